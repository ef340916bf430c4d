"""Whatever goes wrong is written down and told once, and the program goes on."""

import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.crash_bar import CrashBar
from app.crash_reports import LOG_BYTES_KEPT, CrashReports


class DroppedBadlyError(Exception):
    pass


@pytest.fixture
def log(tmp_path: Path) -> Path:
    return tmp_path / "deep" / "crash-reports.log"


@pytest.fixture
def reports(qtbot: QtBot, log: Path) -> Iterator[CrashReports]:
    hooks = sys.excepthook, threading.excepthook, sys.unraisablehook
    reports = CrashReports(log)
    yield reports
    reports.uninstall()
    sys.excepthook, threading.excepthook, sys.unraisablehook = hooks


def test_an_error_is_written_with_its_place_and_told(qtbot: QtBot, reports: CrashReports, log: Path) -> None:
    bar = CrashBar(str(log))
    qtbot.addWidget(bar)
    reports.reported.connect(bar.show_report)
    try:
        raise DroppedBadlyError("no <b>key</b> here")
    except DroppedBadlyError as error:
        for _ in range(100):
            reports.report(error)
    text = log.read_text()
    assert text.count("DroppedBadlyError: no <b>key</b> here") == 7  # once, then for the 2nd, 4th ... 64th time
    assert "test_crash_reports.py" in text
    assert not bar.isHidden()
    assert "(100 times): DroppedBadlyError: no <b>key</b> here" in bar.message.text()
    bar.dismiss()
    assert bar.isHidden()


def test_an_error_in_a_thread_reaches_the_window(qtbot: QtBot, reports: CrashReports) -> None:
    lines: list[str] = []
    reports.reported.connect(lambda line, text: lines.append(line))
    reports.install()
    thread = threading.Thread(target=lambda: [][1])
    thread.start()
    thread.join()
    reports.uninstall()
    qtbot.waitUntil(lambda: lines == ["IndexError: list index out of range"])


def test_the_log_is_kept_short(qtbot: QtBot, log: Path) -> None:
    log.parent.mkdir()
    log.write_bytes(b"x" * (3 * LOG_BYTES_KEPT))
    CrashReports(log).uninstall()
    assert log.stat().st_size == LOG_BYTES_KEPT


def test_a_place_that_cannot_be_written_to_is_no_reason_to_fail(qtbot: QtBot, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    reports = CrashReports(tmp_path / "file" / "log")
    reports.report(DroppedBadlyError())
    reports.uninstall()


PROGRAM = """
import ctypes, sys
from pathlib import Path
from PySide6.QtCore import QCoreApplication, qWarning
from app.crash_reports import CrashReports
app = QCoreApplication([])
CrashReports(Path(sys.argv[1])).install()
class Bad:
    def __del__(self): raise ValueError("in del")
Bad()
qWarning("from Qt")
ctypes.string_at(0)
"""


def test_even_a_crash_of_the_process_leaves_its_traceback(log: Path) -> None:
    result = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(log)], capture_output=True, check=False, cwd=Path(__file__).parents[2]
    )
    assert result.returncode != 0
    text = log.read_text()
    assert "ValueError: in del" in text
    assert "from Qt" in text
    assert "Segmentation fault" in text or "access violation" in text
