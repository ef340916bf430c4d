"""ScaleTool: a box around the selected keys whose edges and corners stretch them in time and value."""

from collections.abc import Iterable
from math import copysign, hypot
from typing import ClassVar, NamedTuple

from PySide6.QtCore import QPointF, QRectF, Qt

from model import edits
from model.clip import Clip
from model.document import Change
from model.labels import counted
from model.selection import Selection
from widgets.graph import Frame, Graph
from widgets.hit_test import RADIUS, Hit
from widgets.tools.base import Axes, Cursor, Drag, EditDrag, Point
from widgets.tools.select import SelectTool
from widgets.tools.steering import Steering

# The box stands this far outside the keys, so that its handles do not cover them; pixels.
PADDING = 12.0
# Keys squeezed further than this could not be told apart, and two keys never share a time.
MIN_FACTOR = 1e-3
# An axis on which the keys were taken this close to the pivot would leap with the first pixel, so it stays.
MIN_ARM = 12.0

SIDES = ((-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1))  # (time, value) of each handle


# Pixels from here on are all the same: what is infinitely far has no middle.
FARTHEST = 1e9


def near(pixels: float) -> float:
    """*pixels*, or as far as there may be."""
    return min(max(pixels, -FARTHEST), FARTHEST)


class Bounds(NamedTuple):
    """The extent of keys in time and value."""

    t0: float
    t1: float
    v0: float
    v1: float

    @property
    def center(self) -> tuple[float, float]:
        """(time, value) in the middle."""
        return self.t0 / 2 + self.t1 / 2, self.v0 / 2 + self.v1 / 2  # finite however far apart

    def at(self, side: tuple[int, int]) -> tuple[float, float]:
        """(time, value) of an edge or corner; of the middle on an axis that it does not move."""
        time, value = self.center
        return (
            (self.t0, time, self.t1)[side[0] + 1],
            (self.v0, value, self.v1)[side[1] + 1],
        )


class ScaleKeys(EditDrag):
    """One stretch of keys about *pivot*: what was taken at *grip* follows the pointer, on the chosen axes."""

    cursor: ClassVar[Qt.CursorShape] = Cursor.SizeAllCursor
    verb: ClassVar[str] = "Scale"

    def __init__(
        self,
        graph: Graph,
        start: Point,
        selection: Selection,
        pivot: tuple[float, float],
        grip: tuple[float, float],
        axes: tuple[bool, bool],
    ) -> None:
        self.steering = Steering(graph, start)
        self.selection, self.pivot, self.grip, self.axes = selection, pivot, grip, axes
        self.factors = 1.0, 1.0
        super().__init__(graph, f"{self.verb} {counted(selection.count, 'key')}", selection)

    def pass_by(self, point: Point) -> None:
        """Only steer."""
        self.steering.steer(point, locks=all(self.axes))

    def move(self, point: Point) -> None:
        """Preview the keys stretched so far that the grip is under the pointer."""
        session, clip = self.graph.document.session, self.graph.document.clip
        d_time, d_value = self.steering.steer(point, locks=all(self.axes))
        time, value = self.grip[0] + d_time, self.grip[1] + d_value
        if d_time and session.snap is not point.ctrl:
            time = session.snap_time(clip, time)
        f_time = self.time_factor((time - self.pivot[0]) / (self.grip[0] - self.pivot[0])) if self.axes[0] else 1.0
        f_value = (value - self.pivot[1]) / (self.grip[1] - self.pivot[1]) if self.axes[1] else 1.0
        selection, pivot = self.selection, self.pivot

        def scaled(clip: Clip) -> Iterable[Change]:
            return edits.scale(clip, selection, pivot[0], pivot[1], f_time, f_value)

        self.preview(scaled, f"{self.verb} {counted(selection.count, 'key')} by {self._amount(f_time, f_value)}")
        self.factors = f_time, f_value

    def time_factor(self, factor: float) -> float:
        """*factor* as it may be; a negative one turns the order round."""
        return copysign(max(abs(factor), MIN_FACTOR), factor)

    def _amount(self, f_time: float, f_value: float) -> str:
        parts = ((self.axes[0], "time", f_time), (self.axes[1], "value", f_value))
        return "  ".join(f"{name} ×{factor:.3g}" for used, name, factor in parts if used)

    @property
    def scrolls(self) -> Axes:
        """Only along the axes that are stretched."""
        return self.axes

    @property
    def hint(self) -> str:
        """The factors so far."""
        one_axis = " · Shift: one axis" if all(self.axes) else ""
        return f"{self._amount(*self.factors)}{self.landing}{one_axis} · Ctrl: no snap · Alt: fine · Esc: cancel"


class ScaleTool(SelectTool):
    """Selects like the select tool; its box, and the keys and the ground inside it, stretch the selected keys."""

    drag_class: ClassVar[type[ScaleKeys]] = ScaleKeys
    wanting: ClassVar[str] = "select two keys or more"

    def __init__(self, graph: Graph) -> None:
        super().__init__(graph)
        self._shown = False
        self._inside = False
        self._under: Point | None = None  # the pointer, while a drag from it would stretch the keys
        self._stamp: tuple[object, ...] = ()
        self._extent: Bounds | None = None

    # What is scaled

    def keys(self) -> Selection:
        """The selected keys that may be edited."""
        return self.session.selection.with_only(
            channel for channel in self.session.selection.channels if self.session.editable(channel)
        )

    def sides(self, bounds: Bounds) -> list[tuple[int, int]]:
        """The handles of the box; none on an axis along which all keys are level."""
        free = (bounds.t1 > bounds.t0, bounds.v1 > bounds.v0)
        return [side for side in SIDES if all(axis_free or not s for axis_free, s in zip(free, side, strict=True))]

    def box(self, bounds: Bounds) -> QRectF:
        """The box around the keys in pixels."""
        graph = self.graph
        x0, x1 = near(graph.x_from_time(bounds.t0)), near(graph.x_from_time(bounds.t1))
        y0, y1 = near(graph.y_from_value(bounds.v1)), near(graph.y_from_value(bounds.v0))
        return QRectF(x0, y0, x1 - x0, y1 - y0).adjusted(-PADDING, -PADDING, PADDING, PADDING)

    def frame(self) -> tuple[Bounds, QRectF] | None:
        """The extent of the keys and the box around it; None unless two keys or more are to be scaled."""
        shown = self.session.shown_channels(self.graph.document.clip)
        stamp = (self.session.selection, [(channel, channel.revision, channel.locked) for channel in shown])
        if stamp != self._stamp:  # a hover asks for it as well, and most of them change nothing
            keys = self.keys()
            self._stamp, self._extent = stamp, bounds_of(keys) if keys.count > 1 else None
        bounds = self._extent
        return (bounds, self.box(bounds)) if bounds is not None and self.sides(bounds) else None

    # Strokes

    def press(self, point: Point) -> bool:
        """A press on the box keeps the selection; inside it the select tool's clicks go on working."""
        self._inside = self._covers(point)
        return super().press(point)

    def _covers(self, point: Point) -> bool:
        """Whether *point* is on ground that stretches the keys."""
        frame = self.frame()
        return frame is not None and frame[1].contains(point.x, point.y) and not point.ctrl

    def drag_from(self, start: Point) -> Drag:
        """The box, a key and the ground inside the box stretch the keys; anything else is as in the select tool."""
        found, frame = self.grabbed, self.frame()
        if frame is None:
            return super().drag_from(start)
        bounds = frame[0]
        if found.kind == "frame":
            side = SIDES[found.id]
            grip, pivot = bounds.at(side), bounds.at((-side[0], -side[1]))
            return self.drag_class(self.graph, start, self.keys(), pivot, grip, (side[0] != 0, side[1] != 0))
        if found.kind == "key" and found.channel is not None and not found.channel.locked:
            return self.drag_inside(start, bounds, (found.time, found.value))
        if self._inside and not found.is_handle:
            return self.drag_inside(start, bounds, (start.time, start.value))
        return super().drag_from(start)

    def drag_inside(self, start: Point, bounds: Bounds, grip: tuple[float, float]) -> Drag:
        """Stretch about the middle of the box."""
        time, value = bounds.center
        graph = self.graph
        far = (
            abs(graph.x_from_time(grip[0]) - graph.x_from_time(time)) >= MIN_ARM and bounds.t1 > bounds.t0,
            abs(graph.y_from_value(grip[1]) - graph.y_from_value(value)) >= MIN_ARM and bounds.v1 > bounds.v0,
        )
        return self.drag_class(graph, start, self.keys(), (time, value), grip, far)

    def hit(self, point: Point) -> Hit:
        """The box's handles lie above everything else."""
        frame = self.frame()
        if frame is not None:
            for side, spot in self._handles(*frame):
                away = hypot(spot.x() - point.x, spot.y() - point.y)
                if away <= RADIUS:
                    return Hit("frame", None, SIDES.index(side), point.time, point.value, away)
        return super().hit(point)

    def hints(self, hit: Hit, modifiers: Qt.KeyboardModifier) -> str:
        """The tool's name, and what a drag from here does with it."""
        name, frame = self.drag_class.verb, self.frame()
        locked = hit.channel is not None and hit.channel.locked
        if frame is None:
            return f"{name} ({self.wanting}) · {super().hints(hit, modifiers)}"
        if locked or hit.is_handle or (hit.kind not in ("frame", "key") and self._under is None):
            return f"{name} · {super().hints(hit, modifiers)}"
        return f"{name} · {self.stretch_hint(hit, frame[0])} · Ctrl: no snap · Alt: fine"

    def stretch_hint(self, hit: Hit, bounds: Bounds) -> str:
        """What a drag of the box, of a key or of the ground inside does."""
        keys = counted(self.keys().count, "key")
        if hit.kind == "frame":
            corner = all(SIDES[hit.id])
            return f"Drag: scale {keys} about the {'corner' if corner else 'edge'} across · Shift: one axis"
        if hit.kind == "key" and hit.channel is not None and not self.session.selection.contains(hit.channel, hit.id):
            return "Drag: move 1 key · Shift+click: add it to what is scaled"
        return f"Drag: scale {keys} about the middle · Shift: one axis"

    def hover(self, point: Point) -> None:
        """Remember whether a drag of the ground would stretch the keys."""
        self._under = point if self._covers(point) else None
        super().hover(point)

    def leave(self) -> None:
        """Nothing is under the pointer."""
        self._under = None
        super().leave()

    def cursor(self, hit: Hit, modifiers: Qt.KeyboardModifier) -> Qt.CursorShape:
        """Arrows in the direction of the handle."""
        return CURSORS[SIDES[hit.id]] if hit.kind == "frame" else super().cursor(hit, modifiers)

    # The box on the screen

    def showing(self, shown: bool) -> None:
        """Draw the box while the tool is chosen."""
        self._shown = shown
        self.refresh()

    def drag(self, point: Point) -> None:
        """Keep the box around the keys while they are stretched."""
        super().drag(point)
        self.refresh()

    def refresh(self) -> None:
        """Draw the box where the keys are now."""
        frame = self.frame() if self._shown else None
        if frame is None:
            self.graph.set_frame(None)
            return
        pivot = self.pivot_of(frame[0])
        spot = None
        if pivot:
            spot = QPointF(near(self.graph.x_from_time(pivot[0])), near(self.graph.y_from_value(pivot[1])))
        self.graph.set_frame(Frame(frame[1], tuple(spot for _, spot in self._handles(*frame)), spot))

    def pivot_of(self, bounds: Bounds) -> tuple[float, float] | None:
        """What stays in the present drag, else what would stay if the inside were dragged."""
        return self.current.pivot if isinstance(self.current, ScaleKeys) else bounds.center

    def _handles(self, bounds: Bounds, box: QRectF) -> list[tuple[tuple[int, int], QPointF]]:
        center = box.center()
        return [
            (side, QPointF(center.x() + side[0] * box.width() / 2, center.y() - side[1] * box.height() / 2))
            for side in self.sides(bounds)
        ]


CURSORS = {
    (-1, 0): Cursor.SizeHorCursor,
    (1, 0): Cursor.SizeHorCursor,
    (0, -1): Cursor.SizeVerCursor,
    (0, 1): Cursor.SizeVerCursor,
    (-1, -1): Cursor.SizeBDiagCursor,
    (1, 1): Cursor.SizeBDiagCursor,
    (1, -1): Cursor.SizeFDiagCursor,
    (-1, 1): Cursor.SizeFDiagCursor,
}


def bounds_of(selection: Selection) -> Bounds | None:
    """The extent of the selected keys; None if there are none."""
    extents = [channel.extent_of(selection.ids(channel)) for channel in selection.channels]
    found = [extent for extent in extents if extent is not None]
    if not found:
        return None
    t0, t1, v0, v1 = zip(*found, strict=True)
    return Bounds(min(t0), max(t1), min(v0), max(v1))
