"""The button at the right end of the menu bar that opens the command palette."""

from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QToolButton

from widgets.guard import guarded
from widgets.theme import Theme

if TYPE_CHECKING:
    from app.main_window import MainWindow


class FindCommandButton(QToolButton):
    """Looks like a field to type in, as that is what it opens."""

    def __init__(self, window: "MainWindow") -> None:
        super().__init__(window)
        self._most = window.menuBar().sizeHint().height()
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

    @guarded(QSize(0, 0))
    def sizeHint(self) -> QSize:
        """No higher than the menus' names: in a higher bar the style draws a line below each name."""
        hint = super().sizeHint()
        return QSize(hint.width(), min(hint.height(), self._most))

    @guarded(QSize(0, 0))
    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()
