"""ContextMenu: what the right mouse button offers for what is under it."""

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QPoint
from PySide6.QtWidgets import QMenu

from model import edits
from model.document import added_keys
from model.selection import Selection
from widgets.hit_test import Hit

if TYPE_CHECKING:
    from app.main_window import MainWindow

SEPARATOR = "-"
_KEY = (
    "menu:Tangent",
    SEPARATOR,
    "edit.cut",
    "edit.copy",
    "edit.duplicate",
    "edit.delete",
    SEPARATOR,
    "view.frame_selection",
    "play.range_selection",
)
_RANGE = ("play.range_start_here", "play.range_end_here", "play.range_selection", "play.range_all")
# kind of the hit -> ids of actions; "menu:" stands before the path of a menu of the menu bar.
CONTEXT_MENUS: dict[str, tuple[str, ...]] = {
    "key": _KEY,
    "handle_in": _KEY,
    "handle_out": _KEY,
    "curve": (
        "edit.select_channel",
        "edit.paste",
        SEPARATOR,
        "menu:Curve",
        SEPARATOR,
        "channel.hide",
        "channel.show_only",
        "channel.lock",
        "channel.color",
        "channel.rename",
    ),
    "playhead": ("key.at_playhead", SEPARATOR, "edit.select_before", "edit.select_after", SEPARATOR, *_RANGE),
    "range_start": _RANGE,
    "range_end": _RANGE,
    "empty": (
        "edit.paste",
        "edit.select_all",
        "key.at_playhead",
        SEPARATOR,
        "view.frame_all",
        "view.frame_selection",
        "view.back",
        SEPARATOR,
        "channel.reveal",
        "key.snap",
    ),
}


class ContextMenu(QObject):
    """Shows the menu when the graph asks for it."""

    def __init__(self, window: "MainWindow") -> None:
        super().__init__(window)
        self._window = window
        window.view.router.context_menu_requested.connect(self.show_menu)

    def show_menu(self, at: QPoint, hit: Hit) -> None:
        """Take up what was hit, then show what can be done with it at *at* (global)."""
        self._take_up(hit)
        menu = QMenu(self._window)
        menu.aboutToHide.connect(menu.deleteLater)
        menu.setToolTipsVisible(True)
        if hit.kind == "curve" and hit.channel is not None:
            insert = menu.addAction(self._window.actions_by_id["key.at_playhead"].icon(), "&Insert Key Here")
            insert.setEnabled(self._window.session.editable(hit.channel))
            insert.triggered.connect(partial(self._insert, hit))
        for name in CONTEXT_MENUS[hit.kind]:
            if name == SEPARATOR:
                menu.addSeparator()
            elif name.startswith("menu:"):
                # Its action only: a menu that is added becomes a child here, and Python loses it with this one.
                menu.addAction(self._window.menus[name.removeprefix("menu:")].menuAction())
            else:
                menu.addAction(self._window.actions_by_id[name])
        menu.popup(at)

    def _take_up(self, hit: Hit) -> None:
        """Select the key that was hit unless it is selected; make the channel that was hit the active one."""
        session = self._window.session
        if hit.channel is None:
            return
        session.active = hit.channel
        if hit.kind == "key" and not session.selection.contains(hit.channel, hit.id):
            session.selection = Selection.of_key(hit.channel, hit.id)

    def _insert(self, hit: Hit, _checked: bool = False) -> None:
        channel = hit.channel
        if channel is not None:
            self._window.document.do(
                f"Insert key in {channel.name} at {hit.time:.6g} s",
                lambda clip: edits.insert(clip, channel, hit.time),
                selection=added_keys,
            )
