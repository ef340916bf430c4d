"""What work costs, counted and not timed: calls of functions, numbers drawn, objects alive."""

import gc
import sys
import threading
from collections import Counter
from collections.abc import Callable
from types import FrameType
from typing import Any

from PySide6.QtCore import QCoreApplication, QEvent, QObject
from PySide6.QtGui import QPainter, QPicture
from PySide6.QtWidgets import QApplication
from shiboken6 import isValid

from widgets.curve_view import CurveView
from widgets.theme import Theme


def calls_in(work: Callable[[], object]) -> int:
    """How many functions are called while *work* runs, those of Python and those in C."""
    count = 0

    def counted(_frame: FrameType, event: str, _arg: Any) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(counted)
    try:
        work()
    finally:
        sys.setprofile(before)
    return count


def least_calls(*steps: Callable[[], object], times: int = 9) -> list[int]:
    """The least number of calls of each step, all taken in turn some times: timers that fire meanwhile only add."""
    return [min(column) for column in zip(*([calls_in(step) for step in steps] for _ in range(times)), strict=True)]


def drawn_bytes(view: CurveView) -> int:
    """The size of a recording of all that a view draws anew: it grows with every point, mark and letter."""
    view.canvas.forget()
    picture = QPicture()
    painter = QPainter(picture)
    view.render(painter)
    painter.end()
    return picture.size()


def alive() -> Counter[str]:
    """How many objects there are of each kind, and listeners to what is shared, when all is gone that is to go."""
    for _ in range(3):
        QCoreApplication.processEvents()
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        gc.collect()
    objects = [each for each in gc.get_objects() if isinstance(each, QObject) and isValid(each)]
    found = Counter(type(each).__name__ for each in objects)
    found["threads"] = threading.active_count()
    found["widgets"] = len(QApplication.allWidgets())
    found["listeners to the theme"] = Theme.current().receivers("2theme_changed()")
    app = QApplication.instance()
    assert isinstance(app, QApplication)
    for signal in ("focusChanged(QWidget*,QWidget*)", "aboutToQuit()", "applicationStateChanged(Qt::ApplicationState)"):
        found[f"listeners to {signal}"] = app.receivers(f"2{signal}")
    return found
