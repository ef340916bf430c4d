"""Canvas: the one graphics item that paints all curves, and the listener that knows which pixels a change touches."""

from collections.abc import Callable
from math import ceil, floor, inf, isfinite
from typing import TYPE_CHECKING, Any, Final

from PySide6.QtCore import QRectF, Qt, QTimer
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QGraphicsItem, QStyleOptionGraphicsItem, QWidget
from shiboken6 import isValid

from model.channel import Channel
from model.document import Document
from model.event import Event
from model.sampling import Window
from model.selection import Selection
from widgets import rulers
from widgets.backdrop import SLICE, Backdrop
from widgets.chosen import MOST
from widgets.guard import guarded
from widgets.layers import LAYERS, Plane
from widgets.layers.drawings import Drawing, changed_drawing, drawing_of, rows_changed
from widgets.layers.handles import KNOB, LENGTH, shown_handles
from widgets.layers.keys import SELECTED
from widgets.layers.labels import hint_of, labels_of, may_be_named
from widgets.numbers import is_angle
from widgets.stage import LABEL_SIZE, Manner, Overlay, Stage, manner_in, sized, unit_of
from widgets.theme import Theme
from widgets.ticks import Ticks, ticks_of
from widgets.traces import Crowd, Trace, live_channels, traces_of
from widgets.words import words_in

if TYPE_CHECKING:
    from widgets.curve_view import CurveView
    from widgets.layers.handles import Box

# How far, in logical pixels, a key's mark and handles reach beside the curve.
REACH: Final = LENGTH + 2 * KNOB + 4
# How far the marks themselves reach.
MARK: Final = 2 * SELECTED + 4
# While the view moves, the picture goes on being refined only so often, in ms.
PAUSE: Final = 20
# So often between two paints is looked for something else to be seen, when what was seen is gone.
MOST_SEARCHES: Final = 8


class Canvas(QGraphicsItem):
    """Paints two planes: the backdrop at rest, and over it what is under the hand; a change repaints only its strip."""

    def __init__(self, view: "CurveView", document: Document, theme: Theme) -> None:
        super().__init__()
        self.setFlag(QGraphicsItem.GraphicsItemFlag.ItemUsesExtendedStyleOption)
        self.setAcceptedMouseButtons(Qt.MouseButton.NoButton)
        self.setZValue(-100)
        self.overlay = Overlay()
        self.backdrop = Backdrop()
        self._view = view
        self._document = document
        self._theme = theme
        self._touched: set[Channel] = set()
        # All traces, and the same as those at rest and those under the hand.
        self._every: tuple[Trace, ...] | None = None
        self._traces: tuple[tuple[Trace, ...], tuple[Trace, ...]] | None = None
        self._crowd = Crowd(())
        self._stage: Stage | None = None
        self._ticks: tuple[Window, bool, tuple[Ticks, Ticks]] | None = None
        self._manners: tuple[Window, dict[Channel, tuple[int, Manner]]] | None = None
        self._selection: Selection | None = None
        self._playhead = document.session.playhead
        self._moving = False
        # Since the last paint: from where to where the whole height is to be painted, and how often was searched.
        self._asked = (0, 0)
        self._searches = 0
        self._timer = QTimer(view)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self._refine)
        self._listen()

    def _listen(self) -> None:
        document, session = self._document, self._document.session
        self._heard: tuple[tuple[Event[*tuple[Any, ...]], Callable[..., None]], ...] = (
            (document.changed, self._on_changed),
            (document.setting_changed, self.restyle),
            (document.gesture_changed, self._on_gesture),
            (document.membership_changed, self.restyle),
            (document.clip_replaced, self._on_replaced),
            (session.selection_changed, self._on_selection),
            (session.active_changed, self.restyle),
            (session.visibility_changed, self.restyle),
            (session.playhead_changed, self._on_playhead),
        )
        for event, slot in self._heard:
            event.connect(slot)
        self._theme.theme_changed.connect(self.restyle)

    def silence(self) -> None:
        """Stop listening: the view is gone, and the document and the theme may live on."""
        for event, slot in self._heard:
            event.disconnect(slot)
        if isValid(self._theme):  # at the end of the program it may be gone first
            self._theme.theme_changed.disconnect(self.restyle)

    # --- Qt

    @guarded(QRectF())
    def boundingRect(self) -> QRectF:
        """The whole viewport, in logical pixels."""
        return QRectF(self._view.viewport().rect())

    @guarded()
    def paint(self, painter: QPainter, option: QStyleOptionGraphicsItem, widget: QWidget | None = None) -> None:
        """Paint the exposed part, in the pixels of the screen."""
        device = painter.device()
        ratio = device.devicePixelRatioF() if device is not None else 1.0
        self._asked, self._searches = (0, 0), 0
        stage = self.stage(ratio)
        exposed = option.exposedRect
        painter.save()
        try:
            painter.scale(1 / ratio, 1 / ratio)
            self._paint(painter, stage, QRectF(exposed.topLeft() * ratio, exposed.bottomRight() * ratio))
        finally:
            painter.restore()
        if self.backdrop.busy and self._moving and self.backdrop.in_place:
            self._timer.start(PAUSE)  # again and again: there is nothing to see until the view rests
        elif self.backdrop.busy and not self._timer.isActive():
            self._timer.start(PAUSE if self._moving else 0)

    def _paint(self, painter: QPainter, stage: Stage, exposed: QRectF) -> None:
        window, plot = stage.window, stage.plot()
        if exposed.intersects(plot):
            painter.save()
            try:
                painter.setClipRect(plot, Qt.ClipOperation.IntersectClip)
                self._paint_plot(painter, stage, exposed)
            finally:
                painter.restore()
        if exposed.left() < window.left:
            rulers.draw_value_ruler(painter, stage)
        if exposed.top() < window.top:
            rulers.draw_time_ruler(painter, stage)
            rulers.draw_playhead_head(painter, stage)

    def _paint_plot(self, painter: QPainter, stage: Stage, exposed: QRectF) -> None:
        window = stage.window
        self.backdrop.prepare(stage)
        self.backdrop.paint(painter, stage)
        drawn = self.backdrop.contents
        live = (*[trace for trace in stage.resting if trace.channel not in drawn], *stage.live)
        x0 = max(floor(exposed.left()) - 1.0, window.left)
        x1 = min(ceil(exposed.right()) + 1.0, window.right)
        for layer in LAYERS:
            if layer.plane is Plane.LIVE:
                layer.draw(painter, stage, live, x0, x1)

    # --- the stage

    def stage(self, ratio: float) -> Stage:
        """What there is to paint now on a screen with this device pixel ratio."""
        window = self._view.window_at(ratio)
        stage = self._stage
        if stage is not None and stage.window == window and self._traces is not None:
            return stage
        if self._traces is None:
            if self._every is None:
                self._every = traces_of(self._document, self._theme)
                self._crowd = Crowd(trace.channel for trace in self._every)
            every = self._every
            live = live_channels(self._document, self._touched)
            self._traces = (
                tuple(trace for trace in every if trace.channel not in live),
                tuple(trace for trace in every if trace.channel in live),
            )
        font = self._view.font()
        degrees = is_angle(unit_of((*self._traces[0], *self._traces[1])))
        if self._ticks is None or self._ticks[:2] != (window, degrees):
            width = words_in(sized(font, LABEL_SIZE, window.unit)).width
            self._ticks = (window, degrees, ticks_of(window, width, degrees=degrees))
        if self._manners is None or self._manners[0] != window:
            self._manners = (window, {})
        stage = Stage(self._document, self._theme, window, *self._traces, self.overlay, *self._ticks[2], base_font=font)
        stage.manners = self._manners[1]
        stage.labels, stage.hint = labels_of(stage), hint_of(stage)
        self._stage = stage
        self._selection = self._document.session.selection
        return stage

    def restyle(self, *_: object) -> None:
        """Which channels are drawn, or how, has changed."""
        self._every = None
        self._regroup()

    def _regroup(self) -> None:
        """Who is under the hand has changed, or what is selected."""
        self._traces = self._stage = None
        self.repaint_all()

    def reframe(self) -> None:
        """The window onto time and value has changed."""
        self._stage = None
        if self._timer.isActive() and not self._timer.interval():
            self._timer.start(PAUSE)
        self._moving = True
        self.repaint_all()

    def forget(self) -> None:
        """Keep no pixel of what has been drawn."""
        self.backdrop.drop()
        self._ticks = None
        self.restyle()

    def settle(self) -> None:
        """Finish the picture that is being refined, now."""
        while self._stage is not None and self.backdrop.busy:
            self._refine(inf)
            if self._stage is not None:
                self.backdrop.prepare(self._stage)

    def _refine(self, seconds: float = SLICE) -> None:
        if self._document.working:
            return
        self._moving = False
        if self._stage is None or not self.backdrop.busy:
            return
        if self.backdrop.refine(self.stage(self._stage.window.unit), seconds):
            self.repaint_all()
        elif self.backdrop.busy:
            self._timer.start(0)

    # --- which pixels

    def repaint_all(self) -> None:
        """Repaint everything in the next turn of the event loop."""
        self._view.viewport().update()

    def repaint(self, box: QRectF) -> None:
        """Repaint a part, in logical pixels."""
        if not box.isEmpty():
            self._view.viewport().update(box.toAlignedRect().adjusted(-1, -1, 1, 1))

    def repaint_times(self, t0: float, t1: float, margin: float = REACH) -> None:
        """Repaint the plot between two times and so much beside them."""
        strip = self._strip(t0, t1, margin)
        if strip is not None:
            self._repaint_strip(*strip)

    def _strip(self, t0: float, t1: float, margin: float) -> tuple[int, int] | None:
        """From where to where the plot is between two times and so much beside them; None if it is not in view."""
        plot = self._view.plot_rect
        x0 = min(max(self._view.x_from_time(t0) - margin, plot.left()), plot.right())
        x1 = min(max(self._view.x_from_time(t1) + margin, plot.left()), plot.right())
        return (floor(x0), ceil(x1)) if x1 > x0 else None

    def _repaint_strip(self, left: int, right: int, rows: tuple[float, float] | None = None) -> None:
        """Repaint the plot from *left* to *right*, all of its height or the *rows* of screen pixels."""
        if self._asked[0] <= left and right <= self._asked[1]:
            return
        plot = self._view.plot_rect
        top, bottom = floor(plot.top()), floor(plot.top()) + ceil(plot.height()) + 1
        if rows is not None:
            unit = self._view.viewport().devicePixelRatioF()
            top, bottom = max(top, floor(rows[0] / unit) - 1), min(bottom, ceil(rows[1] / unit) + 1)
        elif right - left > self._asked[1] - self._asked[0]:
            self._asked = (left, right)
        if top < bottom:
            self._view.viewport().update(left, top, right - left, bottom - top)

    def _on_changed(self, channel: Channel, t0: float, t1: float) -> None:
        if self._document.gesture is not None and channel not in self._touched:
            self._touched.add(channel)
            if self._traces is not None and any(trace.channel is channel for trace in self._traces[0]):
                # Who is live has changed, but no pixel: it is drawn over the backdrop just as it was in it.
                self._traces = self._stage = None
        if self._crowd.changed(channel):
            self.restyle()
        if self._looks_different(channel):
            t0, t1 = -inf, inf
        self.backdrop.mark(channel, t0, t1)
        if self._document.session.shown(channel):
            self._repaint_change(channel, t0, t1)
            self._relabel(channel, t0, t1)

    def _looks_different(self, channel: Channel) -> bool:
        """Whether so many keys have come or gone that the whole channel is drawn in another manner."""
        window, manners = self._manners or (None, {})
        before = manners.get(channel)
        if window is None or before is None:
            return False
        wholly = None if self._stage is None else self._stage.wholly.get(channel)
        many = len(self._document.session.selection.ids(channel))
        manner = manner_in(window, channel)
        manners[channel] = channel.revision, manner  # it is asked for as soon as the change is drawn
        return before[1] != manner or wholly not in (None, many == len(channel))

    def _repaint_change(self, channel: Channel, t0: float, t1: float) -> None:
        """Repaint what has changed of a curve and, if they are few, its handles as painted last and as they are now."""
        stage, hover = self._stage, self.overlay.hover
        told = None if stage is None else stage.ready.pop(channel, None)  # as it was when the change before was told
        rings = hover is not None and hover.channel is channel and hover.kind != "key"
        if stage is None or rings or self._document.session.selection.count > MOST:
            self.repaint_times(t0, t1)
            return
        boxes = [*stage.arms.get(channel, ()), *(handles.box for _, handles in shown_handles(stage, channel))]
        if len(boxes) == 2:  # of one key: they mostly overlap
            (left, top, right, bottom), other = boxes
            boxes = [(min(left, other[0]), min(top, other[1]), max(right, other[2]), max(bottom, other[3]))]
        strip = self._strip(t0, t1, MARK)
        if strip is not None:
            inside = isfinite(t0) and isfinite(t1)  # an extrapolation may be anywhere
            rows = self._draw_change(stage, channel, (t0, t1), told, strip, boxes) if inside else None
            self._repaint_strip(*strip, rows)
        for box in boxes:
            self._repaint_near(box, stage.window)

    def _draw_change(
        self,
        stage: Stage,
        channel: Channel,
        times: tuple[float, float],
        told: Drawing | None,
        strip: tuple[int, int],
        boxes: list["Box"],
    ) -> tuple[float, float] | None:
        """Have at hand what is to be painted of a curve under the hand that has changed between two *times*.

        *told* is what was at hand when the change before was told. Gives the rows of screen pixels in which it was
        painted last or is to be painted now in the strip; None if they are not known, as before its first step.
        """
        trace = stage.trace_of(channel)
        if trace is None or channel not in self._touched or len(channel) < 2:
            return None
        unit, reach = stage.window.unit, MARK * stage.window.unit
        x0, x1 = strip[0] * unit, strip[1] * unit
        # As far as will be painted, and a little farther.
        low = min([x0, *(box[0] - reach for box in boxes)]) - 4 * unit
        high = max([x1, *(box[2] + reach for box in boxes)]) + 4 * unit
        stage.ready[channel] = changed_drawing(stage, trace, told, times) or drawing_of(stage, trace, low, high)
        rows = rows_changed(stage, channel, x0, x1)
        return None if rows is None else (rows[0] - reach, rows[1] + reach)

    def _repaint_near(self, box: "Box", window: Window) -> None:
        """Repaint what lies in a box of screen pixels, and marks around it."""
        unit = window.unit
        margin = MARK * unit
        left, right = max(box[0] - margin, window.left), min(box[2] + margin, window.right)
        top, bottom = max(box[1] - margin, window.top), min(box[3] + margin, window.bottom)
        if left < right and top < bottom:
            x, y = floor(left / unit) - 1, floor(top / unit) - 1
            self._view.viewport().update(x, y, ceil(right / unit) + 1 - x, ceil(bottom / unit) + 1 - y)

    def _relabel(self, channel: Channel, t0: float, t1: float) -> None:
        stage = self._stage
        if stage is None:
            return
        if t1 >= stage.window.t1 and may_be_named(stage, channel):
            before, stage.labels = stage.labels, labels_of(stage)
            if before != stage.labels:
                for label in (*before, *stage.labels):
                    left, top, width, height = (side / stage.window.unit for side in label.box)
                    self.repaint(QRectF(left, top, width, height))
        if stage.seen is not None and (stage.seen[0] is not channel or stage.seen[1] < t0 or stage.seen[1] > t1):
            return  # what was seen has not changed
        self._searches += 1
        if self._searches > MOST_SEARCHES:  # each may take long: one more before the next paint is enough
            self._stage = None
            self.repaint_all()
            return
        hint = hint_of(stage, (t0, t1))
        if hint != stage.hint:
            stage.hint = hint
            self.repaint_all()

    def _on_gesture(self) -> None:
        if self._document.gesture is None and self._touched:
            self._touched.clear()
            self._regroup()

    def _on_selection(self) -> None:
        if self._document.session.selection != self._selection:
            self._regroup()

    def _on_replaced(self) -> None:
        self._touched.clear()
        self.overlay = Overlay()
        self.forget()

    def _on_playhead(self) -> None:
        before, self._playhead = self._playhead, self._document.session.playhead
        view = self._view
        for time in (before, self._playhead):
            self.repaint_times(time, time, 2.0)
            self.repaint(rulers.head_reach(view.window_now, time))
