"""What of a curve falls into a window of pixels: its exact columns, and its spans beyond the keys."""

from typing import NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from model.channel import Channel, Spans
from model.extrapolation import Extrapolation

type Floats = NDArray[np.float64]

# Qt's painter hangs or paints rubbish far outside the window: nothing is drawn beyond this many pixels.
FAR = 1e5
# No value is drawn beyond this; and numbers above the other one are not copied, since their sums may overflow.
LARGE, TOO_LARGE = 1e300, 1e280


class Window(NamedTuple):
    """A rectangle of pixels onto time and value; *unit* is how many of its pixels make one on the user's scale."""

    left: float
    top: float
    width: float
    height: float
    t0: float
    t1: float
    v0: float
    v1: float
    unit: float = 1.0

    @property
    def px_per_second(self) -> float:
        """Pixels per second."""
        return self.width / (self.t1 - self.t0)

    @property
    def px_per_value(self) -> float:
        """Pixels per unit of value."""
        return self.height / (self.v1 - self.v0)

    @property
    def right(self) -> float:
        """The x of the right edge."""
        return self.left + self.width

    @property
    def bottom(self) -> float:
        """The y of the lower edge."""
        return self.top + self.height

    @overload
    def x_from_time(self, time: float) -> float: ...
    @overload
    def x_from_time(self, time: Floats) -> Floats: ...
    def x_from_time(self, time: float | Floats) -> float | Floats:
        """Pixels from seconds."""
        return self.left + (time - self.t0) * self.px_per_second

    @overload
    def y_from_value(self, value: float) -> float: ...
    @overload
    def y_from_value(self, value: Floats) -> Floats: ...
    def y_from_value(self, value: float | Floats) -> float | Floats:
        """Pixels, downwards, from values."""
        return self.top + (self.v1 - value) * self.px_per_value

    @overload
    def time_from_x(self, x: float) -> float: ...
    @overload
    def time_from_x(self, x: Floats) -> Floats: ...
    def time_from_x(self, x: float | Floats) -> float | Floats:
        """Seconds from pixels."""
        return self.t0 + (x - self.left) / self.px_per_second

    @overload
    def value_from_y(self, y: float) -> float: ...
    @overload
    def value_from_y(self, y: Floats) -> Floats: ...
    def value_from_y(self, y: float | Floats) -> float | Floats:
        """Values from pixels."""
        return self.v1 - (y - self.top) / self.px_per_value

    def scaled(self, factor: float) -> "Window":
        """The same rectangle counted in pixels *factor* times as small."""
        sides = (self.left * factor, self.top * factor, self.width * factor, self.height * factor)
        return self._replace(left=sides[0], top=sides[1], width=sides[2], height=sides[3], unit=self.unit * factor)


def keys_in(channel: Channel, window: Window) -> int:
    """How many keys lie between the window's times."""
    ends = channel.ends()
    if ends is None:
        return 0
    if window.t0 <= ends.time0 and ends.time1 <= window.t1:
        return len(channel)
    return channel.count_between(window.t0, window.t1)


def columns(channel: Channel, window: Window, first: int, last: int, *, inside: bool = True) -> tuple[Floats, Floats]:
    """Top and bottom y of the curve in the pixel columns *first* to *last* - 1, exact.

    *inside* leaves the extrapolation out. Column j covers the x from window.left + j to window.left + j + 1.
    """
    edges = window.time_from_x(window.left + np.arange(first, last + 1.0))
    ends = channel.ends()
    if inside and ends is not None:
        edges = np.minimum(np.maximum(edges, ends.time0), ends.time1)
    found = np.array(channel.envelope(edges)[::-1])
    with np.errstate(over="ignore"):
        top, bottom = np.minimum(np.maximum(window.y_from_value(found), -FAR), FAR)
    return top, bottom


def slope_outside(channel: Channel, *, after: bool) -> float | None:
    """The slope of the straight line that goes on from the first or last key; None if the keys are repeated there."""
    mode, ends = channel.post if after else channel.pre, channel.ends()
    if mode is Extrapolation.CONSTANT or ends is None:
        return 0.0
    if mode is Extrapolation.LINEAR:
        return ends.slope1 if after else ends.slope0
    return 0.0 if ends.time0 == ends.time1 else None


def spans_outside(channel: Channel, t0: float, t1: float, *, after: bool, most: int) -> Spans | None:
    """The extrapolation between *t0* and *t1* on one side as spans; None if that takes more than *most* of them.

    None too if numbers are so large that copies of them overflow: their columns are still exact.
    """
    ends, mode = channel.ends(), channel.post if after else channel.pre
    if ends is None:
        return _no_spans()
    t0, t1 = (max(t0, ends.time1), t1) if after else (t0, min(t1, ends.time0))
    if not t0 < t1:
        return _no_spans()
    slope = slope_outside(channel, after=after)
    if slope is not None:
        rise = min(max(slope * (t1 - t0), -LARGE), LARGE)
        start = ends.value1 if after else min(max(ends.value0 - rise, -LARGE), LARGE)
        return Spans(*(np.array([number], np.float64) for number in (t0, t1, 0.0, 0.0, rise, start)))
    period = ends.period
    low, high = (t0 - ends.time0) // period, (t1 - ends.time0) // period
    low, high = (max(low, 1.0), high) if after else (low, min(high, -1.0))
    copies = max(high - low + 1.0, 0.0)
    if copies * len(channel) > most:
        return None
    whole = channel.spans_between(ends.time0, ends.time1)
    if not np.abs(np.array(whole)).max() < TOO_LARGE or not abs(ends.value1) < TOO_LARGE:
        return None
    mirrored = _mirrored(whole, ends.time0 + ends.time1)
    climb = ends.value1 - ends.value0 if mode is Extrapolation.CYCLE_OFFSET else 0.0
    parts = []
    for k in np.arange(low, low + copies):
        part = mirrored if mode is Extrapolation.BOUNCE and k % 2 else whole
        parts.append(part._replace(time0=part.time0 + k * period, time1=part.time1 + k * period, d=part.d + k * climb))
    return Spans(*(np.concatenate(column) for column in zip(*parts, strict=True))) if parts else _no_spans()


def _mirrored(spans: Spans, turn: float) -> Spans:
    """The spans seen backwards in time: what was at t is now at *turn* - t."""
    time0, time1, a, b, c, d = (column[::-1] for column in spans)
    return Spans(turn - time1, turn - time0, -a, 3 * a + b, -(3 * a + 2 * b + c), a + b + c + d)


def _no_spans() -> Spans:
    return Spans(*(np.empty(0) for _ in range(6)))
