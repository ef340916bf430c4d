"""Strokes: the state machine between the buttons of a mouse and a tool; a press becomes a click or a drag."""

from collections.abc import Callable
from enum import Enum, auto
from math import hypot

from PySide6.QtCore import Qt

from widgets.tools.base import Button, Point, Tool

DRAG_DISTANCE = 4.0


class State(Enum):
    """Where a stroke is: a button goes down, then it is a click or, after 4 px, a drag."""

    IDLE = auto()
    PRESSED = auto()
    DRAGGING = auto()
    SPENT = auto()  # cancelled; nothing happens until all buttons are up


class Strokes:
    """The state machine of one mouse; *taker* says which tool a press is meant for, *cancelled* hears of its end."""

    def __init__(self, taker: Callable[[Point], Tool], cancelled: Callable[[], None] = lambda: None) -> None:
        self.state = State.IDLE
        self.tool: Tool | None = None
        self._taker = taker
        self._cancelled = cancelled
        self.start = Point(0.0, 0.0, 0.0, 0.0)
        self._last = self.start

    @property
    def busy(self) -> bool:
        """Whether a button is down for something."""
        return self.state in (State.PRESSED, State.DRAGGING)

    def press(self, point: Point, *, double: bool = False, alone: bool = True) -> None:
        """A button went down; *alone* if it is the only one that is down."""
        if alone and self.state is not State.IDLE:
            self.cancel()  # the release was lost, or belonged to what was cancelled
            self.state = State.IDLE
        if self.state is not State.IDLE:
            if point.button == Button.RightButton:
                self.cancel()
            return
        tool = self.tool = self._taker(point)
        self.start = self._last = point
        self.state = State.PRESSED
        if not (double and tool.double_click(point)) and tool.press(point):
            self.state = State.DRAGGING
            tool.drag(point)

    def move(self, point: Point, held: Qt.MouseButton) -> None:
        """The pointer moved, or a modifier changed; *held* are the buttons down now."""
        if self.state is State.SPENT and held == Button.NoButton:
            self.state = State.IDLE
        if self.busy and not held.value & self.start.button.value:
            self.cancel()  # the button went up where nobody told us
            self.state = State.IDLE
        if self.state is State.IDLE:
            self._hover(point)
            return
        far = hypot(point.x - self.start.x, point.y - self.start.y) >= DRAG_DISTANCE
        if self.state is State.PRESSED and far:
            self.state = State.DRAGGING
        if self.state is State.DRAGGING and self.tool is not None:
            self._last = point
            self.tool.drag(point)

    def release(self, point: Point, held: Qt.MouseButton) -> None:
        """A button went up; *held* are those still down."""
        if self.busy and point.button == self.start.button:
            if (point.x, point.y) != (self._last.x, self._last.y):
                self.move(point, self.start.button)
            ended, self.state = self.state, State.SPENT
            if ended is State.DRAGGING and self.tool is not None:
                self.tool.release(point)
            elif ended is State.PRESSED and self.tool is not None:
                self.tool.click(point)
        if held == Button.NoButton:
            self.state = State.IDLE

    def cancel(self) -> None:
        """Take back what the stroke did; nothing more happens until the buttons are up."""
        if self.busy and self.tool is not None:
            self.state = State.SPENT
            self.tool.cancel()
            self._cancelled()

    def _hover(self, point: Point) -> None:
        tool = self._taker(point)
        if self.tool is not None and tool is not self.tool:
            self.tool.leave()
        self.tool = tool
        tool.hover(point)
