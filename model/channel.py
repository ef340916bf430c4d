"""Channel: a doubly linked list of keys whose only change is the splice of a run of neighbours."""

from collections.abc import Callable, Iterable, Iterator
from math import inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from model import checking, evaluation, picking, short_ways, splicing, within
from model.curve import Curve
from model.curve import Spans as Spans
from model.extrapolation import Extrapolation
from model.keyframe import KEY_DTYPE, Keyframe, Run
from model.mapping import Mapping
from model.rewinding import Question, Start
from model.rows import MARK_FIELDS, NUMBER_FIELDS, VALUE
from model.short_ways import Shifted

# Where fewer than one key in so many is asked for, keys are read one by one and not with those between them.
SPARSE = 4

_NUMBERS = dict(NUMBER_FIELDS)
_MARKS = dict(MARK_FIELDS)


class Reach(NamedTuple):
    """What a splice changed: the times [t0, t1] (t0 > t1: nothing) and the keys as stored, with ids and slopes."""

    t0: float
    t1: float
    run: Run


class Spliced(NamedTuple):
    """The same (t0, t1); the keys as they were given, with the ids that new ones got; whether no key came or went."""

    t0: float
    t1: float
    given: Run
    same_ids: bool


class Channel(Curve):
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
        super().__init__(pre, post)
        self.name, self.unit, self.color, self.locked = name, unit, color, locked
        self._next_id = 1
        if run is not None and len(run):
            self.replace(run[:0], run)
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

    def __iter__(self) -> Iterator[Keyframe]:
        for key_id in self.run()["id"].tolist():
            yield Keyframe(self, key_id)

    def __contains__(self, key_id: object) -> bool:
        rows = self._rows
        if not isinstance(key_id, int | np.integer) or not 0 < key_id < len(rows.row_of):
            return False
        return bool(rows.row_of[key_id] >= 0)

    def holds(self, ids: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Which of these ids are those of its keys."""
        row_of = self._rows.row_of
        known: NDArray[np.bool_] = (ids > 0) & (ids < len(row_of))
        known &= row_of[np.where(known, ids, 0)] >= 0
        return known

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
        slot = np.array([self._rows.slot(self._rows.rank_of(key_id))])
        a, b, c = (float(column[0]) for column in evaluation.finite_coefficients(self._rows, slot))
        return a, b, c, float(self._rows.numbers[VALUE, slot[0]])

    def keys_around(self, key_id: int) -> tuple[Run, int]:
        """The key with this id between its neighbours, and its place among them; KeyGoneError if there is none."""
        rank = self._rows.rank_of(key_id)
        rank0 = max(rank - 1, 0)
        return self._rows.run(rank0, min(rank + 2, len(self))), rank - rank0

    # --- runs

    def _run(self, rank0: int, rank1: int, into: Run | None = None) -> Run:
        run = self._rows.run(rank0, rank1, into)
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
        if not isinstance(ids, np.ndarray) or ids.flags.writeable:
            return self._keys_of(ids)
        return self._again(ids, self._keys_of, ids)

    def _keys_of(self, ids: Iterable[int]) -> Run:
        if isinstance(ids, np.ndarray) and 8 <= len(ids) < len(self) // SPARSE:
            few = picking.keys_at(self._rows, picking.slots_of(self._rows, ids))
            few.flags.writeable = False
            return few
        ranks = self._ranks(ids)
        if not len(ranks):
            return self._run(0, 0)
        run = self._run(int(ranks[0]), int(ranks[-1]) + 1)
        if len(ranks) == len(run):
            return run
        chosen: Run = run[ranks - ranks[0]]
        chosen.flags.writeable = False
        return chosen

    def _again[*Args](self, question: Question, read: Callable[[*Args], Run], *args: *Args) -> Run:
        """What *read* gives; each preview of a gesture begins with the same questions about its start."""
        start = self._rows.start
        if start is None or start.left:
            return read(*args)
        run = start.run_of(question)
        if run is None:
            run = read(*args)
            start.remember(question, run)
        return run

    def extent_of(self, ids: NDArray[np.int64]) -> tuple[float, float, float, float] | None:
        """(first time, last time, lowest value, highest value) of the keys with these ids, each once, as far as there.

        None if none is there.
        """
        return picking.extent_of(self._rows, ids)

    def keys_between(self, t0: float, t1: float, *, around: int = 0) -> Run:
        """The keys with t0 <= time <= t1, and *around* neighbours on each side."""
        rank0, rank1 = self._rows.rank_at(t0, after=False), self._rows.rank_at(t1)
        rank0, rank1 = max(0, rank0 - around), min(len(self), max(rank0, rank1) + around)
        return self._again((rank0, rank1), self._run, rank0, rank1)

    def ids_between(self, t0: float, t1: float) -> NDArray[np.int64]:
        """The ids of the keys with t0 <= time <= t1, in time order."""
        rank0, rank1 = self._rows.rank_at(t0, after=False), self._rows.rank_at(t1)
        return self._rows.ids_between(rank0, max(rank0, rank1))

    def count_between(self, t0: float, t1: float) -> int:
        """How many keys have t0 <= time <= t1."""
        return max(0, self._rows.rank_at(t1) - self._rows.rank_at(t0, after=False))

    def keys_within(self, t0: float, t1: float, low: float, high: float) -> within.KeysWithin:
        """The keys with t0 <= time <= t1 and low <= value <= high."""
        return within.keys_within(self._rows, t0, t1, low, high)

    def spans_within(self, t0: float, t1: float, low: float, high: float, long: float) -> within.SpansWithin:
        """The spans that touch [t0, t1] and from key to key [low, high]; and all that last more than *long* seconds."""
        return within.spans_within(self._rows, t0, t1, low, high, long)

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
        done = self.replace(before, after)
        return Reach(done.t0, done.t1, self.stored(done.given))

    def stored(self, given: Run) -> Run:
        """The neighbouring keys with the ids of *given* as the channel holds them; ValueError if they are not there."""
        rank0 = splicing.rank_of_run(self._rows, given, given)
        room = None if self._rows.start is None else self._rows.start.room_for(len(given))
        return self._run(rank0, rank0 + len(given), room)

    def replace(self, before: Run, after: Run) -> Spliced:
        """The same as `splice` without reading back what the channel has made of *after*."""
        if not len(before) and not len(after):
            return Spliced(inf, -inf, after, True)
        rows = self._rows
        rank0 = splicing.rank_of_run(rows, before, after)
        rank1 = rank0 + len(before)
        old, old_size = splicing.outer(rows, rank0, rank1), rows.size
        found = splicing.check_run(after, old.time_before, old.time_after)
        same_ids = len(before) == len(after) and splicing.have_same_ids(before, after)
        if not same_ids:
            ids, self._next_id = splicing.ids_for(rows, before, after, self._next_id)
            if ids is not None:
                after = after.copy()
                after["id"] = ids
        rows.minus_zero |= found.minus_zero
        moved0, moved1 = rows.replace(rank0, rank1, after, same_ids=same_ids, slopes_too=found.slopes)
        rank1 = rank0 + len(after)
        splicing.rebuild(rows, min(moved0, rank0), max(moved1, rank1))
        self._changed()
        if not old_size or not rows.size:
            return Spliced(-inf, inf, after, False)
        old_times = (float(before["time"][0]), float(before["time"][-1])) if len(before) else (inf, -inf)
        t0, t1 = splicing.reach(rows, rank0, rank1, old, old_times, self.pre, self.post)
        return Spliced(t0, t1, after, same_ids)

    def shift(self, before: Run, mapping: Mapping, slack: float) -> Shifted | None:
        """Change the keys *before* alike, by a way shorter than splices and with the same outcome.

        None, and nothing has changed, where that way is not open (see `short_ways`).
        """
        start = self._rows.start
        if start is None or start.left:
            return None
        done = short_ways.shifted(self._rows, start, before, mapping, slack, self._all_keys, self.pre, self.post)
        if done is not None:
            self._changed()
        return done

    def prepared(self, ids: NDArray[np.int64]) -> Iterator[None]:
        """In steps, after `hold`: have at hand what each change of the keys with these ids begins with."""
        rows, start = self._rows, self._rows.start
        if start is None:
            return
        if len(ids) == len(self) and not ids.flags.writeable:
            keys: Run = np.empty(len(ids), KEY_DTYPE)
            yield from rows.reading(0, len(ids), keys)
            keys.flags.writeable = False
            start.remember(ids, keys)
        else:
            keys = self.keys_of(ids)
            yield
        yield from short_ways.prepared(rows, start, keys, self._all_keys)
        if start.shifting is not None and len(keys) == len(self):
            self._prepare_extremes(start.shifting.extent)
            yield

    def _all_keys(self, chosen: Run) -> Run:
        """All keys, which are the *chosen* ones if those are as many; ValueError if they are not there."""
        if len(chosen) < len(self):
            return self._again((0, len(self)), self._run, 0, len(self))
        splicing.rank_of_run(self._rows, chosen, chosen)
        return chosen

    def hold(self) -> None:
        """Keep from now on what splices overwrite, so that `rewind` can bring the keys of this moment back."""
        self._rows.start = Start(self._rows)

    def rewind(self) -> None:
        """Have the keys of the moment of `hold` again, bit for bit and without working anything out; ids stay used."""
        start = self._rows.start
        if start is not None and start.left:
            start.restore(self._rows)
            self._changed()

    def release(self) -> None:
        """Leave the keys as they are and forget those of the moment of `hold`."""
        self._rows.start = self._rows.likeness = None

    def set_extrapolation(self, pre: Extrapolation, post: Extrapolation) -> None:
        """Choose how the curve goes on before the first and after the last key."""
        self.pre, self.post = Extrapolation(pre), Extrapolation(post)
        self._changed()

    def copy(self) -> "Channel":
        """A channel with the same keys, ids and settings, sharing nothing with this one."""
        twin = Channel(self.name, pre=self.pre, post=self.post, unit=self.unit, color=self.color, locked=self.locked)
        twin._next_id = self._next_id
        if len(self):
            twin.replace(self._run(0, 0), self.run())
        return twin

    def check(self) -> None:
        """Assert everything that must hold of the list, its rows, slopes and coefficients."""
        checking.check(self._rows, self._next_id)
