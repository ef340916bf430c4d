"""TANGENT_RULES: the slope each rule gives to one side of a key."""

from collections.abc import Callable, Sequence
from functools import cached_property
from math import inf, isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.hermite import LARGEST, Floats
from model.keyframe import TangentRule

type Marks = NDArray[np.uint8]


class Chords:
    """The chords that rules look at, of n neighbouring keys seen as a whole channel; each of shape (n,).

    At an end key all three are the only chord there is; for a lone key they are 0.
    """

    def __init__(self, times: Floats, values: Floats) -> None:
        self._times, self._values = times, values

    @cached_property
    def _spans(self) -> Floats:
        return _slopes_between(self._times[:-1], self._values[:-1], self._times[1:], self._values[1:])

    @cached_property
    def before(self) -> Floats:
        """From the key before to the key."""
        if len(self._times) < 2:
            return np.zeros(len(self._times))
        return np.concatenate([self._spans[:1], self._spans])

    @cached_property
    def after(self) -> Floats:
        """From the key to the key after."""
        if len(self._times) < 2:
            return np.zeros(len(self._times))
        return np.concatenate([self._spans, self._spans[-1:]])

    @cached_property
    def around(self) -> Floats:
        """From the key before to the key after."""
        t, v = self._times, self._values
        found = np.zeros(len(t))
        if len(t) > 2:
            found[1:-1] = _slopes_between(t[:-2], v[:-2], t[2:], v[2:])
        if len(t) > 1:
            found[0] = slope_between(float(t[0]), float(v[0]), float(t[1]), float(v[1]))
            found[-1] = slope_between(float(t[-2]), float(v[-2]), float(t[-1]), float(v[-1]))
        return found


class KeyChords(NamedTuple):
    """The same chords of one key, in Python numbers."""

    before: float
    after: float
    around: float


class RuleRow(NamedTuple):
    """One tangent rule: what the artist reads, the sides it can be on, and the slope it gives.

    `slope` works on many keys, `key_slope` on one with the same bits; None leaves the slope as it was given.
    """

    label: str
    tip: str
    sides: tuple[str, ...]
    slope_in: Callable[[Chords], Floats] | None
    slope_out: Callable[[Chords], Floats] | None
    key_slope_in: Callable[[KeyChords], float] | None
    key_slope_out: Callable[[KeyChords], float] | None


def slope_between(time0: float, value0: float, time1: float, value1: float) -> float:
    """The slope of the line from key 0 to key 1; one too steep for a double becomes +-LARGEST."""
    d_time = time1 - time0
    slope = (value1 - value0) / d_time
    if slope - slope != 0.0 or d_time == inf:
        d_value = 0.5 * value1 - 0.5 * value0
        slope = d_value / (0.5 * time1 - 0.5 * time0) if d_time == inf else d_value / d_time * 2.0
    return min(max(slope, -LARGEST), LARGEST)


def _slopes_between(time0: Floats, value0: Floats, time1: Floats, value1: Floats) -> Floats:
    with np.errstate(all="ignore"):
        d_time = time1 - time0
        slopes: Floats = (value1 - value0) / d_time
        # One sum says that none of them is wild; where it is too large itself, they are looked at one by one.
        if len(slopes) and isfinite(time1[-1] - time0[0]) and isfinite(slopes.sum()):
            return slopes
        wild = ~np.isfinite(slopes) | (d_time == inf)
        if wild.any():
            d_value, d_time = 0.5 * value1[wild] - 0.5 * value0[wild], d_time[wild]
            far = d_value / (0.5 * time1[wild] - 0.5 * time0[wild])
            slopes[wild] = np.clip(np.where(d_time == inf, far, d_value / d_time * 2.0), -LARGEST, LARGEST)
    return slopes


def _zero(chords: Chords) -> Floats:
    return np.zeros(len(chords.around))


def _limited(chords: Chords) -> Floats:
    """The smooth slope, but 0 where the curve turns and never more than three times the flatter chord."""
    before, after = chords.before, chords.after
    with np.errstate(all="ignore"):
        limit = np.minimum(3.0 * np.minimum(np.abs(before), np.abs(after)), LARGEST)
    turns = ~(((before > 0.0) & (after > 0.0)) | ((before < 0.0) & (after < 0.0)))
    return np.where(turns, 0.0, np.minimum(np.maximum(chords.around, -limit), limit))


def _key_limited(chords: KeyChords) -> float:
    before, after, slope = chords
    if not ((before > 0.0 and after > 0.0) or (before < 0.0 and after < 0.0)):
        return 0.0
    limit = min(3.0 * min(abs(before), abs(after)), LARGEST)
    return min(max(slope, -limit), limit)


def _around(chords: Chords) -> Floats:
    return chords.around


def _key_around(chords: KeyChords) -> float:
    return chords.around


def _key_zero(chords: KeyChords) -> float:
    return 0.0


_BOTH = ("in", "out")

TANGENT_RULES: dict[TangentRule, RuleRow] = {
    # A rest or an extremum: the curve runs level through the key.
    TangentRule.FLAT: RuleRow("Flat", "Level through the key", _BOTH, _zero, _zero, _key_zero, _key_zero),
    # A corner: the curve leaves straight for its neighbour.
    TangentRule.LINEAR: RuleRow(
        "Linear",
        "Straight towards the neighbour",
        _BOTH,
        lambda chords: chords.before,
        lambda chords: chords.after,
        lambda chords: chords.before,
        lambda chords: chords.after,
    ),
    # The common case: no corner, but it may swing past the keys' values.
    TangentRule.SMOOTH: RuleRow(
        "Smooth", "Along the line from neighbour to neighbour", _BOTH, _around, _around, _key_around, _key_around
    ),
    # The user's own slope.
    TangentRule.FIXED: RuleRow("Fixed", "The slope you gave", _BOTH, None, None, None, None),
    # No movement until the next key, then a jump.
    TangentRule.STEP: RuleRow("Step", "Holds its value until the next key", ("out",), None, _zero, None, _key_zero),
    # Smooth without overshoot: level at extrema, and the curve stays between neighbouring values.
    TangentRule.AUTO: RuleRow(
        "Auto", "Smooth, but never past the keys' values", _BOTH, _limited, _limited, _key_limited, _key_limited
    ),
}

_KEY_SLOPES_IN = [TANGENT_RULES[rule].key_slope_in for rule in TangentRule]
_KEY_SLOPES_OUT = [TANGENT_RULES[rule].key_slope_out for rule in TangentRule]


def slopes_of(
    times: Floats, values: Floats, slopes_in: Floats, slopes_out: Floats, rules_in: Marks, rules_out: Marks
) -> tuple[Floats, Floats]:
    """(slopes in, slopes out) by rule of neighbouring keys seen as a whole channel; fixed sides keep theirs."""
    chords = Chords(times, values)
    return (
        _slopes_on_a_side(chords, rules_in, slopes_in, [row.slope_in for row in TANGENT_RULES.values()]),
        _slopes_on_a_side(chords, rules_out, slopes_out, [row.slope_out for row in TANGENT_RULES.values()]),
    )


def _slopes_on_a_side(
    chords: Chords, rules: Marks, given: Floats, functions: list[Callable[[Chords], Floats] | None]
) -> Floats:
    if not len(rules):
        return given.copy()
    first = int(rules[0])
    if (rules == first).all():
        function = functions[first]
        return given.copy() if function is None else function(chords)
    slopes = given.copy()
    for rule in np.flatnonzero(np.bincount(rules)).tolist():
        function = functions[rule]
        if function is not None:
            np.copyto(slopes, function(chords), where=rules == rule)
    return slopes


def slope_pair(
    times: Sequence[float],
    values: Sequence[float],
    place: int,
    rule_in: int,
    rule_out: int,
    slope_in: float,
    slope_out: float,
) -> tuple[float, float]:
    """(slope in, slope out) of the key at *place* among itself and its one or two neighbours, as slopes_of gives."""
    before = after = around = 0.0
    n = len(times)
    if n == 3:
        (t0, t, t1), (v0, v, v1) = times, values
        before, after = slope_between(t0, v0, t, v), slope_between(t, v, t1, v1)
        around = slope_between(t0, v0, t1, v1)
    elif n == 2:
        before = after = around = slope_between(times[0], values[0], times[1], values[1])
    chords = KeyChords(before, after, around)
    by_in, by_out = _KEY_SLOPES_IN[rule_in], _KEY_SLOPES_OUT[rule_out]
    return by_in(chords) if by_in else slope_in, by_out(chords) if by_out else slope_out
