"""Labels: what an undo step says it did, as in "Move 14 keys of root.tx by +0.10 s"."""

from collections.abc import Iterable
from math import degrees

from model.channel import Channel
from model.selection import Selection

LONGEST_NAME = 40


def short_name(channel: Channel) -> str:
    """The channel's name, cut in the middle where it is long."""
    name = channel.name
    if len(name) <= LONGEST_NAME:
        return name
    half = (LONGEST_NAME - 1) // 2
    return f"{name[:half]}…{name[-half:]}"


def counted(number: int, noun: str) -> str:
    """As "1 key" or "1,400 keys"."""
    return f"1 {noun}" if number == 1 else f"{number:,} {noun}s"


def channels_text(channels: Iterable[Channel]) -> str:
    """The name of one channel, or how many there are."""
    channels = tuple(channels)
    return short_name(channels[0]) if len(channels) == 1 else counted(len(channels), "channel")


def keys_text(selection: Selection) -> str:
    """As "14 keys of root.tx" or "3 keys of 2 channels"."""
    return f"{counted(selection.count, 'key')} of {channels_text(selection.channels)}"


def difference_text(channels: Iterable[Channel], d_time: float = 0.0, d_value: float = 0.0) -> str:
    """As "by +0.10 s and -1.5 m"; angles in degrees, other units only where all *channels* share one."""
    parts = []
    if d_time:
        parts.append(f"{_signed(d_time)} s")
    if d_value:
        units = {channel.unit for channel in channels}
        unit = units.pop() if len(units) == 1 else ""
        parts.append(f"{_signed(degrees(d_value))}°" if unit == "angle" else f"{_signed(d_value)} {unit}".rstrip())
    return f"by {' and '.join(parts)}" if parts else ""


def _signed(number: float) -> str:
    """Two decimals, or as many digits as it takes for small and large numbers."""
    return f"{number:+.2f}" if 0.1 <= abs(number) < 1e6 or number == 0.0 else f"{number:+.3g}"


def label_of(verb: str, selection: Selection, d_time: float = 0.0, d_value: float = 0.0) -> str:
    """As "Move 14 keys of root.tx by +0.10 s", "Delete 3 keys of 2 channels"."""
    return f"{verb} {keys_text(selection)} {difference_text(selection.channels, d_time, d_value)}".rstrip()
