"""CurveView: the graph; owns the view onto time and value, paints through its canvas, hands input to the mouse."""

from collections.abc import Sequence
from time import monotonic
from typing import Any, Final, overload

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPointF, QRectF, QSizeF, Qt, Signal
from PySide6.QtGui import QImage, QPainter, QResizeEvent
from PySide6.QtWidgets import QGraphicsView, QSizePolicy

from model.channel import Channel
from model.document import Document
from model.keyframe import KeyGoneError
from model.sampling import Window
from widgets.canvas import Canvas
from widgets.chosen import MOST, with_neighbours
from widgets.fitting import active_fitted, all_fitted, channels_fitted, clip_fitted, selection_fitted
from widgets.graph import DrawnHandle, Frame, Spot
from widgets.guard import guarded
from widgets.hit_test import Hit
from widgets.last_picture import last_picture
from widgets.layers.handles import handles_of, shown_handles
from widgets.layers.overlays import DOT
from widgets.mouse import MouseRouter
from widgets.rulers import TIME_HEIGHT
from widgets.theme import Theme
from widgets.ticks import VALUE_WIDTH
from widgets.view_range import ViewHistory, ViewRange

pg.setConfigOptions(mouseRateLimit=-1)

type Floats = NDArray[np.float64]

# Steps of the view that follow each other sooner than this are one for "back".
ONE_STEP: Final = 0.6
START: Final = ViewRange(-0.1, 1.1, -0.1, 1.1)


class CurveView(pg.GraphicsView):  # type: ignore[misc]  # pyqtgraph is not typed
    """The curves of a document's shown channels; sizes are logical pixels of the viewport."""

    view_changed = Signal()
    hint_changed = Signal(str)
    status = Signal(str)

    def __init__(self, document: Document, theme: Theme | None = None, parent: Any = None) -> None:
        self._held: QImage | None = None
        super().__init__(parent=parent, background=None)
        self.document = document
        self.theme = Theme.current() if theme is None else theme
        self.view_range = START
        # By device pixel ratio, and the logical one at 0; they live as long as the range and the size.
        self._windows: dict[float, Window] = {}
        self._history = ViewHistory()
        self._last_step = -ONE_STEP
        self._rest = QPointF()
        self._set_up()
        self.canvas = Canvas(self, document, self.theme)
        self.scene().addItem(self.canvas)
        self.viewport().destroyed.connect(self.canvas.silence)
        document.clip_replaced.connect(self._on_replaced)
        document.membership_changed.connect(self._on_membership)
        self._empty = True
        self.router = MouseRouter(self, self)
        self.router.hint_changed.connect(self.hint_changed)
        self._on_replaced()

    def _set_up(self) -> None:
        self.setCacheMode(QGraphicsView.CacheModeFlag(0))
        self.setOptimizationFlag(QGraphicsView.OptimizationFlag.DontSavePainterState, True)
        self.setOptimizationFlag(QGraphicsView.OptimizationFlag.DontAdjustForAntialiasing, True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(160, 120)
        self.setAccessibleName("Curves")
        self.setAccessibleDescription("The graph of the shown channels over time")
        viewport = self.viewport()
        viewport.setMouseTracking(True)
        viewport.setAutoFillBackground(False)
        viewport.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)

    # --- Qt

    @guarded(False)
    def viewportEvent(self, event: QEvent) -> bool:
        """Input goes to the mouse router and never to pyqtgraph's scene."""
        if self._held is not None and event.type() == QEvent.Type.Paint:
            self._paint_held(self._held)
            return True
        return self._routed(event) or bool(super().viewportEvent(event))

    @guarded(False)
    def event(self, event: QEvent) -> bool:
        """Keys and losses of focus go to the mouse router first."""
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.DevicePixelRatioChange) and hasattr(self, "canvas"):
            self._windows.clear()
            self.canvas.forget()
        return self._routed(event) or bool(super().event(event))

    @guarded(False)
    def close(self) -> bool:
        """Close as any widget does; pyqtgraph would clear the scene first and leave a view without its canvas."""
        return QGraphicsView.close(self)

    def _routed(self, event: QEvent) -> bool:
        return hasattr(self, "router") and self.router.handle(event)

    @guarded()
    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the range, on more or fewer pixels."""
        super().resizeEvent(event)
        if hasattr(self, "canvas"):
            self._windows.clear()
            self.canvas.prepareGeometryChange()
            self.canvas.reframe()
            self.view_changed.emit()

    # --- pixels

    def window_at(self, ratio: float) -> Window:
        """The plot area in screen pixels, whole ones, at a device pixel ratio."""
        window = self._windows.get(ratio)
        if window is None:
            size = QSizeF(self.viewport().size()) * ratio
            left, top = round(VALUE_WIDTH * ratio), round(TIME_HEIGHT * ratio)
            width, height = max(round(size.width()) - left, 1), max(round(size.height()) - top, 1)
            window = self._windows[ratio] = Window(left, top, width, height, *self.view_range, ratio)
        return window

    @property
    def window_now(self) -> Window:
        """The plot area in logical pixels."""
        window = self._windows.get(0.0)
        if window is None:
            ratio = float(self.viewport().devicePixelRatioF())
            window = self._windows[0.0] = self.window_at(ratio).scaled(1 / ratio)
        return window

    @property
    def plot_rect(self) -> QRectF:
        """Where the curves are, without the rulers."""
        window = self.window_now
        return QRectF(window.left, window.top, window.width, window.height)

    @overload
    def x_from_time(self, time: float) -> float: ...
    @overload
    def x_from_time(self, time: Floats) -> Floats: ...
    def x_from_time(self, time: float | Floats) -> float | Floats:
        """Pixels from seconds."""
        return self.window_now.x_from_time(time)

    @overload
    def y_from_value(self, value: float) -> float: ...
    @overload
    def y_from_value(self, value: Floats) -> Floats: ...
    def y_from_value(self, value: float | Floats) -> float | Floats:
        """Pixels, downwards, from values."""
        return self.window_now.y_from_value(value)

    @overload
    def time_from_x(self, x: float) -> float: ...
    @overload
    def time_from_x(self, x: Floats) -> Floats: ...
    def time_from_x(self, x: float | Floats) -> float | Floats:
        """Seconds from pixels."""
        return self.window_now.time_from_x(x)

    @overload
    def value_from_y(self, y: float) -> float: ...
    @overload
    def value_from_y(self, y: Floats) -> Floats: ...
    def value_from_y(self, y: float | Floats) -> float | Floats:
        """Values from pixels."""
        return self.window_now.value_from_y(y)

    def handle_points(self, channel: Channel, key_id: int) -> tuple[Spot | None, Spot | None]:
        """The ends of a key's handles (in, out); None for one that is not drawn."""
        session = self.document.session
        if not session.selection.contains(channel, key_id) or not session.editable(channel):
            return None, None
        if session.selection.count > MOST and not shown_handles(self.canvas.stage(self.viewport().devicePixelRatioF())):
            return None, None
        try:
            handles = handles_of(with_neighbours(channel, key_id), channel, self.window_now)
        except KeyGoneError:
            return None, None
        return handles.into, handles.out

    def drawn_handles(self) -> list[DrawnHandle]:
        """The ends of all handles that are drawn."""
        ratio = float(self.viewport().devicePixelRatioF())

        def logical(spot: Spot | None) -> Spot | None:
            return None if spot is None else (spot[0] / ratio, spot[1] / ratio)

        return [
            DrawnHandle(trace.channel, handles.id, logical(handles.into), logical(handles.out))
            for trace, handles in shown_handles(self.canvas.stage(ratio))
        ]

    # --- the view: it moves only when asked

    def set_view(self, view: ViewRange, remember: bool = True) -> None:
        """Show this range, as far as it can be drawn; *remember* the present one for `view_back`."""
        view = view.limited()
        if view == self.view_range:
            return
        if remember:
            now = monotonic()
            if now - self._last_step > ONE_STEP:
                self._history.leave(self.view_range)
            self._last_step = now
        self.view_range = view
        self._windows.clear()
        self.canvas.reframe()
        self.view_changed.emit()

    def frame_all(self) -> None:
        """Show the shown channels from the first key to the last, lowest to highest."""
        self._last_step = -ONE_STEP
        self.set_view(all_fitted(self.document))

    def frame_clip(self) -> None:
        """Show all keys and the clip's range, as a clip is shown that has just been opened; nothing to go back to."""
        self.set_view(clip_fitted(self.document), remember=False)

    def frame_selection(self, channels: Sequence[Channel] = ()) -> None:
        """Show the selected keys; if there are none all of *channels*, of the active channel, or else everything."""
        self._last_step = -ONE_STEP
        document = self.document
        found = selection_fitted(document) or channels_fitted(document, channels) or active_fitted(document)
        self.set_view(found or all_fitted(document))

    @property
    def can_go_back(self) -> bool:
        """Whether `view_back` shows something else."""
        return self._history.leads_back(self.view_range)

    @property
    def can_go_forward(self) -> bool:
        """Whether `view_forward` shows something else."""
        return self._history.leads_forward(self.view_range)

    def view_back(self) -> None:
        """Show what was shown before."""
        view = self._history.back(self.view_range)
        if view is not None:
            self.set_view(view, remember=False)

    def view_forward(self) -> None:
        """Show what was shown before going back."""
        view = self._history.forward(self.view_range)
        if view is not None:
            self.set_view(view, remember=False)

    def pan_pixels(self, dx: float, dy: float) -> None:
        """Move the picture as a hand would; it moves by whole screen pixels and keeps the rest for the next time."""
        ratio = float(self.viewport().devicePixelRatioF())
        wanted = QPointF(dx, dy) * ratio + self._rest
        whole = QPointF(round(wanted.x()), round(wanted.y()))
        self._rest = wanted - whole
        window = self.window_at(ratio)
        self.set_view(self.view_range.panned(-whole.x() / window.px_per_second, whole.y() / window.px_per_value))

    def zoom(self, fx: float, fy: float, center: QPointF) -> None:
        """Bring time and value so many times as near, keeping what is at *center* where it is."""
        window = self.window_now
        self.set_view(self.view_range.zoomed(fx, fy, window.time_from_x(center.x()), window.value_from_y(center.y())))

    def _on_replaced(self) -> None:
        self._history = ViewHistory()
        self._empty = not self.document.clip.channels
        self.set_view(clip_fitted(self.document), remember=False)

    def _on_membership(self) -> None:
        if self._empty and self.document.clip.channels:
            self._on_replaced()

    # --- while the document is changed by another thread

    def hold(self) -> None:
        """Go on showing the picture of now, without a look at the document, until `release`."""
        self._held = last_picture(self.viewport())

    def release(self) -> None:
        """Show the document as it is again."""
        self._held = None
        self.canvas.repaint_all()
        self.router.look_again()

    def _paint_held(self, picture: QImage) -> None:
        painter = QPainter(self.viewport())
        try:
            painter.fillRect(self.viewport().rect(), self.theme.background)
            painter.drawImage(0, 0, picture)
        finally:
            painter.end()

    # --- what belongs to the pointer

    def set_hover(self, hit: Hit | None) -> None:
        """Mark what lies under the pointer."""
        overlay = self.canvas.overlay
        hit = None if hit is None or hit.kind == "empty" else hit
        before = overlay.hover
        if hit == before or (hit and before and hit[:3] == before[:3] and hit.kind == "curve"):
            return
        overlay.hover = hit
        for each in (before, hit):
            if each is not None and each.kind == "curve":
                self.canvas.repaint_all()
            elif each is not None and each.channel is not None:
                time = each.time  # the ring is where the key is now, since an undo may have moved it
                if each.id and each.id in each.channel:
                    time = each.channel.key(each.id).time
                self.canvas.repaint_times(min(time, each.time), max(time, each.time))

    def set_box(self, box: QRectF | None) -> None:
        """Show the selection box."""
        before, self.canvas.overlay.box = self.canvas.overlay.box, box
        self._repaint_boxes(before, box)

    def set_frame(self, frame: Frame | None) -> None:
        """Show the box that scales or retimes the selection."""
        before, self.canvas.overlay.frame = self.canvas.overlay.frame, frame
        for each in (before, frame):
            if each is not None:
                spots = [*each.handles, *([each.pivot] if each.pivot is not None else [])]
                box = each.box
                for spot in spots:
                    box = box.united(QRectF(spot, spot).adjusted(-8, -8, 8, 8))
                self._repaint_boxes(box)

    def set_insert_preview(self, channel: Channel | None, time: float | None) -> None:
        """Show where a key would be set."""
        before = self.canvas.overlay.preview
        preview = None if channel is None or time is None else (channel, time)
        self.canvas.overlay.preview = preview
        for each in (before, preview):
            if each is not None and before != preview:
                self.canvas.repaint_times(each[1], each[1], DOT + 4)

    def set_notice(self, text: str) -> None:
        """Say what is going on meanwhile, where there is no curve to be seen."""
        if text != self.canvas.overlay.notice:
            self.canvas.overlay.notice = text
            if not self.document.clip.channels:
                self.canvas.restyle()

    def say(self, text: str) -> None:
        """Tell the user *text* in the status line."""
        self.status.emit(text)

    def _repaint_boxes(self, *boxes: QRectF | None) -> None:
        for box in boxes:
            if box is not None:
                self.canvas.repaint(box.normalized().adjusted(-10, -10, 10, 10).intersected(self.plot_rect))
