"""CrashBar: says in one line that something went wrong, and shows the details to whoever wants them."""

from PySide6.QtCore import Qt
from PySide6.QtGui import QFontDatabase, QGuiApplication
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.dialogs import close_buttons
from widgets.theme import Theme


class CrashBar(QFrame):
    """A line over the graph; hidden until the first report."""

    def __init__(self, log: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("crash_bar")
        self.setFrameShape(QFrame.Shape.StyledPanel)
        self._log = log
        self._line, self._times, self._text = "", 0, ""
        icon = QLabel()
        icon.setPixmap(Theme.current().icon("warning").pixmap(20, 20))
        self.message = QLabel()
        self.message.setTextFormat(Qt.TextFormat.PlainText)
        self.message.setWordWrap(True)
        details, close = QPushButton("&Details…"), QPushButton("Dismiss")
        details.clicked.connect(self.show_details)
        close.clicked.connect(self.dismiss)
        row = QHBoxLayout(self)
        row.setContentsMargins(10, 6, 10, 6)
        row.addWidget(icon)
        row.addWidget(self.message, 1)
        row.addWidget(details)
        row.addWidget(close)
        self.hide()

    def show_report(self, line: str, text: str) -> None:
        """Show *line*; the same one again only counts up."""
        self._times = self._times + 1 if line == self._line else 1
        self._line, self._text = line, text
        again = f" ({self._times} times)" if self._times > 1 else ""
        self.message.setText(
            f"Something went wrong inside Hermite{again}: {line}\n"
            "The clip is as it was before that step. Saving it under another name now is a good idea."
        )
        self.show()

    def dismiss(self) -> None:
        """Hide until the next report."""
        self._line = ""
        self.hide()

    def show_details(self) -> None:
        """Open the whole report in a window of its own."""
        dialog = QDialog(self.window())
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.setWindowTitle("What went wrong")
        dialog.resize(760, 420)
        text = QPlainTextEdit(self._text)
        text.setReadOnly(True)
        text.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
        text.setAccessibleName("Report")
        where = QLabel(f"Also written to {self._log}")
        where.setTextFormat(Qt.TextFormat.PlainText)
        where.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        buttons = close_buttons(dialog)
        copy = buttons.addButton("&Copy", QDialogButtonBox.ButtonRole.ActionRole)
        copy.clicked.connect(self._copy)
        column = QVBoxLayout(dialog)
        column.addWidget(text)
        column.addWidget(where)
        column.addWidget(buttons)
        dialog.show()

    def _copy(self) -> None:
        QGuiApplication.clipboard().setText(self._text)
