"""A hand on the channel tree: where things are, how they are clicked, what they read."""

from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.keyframe import make_run
from widgets.channel_rows import Column
from widgets.channel_tree import ChannelTree
from widgets.theme import Theme

NAMES = ("root.tx", "root.ty", "root.tz", "blink", "head.rx", "head.ry")


def six_channels() -> Document:
    """Two groups and a lone channel; channel number n goes from n to n + 1 in the first second."""
    channels = [Channel(name, make_run([0, 1], [rank, rank + 1])) for rank, name in enumerate(NAMES)]
    channels[4].unit = "angle"
    return Document(Clip(channels, end=1))


def tree_of(document: Document, qtbot: QtBot) -> ChannelTree:
    """A tree in a window of its own that has the focus."""
    widget = ChannelTree(document, Theme("dark"))
    qtbot.addWidget(widget)
    widget.resize(300, 400)
    widget.show()
    widget.activateWindow()
    qtbot.waitUntil(widget.isActiveWindow)
    return widget


def channel(tree: ChannelTree, name: str) -> Channel:
    """The channel of this name."""
    return tree.document.clip.channel(name)


def names(channels: list[Channel]) -> list[str]:
    """What the channels are called."""
    return [channel.name for channel in channels]


def center(tree: ChannelTree, name: str, column: Column = Column.NAME) -> QPoint:
    """The middle of a cell of a channel's row."""
    return tree.view.visualRect(tree.view.rows.index_of(channel(tree, name), column)).center()


def group_center(tree: ChannelTree, row: int, column: Column = Column.NAME) -> QPoint:
    """The middle of a cell of a group's row."""
    return tree.view.visualRect(tree.view.rows.index(row, column)).center()


def click(tree: ChannelTree, where: QPoint, modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
    """Press and release the left button there."""
    QTest.mouseClick(tree.view.viewport(), Qt.MouseButton.LeftButton, modifiers, where)
