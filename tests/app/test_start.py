"""The program starts on what it is given, says what it cannot open, and ends when it is asked to."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from model.channel import Channel
from model.clip import Clip
from model.formats import write_bytes
from model.keyframe import make_run

ROOT = Path(__file__).resolve().parents[2]

# Runs the program as main.py does and does one thing once the first picture is there.
PROGRAM = """
import sys
from PySide6.QtCore import QTimer
from app.main_window import run_window

def first_picture(window):
    print(window.windowTitle(), "|", window.files.path, "|", window.session.active.name, flush=True)
    {then}

sys.exit(run_window(sys.argv[1] or None, None, first_picture=first_picture))
"""


# Runs the program on a file and tells what is to be seen until the file is open.
LATE_FILE = """
import sys
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
from app.main_window import MainWindow, run_window

seen = []

def look():
    window = next(w for w in QApplication.topLevelWidgets() if isinstance(w, MainWindow))
    if window.ready and window.jobs.job is not None:
        seen.append(window.jobs.job.text)
    if window.ready and window.files.path:
        print(seen[:1], window.document.clip.key_count, flush=True)
        window.close()
    else:
        QTimer.singleShot(1, look)

sys.exit(run_window(sys.argv[1], None, first_frame=look))
"""


# Runs the program as the command line does, up to its first picture, and tells of the collection of garbage.
GARBAGE = """
import gc, sys
import main

kept = []
gc.callbacks.append(lambda phase, info: "PySide6" in sys.modules and kept.append(gc.get_freeze_count()))
sys.argv[1:] = ["--check"]
code = main.main()
gc.collect()
print(min(kept) > 10_000, gc.isenabled())
sys.exit(code)
"""

# Runs the program as the command line does and tells which modules are loaded when the first picture is there.
LOADED = """
import sys
import main, app.quick_qt

import_qt = app.quick_qt.import_qt

def import_qt_and_listen():
    import_qt()
    import app.check, app.main_window
    from PySide6.QtWidgets import QApplication
    tell = lambda window: (print(*sys.modules), QApplication.exit(0))
    app.check.run_check = lambda path, skel, started: app.main_window.run_window(path, skel, first_picture=tell)

app.quick_qt.import_qt = import_qt_and_listen
sys.argv[1:] = ["--check"]
sys.exit(main.main())
"""
# Packages, and parts of packages, that are needed by then; what else is imported makes every start slower.
NEEDED = {
    "": {
        "app",
        "model",
        "widgets",
        "main",
        "PySide6",
        "shiboken6",
        "shibokensupport",
        "pyqtgraph",
        "colorama",
        "numpy",
    },
    "PySide6.": {"QtCore", "QtGui", "QtSvg", "QtWidgets", "support"},
    "numpy.": {"dtypes", "exceptions", "lib", "linalg", "matrixlib", "typing", "version"},
}
# What is imported when it is asked for.
LATE = {"app.about", "app.commands", "app.fuzzy", "app.help", "app.palette", "app.render"}
LATE |= {"asyncio", "email", "http", "importlib.metadata", "logging", "xml"}


def run(path: str, then: str) -> subprocess.CompletedProcess[str]:
    code = {"late": LATE_FILE, "garbage": GARBAGE, "loaded": LOADED}.get(then) or PROGRAM.format(then=then)
    return subprocess.run(
        [sys.executable, "-c", code, path],
        cwd=ROOT,
        env={**os.environ, "QT_QPA_PLATFORM": "offscreen"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def test_without_a_file_a_sample_opens_that_belongs_to_nobody() -> None:
    done = run("", "window.close()")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "bounce[*] — Hermite |  | ball.tx\n"


def test_a_large_file_is_read_behind_a_window_that_answers(tmp_path: Path) -> None:
    path = tmp_path / "large.anim"
    path.write_bytes(write_bytes(Clip([Channel("c", make_run(np.arange(60_000.0), 0.25))]), "anim"))
    done = run(str(path), "late")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "['Opening large.anim'] 60000\n"


def test_a_file_that_cannot_be_read_is_one_sentence_and_code_2(tmp_path: Path) -> None:
    done = run(str(tmp_path / "nothing.anim"), "window.close()")
    assert done.returncode == 2
    assert "nothing.anim" in done.stderr
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.skipif(sys.platform == "win32", reason="signals are another thing there")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_polite_signal_closes_the_window(number: signal.Signals) -> None:
    done = run("", f"import os; os.kill(os.getpid(), {int(number)})")
    assert (done.returncode, done.stderr) == (0, "")


def test_leaving_in_the_middle_of_a_drag_says_nothing() -> None:
    then = "gesture = window.document.begin('Drag'); from PySide6.QtWidgets import QApplication; QApplication.exit(0)"
    done = run("", then)
    assert (done.returncode, done.stderr) == (0, "")


def test_garbage_is_not_looked_for_until_the_first_picture_is_there_and_then_as_ever() -> None:
    done = run("", "garbage")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.splitlines()[-1] == "True True"


def test_nothing_is_imported_before_the_first_picture_that_it_does_not_need() -> None:
    done = run("", "loaded")
    assert (done.returncode, done.stderr) == (0, "")
    names = set(done.stdout.split())
    for package, needed in NEEDED.items():
        parts = {name.removeprefix(package).partition(".")[0] for name in names if name.startswith(package)}
        others = parts - needed - sys.stdlib_module_names
        assert not {name for name in others if not name.startswith("_")} - {"signature_bootstrap"}
    assert sorted(names & LATE) == []
