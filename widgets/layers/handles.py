"""Handles: the ends of the tangents of selected keys, at one length on the screen, whatever the zoom."""

from collections.abc import Sequence
from functools import lru_cache
from math import hypot
from typing import Final, NamedTuple

from PySide6.QtCore import QLineF, QPointF
from PySide6.QtGui import QColor, QPainter, QPen

from model.channel import Channel
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule
from model.lines import HUGE
from model.sampling import FAR, Window
from model.selection import Ids
from widgets.chosen import MOST, ChosenKey, few_chosen, with_neighbours
from widgets.graph import Spot
from widgets.layers.keys import SELECTED
from widgets.layers.selected_keys import many_selected, selected_between
from widgets.stage import Stage
from widgets.traces import Trace

LENGTH: Final = 48.0
KNOB: Final = 3.5


type Box = tuple[float, float, float, float]  # left, top, right, bottom


class Handles(NamedTuple):
    """A key's place and the ends of its handles in pixels; a side without one is None."""

    key: Spot
    into: Spot | None
    out: Spot | None
    broken: bool
    id: int

    @property
    def box(self) -> Box:
        """What lies between the ends."""
        (x, y), (x0, y0), (x1, y1) = self.key, self.into or self.key, self.out or self.key
        return min(x, x0, x1), min(y, y0, y1), max(x, x0, x1), max(y, y0, y1)


class Hands(NamedTuple):
    """The handles of a few keys of a channel with the times of these, and when they were worked out."""

    revision: int
    ids: Ids
    every: list[tuple[float, Handles]]


def handles_of(chosen: ChosenKey, channel: Channel, window: Window) -> Handles:
    """The handles of one key: only where a slope has a say in the curve."""
    key, before, after = chosen
    x = min(max(window.x_from_time(key.time), -FAR), FAR)
    y = min(max(window.y_from_value(key.value), -FAR), FAR)
    has_in = channel.pre is Extrapolation.LINEAR if before is None else before.rule_out != TangentRule.STEP
    has_out = key.rule_out != TangentRule.STEP and (after is not None or channel.post is Extrapolation.LINEAR)
    into = out = None
    if has_in:
        dx, dy = _arm(key.slope_in, window)
        into = (x - dx, y - dy)
    if has_out:
        dx, dy = _arm(key.slope_out, window)
        out = (x + dx, y + dy)
    return Handles((x, y), into, out, key.broken, key.id)


def _arm(slope: float, window: Window) -> tuple[float, float]:
    """From a key to the end of its handle out, in pixels."""
    fall = min(max(-slope * (window.px_per_value / window.px_per_second), -HUGE), HUGE)
    size = hypot(1.0, fall)
    length = LENGTH * window.unit
    return length / size, length * (fall / size)


def shown_handles(stage: Stage, only: Channel | None = None) -> list[tuple[Trace, Handles]]:
    """The handles of all selected keys in view, or *only* of one channel; none if they are too many to tell apart."""
    window = stage.window
    margin = LENGTH * window.unit
    t0, t1 = window.time_from_x(window.left - margin), window.time_from_x(window.right + margin)
    if stage.selection.count <= MOST:
        return [
            (trace, handles)
            for trace, ids in stage.chosen
            if not trace.channel.locked and (only is None or trace.channel is only)
            for time, handles in few_handles(stage, trace.channel, ids)
            if t0 <= time <= t1
        ]
    many = many_selected(stage)
    if stage.many_handles is None or stage.many_handles[0] is not many:
        stage.many_handles = many, _handles_among_many(stage, t0, t1)
    return [each for each in stage.many_handles[1] if only is None or each[0].channel is only]


def _handles_among_many(stage: Stage, t0: float, t1: float) -> list[tuple[Trace, Handles]]:
    chosen = [(trace, ids) for trace, ids in stage.chosen if not trace.channel.locked]
    # As many as there are at least, which is soon told.
    if sum(max(len(ids) - len(t.channel) + t.channel.count_between(t0, t1), 0) for t, ids in chosen) > MOST:
        return []
    seen = [(trace, selected_between(trace.channel, ids, t0, t1)["id"].tolist()) for trace, ids in chosen]
    if sum(len(ids) for _, ids in seen) > MOST:
        return []
    return [
        (trace, handles_of(with_neighbours(trace.channel, key_id), trace.channel, stage.window))
        for trace, ids in seen
        for key_id in ids
    ]


def few_handles(stage: Stage, channel: Channel, ids: Ids) -> list[tuple[float, Handles]]:
    """The times and handles of the selected keys *ids*, which are few; those that are gone are left out."""
    known = stage.hands.get(channel)
    if known is None or known.revision != channel.revision or known.ids is not ids:
        chosen = few_chosen(stage, channel, ids)
        every = [(each.key.time, handles_of(each, channel, stage.window)) for each in chosen]
        known = stage.hands[channel] = Hands(channel.revision, ids, every)
    return known.every


def draw_handles(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """Thin lines with round ends: filled where both sides turn together, hollow where they turn apart."""
    theme = stage.theme
    reach = stage.px(LENGTH + 2 * KNOB)
    every = shown_handles(stage)
    stage.arms = {}
    for trace, handles in every:
        stage.arms.setdefault(trace.channel, []).append(handles.box)
    shown = [each for each in every if x0 - reach <= each[1].key[0] <= x1 + reach]
    if not shown:
        return
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
    painter.setPen(_pen(theme.handle_line.rgba(), stage.px(1.2)))
    gap = SELECTED / LENGTH  # how much of the arm its key's mark covers
    for _, handles in shown:
        x, y = handles.key
        for end in (handles.into, handles.out):
            if end is not None:
                painter.drawLine(QLineF(x + (end[0] - x) * gap, y + (end[1] - y) * gap, *end))
    painter.setPen(_pen(theme.handle.rgba(), stage.px(1.4)))
    radius = stage.px(KNOB)
    for _, handles in shown:
        painter.setBrush(theme.background if handles.broken else theme.handle)
        for end in (handles.into, handles.out):
            if end is not None:
                painter.drawEllipse(QPointF(*end), radius, radius)


@lru_cache(maxsize=64)
def _pen(color: int, width: float) -> QPen:
    return QPen(QColor.fromRgba(color), width)
