"""Selected keys: marks larger than others and over everything; of very many what is seen is worked out once."""

from collections.abc import Sequence
from math import ceil, floor
from typing import Final, cast

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QPainter

from model.channel import Channel
from model.keyframe import KEY_DTYPE, KeyGoneError, Run
from model.sampling import FAR, Window
from model.selection import Ids
from widgets.chosen import MOST, ManySelected, Seen, Sight, few_chosen
from widgets.layers.drawings import boxes_of
from widgets.layers.keys import CELL, SELECTED, Marks, atlas_of, draw_few, marks_of
from widgets.painting import draw_boxes, draw_marks
from widgets.stage import Stage, chosen
from widgets.traces import Trace

# Of more selected keys than this, those in the same small cell are one mark, which covers them all.
MOST_SELECTED: Final = 20_000


def draw_selected_keys(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """The selected keys of all shown channels; merged ones hide none."""
    window = stage.window
    reach = stage.px(SELECTED * 2 + CELL)
    color, radius = stage.theme.key_selected, stage.px(SELECTED)
    if stage.selection.count <= MOST:
        t0, t1 = window.time_from_x(x0 - reach), window.time_from_x(x1 + reach)
        for trace, ids in stage.chosen:
            keys = [each.key for each in few_chosen(stage, trace.channel, ids) if t0 <= each.key.time <= t1]
            draw_few(painter, stage, keys, color, radius)
        return
    many = many_selected(stage)
    for trace, ids in many.merged:
        draw_merged(painter, stage, trace, ids, x0, x1)
    if many.marks is not None:
        x, y, which = many.marks
        near = (x >= x0 - reach) & (x <= x1 + reach)
        if not near.all():
            x, y, which = x[near], y[near], which[near]
        atlas, side = atlas_of(color.rgba(), stage.theme.key.rgba(), radius)
        draw_marks(painter, atlas, side, x, y, which)


def many_selected(stage: Stage) -> ManySelected:
    """What there is to be seen of more than a few selected keys; a strip takes its part of it."""
    revisions = tuple([trace.channel.revision for trace, _ in stage.chosen])
    known = stage.many_selected
    if known is not None and known.chosen is stage.chosen and known.revisions == revisions:
        return known
    window, reach = stage.window, stage.px(SELECTED * 2 + CELL)
    t0, t1 = window.time_from_x(window.left - reach), window.time_from_x(window.right + reach)
    merged: list[tuple[Trace, Ids]] = []
    runs: list[Run] = []
    for trace, ids in stage.chosen:
        if stage.manner_of(trace.channel).merged:
            merged.append((trace, ids))
        else:
            runs.append(_seen_of(stage, trace.channel, ids, t0, t1))
    known = stage.many_selected = ManySelected(stage.chosen, revisions, merged, _marks_of(stage, runs))
    return known


def _seen_of(stage: Stage, channel: Channel, ids: Ids, t0: float, t1: float) -> Run:
    """The selected keys of a channel in the window, read once for each change of it."""
    known = stage.seen_keys.get(channel)
    if known is None or known.revision != channel.revision or known.ids is not ids:
        known = stage.seen_keys[channel] = Seen(channel.revision, ids, selected_between(channel, ids, t0, t1))
    return known.run


def _marks_of(stage: Stage, runs: Sequence[Run]) -> Marks | None:
    if not runs:
        return None
    run = _joined(runs)
    if stage.selection.count > MOST_SELECTED:
        run = run[one_a_cell(run, stage)]
    return marks_of(run, stage, stage.px(SELECTED))


def _joined(runs: Sequence[Run]) -> Run:
    # Joining records by numpy's own means compares their fields one by one, each time.
    whole: Run = np.empty(sum(map(len, runs)), KEY_DTYPE)
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
