"""EXTRAPOLATIONS: the curve before the first and after the last key."""

from collections.abc import Callable
from enum import IntEnum
from math import inf, nextafter
from typing import NamedTuple

import numpy as np

from model.hermite import LARGEST, Floats


class Extrapolation(IntEnum):
    """How a channel goes on beyond its keys; the mode's word is what files hold."""

    # Numbers live in sessions and words in files: never renumber, only add.
    CONSTANT = 0
    LINEAR = 1
    CYCLE = 2
    CYCLE_OFFSET = 3
    BOUNCE = 4

    @property
    def word(self) -> str:
        """The mode's name in files, as in ``cycle_offset``."""
        return self.name.lower()

    @classmethod
    def from_word(cls, word: str) -> "Extrapolation":
        """The mode called *word*; ValueError if there is none."""
        for mode in cls:
            if mode.word == word:
                return mode
        raise ValueError(f"unknown extrapolation {word!r}; known: {', '.join(m.word for m in cls)}")


class Ends(NamedTuple):
    """The first and the last key of a channel: times, values, outward slopes (arrays for many channels)."""

    time0: float
    time1: float
    value0: float
    value1: float
    slope0: float
    slope1: float

    @property
    def period(self) -> float:
        """Seconds from the first to the last key."""
        return min(self.time1 - self.time0, LARGEST)

    @property
    def before_end(self) -> float:
        """The last time before the last key: a copy ends before the next one's beginning, however times are rounded."""
        return nextafter(self.time1, -inf)


class Folded(NamedTuple):
    """Times beyond the keys brought back among them: value there = value at `times` + `shifts` (None: 0)."""

    times: Floats
    shifts: Floats | None
    turns: Floats  # -1 where the copy is mirrored, 0 where the curve is straight, else 1: factor of the slope


class Mode(NamedTuple):
    """One extrapolation: what the artist reads, and how times beyond the keys are folded."""

    label: str
    tip: str
    fold: Callable[[Floats, Ends], Folded]
    fold_one: Callable[[float, Ends], tuple[float, float]]
    repeats: bool


def periods(times: Floats, ends: Ends) -> tuple[Floats, Floats]:
    """(k, tau - t0): which copy a time falls in and where in it, from one divmod."""
    with np.errstate(all="ignore"):
        since = np.clip(times - ends.time0, -LARGEST, LARGEST)
        k, rest = np.divmod(since, ends.period)
    return np.clip(k, -LARGEST, LARGEST), rest


def periods_one(time: float, ends: Ends) -> tuple[float, float]:
    """The same for one time."""
    k, rest = divmod(min(max(time - ends.time0, -LARGEST), LARGEST), ends.period)
    return min(max(k, -LARGEST), LARGEST), rest


def _constant(times: Floats, ends: Ends) -> Folded:
    return Folded(np.clip(times, ends.time0, ends.time1), None, np.zeros_like(times))


def _constant_one(time: float, ends: Ends) -> tuple[float, float]:
    return min(max(time, ends.time0), ends.time1), 0.0


def _linear(times: Floats, ends: Ends) -> Folded:
    near = np.clip(times, ends.time0, ends.time1)
    slopes = np.where(times < ends.time0, ends.slope0, ends.slope1)
    with np.errstate(all="ignore"):
        away = np.clip(times - near, -LARGEST, LARGEST)
        return Folded(near, away * slopes, np.zeros_like(times))


def _linear_one(time: float, ends: Ends) -> tuple[float, float]:
    near = min(max(time, ends.time0), ends.time1)
    away = min(max(time - near, -LARGEST), LARGEST)
    return near, away * (ends.slope0 if time < ends.time0 else ends.slope1)


def _cycle(times: Floats, ends: Ends) -> Folded:
    if ends.period == 0.0:
        return _constant(times, ends)
    _, rest = periods(times, ends)
    return Folded(np.clip(ends.time0 + rest, ends.time0, ends.before_end), None, np.ones_like(times))


def _cycle_one(time: float, ends: Ends) -> tuple[float, float]:
    if ends.period == 0.0:
        return ends.time0, 0.0
    return min(max(ends.time0 + periods_one(time, ends)[1], ends.time0), ends.before_end), 0.0


def _cycle_offset(times: Floats, ends: Ends) -> Folded:
    if ends.period == 0.0:
        return _constant(times, ends)
    k, rest = periods(times, ends)
    with np.errstate(all="ignore"):
        shifts = k * min(max(ends.value1 - ends.value0, -LARGEST), LARGEST)
    return Folded(np.clip(ends.time0 + rest, ends.time0, ends.before_end), shifts, np.ones_like(times))


def _cycle_offset_one(time: float, ends: Ends) -> tuple[float, float]:
    if ends.period == 0.0:
        return ends.time0, 0.0
    k, rest = periods_one(time, ends)
    shift = k * min(max(ends.value1 - ends.value0, -LARGEST), LARGEST)
    return min(max(ends.time0 + rest, ends.time0), ends.before_end), shift


def _bounce(times: Floats, ends: Ends) -> Folded:
    if ends.period == 0.0:
        return _constant(times, ends)
    k, rest = periods(times, ends)
    mirrored = np.fmod(k, 2.0) != 0.0
    tau = np.where(mirrored, ends.time1 - rest, ends.time0 + rest)
    return Folded(np.clip(tau, ends.time0, ends.time1), None, np.where(mirrored, -1.0, 1.0))


def _bounce_one(time: float, ends: Ends) -> tuple[float, float]:
    if ends.period == 0.0:
        return ends.time0, 0.0
    k, rest = periods_one(time, ends)
    tau = ends.time1 - rest if k % 2.0 else ends.time0 + rest
    return min(max(tau, ends.time0), ends.time1), 0.0


EXTRAPOLATIONS: dict[Extrapolation, Mode] = {
    Extrapolation.CONSTANT: Mode("Constant", "Stays at the end key's value", _constant, _constant_one, False),
    Extrapolation.LINEAR: Mode("Linear", "Goes straight on along the end tangent", _linear, _linear_one, False),
    Extrapolation.CYCLE: Mode("Cycle", "Plays again and again", _cycle, _cycle_one, True),
    Extrapolation.CYCLE_OFFSET: Mode(
        "Cycle with offset", "Plays again from where it ended", _cycle_offset, _cycle_offset_one, True
    ),
    Extrapolation.BOUNCE: Mode("Bounce", "Plays forwards and backwards in turn", _bounce, _bounce_one, True),
}
