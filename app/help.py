"""Help: the table of all shortcuts and the table of what the mouse does, both made to be searched and read aloud."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QStandardItem, QStandardItemModel
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QHeaderView,
    QLineEdit,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from app.actions import ACTIONS
from app.dialogs import close_buttons
from app.menus import shortcut_text

if TYPE_CHECKING:
    from app.main_window import MainWindow

MOUSE = (
    ("Select", "Click a key", "Select it; again on the same spot for what lies under it"),
    ("Select", "Shift+click a key", "Add it to the selection, or take it out"),
    ("Select", "Alt+click a key", "Select the keys of all shown channels at its time; with Shift add them"),
    ("Select", "Click a curve", "Make its channel the active one"),
    ("Select", "Double-click a curve", "Select all its keys"),
    ("Select", "Drag on empty ground", "Select what is in the box; Shift adds, Ctrl takes out"),
    ("Change", "Drag a key", "Move all selected keys, past their neighbours too"),
    ("Change", "Drag a curve", "Move the two keys of that span"),
    ("Change", "Drag a handle", "Turn the tangent; that side becomes fixed, and unified tangents turn together"),
    ("Change", "Ctrl+click a curve", "Insert a key without changing the curve's shape"),
    ("Change", "Drag the box of the scale tool", "Scale the selected keys in time and value"),
    ("Change", "Drag with the retime tool", "Stretch the selected keys in time; the other end stays"),
    ("While dragging", "Shift", "Keep to the first direction; a handle goes flat or along a chord"),
    ("While dragging", "Ctrl", "Snap to frames if snapping is off, do not if it is on"),
    ("While dragging", "Alt", "Move at a tenth of the speed"),
    ("While dragging", "Esc or the right button", "Cancel, as if nothing had been"),
    ("While dragging", "Hold at the edge of the graph", "Let the view follow"),
    ("View", "Middle button", "Move the view"),
    ("View", "Wheel, or pinch", "Zoom at the mouse"),
    ("View", "Ctrl+wheel", "Zoom in time"),
    ("View", "Shift+wheel", "Zoom in value"),
    ("View", "Alt+right button", "Zoom by dragging: right or up comes nearer"),
    ("Rulers", "Drag in the time ruler", "Move the playhead, or the start or end of the clip's range"),
    ("Rulers", "Middle or right button in the time ruler", "Zoom in time"),
    ("Rulers", "Drag the value ruler", "Zoom in value"),
    ("Anywhere", "Right click", "Menu of what is under the mouse"),
    ("Anywhere", "Drop a file", "Open it; a .skel names the channels"),
)


class TableDialog(QDialog):
    """A table with a field that filters its rows; it does not block the window."""

    def __init__(self, title: str, headings: Sequence[str], rows: Sequence[Sequence[str]], parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(title)
        self.resize(min(1080, parent.width()), min(640, parent.height()))
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
        self.table.verticalHeader().hide()
        self.table.verticalHeader().setDefaultSectionSize(self.fontMetrics().height() + 8)
        self.table.horizontalHeader().setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.table.horizontalHeader().setSectionResizeMode(len(headings) - 1, QHeaderView.ResizeMode.Stretch)
        self.table.resizeColumnsToContents()
        # What does not fit into the last column goes on in the next line.
        self.table.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        column = QVBoxLayout(self)
        column.addWidget(self.field)
        column.addWidget(self.table)
        column.addWidget(close_buttons(self))

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
