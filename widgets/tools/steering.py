"""Steering: how far a drag has gone in time and value, with the axis lock of Shift and the fine speed of Alt."""

from math import degrees

from model.channel import Channel
from model.labels import short_name
from widgets.graph import Graph
from widgets.hit_test import Hit
from widgets.numbers import factor_of, suffix_of
from widgets.tools.base import Point

FINE_SPEED = 0.1


class Steering:
    """Differences between the pointer and where the drag began.

    They are kept in time and value, not in pixels, so that a view that scrolls or zooms under the drag changes nothing.
    """

    def __init__(self, graph: Graph, start: Point) -> None:
        self.graph = graph
        self.start = start
        self.lock: str | None = None
        self._last = start.time, start.value
        self._held_back = 0.0, 0.0  # what the fine speed has taken off so far

    def steer(self, point: Point, *, locks: bool = True) -> tuple[float, float]:
        """(d_time, d_value) since the start; with Shift only along the direction that was further when it went down."""
        last_time, last_value = self._last
        self._last = point.time, point.value
        if point.alt:
            back_time, back_value = self._held_back
            rest = 1.0 - FINE_SPEED
            self._held_back = (
                back_time + rest * (point.time - last_time),
                back_value + rest * (point.value - last_value),
            )
        d_time = point.time - self.start.time - self._held_back[0]
        d_value = point.value - self.start.value - self._held_back[1]
        if not (point.shift and locks):
            self.lock = None
            return d_time, d_value
        if self.lock is None:
            dx, dy = self.pixels(d_time, d_value)
            self.lock = "time" if abs(dx) >= abs(dy) else "value"
        return (d_time, 0.0) if self.lock == "time" else (0.0, d_value)

    def pixels(self, d_time: float, d_value: float) -> tuple[float, float]:
        """The same difference in pixels of the present view."""
        graph, start = self.graph, self.start
        return (
            graph.x_from_time(start.time + d_time) - graph.x_from_time(start.time),
            graph.y_from_value(start.value + d_value) - graph.y_from_value(start.value),
        )


def time_text(d_time: float) -> str:
    """A difference of time with its sign, as "+0.10 s"."""
    return f"{_signed(d_time)} s"


def value_text(channel: Channel | None, d_value: float) -> str:
    """A difference of value with its sign, in the unit the channel shows."""
    if channel is not None and channel.unit == "angle":
        return f"{_signed(degrees(d_value))}°"
    unit = f" {channel.unit}" if channel is not None and channel.unit else ""
    return f"{_signed(d_value)}{unit}"


def place_text(hit: Hit) -> str:
    """What is under the pointer, as "root.tx at 1.083 s: 0.4 m"."""
    channel = hit.channel
    assert channel is not None
    value = hit.value * factor_of(channel.unit)
    return f"{short_name(channel)} at {hit.time:.4g} s: {value:.4g}{suffix_of(channel.unit)}"


def slope_text(channel: Channel, slope: float) -> str:
    """A slope in the unit the channel shows, as "2.5 m/s"."""
    if channel.unit == "angle":
        return f"{degrees(slope):.4g}°/s"
    return f"{slope:.4g} {channel.unit}/s" if channel.unit else f"{slope:.4g}/s"


def _signed(number: float) -> str:
    if abs(number) < 1e-9:
        return "+0.00"
    text = f"{number:+.4g}" if abs(number) < 0.1 or abs(number) >= 1e4 else f"{number:+.2f}"
    return text.replace("-", "−")
