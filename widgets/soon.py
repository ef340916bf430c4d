"""Soon: many requests, one refresh, and never more than a small part of the time spent on it."""

from collections.abc import Callable
from time import perf_counter
from typing import Final

from PySide6.QtCore import QObject, Qt, QTimer

from model.document import Document

LEAST_PAUSE: Final = 0.030  # seconds between two refreshes: the eye reads no number faster
PAUSE_FOR_WORK: Final = 15.0  # a refresh that took 10 ms is followed by 150 ms without one


class Soon(QObject):
    """Calls *refresh* once, in the next turn of the event loop or after a pause, however often it was asked to.

    One about a *document* waits while that is being changed by another thread.
    """

    def __init__(
        self,
        parent: QObject,
        refresh: Callable[[], None],
        least_pause: float = LEAST_PAUSE,
        document: Document | None = None,
    ) -> None:
        super().__init__(parent)
        self._refresh = refresh
        self._document = document
        self._least_pause = least_pause
        self._not_before = 0.0
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self.now)
        self._asked = False

    def ask(self, *_: object) -> None:
        """Have it refreshed; costs a microsecond, so any listener may be this."""
        if not self._asked:
            self._asked = True
            wait = self._not_before - perf_counter()
            self._timer.start(max(int(wait * 1000) + 1, 0) if wait > 0 else 0)

    def now(self) -> None:
        """Refresh at once, and forget that it was asked for."""
        if self._document is not None and self._document.working:
            self._timer.start(int(LEAST_PAUSE * 1000))
            return
        self._asked = False
        self._timer.stop()
        start = perf_counter()
        try:
            self._refresh()
        finally:
            end = perf_counter()
            self._not_before = end + max(self._least_pause, (end - start) * PAUSE_FOR_WORK)
