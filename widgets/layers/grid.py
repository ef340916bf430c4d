"""Ground and grid: what lies under the curves."""

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QPainter

from widgets.painting import draw_boxes, hair
from widgets.stage import LABEL_SIZE, Stage
from widgets.traces import Trace


def draw_ground(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """The background, darker before and after the clip's range."""
    window, clip, theme = stage.window, stage.document.clip, stage.theme
    painter.fillRect(stage.plot(), theme.background)
    if clip.end > clip.start:
        edges = np.clip(window.x_from_time(np.array([clip.start, clip.end])), window.left, window.right)
        start, end = np.rint(edges).tolist()
        painter.fillRect(QRectF(window.left, window.top, start - window.left, window.height), theme.outside)
        painter.fillRect(QRectF(end, window.top, window.right - end, window.height), theme.outside)


def draw_grid(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """Lines at the rulers' ticks, the labelled ones stronger; opaque, since translucent ones cost twenty times that."""
    window, theme = stage.window, stage.theme
    for upright, ticks in ((True, stage.time_ticks), (False, stage.value_ticks)):
        for places, color in ((ticks.minor, theme.grid), (ticks.major, theme.grid_strong)):
            boxes = np.empty((len(places), 4), np.int32)
            boxes[:] = window.left, window.top, window.right, window.bottom
            at = np.floor(window.x_from_time(places) if upright else window.y_from_value(places))
            boxes[:, 0 if upright else 1] = boxes[:, 2 if upright else 3] = at
            draw_boxes(painter, color, boxes)
    if stage.value_ticks.offset:
        painter.setFont(stage.font(LABEL_SIZE))
        painter.setPen(theme.ruler_text)
        baseline = window.top + stage.px(6) + stage.words(LABEL_SIZE).ascent
        painter.drawText(QPointF(window.left + stage.px(8), baseline), stage.value_ticks.offset)
    zero = np.floor(window.y_from_value(0.0)) + 0.5
    if window.top <= zero <= window.bottom:
        painter.setPen(hair(theme.zero_line))
        painter.drawLine(QPointF(window.left, zero), QPointF(window.right, zero))
