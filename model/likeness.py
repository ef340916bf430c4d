"""Likeness: how alike the spans of rows are that have come from others by one mapping for all their keys."""

from typing import NamedTuple

import numpy as np

from model.hermite import Floats
from model.keyframe import Run
from model.mapping import SMALLEST, UNIT, Added, Mapping, Stretched

# More than any rule makes of what its keys are off.
FAR = 100.0
# How large slopes and differences may be: then nothing that is made of them overflows.
LARGE, LEAST = 1e300, 1e-300
# Rounding may change the length of a span by this share.
STEADY = 1e-6


class Extent(NamedTuple):
    """How far the numbers of all keys of a channel reach."""

    latest: float  # the largest time without its sign
    low: float
    high: float
    shortest: float  # seconds between two neighbours
    longest: float

    @classmethod
    def of(cls, keys: Run) -> "Extent":
        """The extent of two keys or more."""
        times, values = keys["time"], keys["value"]
        with np.errstate(over="ignore"):
            d_times = times[1:] - times[:-1]
        latest = float(max(abs(times[0]), abs(times[-1])))
        return cls(latest, float(values.min()), float(values.max()), float(d_times.min()), float(d_times.max()))


class Likeness(NamedTuple):
    """Rows have come from others of the same shape, key by key and in the same order."""

    origin: Floats  # the numbers of those
    extent: Extent  # the same object as long as the origin is the same
    value: Added | Stretched
    off: float  # how far at most rounding moves an inner control point from where the mapping brings it

    @classmethod
    def of(cls, origin: Floats, extent: Extent, mapping: Mapping) -> "Likeness | None":
        """The likeness of what *mapping* makes of an origin; None if rounding may do more than move it a little.

        A control point is off by what its keys are off, and by what the chords are that its slope comes from: for the
        chord of a shorter neighbour that is more by the ratio of both. The share that the length of a span is off, a
        slope is off too. Control points that are looked at lie among the keys, and so no slope is steeper than three
        times from the lowest to the highest of them.
        """
        f_time, f_value = abs(mapping.time.factor), abs(mapping.value.factor)
        off_time = mapping.time.rounding(extent.latest)
        off_value = mapping.value.rounding(max(abs(extent.low), abs(extent.high)))
        shortest, longest = f_time * extent.shortest, f_time * extent.longest
        spread = f_value * (extent.high - extent.low) + off_value
        if mapping.mirrored or not off_time < STEADY * shortest or not spread + spread / shortest < LARGE:
            return None
        share = off_time / shortest + UNIT
        off = FAR * ((longest / shortest + 1.0) * off_value + share * spread + longest * SMALLEST) + LEAST
        return cls(origin, extent, mapping.value, off)
