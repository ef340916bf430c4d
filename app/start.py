"""The first second of the program: the frame at once, then the clip, then the first picture."""

import gc
import os
import signal
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QCoreApplication, QEvent, QObject, QSocketNotifier, QTimer
from PySide6.QtWidgets import QApplication, QWidget

from app.main_window import MainWindow, make_application
from app.settings import Settings
from widgets.guard import guarded
from widgets.theme import Theme

if TYPE_CHECKING:
    from app.crash_reports import CrashReports

type FirstPicture = Callable[[MainWindow], None]

# A window that starts minimised or on another desktop may not be painted for long; in ms.
FRAME_WAIT, PICTURE_WAIT = 60, 2000
FIRST_SAMPLE = Path(__file__).resolve().parent.parent / "resources" / "samples" / "bounce.hermite"


def start(
    path: str | None, skel: str | None, first_picture: FirstPicture | None, first_frame: Callable[[], None] | None
) -> int:
    """Run the program; see app.main_window.run_window."""
    from app.crash_reports import CrashReports

    app = make_application()
    reports = CrashReports(parent=app)
    reports.install()
    try:
        settings = Settings()
        Theme.current().apply(app, settings.appearance)
        window = MainWindow(settings=settings, frame_only=True)
        window.show()
        closer = SignalCloser(window)
        # Only when the frame is on the screen are numpy, pyqtgraph and the clip loaded: that takes three times as long.
        FirstPaint(
            window, partial(_fill, window, reports, path, skel, first_picture, first_frame), at_latest=FRAME_WAIT
        )
        code = app.exec()
        closer.end()
        if window.ready:
            window.cancel_gesture()
        # Torn down now, while all of Python is there, and not bit by bit when the process ends.
        window.deleteLater()
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        return code
    finally:
        reports.uninstall()


def _fill(
    window: MainWindow,
    reports: "CrashReports",
    path: str | None,
    skel: str | None,
    first_picture: FirstPicture | None,
    first_frame: Callable[[], None] | None,
) -> None:
    if first_frame is not None:
        first_frame()
    from app.quick_start import import_pyqtgraph

    import_pyqtgraph()
    from app.clip_file import open_clip
    from model.formats import FormatError

    opened, problem, advice = None, "", ""
    late = path if path and first_picture is None and _is_large(path) else None
    try:
        opened = None if late else open_clip(path or str(FIRST_SAMPLE), skel)
    except FormatError as error:
        problem, advice = str(error), error.advice
    # An expose of the window system may come in between: what is half laid out is not to be seen.
    window.setUpdatesEnabled(False)
    try:
        window.assemble(opened=opened)
    except Exception:
        QApplication.exit(1)  # there is nothing to go on with; the report says what was wrong
        raise
    QTimer.singleShot(0, window, partial(window.setUpdatesEnabled, True))
    reports.reported.connect(window.crash_bar.show_report)
    if problem and first_picture is not None:
        print(problem, file=sys.stderr)
        QApplication.exit(2)
    elif problem:
        QTimer.singleShot(0, window, partial(window.questions.tell_error, "The clip cannot be opened", advice))
    elif late:
        QTimer.singleShot(0, window, partial(window.files.open, late, skel))
    elif first_picture is not None:
        FirstPaint(window.view.viewport(), partial(first_picture, window))
    FirstPaint(window.view.viewport(), collect_garbage, at_latest=PICTURE_WAIT)


def collect_garbage() -> None:
    """From now on; what there is so far stays to the end, and going through it time and again costs the start 30 ms."""
    gc.freeze()
    gc.enable()


def _is_large(path: str) -> bool:
    """Whether the file is better read on another thread, behind a window that answers."""
    from app.files import FEW_BYTES

    try:
        return os.path.getsize(path) > FEW_BYTES
    except OSError:
        return False  # what is wrong is found at once


class FirstPaint(QObject):
    """Calls back once, when *widget* has been painted for the first time, or *at_latest* after so many ms."""

    def __init__(self, widget: QWidget, call: Callable[[], None], at_latest: int | None = None) -> None:
        super().__init__(widget)
        self._call: Callable[[], None] | None = call
        widget.installEventFilter(self)
        if at_latest is not None:
            QTimer.singleShot(at_latest, self, self._go)

    @guarded(False)
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Paint:
            watched.removeEventFilter(self)
            QTimer.singleShot(0, self, self._go)
        return False

    def _go(self) -> None:
        call, self._call = self._call, None
        if call is not None:
            call()


class SignalCloser(QObject):
    """Ctrl+C in the terminal and a polite kill close the window, which asks when something is not saved."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._notifier: QSocketNotifier | None = None
        if sys.platform == "win32":
            return
        # Python sees a signal only when it runs; the byte that it writes here wakes Qt, and with it Python.
        self._read_end, self._write_end = os.pipe()
        os.set_blocking(self._write_end, False)
        signal.set_wakeup_fd(self._write_end)
        self._notifier = QSocketNotifier(self._read_end, QSocketNotifier.Type.Read, self)
        self._notifier.activated.connect(self._wake)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._close)

    def _wake(self) -> None:
        os.read(self._read_end, 64)

    def _close(self, _number: int, _frame: object) -> None:
        QTimer.singleShot(0, self._window, self._window.close)

    def end(self) -> None:
        """Give the signals back."""
        if self._notifier is not None:
            self._notifier.setEnabled(False)
            signal.set_wakeup_fd(-1)
            for number in (signal.SIGINT, signal.SIGTERM):
                signal.signal(number, signal.SIG_DFL)
            os.close(self._read_end)
            os.close(self._write_end)
            self._notifier = None
