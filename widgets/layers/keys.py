"""Keys: marks whose left half tells the rule of the tangent in, the right half that of the tangent out."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from math import floor
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPixmap, QPolygonF

from model.keyframe import Run, TangentRule
from model.sampling import FAR
from widgets.chosen import Key, keys_from
from widgets.painting import draw_marks
from widgets.stage import Stage
from widgets.traces import Trace

# Half the size of a key's mark, in logical pixels.
REST: Final = 2.6
LIVE: Final = 3.5
SELECTED: Final = 4.6
# Keys nearer to each other than this in both directions are one mark.
CELL: Final = 3.0
# So many keys are drawn one by one: arrays take longer to set up.
FEW: Final = 16


def _diamond(r: float) -> QPainterPath:
    return _polygon((0, -1.25 * r), (1.25 * r, 0), (0, 1.25 * r), (-1.25 * r, 0))


def _circle(r: float) -> QPainterPath:
    path = QPainterPath()
    path.addEllipse(QPointF(0, 0), 1.05 * r, 1.05 * r)
    return path


def _ring(r: float) -> QPainterPath:
    path = _circle(1.1 * r)
    path.addEllipse(QPointF(0, 0), 0.45 * r, 0.45 * r)
    return path


def _square(r: float) -> QPainterPath:
    return _box(0.95 * r, 0.95 * r)


def _bar(r: float) -> QPainterPath:
    return _box(1.3 * r, 0.6 * r)


def _wall(r: float) -> QPainterPath:
    return _box(0.35 * r, 1.2 * r)


def _box(half_width: float, half_height: float) -> QPainterPath:
    path = QPainterPath()
    path.addRect(QRectF(-half_width, -half_height, 2 * half_width, 2 * half_height))
    return path


def _polygon(*points: tuple[float, float]) -> QPainterPath:
    path = QPainterPath()
    path.addPolygon(QPolygonF([QPointF(x, y) for x, y in points]))
    path.closeSubpath()
    return path


SHAPES: Final[dict[TangentRule, Callable[[float], QPainterPath]]] = {
    TangentRule.FLAT: _bar,
    TangentRule.LINEAR: _square,
    TangentRule.SMOOTH: _circle,
    TangentRule.FIXED: _diamond,
    TangentRule.STEP: _wall,
    TangentRule.AUTO: _ring,
}


def draw_keys(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """The keys that are not selected; those too near to tell apart are one mark."""
    window = stage.window
    reach = stage.px(SELECTED * 2)
    for trace in traces:
        channel = trace.channel
        if stage.manner_of(channel).unmarked:
            continue
        run = channel.keys_between(window.time_from_x(x0 - reach), window.time_from_x(x1 + reach), around=1)
        if not len(run):
            continue
        color = stage.theme.key_locked if channel.locked else trace.color
        radius = stage.px(LIVE if trace.active else REST)
        if len(run) <= FEW:
            draw_few(painter, stage, few_told_apart(keys_from(run.tolist()), stage), color, radius)
        else:
            _draw_run(painter, stage, run[told_apart(run, stage)], color, radius)


def draw_covered_keys(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """The keys that the gesture under way hides: they come back if it moves on."""
    gesture = stage.document.gesture
    if gesture is None or not gesture.hides_keys:
        return
    for channel, run in gesture.covered.items():
        if stage.trace_of(channel) is not None:
            painter.setOpacity(0.6)
            _draw_run(painter, stage, run, stage.theme.ghost, stage.px(REST))
            painter.setOpacity(1.0)


def told_apart(run: Run, stage: Stage) -> NDArray[np.bool_]:
    """Which keys get a mark: those that do not lie in the same small cell as the key before them."""
    window = stage.window
    cell = stage.px(CELL)
    with np.errstate(over="ignore"):
        column = np.floor(run["time"] * (window.px_per_second / cell))
        row = np.floor(run["value"] * (window.px_per_value / cell))
    apart = np.ones(len(run), np.bool_)
    apart[1:] = (np.diff(column) != 0) | (row[1:] != row[:-1])
    return apart


def few_told_apart(keys: list[Key], stage: Stage) -> list[Key]:
    """The same of a few keys, one by one: arrays take longer to set up."""
    window, cell = stage.window, stage.px(CELL)
    per_second, per_value = window.px_per_second / cell, window.px_per_value / cell
    kept: list[Key] = []
    before: tuple[float, float] | None = None
    for key in keys:
        place = (key.time * per_second // 1.0, key.value * per_value // 1.0)
        if place != before:
            kept.append(key)
        before = place
    return kept


def draw_few(painter: QPainter, stage: Stage, keys: list[Key], color: QColor, radius: float) -> None:
    """The marks of a few keys, one by one."""
    if not keys:
        return
    window = stage.window
    atlas, side = atlas_of(color.rgba(), stage.theme.key.rgba(), radius)
    half = side // 2
    low, high = window.top - 3 * radius, window.bottom + 3 * radius
    for key in keys:
        x, y = window.x_from_time(key.time), window.y_from_value(key.value)
        if -FAR < x < FAR and low < y < high:
            which = key.rule_in * len(SHAPES) + key.rule_out
            painter.drawPixmap(floor(x) - half, floor(y) - half, atlas, which * side, 0, side, side)


class Marks(NamedTuple):
    """Where marks are to be drawn, in pixels, and which ones of an atlas."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    which: NDArray[np.intp]


def marks_of(run: Run, stage: Stage, radius: float) -> Marks:
    """The marks of these keys, as far as they are neither above nor below the window."""
    window = stage.window
    with np.errstate(over="ignore"):
        x = np.clip(np.floor(window.x_from_time(run["time"])), -FAR, FAR) + 0.5
        y = np.clip(np.floor(window.y_from_value(run["value"])), -FAR, FAR) + 0.5
    inside = (y > window.top - 3 * radius) & (y < window.bottom + 3 * radius)
    which = run["rule_in"].astype(np.intp) * len(SHAPES) + run["rule_out"]
    return Marks(x[inside], y[inside], which[inside])


def _draw_run(painter: QPainter, stage: Stage, run: Run, color: QColor, radius: float) -> None:
    atlas, side = atlas_of(color.rgba(), stage.theme.key.rgba(), radius)
    draw_marks(painter, atlas, side, *marks_of(run, stage, radius))


@lru_cache(maxsize=256)
def atlas_of(color: int, rim: int, radius: float) -> tuple[QPixmap, int]:
    """All pairs of shapes in one picture, and the side of their squares in pixels (odd, so that centres are pixels)."""
    side = 2 * int(np.ceil(radius * 1.5 + 1.5)) + 1
    count = len(SHAPES)
    atlas = QPixmap(side * count * count, side)
    atlas.fill(Qt.GlobalColor.transparent)
    painter = QPainter(atlas)
    try:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for left in TangentRule:
            for right in TangentRule:
                painter.save()
                painter.translate(side * (left * count + right) + side / 2, side / 2)
                _draw_halves(painter, SHAPES[left](radius), SHAPES[right](radius), color, rim, side, radius)
                painter.restore()
    finally:
        painter.end()
    return atlas, side


def _draw_halves(
    painter: QPainter, left: QPainterPath, right: QPainterPath, color: int, rim: int, side: int, radius: float
) -> None:
    half = side / 2
    path = left
    if left != right:
        cut_left, cut_right = QPainterPath(), QPainterPath()
        cut_left.addRect(QRectF(-half, -half, half, side))
        cut_right.addRect(QRectF(0, -half, half, side))
        path = left.intersected(cut_left).united(right.intersected(cut_right))
    pen = painter.pen()
    pen.setColor(QColor.fromRgba(rim))
    pen.setWidthF(max(2.0, radius * 0.6))
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    painter.strokePath(path, pen)
    painter.fillPath(path, QColor.fromRgba(color))
