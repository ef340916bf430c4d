"""ChannelCells: how one cell of the channel tree is painted."""

from collections import Counter
from collections.abc import Sequence
from typing import Final, NamedTuple

from PySide6.QtCore import QModelIndex, QObject, QPersistentModelIndex, QPoint, QRect, QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPainter, QPalette, QPen
from PySide6.QtWidgets import QStyle, QStyledItemDelegate, QStyleOptionViewItem, QTreeView

from model.channel import Channel
from model.document import Document
from widgets.channel_rows import TOGGLES, ChannelRows, Column
from widgets.colors import mix
from widgets.guard import guarded
from widgets.theme import Theme
from widgets.traces import MOST_DASHED

type Index = QModelIndex | QPersistentModelIndex

ROW_HEIGHT: Final = 24
SWATCH: Final = 20
ICON: Final = 16
GAP: Final = 6
# How far an icon that is off goes towards the background: little in the row under the mouse, else nearly all the way.
FAINT: Final = 0.84
FAINT_UNDER_MOUSE: Final = 0.45


class SeenValue(NamedTuple):
    """One value on the screen: where, what it reads, whether its row is chosen."""

    rect: QRect
    text: str
    chosen: bool


class ChannelCells(QStyledItemDelegate):
    """Swatch and name, live value, and icons; nothing is a widget, so thousands of rows cost as much as those seen."""

    def __init__(self, document: Document, theme: Theme, rows: ChannelRows, parent: QObject) -> None:
        super().__init__(parent)
        self._document = document
        self._theme = theme
        self._rows = rows
        self._pens: dict[Channel, QPen] = {}
        self._alike: Counter[int] = Counter()  # how many channels have a colour
        self._dashes: list[tuple[float, ...]] = []  # of all channels, if they are few
        self._font: QFont | None = None
        self._number_font = QFont()
        self._metrics = QFontMetrics(self._number_font)
        self._widths: dict[str, int] = {}
        self.dirty = QRect()  # what the paint event under way is about; cells outside are left alone

    def forget_colors(self) -> None:
        """Work out all colours again: the theme or a channel's colour has changed."""
        self._pens.clear()
        self._alike.clear()

    @guarded(QSize(40, ROW_HEIGHT))
    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:
        return QSize(40, max(ROW_HEIGHT, option.fontMetrics.height() + 6))

    @guarded()
    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        if not option.rect.intersects(self.dirty):
            return
        painter.save()
        chosen = bool(option.state & QStyle.StateFlag.State_Selected)
        painter.fillRect(option.rect, self._ground(option.palette, chosen=chosen))
        column = Column(index.column())
        if column == Column.NAME:
            self._paint_name(painter, option, index)
        elif column == Column.VALUE:
            channel = self._rows.channel_of(index)
            if channel is not None:
                self._begin_values(painter, option.font)
                self._paint_value(painter, option.rect, self._rows.value_text(channel))
            else:  # a group has no value, and so its name goes on here
                self._paint_name(painter, option, index.sibling(index.row(), Column.NAME))
        else:
            self._paint_toggle(painter, option, index, column)
        # On an icon always, for Space acts on it; on a name only for those who go by keyboard.
        by_key = bool(option.state & QStyle.StateFlag.State_KeyboardFocusChange) or column in TOGGLES
        if option.state & QStyle.StateFlag.State_HasFocus and by_key:
            painter.setPen(self._theme.pen(self._theme.accent))
            painter.drawRect(option.rect.adjusted(0, 0, -1, -1))
        painter.restore()

    def paint_values(self, painter: QPainter, palette: QPalette, font: QFont, values: Sequence[SeenValue]) -> None:
        """Paint these values and their ground, without asking the view for anything."""
        self._begin_values(painter, font)
        for value in values:
            painter.fillRect(value.rect, self._ground(palette, chosen=value.chosen))
            self._paint_value(painter, value.rect, value.text)

    def _begin_values(self, painter: QPainter, font: QFont) -> None:
        if font != self._font:
            self._font = QFont(font)
            self._number_font = self._theme.number_font(font)
            self._metrics = QFontMetrics(self._number_font)
            self._widths = {}
        painter.setFont(self._number_font)
        painter.setPen(self._theme.text_dim)

    def _paint_value(self, painter: QPainter, rect: QRect, text: str) -> None:
        widths = self._widths
        for letter in text:
            if letter not in widths:
                widths[letter] = self._metrics.horizontalAdvance(letter)
        left = rect.right() - GAP - sum([widths[letter] for letter in text])
        base = rect.top() + (rect.height() + self._metrics.ascent() - self._metrics.descent()) // 2
        painter.drawText(left, base, text)

    def _ground(self, palette: QPalette, *, chosen: bool) -> QColor:
        return palette.color(QPalette.ColorRole.Highlight if chosen else QPalette.ColorRole.Base)

    def _paint_name(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        channel = self._rows.channel_of(index)
        rect = option.rect.adjusted(2, 0, -2, 0)
        if channel is None and isinstance(option.widget, QTreeView):
            painter.setClipRect(option.rect)
            rect.setLeft(option.widget.visualRect(index).left() + 2)
            rect.setRight(option.widget.visualRect(index.sibling(index.row(), Column.VALUE)).right() - 2)
        seen = self._rows.seen(self._rows.channels_of(index))
        if channel is not None:
            middle = rect.center().y()
            pen = self._pen(channel)
            if not seen:
                pen = QPen(pen)
                pen.setColor(mix(pen.color(), option.palette.color(QPalette.ColorRole.Base), 0.65))
            painter.setPen(pen)
            painter.drawLine(QPoint(rect.left() + 2, middle), QPoint(rect.left() + SWATCH - 2, middle))
            rect.setLeft(rect.left() + SWATCH + GAP)
        font = option.font
        font.setBold(channel is not None and channel is self._document.session.active)
        painter.setFont(font)
        painter.setPen(self._theme.text if seen else self._theme.text_dim)
        text = channel.leaf if channel is not None else self._rows.groups[index.row()].name
        text = QFontMetrics(font).elidedText(text, Qt.TextElideMode.ElideRight, rect.width())
        painter.drawText(rect, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, text)

    def _paint_toggle(self, painter: QPainter, option: QStyleOptionViewItem, index: Index, column: Column) -> None:
        toggle = TOGGLES[column]
        part = self._rows.part_on(self._rows.channels_of(index), column)
        color = self._theme.text_dim
        if part and column != Column.SHOW:
            color = self._theme.accent if column == Column.SOLO else self._theme.warning
        if part < 1:
            under_mouse = bool(option.state & QStyle.StateFlag.State_MouseOver)
            faint = FAINT_UNDER_MOUSE if under_mouse or part or column == Column.SHOW else FAINT
            color = mix(color, option.palette.color(QPalette.ColorRole.Base), faint)
        ratio = painter.device().devicePixelRatio()
        pixmap = self._theme.pixmap(toggle.icon_on if part else toggle.icon_off, ICON, ratio, color)
        painter.drawPixmap(option.rect.center() - QPoint(ICON // 2 - 1, ICON // 2 - 1), pixmap)

    def _pen(self, channel: Channel) -> QPen:
        if channel not in self._pens:
            rank, theme = self._rows.rank(channel), self._theme
            color = theme.channel_color(channel, rank)
            pen = QPen(color, 2.5)
            pen.setCapStyle(Qt.PenCapStyle.FlatCap)
            channels = self._document.clip.channels
            # As the curves: a second code where the first is not enough, and never a fabric of dashes.
            if not self._alike and len(channels) <= MOST_DASHED:
                self._alike = Counter(theme.channel_color(other, place).rgba() for place, other in enumerate(channels))
                self._dashes = theme.channel_dashes(channels)
            if self._alike[color.rgba()] > 1 and (dash := self._dashes[rank]):
                pen.setDashPattern([max(length * 0.4, 0.8) for length in dash])
            self._pens[channel] = pen
        return self._pens[channel]
