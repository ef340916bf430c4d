"""A hand on the mouse over a curve view: every movement is a real Qt event on the view's viewport."""

from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from widgets.curve_view import CurveView

LEFT, MIDDLE, RIGHT = Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton, Qt.MouseButton.RightButton
NO_BUTTON = Qt.MouseButton.NoButton
PLAIN, SHIFT, CTRL, ALT = (
    Qt.KeyboardModifier.NoModifier,
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.ControlModifier,
    Qt.KeyboardModifier.AltModifier,
)

type Spot = tuple[float, float]


class Hand:
    """Presses, moves and releases at viewport pixels, and remembers what it holds down."""

    def __init__(self, view: CurveView) -> None:
        self.view = view
        self.held = NO_BUTTON
        self.spot: Spot = (0.0, 0.0)

    def spot_of(self, time: float, value: float) -> Spot:
        """The viewport pixel of a time and a value, not rounded."""
        return self.view.x_from_time(time), self.view.y_from_value(value)

    def press(self, spot: Spot, button: Qt.MouseButton = LEFT, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
        self.held |= button
        self._send(QEvent.Type.MouseButtonPress, spot, button, modifiers)

    def move(self, spot: Spot, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
        self._send(QEvent.Type.MouseMove, spot, NO_BUTTON, modifiers)

    def release(
        self, spot: Spot | None = None, button: Qt.MouseButton = LEFT, modifiers: Qt.KeyboardModifier = PLAIN
    ) -> None:
        self.held &= ~button
        self._send(QEvent.Type.MouseButtonRelease, spot or self.spot, button, modifiers)

    def click(self, spot: Spot, button: Qt.MouseButton = LEFT, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
        self.move(spot, modifiers)
        self.press(spot, button, modifiers)
        self.release(spot, button, modifiers)

    def double_click(self, spot: Spot, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
        self.click(spot, LEFT, modifiers)
        self.held |= LEFT
        self._send(QEvent.Type.MouseButtonDblClick, spot, LEFT, modifiers)
        self.release(spot, LEFT, modifiers)

    def drag(
        self,
        start: Spot,
        *stops: Spot,
        button: Qt.MouseButton = LEFT,
        modifiers: Qt.KeyboardModifier = PLAIN,
        drop: bool = True,
    ) -> None:
        """Press at *start*, pass *stops*, and release at the last one if *drop*."""
        self.press(start, button, modifiers)
        for stop in stops:
            self.move(stop, modifiers)
        if drop:
            self.release(stops[-1], button, modifiers)

    def wheel(
        self,
        spot: Spot,
        units: int,
        modifiers: Qt.KeyboardModifier = PLAIN,
        *,
        sideways: int = 0,
        pixels: QPoint | None = None,
    ) -> None:
        position = QPointF(*spot)
        event = QWheelEvent(
            position,
            QPointF(self.view.viewport().mapToGlobal(position.toPoint())),
            pixels or QPoint(),
            QPoint(sideways, units),
            self.held,
            modifiers,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
        QApplication.sendEvent(self.view.viewport(), event)

    def key(self, key: Qt.Key, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
        QTest.keyClick(self.view, key, modifiers)

    def _send(self, kind: QEvent.Type, spot: Spot, button: Qt.MouseButton, modifiers: Qt.KeyboardModifier) -> None:
        self.spot = spot
        position = QPointF(*spot)
        viewport = self.view.viewport()
        event = QMouseEvent(
            kind, position, QPointF(viewport.mapToGlobal(position.toPoint())), button, self.held, modifiers
        )
        QApplication.sendEvent(viewport, event)
