"""StatusRow: the bottom line of the window: transport, progress, messages, what is selected, what the mouse does."""

from PySide6.QtCore import QSize, Qt, QTimer
from PySide6.QtGui import QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QBoxLayout, QHBoxLayout, QLabel, QSizePolicy, QWidget

from widgets.guard import guarded

MESSAGE_MILLISECONDS = 6000
# Message, selection and hint are read comfortably in so many pixels.
WIDTH_FOR_WORDS = 620


class ElidedLabel(QLabel):
    """One line of plain text that gives up its end, marked by …, when there is no room; the tooltip has all of it."""

    def __init__(self, align: Qt.AlignmentFlag, *, yields: bool) -> None:
        """One that *yields* takes what the others leave; else it asks for as much as its text needs."""
        super().__init__()
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setAlignment(align | Qt.AlignmentFlag.AlignVCenter)
        across = QSizePolicy.Policy.Ignored if yields else QSizePolicy.Policy.Preferred
        self.setSizePolicy(across, QSizePolicy.Policy.Preferred)

    @guarded(QSize(0, 0))
    def minimumSizeHint(self) -> QSize:
        return QSize(0, super().minimumSizeHint().height())

    @guarded()
    def paintEvent(self, event: QPaintEvent) -> None:
        text = self.fontMetrics().elidedText(self.text(), Qt.TextElideMode.ElideRight, self.width())
        self.setToolTip(self.text() if text != self.text() else "")
        place, palette = int(self.alignment()), self.palette()
        with QPainter(self) as painter:
            self.style().drawItemText(painter, self.rect(), place, palette, True, text, self.foregroundRole())


class StatusRow(QWidget):
    """The transport, then messages, the selection and mouse hints: beside it where there is room, else under it."""

    def __init__(self, transport: QWidget, progress: QWidget, width: int) -> None:
        """*width* is what it will have at first, so that the first picture is not laid out twice."""
        super().__init__()
        self._transport = transport
        self.message = ElidedLabel(Qt.AlignmentFlag.AlignLeft, yields=False)
        self.message.setObjectName("message")
        self.message.setAccessibleName("Message")
        self.message.hide()  # what is empty leaves its room to the others
        self.selection = QLabel()
        self.selection.setObjectName("selection_summary")
        self.selection.setTextFormat(Qt.TextFormat.PlainText)
        self.hint = ElidedLabel(Qt.AlignmentFlag.AlignRight, yields=True)
        self.hint.setObjectName("mouse_hint")
        self.hint.setAccessibleName("What the mouse does here")
        self.hint.hide()
        self._line = line = QHBoxLayout()
        line.setContentsMargins(8, 0, 8, 0)
        line.setSpacing(16)
        line.addWidget(progress)
        line.addWidget(self.message)
        line.addWidget(self.selection)
        line.addWidget(self.hint, 1)
        self._rows = QBoxLayout(QBoxLayout.Direction.LeftToRight, self)
        self._rows.setContentsMargins(0, 0, 0, 0)
        self._rows.setSpacing(2)
        self._rows.addWidget(transport)
        self._rows.addLayout(line, 1)
        self._arrange(width)
        self._tip = self._mouse_hint = ""
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self._clear_message)

    @guarded(QSize(0, 0))
    def minimumSizeHint(self) -> QSize:
        return QSize(self._transport.minimumSizeHint().width(), super().minimumSizeHint().height())

    @guarded()
    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._arrange(event.size().width())

    def _arrange(self, width: int) -> None:
        beside = width >= self._transport.sizeHint().width() + WIDTH_FOR_WORDS
        directions = QBoxLayout.Direction
        self._rows.setDirection(directions.LeftToRight if beside else directions.TopToBottom)

    def say(self, text: str, milliseconds: int = MESSAGE_MILLISECONDS) -> None:
        """Show *text* for a while; 0 keeps it until the next one."""
        self.message.setText(text)
        self.message.setVisible(bool(text))
        self._place_selection()
        if milliseconds and text:
            self._timer.start(milliseconds)
        else:
            self._timer.stop()

    def _place_selection(self) -> None:
        """At the left while nothing stands beside it."""
        alone = self.message.isHidden() and self.hint.isHidden()
        self._line.setStretchFactor(self.selection, 1 if alone else 0)

    def _clear_message(self) -> None:
        self.say("")

    def show_tip(self, text: str) -> None:
        """Show what the menu entry or button under the mouse does, in the place of what the mouse does elsewhere."""
        self._tip = text
        self._show_words_of_mouse()

    def show_hint(self, text: str) -> None:
        """Say what the mouse does where it is."""
        self._mouse_hint = text
        self._show_words_of_mouse()

    def _show_words_of_mouse(self) -> None:
        self.hint.setText(self._tip or self._mouse_hint)
        self.hint.setVisible(bool(self.hint.text()))
        self._place_selection()

    def show_selection(self, text: str) -> None:
        """Say what is selected."""
        self.selection.setText(text)
