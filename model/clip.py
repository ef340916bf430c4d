"""Clip: channels by name, with a range and a frame rate."""

from collections.abc import Iterable

from model.channel import Channel
from model.hermite import LARGEST


class Clip:
    """Channels of different names that are played together from `start` to `end` (seconds)."""

    def __init__(
        self,
        channels: Iterable[Channel] = (),
        *,
        start: float = 0.0,
        end: float = 0.0,
        frame_rate: float = 30.0,
        title: str = "",
    ) -> None:
        self.channels: list[Channel] = list(channels)
        self.start, self.end, self.frame_rate, self.title = float(start), float(end), float(frame_rate), title

    def channel(self, name: str) -> Channel:
        """The channel called *name*; KeyError if there is none."""
        for channel in self.channels:
            if channel.name == name:
                return channel
        raise KeyError(name)

    def unique_name(self, base: str) -> str:
        """*base*, or *base* with the first number behind it that makes it new here."""
        names = {channel.name for channel in self.channels}
        name, number = base, 1
        while name in names:
            number += 1
            name = f"{base}{number}"
        return name

    @property
    def key_count(self) -> int:
        """How many keys all channels hold."""
        return sum(len(channel) for channel in self.channels)

    def extent(self) -> tuple[float, float] | None:
        """(first, last) time of all keys; None without keys."""
        ends = [ends for channel in self.channels if (ends := channel.ends()) is not None]
        return (min(each.time0 for each in ends), max(each.time1 for each in ends)) if ends else None

    def pose(self, time: float) -> dict[str, float]:
        """The value of every channel at *time*."""
        return {channel.name: channel.value(time) for channel in self.channels}

    def frame_of(self, time: float) -> float:
        """The frame, counted from the time 0, whole or not, at *time*; finite for every finite time."""
        return min(max(time * self.frame_rate, -LARGEST), LARGEST)

    def time_of(self, frame: float) -> float:
        """The time of *frame* in seconds; finite for every finite frame."""
        return min(max(frame / self.frame_rate, -LARGEST), LARGEST)

    def check(self) -> None:
        """Assert that names are unique and that every channel is sound."""
        names = [channel.name for channel in self.channels]
        assert len(set(names)) == len(names), "two channels have the same name"
        for channel in self.channels:
            channel.check()
