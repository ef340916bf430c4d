"""The exact range of a curve in each column of a picture, whatever the number of keys.

A column is its two edges, the turns of the two spans that its edges cut, and the spans between (model/extremes.py).
"""

from typing import NamedTuple

import numpy as np

from model import evaluation, hermite
from model.extrapolation import EXTRAPOLATIONS, Ends, Extrapolation, periods
from model.extremes import Extremes, turns_of
from model.hermite import LARGEST, Floats
from model.keyframe import TangentRule
from model.rows import D_TIME, RULE_OUT, VALUE, A, Rows, Slots
from model.suspects import Range


class Points(NamedTuple):
    """Places on the curve where columns begin or end."""

    next_slot: Slots  # the slot behind those of the key at or before
    slot: Slots  # of the key at or before
    u: Floats
    value: Floats
    key_value: Floats
    turns: Floats  # (2, n): u where the span turns
    turn_values: Floats

    def at(self, part: slice) -> "Points":
        """Some of them."""
        next_slot, slot, u, value, key_value, turns, turn_values = self
        several = (turns[:, part], turn_values[:, part])
        return Points(next_slot[part], slot[part], u[part], value[part], key_value[part], *several)


def _points(rows: Rows, times: Floats) -> Points:
    slots = np.maximum(rows.times.searchsorted(times, "right") - 1, 0)
    key_times, keys = rows.numbers[: VALUE + 1].take(slots, axis=1)
    a, b, c, d_times = numbers = rows.numbers[A : D_TIME + 1].take(slots, axis=1)
    turns, turn_values = turns_of(rows, slots, numbers[:3], keys)
    with np.errstate(all="ignore"):
        u = (times - key_times) / d_times
        values = a * u
        values += b
        values *= u
        values += c
        values *= u
        values += keys
    if not (np.isfinite(u).all() and np.isfinite(values).all()):
        wild = np.flatnonzero(~np.isfinite(u))
        if len(wild):
            real = rows.real(slots[wild])
            u[wild] = hermite.places(times[wild], rows.times[real], evaluation.scaled_spans(rows, real)[1])
        values = evaluation.inside(rows, times, None)
    return Points(slots + 1, rows.real(slots), u, values, keys, turns, turn_values)


def _ranges(rows: Rows, extremes: Extremes, begins: Points, ends: Points) -> Range:
    """The ranges from the points *begins* to the points *ends*, pair by pair."""
    low, high = np.minimum(begins.value, ends.value), np.maximum(begins.value, ends.value)
    one_span = begins.slot == ends.slot
    # A turn counts if it lies behind the beginning (of the same span) and before the end (of the same span).
    for points, behind, before in (
        (begins, begins.u, np.where(one_span, ends.u, 1.0)),
        (ends, 0.0, np.where(one_span, 0.0, ends.u)),
    ):
        seen = (points.turns > behind) & (points.turns < before)
        if seen.any():
            values = points.turn_values
            low = np.minimum(low, np.minimum.reduce(np.where(seen, values, np.inf)))
            high = np.maximum(high, np.maximum.reduce(np.where(seen, values, -np.inf)))
    key = np.where(one_span, low, ends.key_value)
    low, high = np.minimum(low, key), np.maximum(high, key)
    if len(one_span) and not one_span.all():
        extremes.refresh(rows, int(begins.slot.min()), int(ends.slot.max()))
        within = extremes.between(rows, begins.next_slot, np.where(one_span, begins.next_slot, ends.slot))
        low, high = np.minimum(low, within[0]), np.maximum(high, within[1])
    return low, high


def between(rows: Rows, extremes: Extremes, times0: Floats, times1: Floats) -> Range:
    """The ranges over [times0[j], times1[j]], all of them from the first to the last key."""
    n = len(times0)
    points = _points(rows, np.concatenate([times0, times1]))
    return _ranges(rows, extremes, points.at(slice(0, n)), points.at(slice(n, 2 * n)))


def envelope(
    rows: Rows, extremes: Extremes, ends: Ends, edges: Floats, pre: Extrapolation, post: Extrapolation
) -> Range:
    """(lowest, highest) of the curve in each [edges[j], edges[j + 1]]."""
    if len(edges) < 2:
        return np.empty(0), np.empty(0)
    if edges[0] >= ends.time0 and edges[-1] <= ends.time1:
        points = _points(rows, edges)
        return _ranges(rows, extremes, points.at(slice(0, -1)), points.at(slice(1, None)))
    low, high = np.full(len(edges) - 1, np.inf), np.full(len(edges) - 1, -np.inf)
    left, right = edges[:-1], edges[1:]
    some = (right >= ends.time0) & (left <= ends.time1)
    if some.any():
        begins, stops = np.maximum(left[some], ends.time0), np.minimum(right[some], ends.time1)
        low[some], high[some] = between(rows, extremes, begins, stops)
    for some, mode, begins, stops in (
        (left < ends.time0, pre, left, np.minimum(right, ends.time0)),
        (right > ends.time1, post, np.maximum(left, ends.time1), right),
    ):
        if some.any():
            found = _outside(rows, extremes, ends, mode, begins[some], stops[some])
            low[some], high[some] = np.minimum(low[some], found[0]), np.maximum(high[some], found[1])
    return low, high


def _outside(rows: Rows, extremes: Extremes, ends: Ends, mode: Extrapolation, times0: Floats, times1: Floats) -> Range:
    """The ranges over [times0[j], times1[j]], all on one side of the keys."""
    row = EXTRAPOLATIONS[mode]
    if not row.repeats or ends.period == 0.0:
        # Straight lines: their ends are enough.
        pair = [evaluation.evaluated(rows, ends, times, mode, mode, None) for times in (times0, times1)]
        return np.minimum(*pair), np.maximum(*pair)
    copies0, rests0 = periods(times0, ends)
    copies1, rests1 = periods(times1, ends)
    inside_one = copies0 == copies1
    low, high = np.full(len(times0), np.inf), np.full(len(times0), -np.inf)
    n = len(times0)
    everything = np.arange(n)
    # From the beginning to its copy's end (or to the end itself), and from the last copy's beginning to the end.
    pieces = [
        (everything, copies0, rests0, np.where(inside_one, rests1, np.inf)),
        (np.flatnonzero(~inside_one), copies1[~inside_one], np.zeros(int((~inside_one).sum())), rests1[~inside_one]),
    ]
    # Whole copies between: the first and the last of them, since what a copy is shifted by grows from one to the next.
    whole = np.flatnonzero(copies1 - copies0 > 1.5)
    for copies in (copies0[whole] + 1.0, copies1[whole] - 1.0):
        pieces.append((whole, copies, np.zeros(len(whole)), np.full(len(whole), np.inf)))
    for place, copies, begins, stops in pieces:
        if len(place):
            found = _in_copies(rows, extremes, ends, mode, copies, begins, stops)
            low[place], high[place] = np.minimum(low[place], found[0]), np.maximum(high[place], found[1])
    return low, high


def _in_copies(
    rows: Rows, extremes: Extremes, ends: Ends, mode: Extrapolation, copies: Floats, begins: Floats, stops: Floats
) -> Range:
    """The ranges from *begins* to *stops* seconds after the beginning of each copy; inf is the copy's end."""
    to_end = np.isinf(stops)
    if mode is Extrapolation.BOUNCE:
        mirrored = np.fmod(copies, 2.0) != 0.0
        times0 = np.where(mirrored, np.where(to_end, ends.time0, ends.time1 - stops), ends.time0 + begins)
        times1 = np.where(mirrored, ends.time1 - begins, np.where(to_end, ends.time1, ends.time0 + stops))
    else:
        # The value of the last key shows at the very end of the keys only, unless the curve leads up to it.
        end = ends.time1
        if rows.size > 1 and rows.marks[RULE_OUT, rows.slot(rows.size - 2)] == TangentRule.STEP:
            end = float(np.nextafter(end, -np.inf))
        times0 = np.minimum(ends.time0 + begins, end)
        times1 = np.where(to_end, end, np.minimum(ends.time0 + stops, end))
    times0, times1 = np.clip(times0, ends.time0, ends.time1), np.clip(times1, ends.time0, ends.time1)
    low, high = between(rows, extremes, np.minimum(times0, times1), times1)
    if mode is Extrapolation.CYCLE_OFFSET:
        with np.errstate(all="ignore"):
            shifts = copies * min(max(ends.value1 - ends.value0, -LARGEST), LARGEST)
            low, high = hermite.finite(low + shifts), hermite.finite(high + shifts)
    return low, high
