"""Heart: how long the GUI thread was kept from its events by work of this process, on however busy a machine."""

import threading
import time
from pathlib import Path
from types import TracebackType
from typing import Self

from PySide6.QtCore import Qt, QTimer

BEAT_MILLISECONDS = 5


class Heart:
    """A timer of the GUI thread that should fire every 5 ms; `longest` is the longest it was held up, in seconds.

    A gap between two beats counts only as far as this process had a hand in it: without the time in which the thread
    was ready to run and another process had the processor (Linux counts that for each thread, in schedstat), and never
    more than the CPU time that all threads of this process used in it. So the thread's own work counts, and waiting
    for Python's lock while another thread holds it; a loaded machine does not, nor does a timer that fires late.
    """

    def __init__(self) -> None:
        self.longest = 0.0
        self._timer = QTimer()
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.setInterval(BEAT_MILLISECONDS)
        self._timer.timeout.connect(self._beat)
        self._schedule = Path(f"/proc/self/task/{threading.get_native_id()}/schedstat")
        self._last = self._now()

    def __enter__(self) -> Self:
        self._last = self._now()
        self._timer.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, tb: TracebackType | None) -> None:
        self._timer.stop()
        self._beat()

    def _now(self) -> tuple[float, float]:
        """(time without waiting for a processor, CPU time of the process)."""
        waited = int(self._schedule.read_text().split()[1]) * 1e-9 if self._schedule.exists() else 0.0
        return time.perf_counter() - waited, time.process_time()

    def _beat(self) -> None:
        now = self._now()
        self.longest = max(self.longest, min(now[0] - self._last[0], now[1] - self._last[1]))
        self._last = now
