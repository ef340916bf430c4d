"""ValueField: a number or a formula is typed, seen at once on all it is about, and kept or taken back."""

from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent, QPalette
from PySide6.QtWidgets import QLineEdit, QWidget

from model.expressions import ExpressionError, Formula
from widgets.guard import guarded
from widgets.numbers import exact, shown
from widgets.theme import Theme

MIXED: Final = "mixed"
HELP: Final = (
    "A number, or a formula for all of them: 3/4, += 0.1, *= 1.1, v*0.5 + sin(t).\n"
    "x this number, t time, v value, i index, n count, u 0 to 1, first, last, min, max.\n"
    "Up and Down step (Shift ×10, Ctrl ×0.1), Enter keeps, Esc takes back."
)


class Target(Protocol):
    """What a field is about: some numbers, and how to change all of them."""

    def numbers(self) -> NDArray[np.float64]:
        """The numbers now, as shown; empty if there is nothing to edit."""

    def text(self, number: float) -> str:
        """How a number reads while nobody edits it."""

    def step(self) -> float:
        """How far one press of the up key goes."""

    def preview(self, formula: Formula) -> str:
        """Show what the formula does; ValueError if it cannot be done. What is to be said if it cannot be shown yet."""

    def commit(self) -> None:
        """Keep what is shown, or do what could not be shown; ValueError if that cannot be done."""

    def cancel(self) -> None:
        """Take back what is shown."""


OWN_KEYS: Final = (Qt.Key.Key_Escape, Qt.Key.Key_Up, Qt.Key.Key_Down)


class ValueField(QLineEdit):
    """Shows one number (or that there are several) and edits them all; what is not touched is never written."""

    status = Signal(str)
    done = Signal()  # Enter kept the entry, or Esc took it back: the keyboard may go back to the graph

    def __init__(self, target: Target, theme: Theme, name: str, tip: str = "", parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.target = target
        self._theme = theme
        self._tip = f"{tip}\n{HELP}" if tip else HELP
        self._opening_text: str | None = None  # not None while the field has the focus or is scrubbed
        self._previewed = False
        self._steps = 0.0
        self._problem = ""
        self.setAccessibleName(name)
        self.setAccessibleDescription(self._tip)
        self.setToolTip(self._tip)
        self.setFont(theme.number_font(self.font()))
        self.setMinimumWidth(64)
        self.textEdited.connect(self._text_edited)
        theme.theme_changed.connect(self._show_problem)
        self.refresh()

    @property
    def editing(self) -> bool:
        """Whether something typed is being shown that is neither kept nor taken back yet."""
        return self._previewed or bool(self._problem)

    def refresh(self) -> None:
        """Show the numbers as they are now, unless something is being typed."""
        if self.editing:
            return
        numbers = self.target.numbers()
        if self.isEnabled() != bool(len(numbers)):
            self.setEnabled(bool(len(numbers)))
        text, placeholder = "", ""
        if len(numbers):
            if (numbers == numbers[0]).all():
                number = float(numbers[0])
                text = exact(number) if self._opening_text is not None else self.target.text(number)
            else:
                placeholder = MIXED
        if text != self.text():
            self.setText(text)
            if self._opening_text is not None:
                self.selectAll()
            else:
                self.setCursorPosition(0)  # where there is no room for all of it, the sign must be seen
        if self._opening_text is not None:
            self._opening_text = text
        if placeholder != self.placeholderText():
            self.setPlaceholderText(placeholder)

    def finish(self) -> None:
        """Keep what is being typed; take it back where it is no formula."""
        if self._problem:
            self.take_back()
        elif self._previewed:
            try:
                self.target.commit()
            except ValueError as error:
                self._show_problem(str(error))
            else:
                self._rest()

    def take_back(self) -> None:
        """Take back what is being typed."""
        if self._previewed:
            self.target.cancel()
        self._rest()

    def step_by(self, steps: float) -> None:
        """Add so many steps to all the numbers, on top of the steps made since the last Enter."""
        if self.editing and not self._steps:
            self.finish()
        self._steps += steps
        if self._opening_text is None:
            self._opening_text = self.text()
        if abs(self._steps) < 1e-9:
            self._back_to_start()
            self.setText(self._opening_text)
        elif self._preview(f"+= {self._steps * self.target.step():.15g}"):
            numbers = self.target.numbers()
            if len(numbers) and (numbers == numbers[0]).all():
                self.setText(shown(float(numbers[0]), 12))
                self.selectAll()

    def release(self) -> None:
        """End a scrub: keep it, and show the number short again if the field has no focus."""
        self.finish()
        if not self.hasFocus():
            self._opening_text = None
            self.refresh()

    def _text_edited(self, text: str) -> None:
        self._steps = 0.0
        if text == self._opening_text or not text.strip():
            self._back_to_start()
        else:
            self._preview(text)

    def _preview(self, text: str) -> bool:
        try:
            words = self.target.preview(Formula(text))
        except (ExpressionError, ValueError) as error:
            if not self._previewed:
                self.target.cancel()  # it may have begun
            self._show_problem(str(error))
            return False
        self._previewed = True
        self._show_problem("")
        if words:
            self.status.emit(f"{self.accessibleName()}: {words}")
        return True

    def _back_to_start(self) -> None:
        if self._previewed:
            self.target.cancel()
        self._previewed = False
        self._show_problem("")

    def _rest(self) -> None:
        self._previewed = False
        self._steps = 0.0
        self._show_problem("")
        self.refresh()

    def _show_problem(self, problem: str | None = None) -> None:
        """Red text and rim with the reason beside it; None shows the present one again."""
        if problem is None:
            problem = self._problem
        elif problem != self._problem:
            self.status.emit(f"{self.accessibleName()}: {problem}" if problem else "")
        self._problem = problem
        self.setToolTip(f"{problem}\n\n{self._tip}" if problem else self._tip)
        self.setAccessibleDescription(self.toolTip())
        palette = QPalette()
        if problem:
            palette.setColor(QPalette.ColorRole.Text, self._theme.error)
            palette.setColor(QPalette.ColorRole.Highlight, self._theme.error)
            palette.setColor(QPalette.ColorRole.Accent, self._theme.error)
        self.setPalette(palette)

    @guarded()
    def focusInEvent(self, event: QFocusEvent) -> None:
        super().focusInEvent(event)
        if self._opening_text is None and not self.editing:
            self._opening_text = ""
            self.refresh()
        if event.reason() != Qt.FocusReason.PopupFocusReason:
            self.selectAll()

    @guarded()
    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        if event.reason() in (Qt.FocusReason.PopupFocusReason, Qt.FocusReason.ActiveWindowFocusReason):
            return
        self.finish()
        self._opening_text = None
        self.refresh()
        self.deselect()

    @guarded(False)
    def event(self, event: QEvent) -> bool:
        # Esc and the arrows belong to the field while it has the focus, not to shortcuts of the window.
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.ShortcutOverride and event.key() in OWN_KEYS:
            event.accept()
            return True
        return super().event(event)

    @guarded()
    def keyPressEvent(self, event: QKeyEvent) -> None:
        key, modifiers = event.key(), event.modifiers()
        if key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            self.step_by(_step_size(modifiers) * (1 if key == Qt.Key.Key_Up else -1))
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            if not self._problem:
                self.finish()
                self.selectAll()
                if not self._problem:
                    self.done.emit()
        elif key == Qt.Key.Key_Escape:
            self.take_back()
            self.selectAll()
            self.done.emit()
        else:
            super().keyPressEvent(event)


def _step_size(modifiers: Qt.KeyboardModifier) -> float:
    if modifiers & Qt.KeyboardModifier.ShiftModifier:
        return 10.0
    return 0.1 if modifiers & Qt.KeyboardModifier.ControlModifier else 1.0
