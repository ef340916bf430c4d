"""Mapping: what the numbers of many keys become, worked out in columns with the bits that it has in records."""

from typing import NamedTuple

import numpy as np

from model.hermite import Floats
from model.keyframe import Run, TangentRule

# Of a rounded number this share is off at most, or so much if it is next to 0.
UNIT, SMALLEST = 2.0**-53, 5e-324


class Added(NamedTuple):
    """A number more."""

    amount: float

    @property
    def still(self) -> bool:
        """Whether all numbers stay as they are."""
        return self.amount == 0.0

    @property
    def factor(self) -> float:
        """What differences are multiplied by."""
        return 1.0

    def rounding(self, largest: float) -> float:
        """How far at most rounding moves what becomes of a number no larger than *largest*."""
        return UNIT * (largest + abs(self.amount))

    def to(self, numbers: Floats, out: Floats | None = None) -> Floats:
        """What *numbers* become, in *out* if it is given."""
        # Adding -0.0 leaves every number as it is, 0.0 would turn -0.0 into 0.0.
        return np.add(numbers, self.amount or -0.0, out=out)


class Stretched(NamedTuple):
    """So many times as far from *center*."""

    center: float
    factor: float

    @property
    def still(self) -> bool:
        """Whether all numbers are known to stay as they are."""
        return False

    def rounding(self, largest: float) -> float:
        """How far at most rounding moves what becomes of a number no larger than *largest*."""
        return 4.0 * UNIT * (abs(self.factor) * (largest + abs(self.center)) + abs(self.center)) + SMALLEST

    def to(self, numbers: Floats, out: Floats | None = None) -> Floats:
        """What *numbers* become, in *out* if it is given; inf or NaN where a double cannot hold it or a step to it."""
        found = np.subtract(numbers, self.center, out=out)
        found *= self.factor
        found += self.center
        return found


class Mapping(NamedTuple):
    """What times and values become; slopes of fixed sides go with them."""

    time: Added | Stretched
    value: Added | Stretched

    @property
    def slope(self) -> float:
        """What the slopes of fixed sides are multiplied by."""
        return self.value.factor / self.time.factor if self.value.factor != self.time.factor else 1.0

    @property
    def move(self) -> tuple[Added, Added] | None:
        """What is added to times and values; None if it does more than that."""
        return (self.time, self.value) if isinstance(self.time, Added) and isinstance(self.value, Added) else None

    @property
    def mirrored(self) -> bool:
        """Whether the keys come to stand in reverse order."""
        return isinstance(self.time, Stretched) and self.time.factor < 0.0

    @property
    def makes_minus_zero(self) -> bool:
        """Whether a value may become -0.0 that was not."""
        return isinstance(self.value, Stretched) and str(self.value.center) == "-0.0"


def mirrored(run: Run) -> Run:
    """*run* in reverse order with their sides exchanged; a span that one of them held is held by the other end."""
    turned = run[::-1].copy()
    turned["slope_in"], turned["slope_out"] = run["slope_out"][::-1], run["slope_in"][::-1]
    rules_in, rules_out = run["rule_in"], run["rule_out"]
    held = rules_out == TangentRule.STEP
    new_in = np.where(held, TangentRule.FLAT, rules_out)
    new_out = rules_in.copy()
    new_out[1:][held[:-1]] = TangentRule.STEP
    turned["rule_in"], turned["rule_out"] = new_in[::-1], new_out[::-1]
    turned["broken"] |= (turned["rule_in"] != turned["rule_out"]) & (turned["rule_out"] != TangentRule.STEP)
    return turned
