"""Menus that pop up over the graph."""

from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint
from PySide6.QtGui import QCursor

if TYPE_CHECKING:
    from app.main_window import MainWindow


def pop_up_menu(window: "MainWindow", path: str, at: QPoint | None = None) -> None:
    """Show the menu of *path* at *at* (global), else at the mouse; in the graph's middle if that is elsewhere."""
    if at is None:
        at, graph = QCursor.pos(), window.view
        if not graph.rect().contains(graph.mapFromGlobal(at)):
            at = graph.mapToGlobal(graph.rect().center())
    window.menus[path].popup(at)
