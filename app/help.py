"""Help: the table of all shortcuts and the table of what the mouse does, both made to be searched and read aloud."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QStandardItem, QStandardItemModel
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QDialogButtonBox,
    QHeaderView,
    QLineEdit,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from app.actions import ACTIONS
from app.menus import shortcut_text

if TYPE_CHECKING:
    from app.main_window import MainWindow

MOUSE = (
    ("Graph", "Click a key", "Select it; again to reach what lies under it"),
    ("Graph", "Shift+click a key", "Add it to the selection, or take it out"),
    ("Graph", "Alt+click a key", "Select all keys at its time"),
    ("Graph", "Click a curve", "Make its channel the active one"),
    ("Graph", "Double-click a curve", "Select all its keys"),
    ("Graph", "Drag on empty ground", "Select what is in the box; Shift adds, Ctrl takes away"),
    ("Graph", "Drag a selected key", "Move all selected keys"),
    ("Graph", "Drag a handle", "Turn the tangent; its side becomes fixed; unified tangents turn together"),
    ("Graph", "Ctrl+click a curve", "Insert a key without changing the curve's shape"),
    ("Graph", "Shift while dragging", "Keep to the first direction"),
    ("Graph", "Ctrl while dragging", "Snap if snapping is off, do not if it is on"),
    ("Graph", "Alt while dragging", "Move at a tenth of the speed"),
    ("Graph", "Esc or right button while dragging", "Cancel, as if nothing had been"),
    ("Graph", "Right click", "Menu of what is under the mouse"),
    ("Graph", "Middle button, or Alt+middle button", "Move the view"),
    ("Graph", "Wheel", "Zoom in both directions at the mouse"),
    ("Graph", "Ctrl+wheel", "Zoom in time"),
    ("Graph", "Shift+wheel", "Zoom in value"),
    ("Rulers", "Drag the time ruler", "Move the playhead"),
    ("Rulers", "Drag the value ruler", "Zoom in value"),
    ("Channels", "Drop a file anywhere", "Open it"),
)


class TableDialog(QDialog):
    """A table with a field that filters its rows; it does not block the window."""

    def __init__(self, title: str, headings: Sequence[str], rows: Sequence[Sequence[str]], parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(title)
        self.resize(760, 560)
        self.field = QLineEdit(placeholderText="Filter")
        self.field.setAccessibleName("Filter")
        self.field.setClearButtonEnabled(True)
        self.field.textChanged.connect(self.filter)
        self._model = QStandardItemModel(self)
        self._model.setHorizontalHeaderLabels(list(headings))
        for row in rows:
            self._model.appendRow([QStandardItem(text) for text in row])
        self.table = QTableView()
        self.table.setAccessibleName(title)
        self.table.setModel(self._model)
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.table.setTabKeyNavigation(False)
        self.table.setAlternatingRowColors(True)
        self.table.setShowGrid(False)
        self.table.setWordWrap(False)
        self.table.verticalHeader().hide()
        self.table.resizeColumnsToContents()
        self.table.horizontalHeader().setSectionResizeMode(len(headings) - 1, QHeaderView.ResizeMode.Stretch)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        buttons.rejected.connect(self.close)
        column = QVBoxLayout(self)
        column.addWidget(self.field)
        column.addWidget(self.table)
        column.addWidget(buttons)

    def filter(self, query: str) -> None:
        """Show only the rows that hold every word of *query*."""
        words = query.lower().split()
        for row in range(self._model.rowCount()):
            text = " ".join(self._model.item(row, column).text() for column in range(self._model.columnCount()))
            self.table.setRowHidden(row, not all(word in text.lower() for word in words))


class ShortcutsDialog(TableDialog):
    """Every command: menu, name, keys, what it does."""

    def __init__(self, window: "MainWindow") -> None:
        rows = [(row.menu.replace("/", " ▸ "), row.plain_label, shortcut_text(row), row.tip) for row in ACTIONS]
        super().__init__("Keyboard Shortcuts", ("Menu", "Command", "Keys", "What it does"), rows, window)


class MouseDialog(TableDialog):
    """What the mouse does."""

    def __init__(self, window: "MainWindow") -> None:
        super().__init__("Mouse", ("Where", "Mouse", "What it does"), MOUSE, window)
