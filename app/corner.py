"""The button at the right end of the menu bar that opens the command palette."""

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QToolButton

from widgets.theme import Theme

if TYPE_CHECKING:
    from app.main_window import MainWindow


class FindCommandButton(QToolButton):
    """Looks like a field to type in, as that is what it opens."""

    def __init__(self, window: "MainWindow") -> None:
        super().__init__(window)
        action = window.actions_by_id["edit.find_command"]
        self.setObjectName("find_command")
        self.setText("Find command   Ctrl+K")
        self.setIcon(Theme.current().icon("search"))
        self.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.setToolTip(action.toolTip())
        self.setStatusTip(action.statusTip())
        self.setAccessibleName("Find command")
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAutoRaise(True)
        self.clicked.connect(action.trigger)
