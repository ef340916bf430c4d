"""Within: the keys and the spans of a channel in a box of times and values, found without copying the others."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.hermite import Floats
from model.keyframe import TangentRule
from model.rows import RULE_OUT, SLOPE_IN, SLOPE_OUT, TIME, VALUE, Rows, Slots


class KeysWithin(NamedTuple):
    """Some keys of a channel in the order of time."""

    times: Floats
    values: Floats
    ids: NDArray[np.int64]


class SpansWithin(NamedTuple):
    """Some spans of a channel in the order of time, by what their two keys say of them."""

    time0: Floats
    value0: Floats
    slope0: Floats
    time1: Floats
    value1: Floats
    slope1: Floats
    held: NDArray[np.bool_]


_NO_SLOTS: Slots = np.zeros(0, np.int64)
_NONE = np.empty(0)
NO_KEYS = KeysWithin(_NONE, _NONE, _NO_SLOTS)
NO_SPANS = SpansWithin(_NONE, _NONE, _NONE, _NONE, _NONE, _NONE, np.zeros(0, np.bool_))


def keys_within(rows: Rows, t0: float, t1: float, low: float, high: float) -> KeysWithin:
    """The keys with t0 <= time <= t1 and low <= value <= high."""
    times, values = rows.times, rows.numbers[VALUE]
    first, stop = int(times.searchsorted(t0, "left")), int(times.searchsorted(t1, "right")) if rows.size else 0
    part = values[first:stop]
    (slots,) = ((part >= low) & (part <= high)).nonzero()
    if not len(slots):
        return NO_KEYS
    slots += first
    found = times[slots]
    real = times[slots - 1] != found
    if slots[0] == 0:
        real[0] = True
    if not real.all():  # spare slots repeat the key before them
        slots, found = slots[real], found[real]
    return KeysWithin(found, values[slots], rows.ids[slots].astype(np.int64))


def spans_within(rows: Rows, t0: float, t1: float, low: float, high: float, long: float) -> SpansWithin:
    """The spans that touch [t0, t1] and whose straight lines from key to key touch [low, high]; and all *long* ones.

    A span is long if it lasts more than so many seconds.
    """
    slots = _spans_within(rows, t0, t1, low, high, long) if rows.size else _NO_SLOTS
    if not len(slots):
        return NO_SPANS
    n, nexts = rows.numbers, slots + 1
    held = rows.marks[RULE_OUT][slots] == TangentRule.STEP
    return SpansWithin(
        n[TIME][slots], n[VALUE][slots], n[SLOPE_OUT][slots], n[TIME][nexts], n[VALUE][nexts], n[SLOPE_IN][nexts], held
    )


def _spans_within(rows: Rows, t0: float, t1: float, low: float, high: float, long: float) -> Slots:
    times = rows.times
    first = max(int(times.searchsorted(t0, "left")) - 1, 0)
    last = min(int(times.searchsorted(t1, "right")), len(times) - 1)
    if first >= last:
        return _NO_SLOTS
    values = rows.numbers[VALUE, first : last + 1]
    above, below = values > high, values < low
    near = ~((above[1:] & above[:-1]) | (below[1:] & below[:-1]))
    if t1 - t0 < long * (last - first):
        # A span that lasts longer than it is from probe to probe has a probe in it, so that few need be measured.
        probes = t0 + 0.5 * long * np.arange(2.0 + 2.0 * (t1 - t0) / long)
        behind = times.searchsorted(probes, "left").clip(first + 1, last)
    else:
        behind = np.arange(first + 1, last + 1)
    with np.errstate(over="ignore"):
        near[behind[times[behind] - times[behind - 1] > long] - 1 - first] = True
    (slots,) = near.nonzero()
    if len(slots):
        slots += first
        # Between spare slots, which repeat the key before them, there is nothing.
        slots = slots[times[slots + 1] > times[slots]]
    return slots
