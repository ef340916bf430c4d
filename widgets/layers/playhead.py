"""The playhead: one line over everything."""

from collections.abc import Sequence

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter

from widgets.stage import Stage
from widgets.traces import Trace


def draw_playhead(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """A line of one logical pixel at the playhead's time."""
    window = stage.window
    x = window.x_from_time(stage.document.session.playhead)
    if window.left - 1 <= x <= window.right + 1:
        width = max(round(stage.px(1)), 1)
        painter.fillRect(QRectF(int(x), window.top, width, window.height), stage.theme.playhead)
