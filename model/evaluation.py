"""Evaluation of a channel's rows: many times in numpy, one time in Python numbers, bit for bit the same."""

from math import inf, nextafter
from typing import NamedTuple

import numpy as np

from model import hermite
from model.extrapolation import EXTRAPOLATIONS, Ends, Extrapolation, Folded
from model.hermite import LARGEST, Floats
from model.rows import D_TIME, SLOPE_IN, SLOPE_OUT, TIME, VALUE, A, B, C, Rows


class Span(NamedTuple):
    """One span in Python numbers; the last key holds its own time only, with a = b = c = 0."""

    time0: float
    time1: float
    d_time: float
    a: float
    b: float
    c: float
    d: float


def ends_of(rows: Rows) -> Ends:
    """The first and last key; their outward slopes serve linear extrapolation."""
    n = rows.numbers
    last = rows.slot(rows.size - 1)
    return Ends(
        float(n[TIME, 0]),
        float(n[TIME, last]),
        float(n[VALUE, 0]),
        float(n[VALUE, last]),
        float(n[SLOPE_IN, 0]),
        float(n[SLOPE_OUT, last]),
    )


def folded(times: Floats, ends: Ends, pre: Extrapolation, post: Extrapolation) -> tuple[Floats, Floats | None]:
    """Times among the keys with the same values but for the shifts: (times, shifts or None)."""
    inner, shifts = times.copy(), None
    for outside, mode in ((times < ends.time0, pre), (times > ends.time1, post)):
        if not outside.any():
            continue
        fold: Folded = EXTRAPOLATIONS[mode].fold(times[outside], ends)
        inner[outside] = fold.times
        if fold.shifts is not None:
            shifts = np.zeros_like(times) if shifts is None else shifts
            shifts[outside] = fold.shifts
    return inner, shifts


def evaluated(rows: Rows, ends: Ends, times: Floats, pre: Extrapolation, post: Extrapolation) -> Floats:
    """The values at *times* (n,) of a channel that has keys."""
    if len(times) == 0:
        return np.empty(0)
    if times.min() >= ends.time0 and times.max() <= ends.time1:
        return inside(rows, times)
    inner, shifts = folded(times, ends, pre, post)
    values = inside(rows, inner)
    if shifts is not None:
        with np.errstate(all="ignore"):
            values = np.where(shifts != 0.0, hermite.finite(values + shifts), values)
    return values


def inside(rows: Rows, times: Floats) -> Floats:
    """The values at *times* (n,) from the first to the last key; NaN gives NaN."""
    numbers = rows.numbers
    slots = rows.times.searchsorted(times, "right") - 1
    np.maximum(slots, 0, out=slots)
    with np.errstate(all="ignore"):
        u = (times - numbers[TIME].take(slots)) / numbers[D_TIME].take(slots)
        values = numbers[VALUE].take(slots) + u * (
            numbers[C].take(slots) + u * (numbers[B].take(slots) + u * numbers[A].take(slots))
        )
    wild = np.flatnonzero(~np.isfinite(values))
    if len(wild):
        values[wild] = careful(rows, times[wild])
    return values


def careful(rows: Rows, times: Floats) -> Floats:
    """The values at *times* where the coefficients are too large for doubles."""
    slots = rows.real(rows.times.searchsorted(times, "right") - 1)
    n = rows.numbers
    following = np.array([rows.slot(min(int(rank) + 1, rows.size - 1)) for rank in rows.ranks(slots)])
    values = hermite.careful_value(
        times,
        n[TIME][slots],
        n[TIME][following],
        n[VALUE][slots],
        n[VALUE][following],
        n[SLOPE_OUT][slots],
        n[SLOPE_IN][following],
    )
    on_key = (times == n[TIME][slots]) | (following == slots)
    held = (n[A][slots] == 0.0) & (n[B][slots] == 0.0) & (n[C][slots] == 0.0)
    return np.where(np.isnan(times), np.nan, np.where(on_key | held, n[VALUE][slots], values))


def span_at(rows: Rows, time: float) -> Span:
    """The span that *time*, at or after the first key, lies in."""
    rank = rows.rank_at(time) - 1
    time0, value, _, _, a, b, c, d_time = rows.numbers[:, rows.slot(rank)].tolist()
    time1 = float(rows.times[rows.slot(rank + 1)]) if rank + 1 < rows.size else nextafter(time0, inf)
    return Span(time0, time1, d_time, a, b, c, value)


def slopes(rows: Rows, ends: Ends, times: Floats, pre: Extrapolation, post: Extrapolation, *, after: bool) -> Floats:
    """The slopes at *times* (n,), to the right of each (to the left, if not *after*), of a channel with keys."""
    inner, factor, right = times.copy(), np.ones_like(times), np.full(times.shape, after)
    straight = np.full(times.shape, np.nan)
    before_all = (times < ends.time0) if after else (times <= ends.time0)
    after_all = (times >= ends.time1) if after else (times > ends.time1)
    for outside, mode, end_slope in ((before_all, pre, ends.slope0), (after_all, post, ends.slope1)):
        if not outside.any():
            continue
        row = EXTRAPOLATIONS[mode]
        if not row.repeats or ends.period == 0.0:
            straight[outside] = end_slope if mode is Extrapolation.LINEAR else 0.0
            continue
        fold = row.fold(times[outside], ends)
        inner[outside], factor[outside] = fold.times, fold.turns
        right[outside] = (fold.turns > 0.0) == after
    # At a join the curve comes from the end of a copy or goes on from the beginning of the next.
    if ends.period > 0.0:
        inner = np.where(~right & (inner == ends.time0), ends.time1, inner)
        inner = np.where(right & (inner == ends.time1), ends.time0, inner)
    if rows.size == 1:
        return np.where(np.isnan(times), np.nan, np.where(np.isnan(straight), 0.0, straight))
    n = rows.numbers
    slots = np.where(right, rows.times.searchsorted(inner, "right"), rows.times.searchsorted(inner, "left")) - 1
    slots = np.maximum(slots, 0)
    with np.errstate(all="ignore"):
        d_time = n[D_TIME][slots]
        u = np.clip((inner - n[TIME][slots]) / d_time, 0.0, 1.0)
        found = hermite.slope(u, n[A][slots], n[B][slots], n[C][slots], d_time) * factor
    found = np.clip(np.nan_to_num(found, posinf=LARGEST, neginf=-LARGEST), -LARGEST, LARGEST)
    return np.where(np.isnan(times), np.nan, np.where(np.isnan(straight), found, straight))
