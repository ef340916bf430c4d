"""What a splice must satisfy, and what it rebuilds: slopes by rule and coefficients around the new keys."""

import numpy as np

from model import hermite
from model.extrapolation import EXTRAPOLATIONS, Extrapolation
from model.hermite import Floats
from model.keyframe import Run, TangentRule
from model.rows import (
    BROKEN,
    D_TIME,
    RULE_IN,
    RULE_OUT,
    SLOPE_IN,
    SLOPE_OUT,
    TIME,
    VALUE,
    A,
    B,
    C,
    Keys,
    Rows,
)
from model.tangents import TANGENT_RULES, slopes_of

# How far beyond the ids handed out so far a given id may lie; more is taken for a damaged record.
ID_GAP = 1 << 24


def rank_of_run(rows: Rows, before: Run, after: Run) -> int:
    """The rank at which *before* begins, or *after* belongs if *before* is empty; ValueError if it is not there."""
    if len(before) == 0:
        return rows.rank_at(float(after["time"][0])) if len(after) and after["time"][0] == after["time"][0] else 0
    try:
        rank = rows.rank_of(int(before["id"][0]))
    except LookupError as error:
        raise ValueError(f"cannot replace key 0 of the run: {error}") from None
    if rank + len(before) > rows.size or not np.array_equal(
        rows.ids[rows.slots(rank, rank + len(before))], before["id"]
    ):
        raise ValueError("the run to replace is not what the channel holds now")
    return rank


def checked(rows: Rows, rank: int, before: Run, after: Run, next_id: int) -> tuple[Keys, int]:
    """*after* as columns with ids for all, and the next id to hand out; ValueError names key and field."""
    keys = Keys.empty(len(after))
    if not len(after):
        return keys, next_id
    for column, field in ((TIME, "time"), (VALUE, "value"), (SLOPE_IN, "slope_in"), (SLOPE_OUT, "slope_out")):
        keys.numbers[column] = after[field]
        if not np.isfinite(keys.numbers[column]).all():
            bad = int(np.flatnonzero(~np.isfinite(after[field]))[0])
            raise ValueError(f"key {bad}: {field} is {after[field][bad]}; it must be finite")
    for mark, field in ((RULE_IN, "rule_in"), (RULE_OUT, "rule_out")):
        keys.marks[mark] = after[field]
        for rule in np.unique(after[field]).tolist():
            if rule not in TANGENT_RULES or (mark == RULE_IN and rule == TangentRule.STEP):
                bad = int(np.flatnonzero(after[field] == rule)[0])
                raise ValueError(f"key {bad}: {field} is {rule}; there is no such rule on this side")
    keys.marks[BROKEN] = after["broken"]
    _check_order(rows, rank, rank + len(before), keys.numbers[TIME])
    keys.ids[:], next_id = _ids(rows, before, after, next_id)
    return keys, next_id


def _check_order(rows: Rows, rank0: int, rank1: int, times: Floats) -> None:
    turned = times[1:] <= times[:-1]
    if turned.any():
        bad = int(turned.argmax()) + 1
        raise ValueError(f"key {bad}: time {times[bad]!r} is not after {times[bad - 1]!r}, the time of the key before")
    if rank0 > 0 and times[0] <= (left := rows.times[rows.slot(rank0 - 1)]):
        raise ValueError(f"key 0: time {times[0]!r} is not after {left!r}, the time of the neighbour before")
    if rank1 < rows.size and times[-1] >= (right := rows.times[rows.slot(rank1)]):
        raise ValueError(f"key {len(times) - 1}: time {times[-1]!r} is not before {right!r}, the time of the neighbour")


def _ids(rows: Rows, before: Run, after: Run, next_id: int) -> tuple[np.ndarray, int]:
    ids = after["id"].astype(np.int64)
    if ids.min() < 0 or ids.max() >= min(next_id + ID_GAP, 2**31 - 1):
        raise ValueError(f"key {int(ids.argmax())}: id {ids.max()} was never handed out by this channel")
    fresh = ids == 0
    given = ids[~fresh]
    next_id = max(next_id, int(given.max()) + 1 if len(given) else 0)
    if not np.array_equal(given, before["id"]):
        if len(np.unique(given)) < len(given):
            raise ValueError("two keys of the run have the same id")
        known = given[given < len(rows.row_of)]
        there = np.setdiff1d(known[rows.row_of[known] >= 0], before["id"])
        if len(there):
            raise ValueError(f"id {there[0]} belongs to a key outside the run")
    ids[fresh] = np.arange(next_id, next_id + int(fresh.sum()))
    return ids, next_id + int(fresh.sum())


def rebuild(keys: Keys, begin: int, end: int, *, at_first: bool, at_last: bool) -> None:
    """Work out the slopes of keys begin to end, and the coefficients of all spans but what follows the window.

    *keys* is a window of neighbours; at_first and at_last say whether it begins and ends where the channel does.
    """
    n, m = keys.numbers, keys.marks
    slopes_in, slopes_out = slopes_of(n[TIME], n[VALUE], n[SLOPE_IN], n[SLOPE_OUT], m[RULE_IN], m[RULE_OUT])
    n[SLOPE_IN, begin:end], n[SLOPE_OUT, begin:end] = slopes_in[begin:end], slopes_out[begin:end]
    with np.errstate(all="ignore"):
        n[D_TIME, :-1] = n[TIME, 1:] - n[TIME, :-1]
        n[A, :-1], n[B, :-1], n[C, :-1] = hermite.coefficients(
            n[D_TIME, :-1], n[VALUE, :-1], n[VALUE, 1:], n[SLOPE_OUT, :-1], n[SLOPE_IN, 1:]
        )
    held = np.flatnonzero(m[RULE_OUT] == TangentRule.STEP)
    n[A : C + 1, held] = 0.0
    if at_last and keys.count:
        n[A : C + 1, -1], n[D_TIME, -1] = 0.0, 1.0


def spliced(
    rows: Rows, rank: int, gone: int, new: Keys, pre: Extrapolation, post: Extrapolation
) -> tuple[float, float, int]:
    """Put *new* in the place of *gone* keys at *rank*: (t0, t1) of what changed, and how many keys were stored."""
    if not gone and not new.count:
        return np.inf, -np.inf, 0
    left, right = max(0, rank - 2), min(rows.size, rank + gone + 2)
    old = rows.gathered(left, right)
    begin, old_end = rank - left, rank - left + gone
    end = begin + new.count
    window = Keys.joined(old[:begin], new, old[old_end:])
    at_first, at_last = left == 0, right == rows.size
    touched = slice(max(0, begin - 1), min(window.count, end + 1))
    rebuild(window, touched.start, touched.stop, at_first=at_first, at_last=at_last)
    t0, t1 = _reach(old, window, begin, old_end, end, at_first, at_last, pre, post)
    rows.replace(left, right, window)
    return t0, t1, new.count


def _reach(
    old: Keys,
    new: Keys,
    begin: int,
    old_end: int,
    end: int,
    at_first: bool,
    at_last: bool,
    pre: Extrapolation,
    post: Extrapolation,
) -> tuple[float, float]:
    if not old.count or not new.count:
        return -np.inf, np.inf
    t0 = min(old.numbers[TIME, max(begin - 1, 0)], new.numbers[TIME, max(begin - 1, 0)])
    if begin > 1 and _bits(old, SLOPE_IN, begin - 1) != _bits(new, SLOPE_IN, begin - 1):
        t0 = old.numbers[TIME, begin - 2]
    old_next, new_next = min(old_end, old.count - 1), min(end, new.count - 1)
    t1 = max(old.numbers[TIME, old_next], new.numbers[TIME, new_next])
    if old_end + 1 < old.count and _bits(old, SLOPE_OUT, old_end) != _bits(new, SLOPE_OUT, end):
        t1 = old.numbers[TIME, old_end + 1]
    if EXTRAPOLATIONS[pre].repeats or (at_first and _end_changed(old, new, 0, SLOPE_IN, pre)):
        t0 = -np.inf
    if EXTRAPOLATIONS[post].repeats or (at_last and _end_changed(old, new, -1, SLOPE_OUT, post)):
        t1 = np.inf
    return float(t0), float(t1)


def _bits(keys: Keys, column: int, place: int) -> bytes:
    return keys.numbers[column, place].tobytes()


def _end_changed(old: Keys, new: Keys, place: int, slope: int, mode: Extrapolation) -> bool:
    columns = (TIME, VALUE, slope) if mode is Extrapolation.LINEAR else (VALUE,)
    return any(_bits(old, column, place) != _bits(new, column, place) for column in columns)


def check(rows: Rows, next_id: int) -> None:
    """Assert what must hold of *rows*: order, finite numbers, links, ids, padding, slopes and coefficients."""
    rows.check()
    keys = rows.gathered(0, rows.size)
    assert np.isfinite(keys.numbers[[TIME, VALUE, SLOPE_IN, SLOPE_OUT]]).all()
    assert keys.count == 0 or int(keys.ids.max()) < next_id
    again = Keys(keys.numbers.copy(), keys.marks.copy(), keys.ids.copy())
    rebuild(again, 0, again.count, at_first=True, at_last=True)
    assert again.numbers.tobytes() == keys.numbers.tobytes(), "slopes or coefficients are not what the rules say"
