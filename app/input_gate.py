"""InputGate: while it is shut the user can do nothing but what one button does, and nothing is seen of that."""

from collections.abc import Callable
from typing import Final

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QApplication, QWidget

from widgets.guard import guarded

KEYS: Final = frozenset(
    {QEvent.Type.KeyPress, QEvent.Type.KeyRelease, QEvent.Type.ShortcutOverride, QEvent.Type.InputMethod}
)
PRESSES: Final = frozenset({QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonDblClick})
MOUSE: Final = PRESSES | {QEvent.Type.MouseButtonRelease, QEvent.Type.MouseMove}
OTHERS: Final = frozenset(
    {
        QEvent.Type.Wheel,
        QEvent.Type.ContextMenu,
        QEvent.Type.NativeGesture,
        QEvent.Type.TouchBegin,
        QEvent.Type.TouchUpdate,
        QEvent.Type.TouchEnd,
        QEvent.Type.TabletPress,
        QEvent.Type.TabletMove,
        QEvent.Type.TabletRelease,
        QEvent.Type.ToolTip,
        QEvent.Type.DragEnter,
        QEvent.Type.DragMove,
        QEvent.Type.Drop,
    }
)


class InputGate(QObject):
    """Keeps keys and mouse from the whole program, but for Esc, which calls *escape*, and the mouse on *button*.

    Disabling the window instead would grey it for a moment and take the focus from where it is.
    """

    def __init__(self, button: QWidget, escape: Callable[[], None]) -> None:
        super().__init__()
        self._button = button
        self._escape = escape

    def shut(self) -> None:
        """Let nothing more through."""
        app = QApplication.instance()
        if app is not None:
            app.installEventFilter(self)

    def open(self) -> None:
        """Let everything through again."""
        app = QApplication.instance()
        if app is not None:
            app.removeEventFilter(self)

    @guarded(False)
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        kind = event.type()
        if kind in KEYS:
            if isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape and kind != QEvent.Type.KeyRelease:
                self._escape()
            event.accept()  # so that no shortcut takes it
            return True
        if kind in MOUSE and isinstance(event, QMouseEvent):
            return self._keeps(watched, event)
        return kind in OTHERS

    def _keeps(self, watched: QObject, event: QMouseEvent) -> bool:
        if isinstance(watched, QWidget):
            return watched is not self._button
        # A press that came to a window would move the focus; a release has to, or the next press would go astray.
        spot = self._button.mapFromGlobal(event.globalPosition().toPoint())
        over = self._button.isVisible() and self._button.rect().contains(spot)
        return event.type() in PRESSES and not over
