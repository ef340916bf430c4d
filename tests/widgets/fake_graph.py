"""A graph without a picture: a linear map and a memory of what it was told to show, for tests of tools."""

from typing import Any

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtWidgets import QWidget

from model.channel import Channel
from model.document import Document
from model.event import Event
from model.sampling import Window
from widgets.graph import DrawnHandle, Frame
from widgets.hit_test import Hit

HANDLE = 60.0


class FakeGraph:
    """A plot of 1600 x 900 pixels at (50, 30), showing [t0, t1] x [v0, v1]."""

    def __init__(self, document: Document, range_: tuple[float, float, float, float] = (0.0, 16.0, 0.0, 9.0)) -> None:
        self.document = document
        self.plot_rect = QRectF(50.0, 30.0, 1600.0, 900.0)
        self.range = range_
        self.view_changed: Any = Event[()]()
        self.shown: dict[str, Any] = {}

    @property
    def window_now(self) -> Window:
        plot = self.plot_rect
        return Window(plot.left(), plot.top(), plot.width(), plot.height(), *self.range)

    def x_from_time(self, time: Any) -> Any:
        t0, t1 = self.range[:2]
        return self.plot_rect.left() + (time - t0) / (t1 - t0) * self.plot_rect.width()

    def y_from_value(self, value: Any) -> Any:
        v0, v1 = self.range[2:]
        return self.plot_rect.bottom() - (value - v0) / (v1 - v0) * self.plot_rect.height()

    def time_from_x(self, x: Any) -> Any:
        t0, t1 = self.range[:2]
        return t0 + (x - self.plot_rect.left()) / self.plot_rect.width() * (t1 - t0)

    def value_from_y(self, y: Any) -> Any:
        v0, v1 = self.range[2:]
        return v0 + (self.plot_rect.bottom() - y) / self.plot_rect.height() * (v1 - v0)

    def handle_points(self, channel: Channel, key_id: int) -> tuple[Any, Any]:
        key = channel.key(key_id)
        x, y = self.x_from_time(key.time), self.y_from_value(key.value)
        ends = []
        for sign, slope in ((-1.0, key.slope_in), (1.0, key.slope_out)):
            dx = self.x_from_time(1.0) - self.x_from_time(0.0)
            dy = (self.y_from_value(1.0) - self.y_from_value(0.0)) * slope
            length = (dx * dx + dy * dy) ** 0.5
            ends.append((x + sign * HANDLE * dx / length, y + sign * HANDLE * dy / length))
        return ends[0], ends[1]

    def drawn_handles(self) -> list[DrawnHandle]:
        keys = self.document.session.selection.keys()
        return [DrawnHandle(channel, key_id, *self.handle_points(channel, key_id)) for channel, key_id in keys]

    def pan_pixels(self, dx: float, dy: float) -> None:
        t0, t1, v0, v1 = self.range
        dt, dv = dx / self.plot_rect.width() * (t1 - t0), dy / self.plot_rect.height() * (v1 - v0)
        self.range = (t0 - dt, t1 - dt, v0 + dv, v1 + dv)

    def zoom(self, fx: float, fy: float, center: QPointF) -> None:
        time, value = self.time_from_x(center.x()), self.value_from_y(center.y())
        t0, t1, v0, v1 = self.range
        self.range = (
            *(time + (t0 - time) / fx, time + (t1 - time) / fx),
            *(value + (v0 - value) / fy, value + (v1 - value) / fy),
        )

    def set_hover(self, hit: Hit | None) -> None:
        self.shown["hover"] = hit

    def set_box(self, box: QRectF | None) -> None:
        self.shown["box"] = box

    def set_frame(self, frame: Frame | None) -> None:
        self.shown["frame"] = frame

    def set_insert_preview(self, channel: Channel | None, time: float | None) -> None:
        self.shown["insert"] = (channel, time)

    def say(self, text: str) -> None:
        self.shown["said"] = text

    def viewport(self) -> QWidget:
        raise NotImplementedError
