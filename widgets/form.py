"""The parts that the sections of the key inspector are put together from."""

from typing import Final

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QPalette, QWheelEvent
from PySide6.QtWidgets import QComboBox, QGridLayout, QHBoxLayout, QLabel, QSizePolicy, QWidget

from widgets.guard import guarded
from widgets.theme import Theme

WIDEST_LABEL: Final = "Slope out "  # so that the fields of all sections begin at one line


class DimLabel(QLabel):
    """Words that explain, less loud than the rest."""

    def __init__(self, theme: Theme, text: str = "", parent: QWidget | None = None) -> None:
        super().__init__(text, parent)
        self._theme = theme
        self.setTextFormat(Qt.TextFormat.PlainText)  # names of channels are no markup
        theme.theme_changed.connect(self._dim)
        self._dim()

    def say(self, text: str) -> None:
        """Show *text*, if it is another one."""
        if text != self.text():
            self.setText(text)

    def _dim(self) -> None:
        palette = QPalette()
        palette.setColor(QPalette.ColorRole.WindowText, self._theme.text_dim)
        self.setPalette(palette)


class Heading(QWidget):
    """The name of a section, and on its right what it is about now."""

    def __init__(self, theme: Theme, title: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        name = QLabel(title, self)
        font = name.font()
        font.setBold(True)
        name.setFont(font)
        self.detail = DimLabel(theme, "", self)
        self.detail.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.detail.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 2)
        layout.addWidget(name)
        layout.addWidget(self.detail, 1)


class QuietCombo(QComboBox):
    """A combo box that the wheel scrolls past, and that can show that its things differ."""

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName(name)
        self.setIconSize(QSize(18, 18))
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumContentsLength(6)
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def show_data(self, data: object, otherwise: str) -> None:
        """Show the row with this data, or the words *otherwise* if there is none."""
        index = -1 if data is None else self.findData(data)
        if self.placeholderText() != otherwise:
            self.setPlaceholderText(otherwise)
        if index != self.currentIndex():
            self.setCurrentIndex(index)

    @guarded()
    def wheelEvent(self, event: QWheelEvent) -> None:
        event.ignore()


def form_grid(parent: QWidget) -> QGridLayout:
    """Labels, fields, units."""
    grid = QGridLayout(parent)
    grid.setContentsMargins(0, 0, 0, 0)
    grid.setHorizontalSpacing(8)
    grid.setVerticalSpacing(5)
    grid.setColumnStretch(1, 1)
    grid.setColumnMinimumWidth(0, parent.fontMetrics().horizontalAdvance(WIDEST_LABEL))
    return grid
