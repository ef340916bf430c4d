"""Jobs: work that would stop the window runs on another thread, one piece at a time, told and stopped from here.

Whoever asks for a job waits for it in the event loop, as for the answer of a dialog, while the window goes on. What the
user may do meanwhile is up to the callers: they ask `job` first.
"""

import sys
from collections.abc import Callable
from typing import Final

from PySide6.QtCore import QEventLoop, QObject, QThreadPool, Signal, Slot

from model.progress import CancelledError, Report, unheard

# Seconds after which a thread in the middle of Python code lets the other go on. Each call into Qt gives the turn away,
# so that painting waits a hundred times a picture; Python's own 5 ms would make that half a second.
SWITCH_INTERVAL: Final = 1e-4


class Job(QObject):
    """One piece of work under way; `share` is how much of it is done, from 0 to 1."""

    ended = Signal()  # from the other thread

    def __init__(self, text: str, work: Callable[[Report], object], *, vital: bool) -> None:
        super().__init__()
        self.text = text
        self.vital = vital  # not given up because the window is closed
        self.share = 0.0
        self.cancelled = False
        self.result: object = None
        self.error: BaseException | None = None
        self._work = work

    def cancel(self) -> None:
        """Have it stopped where it next reports; nothing is left of it then."""
        self.cancelled = True

    def do(self) -> None:
        """Do the work, on whatever thread this is."""
        try:
            self.result = self._work(self._heard)
        except BaseException as error:
            self.error = error
        self.ended.emit()

    def _heard(self, share: float) -> None:
        self.share = share
        if self.cancelled:
            raise CancelledError


class Jobs(QObject):
    """Runs the jobs of one window; `job` is the one under way."""

    changed = Signal()  # a job has begun or ended

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self.job: Job | None = None
        self._loop: QEventLoop | None = None

    def run[T](self, text: str, work: Callable[[Report], T], *, at_once: bool, vital: bool = False) -> T:
        """Do *work* and give its result or raise its error; CancelledError if it was cancelled.

        *at_once* does it here and now, without a word: for work that is done before anybody sees it begin.
        """
        if self.job is not None:
            raise RuntimeError(f"{self.job.text!r} is still going on")
        if at_once:
            return work(unheard)
        job = self.job = Job(text, work, vital=vital)
        self._loop = QEventLoop(self)
        interval = sys.getswitchinterval()
        sys.setswitchinterval(SWITCH_INTERVAL)
        try:
            job.ended.connect(self._end)
            QThreadPool.globalInstance().start(job.do)
            self.changed.emit()
            self._loop.exec()
            QThreadPool.globalInstance().waitForDone()  # when the program was told to quit meanwhile
        finally:
            sys.setswitchinterval(interval)
            self._loop = self.job = None
            self.changed.emit()
        if job.error is not None:
            raise job.error
        return job.result  # type: ignore[return-value]  # what work gave

    @Slot()
    def _end(self) -> None:
        if self._loop is not None:
            self._loop.quit()
