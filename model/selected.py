"""SelectedRuns: the selected keys as they are, read once for all who ask while nothing changes."""

from model.channel import Channel
from model.keyframe import KeyGoneError, Run
from model.selection import Selection


class SelectedRuns:
    """Remembers the keys of one selection until it, or a channel that it is in, is another."""

    def __init__(self) -> None:
        self._mark: object = None
        self._runs: list[tuple[Channel, Run]] = []

    def of(self, selection: Selection) -> list[tuple[Channel, Run]]:
        """The keys of *selection* by channel, in time order; none at all if one of them is gone."""
        mark = selection, tuple(channel.revision for channel in selection.channels)
        if mark != self._mark:
            try:
                self._runs = [(channel, channel.keys_of(selection.ids(channel))) for channel in selection.channels]
            except KeyGoneError:  # deleted a moment ago; the selection follows
                self._runs = []
            self._mark = mark
        return self._runs
