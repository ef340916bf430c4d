"""Touched: from when to when changes have touched each curve, and what else listeners must be told."""

from math import isfinite
from typing import NamedTuple

from model.channel import Channel
from model.clip import Clip


class Near(NamedTuple):
    """From t0 to t1 lies all that depends on where a key has been taken; besides, it is only missing where it was."""

    key_id: int
    t0: float
    t1: float


class Touched:
    """What changes have touched, and so what must be told."""

    __slots__ = ("intervals", "keys_came_or_went", "membership", "nearest", "settings")

    def __init__(self) -> None:
        self.intervals: dict[Channel, tuple[float, float]] = {}
        self.nearest: dict[Channel, Near] = {}  # of channels one of whose keys has been moved, and nothing else
        self.settings: dict[tuple[Channel | Clip, str], None] = {}
        self.membership = False
        self.keys_came_or_went = False

    def widen(self, channel: Channel, t0: float, t1: float) -> None:
        """Add [t0, t1] of *channel*; t0 > t1 adds nothing."""
        known = self.intervals.get(channel)
        if known is not None:
            t0, t1 = min(t0, known[0]), max(t1, known[1])
        if t0 <= t1:
            self.intervals[channel] = (t0, t1)

    def instead_of(self, other: "Touched") -> "Touched":
        """What differs from a clip that *other* has touched, where both were the same before either."""
        both = Touched()
        both.intervals = {**other.intervals, **self.intervals}
        for channel in self.intervals.keys() & other.intervals.keys():
            both.intervals[channel] = self._from(other, channel)
        both.settings = {**self.settings, **other.settings}
        both.membership = self.membership or other.membership
        both.keys_came_or_went = self.keys_came_or_went or other.keys_came_or_went
        return both

    def _from(self, other: "Touched", channel: Channel) -> tuple[float, float]:
        here, there = self.nearest.get(channel), other.nearest.get(channel)
        mine, its = self.intervals[channel], other.intervals[channel]
        if here is not None and there is not None and here.key_id == there.key_id and isfinite(sum(mine) + sum(its)):
            mine, its = here[1:], there[1:]  # where the key was at first it is missing in both
        return min(mine[0], its[0]), max(mine[1], its[1])
