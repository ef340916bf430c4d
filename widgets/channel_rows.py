"""ChannelRows: the channels of a clip as a tree of groups; values are worked out only where they are seen."""

from collections.abc import Callable, Iterable, Sequence
from enum import IntEnum
from typing import Any, Final, NamedTuple

from PySide6.QtCore import QAbstractItemModel, QModelIndex, QObject, QPersistentModelIndex, Qt

from model.channel import Channel
from model.document import Document
from widgets.guard import guarded
from widgets.numbers import factor_of, is_angle, steady

type Index = QModelIndex | QPersistentModelIndex
Role = Qt.ItemDataRole


class Column(IntEnum):
    """From left to right."""

    NAME = 0
    VALUE = 1
    SHOW = 2
    LOCK = 3
    SOLO = 4


SELECTABLE: Final = Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable
EDITABLE: Final = SELECTABLE | Qt.ItemFlag.ItemIsEditable


class Toggle(NamedTuple):
    """A column that is clicked: its icons, its words on and off, what it does."""

    icon_on: str
    icon_off: str
    on: str
    off: str
    tip: str


TOGGLES = {
    Column.SHOW: Toggle("eye", "eye-off", "shown", "hidden", "Show or hide"),
    Column.LOCK: Toggle("lock", "unlock", "locked", "not locked", "Lock against editing, or unlock"),
    Column.SOLO: Toggle("solo", "solo", "solo", "not solo", "Show only the channels with this mark"),
}


class Group(NamedTuple):
    """Channels of one dotted prefix, or one channel that has none."""

    name: str
    channels: list[Channel]
    is_channel: bool


def grouped(channels: Iterable[Channel]) -> list[Group]:
    """The channels in the clip's order, each group where its first channel stands."""
    groups: list[Group] = []
    places: dict[str, Group] = {}
    for channel in channels:
        prefix = channel.group
        if not prefix:
            groups.append(Group(channel.name, [channel], True))
        elif prefix in places:
            places[prefix].channels.append(channel)
        else:
            places[prefix] = Group(prefix, [channel], False)
            groups.append(places[prefix])
    return groups


class ChannelRows(QAbstractItemModel):
    """Two levels: groups and lone channels, and the channels of each group."""

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._groups: list[Group] = []
        self._places: dict[Channel, tuple[int, int]] = {}
        self._ranks: dict[Channel, int] = {}
        self.rename: Callable[[dict[Channel, str]], bool] = lambda names: False

    def show(self, words: Sequence[str]) -> None:
        """Take the channels of the clip whose full names hold all *words*; the view is reset."""
        channels = self._document.clip.channels
        folded = [word.casefold() for word in words]
        kept = [c for c in channels if all(word in c.name.casefold() for word in folded)] if folded else channels
        self.beginResetModel()
        self._groups = grouped(kept)
        self._ranks = {channel: rank for rank, channel in enumerate(channels)}
        self._places = {
            channel: (row, -1 if group.is_channel else place)
            for row, group in enumerate(self._groups)
            for place, channel in enumerate(group.channels)
        }
        self.endResetModel()

    @property
    def groups(self) -> Sequence[Group]:
        """The rows of the upper level."""
        return self._groups

    def rank(self, channel: Channel) -> int:
        """The channel's place in the clip, which its colour goes by."""
        return self._ranks.get(channel, 0)

    def channel_of(self, index: Index) -> Channel | None:
        """The channel in this row, None for a group."""
        if not index.isValid():
            return None
        if index.internalId():
            return self._groups[index.internalId() - 1].channels[index.row()]
        group = self._groups[index.row()]
        return group.channels[0] if group.is_channel else None

    def channels_of(self, index: Index) -> list[Channel]:
        """The channel in this row, or all of the group."""
        channel = self.channel_of(index)
        if channel is not None:
            return [channel]
        return list(self._groups[index.row()].channels) if index.isValid() else []

    def index_of(self, channel: Channel, column: Column = Column.NAME) -> QModelIndex:
        """Where the channel is; not valid while the filter hides it."""
        row, place = self._places.get(channel, (-1, -1))
        if row < 0:
            return QModelIndex()
        return self.createIndex(row, column, 0) if place < 0 else self.createIndex(place, column, row + 1)

    def part_on(self, channels: Sequence[Channel], column: Column) -> float:
        """How many of the channels have this toggle on: 0 none, 1 all, between some."""
        session = self._document.session
        match column:
            case Column.SHOW:
                on = sum(channel not in session.hidden for channel in channels)
            case Column.LOCK:
                on = sum(channel.locked for channel in channels)
            case _:
                on = sum(channel in session.solo for channel in channels)
        return on / len(channels) if channels else 0.0

    def seen(self, channels: Sequence[Channel]) -> bool:
        """Whether the graph shows any of the channels."""
        return any(self._document.session.shown(channel) for channel in channels)

    def value_text(self, channel: Channel) -> str:
        """The value at the playhead, as shown."""
        if self._document.working:
            return "…"
        value = channel.value(self._document.session.playhead) * factor_of(channel.unit)
        return steady(value) + ("°" if is_angle(channel.unit) else "")

    @guarded(QModelIndex())
    def index(self, row: int, column: int, parent: Index = QModelIndex()) -> QModelIndex:  # noqa: B008
        # Asked for thousands of times by one layout: no call back into Qt that asks here again.
        if not 0 <= column < len(Column) or not 0 <= row < self.rowCount(parent):
            return QModelIndex()
        return self.createIndex(row, column, parent.row() + 1 if parent.isValid() else 0)

    @guarded(QModelIndex())
    def parent(self, index: Index = QModelIndex()) -> QModelIndex:  # type: ignore[override]  # noqa: B008
        if not index.isValid() or not index.internalId():
            return QModelIndex()
        return self.createIndex(index.internalId() - 1, 0, 0)

    @guarded(0)
    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        if not parent.isValid():
            return len(self._groups)
        if parent.internalId() or parent.column() > 0 or self._groups[parent.row()].is_channel:
            return 0
        return len(self._groups[parent.row()].channels)

    @guarded(len(Column))
    def columnCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        return len(Column)

    @guarded(Qt.ItemFlag.NoItemFlags)
    def flags(self, index: Index) -> Qt.ItemFlag:
        if not index.isValid():
            return Qt.ItemFlag.NoItemFlags
        return EDITABLE if index.column() == Column.NAME else SELECTABLE

    @guarded()
    def data(self, index: Index, role: int = Role.DisplayRole) -> Any:
        if not index.isValid():
            return None
        channels, column = self.channels_of(index), Column(index.column())
        channel = self.channel_of(index)
        if column == Column.NAME:
            return self._name_data(index, channel, role)
        if column == Column.VALUE:
            return self.value_text(channel) if channel is not None and role == Role.DisplayRole else None
        return self._toggle_data(channels, column, role)

    def _name_data(self, index: Index, channel: Channel | None, role: int) -> Any:
        name = channel.name if channel is not None else self._groups[index.row()].name
        if role == Role.DisplayRole:
            return channel.leaf if channel is not None else name
        if role in (Role.EditRole, Role.ToolTipRole):
            return name
        if role == Role.AccessibleTextRole:
            return f"channel {name}" if channel is not None else f"group {name}"
        return None

    def _toggle_data(self, channels: Sequence[Channel], column: Column, role: int) -> Any:
        toggle = TOGGLES[column]
        if role == Role.ToolTipRole:
            return toggle.tip
        if role == Role.AccessibleTextRole:
            part = self.part_on(channels, column)
            return toggle.on if part == 1 else toggle.off if part == 0 else f"some {toggle.on}"
        return None

    @guarded(False)
    def setData(self, index: Index, value: Any, role: int = Role.EditRole) -> bool:
        if role != Role.EditRole or index.column() != Column.NAME:
            return False
        text = str(value).strip()
        channel = self.channel_of(index)
        if channel is not None:
            return self.rename({channel: text})
        old = self._groups[index.row()].name
        return self.rename({c: f"{text}.{c.leaf}" for c in self._document.clip.channels if c.group == old})
