"""LongEdits: changes of very many keys are made on another thread, while the window shows what was and waits."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from app.input_gate import InputGate
from model.progress import CancelledError, Report, unheard

if TYPE_CHECKING:
    from app.main_window import MainWindow
    from app.progress_row import ProgressRow


class LongEdits:
    """The `LongWork` of a window's document."""

    def __init__(self, window: "MainWindow", progress: "ProgressRow") -> None:
        self._window = window
        self._progress = progress

    def __call__[T](self, text: str, work: Callable[[Report], T]) -> T:
        """Do *work* as a job; at once if there is another job already."""
        window = self._window
        if window.jobs.job is not None:
            return work(unheard)
        gate = InputGate(self._progress.cancel, self._progress.stop)
        gate.shut()
        window.view.hold()
        window.tree.view.setUpdatesEnabled(False)  # its rows read the curves as they are painted
        try:
            return window.jobs.run(text, work, at_once=False, vital=True)
        except CancelledError:
            window.say(f"{text}: cancelled, nothing has changed")
            raise
        finally:
            window.tree.view.setUpdatesEnabled(True)
            window.view.release()
            gate.open()
