"""ShortcutGuard: who gets a key, the widget with the focus or the shortcut of an action."""

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QAbstractSlider,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QLineEdit,
    QPlainTextEdit,
    QTabBar,
    QTextEdit,
    QWidget,
)
from shiboken6 import isValid

from widgets.guard import guarded

Key, Modifier = Qt.Key, Qt.KeyboardModifier

VERTICAL = {Key.Key_Up, Key.Key_Down, Key.Key_PageUp, Key.Key_PageDown, Key.Key_Home, Key.Key_End}
ARROWS = VERTICAL | {Key.Key_Left, Key.Key_Right}
EDITING = ARROWS | {Key.Key_Delete, Key.Key_Backspace, Key.Key_Space, Key.Key_Return, Key.Key_Enter}

TEXT = (QLineEdit, QAbstractSpinBox, QPlainTextEdit, QTextEdit)
# Keys without Ctrl or Alt that a focused widget keeps for itself; the first matching row counts.
KEPT_KEYS: tuple[tuple[tuple[type[QWidget], ...], set[Qt.Key]], ...] = (
    ((QComboBox,), VERTICAL | {Key.Key_Space}),
    ((QAbstractItemView,), ARROWS),
    ((QAbstractButton,), {Key.Key_Space}),
    ((QAbstractSlider, QTabBar), ARROWS),
)


class ShortcutGuard(QObject):
    """Lets text fields keep their typing and lists their arrows, by answering Qt's question before each shortcut.

    It watches the focused widget only, so that no other event passes through Python.
    """

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._watched: QWidget | None = None
        app = QApplication.instance()
        if isinstance(app, QApplication):
            app.focusChanged.connect(self._watch)
            self._watch(None, app.focusWidget())

    def _watch(self, _old: QWidget | None, new: QWidget | None) -> None:
        if self._watched is not None and isValid(self._watched):
            self._watched.removeEventFilter(self)
        self._watched = new
        if new is not None:
            new.installEventFilter(self)

    @guarded(False)
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() != QEvent.Type.ShortcutOverride or not isinstance(event, QKeyEvent):
            return False
        if not isinstance(watched, QWidget):
            return False
        answer = keeps(watched, event)
        if answer is None:
            return False
        event.setAccepted(answer)
        return True


def keeps(widget: QWidget, event: QKeyEvent) -> bool | None:
    """Whether *widget* wants this key for itself; None when that is Qt's to say."""
    plain = not event.modifiers() & (Modifier.ControlModifier | Modifier.AltModifier | Modifier.MetaModifier)
    if isinstance(widget, TEXT):
        return _text_keeps(widget, event, plain=plain)
    for kinds, keys in KEPT_KEYS:
        if isinstance(widget, kinds):
            return True if plain and event.key() in keys else None
    return None


def _text_keeps(widget: QWidget, event: QKeyEvent, *, plain: bool) -> bool | None:
    if plain:
        return True if (event.text().isprintable() and event.text()) or event.key() in EDITING else None
    undoing = event.matches(QKeySequence.StandardKey.Undo) or event.matches(QKeySequence.StandardKey.Redo)
    if undoing and isinstance(widget, QLineEdit) and not (widget.isUndoAvailable() or widget.isRedoAvailable()):
        return False  # nothing typed to take back: it is the clip's step that is meant
    if event.key() in ARROWS and not event.modifiers() & Modifier.AltModifier:
        return True
    return None
