"""What every test stands on: the right Python, no screen unless asked for, nobody's settings, an empty clipboard."""

import atexit
import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
SHARED = ROOT.parent / "shared"

if sys.version_info < (3, 12):
    # Qt for Python 6.12 loses references to None and True on older Pythons and then aborts somewhere at random.
    pytest.exit(f"Hermite needs Python 3.12 or newer, this is {sys.version.split()[0]}: run make test", returncode=2)

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ.setdefault("QT_NO_GUI_THREADPOOL", "1")

# The user's own settings, recent files and crash reports are out of reach before anything can look for them.
_HOME = Path(tempfile.mkdtemp(prefix="hermite-tests-"))
atexit.register(shutil.rmtree, _HOME, ignore_errors=True)
os.environ["HOME"] = str(_HOME)
for _name in ("XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME"):
    os.environ[_name] = str(_HOME / _name.lower())

from hypothesis import settings  # HOME has moved

from app.preflight import library_problem, missing_libraries, platform_name

if _problem := library_problem(missing_libraries(platform_name())):
    pytest.exit(_problem, returncode=2)

settings.register_profile("desk", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("ci" if os.environ.get("CI") else "desk")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Skips the window tests where there is no X screen to hold a window."""
    if os.environ["QT_QPA_PLATFORM"] == "xcb":
        return
    for item in items:
        if item.get_closest_marker("window"):
            item.add_marker(pytest.mark.skip(reason="needs an X screen with a window manager: make test"))


@pytest.fixture(scope="session", autouse=True)
def _settings_of_nobody() -> None:
    """Qt's own folders move too: on Windows and macOS they do not follow HOME."""
    from PySide6.QtCore import QStandardPaths

    QStandardPaths.setTestModeEnabled(True)


@pytest.fixture(autouse=True)
def _empty_clipboard(request: pytest.FixtureRequest) -> Iterator[None]:
    """The offscreen platform crashes at exit when the clipboard still holds data."""
    yield
    if {"qtbot", "qapp"} & set(request.fixturenames):
        from PySide6.QtGui import QGuiApplication

        QGuiApplication.clipboard().clear()


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of golden values and sample files beside the checkout; its tests are skipped where it is not."""
    if not SHARED.is_dir():
        pytest.skip("no ../shared beside this checkout")
    return SHARED
