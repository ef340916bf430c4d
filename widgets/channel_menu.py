"""The menu that a right click on channels opens."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPixmap
from PySide6.QtWidgets import QColorDialog, QMenu

from model.channel import Channel
from widgets.channel_verbs import reveal_all, set_color, set_locked, set_shown, set_solo, show_only
from widgets.colors import AXIS_COLORS, CURVE_COLORS
from widgets.theme import Theme

if TYPE_CHECKING:
    from widgets.channel_tree import ChannelTree

COLOR_NAMES = ("Amber", "Sky", "Mint", "Straw", "Rose", "Rust", "Violet")
AXIS_NAMES = ("Red", "Green", "Blue")


def channel_menu(tree: "ChannelTree", channels: Sequence[Channel]) -> QMenu:
    """What can be done to these channels."""
    document, session, theme = tree.document, tree.document.session, tree.theme
    menu = QMenu(tree)
    menu.aboutToHide.connect(menu.deleteLater)

    def add(text: str, icon: str, act: Callable[[], object]) -> None:
        menu.addAction(theme.icon(icon), text, act)

    add("Frame", "frame-all", lambda: tree.frame_requested.emit(channels[0]))
    add("Rename…", "rename", tree.rename_chosen)
    menu.addMenu(_color_menu(tree, channels, menu))
    menu.addSeparator()
    hidden = all(channel in session.hidden for channel in channels)
    add("Show" if hidden else "Hide", "eye" if hidden else "eye-off", partial(set_shown, session, channels, hidden))
    add("Show Only These", "solo", partial(show_only, document, channels))
    solo = all(channel in session.solo for channel in channels)
    add("End Solo" if solo else "Solo", "solo", partial(set_solo, session, channels, not solo))
    add("Reveal All", "eye", partial(reveal_all, session))
    menu.addSeparator()
    locked = all(channel.locked for channel in channels)
    add(
        "Unlock" if locked else "Lock",
        "unlock" if locked else "lock",
        partial(set_locked, document, channels, not locked),
    )
    return menu


def _color_menu(tree: "ChannelTree", channels: Sequence[Channel], parent: QMenu) -> QMenu:
    theme, document = tree.theme, tree.document
    menu = QMenu("Color", parent)
    menu.setIcon(theme.icon("color"))
    colors = zip(COLOR_NAMES + AXIS_NAMES, CURVE_COLORS[theme.name] + AXIS_COLORS[theme.name][0], strict=True)
    for name, color in colors:
        action = menu.addAction(_patch(QColor(color)), name, partial(set_color, document, channels, color))
        action.setCheckable(True)
        action.setChecked(all(channel.color == color for channel in channels))
    menu.addSeparator()
    menu.addAction("Other…", partial(_ask_color, tree, channels))
    menu.addAction("Color by Theme", partial(set_color, document, channels, None))
    return menu


def _ask_color(tree: "ChannelTree", channels: Sequence[Channel]) -> None:
    theme: Theme = tree.theme
    rank = tree.document.clip.channels.index(channels[0])
    color = QColorDialog.getColor(theme.channel_color(channels[0], rank), tree, "Color of the Channel")
    if color.isValid():
        set_color(tree.document, channels, color.name())


def _patch(color: QColor) -> QIcon:
    pixmap = QPixmap(QSize(32, 32))
    pixmap.fill(Qt.GlobalColor.transparent)
    with QPainter(pixmap) as painter:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(color)
        painter.drawRoundedRect(4, 4, 24, 24, 6, 6)
    return QIcon(pixmap)
