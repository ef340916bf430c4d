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


def careful_value(
    time: Floats, time0: Floats, time1: Floats, value0: Floats, value1: Floats, slope0: Floats, slope1: Floats
) -> Floats:
    """The span's value at *time* however large its numbers are; what no double can hold becomes +-LARGEST.

    Every number is split into mantissa and exponent, and the polynomial is worked out on numbers of size one.
    """
    with np.errstate(all="ignore"):
        d_time = 0.25 * time1 - 0.25 * time0
        u = np.minimum((0.25 * time - 0.25 * time0) / d_time, 1.0)
        # The quarter of a denormal number loses bits, the difference of small numbers does not overflow.
        small = np.maximum(np.abs(time0), np.abs(time1)) < 1e300
        u = np.where(small, (time - time0) / (time1 - time0), u)
        mantissa, exponent = np.frexp(np.where(small, time1 - time0, d_time))
        exponent = exponent + np.where(small, 0, 2)
        m0, e0 = np.frexp(slope0)
        m1, e1 = np.frexp(slope1)
        p0, f0 = np.frexp(value0)
        p1, f1 = np.frexp(value1)
        # Zeros have exponent 0 in frexp; they must not set the scale.
        exponents = [
            np.where(m == 0.0, -5000, e)
            for m, e in ((m0 * mantissa, e0 + exponent), (m1 * mantissa, e1 + exponent), (p0, f0), (p1, f1))
        ]
        scale = np.maximum.reduce(exponents)
        s0, s1, v0, v1 = (
            np.ldexp(m, np.maximum(e - scale, -2000))
            for m, e in zip((m0 * mantissa, m1 * mantissa, p0, p1), exponents, strict=True)
        )
        a, b, c = coefficients(np.ones_like(u), v0, v1, s0, s1)
        return finite(np.ldexp(value(u, a, b, c, v0), scale))


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
