"""Drag steps on a screen with two pixels for one; the view is as large as for the other figures in logical pixels."""

from PySide6.QtWidgets import QStackedWidget

from tests.bench.apart import lines_of
from tests.bench.picture import CLIPS, SIZE, drag_times, empty_repaint, shown
from tests.bench.table import Line

ENVIRONMENT = {"QT_SCALE_FACTOR": "2", "QT_QPA_PLATFORM": "offscreen"}
# Keys in view, and the most that a step may take.
VIEWS = {"all in view": (None, 3e-3), "30 keys in view": (30, 3e-3), "3 keys fill the view": (2, 5e-3)}
FLOOR = "empty repaint, PlotWidget with axes"


def run() -> list[Line]:
    """The figures; in a process whose screen is as sharp as that, or by one."""
    stack = QStackedWidget()
    if stack.devicePixelRatioF() != 2.0:
        found = lines_of("sharp", ENVIRONMENT)
        assert not isinstance(found, str), found
        return found
    stack.resize(*SIZE)
    stack.show()
    empty = empty_repaint(stack).median
    lines = []
    for name, make in CLIPS.items():
        clip = make()
        for where, (keys_in_view, most) in VIEWS.items():
            times = drag_times(shown(stack, clip, keys_in_view))
            work = f"a drag step of one key at ratio 2, {name}, {where}"
            lines.append(Line(work, times.median, FLOOR, empty, most=most))
    stack.close()
    return lines
