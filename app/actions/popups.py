"""Menus that pop up over the graph."""

from typing import TYPE_CHECKING

from PySide6.QtGui import QCursor
from PySide6.QtWidgets import QMenu

if TYPE_CHECKING:
    from app.main_window import MainWindow

# The actions that show such a menu: they have no place in it.
SHOWING = ("tangent.menu", "curve.menu", "edit.paste_special")


def pop_up_menu(window: "MainWindow", *paths: str, of: str = "") -> None:
    """Show the menus of *paths* as one, at the mouse; in the graph's middle if the mouse is elsewhere.

    Their titles say *of* what they are.
    """
    at, graph = QCursor.pos(), window.view
    if not graph.rect().contains(graph.mapFromGlobal(at)):
        at = graph.mapToGlobal(graph.rect().center())
    menu = QMenu(window)
    menu.setToolTipsVisible(True)
    menu.aboutToHide.connect(menu.deleteLater)
    shown = [window.actions_by_id[name] for name in SHOWING]
    for path in paths:
        source = window.menus[path]
        if len(paths) > 1:
            menu.addSection(source.title().replace("&", "") + (f" of {of}" if of else ""))
        menu.addActions([action for action in source.actions() if action not in shown])
    menu.popup(at)
