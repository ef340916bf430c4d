"""Arrays of numbers straight into QPainter: a thousand lines, boxes or marks in one call."""

from functools import lru_cache
from typing import Any, Final, cast

import numpy as np
import shiboken6
from numpy.typing import NDArray
from PySide6.QtCore import QLineF, QRect, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPixmap, QPolygonF

from model.lines import Line

type Floats = NDArray[np.float64]

# Where the line goes again to look thicker, in pixels: a wide antialiased pen is a hundred times as slow (QTBUG-27545).
STROKES: Final = {
    1: ((0.0, 0.0),),
    2: ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)),
    3: ((0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)),
    4: ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (2.0, 0.0), (0.0, 2.0), (1.0, 1.0), (2.0, 1.0), (1.0, 2.0)),
}
# The same for all four numbers of a line: (strokes, 1, 4).
_MOVES: Final = {width: np.tile(strokes, 2)[:, None] for width, strokes in STROKES.items()}


def hair(color: QColor, *, flat: bool = False) -> QPen:
    """A pen one pixel wide at every scale, the only one that is quick on long lines; nobody may change it.

    With *flat* ends a part of a chain looks as in the whole: to make room for other ends, Qt moves the whole first and
    last piece by up to half a pixel.
    """
    return _pen(color.rgba(), flat)


@lru_cache(maxsize=1024)
def _pen(color: int, flat: bool) -> QPen:
    pen = QPen(QColor.fromRgba(color), 1.0)
    pen.setCosmetic(True)
    if flat:
        pen.setCapStyle(Qt.PenCapStyle.FlatCap)
    return pen


def polygon_from(line: Line) -> QPolygonF:
    """The chain as Qt's polygon."""
    count = len(line.x)
    polygon = QPolygonF()
    if count:
        polygon.resize(count)
        address = shiboken6.getCppPointer(polygon.data())[0]
        memory: Any = cast("Any", shiboken6.VoidPtr)(address, count * 16, True)
        points = np.frombuffer(memory, np.float64).reshape(count, 2)
        points[:, 0] = line.x
        points[:, 1] = line.y
    return polygon


def _first[T](rows: NDArray[Any], kind: type[T]) -> T:
    """The first row of an array that lies in memory as Qt's own objects do."""
    return cast("T", shiboken6.wrapInstance(rows.__array_interface__["data"][0], kind))


def draw_chain(painter: QPainter, line: Line, width: int) -> None:
    """The chain with the painter's pen, *width* pixels thick."""
    if len(line.x) < 2:
        return
    polygon = polygon_from(line)
    for dx, dy in STROKES[width]:
        painter.drawPolyline(polygon.translated(dx, dy) if dx or dy else polygon)


def draw_lines(painter: QPainter, lines: Floats, width: int = 1) -> None:
    """Lines (n, 4) of x0, y0, x1, y1."""
    if not len(lines):
        return
    if width > 1:  # every stroke in one call
        lines = (_MOVES[width] + lines).reshape(-1, 4)
    lines = np.ascontiguousarray(lines)
    painter.drawLines(_first(lines, QLineF), len(lines))


def draw_boxes(painter: QPainter, color: QColor, boxes: NDArray[np.int32]) -> None:
    """Filled boxes (n, 4) of whole pixels: left, top, right, bottom, the last two included.

    Upright and level lines are boxes too: a line one pixel thick takes four to seventy times as long.
    """
    if not len(boxes):
        return
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(color)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    painter.drawRects(_first(np.ascontiguousarray(boxes, np.int32), QRect), len(boxes))


def draw_marks(painter: QPainter, atlas: QPixmap, side: int, x: Floats, y: Floats, which: NDArray[np.intp]) -> None:
    """Marks number *which* of an atlas of squares of *side* pixels in a row, centred at x, y, in this order."""
    if not len(x):
        return
    marks = np.empty((len(x), 10))
    marks[:, 0], marks[:, 1] = x, y
    marks[:, 2] = which * side
    marks[:, 3] = 0.0
    marks[:, 4:6] = side
    marks[:, 6:8] = 1.0
    marks[:, 8], marks[:, 9] = 0.0, 1.0
    painter.drawPixmapFragments(_first(marks, QPainter.PixmapFragment), len(marks), atlas)
