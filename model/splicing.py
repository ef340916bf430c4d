"""What a splice must satisfy, what it rebuilds (slopes by rule, coefficients), and how far its effect reaches."""

from itertools import pairwise
from math import copysign, inf, isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model import hermite
from model.extrapolation import EXTRAPOLATIONS, Extrapolation
from model.hermite import Floats
from model.keyframe import KEY_DTYPE, KeyGoneError, Run, TangentRule
from model.rows import NUMBER_FIELDS, SLOPE_IN, SLOPE_OUT, TIME, VALUE, Rows
from model.tangents import TANGENT_RULES, slope_pair, slopes_of

# How far beyond the ids handed out so far a given id may lie; more is taken for a damaged record.
ID_GAP = 1 << 24
# Keys checked or rebuilt at a time: their columns stay in the processor's cache.
AT_A_TIME = 8192
# Up to so many keys are rebuilt in Python numbers, which is quicker than numpy on short columns.
FEW = 8
# From so many ids on, a flag for every id that ever was is quicker than sets.
MANY = 1000

IN_RULES = np.array([rule in TANGENT_RULES and rule != TangentRule.STEP for rule in range(256)])
OUT_RULES = np.array([rule in TANGENT_RULES for rule in range(256)])
# Both rules of a key as one number, and what each of the 65536 there can be stands for.
assert KEY_DTYPE.fields is not None
_PAIR_OF_RULES = np.dtype(
    {"names": ["rules"], "formats": ["u2"], "offsets": [KEY_DTYPE.fields["rule_in"][1]], "itemsize": KEY_DTYPE.itemsize}
)
_BYTES = np.arange(65536, dtype=np.uint16).view(np.uint8).reshape(-1, 2)
_UNKNOWN, _BY_RULE, _FIXED = range(3)
_KIND_OF_PAIR = np.where(IN_RULES[_BYTES[:, 0]] & OUT_RULES[_BYTES[:, 1]], _BY_RULE, _UNKNOWN).astype(np.uint8)
_KIND_OF_PAIR[(_KIND_OF_PAIR == _BY_RULE) & (_BYTES == TangentRule.FIXED).any(axis=1)] = _FIXED


class Outer(NamedTuple):
    """What a splice may change outside its run: the tangents of the neighbours, and how the ends go on.

    Numbers whose sign of zero matters are here as the integers that have their bits.
    """

    time_before: float  # of the neighbour before the run; -inf without one
    time_after: float  # of the neighbour after; inf without one
    slope_before: int  # slope in of the neighbour before
    slope_after: int  # slope out of the neighbour after
    first: tuple[int, int, int]  # time, value and slope in of the first key
    last: tuple[int, int, int]  # time, value and slope out of the last key


# --- what a run must be


def rank_of_run(rows: Rows, before: Run, after: Run) -> int:
    """The rank at which *before* begins, or *after* belongs if *before* is empty; ValueError if it is not there."""
    if len(before) == 0:
        return rows.rank_at(float(after["time"][0])) if len(after) else 0
    try:
        rank = rows.rank_of(int(before["id"][0]))
    except KeyGoneError as error:
        raise ValueError(f"the run to replace is not in the channel: {error}") from None
    end = rank + len(before)
    if end <= rows.size and (len(before) == 1 or _stand_at(rows, rank, before)):
        return rank
    raise ValueError("the run to replace is not what the channel holds now")


def _stand_at(rows: Rows, rank: int, run: Run) -> bool:
    """Whether the keys from *rank* on are those of *run*."""
    start = rows.start
    if start is not None and not start.left and start.holds(run):
        return rows.rank_of(int(run["id"][-1])) == rank + len(run) - 1
    return rows.same_ids(rank, run["id"])


def have_same_ids(run: Run, other: Run) -> bool:
    """Whether two runs of equal length hold the same keys in the same order."""
    ids, others = run["id"], other["id"]
    if len(run) == 1:
        return bool(ids[0] == others[0])
    return all((ids[at : at + AT_A_TIME] == others[at : at + AT_A_TIME]).all() for at in range(0, len(run), AT_A_TIME))


class Given(NamedTuple):
    """What a run that can stand where it is to stand holds."""

    minus_zero: bool  # whether a value is -0.0
    slopes: bool  # whether a side is fixed: only there do slopes count that are given


def check_run(run: Run, time_before: float, time_after: float) -> Given:
    """Raise ValueError, naming key and field, unless *run* can stand between keys of these times."""
    if len(run) <= 2 * FEW:
        return _check_few(run, time_before, time_after)
    minus_zero = slopes = False
    last = time_before
    numbers = np.empty((4, min(len(run), AT_A_TIME)))
    with np.errstate(all="ignore"):
        for at in range(0, len(run), AT_A_TIME):
            part = run[at : at + AT_A_TIME]
            columns = numbers[:, : len(part)]
            for field, column in NUMBER_FIELDS:
                columns[column] = part[field]
            # A sum is finite only if all its terms are; one that is not may still be of finite terms.
            kind = _kind_of_rules(part)
            if not isfinite(columns.sum()) or not kind:
                _refuse_numbers_or_rules(part, at)
            slopes |= kind == _FIXED
            times, values = columns[TIME], columns[VALUE]
            if times[0] <= last or not (times[1:] > times[:-1]).all():
                before = np.append(last, times[:-1])
                bad = int((times <= before).argmax())
                what = f"key {at + bad}: time {float(times[bad])!r} is not after {float(before[bad])!r}"
                raise ValueError(f"{what}, the time of the key before")
            last = float(times[-1])
            if not values.all():
                minus_zero |= bool(np.signbit(values[values == 0.0]).any())
    _check_last(run, last, time_after)
    return Given(minus_zero, slopes)


def _kind_of_rules(part: Run) -> int:
    """_UNKNOWN if a side has no rule there can be, else _FIXED if one is fixed, else _BY_RULE."""
    rules = part.view(_PAIR_OF_RULES)["rules"]
    first = rules[0]
    if (rules == first).all():
        return int(_KIND_OF_PAIR[first])
    kinds = _KIND_OF_PAIR[rules]
    return _UNKNOWN if kinds.min() == _UNKNOWN else int(kinds.max())


def _check_few(run: Run, last: float, time_after: float) -> Given:
    """The same for a few keys, in Python numbers."""
    minus_zero = False
    for place, (time, value, slope_in, slope_out, rule_in, rule_out, _, _) in enumerate(run.tolist()):
        if not (isfinite(time) and isfinite(value) and isfinite(slope_in) and isfinite(slope_out)):
            _refuse_numbers_or_rules(run, 0)
        if not (IN_RULES[rule_in] and OUT_RULES[rule_out]):
            _refuse_numbers_or_rules(run, 0)
        if time <= last:
            raise ValueError(f"key {place}: time {time!r} is not after {last!r}, the time of the key before")
        last = time
        minus_zero |= value == 0.0 and copysign(1.0, value) < 0.0
    _check_last(run, last, time_after)
    return Given(minus_zero, True)


def _check_last(run: Run, last: float, time_after: float) -> None:
    if len(run) and last >= time_after:
        raise ValueError(f"key {len(run) - 1}: time {last!r} is not before {time_after!r}, the time of the key after")


def _refuse_numbers_or_rules(part: Run, at: int) -> None:
    for field, _ in NUMBER_FIELDS:
        fine = np.isfinite(part[field])
        if not fine.all():
            bad = int(fine.argmin())
            raise ValueError(f"key {at + bad}: {field} is {part[field][bad]}; it must be finite")
    for field, known in (("rule_in", IN_RULES), ("rule_out", OUT_RULES)):
        fine = known[part[field]]
        if not fine.all():
            bad = int(fine.argmin())
            raise ValueError(f"key {at + bad}: {field} is {part[field][bad]}; there is no such rule on this side")


def ids_for(rows: Rows, before: Run, after: Run, next_id: int) -> tuple[NDArray[np.int64] | None, int]:
    """(ids for *after*, or None if it can keep its own; the next id to hand out); ValueError for ids it cannot have."""
    ids = after["id"]
    if not len(ids):
        return None, next_id
    lowest, highest = int(ids.min()), int(ids.max())
    if lowest < 0 or highest >= min(next_id + ID_GAP, 2**31 - 1):
        wrong = lowest if lowest < 0 else highest
        raise ValueError(f"key {int((ids == wrong).argmax())}: id {wrong} was never handed out by this channel")
    next_id = max(next_id, highest + 1)
    fresh = ids == 0
    count = int(fresh.sum())
    if count < len(ids):
        _check_ids(rows, ids[~fresh] if count else ids, before["id"])
    if not count:
        return None, next_id
    filled = ids.copy()
    filled[fresh] = np.arange(next_id, next_id + count)
    return filled, next_id + count


def _check_ids(rows: Rows, ids: NDArray[np.int64], gone: NDArray[np.int64]) -> None:
    """Raise ValueError unless *ids* differ from each other and from those of all keys but the ones that go."""
    if len(ids) + len(gone) <= MANY:
        twice, leaving = len(set(ids.tolist())) < len(ids), set(gone.tolist())
        known = [key_id for key_id in ids.tolist() if key_id < len(rows.row_of) and rows.row_of[key_id] >= 0]
        strangers = [key_id for key_id in known if key_id not in leaving]
    else:
        # A flag for each id: quicker than sorting them.
        flags = np.zeros(max(int(ids.max()) + 1, len(rows.row_of)), np.bool_)
        flags[ids] = True
        twice = int(np.count_nonzero(flags)) < len(ids)
        flags[gone] = False
        flags[: len(rows.row_of)] &= rows.row_of >= 0
        flags[len(rows.row_of) :] = False
        strangers = ids[flags[ids]].tolist()
    if twice:
        raise ValueError("id: two keys of the run have the same one")
    if strangers:
        raise ValueError(f"id {strangers[0]} belongs to a key outside the run")


# --- what follows from a run


def rebuild(rows: Rows, rank0: int, rank1: int) -> None:
    """Work out what follows from the keys of ranks rank0 to rank1 being new.

    That is their slopes and those of their neighbours, and the coefficients of all spans that these touch.
    """
    slopes0, slopes1 = max(rank0 - 1, 0), min(rank1 + 1, rows.size)
    spans0 = max(rank0 - 2, 0)
    if slopes1 - spans0 <= 2 * FEW:
        _rebuild_few(rows, spans0, slopes0, slopes1)
        return
    _rebuild_many(rows, spans0, slopes1)


def _rebuild_few(rows: Rows, spans0: int, slopes0: int, slopes1: int) -> None:
    # One key more on each side, for chords and for the last span.
    left, right = max(spans0 - 1, 0), min(slopes1 + 1, rows.size)
    (times, values, slopes_in, slopes_out), (rules_in, rules_out) = rows.few(left, right)
    n = right - left
    for i in range(slopes0 - left, slopes1 - left):
        j, k = max(i - 1, 0), min(i + 2, n)
        slopes_in[i], slopes_out[i] = slope_pair(
            times[j:k], values[j:k], i - j, rules_in[i], rules_out[i], slopes_in[i], slopes_out[i]
        )
    out = []
    for i in range(spans0 - left, slopes1 - left):
        a = b = c = 0.0
        d_time = 1.0
        if i + 1 < n:
            d_time = times[i + 1] - times[i]
            if rules_out[i] != TangentRule.STEP:
                a, b, c = hermite.coefficients(d_time, values[i], values[i + 1], slopes_out[i], slopes_in[i + 1])
        out.append((slopes_in[i], slopes_out[i], a, b, c, d_time))
    if out:
        rows.write(spans0, SLOPE_IN, np.array(out).T)


def _rebuild_many(rows: Rows, rank0: int, rank1: int) -> None:
    """Slopes and coefficients of the keys rank0 to rank1, some rows at a time; slopes worked out twice are the same."""
    cuts = rows.cuts(rank0, rank1)
    most = max(end - begin for begin, end in pairwise(cuts))
    # Memory that is asked for anew for each part would cost as much as the work on it.
    keys, out = np.empty((4, most + 3)), np.empty((6, most))
    with np.errstate(all="ignore"):
        for begin, end in pairwise(cuts):
            _rebuild_part(rows, begin, end, keys, out[:, : end - begin])


def _rebuild_part(rows: Rows, rank0: int, rank1: int, keys: Floats, out: Floats) -> None:
    # One key before, one after for the last span, and that key's other neighbour for its slope.
    left, right = max(rank0 - 1, 0), min(rank1 + 2, rows.size)
    rule_in, rule_out = rows.rules(left, right)
    # Slopes that were given count where a side is fixed, and nowhere else.
    given = bool((rule_in == TangentRule.FIXED).any() or (rule_out == TangentRule.FIXED).any())
    n = keys[:, : right - left]
    rows.columns(
        left, right, stop=SLOPE_OUT + 1 if given else VALUE + 1, into=n[: SLOPE_OUT + 1 if given else VALUE + 1]
    )
    slope_in, slope_out = slopes_of(n[TIME], n[VALUE], n[SLOPE_IN], n[SLOPE_OUT], rule_in, rule_out)
    here, spans = slice(rank0 - left, rank1 - left), slice(rank0 - left, min(rank1, rows.size - 1) - left)
    after = slice(spans.start + 1, spans.stop + 1)
    out[0], out[1] = slope_in[here], slope_out[here]
    count = spans.stop - spans.start
    d_time = np.subtract(n[TIME, after], n[TIME, spans], out=out[5, :count])
    out[2, :count], out[3, :count], out[4, :count] = hermite.coefficients(
        d_time, n[VALUE, spans], n[VALUE, after], slope_out[spans], slope_in[after]
    )
    held = rule_out[here] == TangentRule.STEP
    if held.any():
        out[2:5, held] = 0.0
    if rank1 == rows.size:
        out[2:5, -1], out[5, -1] = 0.0, 1.0
    rows.write(rank0, SLOPE_IN, out)


# --- how far a splice reaches


def outer(rows: Rows, rank0: int, rank1: int) -> Outer:
    """What lies around the keys of ranks rank0 to rank1."""
    bits = rows.bits
    time_before, time_after, slope_before, slope_after = -inf, inf, 0, 0
    if rank0 > 0:
        slot = rows.slot(rank0 - 1)
        time_before, slope_before = float(rows.times[slot]), int(bits[SLOPE_IN, slot])
    if rank1 < rows.size:
        slot = rows.slot(rank1)
        time_after, slope_after = float(rows.times[slot]), int(bits[SLOPE_OUT, slot])
    first, last = bits[:, 0].tolist(), bits[:, -1].tolist()
    return Outer(
        time_before,
        time_after,
        slope_before,
        slope_after,
        (first[TIME], first[VALUE], first[SLOPE_IN]),
        (last[TIME], last[VALUE], last[SLOPE_OUT]),
    )


def reach(
    rows: Rows,
    rank0: int,
    rank1: int,
    old: Outer,
    old_times: tuple[float, float],
    pre: Extrapolation,
    post: Extrapolation,
) -> tuple[float, float]:
    """(t0, t1) of what changed, now that the keys of ranks rank0 to rank1 stand where *old* was around others.

    *old_times* are those of the first and last key replaced.
    """
    new = outer(rows, rank0, rank1)
    t0, t1 = new.time_before, new.time_after
    if t0 == -inf:
        t0 = min(old_times[0], float(rows.times[0]))
    elif old.slope_before != new.slope_before and rank0 > 1:
        t0 = float(rows.times[rows.slot(rank0 - 2)])
    if t1 == inf:
        t1 = max(old_times[1], float(rows.times[-1]))
    elif old.slope_after != new.slope_after and rank1 + 1 < rows.size:
        t1 = float(rows.times[rows.slot(rank1 + 1)])
    if _goes_on_differently(old.first, new.first, pre):
        t0 = -inf
    if _goes_on_differently(old.last, new.last, post):
        t1 = inf
    return t0, t1


def _goes_on_differently(old: tuple[int, int, int], new: tuple[int, int, int], mode: Extrapolation) -> bool:
    """Whether the curve beyond an end key changed, from that key's time, value and outward slope."""
    if EXTRAPOLATIONS[mode].repeats:
        return True
    return old != new if mode is Extrapolation.LINEAR else old[1] != new[1]
