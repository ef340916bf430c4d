"""What a curve looks like through a window of pixels: adaptive lines where keys are few, else columns."""

from typing import NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from model.channel import Channel, Spans
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule

type Floats = NDArray[np.float64]

# No line may leave the true cubic by more pixels than this.
TOLERANCE = 0.25
# Qt's painter hangs or paints rubbish far outside the window: nothing is drawn beyond this many pixels.
FAR = 1e5
# Beyond this the arithmetic of crossings overflows, and every line is upright anyway.
HUGE = 1e30
MOST_PIECES = 4096


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


class Line(NamedTuple):
    """A chain of points in pixels; the steps of a curve are upright pieces of it."""

    x: Floats
    y: Floats


def crowded(channel: Channel, window: Window) -> bool:
    """Whether the window shows more than one key in two pixels, so that lines would only scribble."""
    return channel.count_between(window.t0, window.t1) > window.width / 2


def line_through(spans: Spans, window: Window, tolerance: float = TOLERANCE) -> Line:
    """The spans as one chain of points within *tolerance* pixels of the true cubics, keys and extrema exact.

    Its points depend on each span and on the window alone, so that a part drawn again meets the rest pixel by pixel.
    """
    count = len(spans.time0)
    if count == 0:
        return Line(np.empty(0), np.empty(0))
    with np.errstate(over="ignore", invalid="ignore"):
        length = spans.time1 - spans.time0
        # Of a span wider than the window only the part inside is cut into pieces.
        margin = 64.0 / window.px_per_second
        u0 = np.clip((window.t0 - margin - spans.time0) / length, 0.0, 1.0)
        u1 = np.clip((window.t1 + margin - spans.time0) / length, 0.0, 1.0)
        part = u1 - u0
        bend = np.maximum(np.abs(2 * spans.b + 6 * spans.a * u0), np.abs(2 * spans.b + 6 * spans.a * u1))
        # A chord of a parabola leaves it by an eighth of the second derivative times its length squared; two points
        # moved onto extrema may stretch the piece between them to twice its length.
        pieces = part * np.sqrt(bend * (window.px_per_value / (8 * tolerance / 4)))
        n = np.ceil(np.clip(np.nan_to_num(pieces, nan=MOST_PIECES, posinf=MOST_PIECES), 1, MOST_PIECES)).astype(np.intp)
        ends = np.cumsum(n + 1)
        which = np.repeat(np.arange(count), n + 1)
        step = np.arange(ends[-1]) - np.repeat(ends - n - 1, n + 1)
        u = u0[which] + part[which] * (step / n[which])
        _set_extrema(u, spans, u0, part, n, ends - n - 1)
        x = window.x_from_time(spans.time0[which] + u * length[which])
        value = spans.d[which] + u * (spans.c[which] + u * (spans.b[which] + u * spans.a[which]))
        return kept_near(x, window.y_from_value(value), window.top)


def _set_extrema(
    u: Floats, spans: Spans, u0: Floats, part: Floats, n: NDArray[np.intp], starts: NDArray[np.intp]
) -> None:
    """Move the nearest inner point of each span onto each extremum; a span of one piece has none worth a point."""
    bent = np.flatnonzero(n > 1)
    if not len(bent):
        return
    a, b, c = 3 * spans.a[bent], spans.b[bent], spans.c[bent]
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    q = -(b + np.copysign(root, b))
    with np.errstate(divide="ignore"):
        for r in (q / a, c / q):
            j = (r - u0[bent]) / part[bent] * n[bent]
            hit = (j > 0) & (j < n[bent])
            if hit.any():
                at = np.clip(np.rint(j[hit]), 1, n[bent][hit] - 1).astype(np.intp)
                u[starts[bent][hit] + at] = r[hit]


def kept_near(x: Floats, y: Floats, top: float = 0.0) -> Line:
    """The chain cut where it leaves the pixels that Qt can paint; the slopes of what stays are kept."""
    y = np.nan_to_num(y, nan=0.0, posinf=HUGE, neginf=-HUGE)
    if len(y) and max(y.max(), -y.min()) > FAR:
        y = np.clip(y, -HUGE, HUGE)
        for limit in (FAR, -FAR):
            at = np.flatnonzero((y[:-1] - limit) * (y[1:] - limit) < 0)
            if len(at):
                part = (limit - y[at]) / (y[at + 1] - y[at])
                x = np.insert(x, at + 1, x[at] + part * (x[at + 1] - x[at]))
                y = np.insert(y, at + 1, limit)
        y = np.clip(y, -FAR, FAR)
    return Line(np.clip(x, -FAR, FAR), y)


def columns(channel: Channel, window: Window, first: int, last: int, *, inside: bool = True) -> tuple[Floats, Floats]:
    """Top and bottom y of the curve in the pixel columns *first* to *last* - 1, exact.

    *inside* leaves the extrapolation out. Column j covers the x from window.left + j to window.left + j + 1.
    """
    edges = window.time_from_x(window.left + np.arange(first, last + 1, dtype=np.float64))
    ends = (channel.first, channel.last)
    if inside and ends[0] is not None and ends[1] is not None:
        edges = np.clip(edges, ends[0].time, ends[1].time)
    low, high = channel.envelope(edges)
    with np.errstate(over="ignore"):
        return np.clip(window.y_from_value(high), -FAR, FAR), np.clip(window.y_from_value(low), -FAR, FAR)


def spans_outside(channel: Channel, t0: float, t1: float, *, after: bool, most: int) -> Spans | None:
    """The extrapolation between *t0* and *t1* on one side as spans; None if that takes more than *most* of them."""
    first, last = channel.first, channel.last
    if first is None or last is None:
        return _no_spans()
    end, mode = (last, channel.post) if after else (first, channel.pre)
    t0, t1 = (max(t0, end.time), t1) if after else (t0, min(t1, end.time))
    if not t0 < t1:
        return _no_spans()
    if mode is Extrapolation.CONSTANT or mode is Extrapolation.LINEAR or first == last:
        slope = 0.0
        if mode is Extrapolation.LINEAR:
            held = after and end.rule_out == TangentRule.STEP
            slope = 0.0 if held else (end.slope_out if after else end.slope_in)
        with np.errstate(over="ignore"):
            rise = float(np.clip(np.float64(slope) * (t1 - t0), -1e300, 1e300))
            start = end.value if after else float(np.clip(end.value - rise, -1e300, 1e300))
        return Spans(*(np.array([number], np.float64) for number in (t0, t1, 0.0, 0.0, rise, start)))
    period = last.time - first.time
    low = np.floor((t0 - first.time) / period)
    high = np.floor((t1 - first.time) / period)
    low, high = (max(low, 1.0), high) if after else (low, min(high, -1.0))
    copies = max(high - low + 1.0, 0.0)
    if copies * len(channel) > most:
        return None
    whole = channel.spans_between(first.time, last.time)
    mirrored = _mirrored(whole, first.time + last.time)
    climb = last.value - first.value if mode is Extrapolation.CYCLE_OFFSET else 0.0
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


def dashes(line: Line, pattern: tuple[float, ...], anchor: float) -> Floats:
    """The drawn pieces (n, 4) of x0, y0, x1, y1 of a chain under a dash pattern (drawn, gap, ... in pixels).

    Dashes are counted along x from *anchor*, not along the chain: an edit moves no dash beside it. Steps stay whole.
    """
    x, y = line
    if len(x) < 2:
        return np.empty((0, 4))
    period = float(sum(pattern))
    starts = np.cumsum((0.0, *pattern[:-1]))
    turns = np.arange(np.floor((x[0] - anchor) / period), np.floor((x[-1] - anchor) / period) + 1)
    marks = (anchor + turns[:, None] * period + starts).reshape(-1)
    inner = marks[(marks > x[0]) & (marks < x[-1])]
    after = np.searchsorted(x, inner)
    px = np.insert(x, after, inner)
    py = np.insert(y, after, np.interp(inner, x, y))
    drawn = (np.searchsorted(marks, (px[:-1] + px[1:]) / 2, "right") - 1) % len(pattern) % 2 == 0
    upright = px[:-1] == px[1:]
    pieces: Floats = np.stack((px[:-1], py[:-1], px[1:], py[1:]), axis=1)
    return pieces.compress(drawn | upright & (py[:-1] != py[1:]), axis=0)
