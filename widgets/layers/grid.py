"""Ground and grid: what lies under the curves."""

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QPointF
from PySide6.QtGui import QImage, QPainter, QPixmap

from widgets.painting import draw_boxes, hair
from widgets.stage import LABEL_SIZE, Stage
from widgets.traces import Trace


def draw_ground(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """The background, darker before and after the clip's range, with the upright lines of the grid.

    All rows of pixels are the same: one is made, and laid over the plot as quickly as it could be filled.
    """
    window, clip, theme = stage.window, stage.document.clip, stage.theme
    row = QImage(max(round(window.width), 1), 1, QImage.Format.Format_RGB32)
    pixels = np.frombuffer(row.bits(), np.uint32)
    pixels[:] = theme.background.rgba()
    if clip.end > clip.start:
        with np.errstate(over="ignore"):
            edges = window.x_from_time(np.array([clip.start, clip.end])) - window.left
        start, end = np.rint(np.clip(edges, 0.0, window.width)).astype(np.intp).tolist()
        pixels[:start] = pixels[end:] = theme.outside.rgba()
    for places, color in ((stage.time_ticks.minor, theme.grid), (stage.time_ticks.major, theme.grid_strong)):
        at = np.floor(window.x_from_time(places)) - window.left
        pixels[at[(at >= 0) & (at < len(pixels))].astype(np.intp)] = color.rgba()
    painter.drawTiledPixmap(stage.plot(), QPixmap.fromImage(row))


def draw_grid(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """Level lines at the values of the ruler, the labelled ones stronger; translucent ones would cost twenty times."""
    window, theme = stage.window, stage.theme
    for places, color in ((stage.value_ticks.minor, theme.grid), (stage.value_ticks.major, theme.grid_strong)):
        boxes = np.empty((len(places), 4), np.int32)
        boxes[:, 0], boxes[:, 2] = window.left, window.right
        boxes[:, 1] = boxes[:, 3] = np.floor(window.y_from_value(places))
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
