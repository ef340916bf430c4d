"""Evaluation of a channel's rows: many times in numpy, one time in Python numbers, bit for bit the same."""

import numpy as np

from model import hermite
from model.extrapolation import EXTRAPOLATIONS, Ends, Extrapolation, Folded
from model.hermite import LARGEST, Floats
from model.keyframe import TangentRule
from model.lookup import AT_A_TIME, Table, merged_slots
from model.rows import D_TIME, RULE_OUT, SLOPE_IN, SLOPE_OUT, TIME, VALUE, A, B, C, Rows, Slots

# Rising times are merged with the keys if there are so many for each slot; a table serves other large sets.
MERGED_TIMES = 16


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


def evaluated(
    rows: Rows, ends: Ends, times: Floats, pre: Extrapolation, post: Extrapolation, table: Table | None
) -> Floats:
    """The values at *times* (n,) of a channel that has keys."""
    if len(times) == 0:
        return np.empty(0)
    if times.min() >= ends.time0 and times.max() <= ends.time1:
        return inside(rows, times, table)
    inner, shifts = folded(times, ends, pre, post)
    values = inside(rows, inner, table)
    if shifts is not None:
        with np.errstate(all="ignore"):
            values = np.where(shifts != 0.0, hermite.finite(values + shifts), values)
    return values


def inside(rows: Rows, times: Floats, table: Table | None) -> Floats:
    """The values at *times* (n,) from the first to the last key; NaN gives NaN."""
    found = np.empty(len(times))
    merging = len(times) > MERGED_TIMES * len(rows.ids) and bool((times[1:] >= times[:-1]).all())
    slots: Slots
    with np.errstate(all="ignore"):
        for at in range(0, len(times), AT_A_TIME):
            part, values = times[at : at + AT_A_TIME], found[at : at + AT_A_TIME]
            if merging:
                first, counts = merged_slots(rows.times, part)
                if len(counts) == 1:
                    _one_span(rows, first, part, values)
                    continue
                slots = np.repeat(np.arange(first, first + len(counts)), counts)
            elif table is not None:
                slots = table.slots(rows.times, part)
            else:
                slots = np.maximum(rows.times.searchsorted(part, "right") - 1, 0)
            _many_spans(rows, slots, part, values)
    return found


def _many_spans(rows: Rows, slots: Slots, times: Floats, values: Floats) -> None:
    """Fill *values*, each time in the span that the key of its slot starts."""
    n = rows.numbers
    u = np.subtract(times, n[TIME].take(slots, mode="clip"))
    u /= n[D_TIME].take(slots, mode="clip")
    n[A].take(slots, out=values, mode="clip")
    for column in (B, C, VALUE):
        values *= u
        values += n[column].take(slots, mode="clip")
    _mend(rows, slots, times, values)


def _one_span(rows: Rows, slot: int, times: Floats, values: Floats) -> None:
    """The same when all times are in one span."""
    n = rows.numbers
    u = np.subtract(times, n[TIME, slot])
    u /= n[D_TIME, slot]
    np.multiply(u, n[A, slot], out=values)
    values += n[B, slot]
    for column in (C, VALUE):
        values *= u
        values += n[column, slot]
    _mend(rows, slot, times, values)


def _mend(rows: Rows, slots: Slots | int, times: Floats, values: Floats) -> None:
    """Work out anew what overflowed, and give keys of value -0.0 their sign back."""
    fine = np.isfinite(values)
    if not fine.all():
        wild = np.flatnonzero(~fine)
        values[wild] = careful(rows, np.broadcast_to(slots, times.shape)[wild], times[wild])
    if rows.minus_zero and not values.all():
        zero = (values == 0.0) & (times == rows.times[slots])
        values[zero] = np.broadcast_to(rows.numbers[VALUE, slots], times.shape)[zero]


def careful(rows: Rows, slots: Slots, times: Floats) -> Floats:
    """The values at *times*, in the spans that the keys of *slots* start, whose numbers are too large for doubles."""
    n = rows.numbers
    spans, time1 = scaled_spans(rows, slots)
    found = spans.value(hermite.places(times, n[TIME][slots], time1))
    at_key = times == n[TIME][slots]
    return np.where(np.isnan(times), np.nan, np.where(at_key, n[VALUE][slots], found))


def scaled_spans(rows: Rows, slots: Slots) -> tuple[hermite.Scaled, Floats]:
    """(the spans that the keys of *slots* start in numbers of size one, the times at which they end)."""
    n = rows.numbers
    ranks = rows.ranks(slots)
    following = rows.slots(np.minimum(ranks + 1, rows.size - 1))
    held = (rows.marks[RULE_OUT][slots] == TangentRule.STEP) | (ranks == rows.size - 1)
    value0, time1 = n[VALUE][slots], np.where(ranks == rows.size - 1, n[TIME][slots] + 1.0, n[TIME][following])
    value1 = np.where(held, value0, n[VALUE][following])
    slope0, slope1 = np.where(held, 0.0, n[SLOPE_OUT][slots]), np.where(held, 0.0, n[SLOPE_IN][following])
    return hermite.scaled(n[TIME][slots], time1, value0, value1, slope0, slope1), time1


def finite_coefficients(rows: Rows, slots: Slots) -> tuple[Floats, Floats, Floats]:
    """(a, b, c) of the spans that the keys of *slots* start; what no double can hold becomes +-LARGEST."""
    a, b, c = (rows.numbers[column][slots] for column in (A, B, C))
    wild = np.flatnonzero(~(np.isfinite(a) & np.isfinite(b) & np.isfinite(c)))
    if len(wild):
        spans, _ = scaled_spans(rows, slots[wild])
        with np.errstate(all="ignore"):
            for column, true in ((a, spans.a), (b, spans.b), (c, spans.c)):
                column[wild] = hermite.finite(np.ldexp(true, spans.exponent))
    return a, b, c


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
        tau, turns, to_right = fold.times, fold.turns, (fold.turns > 0.0) == after
        # Where a copy begins or ends, the curve turns round or goes on at the other end.
        seam = (~to_right & (tau == ends.time0)) | (to_right & (tau == ends.time1))
        if mode is Extrapolation.BOUNCE:
            turns, to_right = np.where(seam, -turns, turns), to_right ^ seam
        else:
            tau = np.where(seam, ends.time0 + ends.time1 - tau, tau)
        inner[outside], factor[outside], right[outside] = tau, turns, to_right
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
