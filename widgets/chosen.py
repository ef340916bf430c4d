"""Chosen keys: the few selected keys of a channel with their neighbours, read once for each change of it."""

from typing import TYPE_CHECKING, Final, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from model.channel import Channel
from model.keyframe import Run
from model.selection import Ids

if TYPE_CHECKING:
    from widgets.layers.keys import Marks
    from widgets.stage import Stage
    from widgets.traces import Trace

# With more selected keys in view than this, handles would hide the curves; and keys are read as columns.
MOST: Final = 64


class Key(NamedTuple):
    """One key as Python numbers, in the order of KEY_DTYPE."""

    time: float
    value: float
    slope_in: float
    slope_out: float
    rule_in: int
    rule_out: int
    broken: bool
    id: int


class ChosenKey(NamedTuple):
    """A selected key and its neighbours."""

    key: Key
    before: Key | None
    after: Key | None


class Reading(NamedTuple):
    """What was read of a channel, and when."""

    revision: int
    ids: Ids
    keys: tuple[ChosenKey, ...]


class Sight(NamedTuple):
    """What very many selected keys of a channel cover in the window, and when that was looked for."""

    revision: int
    ids: Ids
    boxes: NDArray[np.int32]


class Seen(NamedTuple):
    """The selected keys of a channel in the window, and when they were read."""

    revision: int
    ids: Ids
    run: Run


class ManySelected(NamedTuple):
    """What there is to be seen of more than MOST selected keys, and of what that was worked out."""

    chosen: "tuple[tuple[Trace, Ids], ...]"
    revisions: tuple[int, ...]
    merged: "list[tuple[Trace, Ids]]"  # those that are too many for marks
    marks: "Marks | None"


def few_chosen(stage: "Stage", channel: Channel, ids: Ids) -> tuple[ChosenKey, ...]:
    """The selected keys *ids*, which are few, in the order of time; those that are gone are left out."""
    known = stage.readings.get(channel)
    if known is None or known.revision != channel.revision or known.ids is not ids:
        keys = sorted(with_neighbours(channel, key_id) for key_id in ids.tolist() if key_id in channel)
        known = stage.readings[channel] = Reading(channel.revision, ids, tuple(keys))
    return known.keys


def with_neighbours(channel: Channel, key_id: int) -> ChosenKey:
    """The key with this id; KeyGoneError if there is none."""
    run, i = channel.keys_around(key_id)
    near = keys_from(run.tolist())
    return ChosenKey(near[i], near[i - 1] if i else None, near[i + 1] if i + 1 < len(near) else None)


def keys_from(rows: list[tuple[object, ...]]) -> list[Key]:
    """The rows of a run, as its `tolist` gives them."""
    return [Key(*cast("Key", row)) for row in rows]
