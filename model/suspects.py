"""Suspects: the spans that may leave the range of the keys around them, found without working out where they turn."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.hermite import Floats
from model.likeness import Extent, Likeness
from model.rows import VALUE, B, C, Rows, Slots

# What rounding may do to a turn: as a share of the largest value, of that and the range together, and at least.
ROUNDING, NEAR, LEAST = 1e-12, 2e-6, 1e-300
# Spans that come within this share of their block's range to its ends are suspects of all that is made of them.
GENEROUS = 1.0 / 256.0
# What is made of a block must need so many times less than that.
ROOM = 16.0
# Where more than one span in so many is a suspect for all times, it is no use to know which.
FEWEST = 8

type Range = tuple[Floats, Floats]


def key_ranges(rows: Rows, grid: Floats, some: Slots, block: int) -> Range:
    """The lowest and highest keys in the blocks of some rows of *grid*, which is like that of *rows*."""
    d = grid[VALUE][_few(some)].reshape(-1)
    begins = np.arange(0, len(d), block)
    return np.minimum.reduceat(d, begins), np.maximum.reduceat(d, begins)


def suspects(rows: Rows, grid: Floats, some: Slots, bounds: Range, room: Floats) -> Slots:
    """The slots in some rows of *grid* of the spans with an inner control point outside the *bounds* of their block."""
    few = _few(some)
    b, c, d = (grid[column][few].reshape(-1) for column in (B, C, VALUE))
    least, most = (bound[:, None] for bound in bounds)
    p1, p2, spare = room[:, : len(d)]
    in_blocks = spare.reshape(len(most), -1)
    _control_points(b, c, d, p1, p2)
    np.maximum(p1, p2, out=spare)
    beyond = ~(in_blocks <= most)
    np.minimum(p1, p2, out=spare)
    beyond |= ~(in_blocks >= least)
    # The spans of spare slots are those of the last key.
    beyond.reshape(len(some), -1)[:, int((rows.first[some + 1] - rows.first[some]).max()) :] = False
    (slots,) = beyond.reshape(-1).nonzero()
    found: Slots = some.take(slots // rows.width) * rows.width + slots % rows.width
    return found


def _few(some: Slots) -> Slots | slice:
    """Some rows, as a slice if they are neighbours."""
    return slice(some[0], some[-1] + 1) if some[-1] - some[0] == len(some) - 1 else some


def safe(low: Floats, high: Floats) -> Range:
    """Bounds within *low* to *high*: with its inner control points between them a span does not turn outside these.

    Since a curve crosses no level more often than the line through its control points does, it turns downwards no
    higher than the higher of the inner ones, and upwards no higher than the key that it starts from; and so below.
    But a turn as it is worked out may lie some 1e-14 of the largest value off. No turn is that near to a key at the
    end of the range if the curve leaves the key steeply enough.
    """
    slack = _slack(low, high)
    return low + slack, high - slack


def _slack(low: Floats, high: Floats) -> Floats:
    largest = np.maximum(np.abs(low), np.abs(high))
    slack: Floats = np.sqrt((high - low) * NEAR) * np.sqrt(largest * NEAR) + largest * ROUNDING + LEAST
    return slack


def _control_points(b: Floats, c: Floats, d: Floats, p1: Floats, p2: Floats) -> None:
    """Fill *p1* and *p2* with the two control points between the keys of each span."""
    np.multiply(c, 1.0 / 3.0, out=p1)
    p1 += d
    np.add(b, c, out=p2)
    p2 *= 1.0 / 3.0
    p2 += p1


class Known(NamedTuple):
    """What is known of rows of which others are made again and again."""

    extent: Extent  # tells which rows
    low: Floats  # of the keys of each block
    high: Floats
    slack: Floats  # how far the control points of those that are no suspects stay within; inf: all are suspects
    slots: Slots | None  # the suspects; None: too many

    @classmethod
    def of(cls, rows: Rows, origin: Floats, extent: Extent, block: int, parts: list[Slots], room: Floats) -> "Known":
        """Look at the *origin* of all *rows*, the numbers of rows of their shape, some rows at a time."""
        lows, highs, slacks, slots = [], [], [], []
        for some in parts:
            low, high = key_ranges(rows, origin, some, block)
            slack = (high - low) * GENEROUS
            slack[~(slack > ROOM * _slack(low, high))] = np.inf
            slots.append(suspects(rows, origin, some, (low + slack, high - slack), room))
            lows.append(low)
            highs.append(high)
            slacks.append(slack)
        found = np.concatenate(slots)
        few = found if len(found) * FEWEST <= rows.size else None
        return cls(extent, np.concatenate(lows), np.concatenate(highs), np.concatenate(slacks), few)

    def made(self, likeness: Likeness) -> tuple[Floats, Floats, NDArray[np.int64]] | None:
        """(lowest, highest key of each block, suspects) of what is made of these rows; None if that must be looked for.

        Times and values go the same way for all keys, and control points with them, but for what rounding does.
        """
        if self.slots is None:
            return None
        # A rounded sum or product never falls where the numbers rise, so that the lowest key stays the lowest.
        low, high = likeness.value.to(self.low), likeness.value.to(self.high)
        if likeness.value.factor < 0.0:
            low, high = high, low
        enough = abs(likeness.value.factor) * self.slack >= _slack(low, high) + likeness.off
        return (low, high, self.slots) if enough.all() else None
