"""ScrubLabel: the name of a field, which can be dragged sideways to change the number."""

from typing import Final

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QApplication, QLabel, QWidget

from widgets.guard import guarded
from widgets.value_field import ValueField

PIXELS_A_STEP: Final = 4
BEGIN_AFTER: Final = 3  # pixels, so that a click only gives the field the focus


class ScrubLabel(QLabel):
    """Dragged sideways it steps its field: Shift ten times as far, Alt a tenth; Esc or the right button takes back."""

    def __init__(self, text: str, field: ValueField, parent: QWidget | None = None) -> None:
        super().__init__(text, parent)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self._field = field
        self._from: float | None = None
        self._scrubbing = False
        self._last = 0.0
        self._focus_before: QWidget | None = None
        self.setBuddy(field)
        self.setCursor(Qt.CursorShape.SizeHorCursor)
        self.setToolTip(f"{field.toolTip()}\nDrag this name sideways to change the number.")

    @guarded()
    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton and self._field.isEnabled():
            self._from = self._last = event.position().x()
            self._scrubbing = False
        elif self._from is not None:
            self._end(keep=False)

    @guarded()
    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        x = event.position().x()
        if self._from is None or not (self._scrubbing or abs(x - self._from) >= BEGIN_AFTER):
            return
        if not self._scrubbing:
            self._scrubbing = True
            self._focus_before = QApplication.focusWidget()
            self.setFocus(Qt.FocusReason.OtherFocusReason)  # so that Esc arrives here
        steps = (x - self._last) / PIXELS_A_STEP
        self._last = x
        modifiers = event.modifiers()
        if modifiers & Qt.KeyboardModifier.ShiftModifier:
            steps *= 10
        elif modifiers & Qt.KeyboardModifier.AltModifier:
            steps *= 0.1
        if steps:
            self._field.step_by(steps)

    @guarded()
    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton or self._from is None:
            return
        if self._scrubbing:
            self._end(keep=True)
        else:
            self._from = None
            self._field.setFocus(Qt.FocusReason.MouseFocusReason)

    @guarded()
    def keyPressEvent(self, event: QKeyEvent) -> None:
        if self._scrubbing and event.key() == Qt.Key.Key_Escape:
            self._end(keep=False)
        else:
            super().keyPressEvent(event)

    @guarded(False)
    def event(self, event: QEvent) -> bool:
        if self._scrubbing:
            if event.type() in (QEvent.Type.Hide, QEvent.Type.WindowDeactivate, QEvent.Type.FocusOut):
                self._end(keep=False)
            elif event.type() == QEvent.Type.ShortcutOverride:
                event.accept()  # in a drag every key is ours
                return True
        return super().event(event)

    def _end(self, *, keep: bool) -> None:
        scrubbed, before = self._scrubbing, self._focus_before
        self._from, self._scrubbing, self._focus_before = None, False, None
        if not keep:
            self._field.take_back()
        self._field.release()
        if scrubbed and self.hasFocus():
            if before is not None:
                before.setFocus(Qt.FocusReason.OtherFocusReason)
            else:
                self.clearFocus()
