"""The quick import of Qt for Python leaves its words for errors and help as they are for everybody else."""

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
QUICK = "import sys; from app.quick_qt import WORDING, import_qt; import_qt(); "
LOADED = (
    "names = sorted(name.removesuffix('.py').replace('/', '.') for name in WORDING); "
    "print([name for name in names if '__getattr__' not in vars(sys.modules[name])])"
)
SAYS = """
import inspect
from PySide6.QtCore import QObject, QPoint, QTimer
try:
    QPoint("here")
except TypeError as error:
    print(error)
print(inspect.signature(QTimer.setInterval), QObject.objectName.__doc__)
"""


def printed(code: str, more: Mapping[str, str] | None = None) -> str:
    """What a new Python prints, or what it fails with."""
    environment = {**os.environ, **(more or {})}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )
    return done.stdout.strip() + done.stderr.strip()


def test_the_words_for_signatures_are_not_loaded_until_they_are_asked_for() -> None:
    assert printed(f"{QUICK}import PySide6.QtWidgets; {LOADED}") == "[]"
    assert "errorhandler" in printed(f"{QUICK}from PySide6.QtCore import QObject; print(QObject.__doc__); {LOADED}")


def test_a_wrong_call_and_help_are_worded_as_after_the_usual_import() -> None:
    usual = printed(SAYS)
    assert "called with wrong argument types" in usual
    assert printed(QUICK + SAYS) == usual


def test_an_option_of_qt_for_python_that_these_modules_read_is_still_read_at_import() -> None:
    told = printed(QUICK + LOADED, {"PYSIDE6_OPTION_PYTHON_ENUM": "0x01"})
    assert told.count("shibokensupport") == 7


def test_an_unknown_version_is_imported_as_everybody_does() -> None:
    code = f"import app.quick_qt; app.quick_qt.KNOWN = '5.0'; {QUICK}{LOADED}"
    assert printed(code).count("shibokensupport") == 7


def test_compile_is_itself_again_and_imports_pass_qt_by() -> None:
    assert printed("import PySide6.QtCore; print(__import__.__name__)") == "__feature_import__"
    told = printed(f"before = compile; {QUICK}print(compile is before, __import__.__name__)")
    assert told.startswith("True ")
    assert "feature" not in told
