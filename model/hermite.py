"""Hermite spans: coefficients, values, slopes, subdivision, extrema and inflections of one or many.

A span runs from key 0 to key 1 over dt seconds; inside it u = (t - t0) / dt goes from 0 to 1 and
value = d + u (c + u (b + u a)). Numbers and arrays are both welcome unless a line says otherwise.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

type Floats = NDArray[np.float64]

LARGEST = float(np.finfo(np.float64).max)


class Halves[Number: (float, Floats)](NamedTuple):
    """The key that cuts a span in two without changing its shape; slopes in value per second."""

    value: Number
    slope: Number


def coefficients[Number: (float, Floats)](
    d_time: Number, value0: Number, value1: Number, slope0: Number, slope1: Number
) -> tuple[Number, Number, Number]:
    """(a, b, c) of the span; d is value0. Numbers too large for a double come out as inf or NaN."""
    d_value = value1 - value0
    c = d_time * slope0
    a = d_time * (slope0 + slope1) - 2.0 * d_value
    b = 3.0 * d_value - d_time * (2.0 * slope0 + slope1)
    return a, b, c


def value[Number: (float, Floats)](u: Number, a: Number, b: Number, c: Number, d: Number) -> Number:
    """The span's value at u."""
    return d + u * (c + u * (b + u * a))


def slope[Number: (float, Floats)](u: Number, a: Number, b: Number, c: Number, d_time: Number) -> Number:
    """The span's slope at u in value per second."""
    return (c + u * (2.0 * b + u * (3.0 * a))) / d_time


class Scaled(NamedTuple):
    """A span in numbers of size one: its true a, b, c and d are these times 2 to the power of `exponent`."""

    a: Floats
    b: Floats
    c: Floats
    d: Floats
    exponent: NDArray[np.int64]

    def value(self, u: Floats) -> Floats:
        """The span's value at u; what no double can hold becomes +-LARGEST."""
        with np.errstate(all="ignore"):
            return finite(np.ldexp(value(u, self.a, self.b, self.c, self.d), self.exponent))


def scaled(time0: Floats, time1: Floats, value0: Floats, value1: Floats, slope0: Floats, slope1: Floats) -> Scaled:
    """The spans between keys whose numbers may be so large or so far apart that their coefficients overflow."""
    with np.errstate(all="ignore"):
        far = ~np.isfinite(time1 - time0)
        d_time, d_exponent = np.frexp(np.where(far, 0.5 * time1 - 0.5 * time0, time1 - time0))
        d_exponent = d_exponent + far
        mantissas, exponents = [], []
        for numbers, is_slope in ((slope0, True), (slope1, True), (value0, False), (value1, False)):
            mantissa, exponent = np.frexp(numbers)
            mantissas.append(mantissa * d_time if is_slope else mantissa)
            # A zero must not set the scale.
            exponents.append(np.where(mantissa == 0.0, -9999, exponent + d_exponent if is_slope else exponent))
        scale = np.maximum.reduce(exponents)
        s0, s1, v0, v1 = (
            np.ldexp(mantissa, np.maximum(exponent - scale, -2000))
            for mantissa, exponent in zip(mantissas, exponents, strict=True)
        )
        return Scaled(*coefficients(np.ones_like(s0), v0, v1, s0, s1), v0, scale)


def places(times: Floats, time0: Floats, time1: Floats) -> Floats:
    """u of *times* in spans however long."""
    with np.errstate(all="ignore"):
        u = (times - time0) / (time1 - time0)
        return np.where(np.isfinite(time1 - time0), u, (0.5 * times - 0.5 * time0) / (0.5 * time1 - 0.5 * time0))


def finite(numbers: Floats) -> Floats:
    """*numbers* with +-inf replaced by +-LARGEST; NaN stays."""
    return np.clip(numbers, -LARGEST, LARGEST)


def subdivided[Number: (float, Floats)](
    u: Number, a: Number, b: Number, c: Number, d: Number, d_time: Number
) -> Halves[Number]:
    """The key at u that keeps the shape: its value, and its slope on both sides.

    The span's two outer slopes stay as they are, since slopes are in value per second.
    """
    return Halves(value(u, a, b, c, d), slope(u, a, b, c, d_time))


def extremum_places(a: Floats, b: Floats, c: Floats) -> tuple[Floats, Floats]:
    """The two u at which the slope is 0, smaller first; NaN where there is none inside (0, 1). Shapes as given."""
    a, b, c = np.broadcast_arrays(np.asarray(a, np.float64), b, c)
    with np.errstate(all="ignore"):
        # Scaled to size one, so that squares neither overflow nor vanish.
        size = np.maximum(np.maximum(np.abs(a), np.abs(b)), np.abs(c))
        scale = np.where((size > 0) & (size < np.inf), size, 1.0)
        a, b, c = 3.0 * (a / scale), b / scale, c / scale
        # a u^2 + 2 b u + c = 0, by the form without cancellation.
        q = -(b + np.copysign(np.sqrt(b * b - a * c), b))
        u0, u1 = c / q, q / a
        u0 = np.where((u0 > 0.0) & (u0 < 1.0), u0, np.nan)
        u1 = np.where((u1 > 0.0) & (u1 < 1.0), u1, np.nan)
        return np.fmin(u0, u1), np.where(np.isnan(u0) | np.isnan(u1), np.nan, np.fmax(u0, u1))


def inflection_places(a: Floats, b: Floats) -> Floats:
    """The u at which the bend changes side; NaN where it does not inside (0, 1)."""
    with np.errstate(all="ignore"):
        u = -np.asarray(b, np.float64) / (3.0 * np.asarray(a, np.float64))
    return np.where((u > 0.0) & (u < 1.0), u, np.nan)
