"""Hop: one key moved, past others or not, in the rows where they are.

Nothing that a splice must make sure of can be wrong: the key was there before, and neither its rules nor its id change.
"""

from math import copysign
from typing import NamedTuple

from model import splicing
from model.extrapolation import Extrapolation
from model.hermite import LARGEST
from model.keyframe import Run
from model.rows import TIME, VALUE, Rows


class Hopped(NamedTuple):
    """What of the curve has changed, where the key is now with all that depends on it, whether it passed others."""

    t0: float
    t1: float
    near: tuple[float, float]
    passed: bool


def hop(
    rows: Rows, key: Run, d_time: float, d_value: float, slack: float, pre: Extrapolation, post: Extrapolation
) -> Hopped | None:
    """Move *key*; None, and nothing has changed, if it would come within *slack* seconds of another or has no room."""
    key_time, key_value, *_, key_id = key.tolist()[0]
    time, value = _sum(key_time, d_time), _sum(key_value, d_value)
    rank = rows.rank_of(key_id)
    # The keys with earlier times, itself not counted, are as many as its rank will be.
    new_rank = rank if time == key_time else rows.rank_at(time, after=False) - (time > key_time)
    if _is_near_another(rows, rank, new_rank, time, slack) or not _has_room(rows, rank, new_rank):
        return None
    low, high = min(rank, new_rank), max(rank, new_rank)
    old, old_times = splicing.outer(rows, low, high + 1), (_time(rows, low), _time(rows, high))
    rows.minus_zero |= value == 0.0 and copysign(1.0, value) < 0.0
    if low < high:
        _carry(rows, rank, new_rank)
    _set(rows, new_rank, time, value)
    if high - low > 1:
        gap = rank + (new_rank < rank)
        splicing.rebuild(rows, gap, gap)
        splicing.rebuild(rows, new_rank, new_rank + 1)
    else:
        splicing.rebuild(rows, low, high + 1)
    t0, t1 = splicing.reach(rows, low, high + 1, old, old_times, pre, post)
    near = _time(rows, max(new_rank - 2, 0)), _time(rows, min(new_rank + 2, rows.size - 1))
    return Hopped(t0, t1, near, low < high)


def _sum(number: float, more: float) -> float:
    """Both together; a sum that no double can hold stops at the end of its range, and 0.0 more is none."""
    return min(max(number + more, -LARGEST), LARGEST) if more else number


def _time(rows: Rows, rank: int) -> float:
    return float(rows.times[rows.slot(rank)])


def _is_near_another(rows: Rows, rank: int, new_rank: int, time: float, slack: float) -> bool:
    """Whether a key that goes from *rank* to *new_rank* comes within *slack* of what is then before or behind it."""
    before, behind = new_rank - (new_rank <= rank), new_rank + (new_rank >= rank)
    if before >= 0 and time - _time(rows, before) <= slack:
        return True
    return behind < rows.size and _time(rows, behind) - time <= slack


def _has_room(rows: Rows, rank: int, new_rank: int) -> bool:
    """Whether the key can leave its row, and another one can take it in."""
    old, new = rows.place(rank)[0], rows.place(new_rank)[0]
    return old == new or (rows.held(old) > 1 and rows.held(new) < rows.width)


def _carry(rows: Rows, rank: int, new_rank: int) -> None:
    """Take the key from *rank* to *new_rank*, with all its numbers and marks."""
    (old_row, old), (row, place) = rows.place(rank), rows.place(new_rank)
    if row == old_row:
        _turn(rows, row, old, place)
        return
    key_id = int(rows.id_grid[old_row, old])
    numbers, marks = rows.number_grid[:, old_row, old].copy(), rows.mark_grid[:, old_row, old].copy()
    rows.make_room(old_row, old, 1, 0)
    place += new_rank > rank  # behind the key that it has passed last
    rows.make_room(row, place, 0, 1)
    rows.number_grid[:, row, place], rows.mark_grid[:, row, place] = numbers, marks
    rows.id_grid[row, place], rows.row_of[key_id] = key_id, row
    rows.dirty.add(old_row)


def _turn(rows: Rows, row: int, old: int, place: int) -> None:
    """Take the key at place *old* of a row to another *place* of it; those between move up."""
    low, high = min(old, place), max(old, place)
    held = rows.held(row)
    rows.keep(row, row + 1, low, rows.width if high + 1 == held else high + 1, keys_move=True)
    for grid in (rows.number_grid, rows.mark_grid, rows.id_grid[None]):
        line = grid[:, row]
        record = line[:, old].copy()
        if place > old:
            line[:, old:place] = line[:, old + 1 : place + 1]
        else:
            line[:, place + 1 : old + 1] = line[:, place:old]
        line[:, place] = record
        if high + 1 == held:
            line[:, held:] = line[:, held - 1 : held]
    if low == 0:
        rows.starts[row] = float(rows.number_grid[TIME, row, 0])


def _set(rows: Rows, rank: int, time: float, value: float) -> None:
    """Give the key of that rank another time and value."""
    row, place = rows.place(rank)
    last = place + 1 == rows.held(row)
    rows.keep(row, row + 1, place, rows.width if last else place + 1, keys_move=False, marks_too=False)
    line = rows.number_grid[:, row]
    line[TIME, place], line[VALUE, place] = time, value
    if place == 0:
        rows.starts[row] = time
    if last:
        for grid in (rows.number_grid, rows.mark_grid, rows.id_grid[None]):
            grid[:, row, place + 1 :] = grid[:, row, place : place + 1]
    rows.dirty.add(row)
