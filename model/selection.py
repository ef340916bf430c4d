"""Selection: which keys of which channels are chosen; a value that is never changed in place."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.channel import Channel

type Ids = NDArray[np.int64]

# More ids than this are told apart by a flag for each id that there may be, unless so many flags came on each.
MANY = 1000
FLAGS_AN_ID = 64

NO_IDS: Ids = np.empty(0, np.int64)
NO_IDS.flags.writeable = False


# numpy's own sets are worked out by hashing, which takes ten times as long as sorting from some thousand ids on.


def _increasing(ids: Ids) -> bool:
    return len(ids) < 2 or bool((ids[1:] > ids[:-1]).all())


def _united(ids: Ids, others: Ids) -> Ids:
    """The ids of one or both, increasing."""
    column = np.sort(np.concatenate([ids, others]))
    united: Ids = column[np.append(True, column[1:] != column[:-1])] if len(column) else column
    return united


def _in_one(ids: Ids, others: Ids) -> Ids:
    """The ids of one of two increasing columns and not of both, increasing."""
    column = np.sort(np.concatenate([ids, others]))
    same = np.append(column[1:] == column[:-1], False)
    same[1:] |= same[:-1].copy()
    rest: Ids = column[~same]
    return rest


def ids_without(ids: Ids, others: Ids) -> Ids:
    """*ids* but for *others*, both in any order and each id once, increasing."""
    if len(ids) > MANY and len(others):
        top = int(max(ids.max(), others.max()))
        if top < FLAGS_AN_ID * len(ids):
            flags = np.zeros(top + 1, np.bool_)
            flags[ids] = True
            flags[others] = False
            return np.flatnonzero(flags)
    ids, others = np.sort(ids), np.sort(others)
    if not len(others) or np.array_equal(ids, others):
        return ids[len(others) :]
    rest: Ids = ids[others.take(others.searchsorted(ids), mode="clip") != ids]
    return rest


def _sorted_ids(ids: ArrayLike) -> Ids:
    """*ids* in increasing order, each once, read-only."""
    column = np.array(ids, np.int64).reshape(-1)
    if not _increasing(column):
        column = _united(column, NO_IDS)
    column.flags.writeable = False
    return column


class Selection:
    """Keys by channel and id, so that they stay the same keys whatever is edited around them."""

    __slots__ = ("_count", "_ids")

    NONE: ClassVar["Selection"]

    def __init__(self, ids: Mapping[Channel, Ids]) -> None:
        self._ids = {channel: column for channel, column in ids.items() if len(column)}
        self._count = sum(map(len, self._ids.values()))

    @classmethod
    def of(cls, ids: Mapping[Channel, ArrayLike]) -> "Selection":
        """The keys with these ids, in any order; an id named twice counts once."""
        return cls({channel: _sorted_ids(column) for channel, column in ids.items()})

    @classmethod
    def of_key(cls, channel: Channel, key_id: int) -> "Selection":
        """One key."""
        return cls({channel: _sorted_ids([key_id])})

    @classmethod
    def of_all(cls, channels: Iterable[Channel]) -> "Selection":
        """Every key of *channels*."""
        return cls({channel: _sorted_ids(channel.run()["id"]) for channel in channels if len(channel)})

    def ids(self, channel: Channel) -> Ids:
        """Ids of the selected keys of *channel*, increasing; empty if there are none."""
        return self._ids.get(channel, NO_IDS)

    @property
    def channels(self) -> tuple[Channel, ...]:
        """The channels with a selected key, in the order in which they came in."""
        return tuple(self._ids)

    @property
    def count(self) -> int:
        """Number of selected keys."""
        return self._count

    def contains(self, channel: Channel, key_id: int) -> bool:
        """Whether this key is selected."""
        column = self._ids.get(channel)
        if column is None:
            return False
        place = int(column.searchsorted(key_id))
        return place < len(column) and int(column[place]) == key_id

    def keys(self) -> Iterator[tuple[Channel, int]]:
        """Every selected key as (channel, id)."""
        for channel, column in self._ids.items():
            for key_id in column.tolist():
                yield channel, key_id

    def union(self, other: "Selection") -> "Selection":
        """The keys of both."""
        return self._combined(other, _united)

    def toggled(self, other: "Selection") -> "Selection":
        """The keys of one but not of both."""
        return self._combined(other, _in_one)

    def minus(self, other: "Selection") -> "Selection":
        """The keys that *other* does not hold."""
        return Selection(
            {
                channel: ids_without(column, other._ids[channel]) if channel in other._ids else column
                for channel, column in self._ids.items()
            }
        )

    def with_only(self, channels: Iterable[Channel]) -> "Selection":
        """The keys of these channels alone."""
        wanted = set(channels)
        return Selection({channel: column for channel, column in self._ids.items() if channel in wanted})

    def pruned(self, channels: Iterable[Channel]) -> "Selection":
        """The keys that still exist in one of *channels*."""
        kept = {}
        for channel in self.with_only(channels).channels:
            column = self._ids[channel]
            alive = channel.holds(column)
            kept[channel] = column if alive.all() else column[alive]
        return Selection(kept)

    def _combined(self, other: "Selection", combine: Callable[[Ids, Ids], Ids]) -> "Selection":
        ids = dict(self._ids)
        for channel, column in other._ids.items():
            ids[channel] = combine(ids[channel], column) if channel in ids else column
        return Selection(ids)

    __or__ = union
    __sub__ = minus
    __xor__ = toggled

    def __bool__(self) -> bool:
        return bool(self._ids)

    def __len__(self) -> int:
        return self.count

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        if not isinstance(other, Selection) or self._ids.keys() != other._ids.keys():
            return False
        return all(np.array_equal(column, other._ids[channel]) for channel, column in self._ids.items())

    def __hash__(self) -> int:
        return hash(frozenset((channel, column.tobytes()) for channel, column in self._ids.items()))

    def __repr__(self) -> str:
        return f"Selection({', '.join(f'{channel.name}: {len(ids)} keys' for channel, ids in self._ids.items())})"


Selection.NONE = Selection({})
