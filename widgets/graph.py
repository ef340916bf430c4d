"""Graph: what the tools and the hit test know of the curve view, so that either can be tested without the other."""

from typing import TYPE_CHECKING, NamedTuple, Protocol, overload

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, SignalInstance
from PySide6.QtWidgets import QWidget

from model.channel import Channel
from model.document import Document
from model.sampling import Window

if TYPE_CHECKING:
    from widgets.hit_test import Hit

type Spot = tuple[float, float]


class Frame(NamedTuple):
    """A box with handles around the selection, in viewport pixels; the cross of *pivot* is what stays."""

    box: QRectF
    handles: tuple[QPointF, ...]
    pivot: QPointF | None


class DrawnHandle(NamedTuple):
    """The ends of one key's handles as drawn, in viewport pixels; None for a side without one."""

    channel: Channel
    id: int
    into: Spot | None
    out: Spot | None


class Graph(Protocol):
    """The picture of the curves: a map between viewport pixels and (time, value), and what is drawn over it."""

    @property
    def document(self) -> Document: ...

    @property
    def view_changed(self) -> SignalInstance: ...

    @property
    def plot_rect(self) -> QRectF: ...

    @property
    def window_now(self) -> Window: ...

    @overload
    def x_from_time(self, time: float) -> float: ...
    @overload
    def x_from_time(self, time: NDArray[np.float64]) -> NDArray[np.float64]: ...

    @overload
    def y_from_value(self, value: float) -> float: ...
    @overload
    def y_from_value(self, value: NDArray[np.float64]) -> NDArray[np.float64]: ...

    @overload
    def time_from_x(self, x: float) -> float: ...
    @overload
    def time_from_x(self, x: NDArray[np.float64]) -> NDArray[np.float64]: ...

    @overload
    def value_from_y(self, y: float) -> float: ...
    @overload
    def value_from_y(self, y: NDArray[np.float64]) -> NDArray[np.float64]: ...

    def drawn_handles(self) -> list[DrawnHandle]: ...

    def handle_points(self, channel: Channel, key_id: int) -> tuple[Spot | None, Spot | None]: ...

    def pan_pixels(self, dx: float, dy: float) -> None: ...

    def zoom(self, fx: float, fy: float, center: QPointF) -> None: ...

    def set_hover(self, hit: "Hit | None") -> None: ...

    def set_box(self, box: QRectF | None) -> None: ...

    def set_frame(self, frame: Frame | None) -> None: ...

    def set_insert_preview(self, channel: Channel | None, time: float | None) -> None: ...

    def say(self, text: str) -> None: ...

    def viewport(self) -> QWidget: ...
