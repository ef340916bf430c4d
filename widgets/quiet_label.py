"""QuietLabel: words that change all the time and make nobody else move."""

from typing import Final

from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QLabel, QSizePolicy, QWidget

from widgets.guard import guarded

# Room is asked for in steps of so many pixels: a label laid out anew has the whole window laid out and painted.
ROOM_STEP: Final = 24


class QuietLabel(QLabel):
    """One line of plain text that gives up its end, marked by …, when there is no room; the tooltip has all of it.

    A new text is painted, and no more, as long as it needs about the room of the old one. A QLabel would have its
    window laid out for each, which in a drag costs as much as everything else.
    """

    def __init__(
        self,
        text: str = "",
        parent: QWidget | None = None,
        *,
        align: Qt.AlignmentFlag = Qt.AlignmentFlag.AlignLeft,
        yields: bool = False,
    ) -> None:
        """One that *yields* takes what the others leave; else it asks for as much as its text needs."""
        super().__init__(parent)
        self._words, self._yields = "", yields
        self._wide = self._room = 0
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setAutoFillBackground(True)  # or all that it stands on is painted with it
        self.setAlignment(align | Qt.AlignmentFlag.AlignVCenter)
        across = QSizePolicy.Policy.Ignored if yields else QSizePolicy.Policy.Preferred
        self.setSizePolicy(across, QSizePolicy.Policy.Preferred)
        self.setText(text)

    @guarded("")
    def text(self) -> str:
        """All of the text, whatever is to be seen of it."""
        return self._words

    @guarded()
    def setText(self, text: str) -> None:
        """Show *text*."""
        if text == self._words:
            return
        self._words = text
        self.setAccessibleDescription(text)
        self._measure()
        self.update()

    def _measure(self) -> None:
        self._wide = self.fontMetrics().horizontalAdvance(self._words)
        room = -(-self._wide // ROOM_STEP) * ROOM_STEP
        if not self._yields and room != self._room:
            self._room = room
            self.updateGeometry()

    @guarded()
    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._measure()

    @guarded(QSize(0, 0))
    def sizeHint(self) -> QSize:
        return QSize(self._room, super().sizeHint().height())

    @guarded(QSize(0, 0))
    def minimumSizeHint(self) -> QSize:
        return QSize(0, super().minimumSizeHint().height())

    @guarded()
    def paintEvent(self, event: QPaintEvent) -> None:
        text, tip = self._words, ""
        if self._wide > self.width():
            text, tip = self.fontMetrics().elidedText(text, Qt.TextElideMode.ElideRight, self.width()), text
        if tip != self.toolTip():
            self.setToolTip(tip)
        place, palette = int(self.alignment()), self.palette()
        with QPainter(self) as painter:
            enabled = self.isEnabled()
            self.style().drawItemText(painter, self.rect(), place, palette, enabled, text, self.foregroundRole())
