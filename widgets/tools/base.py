"""Tool and Drag: what the mouse does now, and one gesture of it from press to end."""

from collections.abc import Callable
from time import perf_counter
from typing import ClassVar, Final, NamedTuple, Protocol

from PySide6.QtCore import Qt

from model.document import MANY_KEYS, Gesture
from model.gesture import Compute
from model.labels import counted
from model.selection import Selection
from widgets.graph import Graph
from widgets.hit_test import EMPTY, Hit

Button = Qt.MouseButton
Modifier = Qt.KeyboardModifier
Cursor = Qt.CursorShape
# As numbers: to combine Qt's flags, which are those of Python's enum, takes ten times as long.
SHIFT: Final[int] = Modifier.ShiftModifier.value
CTRL: Final[int] = Modifier.ControlModifier.value
ALT: Final[int] = Modifier.AltModifier.value

# How long a drag that is not ready yet may hold up the window.
SLICE: Final = 0.02

type Axes = tuple[bool, bool]  # time, value

NO_AXIS: Axes = (False, False)
TIME_AXIS: Axes = (True, False)
VALUE_AXIS: Axes = (False, True)
BOTH_AXES: Axes = (True, True)


class Point(NamedTuple):
    """The pointer at one event: viewport pixels, the same in time and value, and what is held down."""

    x: float
    y: float
    time: float
    value: float
    modifiers: Qt.KeyboardModifier = Modifier.NoModifier
    button: Qt.MouseButton = Button.NoButton

    @property
    def shift(self) -> bool:
        """Shift: add, or lock the first direction of a drag."""
        return bool(self.modifiers.value & SHIFT)

    @property
    def ctrl(self) -> bool:
        """Ctrl: insert, subtract, or the other way of snapping in a drag."""
        return bool(self.modifiers.value & CTRL)

    @property
    def alt(self) -> bool:
        """Alt: the column, or a tenth of the speed in a drag."""
        return bool(self.modifiers.value & ALT)


class Drag(Protocol):
    """One gesture of the mouse: made where it begins, moved, then finished or cancelled, and never used again."""

    cursor: ClassVar[Qt.CursorShape]

    @property
    def scrolls(self) -> Axes:
        """The axes along which the view follows at its edge."""

    @property
    def hint(self) -> str:
        """What has been done so far, as "dt +0.10 s  dv +0.25", then what the modifiers would change."""

    def move(self, point: Point) -> None:
        """The pointer is at *point*: preview from the gesture's start."""

    def finish(self, point: Point) -> None:
        """The button went up: keep what the last preview showed."""

    def cancel(self) -> None:
        """Esc, the right button or a lost pointer: as if nothing had been."""


class EditDrag:
    """A drag that changes the clip: one document gesture, one undo step.

    Subclasses call this __init__ last: an error in theirs must not leave a gesture open. With very many keys selected
    the first step would take longer than the hand may wait: what it begins with is got ready before.
    """

    cursor: ClassVar[Qt.CursorShape] = Cursor.ClosedHandCursor

    def __init__(self, graph: Graph, label: str, selection: Selection = Selection.NONE) -> None:
        self.graph = graph
        self.gesture: Gesture = graph.document.begin(label)
        self._preparing = self.gesture.prepared(selection) if selection.count >= MANY_KEYS else None
        self._count = selection.count
        self._at_once = False

    @property
    def waiting_hint(self) -> str:
        """What is said meanwhile."""
        return f"Getting {counted(self._count, 'key')} ready · Esc: cancel"

    @property
    def waiting(self) -> bool:
        """Whether it must be moved again soon, since it has not followed yet."""
        return self._preparing is not None

    def prepare(self) -> bool:
        """Go on for some steps; False if there is nothing left to get ready, and it can be moved."""
        end = perf_counter() + SLICE
        while self._preparing is not None:
            if next(self._preparing, self) is self:
                self._preparing = None
            elif perf_counter() > end:
                break
        return self.waiting

    def pass_by(self, point: Point) -> None:
        """The pointer is at *point*, and nothing can follow it yet."""

    def move(self, point: Point) -> None:
        """The pointer is at *point*: preview from the gesture's start."""
        raise NotImplementedError

    def preview(self, compute: Compute, label: str | Callable[[], str]) -> None:
        """Show what *compute* gives; or make it, if the button went up before anything could be shown."""
        if self._at_once:
            text = label() if callable(label) else label
            self.graph.document.do(text, compute, keys=self._count)
        else:
            self.gesture.preview(compute, label=label)

    @property
    def scrolls(self) -> Axes:
        """Both axes, unless the drag is about one."""
        return BOTH_AXES

    @property
    def landing(self) -> str:
        """For the hint: that keys lie where the dragged ones are now, and would go."""
        covered = self.gesture.keys_fewer
        return f" · lands on {counted(covered, 'key')}, which would go" if covered else ""

    def finish(self, point: Point) -> None:
        """Commit; a gesture that changed nothing leaves no undo step.

        What could not follow yet is made at length, as a command would be: with progress, and Esc takes it back.
        """
        try:
            if self.waiting:
                self._preparing, self._at_once = None, True
                self.gesture.cancel()
                self.move(point)
            else:
                self.gesture.commit()
        except BaseException:
            self.gesture.cancel()  # nobody else would: the stroke is over
            raise

    def cancel(self) -> None:
        """Take every preview back."""
        self.gesture.cancel()


class Tool:
    """What the left button does in the plot while this tool is chosen.

    mouse.py calls press, then click, or drag and release; hover between strokes; cancel at any time in one.
    """

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.current: Drag | None = None
        self.pressed: Point | None = None
        self.hovered: Hit = EMPTY

    # What a stroke consists of

    def press(self, point: Point) -> bool:
        """The button went down; True if the drag begins at once, without the usual 4 px."""
        self.pressed = point
        return False

    def drag(self, point: Point) -> None:
        """The pointer moved in a drag; the first call decides which gesture it is."""
        if self.current is None:
            assert self.pressed is not None
            self.current = self.drag_from(self.pressed)
        current = self.current
        if isinstance(current, EditDrag) and current.prepare():
            current.pass_by(point)
        else:
            current.move(point)

    def release(self, point: Point) -> None:
        """The drag ended where it was meant to."""
        current, self.current, self.pressed = self.current, None, None
        if current is not None:
            current.finish(point)

    def click(self, point: Point) -> None:
        """The button went up where it went down."""
        self.pressed = None

    def double_click(self, point: Point) -> bool:
        """The second press at one spot; False if it means no more than another press."""
        return False

    def hover(self, point: Point) -> None:
        """The pointer moved with no button down."""

    def leave(self) -> None:
        """The pointer left the view, or a stroke begins: show nothing of a hover."""

    def cancel(self) -> None:
        """Esc, the right button or a lost pointer: as if the button had never gone down."""
        current, self.current, self.pressed = self.current, None, None
        if current is not None:
            current.cancel()

    # What differs from tool to tool

    def drag_from(self, start: Point) -> Drag:
        """The gesture that a drag from *start* is."""
        raise NotImplementedError

    def hit(self, point: Point) -> Hit:
        """What a press at *point* would meet."""
        raise NotImplementedError

    def hints(self, hit: Hit, modifiers: Qt.KeyboardModifier) -> str:
        """What the mouse does here, for the status bar."""
        return ""

    def cursor(self, hit: Hit, modifiers: Qt.KeyboardModifier) -> Qt.CursorShape:
        """The pointer's shape here."""
        return Cursor.ArrowCursor

    def showing(self, shown: bool) -> None:
        """The tool was chosen, or another one was: show or take away what it draws."""

    def refresh(self) -> None:
        """The view, the selection or a channel has changed: draw again what the tool draws."""
