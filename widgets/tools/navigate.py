"""Navigation: what no tool changes: the rulers, panning, zooming by drag, wheel or pinch, and the edge of the view."""

from typing import ClassVar

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QNativeGestureEvent, QWheelEvent

from widgets.graph import Graph
from widgets.hit_test import EMPTY, Hit, Place, hit_ruler, place
from widgets.tools.base import NO_AXIS, Axes, Button, Cursor, Drag, Modifier, Point, Tool
from widgets.tools.scrub import ChangeRange, Scrub

# One notch of a wheel is 120 units; trackpads send fractions of it, so that the exponent makes both smooth.
ZOOM_PER_UNIT = 1.2 ** (1 / 120)
MAX_UNITS = 1200.0
ZOOM_PER_PIXEL = 1.01
MAX_PIXELS = 1000.0

# The edge of the view begins so many pixels inside it, and pushes the harder the further out the pointer is.
EDGE_MARGIN = 12.0
EDGE_REACH = 48.0  # pixels beyond where it begins, from which on it pushes no harder
EDGE_SPEED = 0.5  # of the plot's width or height, in a second: the hand must be able to stop in time


class Pan:
    """The picture follows the hand."""

    cursor: ClassVar[Qt.CursorShape] = Cursor.ClosedHandCursor
    scrolls = NO_AXIS
    hint = "Pan the view"

    def __init__(self, graph: Graph, start: Point) -> None:
        self.graph = graph
        self.x, self.y = start.x, start.y

    def move(self, point: Point) -> None:
        """Shift the picture by what the pointer moved."""
        dx, dy = point.x - self.x, point.y - self.y
        self.x, self.y = point.x, point.y
        if dx or dy:
            self.graph.pan_pixels(dx, dy)

    def finish(self, point: Point) -> None:
        """The view stays where it is."""

    def cancel(self) -> None:
        """The view stays where it is: nothing of the clip was touched."""


class Zoom(Pan):
    """The axes come nearer by dragging right or up; what was pressed stays under its pixel."""

    cursor: ClassVar[Qt.CursorShape] = Cursor.SizeAllCursor
    hint = "Zoom: right or up comes nearer"

    def __init__(self, graph: Graph, start: Point, *, time: bool, value: bool) -> None:
        super().__init__(graph, start)
        self.center = QPointF(start.x, start.y)
        self.axes = time, value

    def move(self, point: Point) -> None:
        """Zoom about the pressed spot by what the pointer moved."""
        dx, dy = point.x - self.x, self.y - point.y
        self.x, self.y = point.x, point.y
        time, value = self.axes
        if time and value:
            dx = dy = dx + dy
        self.graph.zoom(_factor(dx) if time else 1.0, _factor(dy) if value else 1.0, self.center)


def _factor(pixels: float) -> float:
    return float(ZOOM_PER_PIXEL ** max(-MAX_PIXELS, min(MAX_PIXELS, pixels)))


class Rest(Pan):
    """A drag that does nothing, so that a hand that trembles on the right button still gets its menu."""

    cursor: ClassVar[Qt.CursorShape] = Cursor.ArrowCursor
    hint = ""

    def move(self, point: Point) -> None:
        """Nothing."""


class Navigation(Tool):
    """Takes every stroke that the chosen tool does not: the other buttons, and the rulers."""

    def takes(self, point: Point) -> bool:
        """Whether a press at *point* is ours rather than the tool's."""
        plain = point.button in (Button.NoButton, Button.LeftButton)
        return not plain or place(self.graph, point.x, point.y) is not Place.PLOT

    def press(self, point: Point) -> bool:
        """All but the right button act at once: it may have been meant for the menu."""
        super().press(point)
        return point.button != Button.RightButton

    def drag_from(self, start: Point) -> Drag:
        """Rulers zoom their axis, and the left button in the time ruler moves the playhead or the clip's range."""
        match start.button, place(self.graph, start.x, start.y):
            case Button.LeftButton, Place.TIME_RULER:
                hit = self.hit(start)
                if hit.kind in ("range_start", "range_end"):
                    return ChangeRange(self.graph, start, "start" if hit.kind == "range_start" else "end")
                return Scrub(self.graph)
            case _, Place.TIME_RULER:
                return Zoom(self.graph, start, time=True, value=False)
            case _, Place.VALUE_RULER:
                return Zoom(self.graph, start, time=False, value=True)
            case Button.RightButton, _:
                return Zoom(self.graph, start, time=True, value=True) if start.alt else Rest(self.graph, start)
            case Button.MiddleButton, _:
                return Pan(self.graph, start)
            case _:
                return Rest(self.graph, start)

    def hover(self, point: Point) -> None:
        """Remember what a press would meet."""
        self.hovered = self.hit(point)

    def hit(self, point: Point) -> Hit:
        """The playhead or an end of the range in the time ruler, else the ruler itself."""
        return hit_ruler(self.graph, point.x, point.y)

    def hints(self, hit: Hit, modifiers: Qt.KeyboardModifier) -> str:
        """What dragging a ruler does."""
        return HINTS.get(hit.kind, "")

    def cursor(self, hit: Hit, modifiers: Qt.KeyboardModifier) -> Qt.CursorShape:
        """Arrows along the axis that a drag moves."""
        return CURSORS.get(hit.kind, Cursor.ArrowCursor)

    def leave(self) -> None:
        """Forget what a press would meet."""
        self.hovered = EMPTY


HINTS = {
    "playhead": "Drag: move the playhead · Ctrl: no snap · middle or right drag: zoom time",
    "range_start": "Drag: move the start of the clip's range · Ctrl: no snap",
    "range_end": "Drag: move the end of the clip's range · Ctrl: no snap",
    "time_ruler": "Click or drag: move the playhead · Ctrl: no snap · middle or right drag: zoom time",
    "value_ruler": "Drag: zoom values · wheel: zoom values",
}

CURSORS = {
    "playhead": Cursor.SplitHCursor,
    "range_start": Cursor.SizeHorCursor,
    "range_end": Cursor.SizeHorCursor,
    "value_ruler": Cursor.SizeVerCursor,
}


def wheeled(graph: Graph, event: QWheelEvent) -> None:
    """Zoom at the cursor: both axes, with Ctrl time, with Shift value, over a ruler its own; a sideways wheel pans."""
    units = event.angleDelta()
    if units.isNull():
        units = event.pixelDelta()
    x, y = float(units.x()), float(units.y())
    spot, modifiers = event.position(), event.modifiers()
    # Some platforms turn the wheel by 90 degrees while Alt or Shift is held; a tilted wheel comes without them.
    turned = bool(modifiers & (Modifier.AltModifier | Modifier.ShiftModifier))
    if y == 0.0 and turned:
        x, y = 0.0, x
    if x and not turned and abs(x) > abs(y):
        graph.pan_pixels(max(-MAX_UNITS, min(MAX_UNITS, x)), 0.0)
        return
    factor = ZOOM_PER_UNIT ** max(-MAX_UNITS, min(MAX_UNITS, y))
    where = place(graph, spot.x(), spot.y())
    only_time = where is Place.TIME_RULER or bool(modifiers & Modifier.ControlModifier)
    only_value = where is Place.VALUE_RULER or bool(modifiers & Modifier.ShiftModifier)
    if only_time and only_value:
        only_time, only_value = where is Place.TIME_RULER, where is Place.VALUE_RULER
    graph.zoom(1.0 if only_value else factor, 1.0 if only_time else factor, spot)


def pinched(graph: Graph, event: QNativeGestureEvent) -> bool:
    """Two fingers on a trackpad: zoom both axes between them; True if that was the gesture."""
    if event.gestureType() != Qt.NativeGestureType.ZoomNativeGesture:
        return False
    factor = min(2.0, max(0.5, 1.0 + event.value()))
    graph.zoom(factor, factor, event.position())
    return True


def edge_push(plot: QRectF, start: Point, spot: QPointF, scrolls: Axes) -> tuple[float, float]:
    """Pixels in a second by which the view is to follow a drag held at its edge; a drag begun there does not push."""
    time, value = scrolls
    return (
        _push(spot.x(), start.x, plot.left(), plot.right()) if time else 0.0,
        _push(spot.y(), start.y, plot.top(), plot.bottom()) if value else 0.0,
    )


def _push(at: float, start: float, low: float, high: float) -> float:
    low_edge = max(low, min(low + EDGE_MARGIN, start))
    high_edge = min(high, max(high - EDGE_MARGIN, start))
    beyond = min(at - low_edge, 0.0) + max(at - high_edge, 0.0)
    return max(-1.0, min(1.0, beyond / EDGE_REACH)) * EDGE_SPEED * (high - low)
