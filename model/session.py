"""Session: what is open but not saved: selection, playhead, what is shown, how the tools behave."""

from collections.abc import Iterable
from math import isfinite

from model.channel import Channel
from model.clip import Clip
from model.event import Event
from model.selection import Selection
from model.snapping import snapped_to_frame

# Snapping asks the keys of at most this many channels, so that a drag step costs the same in a big clip.
MOST_CHANNELS_TO_ASK = 16


class Session:
    """The state of one window on a document; each setter tells its listeners only if something is different."""

    def __init__(self) -> None:
        self.selection_changed = Event[()]()
        self.active_changed = Event[()]()
        self.playhead_changed = Event[()]()
        self.visibility_changed = Event[()]()
        self.option_changed = Event[str]()
        self._selection = Selection.NONE
        self._active: Channel | None = None
        self._playhead = 0.0
        self._hidden: frozenset[Channel] = frozenset()
        self._solo: frozenset[Channel] = frozenset()
        self._folded: frozenset[str] = frozenset()
        self._playing = False
        self._loop = True
        self._snap = True
        self._reorder = True
        self._tool = "select"

    # --- what is meant

    @property
    def selection(self) -> Selection:
        """The selected keys; those of channels that are not shown drop out, so that no command touches them unseen."""
        return self._selection

    @selection.setter
    def selection(self, selection: Selection) -> None:
        selection = self._seen(selection)
        if selection != self._selection:
            self._selection = selection
            self.selection_changed.emit()

    @property
    def active(self) -> Channel | None:
        """The channel that the inspector shows and that new keys go to."""
        return self._active

    @active.setter
    def active(self, channel: Channel | None) -> None:
        if channel is not self._active:
            self._active = channel
            self.active_changed.emit()

    @property
    def playhead(self) -> float:
        """The time that is looked at, seconds; ValueError if it is set to what is not finite."""
        return self._playhead

    @playhead.setter
    def playhead(self, time: float) -> None:
        if not isfinite(time):
            raise ValueError(f"the playhead cannot be at {time}")
        if time != self._playhead:
            self._playhead = float(time)
            self.playhead_changed.emit()

    # --- what is shown

    @property
    def hidden(self) -> frozenset[Channel]:
        """The channels whose eye is closed."""
        return self._hidden

    @hidden.setter
    def hidden(self, channels: Iterable[Channel]) -> None:
        self._show(frozenset(channels), self._solo)

    @property
    def solo(self) -> frozenset[Channel]:
        """If there are any, only these channels are shown."""
        return self._solo

    @solo.setter
    def solo(self, channels: Iterable[Channel]) -> None:
        self._show(self._hidden, frozenset(channels))

    def _show(self, hidden: frozenset[Channel], solo: frozenset[Channel]) -> None:
        if (hidden, solo) != (self._hidden, self._solo):
            self._hidden, self._solo = hidden, solo
            before, self._selection = self._selection, self._seen(self._selection)
            if self._selection is not before:
                self.selection_changed.emit()
            self.visibility_changed.emit()

    def _seen(self, selection: Selection) -> Selection:
        """*selection* without the keys of channels that are not shown; the same one if all are."""
        shown = [channel for channel in selection.channels if self.shown(channel)]
        return selection if len(shown) == len(selection.channels) else selection.with_only(shown)

    def shown(self, channel: Channel) -> bool:
        """Whether the graph draws *channel*."""
        return channel not in self._hidden and (not self._solo or channel in self._solo)

    def editable(self, channel: Channel) -> bool:
        """Whether the mouse and the keyboard may change *channel*: it is shown and not locked."""
        return not channel.locked and self.shown(channel)

    def shown_channels(self, clip: Clip) -> list[Channel]:
        """The channels that the graph draws, in the clip's order."""
        hidden, solo = self._hidden, self._solo
        if not hidden and not solo:
            return clip.channels.copy()
        return [channel for channel in clip.channels if channel not in hidden and (not solo or channel in solo)]

    # --- how the tools behave

    @property
    def folded(self) -> frozenset[str]:
        """The groups of the channel tree that are folded away."""
        return self._folded

    @folded.setter
    def folded(self, groups: Iterable[str]) -> None:
        self._set_option("folded", frozenset(groups))

    @property
    def playing(self) -> bool:
        """Whether the playhead runs."""
        return self._playing

    @playing.setter
    def playing(self, yes: bool) -> None:
        self._set_option("playing", bool(yes))

    @property
    def loop(self) -> bool:
        """Whether playing begins again at the end of the range."""
        return self._loop

    @loop.setter
    def loop(self, yes: bool) -> None:
        self._set_option("loop", bool(yes))

    @property
    def snap(self) -> bool:
        """Whether times that the mouse sets snap to whole frames."""
        return self._snap

    @snap.setter
    def snap(self, yes: bool) -> None:
        self._set_option("snap", bool(yes))

    @property
    def reorder(self) -> bool:
        """Whether dragged keys go past their neighbours; if not, they stop short of them."""
        return self._reorder

    @reorder.setter
    def reorder(self, yes: bool) -> None:
        self._set_option("reorder", bool(yes))

    @property
    def tool(self) -> str:
        """What the mouse does now, by the name of its row in the table of tools."""
        return self._tool

    @tool.setter
    def tool(self, name: str) -> None:
        self._set_option("tool", name)

    def _set_option(self, name: str, value: object) -> None:
        if getattr(self, f"_{name}") != value:
            setattr(self, f"_{name}", value)
            self.option_changed.emit(name)

    def snap_time(self, clip: Clip, time: float) -> float:
        """*time* on its nearest whole frame, whether snapping is on or not: the caller knows what Ctrl turned round.

        Where a key of a selected, the active or one of the first shown channels lies on that frame but for rounding,
        that key's own time.
        """
        channels = dict.fromkeys((*self._selection.channels, *((self._active,) if self._active else ())))
        for channel in clip.channels[:MOST_CHANNELS_TO_ASK]:
            if self.shown(channel):
                channels[channel] = None
        return snapped_to_frame(clip, time, list(channels)[:MOST_CHANNELS_TO_ASK])

    # --- what the document asks for

    def settle(self, channels: Iterable[Channel], selection: Selection, active: Channel | None) -> None:
        """Take over *selection* and *active*, forget channels that are not among *channels*, then tell all at once."""
        alive = set(channels)
        before = (self._selection, self._active, self._hidden, self._solo)
        if any(channel not in alive for channel in selection.channels):
            selection = selection.with_only(alive)
        self._active = active if active in alive else None
        self._hidden &= alive
        self._solo &= alive
        self._selection = self._seen(selection)
        if self._selection != before[0]:
            self.selection_changed.emit()
        if self._active is not before[1]:
            self.active_changed.emit()
        if (self._hidden, self._solo) != before[2:]:
            self.visibility_changed.emit()
