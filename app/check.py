"""hermite --check: opens the window as always, waits for its first picture, tells versions and times, and closes."""

import os
import platform
import sys
import threading
from pathlib import Path
from time import perf_counter, process_time
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QApplication

from app import __version__
from app.main_window import run_window

if TYPE_CHECKING:
    from app.main_window import MainWindow

PACKAGES = ("PySide6-Essentials", "pyqtgraph", "numpy")
LONGEST_WAIT = 60.0


def process_age() -> float | None:
    """Seconds since this process was started, to a hundredth; None where the system does not tell."""
    try:
        fields = Path("/proc/self/stat").read_text(encoding="ascii").rpartition(")")[2].split()
        uptime = float(Path("/proc/uptime").read_text(encoding="ascii").split()[0])
    except (OSError, ValueError):
        return None
    return uptime - int(fields[19]) / os.sysconf("SC_CLK_TCK")


def run_check(path: str | None, skel: str | None, started: float) -> int:
    """Open the clip at *path*, draw it once and close; *started* is when main.py began (perf_counter).

    When no picture comes, because something failed or hangs, the process ends with 1 after LONGEST_WAIT seconds.
    """
    watchdog = threading.Timer(LONGEST_WAIT, give_up)
    watchdog.daemon = True
    watchdog.start()

    def age() -> float:
        return process_age() or perf_counter() - started

    frames: list[float] = []

    def first_frame() -> None:
        frames.append(age())

    def first_picture(window: "MainWindow") -> None:
        watchdog.cancel()
        picture, work = age(), process_time()
        # Not above: the import would count into the time.
        from importlib.metadata import version

        clip = window.document.clip
        screen = window.screen()
        size = screen.size()
        print(f"hermite {__version__}, Python {platform.python_version()}, {platform.platform()}")
        print(*(f"{name} {version(name)}" for name in PACKAGES), sep=", ")
        print(f"screen {QApplication.platformName()} {size.width()}x{size.height()} at {screen.devicePixelRatio():g}")
        print(f"{window.files.name}: {len(clip.channels)} channels, {clip.key_count} keys")
        print(f"first picture {picture:.2f} s after the start, {work:.2f} s of processor time")
        print(f"empty frame {frames[0]:.2f} s after the start")
        QApplication.exit(0)

    try:
        return run_window(path, skel, first_picture=first_picture, first_frame=first_frame)
    finally:
        watchdog.cancel()


def give_up() -> None:
    """End the process at once: the event loop may be what hangs."""
    print(f"no picture within {LONGEST_WAIT:g} s", file=sys.stderr, flush=True)
    os._exit(1)
