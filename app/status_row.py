"""StatusRow: the bottom line of the window: transport, progress, messages, what is selected, what the mouse does."""

from PySide6.QtCore import QSize, Qt, QTimer
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QBoxLayout, QHBoxLayout, QWidget

from widgets.guard import guarded
from widgets.quiet_label import QuietLabel

MESSAGE_MILLISECONDS = 6000
# Message, selection and hint are read comfortably in so many pixels.
WIDTH_FOR_WORDS = 620


class StatusRow(QWidget):
    """The transport, then messages, the selection and mouse hints: beside it where there is room, else under it."""

    def __init__(self, transport: QWidget, progress: QWidget, width: int) -> None:
        """*width* is what it will have at first, so that the first picture is not laid out twice."""
        super().__init__()
        self._transport = transport
        self.message = QuietLabel()
        self.message.setObjectName("message")
        self.message.setAccessibleName("Message")
        self.message.hide()  # what is empty leaves its room to the others
        self.selection = QuietLabel()
        self.selection.setObjectName("selection_summary")
        self.hint = QuietLabel(align=Qt.AlignmentFlag.AlignRight, yields=True)
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
        self._alone = False
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
        if alone != self._alone:  # to be told the same again has everything laid out anew
            self._alone = alone
            self._line.setStretchFactor(self.selection, int(alone))

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
