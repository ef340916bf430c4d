"""Channel: a doubly linked list of keys whose only change is the splice of a run of neighbours."""

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from model import envelope, evaluation, splicing
from model.evaluation import Span
from model.extrapolation import EXTRAPOLATIONS, Ends, Extrapolation
from model.hermite import LARGEST, Floats
from model.keyframe import KEY_DTYPE, Keyframe, Run
from model.rows import BROKEN, RULE_IN, RULE_OUT, SLOPE_IN, SLOPE_OUT, TIME, VALUE, A, B, C, Keys, Rows

_NUMBERS = {"time": TIME, "value": VALUE, "slope_in": SLOPE_IN, "slope_out": SLOPE_OUT}
_MARKS = {"rule_in": RULE_IN, "rule_out": RULE_OUT, "broken": BROKEN}


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
        self._rows = Rows(Keys.empty(0))
        self._ends: Ends | None = None
        self._hit: Span | None = None
        if run is not None and len(run):
            self.splice(run[:0], run)
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
        return isinstance(key_id, int | np.integer) and 0 < key_id < len(rows.row_of) and bool(rows.row_of[key_id] >= 0)

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
        keys = self._rows.gathered(rank0, rank1)
        run = np.empty(keys.count, KEY_DTYPE)
        for name, column in _NUMBERS.items():
            run[name] = keys.numbers[column]
        for name, column in _MARKS.items():
            run[name] = keys.marks[column]
        run["id"] = keys.ids
        run.flags.writeable = False
        return run

    def run(self) -> Run:
        """All keys."""
        return self._run(0, len(self))

    def _ranks(self, ids: Iterable[int]) -> list[int]:
        return sorted({self._rows.rank_of(key_id) for key_id in (ids.tolist() if isinstance(ids, np.ndarray) else ids)})

    def run_of(self, ids: Iterable[int]) -> Run:
        """The fewest neighbouring keys that hold all *ids*; KeyGoneError if one is gone."""
        ranks = self._ranks(ids)
        return self._run(ranks[0], ranks[-1] + 1) if ranks else self._run(0, 0)

    def keys_of(self, ids: Iterable[int]) -> Run:
        """Exactly the keys *ids*, in time order; KeyGoneError if one is gone."""
        ranks = self._ranks(ids)
        if not ranks:
            return self._run(0, 0)
        run = self._run(ranks[0], ranks[-1] + 1)[np.array(ranks) - ranks[0]]
        run.flags.writeable = False
        return run

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
        rank = splicing.rank_of_run(self._rows, before, after)
        new, self_next = splicing.checked(self._rows, rank, before, after, self._next_id)
        t0, t1, stored = splicing.spliced(self._rows, rank, len(before), new, self.pre, self.post)
        self._next_id = self_next
        self._changed()
        run = self._run(rank, rank + stored)
        return Reach(t0, t1, run)

    def set_extrapolation(self, pre: Extrapolation, post: Extrapolation) -> None:
        """Choose how the curve goes on before the first and after the last key."""
        self.pre, self.post = Extrapolation(pre), Extrapolation(post)
        self._changed()

    def _changed(self) -> None:
        self.revision += 1
        self._ends = self._hit = None

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

    def evaluate(self, times: ArrayLike) -> Floats:
        """The values at *times* (seconds, any shape); NaN in, NaN out, every finite time gives a finite value."""
        array = np.asarray(times, np.float64)
        flat = np.ascontiguousarray(array).reshape(-1)
        if len(self) == 0:
            return np.where(np.isnan(array), np.nan, 0.0)
        return evaluation.evaluated(self._rows, self._the_ends(), flat, self.pre, self.post).reshape(array.shape)

    def value(self, time: float) -> float:
        """The value at one time, bit for bit that of `evaluate`."""
        hit = self._hit
        if hit is None or not hit.time0 <= time < hit.time1:
            if len(self) == 0:
                return 0.0 if time == time else time
            ends = self._the_ends()
            if time < ends.time0 or time > ends.time1:
                mode = EXTRAPOLATIONS[self.pre if time < ends.time0 else self.post]
                inner, shift = mode.fold_one(time, ends)
                value = self.value(inner)
                return min(max(value + shift, -LARGEST), LARGEST) if shift else value
            if time != time:
                return time
            hit = self._hit = evaluation.span_at(self._rows, time)
        time0, _, d_time, a, b, c, d = hit
        u = (time - time0) / d_time
        value = d + u * (c + u * (b + u * a))
        if value - value != 0.0:
            return float(evaluation.careful(self._rows, np.array([time]))[0])
        return value

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
        keys = self._rows.gathered(rank0, rank1 + 1).numbers
        a, b, c = (np.clip(np.nan_to_num(keys[i, :-1]), -LARGEST, LARGEST) for i in (A, B, C))
        return Spans(keys[TIME, :-1], keys[TIME, 1:], a, b, c, keys[VALUE, :-1])

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
        return envelope.envelope(self._rows, self._the_ends(), array, self.pre, self.post)

    def check(self) -> None:
        """Assert everything that must hold of the list, its rows, slopes and coefficients."""
        splicing.check(self._rows, self._next_id)
