"""ViewRange: which times and values the view shows, as far as they can be drawn; ViewHistory: back and forward."""

from math import isfinite
from typing import NamedTuple

# Beyond these, pixels and doubles no longer tell neighbouring points apart.
FARTHEST = 1e12
LEAST_SPAN = 1e-12
LEAST_RELATIVE_SPAN = 1e-9


class ViewRange(NamedTuple):
    """Seconds t0 to t1 and values v0 to v1."""

    t0: float
    t1: float
    v0: float
    v1: float

    def limited(self) -> "ViewRange":
        """The nearest range that can be drawn; ValueError if a number is not finite."""
        if not all(map(isfinite, self)):
            raise ValueError(f"a view needs finite times and values, not {tuple(self)}")
        return ViewRange(*_limited(self.t0, self.t1), *_limited(self.v0, self.v1))

    def panned(self, d_time: float, d_value: float) -> "ViewRange":
        """The range moved by so much."""
        return ViewRange(self.t0 + d_time, self.t1 + d_time, self.v0 + d_value, self.v1 + d_value)

    def zoomed(self, f_time: float, f_value: float, time: float, value: float) -> "ViewRange":
        """The range with (time, value) kept in place and everything else so many times as near."""
        return ViewRange(
            time + (self.t0 - time) / f_time,
            time + (self.t1 - time) / f_time,
            value + (self.v0 - value) / f_value,
            value + (self.v1 - value) / f_value,
        )


def fitted(t0: float, t1: float, v0: float, v1: float, margins: tuple[float, float]) -> ViewRange:
    """The range that shows the given one with a margin, as a part of the view, left and right, above and below."""
    times = _widened(t0, t1, 1.0, margins[0])
    values = _widened(v0, v1, 1.0, margins[1])
    return ViewRange(*times, *values).limited()


def _widened(low: float, high: float, least: float, margin: float) -> tuple[float, float]:
    low, high = max(low, -FARTHEST), min(high, FARTHEST)
    if not high > low or high - low < LEAST_RELATIVE_SPAN * max(abs(low), abs(high)):
        # One point, or a level line: show it in the middle of a scale that suits its size.
        center, half = (low + high) / 2, max(least, abs(low), abs(high)) / 2
        return center - half, center + half
    extra = (high - low) * margin / (1 - 2 * margin)
    return low - extra, high + extra


def _limited(low: float, high: float) -> tuple[float, float]:
    low, high = min(low, high), max(low, high)
    center = min(max(low / 2 + high / 2, -FARTHEST), FARTHEST)
    span = min(high / 2 - low / 2, FARTHEST) * 2
    least = max(LEAST_SPAN, LEAST_RELATIVE_SPAN * abs(center))
    if span >= least and low >= -FARTHEST and high <= FARTHEST:
        return low, high
    half = max(span, least) / 2
    center = min(max(center, half - FARTHEST), FARTHEST - half)
    return center - half, center + half


class ViewHistory:
    """The views the user has left, to go back to and forward again; small steps in a row count as one."""

    DEPTH = 100

    def __init__(self) -> None:
        self._back: list[ViewRange] = []
        self._forward: list[ViewRange] = []

    def leave(self, view: ViewRange) -> None:
        """Remember *view*, which is about to be replaced by one the user asked for."""
        self._forward.clear()
        if not self._back or self._back[-1] != view:
            self._back.append(view)
            del self._back[: -self.DEPTH]

    def back(self, present: ViewRange) -> ViewRange | None:
        """The view before, None if there is none."""
        return self._step(self._back, self._forward, present)

    def forward(self, present: ViewRange) -> ViewRange | None:
        """The view that going back left."""
        return self._step(self._forward, self._back, present)

    def leads_back(self, present: ViewRange) -> bool:
        """Whether there is a view before."""
        return any(view != present for view in self._back)

    def leads_forward(self, present: ViewRange) -> bool:
        """Whether going back left a view."""
        return any(view != present for view in self._forward)

    @staticmethod
    def _step(source: list[ViewRange], target: list[ViewRange], present: ViewRange) -> ViewRange | None:
        while source:
            view = source.pop()
            if view != present:
                target.append(present)
                return view
        return None
