"""Keys: marks whose left half tells the rule of the tangent in, the right half that of the tangent out."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from math import ceil, floor
from typing import Final, cast

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPixmap, QPolygonF

from model.channel import Channel
from model.keyframe import KeyGoneError, Run, TangentRule
from model.sampling import FAR, Window
from widgets.chosen import MOST, Key, Sight, few_chosen, keys_from
from widgets.layers.drawings import boxes_of
from widgets.painting import draw_boxes, draw_marks
from widgets.stage import Stage, chosen
from widgets.traces import Trace

# Half the size of a key's mark, in logical pixels.
REST: Final = 2.6
LIVE: Final = 3.5
SELECTED: Final = 4.6
# Keys nearer to each other than this in both directions are one mark.
CELL: Final = 3.0
# So many keys are drawn one by one: arrays take longer to set up.
FEW: Final = 16
# Of more selected keys than this, those in the same small cell are one mark, which covers them all.
MOST_SELECTED: Final = 20_000


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
            _draw_few(painter, stage, few_told_apart(keys_from(run.tolist()), stage), color, radius)
        else:
            _draw_run(painter, stage, run[told_apart(run, stage)], color, radius)


def draw_selected_keys(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """The selected keys of all shown channels, larger and over everything; merged ones hide none."""
    window = stage.window
    reach = stage.px(SELECTED * 2 + CELL)
    t0, t1 = window.time_from_x(x0 - reach), window.time_from_x(x1 + reach)
    color, radius = stage.theme.key_selected, stage.px(SELECTED)
    if stage.selection.count <= MOST:
        for trace, ids in stage.chosen:
            keys = [each.key for each in few_chosen(stage, trace.channel, ids) if t0 <= each.key.time <= t1]
            _draw_few(painter, stage, keys, color, radius)
        return
    runs = []
    for trace, ids in stage.chosen:
        if stage.manner_of(trace.channel).merged:
            draw_merged(painter, stage, trace, ids, x0, x1)
        else:
            runs.append(selected_between(trace.channel, ids, t0, t1))
    if runs:
        run = _joined(runs)
        if stage.selection.count > MOST_SELECTED:
            run = run[one_a_cell(run, stage)]
        _draw_run(painter, stage, run, color, radius)


def _joined(runs: Sequence[Run]) -> Run:
    # Joining records by numpy's own means compares their fields one by one, each time.
    whole: Run = np.empty(sum(map(len, runs)), runs[0].dtype)
    at = 0
    for run in runs:
        whole[at : at + len(run)] = run
        at += len(run)
    return whole


def draw_merged(painter: QPainter, stage: Stage, trace: Trace, ids: NDArray[np.int64], x0: float, x1: float) -> None:
    """Selected keys that are many in each pixel column, as what they cover there; if they are all, as the curve."""
    window, channel, color = stage.window, trace.channel, stage.theme.key_selected
    whole = stage.wholly[channel] = len(ids) == len(channel)
    if whole:
        draw_boxes(painter, color, boxes_of(window, trace, x0, x1, inside=True))
        return
    known = stage.sights.get(channel)
    if known is None or known.revision != channel.revision or known.ids is not ids:
        known = stage.sights[channel] = Sight(channel.revision, ids, _covered(channel, ids, window))
    boxes = known.boxes
    seen = slice(*boxes[:, 0].searchsorted((floor(x0) - 1, ceil(x1) + 1)).tolist())
    draw_boxes(painter, color, boxes[seen])


def _covered(channel: Channel, ids: NDArray[np.int64], window: Window) -> NDArray[np.int32]:
    """What the keys with these ids cover of each pixel column: boxes (n, 4), left to right."""
    run = channel.keys_between(window.t0, window.t1)
    chosen_ids = np.zeros(int(max(run["id"].max(initial=0), ids[-1])) + 1, np.bool_)
    chosen_ids[ids] = True
    (places,) = chosen_ids.take(run["id"]).nonzero()
    with np.errstate(over="ignore"):
        x = np.clip(np.floor(window.x_from_time(run["time"].take(places))), -FAR, FAR)
        y = np.clip(np.floor(window.y_from_value(run["value"].take(places))), -FAR, FAR)
    if not len(x):
        return np.empty((0, 4), np.int32)
    first = np.concatenate(([0], np.flatnonzero(x[1:] != x[:-1]) + 1))
    left = x.take(first)
    boxes = (left, np.minimum.reduceat(y, first) - 1.0, left, np.maximum.reduceat(y, first) + 1.0)
    return np.stack(boxes, axis=1).astype(np.int32)


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


def selected_between(channel: Channel, ids: NDArray[np.int64], t0: float, t1: float) -> Run:
    """The selected keys from *t0* to *t1*, by whichever way touches fewer keys."""
    if len(ids) < 64 and len(ids) * 16 < channel.count_between(t0, t1):
        try:
            few = channel.keys_of(ids)
        except KeyGoneError:  # some are hidden by a drag
            few = channel.keys_of([key_id for key_id in ids.tolist() if key_id in channel])
        return few[(few["time"] >= t0) & (few["time"] <= t1)]
    run = channel.keys_between(t0, t1)
    return run if len(ids) == len(channel) else cast("Run", run[chosen(run, ids)])


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


def one_a_cell(run: Run, stage: Stage) -> NDArray[np.intp]:
    """The last key of each small cell of the picture, in their order; what lies above or below it is left out."""
    window, cell = stage.window, stage.px(CELL)
    with np.errstate(over="ignore"):
        column = np.floor(run["time"] * (window.px_per_second / cell))
        row = np.floor((window.y_from_value(run["value"]) - window.top) / cell)
    rim = int(4 * SELECTED / CELL)
    high = int(window.height / cell) + 1 + 2 * rim
    inside = np.flatnonzero((row >= -rim) & (row < high - rim))
    if not len(inside):
        return inside
    column, row = column[inside] - column[inside].min(), row[inside] + rim
    last = np.full((int(column.max()) + 1) * high, -1, np.intp)
    last[(column * high + row).astype(np.intp)] = inside
    return np.sort(last[last >= 0])


def _draw_few(painter: QPainter, stage: Stage, keys: list[Key], color: QColor, radius: float) -> None:
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


def _draw_run(painter: QPainter, stage: Stage, run: Run, color: QColor, radius: float) -> None:
    window = stage.window
    with np.errstate(over="ignore"):
        x = np.clip(np.floor(window.x_from_time(run["time"])), -FAR, FAR) + 0.5
        y = np.clip(np.floor(window.y_from_value(run["value"])), -FAR, FAR) + 0.5
    inside = (y > window.top - 3 * radius) & (y < window.bottom + 3 * radius)
    which = run["rule_in"].astype(np.intp) * len(SHAPES) + run["rule_out"]
    atlas, side = atlas_of(color.rgba(), stage.theme.key.rgba(), radius)
    draw_marks(painter, atlas, side, x[inside], y[inside], which[inside])


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
