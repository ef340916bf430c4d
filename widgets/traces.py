"""Trace: how one channel is drawn; who is drawn at rest and who under the hand."""

from collections import Counter
from collections.abc import Iterable, Set
from typing import Final, NamedTuple

from PySide6.QtGui import QColor

from model.channel import Channel
from model.document import Document
from widgets.colors import mix
from widgets.theme import Theme

# With more keys than this in all, hard lines: soft ones cost twice the ink and are lost in a thicket.
MOST_SOFT_KEYS: Final = 20_000
# With more curves than this, whole lines: dashes would make a fabric of them, and the active one stands out anyway.
MOST_DASHED: Final = 24
LOCKED_DASH: Final = (3.0, 3.0)
# A theme's dashes are in widths of a pen that would be so wide; longer dashes keep a curve a curve.
DASH_UNIT: Final = 2.2
DIMMED: Final = 0.28
LOCKED_DIMMED: Final = 0.5
FAINT: Final = 0.34


class Trace(NamedTuple):
    """How one channel is drawn; sizes in logical pixels."""

    channel: Channel
    place: int
    color: QColor
    faint: QColor
    dash: tuple[float, ...]
    width: float
    soft: bool
    active: bool
    among_many: bool = False

    def pixels(self, unit: float) -> int:
        """The line's thickness in whole pixels of the screen, 1 to 4."""
        return min(max(round(self.width * unit), 1), 4)


class Crowd:
    """How many keys the shown channels have in all, kept up to date channel by channel."""

    def __init__(self, channels: Iterable[Channel]) -> None:
        self._counts = {channel: len(channel) for channel in channels}
        self._count = sum(self._counts.values())

    def changed(self, channel: Channel) -> bool:
        """Whether there are now so many or so few keys, since the channel has changed, that all look different."""
        before, after = self._counts.get(channel), len(channel)
        if before is None or before == after:
            return False
        was_soft = self._count <= MOST_SOFT_KEYS
        self._counts[channel] = after
        self._count += after - before
        return was_soft is not (self._count <= MOST_SOFT_KEYS)


def traces_of(document: Document, theme: Theme) -> tuple[Trace, ...]:
    """The shown channels in the order of the clip, the active one last."""
    session = document.session
    shown = [(index, channel) for index, channel in enumerate(document.clip.channels) if session.shown(channel)]
    soft = sum(len(channel) for _, channel in shown) <= MOST_SOFT_KEYS
    dashed = len(shown) <= MOST_DASHED
    active = session.active
    some_active = any(channel is active for _, channel in shown)
    colors = [theme.channel_color(channel, index) for index, channel in shown]
    alike = Counter(color.rgba() for color in colors) if dashed else Counter()
    dashes = theme.channel_dashes(document.clip.channels) if any(count > 1 for count in alike.values()) else []
    mixed: dict[tuple[int, float], tuple[QColor, QColor]] = {}
    traces = []
    for (index, channel), own in zip(shown, colors, strict=True):
        part = LOCKED_DIMMED if channel.locked else DIMMED if some_active and channel is not active else 0.0
        if (look := (own.rgba(), part)) not in mixed:
            color = mix(own, theme.background, part)
            mixed[look] = color, mix(color, theme.background, FAINT)
        color, faint = mixed[look]
        dash: tuple[float, ...] = ()
        if channel.locked and (dashed or channel is active):
            dash = LOCKED_DASH
        elif alike[own.rgba()] > 1:  # a second code beside the colour, only where two of the shown curves have the same
            dash = tuple(DASH_UNIT * length for length in dashes[index])
        width, soft_too = (2.0, True) if channel is active else (1.0, soft)
        traces.append(Trace(channel, index, color, faint, dash, width, soft_too, channel is active, not dashed))
    return tuple(sorted(traces, key=lambda trace: trace.active))


def live_channels(document: Document, touched: Set[Channel], most: int = 24) -> set[Channel]:
    """The channels drawn anew at every step: the active one, those of the gesture, those about to be dragged."""
    session = document.session
    live = set(touched)
    if session.active is not None:
        live.add(session.active)
    chosen = session.selection.channels
    if len(chosen) <= most:
        live.update(chosen)
    return live
