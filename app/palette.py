"""CommandPalette: every command and every channel, found by typing a part of the name."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import (
    QAbstractListModel,
    QEvent,
    QModelIndex,
    QObject,
    QPersistentModelIndex,
    QPoint,
    QRect,
    QSize,
    Qt,
)
from PySide6.QtGui import QKeyEvent, QPainter, QPalette
from PySide6.QtWidgets import (
    QDialog,
    QLineEdit,
    QListView,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QVBoxLayout,
)

from app.fuzzy import fitness
from app.menus import shortcut_text
from model.labels import counted
from widgets.guard import guarded

if TYPE_CHECKING:
    from app.main_window import MainWindow

type Index = QModelIndex | QPersistentModelIndex

SHOWN_AT_MOST = 200
KEYS_OF_THE_LIST = (Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_PageUp, Qt.Key.Key_PageDown)


@dataclass(frozen=True, slots=True)
class Entry:
    """A line of the palette."""

    title: str
    place: str  # where it is found otherwise, as "Edit ▸ Select"
    keys: str
    unmet: str  # why it cannot run now
    run: Callable[[], object]
    words: str = ""  # by which it is found too


def entries_of(window: "MainWindow") -> list[Entry]:
    """All commands in the order of the menus, then all channels."""
    entries = []
    for action in window.actions_by_id.values():
        row = action.row
        title = action.text().replace("&&", "\0").replace("&", "").replace("\0", "&").removesuffix("…")
        place = row.menu.replace("/", " ▸ ")
        entries.append(Entry(title, place, shortcut_text(row), row.unmet_need(window), action.run, row.words))
    for channel in window.document.clip.channels:
        keys = counted(len(channel), "key")
        entries.append(Entry(channel.name, "Channel", keys, "", partial(window.activate, channel)))
    return entries


class EntryList(QAbstractListModel):
    """The entries that fit what was typed, best first."""

    def __init__(self, entries: list[Entry], parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._all = entries
        self.found = entries

    def filter(self, query: str) -> None:
        """Keep what fits *query*; what can run now comes before what cannot."""
        scored = [(fitness(query, entry.title, f"{entry.place} {entry.words}"), entry) for entry in self._all]
        fitting = [(score, entry) for score, entry in scored if score > 0]
        if query.strip():
            fitting.sort(key=lambda pair: (bool(pair[1].unmet), -pair[0]))
        self.beginResetModel()
        self.found = [entry for _, entry in fitting[:SHOWN_AT_MOST]]
        self.endResetModel()

    @guarded(0)
    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008 - Qt's own signature
        return 0 if parent.isValid() else len(self.found)

    @guarded()
    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        entry = self.found[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return entry.title
        if role == Qt.ItemDataRole.UserRole:
            return entry
        if role == Qt.ItemDataRole.AccessibleTextRole:
            return ", ".join(part for part in (entry.title, entry.place, entry.keys, entry.unmet) if part)
        return None


class EntryDelegate(QStyledItemDelegate):
    """Title and place on the left, shortcut or reason on the right."""

    @guarded(QSize(0, 28))
    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:
        return QSize(0, option.fontMetrics.height() + 12)

    @guarded()
    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        entry: Entry = index.data(Qt.ItemDataRole.UserRole)
        rect: QRect = option.rect
        palette: QPalette = option.palette
        chosen = bool(option.state & QStyle.StateFlag.State_Selected)
        if chosen:
            painter.fillRect(rect, palette.highlight())
        group = QPalette.ColorGroup.Disabled if entry.unmet else QPalette.ColorGroup.Active
        role = QPalette.ColorRole.HighlightedText if chosen else QPalette.ColorRole.Text
        strong = palette.color(group, role)
        weak = strong if chosen else palette.color(QPalette.ColorRole.PlaceholderText)
        middle = Qt.AlignmentFlag.AlignVCenter
        text = rect.adjusted(12, 0, -12, 0)
        painter.setPen(weak)
        right = f"not now: {entry.unmet}" if entry.unmet else entry.keys
        used = painter.drawText(text, int(middle | Qt.AlignmentFlag.AlignRight), right)
        painter.setPen(strong)
        text.setRight((used.left() if right else text.right()) - 12)
        title = painter.fontMetrics().elidedText(entry.title, Qt.TextElideMode.ElideMiddle, text.width())
        used = painter.drawText(text, int(middle | Qt.AlignmentFlag.AlignLeft), title)
        text.setLeft(used.right() + 14)
        painter.setPen(weak)
        place = painter.fontMetrics().elidedText(entry.place, Qt.TextElideMode.ElideRight, max(text.width(), 0))
        painter.drawText(text, int(middle | Qt.AlignmentFlag.AlignLeft), place)


class CommandPalette(QDialog):
    """Type, Enter runs, Esc closes; the arrows move in the list while the cursor stays in the field."""

    def __init__(self, window: "MainWindow") -> None:
        super().__init__(window, Qt.WindowType.Popup)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("Find command")
        self.model = EntryList(entries_of(window), self)
        self.field = QLineEdit(placeholderText="Find a command or a channel")
        self.field.setAccessibleName("Find a command or a channel")
        self.field.setClearButtonEnabled(True)
        self.list = QListView()
        self.list.setAccessibleName("Commands and channels")
        self.list.setModel(self.model)
        self.list.setItemDelegate(EntryDelegate(self.list))
        self.list.setUniformItemSizes(True)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 8, 8, 8)
        column.addWidget(self.field)
        column.addWidget(self.list)
        self.field.textChanged.connect(self._filter)
        self.field.returnPressed.connect(self.run_chosen)
        self.list.clicked.connect(self.run_chosen)
        self.field.installEventFilter(self)
        self._filter("")
        width = min(620, window.width() - 40)
        self.setGeometry(0, 0, width, min(460, window.height() - 120))
        top = window.view.mapToGlobal(QPoint((window.view.width() - width) // 2, 12))
        self.move(top)
        self.field.setFocus()

    def _filter(self, query: str) -> None:
        self.model.filter(query)
        self.list.setCurrentIndex(self.model.index(0))

    def run_chosen(self) -> None:
        """Close and run the chosen entry; one that cannot run says why and stays."""
        index = self.list.currentIndex()
        if not index.isValid():
            return
        entry: Entry = index.data(Qt.ItemDataRole.UserRole)
        if not entry.unmet:
            self.close()
            entry.run()

    @guarded(False)
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent) and event.key() in KEYS_OF_THE_LIST:
            self.list.event(event)
            return True
        return super().eventFilter(watched, event)
