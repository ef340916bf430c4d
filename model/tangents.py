"""TANGENT_RULES: the slope each rule gives to one side of a key."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.hermite import LARGEST, Floats
from model.keyframe import TangentRule

type Marks = NDArray[np.uint8]


class Chords(NamedTuple):
    """What the rules look at; arrays of one length, or numbers for one key.

    `before` and `after` are the chords to the two neighbours, `around` the one from neighbour to neighbour;
    at an end of the channel all three are the only chord there is, and 0 for a lone key.
    """

    before: Floats
    after: Floats
    around: Floats


class OneKeyChords(NamedTuple):
    """The same for one key, in Python numbers."""

    before: float
    after: float
    around: float


class Row(NamedTuple):
    """One tangent rule: what the artist reads, and its slopes in and out (None: the stored slope stays)."""

    label: str
    tip: str
    slope_in: Callable[[Chords], Floats] | None
    slope_out: Callable[[Chords], Floats] | None
    one_in: Callable[[OneKeyChords], float] | None
    one_out: Callable[[OneKeyChords], float] | None
    sides: str = "both"


def _zero(chords: Chords) -> Floats:
    return np.zeros_like(chords.around)


def _limited(chords: Chords) -> Floats:
    """The smooth slope, but 0 where the chords turn and never above three times the flatter chord."""
    limit = np.minimum(np.abs(chords.before), np.abs(chords.after))
    limit = np.where(limit < LARGEST / 3.0, 3.0 * limit, LARGEST)
    slope = np.clip(chords.around, -limit, limit)
    rising = (chords.before > 0.0) & (chords.after > 0.0)
    falling = (chords.before < 0.0) & (chords.after < 0.0)
    return np.where(rising | falling, slope, 0.0)


def _limited_one(chords: OneKeyChords) -> float:
    before, after, slope = chords
    if not (before > 0.0 and after > 0.0) and not (before < 0.0 and after < 0.0):
        return 0.0
    limit = min(abs(before), abs(after))
    limit = 3.0 * limit if limit < LARGEST / 3.0 else LARGEST
    return min(max(slope, -limit), limit)


TANGENT_RULES: dict[TangentRule, Row] = {
    TangentRule.FLAT: Row("Flat", "Level: the slope is 0", _zero, _zero, lambda c: 0.0, lambda c: 0.0),
    TangentRule.LINEAR: Row(
        "Linear",
        "Straight towards the neighbour",
        lambda c: c.before,
        lambda c: c.after,
        lambda c: c.before,
        lambda c: c.after,
    ),
    TangentRule.SMOOTH: Row(
        "Smooth",
        "Along the line through the two neighbours",
        lambda c: c.around,
        lambda c: c.around,
        lambda c: c.around,
        lambda c: c.around,
    ),
    TangentRule.FIXED: Row("Fixed", "The slope you gave", None, None, None, None),
    TangentRule.STEP: Row("Step", "Holds the value until the next key", None, _zero, None, lambda c: 0.0, sides="out"),
    TangentRule.AUTO: Row(
        "Auto", "Smooth, and never past the neighbours' values", _limited, _limited, _limited_one, _limited_one
    ),
}


def chord(time0: float, value0: float, time1: float, value1: float) -> float:
    """The slope of the line from key 0 to key 1, never beyond +-LARGEST."""
    slope = (value1 - value0) / (time1 - time0)
    if slope - slope != 0.0:
        slope = (0.5 * value1 - 0.5 * value0) / (0.5 * time1 - 0.5 * time0)
    return min(max(slope, -LARGEST), LARGEST)


def chords(time0: Floats, value0: Floats, time1: Floats, value1: Floats) -> Floats:
    """The same for many pairs of keys."""
    with np.errstate(all="ignore"):
        slopes = (value1 - value0) / (time1 - time0)
        wild = ~np.isfinite(slopes)
        if wild.any():
            half = 0.5 * value1[wild] - 0.5 * value0[wild]
            slopes[wild] = np.clip(half / (0.5 * time1[wild] - 0.5 * time0[wild]), -LARGEST, LARGEST)
    return slopes


def chords_of(times: Floats, values: Floats) -> Chords:
    """The chords of neighbouring keys, as if they were a whole channel; all of shape (n,)."""
    n = len(times)
    if n < 2:
        zero = np.zeros(n)
        return Chords(zero, zero, zero)
    spans = chords(times[:-1], values[:-1], times[1:], values[1:])
    before, after, around = np.empty(n), np.empty(n), np.empty(n)
    before[0], before[1:] = spans[0], spans
    after[-1], after[:-1] = spans[-1], spans
    around[0], around[-1] = spans[0], spans[-1]
    if n > 2:
        around[1:-1] = chords(times[:-2], values[:-2], times[2:], values[2:])
    return Chords(before, after, around)


def slopes_of(
    times: Floats, values: Floats, slopes_in: Floats, slopes_out: Floats, rules_in: Marks, rules_out: Marks
) -> tuple[Floats, Floats]:
    """(slopes in, slopes out) by rule for neighbouring keys seen as a whole channel; fixed sides keep theirs."""
    around = chords_of(times, values)
    slopes_in, slopes_out = slopes_in.copy(), slopes_out.copy()
    for rule, row in TANGENT_RULES.items():
        for function, rules, slopes in ((row.slope_in, rules_in, slopes_in), (row.slope_out, rules_out, slopes_out)):
            if function is None:
                continue
            here = rules == rule
            if here.all():
                slopes[:] = function(around)
            elif here.any():
                np.copyto(slopes, function(around), where=here)
    return slopes_in, slopes_out
