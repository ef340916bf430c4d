"""The lowest and highest values of spans and blocks of spans, exact however few of them are worked out.

Inside a span the curve turns at most twice. A span whose control points lie within the range of the keys around it
adds nothing to that range, and so its turns need not be worked out.
"""

from collections.abc import Sequence
from itertools import batched
from math import inf, nan

import numpy as np
from numpy.typing import NDArray

from model import evaluation, hermite
from model.hermite import Floats
from model.likeness import Extent, Likeness
from model.rows import VALUE, A, B, C, Rows, Slots
from model.suspects import Known, Range, key_ranges, safe, suspects

BLOCK = 64
# What is left of a block at the end of a column is read in smaller ones.
FINE = 8
# Rows handled at a time: a few of their columns stay in the processor's cache.
AT_A_TIME = 64
# Up to so many spans, those between two pairs of ends and behind the last included, one pass is quicker than blocks.
DIRECT = 20_000
# Up to so many spans all are worked out at once; of more, the columns of a picture begin and end among few.
EACH = 1 << 18
# If more than one row in so many has changed, all are looked at as what a drag has made of others.
MOST_STALE = 3
# Of up to so many rows all spans are worked out at once too: that takes no longer than to look for those that count.
FEW = 4


class Extremes:
    """The lowest and highest values of all spans and blocks of one channel's rows, worked out when asked for.

    A block needs few of its spans; the others of a long channel follow when a column begins or ends among them.
    Spare slots count as keys without a span in the ranges of blocks.
    """

    def __init__(self, rows: Rows) -> None:
        self.shape = rows.number_grid.shape
        self.block = min(BLOCK, rows.width)
        self.each = len(rows.ids) <= EACH
        self.fine = min(FINE, self.block)
        n = len(rows.ids)
        # Behind the spans the small blocks, so that both are found in one pass.
        self._lows, self._highs = both = np.empty((2, n + n // self.fine))
        (self.low, self.high), (self.fine_low, self.fine_high) = both[:, :n], both[:, n:]
        self.block_low, self.block_high = np.empty((2, len(rows.ids) // self.block))
        self.known = np.zeros(len(self.block_low), np.bool_)  # the blocks whose spans are worked out too
        self._room = np.empty((3, min(rows.rows, AT_A_TIME) * rows.width))
        self._made_of: Known | None = None
        self.begin(rows)

    def begin(self, rows: Rows) -> None:
        """Forget everything: these are other rows, of the same shape."""
        self.numbers = rows.numbers
        self.known[:] = False
        rows.dirty = set(range(rows.rows))

    def refresh(self, rows: Rows, slot0: int, slot1: int) -> None:
        """Work out anew the rows from slot0 to slot1 that have changed."""
        row0, row1 = slot0 // rows.width, slot1 // rows.width + 1
        stale = sorted(rows.dirty.intersection(range(row0, row1)) if len(rows.dirty) > 1 else rows.dirty)
        if self.each or len(stale) <= FEW:
            for some in _parts(stale):
                self._measure(rows, some)
        else:
            with np.errstate(all="ignore"):
                slots = self._measure_made(rows, rows.likeness) if MOST_STALE * len(stale) > rows.rows else None
                if slots is None:
                    slots = np.concatenate([self._measure_keys(rows, some) for some in _parts(stale)])
                else:
                    stale = sorted(rows.dirty)
                self.known.reshape(-1, rows.width // self.block)[stale] = False
                self._widen(rows, slots)
        rows.dirty.difference_update(stale)

    def _measure(self, rows: Rows, some: Slots) -> None:
        """Work out the ranges of all spans of some rows, and of their blocks."""
        low, high = self._measure_spans(rows, some, rows.width)
        in_blocks, blocks = (len(some), -1, self.block // self.fine), (-1, rows.width // self.block)
        self.block_low.reshape(blocks)[some] = low.reshape(in_blocks).min(axis=2)
        self.block_high.reshape(blocks)[some] = high.reshape(in_blocks).max(axis=2)
        self.known.reshape(blocks)[some] = True

    def _measure_spans(self, rows: Rows, some: Slots, size: int) -> Range:
        """Work out the ranges of the spans in some lines of *size* slots, and of their small blocks; give these."""
        low, high = _span_ranges(rows, some, size)
        self.low.reshape(-1, size)[some], self.high.reshape(-1, size)[some] = low, high
        begins, shape = np.arange(0, low.size, self.fine), (-1, size // self.fine)
        low = np.minimum.reduceat(low.reshape(-1), begins).reshape(shape)
        high = np.maximum.reduceat(high.reshape(-1), begins).reshape(shape)
        self.fine_low.reshape(shape)[some], self.fine_high.reshape(shape)[some] = low, high
        return low, high

    def _measure_keys(self, rows: Rows, some: Slots) -> Slots:
        """Set the ranges of the blocks of some rows to those of their keys; the slots of spans that may leave them."""
        low, high = key_ranges(rows, rows.number_grid, some, self.block)
        blocks = (-1, rows.width // self.block)
        self.block_low.reshape(blocks)[some] = low.reshape(len(some), -1)
        self.block_high.reshape(blocks)[some] = high.reshape(len(some), -1)
        return suspects(rows, rows.number_grid, some, safe(low, high), self._room)

    def _measure_made(self, rows: Rows, likeness: Likeness | None) -> Slots | None:
        """The same for all rows, from what is known of those they are made of; None if that does not do."""
        if likeness is None:
            return None
        made = self._origin(rows, likeness.origin, likeness.extent).made(likeness)
        if made is None:
            return None
        self.block_low[:], self.block_high[:], slots = made
        return slots

    def prepare(self, rows: Rows, extent: Extent) -> None:
        """Look at *rows*, of this extent, before others are made of them again and again."""
        if not self.each:
            self._origin(rows, rows.number_grid, extent)

    def _origin(self, rows: Rows, origin: Floats, extent: Extent) -> Known:
        """What is known of the rows of this extent; *rows* have the same shape."""
        if self._made_of is None or self._made_of.extent is not extent:
            self._made_of = Known.of(rows, origin, extent, self.block, _parts(range(rows.rows)), self._room)
        return self._made_of

    def _widen(self, rows: Rows, slots: Slots) -> None:
        """Have the turns of these spans in the ranges of their blocks."""
        slots = slots[_may_turn(*(rows.numbers[column].take(slots) for column in (A, B, C)))]
        values, block = turns_of(rows, slots)[1], slots // self.block
        np.fmin.at(self.block_low, block, np.fmin(values[0], values[1]))
        np.fmax.at(self.block_high, block, np.fmax(values[0], values[1]))

    def between(self, rows: Rows, starts: Slots, ends: Slots) -> Range:
        """The ranges over the slots from *starts* up to before *ends*, pair by pair; (inf, -inf) over none."""
        if self.each:
            cuts = np.minimum(np.stack([starts, ends], axis=1).reshape(-1), len(rows.ids) - 1)
            passed = int(np.maximum(cuts[1:] - cuts[:-1], 0).sum())
            if passed + len(self.low) <= DIRECT:
                low, high = np.minimum.reduceat(self.low, cuts)[::2], np.maximum.reduceat(self.high, cuts)[::2]
                none = starts >= ends
                low[none], high[none] = inf, -inf
                return low, high
        size = self.block
        first, last = -(-starts // size), ends // size
        cuts = np.empty((len(starts), 2), np.int64)
        np.minimum(first, len(self.block_low) - 1, out=cuts[:, 0])
        np.minimum(last, len(self.block_low) - 1, out=cuts[:, 1])
        cuts = cuts.reshape(-1)
        low, high = np.minimum.reduceat(self.block_low, cuts)[::2], np.maximum.reduceat(self.block_high, cuts)[::2]
        none = first >= last
        if none.any():
            low[none], high[none] = inf, -inf
        # What is left at both ends is shorter than a block, and adds nothing where all of its block lies within.
        begin = np.concatenate([starts, np.maximum(starts, last * size)])
        end = np.concatenate([np.minimum(ends, first * size), ends])
        block = np.minimum(begin // size, len(self.block_low) - 1)
        outside = (self.block_low.take(block).reshape(2, -1) < low) | (
            self.block_high.take(block).reshape(2, -1) > high
        )
        (some,) = ((begin < end) & outside.reshape(-1)).nonzero()
        if len(some):
            self._know(rows, block.take(some))
            left = self._within_blocks(begin.take(some), end.take(some))
            lows, highs = np.full((2, len(starts)), inf), np.full((2, len(starts)), -inf)
            lows.reshape(-1)[some], highs.reshape(-1)[some] = left
            low, high = np.minimum(low, lows, out=lows), np.maximum(high, highs, out=highs)
            return np.minimum(low[0], low[1]), np.maximum(high[0], high[1])
        return low, high

    def _within_blocks(self, begins: Slots, ends: Slots) -> Range:
        """The ranges over the slots from *begins* up to before *ends*, which lie within known blocks, one at least."""
        fine0, fine1 = -(-begins // self.fine), ends // self.fine
        # Spans up to the first whole small block, such blocks, and the spans behind them.
        runs = np.empty((len(begins), 3), np.int64)
        counts = np.empty_like(runs)
        runs[:, 0], runs[:, 1] = begins, fine0 + len(self.low)
        behind = np.minimum(fine0 * self.fine, ends)
        np.subtract(behind, begins, out=counts[:, 0])
        np.maximum(fine1 - fine0, 0, out=counts[:, 1])
        np.maximum(behind, fine1 * self.fine, out=runs[:, 2])
        np.subtract(ends, runs[:, 2], out=counts[:, 2])
        lengths = counts.reshape(-1)
        firsts = lengths.cumsum() - lengths
        places = (runs.reshape(-1) - firsts).repeat(lengths)
        places += np.arange(len(places))
        firsts = firsts[::3]
        lows, highs = self._lows.take(places), self._highs.take(places)
        return np.minimum.reduceat(lows, firsts), np.maximum.reduceat(highs, firsts)

    def _know(self, rows: Rows, blocks: Slots) -> None:
        """Have the ranges of all spans of these blocks."""
        wanted = blocks[~self.known.take(blocks)]
        if not len(wanted):
            return
        wanted = np.unique(wanted)
        for some in np.array_split(wanted, len(wanted) * self.block // (AT_A_TIME * rows.width) + 1):
            self._measure_spans(rows, some, self.block)
        self.known[wanted] = True


def _parts(rows: Sequence[int]) -> list[Slots]:
    """*rows*, so many at a time."""
    return [np.array(few) for few in batched(rows, AT_A_TIME)]


def _may_turn(a: Floats, b: Floats, c: Floats) -> NDArray[np.bool_]:
    """Whether a span may turn: without a change of sign from slope to slope, or from bend to bend, it does not."""
    with np.errstate(all="ignore"):
        bend = b + 3.0 * a
        turning: NDArray[np.bool_] = ~(c * (c + b + bend) > 0.0) | ((b < 0.0) != (bend < 0.0))
        turning &= (a != 0.0) | (b != 0.0)
    return turning


def _span_ranges(rows: Rows, some: Slots, size: int) -> Range:
    """The ranges over the first keys and the turns of the spans of *some* lines of *size* slots: (lines, size)."""
    abc = rows.numbers[A : C + 1].reshape(3, -1, size).take(some, axis=1).reshape(3, -1)
    d = rows.numbers[VALUE].reshape(-1, size).take(some, axis=0)
    turning = _may_turn(*abc)
    turns = int(np.count_nonzero(turning))
    low, high = d, d.copy()
    if 2 * turns > d.size:
        # To pick most of them takes longer than to work out all.
        slots = (some * size)[:, None] + np.arange(size)
        values = turns_of(rows, slots.reshape(-1), abc, d.reshape(-1))[1]
        np.copyto(values, nan, where=~turning)
        np.fmax(high, np.fmax(values[0], values[1]).reshape(d.shape), out=high)
        np.fmin(low, np.fmin(values[0], values[1]).reshape(d.shape), out=low)
    elif turns:
        (places,) = turning.nonzero()
        line, place = np.divmod(places, size)
        values = turns_of(rows, some.take(line) * size + place)[1]
        flat_low, flat_high = low.reshape(-1), high.reshape(-1)
        flat_low[places] = np.fmin(flat_low.take(places), np.fmin(values[0], values[1]))
        flat_high[places] = np.fmax(flat_high.take(places), np.fmax(values[0], values[1]))
    return low, high


def turns_of(rows: Rows, slots: Slots, abc: Floats | None = None, d: Floats | None = None) -> Range:
    """(u, value) where the spans of these slots turn, each (2, n); NaN where they do not.

    *abc* and *d* are their coefficients, if they have been read.
    """
    if abc is None or d is None:
        abc, d = rows.numbers[A : C + 1].take(slots, axis=1), rows.numbers[VALUE].take(slots)
    places = np.empty((2, len(slots)))
    with np.errstate(all="ignore"):
        # Scaled to size one, so that squares neither overflow nor vanish.
        size = np.maximum.reduce(np.abs(abc))
        a, b, c = abc / np.where((size > 0.0) & (size < np.inf), size, 1.0)
        a *= 3.0
        # a u^2 + 2 b u + c = 0, by the form without cancellation.
        q = -(b + np.copysign(np.sqrt(b * b - a * c), b))
        np.divide(c, q, out=places[0])
        np.divide(q, a, out=places[1])
        np.copyto(places, nan, where=(places <= 0.0) | (places >= 1.0))
        values = places * abc[0]
        values += abc[1]
        values *= places
        values += abc[2]
        values *= places
        values += d
        wild = ~np.isfinite(size) | np.logical_or.reduce(np.isinf(values))
    if wild.any():
        spans, _ = evaluation.scaled_spans(rows, rows.real(slots[wild]))
        places[:, wild] = hermite.extremum_places(spans.a, spans.b, spans.c)
        values[:, wild] = spans.value(places[0, wild]), spans.value(places[1, wild])
    return places, values


def whole(rows: Rows) -> tuple[float, float]:
    """The range from the first to the last key of rows that are one only, without what is kept for columns."""
    keys = slice(0, rows.size - 1)
    low, high = _span_ranges(rows, np.zeros(1, np.int64), rows.width)
    last = float(rows.numbers[VALUE, rows.size - 1])
    return float(low[0, keys].min(initial=last)), float(high[0, keys].max(initial=last))
