"""MouseRouter: raw Qt events drive the chosen tool; hints, the pointer's shape and scrolling at the edge."""

from collections.abc import Callable
from typing import Any, ClassVar

from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, Qt, QTimer, Signal
from PySide6.QtGui import (
    QContextMenuEvent,
    QGuiApplication,
    QKeyEvent,
    QKeySequence,
    QMouseEvent,
    QNativeGestureEvent,
    QSinglePointEvent,
    QWheelEvent,
)
from shiboken6 import isValid

from model.event import Event
from widgets.graph import Graph
from widgets.guard import guarded
from widgets.strokes import State, Strokes
from widgets.tools import TOOLS
from widgets.tools.base import ALT, Button, EditDrag, Modifier, Point, Tool
from widgets.tools.navigate import Navigation, Rest, edge_push, pinched, wheeled

EDGE_INTERVAL = 16
CALM_INTERVAL = 100

# By number: the keys of many keyboards have numbers that Qt has no name for.
MODIFIER_OF_KEY = {
    Qt.Key.Key_Shift.value: Modifier.ShiftModifier,
    Qt.Key.Key_Control.value: Modifier.ControlModifier,
    Qt.Key.Key_Alt.value: Modifier.AltModifier,
    Qt.Key.Key_Meta.value: Modifier.MetaModifier,
}


class MouseRouter(QObject):
    """Takes the view's raw events, drives the chosen tool with them, and scrolls the view at its edge.

    The view hands every event of its own and of its viewport to handle().
    """

    hint_changed = Signal(str)
    context_menu_requested = Signal(QPoint, object)  # global position, Hit

    def __init__(self, graph: Graph, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.graph = graph
        self.navigation = Navigation(graph)
        self.strokes = Strokes(self._taker, self._pan_back)
        self._tools: dict[str, Tool] = {}
        self._hint = ""
        self._pointer: tuple[QPointF, Qt.MouseButton] | None = None  # where it is and what is held, while over the view
        self._modifiers = Modifier.NoModifier
        self._edge = QTimer(self, interval=EDGE_INTERVAL)
        self._pushed = QPointF()  # how far the edge has moved the picture in this stroke, in logical pixels
        self._edge.timeout.connect(self._scroll)
        self._later = QTimer(self, singleShot=True, interval=0)
        self._later.timeout.connect(self._refresh)
        self._soon = QTimer(self, singleShot=True, interval=0)
        self._soon.timeout.connect(self._go_on)
        self._calm = QTimer(self, singleShot=True, interval=CALM_INTERVAL)
        self._calm.timeout.connect(self._hover_again)
        self._shown = self.tool
        self._shown.showing(True)
        self._listen()

    def _listen(self) -> None:
        document, session = self.graph.document, self.graph.document.session
        session.option_changed.connect(self._option_changed)
        document.clip_replaced.connect(self.cancel)
        for event in self._telling():
            event.connect(self._stale)
        self.graph.view_changed.connect(self._stale)
        self.graph.viewport().destroyed.connect(self.forget)

    def _telling(self) -> "tuple[Event[*tuple[Any, ...]], ...]":
        """What tells that other things may lie under the pointer, or in the hands of the tool."""
        document, session = self.graph.document, self.graph.document.session
        return (
            document.changed,
            document.setting_changed,
            document.membership_changed,
            session.selection_changed,
            session.visibility_changed,
        )

    def forget(self) -> None:
        """Stop listening to the document: the view is gone, and the document may live on."""
        for timer in (self._later, self._soon, self._calm, self._edge):
            if isValid(timer):
                timer.stop()
        document, session = self.graph.document, self.graph.document.session
        session.option_changed.disconnect(self._option_changed)
        document.clip_replaced.disconnect(self.cancel)
        for event in self._telling():
            event.disconnect(self._stale)
        if document.gesture is not None and self.busy:
            document.gesture.cancel()

    @property
    def tool(self) -> Tool:
        """The tool that session.tool names."""
        name = self.graph.document.session.tool
        if name not in self._tools:
            self._tools[name] = TOOLS[name].factory(self.graph)
        return self._tools[name]

    @property
    def busy(self) -> bool:
        """Whether the mouse is doing something that cancel() would take back."""
        return self.strokes.busy

    def cancel(self) -> None:
        """End the stroke, if there is one, as if it had never begun."""
        self._edge.stop()
        self.strokes.cancel()
        self._tell()

    def handle(self, event: QEvent) -> bool:
        """Take one raw event; True if the view is to do nothing more with it."""
        method = self._HANDLERS.get(event.type())
        if method is None or not isValid(self):  # the program may end with a view still shown
            return False
        try:
            return method(self, event)
        except Exception:
            self.cancel()  # an error must not leave half a gesture behind
            raise

    # Mouse

    def _press(self, event: QMouseEvent) -> bool:
        alone = event.buttons() == event.button()
        double = event.type() == QEvent.Type.MouseButtonDblClick
        other = self.graph.document.gesture
        if other is not None and event.button() == Button.LeftButton and not self.busy:
            self._say(f"Finish or cancel the other change first: {other.label}")
            return True
        if not self.busy:
            self._pushed = QPointF()
        self.strokes.press(self._point_of(event), double=double, alone=alone)
        return self._taken(event)

    def _move(self, event: QMouseEvent) -> bool:
        self.strokes.move(self._point_of(event), event.buttons())
        self._follow()
        return self._taken(event)

    def _release(self, event: QMouseEvent) -> bool:
        point = self._point_of(event)
        still = isinstance(self.navigation.current, Rest | None)
        asks = point.button == Button.RightButton and self.busy and still
        self.strokes.release(point, event.buttons())
        if not self.busy:
            self._edge.stop()
            self.strokes.move(point._replace(button=Button.NoButton), event.buttons())
        taken = self._taken(event)
        if asks:  # last of all: a menu runs an event loop of its own
            self.context_menu_requested.emit(event.globalPosition().toPoint(), self.tool.hit(point))
        return taken

    def _wheel(self, event: QWheelEvent) -> bool:
        wheeled(self.graph, event)
        self._pushed = QPointF()  # the user has chosen what to see
        if self.busy:
            self._again()
        event.accept()
        return True

    def _pinch(self, event: QNativeGestureEvent) -> bool:
        return pinched(self.graph, event)

    def _leave(self, event: QEvent) -> bool:
        if not self.busy:
            self._pointer = None
            (self.strokes.tool or self.tool).leave()
            self._say("")
        return False

    def _menu(self, event: QContextMenuEvent) -> bool:
        if event.reason() == QContextMenuEvent.Reason.Mouse:
            return True  # the release of the button asks for it, unless the button ended a drag
        spot = self.graph.viewport().mapFromGlobal(event.globalPos())
        self.context_menu_requested.emit(event.globalPos(), self.tool.hit(self._point(QPointF(spot))))
        return True

    # Keys and focus

    def _key(self, event: QKeyEvent) -> bool:
        modifier = MODIFIER_OF_KEY.get(event.key())
        if modifier is not None:
            pressed = event.type() == QEvent.Type.KeyPress
            self._modifiers = event.modifiers() | modifier if pressed else event.modifiers() & ~modifier
            self._again()
            return False
        if event.type() != QEvent.Type.KeyPress or not self.busy:
            return False
        if event.key() == Qt.Key.Key_Escape or event.matches(QKeySequence.StandardKey.Undo):
            self.cancel()
        return True  # no command may change the clip in the middle of a drag

    def _shortcut(self, event: QKeyEvent) -> bool:
        if self.busy:
            event.accept()  # so that it comes as a key press, not as a shortcut
        return self.busy

    def _lose(self, event: QEvent) -> bool:
        self.cancel()
        return False

    _HANDLERS: ClassVar[dict[QEvent.Type, Callable[..., bool]]] = {
        QEvent.Type.MouseButtonPress: _press,
        QEvent.Type.MouseButtonDblClick: _press,
        QEvent.Type.MouseMove: _move,
        QEvent.Type.MouseButtonRelease: _release,
        QEvent.Type.Wheel: _wheel,
        QEvent.Type.NativeGesture: _pinch,
        QEvent.Type.Leave: _leave,
        QEvent.Type.ContextMenu: _menu,
        QEvent.Type.KeyPress: _key,
        QEvent.Type.KeyRelease: _key,
        QEvent.Type.ShortcutOverride: _shortcut,
        QEvent.Type.FocusOut: _lose,
        QEvent.Type.WindowDeactivate: _lose,
        QEvent.Type.Hide: _lose,
        QEvent.Type.Close: _lose,
    }

    # What the handlers share

    def _point(self, spot: QPointF, button: Qt.MouseButton = Button.NoButton) -> Point:
        x, y = spot.x(), spot.y()
        return Point(x, y, self.graph.time_from_x(x), self.graph.value_from_y(y), self._modifiers, button)

    def _point_of(self, event: QSinglePointEvent) -> Point:
        self._modifiers = event.modifiers()
        self._pointer = (event.position(), event.buttons())
        return self._point(event.position(), event.button())

    def _again(self) -> None:
        """The pointer stands still, but the view under it or the modifiers have changed."""
        if self._pointer is not None:
            spot, held = self._pointer
            self.strokes.move(self._point(spot), held)
            self._follow()
            self._tell()

    def _follow(self) -> None:
        """Move a drag again soon that could not follow the pointer yet."""
        drag = None if self.strokes.tool is None else self.strokes.tool.current
        if isinstance(drag, EditDrag) and drag.waiting:
            self._soon.start()
        else:
            self._soon.stop()

    @guarded()
    def _go_on(self) -> None:
        try:
            if self.busy:
                self._again()
        except Exception:
            self.cancel()  # an error must not leave half a gesture behind
            raise

    def _taken(self, event: QEvent) -> bool:
        self._watch_edge()
        self._tell()
        event.accept()
        return True

    def _taker(self, point: Point) -> Tool:
        return self.navigation if self.navigation.takes(point) else self.tool

    def _tell(self) -> None:
        """Say what the mouse does here, and shape the pointer for it."""
        tool, point = self.strokes.tool, self._pointer
        if tool is None or point is None or self.graph.document.working:
            return
        drag = tool.current
        if isinstance(drag, EditDrag) and drag.waiting:
            self._say(drag.waiting_hint)
        else:
            self._say(drag.hint if drag is not None else tool.hints(tool.hovered, self._modifiers))
        shape = drag.cursor if drag is not None else tool.cursor(tool.hovered, self._modifiers)
        if self.graph.viewport().cursor().shape() != shape:
            self.graph.viewport().setCursor(shape)

    def _say(self, hint: str) -> None:
        if hint != self._hint:
            self._hint = hint
            self.hint_changed.emit(hint)

    def look_again(self) -> None:
        """What is held and what lies under the pointer may have changed while nothing was told."""
        self._modifiers = QGuiApplication.keyboardModifiers()
        self._stale()

    def _stale(self, *_: object) -> None:
        if not self._later.isActive():
            self._later.start()
        if not self.busy:  # a drag tells of every channel at every step, and looks again when it ends
            self._calm.start()

    @guarded()
    def _hover_again(self) -> None:
        """What lies under the pointer may be another thing by now; in a drag it is what was taken."""
        if not self.busy and not self.graph.document.working:
            self._again()

    @guarded()
    def _refresh(self) -> None:
        if not self.graph.document.working:
            self._shown.refresh()

    def _option_changed(self, name: str) -> None:
        if name == "tool":
            self.cancel()
            self._shown.showing(False)
            self._shown = self.tool
            self._shown.showing(True)
            self._again()

    # The edge of the view

    def _push(self) -> tuple[float, float]:
        tool = self.strokes.tool
        if self.strokes.state is not State.DRAGGING or tool is None or tool.current is None or self._pointer is None:
            return 0.0, 0.0
        if self._modifiers.value & ALT:  # at a tenth of the speed what is dragged would be left behind
            return 0.0, 0.0
        return edge_push(self.graph.plot_rect, self.strokes.start, self._pointer[0], tool.current.scrolls)

    def _watch_edge(self) -> None:
        if any(self._push()):
            if not self._edge.isActive():
                self._edge.start()
        else:
            self._edge.stop()

    @guarded()
    def _scroll(self) -> None:
        dx, dy = self._push()
        if dx or dy:
            push = QPointF(dx, dy) * (EDGE_INTERVAL / 1000)
            self._pushed += push
            self.graph.pan_pixels(-push.x(), -push.y())
            self._again()
        else:
            self._edge.stop()

    def _pan_back(self) -> None:
        """Show what was in view before a drag at the edge moved the picture."""
        push, self._pushed = self._pushed, QPointF()
        if not push.isNull():
            self.graph.pan_pixels(push.x(), push.y())
