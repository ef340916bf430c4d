"""Stage: what the layers read to draw one picture."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QFont, QFontMetricsF

from model.channel import Channel
from model.document import Document
from model.keyframe import Run
from model.sampling import Window, keys_in
from model.selection import Ids, Selection
from widgets.chosen import ManySelected, Reading, Seen, Sight
from widgets.graph import Frame
from widgets.hit_test import Hit
from widgets.numbers import is_angle
from widgets.theme import Theme
from widgets.ticks import Ticks, ticks_of
from widgets.traces import Trace
from widgets.words import Words, words_in

if TYPE_CHECKING:
    from widgets.layers.drawings import Drawing
    from widgets.layers.handles import Box, Handles, Hands


@dataclass(slots=True)
class Overlay:
    """What is drawn over the curves and belongs to the pointer; in logical viewport pixels."""

    hover: Hit | None = None
    box: QRectF | None = None
    frame: Frame | None = None
    preview: tuple[Channel, float] | None = None
    # What is going on meanwhile, said where there is nothing to see yet.
    notice: str = ""


# The size of the rulers' numbers beside the view's font.
LABEL_SIZE: Final = 0.88


# Among many curves hard lines through up to so many keys in each pixel column take the place of what it covers exactly:
# they may lie in the column beside it, but that would take three times as long.
HARD: Final = 3.0
# Keys nearer to each other than this on average leave no room for marks, or for dashes, which every key begins anew.
CROWD: Final = 3.0
UNDASHED: Final = 4.0
# With more keys in each pixel column, selected ones are what they cover there.
MERGED: Final = 4.0


class Manner(NamedTuple):
    """How a channel is drawn for its number of keys in the window; when this changes, all of it looks different."""

    columns: bool
    hard_columns: bool  # of hard lines among many
    undashed: bool
    unmarked: bool
    merged: bool


class Label(NamedTuple):
    """A channel's name at the end of its line; the box is in screen pixels."""

    trace: Trace
    text: str
    box: tuple[float, float, float, float]


@dataclass(slots=True)
class Stage:
    """One picture: the window in screen pixels, the traces at rest and those under the hand."""

    document: Document
    theme: Theme
    window: Window
    resting: tuple[Trace, ...]
    live: tuple[Trace, ...]
    overlay: Overlay
    time_ticks: Ticks
    value_ticks: Ticks
    base_font: QFont
    labels: tuple[Label, ...] = ()
    hint: str = ""
    # A channel, and a time at which it is seen in the window.
    seen: tuple[Channel, float] | None = None
    # Where the handles that have been painted last are, in screen pixels.
    arms: dict[Channel, list["Box"]] = field(default_factory=dict)
    # Curves that are worked out already, and those that were painted last, where they will be asked for again.
    ready: dict[Channel, "Drawing"] = field(default_factory=dict)
    painted: dict[Channel, "Drawing"] = field(default_factory=dict)
    # How each channel was drawn, and at which revision; shared by the stages of one window.
    manners: dict[Channel, tuple[int, Manner]] = field(default_factory=dict)
    # The few selected keys as they were read last, and their handles.
    readings: dict[Channel, Reading] = field(default_factory=dict)
    hands: dict[Channel, "Hands"] = field(default_factory=dict)
    # What very many selected keys cover, and whether they were all of their channel when they were painted last.
    sights: dict[Channel, Sight] = field(default_factory=dict)
    wholly: dict[Channel, bool] = field(default_factory=dict)
    # More than a few selected keys: those in view channel by channel, what is seen of all, and their handles in view.
    seen_keys: dict[Channel, Seen] = field(default_factory=dict)
    many_selected: ManySelected | None = None
    many_handles: "tuple[ManySelected, list[tuple[Trace, Handles]]] | None" = None
    # The channels with keys.
    filled: set[Channel] = field(init=False)
    # That of the value ruler.
    unit: str = field(init=False)
    _words: dict[float, Words] = field(default_factory=dict)
    _chosen: tuple[Selection, tuple[tuple[Trace, Ids], ...]] | None = None
    _by_channel: dict[Channel, Trace] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._by_channel = {trace.channel: trace for trace in (*self.resting, *self.live)}
        self.filled = {channel for channel in self._by_channel if len(channel)}
        self.unit = unit_of(tuple(self._by_channel.values()))

    def trace_of(self, channel: Channel) -> Trace | None:
        """How the channel is drawn; None if it is not shown."""
        return self._by_channel.get(channel)

    @property
    def chosen(self) -> tuple[tuple[Trace, Ids], ...]:
        """The shown channels with selected keys, and the ids of these."""
        selection = self.selection
        if self._chosen is None or self._chosen[0] is not selection:
            found = ((self._by_channel.get(channel), selection.ids(channel)) for channel in selection.channels)
            self._chosen = selection, tuple((trace, ids) for trace, ids in found if trace is not None)
        return self._chosen[1]

    @classmethod
    def at(cls, stage: "Stage", window: Window) -> "Stage":
        """The same stage seen through another window."""
        if window == stage.window:
            return stage
        ticks = ticks_of(window, stage.words(LABEL_SIZE).width, degrees=stage.degrees)
        own: dict[str, Any] = {
            name: {} for name in ("manners", "sights", "seen_keys", "wholly", "hands", "ready", "painted")
        }
        own |= {"many_selected": None, "many_handles": None}
        return replace(stage, window=window, time_ticks=ticks[0], value_ticks=ticks[1], **own)

    def manner_of(self, channel: Channel) -> Manner:
        """How the channel is to be drawn."""
        known = self.manners.get(channel)
        if known is None or known[0] != channel.revision:
            known = self.manners[channel] = (channel.revision, manner_in(self.window, channel))
        return known[1]

    def in_columns(self, trace: Trace) -> bool:
        """Whether a curve is drawn as what it covers of each pixel column."""
        manner = self.manner_of(trace.channel)
        return manner.hard_columns if trace.among_many and not trace.soft else manner.columns

    @property
    def degrees(self) -> bool:
        """Whether values are read in degrees, where radians are stored."""
        return is_angle(self.unit)

    @property
    def selection(self) -> Selection:
        """The selected keys."""
        return self.document.session.selection

    def px(self, logical: float) -> float:
        """Screen pixels from logical ones."""
        return logical * self.window.unit

    def font(self, size: float) -> QFont:
        """The view's font at *size* times its normal size, for painting in screen pixels."""
        return self.words(size).font

    def words(self, size: float) -> Words:
        """The words of that font."""
        words = self._words.get(size)
        if words is None:
            words = self._words[size] = words_in(sized(self.base_font, size, self.window.unit))
        return words

    def plot(self) -> QRectF:
        """The plot area in screen pixels."""
        window = self.window
        return QRectF(window.left, window.top, window.width, window.height)

    def scaled(self, point: QPointF) -> QPointF:
        """A logical point in screen pixels."""
        return point * self.window.unit


def manner_in(window: Window, channel: Channel) -> Manner:
    """How a window shows a channel."""
    count, width = keys_in(channel, window), window.width
    dense = count * window.unit
    columns, hard_columns, merged = (count > width * most for most in (1.0, HARD, MERGED))
    return Manner(columns, hard_columns, dense * UNDASHED > width, dense * CROWD > width, merged)


def unit_of(traces: Sequence[Trace]) -> str:
    """The unit of the active channel; without one, the unit that all of these share, else none."""
    units = {trace.channel.unit for trace in traces if trace.active} or {trace.channel.unit for trace in traces}
    return units.pop() if len(units) == 1 else ""


def sized(font: QFont, size: float, unit: float) -> QFont:
    """The font at *size* times its size, however that was set, where *unit* pixels make one on the user's scale."""
    height = font.pixelSize() if font.pixelSize() > 0 else QFontMetricsF(font).ascent() * 1.08
    found = QFont(font)
    found.setPixelSize(max(round(height * size * unit), 1))
    return found


def chosen(run: Run, ids: np.ndarray[Any, np.dtype[np.int64]]) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Which keys of the run are among the sorted *ids*."""
    if not len(ids):
        return np.zeros(len(run), np.bool_)
    at = np.minimum(np.searchsorted(ids, run["id"]), len(ids) - 1)
    return np.asarray(ids[at] == run["id"])
