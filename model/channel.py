"""Channel: a doubly linked list of keys whose only change is the splice of a run of neighbours."""

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from math import inf, nextafter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model import envelope, evaluation, splicing
from model.extrapolation import EXTRAPOLATIONS, Ends, Extrapolation
from model.hermite import LARGEST, Floats
from model.keyframe import Keyframe, Run
from model.lookup import SLOTS_A_TIME, TABLE_TIMES, Table
from model.rows import D_TIME, MARK_FIELDS, NUMBER_FIELDS, TIME, VALUE, A, B, C, Rows

_NUMBERS = dict(NUMBER_FIELDS)
_MARKS = dict(MARK_FIELDS)

_SPAN_COLUMNS = [D_TIME, A, B, C]

# One span in Python numbers: (time0, time1, d_time, a, b, c, d); the last key holds its own time only.
type Span = tuple[float, float, float, float, float, float, float]
NOWHERE: Span = (inf, -inf, 1.0, 0.0, 0.0, 0.0, 0.0)
# Channels of so many rows keep their times as lists, and those of so many keys their spans, once values are asked for.
LISTED_ROWS = 512
KEPT_SPANS = 4096


class Reach(NamedTuple):
    """What a splice changed: the times [t0, t1] (t0 > t1: nothing) and the keys as stored, with ids and slopes."""

    t0: float
    t1: float
    run: Run


class Spans(NamedTuple):
    """Neighbouring spans as columns of shape (n,): value = d + u (c + u (b + u a)), u from 0 to 1."""

    time0: Floats
    time1: Floats
    a: Floats
    b: Floats
    c: Floats
    d: Floats


class Channel:
    """The keys of one animated number, in strictly increasing time, and the curve through them.

    The plain attributes are read by everyone and written by the document only.
    """

    def __init__(
        self,
        name: str = "",
        run: Run | None = None,
        *,
        pre: Extrapolation = Extrapolation.CONSTANT,
        post: Extrapolation = Extrapolation.CONSTANT,
        unit: str = "",
        color: str | None = None,
        locked: bool = False,
    ) -> None:
        self.name, self.unit, self.color, self.locked = name, unit, color, locked
        self.pre, self.post = Extrapolation(pre), Extrapolation(post)
        self.revision = 0
        self._next_id = 1
        self._rows = Rows()
        self._ends: Ends | None = None
        self._table: Table | None = None
        self._extremes: envelope.Extremes | None = None
        self._hit = NOWHERE
        self._kept_spans: dict[int, Span] = {}
        self._row_times: dict[int, Sequence[float]] = {}
        if run is not None and len(run):
            self._splice(run[:0], run)
            self.revision = 0

    def __repr__(self) -> str:
        return f"Channel({self.name!r}, {len(self)} keys)"

    @property
    def group(self) -> str:
        """The name up to its last dot."""
        return self.name.rpartition(".")[0]

    @property
    def leaf(self) -> str:
        """The name behind its last dot."""
        return self.name.rpartition(".")[2]

    # --- the list

    def __len__(self) -> int:
        return self._rows.size

    def __iter__(self) -> Iterator[Keyframe]:
        for key_id in self.run()["id"].tolist():
            yield Keyframe(self, key_id)

    def __contains__(self, key_id: object) -> bool:
        rows = self._rows
        if not isinstance(key_id, int | np.integer) or not 0 < key_id < len(rows.row_of):
            return False
        return bool(rows.row_of[key_id] >= 0)

    def _key(self, rank: int) -> Keyframe | None:
        if not 0 <= rank < len(self):
            return None
        return Keyframe(self, int(self._rows.ids[self._rows.slot(rank)]))

    @property
    def first(self) -> Keyframe | None:
        """The first key, if any."""
        return self._key(0)

    @property
    def last(self) -> Keyframe | None:
        """The last key, if any."""
        return self._key(len(self) - 1)

    def key(self, key_id: int) -> Keyframe:
        """The key with this id; KeyGoneError if there is none."""
        self._rows.rank_of(key_id)
        return Keyframe(self, int(key_id))

    def key_field(self, key_id: int, name: str) -> Any:
        """One field of KEY_DTYPE of the key with this id; KeyGoneError if there is none."""
        slot = self._rows.slot(self._rows.rank_of(key_id))
        if name == "id":
            return key_id
        if name in _NUMBERS:
            return self._rows.numbers[_NUMBERS[name], slot]
        return self._rows.marks[_MARKS[name], slot]

    def previous_of(self, key_id: int) -> Keyframe | None:
        """The key before the one with this id."""
        return self._key(self._rows.rank_of(key_id) - 1)

    def next_of(self, key_id: int) -> Keyframe | None:
        """The key after the one with this id."""
        return self._key(self._rows.rank_of(key_id) + 1)

    def coefficients_of(self, key_id: int) -> tuple[float, float, float, float]:
        """(a, b, c, d) of the span that the key with this id starts."""
        column = self._rows.numbers[:, self._rows.slot(self._rows.rank_of(key_id))]
        a, b, c, d = (min(max(float(column[i]), -LARGEST), LARGEST) for i in (A, B, C, VALUE))
        return a, b, c, d

    # --- runs

    def _run(self, rank0: int, rank1: int) -> Run:
        run = self._rows.run(rank0, rank1)
        run.flags.writeable = False
        return run

    def run(self) -> Run:
        """All keys."""
        return self._run(0, len(self))

    def _ranks(self, ids: Iterable[int]) -> NDArray[np.int64]:
        array = ids if isinstance(ids, np.ndarray) else np.array(list(ids), np.int64)
        return self._rows.ranks_of(array.astype(np.int64, copy=False).reshape(-1))

    def run_of(self, ids: Iterable[int]) -> Run:
        """The fewest neighbouring keys that hold all *ids*; KeyGoneError if one is gone."""
        ranks = self._ranks(ids)
        return self._run(int(ranks[0]), int(ranks[-1]) + 1) if len(ranks) else self._run(0, 0)

    def keys_of(self, ids: Iterable[int]) -> Run:
        """Exactly the keys *ids*, in time order; KeyGoneError if one is gone."""
        ranks = self._ranks(ids)
        if not len(ranks):
            return self._run(0, 0)
        run = self._run(int(ranks[0]), int(ranks[-1]) + 1)
        if len(ranks) == len(run):
            return run
        chosen: Run = run[ranks - ranks[0]]
        chosen.flags.writeable = False
        return chosen

    def keys_between(self, t0: float, t1: float, *, around: int = 0) -> Run:
        """The keys with t0 <= time <= t1, and *around* neighbours on each side."""
        rank0, rank1 = self._rows.rank_at(t0, after=False), self._rows.rank_at(t1)
        rank0, rank1 = max(0, rank0 - around), min(len(self), max(rank0, rank1) + around)
        return self._run(rank0, rank1)

    def count_between(self, t0: float, t1: float) -> int:
        """How many keys have t0 <= time <= t1."""
        return max(0, self._rows.rank_at(t1) - self._rows.rank_at(t0, after=False))

    def neighbours(self, time: float) -> tuple[Keyframe | None, Keyframe | None]:
        """(the last key at or before *time*, the first key after it)."""
        rank = self._rows.rank_at(time)
        return self._key(rank - 1), self._key(rank)

    def key_at(self, time: float) -> Keyframe | None:
        """The key at exactly *time*."""
        rank = self._rows.rank_at(time) - 1
        return self._key(rank) if rank >= 0 and self._rows.times[self._rows.slot(rank)] == time else None

    def nearest_key(self, time: float) -> Keyframe | None:
        """The key nearest to *time*; the earlier of two equally near."""
        before, after = self.neighbours(time)
        if before is None or after is None:
            return before or after
        return before if time - before.time <= after.time - time else after

    # --- changes

    def splice(self, before: Run, after: Run) -> Reach:
        """Replace the neighbouring keys *before* by *after*, rebuild slopes and coefficients around, say what changed.

        *before* must be what is there, by ids; *after* must be finite, in order and between the neighbours, and its
        rules known; else ValueError, and nothing has changed. Keys with id 0 get new ids.
        """
        if not len(before) and not len(after):
            return Reach(inf, -inf, after)
        t0, t1, rank0, rank1 = self._splice(before, after)
        return Reach(t0, t1, self._run(rank0, rank1))

    def _splice(self, before: Run, after: Run) -> tuple[float, float, int, int]:
        """Do what `splice` says: (t0, t1) of what changed, (rank0, rank1) of the new keys."""
        rows = self._rows
        rank0 = splicing.rank_of_run(rows, before, after)
        rank1 = rank0 + len(before)
        splicing.check_run(rows, rank0, rank1, after)
        ids, next_id = splicing.ids_for(rows, before, after, self._next_id)
        if ids is not None:
            after = after.copy()
            after["id"] = ids
        old = splicing.outer(rows, rank0, rank1)
        old_size = rows.size
        old_times = (float(before["time"][0]), float(before["time"][-1])) if len(before) else (inf, -inf)
        moved0, moved1 = rows.replace(rank0, rank1, after)
        rank1 = rank0 + len(after)
        splicing.rebuild(rows, min(moved0, rank0 - 2), max(moved1, rank1 + 1))
        self._next_id = next_id
        self._changed()
        if not old_size or not rows.size:
            return -inf, inf, rank0, rank1
        t0, t1 = splicing.reach(rows, rank0, rank1, old, old_times, self.pre, self.post)
        return t0, t1, rank0, rank1

    def set_extrapolation(self, pre: Extrapolation, post: Extrapolation) -> None:
        """Choose how the curve goes on before the first and after the last key."""
        self.pre, self.post = Extrapolation(pre), Extrapolation(post)
        self._changed()

    def _changed(self) -> None:
        self.revision += 1
        self._ends = self._table = None
        self._hit = NOWHERE
        self._kept_spans.clear()
        self._row_times.clear()

    def copy(self) -> "Channel":
        """A channel with the same keys, ids and settings, sharing nothing with this one."""
        twin = Channel(
            self.name,
            self.run(),
            pre=self.pre,
            post=self.post,
            unit=self.unit,
            color=self.color,
            locked=self.locked,
        )
        twin._next_id = self._next_id
        return twin

    # --- the curve

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
        hit = self._hit
        if not hit[0] <= time < hit[1]:
            found = self._seek(float(time))
            if found is None:
                return self._value_outside(float(time))
            hit = self._hit = found
        time0, _, d_time, a, b, c, d = hit
        u = (time - time0) / d_time
        value = d + u * (c + u * (b + u * a))
        if value and value - value == 0.0:
            return value
        return self._careful_value(time, value, d)

    def _careful_value(self, time: float, value: float, d: float) -> float:
        """*value* at *time*, which is 0 or no number, as `evaluate` gives it."""
        if value == 0.0:
            return d if time == self._hit[0] else value
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

    def _seek(self, time: float) -> Span | None:
        """The span that *time* lies in; None outside the keys."""
        rows = self._rows
        row = bisect_right(rows.starts, time) - 1 if rows.rows > 1 else 0
        times = self._row_times.get(row)
        if times is None:
            times = rows.number_grid[TIME, row, : rows.held(row)].tolist() if row >= 0 else []
            if rows.rows <= LISTED_ROWS:
                self._row_times[row] = times
        place = bisect_right(times, time) - 1
        if place < 0:
            return None
        slot = row * rows.width + place
        span = self._kept_spans.get(slot)
        if span is None:
            time0, value, _, _, a, b, c, d_time = rows.numbers[:, slot].tolist()
            if place + 1 < len(times):
                time1 = times[place + 1]
            else:
                time1 = rows.starts[row + 1] if row + 1 < rows.rows else nextafter(time0, inf)
            span = (time0, time1, d_time, a, b, c, value)
            if rows.size <= KEPT_SPANS:
                self._kept_spans[slot] = span
        return span if time < span[1] else None

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
        return tuple(float(column[0]) for column in spans)  # type: ignore[return-value]

    def _spans(self, rank0: int, rank1: int) -> Spans:
        keys = self._rows.columns(rank0, rank1 + 1)
        a, b, c = (np.clip(np.nan_to_num(keys[i, :-1]), -LARGEST, LARGEST) for i in (A, B, C))
        return Spans(keys[TIME, :-1], keys[TIME, 1:], a, b, c, keys[VALUE, :-1])

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
        rank0 = max(self._rows.rank_at(t0, after=False) - 1, 0)
        rank1 = min(self._rows.rank_at(t1), len(self) - 1)
        return self._spans(rank0, rank1) if rank1 > rank0 else Spans(*np.empty((6, 0)))

    def extrema(self, t0: float | None = None, t1: float | None = None) -> tuple[float, float]:
        """The lowest and highest value over [t0, t1], by default from the first to the last key."""
        if len(self) == 0:
            return 0.0, 0.0
        ends = self._the_ends()
        edges = np.array([ends.time0 if t0 is None else t0, ends.time1 if t1 is None else t1])
        lowest, highest = self.envelope(edges)
        return float(lowest[0]), float(highest[0])

    def envelope(self, edges: ArrayLike) -> tuple[Floats, Floats]:
        """Lowest and highest value of the curve in each [edges[j], edges[j + 1]], extrapolation included: (n - 1,)."""
        array = np.asarray(edges, np.float64)
        if len(self) == 0:
            return np.zeros(len(array) - 1), np.zeros(len(array) - 1)
        if self._extremes is None or self._extremes.numbers is not self._rows.numbers:
            self._extremes = envelope.Extremes(self._rows)
        return envelope.envelope(self._rows, self._extremes, self._the_ends(), array, self.pre, self.post)

    def check(self) -> None:
        """Assert everything that must hold of the list, its rows, slopes and coefficients."""
        splicing.check(self._rows, self._next_id)
