"""The parts that the sections of the key inspector are put together from."""

from typing import Final

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPalette, QWheelEvent
from PySide6.QtWidgets import (
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QSizePolicy,
    QStyle,
    QStyleOptionToolButton,
    QToolButton,
    QWidget,
)

from widgets.colors import mix
from widgets.guard import guarded
from widgets.quiet_label import QuietLabel
from widgets.theme import ICON_SIZE, Theme

WIDEST_LABEL: Final = "Slope out "  # so that the fields of all sections begin at one line


class DimLabel(QuietLabel):
    """A few words that explain, less loud than the rest."""

    def __init__(self, theme: Theme, text: str = "", parent: QWidget | None = None) -> None:
        super().__init__(text, parent)
        self._theme = theme
        theme.theme_changed.connect(self._dim)
        self._dim()

    def _dim(self) -> None:
        dim(self, self._theme)


class DimText(QLabel):
    """As DimLabel, of several lines."""

    def __init__(self, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._theme = theme
        self.setTextFormat(Qt.TextFormat.PlainText)  # names of channels are no markup
        theme.theme_changed.connect(self._dim)
        self._dim()

    def say(self, text: str) -> None:
        """Show *text*, if it is another one."""
        if text != self.text():
            self.setText(text)

    def _dim(self) -> None:
        dim(self, self._theme)


def dim(label: QLabel, theme: Theme) -> None:
    """Give the words of *label* the dim colour of *theme*."""
    palette = QPalette()
    palette.setColor(QPalette.ColorRole.WindowText, theme.text_dim)
    label.setPalette(palette)


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


class PanelButton(QToolButton):
    """A tool button that can be seen from afar to be switched on, and to have the focus."""

    def __init__(self, theme: Theme, icon: str, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._theme = theme
        self.setIcon(theme.icon(icon))
        self.setIconSize(ICON_SIZE)
        self.setAccessibleName(name)
        self.setToolTip(name)

    @guarded()
    def paintEvent(self, event: QPaintEvent) -> None:
        if not (self.isChecked() or self.hasFocus()):
            super().paintEvent(event)
            return
        option = QStyleOptionToolButton()
        self.initStyleOption(option)
        accent = self._theme.accent if self.isEnabled() else self._theme.text_dim
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(accent)
            if self.isChecked():
                painter.setBrush(mix(self.palette().color(QPalette.ColorRole.Window), accent, 0.3))
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4)
            self.style().drawControl(QStyle.ControlElement.CE_ToolButtonLabel, option, painter, self)


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
