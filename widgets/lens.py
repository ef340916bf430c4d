"""Lens: the map between pixels and (time, value) of one moment, for those who ask it many times in a row."""

from typing import overload

import numpy as np
from numpy.typing import NDArray

from widgets.graph import Graph

type Floats = NDArray[np.float64]


class Lens:
    """What graph.x_from_time and its sisters say now; both axes are linear, so the corners of the plot are enough."""

    def __init__(self, graph: Graph) -> None:
        self.left, self.top, width, height, self.t0, self.t1, self.v0, self.v1, _ = graph.window_now
        self.right, self.bottom = self.left + width, self.top + height
        self._time_per_x = (self.t1 - self.t0) / (self.right - self.left)
        self._value_per_y = (self.v1 - self.v0) / (self.top - self.bottom)

    @overload
    def x(self, time: float) -> float: ...
    @overload
    def x(self, time: Floats) -> Floats: ...
    def x(self, time: float | Floats) -> float | Floats:
        """Pixels from seconds."""
        return self.left + (time - self.t0) / self._time_per_x

    @overload
    def y(self, value: float) -> float: ...
    @overload
    def y(self, value: Floats) -> Floats: ...
    def y(self, value: float | Floats) -> float | Floats:
        """Pixels, downwards, from values."""
        return self.bottom + (value - self.v0) / self._value_per_y

    @overload
    def time(self, x: float) -> float: ...
    @overload
    def time(self, x: Floats) -> Floats: ...
    def time(self, x: float | Floats) -> float | Floats:
        """Seconds from pixels."""
        return self.t0 + (x - self.left) * self._time_per_x

    def value(self, y: float) -> float:
        """Values from pixels."""
        return self.v0 + (y - self.bottom) * self._value_per_y
