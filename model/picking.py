"""Picking: certain keys of a channel looked up by their ids, and not read with those between them."""

import numpy as np
from numpy.typing import NDArray

from model.keyframe import KEY_DTYPE, KeyGoneError, Run
from model.rows import MARK_FIELDS, NUMBER_FIELDS, VALUE, Rows, Slots

# In channels of fewer rows all keys are looked through for those with certain ids.
MOST_LOOKED_THROUGH = 8


def slots_of(rows: Rows, ids: NDArray[np.int64]) -> Slots:
    """The slots of the keys with these ids (at least one), sorted, each once; KeyGoneError if one is gone."""
    row_of = rows.row_of.take(ids, mode="clip")
    if ids.min() <= 0 or ids.max() >= len(rows.row_of):
        row_of[(ids <= 0) | (ids >= len(rows.row_of))] = -1
    if row_of.min() < 0:
        raise KeyGoneError(f"there is no key with id {ids[int((row_of < 0).argmax())]}")
    wanted = np.zeros(len(rows.row_of), np.bool_)
    wanted[ids] = True
    if rows.rows < MOST_LOOKED_THROUGH:
        (slots,) = wanted.take(rows.ids).nonzero()
    else:
        touched = np.flatnonzero(np.bincount(row_of))
        row, place = wanted.take(rows.id_grid.take(touched, axis=0)).nonzero()
        slots = touched.take(row) * rows.width + place
    # The spare slots of a row repeat its last key.
    found = rows.ids.take(slots)
    first = np.ones(len(slots), np.bool_)
    np.not_equal(found[1:], found[:-1], out=first[1:])
    return slots[first]


def keys_at(rows: Rows, slots: Slots) -> Run:
    """The keys that these slots hold or repeat."""
    run = np.empty(len(slots), KEY_DTYPE)
    for field, column in NUMBER_FIELDS:
        run[field] = rows.numbers[column].take(slots)
    for field, column in MARK_FIELDS:
        run[field] = rows.marks[column].take(slots)
    run["id"] = rows.ids.take(slots)
    return run


def extent_of(rows: Rows, ids: NDArray[np.int64]) -> tuple[float, float, float, float] | None:
    """(first time, last time, lowest value, highest value) of the keys with these ids, each once and some maybe gone.

    None if all of them are gone.
    """
    if len(ids) and not 0 < ids.min() <= ids.max() < len(rows.row_of):
        ids = ids[(ids > 0) & (ids < len(rows.row_of))]
    row_of = rows.row_of.take(ids)
    if row_of.min(initial=0) < 0:
        ids = ids[row_of >= 0]
    if not len(ids):
        return None
    if len(ids) == rows.size:
        # Spare slots repeat keys.
        times, values = rows.numbers[: VALUE + 1]
    else:
        times, values = rows.numbers[: VALUE + 1].take(slots_of(rows, ids), axis=1)
    return float(times[0]), float(times[-1]), float(values.min()), float(values.max())
