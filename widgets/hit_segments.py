"""Curves as straight segments of two pixels, and the point of each that is nearest to the pointer."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.channel import Channel
from model.within import SpansWithin
from widgets.lens import Lens

SEGMENT = 2.0

type Floats = NDArray[np.float64]
type Ints = NDArray[np.int64]

NO_SEGMENTS: Floats = np.empty((4, 0))


class Box(NamedTuple):
    """Where a segment must begin, and what values it must touch, to come near the pointer."""

    t0: float
    t1: float
    low: float
    high: float


def box_around(lens: Lens, x: float, y: float, radius: float, segment: float = 0.0) -> Box:
    """What is within the radius of a pixel; *segment*: how long before it a segment may begin, seconds."""
    low, high = sorted((lens.value(y - radius), lens.value(y + radius)))
    return Box(lens.time(x - radius) - segment, lens.time(x + radius), low, high)


def touching(segments: Floats, box: Box) -> Ints:
    """Which of the segments, which begin within the times of the box, touch its values; none without a value."""
    value0, value1 = segments[1], segments[3]
    touches = ((value0 >= box.low) | (value1 >= box.low)) & ((value0 <= box.high) | (value1 <= box.high))
    which: Ints = touches.nonzero()[0]
    return which


def segments_near(channel: Channel, box: Box, times: tuple[float, float], segment: float) -> Floats:
    """(4, n): time0, value0, time1, value1 of a channel's segments among its keys that begin within the box.

    They are those that `cut` makes of all the spans within *times*, and in the same order.
    """
    spans = channel.spans_within(*box, segment)
    if not len(spans.time0):
        return NO_SEGMENTS
    segments, _ = cut(spans, np.zeros(len(spans.time0), np.int64), times, segment)
    return begun_within(segments[:, np.argsort(segments[0], kind="stable")], box)


def begun_within(segments: Floats, box: Box) -> Floats:
    """Those of the segments, which are in order, that begin within the box."""
    first, stop = segments[0].searchsorted(box.t0, "left"), segments[0].searchsorted(box.t1, "right")
    return segments[:, first:stop]


class Nearest(NamedTuple):
    """The point of each segment that is nearest to a pixel."""

    times: Floats
    values: Floats
    distances: Floats


def nearest_points(lens: Lens, segments: Floats, x: float, y: float) -> Nearest:
    """The nearest points by true distance on the screen, so that steep spans can be hit too."""
    time0, value0, time1, value1 = segments
    with np.errstate(all="ignore"):
        x0, y0 = lens.x(time0) - x, lens.y(value0) - y
        dx, dy = lens.x(time1) - x - x0, lens.y(value1) - y - y0
        along = -(x0 * dx + y0 * dy) / (dx * dx + dy * dy)
        along = np.where(along > 0.0, np.minimum(along, 1.0), 0.0)  # where there is no way along, its start counts
        distances = np.hypot(x0 + along * dx, y0 + along * dy)
    return Nearest(time0 + along * (time1 - time0), value0 + along * (value1 - value0), distances)


def outside(channel: Channel, columns: Floats) -> Floats:
    """The curve before the first and after the last key, if it goes on there within *columns*."""
    ends, parts = channel.ends(), []
    if ends is not None and ends.time0 > columns[0]:
        parts.append(np.append(columns[columns < ends.time0], min(ends.time0, float(columns[-1]))))
    if ends is not None and ends.time1 < columns[-1]:
        parts.append(np.insert(columns[columns > ends.time1], 0, max(ends.time1, float(columns[0]))))
    if not parts:
        return NO_SEGMENTS
    pairs = [(part, channel.evaluate(part)) for part in parts]
    return np.concatenate([np.array([t[:-1], v[:-1], t[1:], v[1:]]) for t, v in pairs], axis=1)


def cut(spans: SpansWithin, owners: Ints, times: tuple[float, float], segment: float) -> tuple[Floats, Ints]:
    """(4, m) segments of *spans*, and their owners.

    Spans shorter than a *segment* (seconds) are one; of longer ones only what lies within *times* is cut up.
    """
    time0, value0, slope0, time1, value1, slope1, held = spans
    ends = np.array([time0, value0, time1, value1])
    with np.errstate(over="ignore"):
        short = (time1 - time0 <= segment) & ~held
        if short.all():
            return ends, owners
        low, high = np.maximum(time0, times[0]), np.minimum(time1, times[1])
        counts = np.ceil((high - low) / segment)
    long = np.flatnonzero(~short & (counts > 0))
    which, step, width = _steps(long, low, high, counts)
    start = low[which] + step * width
    end = np.where(step + 1 == counts[which], high[which], start + width)
    with np.errstate(all="ignore"):
        d_time, d_value = time1[which] - time0[which], value1[which] - value0[which]
        m0, m1 = np.where(held[which], 0.0, slope0[which] * d_time), np.where(held[which], 0.0, slope1[which] * d_time)
        rise = np.where(held[which], 0.0, d_value)
        u0, u1 = (start - time0[which]) / d_time, (end - time0[which]) / d_time
        from_value, to_value = (
            value0[which] + u * (m0 + u * (3 * rise - 2 * m0 - m1 + u * (m0 + m1 - 2 * rise))) for u in (u0, u1)
        )
    jump = np.flatnonzero(held)  # a held span ends in a jump, drawn upright
    segments = (
        ends.take(np.flatnonzero(short), axis=1),
        np.array([start, from_value, end, to_value]),
        np.array([time1[jump], value0[jump], time1[jump], value1[jump]]),
    )
    return np.concatenate(segments, axis=1), np.concatenate([owners[short], owners[which], owners[jump]])


def _steps(spans: Ints, low: Floats, high: Floats, counts: Floats) -> tuple[Ints, Floats, Floats]:
    """For each piece of *spans*, cut into *counts* pieces: its span, its number there and its width."""
    pieces = counts[spans].astype(np.int64)
    which = np.repeat(spans, pieces)
    step = np.arange(len(which)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    return which, step.astype(np.float64), (high[which] - low[which]) / counts[which]
