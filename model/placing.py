"""Placing: how keys are taken out of a channel and put in at other times, by splices of as few keys as it takes."""

from math import ulp

import numpy as np
from numpy.typing import NDArray

from model.change import Splice
from model.channel import Channel
from model.hermite import LARGEST, Floats
from model.keyframe import KEY_DTYPE, Run

# A splice costs about as much as some hundred keys in it, so places with no more keys than this between them share one;
# what an undo step of one key holds stays below 64 KiB.
FEW = 512
FEW_EACH = 16
MOST_SPLICES = 64

NO_KEYS: Run = np.empty(0, KEY_DTYPE)
NO_KEYS.flags.writeable = False

_MAGNITUDE = np.int64(2**63 - 1)


def placed(channel: Channel, removed: Run, rows: Run, *, slack: float = 0.0) -> list[Splice]:
    """Splices that take the keys *removed* out of *channel* and put *rows* in, both in strictly increasing time.

    A row at the time of another key covers it: that key is left out. A row no more than *slack* seconds away from
    another key takes over its time first, since only rounding has kept them apart.
    """
    ends = [float(run["time"][end]) for run in (removed, rows) if len(run) for end in (0, -1)]
    if not ends:
        return []
    if channel.count_between(min(ends) - slack, max(ends) + slack) == len(removed):
        return [Splice(channel, removed, rows)]  # nothing else lies between their old and new places
    places = np.sort(np.concatenate([removed["time"], rows["time"]]))
    parts = _in_possible_order(_clusters(channel, places, slack), removed, rows)
    if len(parts) == 1:
        return [_splice(channel, *parts[0], removed, rows, slack)]
    splices = (_splice(channel, t0, t1, _between(removed, t0, t1), _between(rows, t0, t1), slack) for t0, t1 in parts)
    return [splice for splice in splices if len(splice.before) or len(splice.after)]


def _splice(channel: Channel, t0: float, t1: float, gone: Run, come: Run, slack: float) -> Splice:
    """*gone* give way to *come*, all of which lie between *t0* and *t1*."""
    before = channel.keys_between(t0 - slack, t1 + slack)
    if len(gone) == len(before):
        return Splice(channel, before, come)
    stays = np.ones(len(before), np.bool_)
    stays[before["time"].searchsorted(gone["time"])] = False
    kept = before[stays]
    after = _merged(kept, come)
    times = after["time"]
    if (times[1:] - times[:-1]).min(initial=np.inf) <= slack:
        come, covered = _landed(come, kept, slack)
        after = _merged(kept[~covered], come)
    return Splice(channel, before, after)


def _merged(kept: Run, come: Run) -> Run:
    """The keys of both in the order of their times."""
    # Joining records by numpy's own means compares their fields one by one, each time.
    after = np.empty(len(kept) + len(come), KEY_DTYPE)
    new = np.zeros(len(after), np.bool_)
    new[kept["time"].searchsorted(come["time"]) + np.arange(len(come))] = True
    after[new], after[~new] = come, kept
    return after


def _landed(rows: Run, kept: Run, slack: float) -> tuple[Run, NDArray[np.bool_]]:
    """*rows* at the exact times of the keys of *kept* they land on, and which of those they cover."""
    covered = np.zeros(len(kept), np.bool_)
    if not len(rows) or not len(kept):
        return rows, covered
    times, others = rows["time"], kept["time"]
    right = others.searchsorted(times).clip(max=len(others) - 1)
    left = (right - 1).clip(min=0)
    with np.errstate(over="ignore"):
        nearest = np.where(np.abs(others[right] - times) <= np.abs(others[left] - times), right, left)
        hit = np.abs(others[nearest] - times) <= slack
    landed = np.where(hit, others[nearest], times)
    if slack and not (landed[1:] > landed[:-1]).all():
        return _landed(rows, kept, 0.0)  # the keys are as near to each other as the slack: only what is equal counts
    covered[nearest[hit]] = True
    if slack and hit.any():
        rows = rows.copy()
        rows["time"] = landed
    return rows, covered


def _between(run: Run, t0: float, t1: float) -> Run:
    times = run["time"]
    return run[times.searchsorted(t0) : times.searchsorted(t1, "right")]


def _clusters(channel: Channel, places: Floats, slack: float) -> list[tuple[float, float]]:
    """Intervals around *places* (at least one) that leave out the widest stretches in which none of them lies.

    They are more than twice *slack* apart, so that no key falls to two of them.
    """
    first, last = float(places[0]), float(places[-1])
    if len(places) == 1 or channel.count_between(first, last) <= FEW_EACH * len(places) + FEW:
        return [(first, last)]
    gaps = places[1:] - places[:-1]
    wide = np.arange(len(gaps))
    if len(gaps) >= MOST_SPLICES:
        wide = np.sort(np.argpartition(gaps, -MOST_SPLICES)[1 - MOST_SPLICES :])
    wide = wide[gaps[wide] > 2.0 * slack]
    cuts = [i for i in wide.tolist() if channel.count_between(float(places[i]), float(places[i + 1])) > FEW]
    begins, ends = [0, *(i + 1 for i in cuts)], [*cuts, len(places) - 1]
    return [(float(places[begin]), float(places[end])) for begin, end in zip(begins, ends, strict=True)]


def _in_possible_order(parts: list[tuple[float, float]], removed: Run, rows: Run) -> list[tuple[float, float]]:
    """*parts* in an order in which every key is taken out before it is put in; one part where there is none such."""
    if len(parts) == 1 or not len(removed) or not len(rows):
        return parts
    times_out, times_in = removed["time"], rows["time"]
    if len(removed) != len(rows) or not (removed["id"] == rows["id"]).all():
        kept = np.flatnonzero(rows["id"])
        _, old, new = np.intersect1d(removed["id"], rows["id"][kept], assume_unique=True, return_indices=True)
        times_out, times_in = times_out[old], times_in[kept[new]]
    ends = np.array([t1 for _, t1 in parts])
    out, into = ends.searchsorted(times_out), ends.searchsorted(times_in)
    if (out <= into).all():
        return parts
    if (out >= into).all():
        return parts[::-1]
    return [(parts[0][0], parts[-1][1])]


def strictly_increasing(times: Floats) -> Floats:
    """*times*, which never fall, with equal ones moved to the next numbers that a double can hold."""
    if len(times) == 1 or (times[1:] > times[:-1]).all():
        return times
    # The bits of a double without its sign, with that sign, are integers in the order of the doubles.
    bits = times.view(np.int64)
    magnitudes = bits & _MAGNITUDE
    steps = np.arange(len(times))
    places = np.maximum.accumulate(np.where(bits < 0, -magnitudes, magnitudes) - steps) + steps
    top = np.float64(LARGEST).view(np.int64)
    places = np.minimum(places, top - steps[::-1])
    increasing: Floats = np.copysign(np.abs(places).view(np.float64), places)
    return increasing


def rounding_slack(keys: Run, rows: Run) -> float:
    """How far apart rounding may have put two times that were meant to be equal, when *keys* have become *rows*."""
    return slack_at(*(float(run["time"][end]) for run in (keys, rows) for end in (0, -1)))


def slack_at(*times: float) -> float:
    """The same for keys that lie between these times before and after."""
    largest = max(map(abs, times))
    return 4.0 * ulp(largest) if largest < LARGEST else 0.0
