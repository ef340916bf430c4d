"""ChannelView: the rows of the channel tree under the mouse and the keyboard."""

from typing import Final, NamedTuple

from PySide6.QtCore import QEvent, QItemSelectionModel, QModelIndex, QPoint, QRect, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPalette, QRegion, QResizeEvent
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTreeView, QWidget

from model.channel import Channel
from model.document import Document, Gesture
from model.selection import Selection
from widgets.channel_cells import GAP, SWATCH, ChannelCells, SeenValue
from widgets.channel_rows import TOGGLES, ChannelRows, Column
from widgets.channel_verbs import lock_label, set_shown, set_solo, settings, unlocked
from widgets.colors import mix
from widgets.guard import guarded
from widgets.theme import Theme

TOGGLE_WIDTH: Final = 23
WIDEST_VALUE: Final = "-9999.9°"
WIDEST_NAME: Final = "translateX"  # of what a narrow dock must still show
# Keys that move about in the tree; without this the window's shortcuts would take them.
OWN_KEYS: Final = frozenset(
    {
        Qt.Key.Key_Up,
        Qt.Key.Key_Down,
        Qt.Key.Key_Left,
        Qt.Key.Key_Right,
        Qt.Key.Key_Home,
        Qt.Key.Key_End,
        Qt.Key.Key_PageUp,
        Qt.Key.Key_PageDown,
        Qt.Key.Key_F2,
    }
)


class Brush(NamedTuple):
    """A press on an icon, dragged over others to give them the same state."""

    column: Column
    turn_on: bool
    touched: list[Channel]
    gesture: Gesture | None
    selection: Selection


class ChannelView(QTreeView):
    """Rows are chosen, icons are clicked or painted over, cells are walked by the arrow keys."""

    framed = Signal(object)
    refused = Signal(str)

    def __init__(self, document: Document, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._theme = theme
        self._brush: Brush | None = None
        self.empty_text = ""
        self.rows = ChannelRows(document, self)
        self.cells = ChannelCells(document, theme, self.rows, self)
        self.setModel(self.rows)
        self.setItemDelegate(self.cells)
        self.setUniformRowHeights(True)
        self.setAllColumnsShowFocus(False)
        self.setIndentation(14)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setMouseTracking(True)
        self.setHeaderHidden(True)
        self._places: list[tuple[Channel, QRect]] | None = None  # of the values on the screen, once worked out
        self._seen: dict[Channel, str] = {}
        self._lay_out_columns()
        self.verticalScrollBar().valueChanged.connect(self.forget_places)
        for change in (self.expanded, self.collapsed, self.rows.modelReset, self.header().geometriesChanged):
            change.connect(self.forget_places)
        self.recolor()

    def _lay_out_columns(self) -> None:
        header = self.header()
        header.setStretchLastSection(False)
        header.setMinimumSectionSize(TOGGLE_WIDTH)
        header.setSectionResizeMode(Column.NAME, QHeaderView.ResizeMode.Stretch)
        for column in list(Column)[1:]:
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.Fixed)
            header.resizeSection(column, TOGGLE_WIDTH)
        metrics = self.fontMetrics()
        header.resizeSection(Column.VALUE, metrics.horizontalAdvance(WIDEST_VALUE) + 2 * GAP)
        name = metrics.horizontalAdvance(WIDEST_NAME) + SWATCH + 2 * GAP + 2 * self.indentation()
        numbers = sum(header.sectionSize(column) for column in list(Column)[1:])
        self.setMinimumWidth(name + numbers + self.verticalScrollBar().sizeHint().width())

    def recolor(self) -> None:
        """Take the colours of the theme; chosen rows are tinted only, so that the swatches stay what they are."""
        palette = self._theme.palette()
        base = palette.color(QPalette.ColorRole.Base)
        groups = (QPalette.ColorGroup.Active, 0.34), (QPalette.ColorGroup.Inactive, 0.22)
        for group, part in groups:
            palette.setColor(group, QPalette.ColorRole.Highlight, mix(base, self._theme.accent, part))
            palette.setColor(group, QPalette.ColorRole.HighlightedText, self._theme.text)
        self.setPalette(palette)
        self.cells.forget_colors()
        self.viewport().update()

    def update_values(self) -> None:
        """Paint again the values that read differently now, and nothing else."""
        if self._places is None:
            self._places = self._value_places()
        seen = self._seen
        region = QRegion()
        for channel, rect in self._places:
            text = self.rows.value_text(channel)
            if seen.get(channel) != text:
                seen[channel] = text
                region += rect
        if not region.isEmpty():
            self.viewport().update(region)

    def _value_places(self) -> list[tuple[Channel, QRect]]:
        """The channels on the screen and where their values are."""
        places = []
        bottom = self.viewport().height()
        index = self.indexAt(QPoint(1, 0))
        while index.isValid():
            rect = self.visualRect(index.siblingAtColumn(Column.VALUE))
            if rect.top() > bottom:
                break
            channel = self.rows.channel_of(index)
            if channel is not None:
                places.append((channel, rect))
            index = self.indexBelow(index)
        return places

    def forget_places(self, *_: object) -> None:
        """Work out anew which values are on the screen and where."""
        self._places = None
        self._seen.clear()

    def _paint_values(self, region: QRegion) -> None:
        chosen = {self.rows.channel_of(row) for row in self.selectionModel().selectedRows()}
        values = [
            SeenValue(rect, self._seen.get(channel) or self.rows.value_text(channel), channel in chosen)
            for channel, rect in self._places or ()
            if region.intersects(rect)
        ]
        palette = self.palette()
        # As Qt has it for whole rows.
        group = QPalette.ColorGroup.Active if self.hasFocus() else QPalette.ColorGroup.Inactive
        palette.setCurrentColorGroup(group)
        with QPainter(self.viewport()) as painter:
            self.cells.paint_values(painter, palette, self.font(), values)

    def chosen(self) -> list[Channel]:
        """The channels of the chosen rows, groups opened up, in the clip's order."""
        rows = self.selectionModel().selectedRows(Column.NAME)
        channels = {channel: None for row in rows for channel in self.rows.channels_of(row)}
        return sorted(channels, key=self.rows.rank)

    def choose(self, channels: list[Channel]) -> None:
        """Choose the rows of these channels, and no others."""
        model = self.selectionModel()
        flag = QItemSelectionModel.SelectionFlag
        model.clearSelection()
        for channel in channels:
            index = self.rows.index_of(channel)
            if index.isValid():
                model.select(index, flag.Select | flag.Rows)

    def toggle(self, index: QModelIndex) -> None:
        """Turn the icon of this cell over; of a group, all on unless all are."""
        column = Column(index.column())
        channels = self.rows.channels_of(index)
        self._begin_brush(column, channels)
        self._end_brush()

    # --- painting icons on and off

    def _begin_brush(self, column: Column, channels: list[Channel]) -> None:
        turn_on = self.rows.part_on(channels, column) < 1
        gesture = None
        if column == Column.LOCK:
            if self._document.gesture is not None:
                self.refused.emit("Finish the drag first, or press Esc to cancel it")
                return
            gesture = self._document.begin(lock_label(channels, turn_on))
        self._brush = Brush(column, turn_on, [], gesture, self._document.session.selection)
        self._touch(channels)

    def _touch(self, channels: list[Channel]) -> None:
        brush = self._brush
        if brush is None:
            return
        new = [channel for channel in channels if channel not in brush.touched]
        if not new:
            return
        brush.touched.extend(new)
        session = self._document.session
        if brush.column == Column.SHOW:
            set_shown(session, new, brush.turn_on)
        elif brush.column == Column.SOLO:
            set_solo(session, new, brush.turn_on)
        elif brush.gesture is not None:
            label = lock_label(brush.touched, brush.turn_on)
            brush.gesture.preview(
                lambda clip: settings(brush.touched, "locked", brush.turn_on),
                selection=lambda _changes: unlocked(brush.selection),
                label=label,
            )

    def _end_brush(self) -> None:
        brush, self._brush = self._brush, None
        if brush is not None and brush.gesture is not None:
            brush.gesture.commit()

    # --- Qt

    @guarded()
    def mousePressEvent(self, event: QMouseEvent) -> None:
        index = self.indexAt(event.position().toPoint())
        if event.button() == Qt.MouseButton.LeftButton and index.isValid() and index.column() in TOGGLES:
            self._begin_brush(Column(index.column()), self.rows.channels_of(index))
        else:
            super().mousePressEvent(event)

    @guarded()
    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._brush is None:
            super().mouseMoveEvent(event)
            return
        index = self.indexAt(event.position().toPoint())
        if index.isValid():
            self._touch(self.rows.channels_of(index))

    @guarded()
    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._brush is not None:
            self._end_brush()
        else:
            super().mouseReleaseEvent(event)

    @guarded()
    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        index = self.indexAt(event.position().toPoint())
        if index.isValid() and index.column() in TOGGLES:
            self.mousePressEvent(event)
            return
        super().mouseDoubleClickEvent(event)
        channel = self.rows.channel_of(index)
        if channel is not None and event.button() == Qt.MouseButton.LeftButton:
            self.framed.emit(channel)

    @guarded()
    def resizeEvent(self, event: QResizeEvent) -> None:
        self.forget_places()
        super().resizeEvent(event)

    @guarded(False)
    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            plain = event.modifiers() & ~(Qt.KeyboardModifier.KeypadModifier | Qt.KeyboardModifier.ShiftModifier)
            on_icon = event.key() == Qt.Key.Key_Space and self.currentIndex().column() in TOGGLES
            if plain == Qt.KeyboardModifier.NoModifier and (event.key() in OWN_KEYS or on_icon):
                event.accept()
                return True
        if event.type() in (QEvent.Type.Hide, QEvent.Type.WindowDeactivate):
            self._end_brush()
        return super().event(event)

    @guarded()
    def keyPressEvent(self, event: QKeyEvent) -> None:
        index, key = self.currentIndex(), event.key()
        column = index.column()
        is_leaf = index.isValid() and not self.rows.hasChildren(index.siblingAtColumn(Column.NAME))
        if key == Qt.Key.Key_F2 and index.isValid():
            self.edit(index.siblingAtColumn(Column.NAME))
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.rows.channel_of(index) is not None:
            self.framed.emit(self.rows.channel_of(index))
        elif key == Qt.Key.Key_Space and column in TOGGLES:
            self.toggle(index)
        elif key == Qt.Key.Key_Right and (is_leaf or self.isExpanded(index)) and column < Column.SOLO:
            self._go_to_column(index, Column.SHOW if column < Column.SHOW else Column(column + 1))
        elif key == Qt.Key.Key_Left and column > Column.NAME:
            self._go_to_column(index, Column.NAME if column <= Column.SHOW else Column(column - 1))
        else:
            super().keyPressEvent(event)

    def _go_to_column(self, index: QModelIndex, column: Column) -> None:
        self.selectionModel().setCurrentIndex(index.siblingAtColumn(column), QItemSelectionModel.SelectionFlag.NoUpdate)

    @guarded()
    def paintEvent(self, event: QPaintEvent) -> None:
        dirty = event.region().boundingRect()
        left = self.columnViewportPosition(Column.VALUE)
        if self._places and left <= dirty.left() and dirty.right() < left + self.columnWidth(Column.VALUE):
            self._paint_values(event.region())
            return
        self.cells.dirty = dirty
        self._seen.clear()
        super().paintEvent(event)
        if not self.rows.groups and self.empty_text:
            with QPainter(self.viewport()) as painter:
                painter.setPen(self._theme.text_dim)
                flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
                painter.drawText(self.viewport().rect().adjusted(12, 12, -12, -12), flags, self.empty_text)
