"""Snapping: whole frames, and the times and values of other keys."""

from collections.abc import Iterable
from math import isfinite

from model.channel import Channel
from model.clip import Clip
from model.hermite import Floats

# A key this near to a frame (seconds) was meant to be on it: its own time is used, so that the two coincide.
SAME_TIME = 1e-6


def nearest_time(channels: Iterable[Channel], time: float, within: float) -> float | None:
    """The time of the key of *channels* nearest to *time* and at most *within* seconds away."""
    times = [run["time"] for channel in channels if len(run := channel.keys_between(time - within, time + within))]
    return min((near(column, time) for column in times), key=lambda key: abs(key - time), default=None)


def near(times: Floats, time: float) -> float:
    """The one of *times*, of which there is one at least, nearest to *time*."""
    return float(times[abs(times - time).argmin()])


def snapped_to_frame(clip: Clip, time: float, channels: Iterable[Channel] = ()) -> float:
    """The whole frame nearest to *time*, or the exact time of a key of *channels* that lies on it but for rounding."""
    frame = clip.frame_of(time)
    if not isfinite(frame) or abs(frame) >= 2.0**52:
        return time
    snapped = clip.time_of(round(frame))
    key_time = nearest_time(channels, snapped, SAME_TIME)
    return snapped if key_time is None else key_time


def snapped_to_keys(channels: Iterable[Channel], time: float, within: float) -> float:
    """The time of the key nearest to *time*, or *time* where none lies within that many seconds."""
    key_time = nearest_time(channels, time, within)
    return time if key_time is None else key_time


def snapped_to_values(channels: Iterable[Channel], time: float, value: float, within: float) -> float:
    """The nearest value that one of *channels* has at *time*, or *value* where none lies within that distance."""
    levels = [level for channel in channels if abs((level := channel.value(time)) - value) <= within]
    return min(levels, key=lambda level: abs(level - value), default=value)
