"""Crash reports: whatever goes wrong anywhere leaves a record in one file, and the user is told once."""

import faulthandler
import platform
import sys
import threading
import time
import traceback
from pathlib import Path
from types import TracebackType
from typing import TextIO

from PySide6.QtCore import QMessageLogContext, QObject, QStandardPaths, QtMsgType, Signal, qInstallMessageHandler

LOG_BYTES_KEPT = 256 * 1024
# What Qt says of its platform without a screen, at every window that opens there.
HARMLESS = "This plugin does not support"


def log_path() -> Path:
    """Where the reports of this user go."""
    folder = QStandardPaths.writableLocation(QStandardPaths.StandardLocation.AppLocalDataLocation)
    return Path(folder) / "crash-reports.log"


class CrashReports(QObject):
    """Catches what nobody else caught, in all threads; `reported` is emitted with (one line, the whole text)."""

    reported = Signal(str, str)

    def __init__(self, path: Path | None = None, parent: QObject | None = None) -> None:
        """Write to *path*, by default log_path(); a place that cannot be written to is not an error."""
        super().__init__(parent)
        self.path = path or log_path()
        self._file = _opened(self.path)
        self._lock = threading.RLock()
        self._busy = threading.local()
        self._last, self._times = "", 0

    def install(self) -> None:
        """Take over the hooks of Python, of its threads and of Qt."""
        sys.excepthook = self._uncaught
        threading.excepthook = self._uncaught_in_thread
        sys.unraisablehook = self._unraisable
        qInstallMessageHandler(self._qt_message)
        faulthandler.enable(self._file or sys.__stderr__ or sys.stderr, all_threads=True)

    def uninstall(self) -> None:
        """Give the hooks back."""
        sys.excepthook = sys.__excepthook__
        threading.excepthook = threading.__excepthook__
        sys.unraisablehook = sys.__unraisablehook__
        qInstallMessageHandler(None)
        faulthandler.disable()
        if self._file is not None:
            self._file.close()
            self._file = None

    def report(self, error: BaseException, where: str = "") -> None:
        """Record *error* and tell the user; *where* says in which thread or object it was."""
        if getattr(self._busy, "reporting", False):  # an error while reporting an error
            return
        self._busy.reporting = True
        try:
            text = "".join(traceback.format_exception(error))
            line = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
            self._record(where or "error", text, line)
            self.reported.emit(line, f"{about_this_run()}\n{where}\n{text}".replace("\n\n", "\n"))
        finally:
            self._busy.reporting = False

    def _record(self, kind: str, text: str, line: str) -> None:
        """Write it down; what comes again and again, as from a paint event, only at every doubling of its number."""
        self._times = self._times + 1 if text == self._last else 1
        self._last = text
        if self._times == 1:
            self._write(kind, text)
        elif self._times & (self._times - 1) == 0:
            self._write(kind, f"{line} (for the {self._times}th time)")

    def _write(self, kind: str, text: str) -> None:
        stamp = time.strftime("%Y-%m-%d %H:%M:%S")
        for stream in (self._file, sys.__stderr__):
            if stream is not None:
                with self._lock:
                    stream.write(f"{stamp} {kind}\n{text.rstrip()}\n")
                    stream.flush()

    def _uncaught(self, kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        if isinstance(error, KeyboardInterrupt):
            sys.__excepthook__(kind, error, trace)
        else:
            self.report(error)

    def _uncaught_in_thread(self, hook: threading.ExceptHookArgs) -> None:
        if hook.exc_value is not None:
            self.report(hook.exc_value, f"in thread {hook.thread.name if hook.thread else 'unknown'}")

    def _unraisable(self, hook: "sys.UnraisableHookArgs") -> None:
        if hook.exc_value is not None:
            self.report(hook.exc_value, f"in {hook.object!r}")

    def _qt_message(self, kind: QtMsgType, context: QMessageLogContext, message: str) -> None:
        if kind != QtMsgType.QtDebugMsg and not message.startswith(HARMLESS):
            self._write(f"Qt {kind.name}", message)


def about_this_run() -> str:
    """The versions a reader of a report asks for first."""
    import PySide6

    from app import __version__

    return f"Hermite {__version__}, Python {platform.python_version()}, Qt {PySide6.__version__}, {platform.platform()}"


def _opened(path: Path) -> TextIO | None:
    """The log, open for appending and cut to its newest part."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.exists() and path.stat().st_size > 2 * LOG_BYTES_KEPT:
            path.write_bytes(path.read_bytes()[-LOG_BYTES_KEPT:])
        return path.open("a", encoding="utf-8", errors="backslashreplace", buffering=1)
    except OSError:
        return None
