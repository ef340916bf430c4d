"""Resorting: chosen keys of a channel moved alike among the others, from the rows of a gesture's start into others.

No records and no parts of rows are made: the columns of all keys, which are few enough to stay in the processor's
cache, are put in their new order, and all that follows from them is worked out in one go.
"""

from math import isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model import hermite
from model.hermite import Floats
from model.keyframe import Run, TangentRule
from model.mapping import Added
from model.rewinding import NO_COLUMNS, Start
from model.rows import D_TIME, RULE_IN, RULE_OUT, SLOPE_IN, SLOPE_OUT, TIME, VALUE, A, C, Rows, Slots
from model.tangents import slopes_of

# In a channel of more keys it is quicker to write those that change only.
MOST_RESORTED = 20_000


class Resorted(NamedTuple):
    """The ranks from rank0 up to before rank1 hold other numbers; the ranks that all keys had, if in a new order."""

    rank0: int
    rank1: int
    order: Slots | None


class Resorting:
    """What is known of the rows of a start some of whose keys are moved again and again."""

    def __init__(self, rows: Rows, keys: Run) -> None:
        self.keys = keys
        self.run = rows.run(0, rows.size)  # all keys
        self.run.flags.writeable = False
        slots = rows.slots(np.arange(rows.size))
        self._numbers, self._marks, self._ids = rows.numbers[:A, slots], rows.marks[:, slots], rows.ids[slots]
        self._chosen: Slots = rows.ranks_of(keys["id"])
        others = np.ones(rows.size, np.bool_)
        others[self._chosen] = False
        self._others = others.nonzero()[0]
        self._times, self._values = self._numbers[: VALUE + 1, self._chosen]
        self._other_times = self._numbers[TIME, self._others]
        self._rank_of_slot: Slots = rows.ranks(np.arange(len(rows.ids)))
        self._steps = np.arange(len(keys))
        self._table = np.empty((D_TIME + 1, rows.size))

    def moved(self, d_time: Added, d_value: Added, slack: float) -> Resorted | None:
        """Work out the keys moved by both; None if two come within *slack* seconds or a number is unusually large."""
        with np.errstate(all="ignore"):
            return self._moved(d_time, d_value, slack)

    def _moved(self, d_time: Added, d_value: Added, slack: float) -> Resorted | None:
        times, values = d_time.to(self._times), d_value.to(self._values)
        places = self._other_times.searchsorted(times) + self._steps if d_time.amount else self._chosen
        same = places is self._chosen or bool((places == self._chosen).all())
        order = None if same else self._order(places)
        table = self._table
        if order is None:
            table[:A] = self._numbers
        else:
            self._numbers.take(order, axis=1, out=table[:A], mode="clip")
        table[TIME, places], table[VALUE, places] = times, values
        t, d_times = table[TIME], table[D_TIME, :-1]
        np.subtract(t[1:], t[:-1], out=d_times)
        if not (d_times.min(initial=np.inf) > slack and isfinite(t[-1] - t[0]) and isfinite(table[VALUE].sum())):
            return None
        _follow(table, self._marks if order is None else self._marks.take(order, axis=1))
        first, last = min(self._chosen[0], places[0]), max(self._chosen[-1], places[-1])
        return Resorted(int(first), int(last) + 1, order)

    def store(self, rows: Rows, start: Start, order: Slots | None) -> None:
        """Have *rows* hold what was worked out last."""
        numbers, marks, ids = twins = start.twin_grids(rows)
        start.spare_columns = NO_COLUMNS
        self._table.take(self._rank_of_slot, axis=1, out=numbers.reshape(D_TIME + 1, -1), mode="clip")
        start.set_aside(rows, keys_move=order is not None)
        if order is not None:
            start.write_keys()
            old_ranks = order.take(self._rank_of_slot)
            self._marks.take(old_ranks, axis=1, out=marks.reshape(len(marks), -1), mode="clip")
            self._ids.take(old_ranks, out=ids.reshape(-1), mode="clip")
            rows.row_of[ids] = np.arange(rows.rows, dtype=np.int32)[:, None]
        rows.take_over(twins, rows.first.copy(), numbers[TIME, :, 0].tolist())

    def given(self, resorted: Resorted) -> Run:
        """The keys of these ranks with the times and values worked out last."""
        rank0, rank1, order = resorted
        after: Run = self.run[rank0:rank1].copy() if order is None else self.run.take(order[rank0:rank1])
        after["time"], after["value"] = self._table[: VALUE + 1, rank0:rank1]
        return after

    def _order(self, places: Slots) -> Slots:
        """The ranks that the keys had, by those that they have when the chosen ones are at *places*."""
        others = np.ones(len(self._ids), np.bool_)
        others[places] = False
        order = np.empty(len(others), np.int64)
        order[places] = self._chosen
        order[others] = self._others
        return order


def _follow(table: Floats, marks: NDArray[np.uint8]) -> None:
    """Work out what follows from the first columns of all keys of a channel, and the rules among their marks."""
    t, v = table[: VALUE + 1]
    rules_in, rules_out = marks[RULE_IN], marks[RULE_OUT]
    slope_in, slope_out = slopes_of(t, v, table[SLOPE_IN], table[SLOPE_OUT], rules_in, rules_out)
    table[SLOPE_IN], table[SLOPE_OUT] = slope_in, slope_out
    d_time = table[D_TIME, :-1]
    table[A : C + 1, :-1] = hermite.coefficients(d_time, v[:-1], v[1:], slope_out[:-1], slope_in[1:])
    held = rules_out == TangentRule.STEP
    if held.any():
        table[A : C + 1, held] = 0.0
    table[A : C + 1, -1], table[D_TIME, -1] = 0.0, 1.0
