"""Ticks: round numbers along an axis, as many as have room, each with words that tell it from its neighbours."""

from collections.abc import Callable
from math import ceil, floor, inf, isfinite, log10
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.sampling import Window

type Floats = NDArray[np.float64]

DECIMAL_STEPS: Final = (1.0, 2.0, 5.0, 10.0)
# Full turns and their usual parts, before degrees go on in decimal steps.
DEGREE_STEPS: Final = (1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0, 180.0, 360.0, 720.0, 1800.0, 3600.0)
MINUS: Final = "−"
# Characters that are still read at a glance.
LONGEST: Final = 14
# Logical pixels; multiples of four stay whole at the device ratios 1.25, 1.5 and 1.75.
VALUE_WIDTH: Final = 60.0
LABEL_GAP: Final = 14.0
VALUES_APART: Final = 44.0
# Finer lines than this would be a fabric, not a grid.
MINOR_APART: Final = 9.0


class Ticks(NamedTuple):
    """Places of the labelled lines and of the finer ones between them, in the axis's unit, ascending."""

    major: Floats
    labels: tuple[str, ...]
    minor: Floats
    # What every label leaves out when the numbers are too long to write, "" if nothing.
    offset: str


def ticks_of(window: Window, width: Callable[[str], float], *, degrees: bool) -> tuple[Ticks, Ticks]:
    """(time ticks, value ticks) of a window in screen pixels; degrees are ticked where radians are stored.

    *width* measures words.
    """
    room = (VALUE_WIDTH - 12.0) * window.unit
    times = time_ticks(window.t0, window.t1, window.width, LABEL_GAP * window.unit, width)
    low, high = np.rad2deg((window.v0, window.v1)) if degrees else (window.v0, window.v1)
    values = value_ticks(
        float(low),
        float(high),
        window.height,
        VALUES_APART * window.unit,
        lambda text: width(text) <= room,
        degrees=degrees,
    )
    if degrees:
        labels = tuple(label + "°" for label in values.labels)
        values = Ticks(np.deg2rad(values.major), labels, np.deg2rad(values.minor), values.offset)
    return times, values


def decimal_step(least: float) -> float:
    """The smallest of 1, 2, 5 times a power of ten that is at least *least*."""
    power = 10.0 ** floor(log10(least))
    return next(step * power for step in DECIMAL_STEPS if step * power >= least * (1 - 1e-9))


def degree_step(least: float) -> float:
    """The smallest step of degrees that divides the circle well and is at least *least*."""
    if least > DEGREE_STEPS[0]:
        return next((step for step in DEGREE_STEPS if step >= least), 3600.0 * decimal_step(least / 3600.0))
    return decimal_step(least)


def value_ticks(
    low: float, high: float, length: float, apart: float, fits: Callable[[str], bool], *, degrees: bool
) -> Ticks:
    """Ticks from *low* to *high* over *length* pixels, at least *apart*, with labels that *fits* takes."""
    least = (high - low) / max(length / apart, 1.0)
    step = degree_step(least) if degrees else decimal_step(least)
    major = multiples(low, high, step)
    labels, offset = worded(major, step, fits)
    return Ticks(major, labels, finer(low, high, step, length), offset)


def time_ticks(low: float, high: float, length: float, gap: float, width: Callable[[str], float]) -> Ticks:
    """Ticks in seconds over *length* pixels, with at least *gap* pixels between the words; *width* measures them."""
    apart = 40.0
    while True:
        step = decimal_step((high - low) / max(length / apart, 1.0))
        major = multiples(low, high, step)
        labels, offset = worded(major, step, lambda _: True)
        need = max(map(width, labels), default=0.0) + gap
        if need <= step * length / (high - low) or len(major) < 2:
            return Ticks(major, labels, finer(low, high, step, length), offset)
        apart = max(need, apart * 1.25)


def frame_ticks(low: float, high: float, rate: float, length: float, apart: float) -> NDArray[np.int64]:
    """The frames to number between two times in seconds, at least *apart* pixels from each other."""
    per_frame = length / (high - low) / rate
    if not isfinite(rate) or not isfinite(per_frame) or max(abs(low), abs(high)) * rate > 1e15:
        return np.empty(0, np.int64)
    step = max(decimal_step(apart / per_frame), 1.0)
    return np.rint(multiples(low * rate, high * rate, step)).astype(np.int64)


def multiples(low: float, high: float, step: float) -> Floats:
    """The multiples of *step* from *low* to *high*; never more than 2,000."""
    first, last = ceil(low / step - 1e-9), floor(high / step + 1e-9)
    return np.arange(first, min(last, first + 1999) + 1, dtype=np.float64) * step


def finer(low: float, high: float, step: float, length: float) -> Floats:
    """The places between the multiples of *step*, none if they would lie too near."""
    part = step / parts_of(step)
    return multiples(low, high, part) if part * length / (high - low) >= MINOR_APART else np.empty(0)


def parts_of(step: float) -> int:
    """Into how many finer parts a step is cut: those that land on round numbers again."""
    mantissa = round(step / 10.0 ** floor(log10(step) + 1e-9), 6)
    return {1.0: 5, 2.0: 4, 5.0: 5, 1.5: 3, 3.0: 3, 4.5: 3, 9.0: 3, 1.8: 2, 3.6: 4, 7.2: 4}.get(mantissa, 2)


def worded(numbers: Floats, step: float, fits: Callable[[str], bool]) -> tuple[tuple[str, ...], str]:
    """(labels, offset): plain decimals, else powers of ten, else the differences from an offset, which always fit."""
    if not len(numbers):
        return (), ""
    decimals = max(0, -floor(log10(step) + 1e-9))
    size = float(np.abs(numbers).max())
    if decimals <= 12 and size < 1e15:
        labels = tuple(plain(number, decimals) for number in numbers.tolist())
        if max(map(len, labels)) <= LONGEST and all(map(fits, labels)):
            return labels, ""
    digits = max(0, ceil(log10(size / step)) if size else 0)
    powers = tuple(power(number, digits) for number in numbers.tolist())
    if all(map(fits, powers)) and len(set(powers)) == len(powers):
        return powers, ""
    middle = float(numbers[len(numbers) // 2])
    coarse = 10.0 ** ceil(log10(step) + 2)
    base = round(middle / coarse) * coarse
    rest = numbers - base
    if base == 0.0 or not fits(plain(float(np.abs(rest).max()), decimals)):
        scale = 10.0 ** floor(log10(step) + 1e-9)
        labels = tuple(plain(number, 0) for number in (rest / scale).tolist())
        return labels, f"× {power(scale, 0)} {_offset(base, step)}".strip()
    return tuple(plain(number, decimals) for number in rest.tolist()), _offset(base, step)


def _offset(base: float, step: float) -> str:
    if base == 0.0:
        return ""
    decimals = min(max(0, -floor(log10(step) + 1e-9)), 15)
    return "+ " + (plain(base, decimals) if abs(base) < 1e15 else power(base, 12))


def plain(number: float, decimals: int) -> str:
    """A decimal number with a true minus sign, and none before zero."""
    text = f"{number:.{decimals}f}"
    return text.replace("-", MINUS) if float(text) else text.lstrip("-")


def power(number: float, digits: int) -> str:
    """A number as 1.5e−9."""
    if number == 0.0 or abs(number) == inf:
        return plain(number, 0)
    mantissa, exponent = f"{number:.{digits}e}".split("e")
    return f"{mantissa}e{int(exponent)}".replace("-", MINUS)
