"""Curve: the values that keys in rows stand for; what a channel is to the eye and to the player."""

from bisect import bisect_right
from collections.abc import Buffer, Callable
from math import inf, nextafter
from typing import NamedTuple, cast

import numpy as np
from numpy.typing import ArrayLike

from model import envelope, evaluation, extremes
from model.extrapolation import EXTRAPOLATIONS, Ends, Extrapolation
from model.hermite import LARGEST, Floats
from model.likeness import Extent
from model.lookup import DOUBLE, SLOTS_A_TIME, TABLE_TIMES, Table, span_struct
from model.rows import D_TIME, TIME, VALUE, A, B, C, Rows

# One span in Python numbers: (time0, time1, d, a, b, c); the last key holds its own time only.
type Span = tuple[float, float, float, float, float, float]

_NOWHERE: Span = (inf, -inf, 0.0, 0.0, 0.0, 0.0)
_SPAN_COLUMNS = [D_TIME, A, B, C]
# Channels of up to so many keys keep their times and spans as Python numbers once values are asked for.
_KEPT_SPANS = 4096
# A search for one value takes about as long as the making of a table for so many slots. So a longer channel gets one
# once its searches have taken as long as that: whatever is asked then, it was no more than twice the least possible.
_SLOTS_A_SEARCH = 256
# How far a value is looked for behind the place that the table gives.
_STEPS = 8

type _Read = Callable[[Buffer, int], Span]
# What reads a span, the columns it reads, and of the table its places there in bytes, its start, its buckets a second;
# the last key's time.
type _Seekable = tuple[_Read, Buffer, "memoryview[int]", float, float, float]

_NOT_YET: _Seekable = (cast("_Read", span_struct(2).unpack_from), b"", memoryview(b"").cast("i"), inf, 0.0, -inf)


class Spans(NamedTuple):
    """Neighbouring spans as columns of shape (n,): value = d + u (c + u (b + u a)), u from 0 to 1."""

    time0: Floats
    time1: Floats
    a: Floats
    b: Floats
    c: Floats
    d: Floats


class Curve:
    """A curve through keys that somebody else changes, with an extrapolation on each side.

    What it keeps to answer quickly follows from the rows alone and is dropped by `_changed`.
    """

    def __init__(self, pre: Extrapolation, post: Extrapolation) -> None:
        self.pre, self.post = Extrapolation(pre), Extrapolation(post)
        self.revision = 0  # grows at each change
        self._rows = Rows()
        self._ends: Ends | None = None
        self._whole_range: tuple[float, float] | None = None  # from the first to the last key
        self._table: Table | None = None
        self._extremes: extremes.Extremes | None = None
        self._hit = _NOWHERE
        self._searched = 0
        self._seekable = _NOT_YET
        # All times of a short channel, and those of its spans that were asked for; at the end one that is nowhere.
        self._times_kept: list[float] = []
        self._spans_kept = [_NOWHERE]

    def __len__(self) -> int:
        return self._rows.size

    def _changed(self) -> None:
        self.revision += 1
        self._ends = self._table = self._whole_range = None
        self._hit = _NOWHERE
        self._searched, self._seekable = 0, _NOT_YET
        self._times_kept, self._spans_kept = [], [_NOWHERE]

    def _the_ends(self) -> Ends:
        if self._ends is None:
            self._ends = evaluation.ends_of(self._rows)
        return self._ends

    def ends(self) -> Ends | None:
        """Times, values and outward slopes of the first and last key; None without keys."""
        return self._the_ends() if len(self) else None

    def evaluate(self, times: ArrayLike) -> Floats:
        """The values at *times* (seconds, any shape); NaN in, NaN out, every finite time gives a finite value."""
        array = np.asarray(times, np.float64)
        flat = np.ascontiguousarray(array).reshape(-1)
        if len(self) == 0:
            return np.where(np.isnan(array), np.nan, 0.0)
        table = self._table_for(len(flat))
        return evaluation.evaluated(self._rows, self._the_ends(), flat, self.pre, self.post, table).reshape(array.shape)

    def _table_for(self, times: int) -> Table | None:
        """A table that finds that many times, if it is worth its making."""
        if times < TABLE_TIMES or SLOTS_A_TIME * times < len(self._rows.ids):
            return None
        if self._table is None:
            self._table = Table(self._rows)
        return self._table if self._table.usable else None

    def value(self, time: float) -> float:
        """The value at one time, bit for bit that of `evaluate`."""
        if type(time) is not float:
            time = float(time)
        span = self._hit
        # The ways to find a span are written out here: a call more would cost a tenth of the whole.
        if not span[0] <= time < span[1]:
            if self._times_kept:
                # Before the first key this is the last entry, in which no time is.
                span = self._spans_kept[bisect_right(self._times_kept, time) - 1]
                known = span[0] <= time < span[1]
            else:
                read, columns, places, start, per_second, end = self._seekable
                known = start <= time < end
                if known:
                    # As Table.slots finds many: one of the next few, or else by bisection.
                    place = places[int((time - start) * per_second)]
                    span = read(columns, place)
                    if span[1] <= time:
                        span = read(columns, place + DOUBLE)
                        if span[1] <= time:
                            span = _further(time, read, columns, place)
                            known = span is not _NOWHERE
            if not known:
                found = self._search(time)
                if found is None:
                    return self._value_outside(time)
                span = found
            self._hit = span
        time0, time1, d, a, b, c = span
        u = (time - time0) / (time1 - time0)
        value = d + u * (c + u * (b + u * a))
        if value and value - value == 0.0:
            return value
        return self._careful_value(time, value, span)

    def _careful_value(self, time: float, value: float, span: Span) -> float:
        """*value* at *time*, which is 0 or no number, as `evaluate` gives it."""
        if value == 0.0:
            return span[2] if time == span[0] else value
        slot = self._rows.slot(self._rows.rank_at(time) - 1)
        return float(evaluation.careful(self._rows, np.array([slot]), np.array([time]))[0])

    def _value_outside(self, time: float) -> float:
        """The value before the first or after the last key, without keys, or at NaN."""
        if time != time or not len(self):
            return time if time != time else 0.0
        ends = self._the_ends()
        inner, shift = EXTRAPOLATIONS[self.pre if time < ends.time0 else self.post].fold_one(time, ends)
        value = self.value(inner)
        return min(max(value + shift, -LARGEST), LARGEST) if shift else value

    def _search(self, time: float) -> Span | None:
        """The span that *time* lies in, by bisection; None outside the keys.

        Short channels keep what they found; long ones get a table for the next times.
        """
        rows = self._rows
        if not rows.size or not rows.times[0] <= time <= rows.times[-1]:
            return None
        rank = rows.rank_at(time) - 1
        slot = rows.slot(rank)
        time0, value, _, _, a, b, c, _ = rows.numbers[:, slot].tolist()
        time1 = float(rows.times[rows.slot(rank + 1)]) if rank + 1 < rows.size else nextafter(time0, inf)
        span = (time0, time1, value, a, b, c)
        if rows.size <= _KEPT_SPANS:
            if not self._times_kept:
                self._spans_kept = [_NOWHERE] * (rows.size + 1)
                self._times_kept = rows.times[rows.slots(np.arange(rows.size))].tolist()
            self._spans_kept[rank] = span
        elif self._seekable is _NOT_YET:
            self._searched += _SLOTS_A_SEARCH
            if self._searched > len(rows.ids):
                self._make_seekable()
        return span

    def _make_seekable(self) -> None:
        """Get ready to read spans straight out of the rows, which the table of `evaluate` finds."""
        rows = self._rows
        table = self._table = self._table or Table(rows)
        if table.usable:
            read = cast("_Read", span_struct(len(rows.ids)).unpack_from)
            columns, places = memoryview(rows.numbers).cast("B"), memoryview(table.last * np.int32(DOUBLE))
            self._seekable = read, columns, places, table.start, table.per_second, float(rows.times[-1])

    def slopes(self, times: ArrayLike, side: str = "out") -> Floats:
        """The slopes at *times* in value per second; at a corner the one to the right ("out") or left ("in")."""
        if side not in ("in", "out"):
            raise ValueError(f"side is {side!r}; it can be 'in' or 'out'")
        array = np.asarray(times, np.float64)
        if len(self) == 0:
            return np.where(np.isnan(array), np.nan, 0.0)
        flat = np.ascontiguousarray(array).reshape(-1)
        found = evaluation.slopes(self._rows, self._the_ends(), flat, self.pre, self.post, after=side == "out")
        return found.reshape(array.shape)

    def slope(self, time: float, side: str = "out") -> float:
        """The slope at one time."""
        return float(self.slopes(time, side))

    def span_at(self, time: float) -> tuple[float, float, float, float, float, float] | None:
        """(t0, t1, a, b, c, d) of the span *time* lies in; None outside the keys."""
        rank = min(self._rows.rank_at(time), len(self) - 1) - 1
        if rank < 0 or time > self._the_ends().time1 or time < self._the_ends().time0:
            return None
        spans = self._spans(rank, rank + 1)
        return tuple(float(column[0]) for column in spans)  # type: ignore[return-value]  # as many as there are columns

    def _spans(self, rank0: int, rank1: int) -> Spans:
        numbers = self._rows.columns(rank0, rank1 + 1, stop=C + 1)
        times, (a, b, c) = numbers[TIME], numbers[A : C + 1, :-1]
        if not np.isfinite(numbers[A : C + 1, :-1]).all():
            a, b, c = evaluation.finite_coefficients(self._rows, self._rows.slots(np.arange(rank0, rank1)))
        return Spans(times[:-1], times[1:], a, b, c, numbers[VALUE, :-1])

    def spans_from(self, time: float, most: int) -> Floats:
        """(time0, time1, d_time, a, b, c, d) of neighbouring spans: (7, n), 1 <= n <= *most*.

        The first is the one that *time*, which must lie among the keys, is in; the last key counts as a span that
        holds its own time only. Numbers too large for doubles are inf or NaN.
        """
        rows = self._rows
        row, place = rows.place(rows.rank_at(time) - 1)
        held = rows.held(row)
        end = min(place + most, held)
        line = rows.number_grid[:, row]
        spans = np.empty((7, end - place))
        spans[0], spans[2:6], spans[6] = line[TIME, place:end], line[_SPAN_COLUMNS, place:end], line[VALUE, place:end]
        spans[1, :-1] = spans[0, 1:]
        if end < held:
            spans[1, -1] = line[TIME, end]
        else:
            spans[1, -1] = rows.starts[row + 1] if row + 1 < rows.rows else nextafter(float(spans[0, -1]), inf)
        return spans

    def spans_between(self, t0: float, t1: float) -> Spans:
        """The spans that touch [t0, t1]."""
        ends = self.ends()
        if ends is not None and t0 < ends.time0 and ends.time1 < t1:
            return self._spans(0, len(self) - 1)
        rank0 = max(self._rows.rank_at(t0, after=False) - 1, 0)
        rank1 = min(self._rows.rank_at(t1), len(self) - 1)
        return self._spans(rank0, rank1) if rank1 > rank0 else Spans(*np.empty((6, 0)))

    def extrema(self, t0: float | None = None, t1: float | None = None) -> tuple[float, float]:
        """The lowest and highest value over [t0, t1], by default from the first to the last key."""
        if len(self) == 0:
            return 0.0, 0.0
        whole = t0 is None and t1 is None
        if whole and self._whole_range is not None:
            return self._whole_range
        if whole and self._rows.rows == 1:
            self._whole_range = extremes.whole(self._rows)
            return self._whole_range
        ends = self._the_ends()
        edges = np.array([ends.time0 if t0 is None else t0, ends.time1 if t1 is None else t1])
        lowest, highest = self.envelope(edges)
        found = float(lowest[0]), float(highest[0])
        if whole:
            self._whole_range = found
        return found

    def envelope(self, edges: ArrayLike) -> tuple[Floats, Floats]:
        """Lowest and highest value of the curve in each [edges[j], edges[j + 1]], extrapolation included: (n - 1,)."""
        array = np.asarray(edges, np.float64)
        if len(self) == 0:
            return np.zeros(max(len(array) - 1, 0)), np.zeros(max(len(array) - 1, 0))
        return envelope.envelope(self._rows, self._the_extremes(), self._the_ends(), array, self.pre, self.post)

    def _the_extremes(self) -> extremes.Extremes:
        if self._extremes is None or self._extremes.shape != self._rows.number_grid.shape:
            self._extremes = extremes.Extremes(self._rows)
        elif self._extremes.numbers is not self._rows.numbers:
            self._extremes.begin(self._rows)
        return self._extremes

    def _prepare_extremes(self, extent: Extent) -> None:
        """Look at all keys, of this extent, before others are made of them again and again."""
        self._the_extremes().prepare(self._rows, extent)


def _further(time: float, read: _Read, columns: Buffer, place: int) -> Span:
    """The span that *time* lies in, if it is one of the next few behind *place*; else _NOWHERE."""
    for step in range(2, _STEPS):
        span = read(columns, place + step * DOUBLE)
        if time < span[1]:
            return span
    return _NOWHERE
