"""Playback: the playhead runs by the clock on the wall; frames may be skipped, time is never stretched."""

from collections.abc import Callable
from math import ceil, floor
from time import perf_counter
from typing import Final

from PySide6.QtCore import QObject, Qt, QTimer, Signal

from model.channel import Channel
from model.document import Document
from model.keyframe import Keyframe

TICK: Final = 8  # milliseconds between two looks at the clock: every picture of a screen of 120 Hz is a new one
SAME_FRAME: Final = 1e-6  # a playhead so near to a whole frame (in frames) stands on it


class Playback(QObject):
    """Plays, stops and steps; the playhead itself is the session's, and may be dragged while it runs."""

    status = Signal(str)

    def __init__(
        self, document: Document, parent: QObject | None = None, clock: Callable[[], float] = perf_counter
    ) -> None:
        super().__init__(parent)
        self._document = document
        self._session = document.session
        self._clock = clock
        self._anchor = (0.0, 0.0)  # (clock, playhead) of which the time follows
        self._last = 0.0
        self._came_from: float | None = None
        self._timer = QTimer(self)
        self._timer.setInterval(TICK)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self.tick)
        self._session.option_changed.connect(self._option_changed)
        document.clip_replaced.connect(self._clip_replaced)

    def range(self) -> tuple[float, float]:
        """What is played: the clip's range, else the times of all keys."""
        clip = self._document.clip
        if clip.end > clip.start:
            return clip.start, clip.end
        return clip.extent() or (clip.start, clip.start)

    def toggle_play(self) -> None:
        """Play from the playhead, or pause there."""
        self._session.playing = not self._session.playing

    def stop(self) -> None:
        """Stop and go back to where playing began; when already stopped, to the start."""
        back, self._came_from = self._came_from, None
        self._session.playing = False
        self._session.playhead = self.range()[0] if back is None else back

    def to_start(self) -> None:
        """Go to the start of the range."""
        self._session.playhead = self.range()[0]

    def to_end(self) -> None:
        """Go to the end of the range."""
        self._session.playhead = self.range()[1]

    def step_frame(self, frames: int) -> None:
        """Go so many whole frames on (or back); from between two frames the first step ends on the next one."""
        clip = self._document.clip
        frame = clip.frame_of(self._session.playhead)
        self._session.playing = False
        whole = round(frame)
        if abs(frame - whole) > SAME_FRAME:
            whole = floor(frame) if frames > 0 else ceil(frame)
        self._session.playhead = clip.time_of(whole + frames)

    def step_key(self, direction: int) -> None:
        """Go to the next (1) or previous (-1) key of the selected channels, else of the active, else of all shown."""
        now = self._session.playhead
        self._session.playing = False
        times = [key.time for channel in self._channels() if (key := _key_beside(channel, now, direction)) is not None]
        if times:
            self._session.playhead = min(times) if direction > 0 else max(times)
        else:
            self.status.emit(f"No key {'after' if direction > 0 else 'before'} the playhead")

    def tick(self) -> None:
        """Put the playhead where the clock says it is."""
        if self._document.working:
            return
        session, now = self._session, self._clock()
        if session.playhead != self._last:  # somebody moved it: go on from there
            self._anchor = (now, session.playhead)
        time = self._anchor[1] + now - self._anchor[0]
        start, end = self.range()
        if time >= end:
            if not session.loop or end <= start:
                session.playing = False
                session.playhead = end
                return
            time = start + (time - start) % (end - start)
            self._anchor = (now, time)
        session.playhead = self._last = time

    def _channels(self) -> list[Channel]:
        session = self._session
        if session.selection:
            return list(session.selection.channels)
        if session.active is not None and session.shown(session.active):
            return [session.active]
        return session.shown_channels(self._document.clip)

    def _option_changed(self, name: str) -> None:
        if name != "playing":
            return
        if self._session.playing:
            self._begin()
        elif self._timer.isActive():
            self._timer.stop()
            self._come_to_rest()

    def _come_to_rest(self) -> None:
        """With snapping on, stand on the nearest whole frame, but not on one outside of what is played."""
        session = self._session
        if session.snap:
            start, end = self.range()
            time = session.snap_time(self._document.clip, session.playhead)
            inside = start <= session.playhead <= end
            session.playhead = min(max(time, start), end) if inside else time

    def _begin(self) -> None:
        start, end = self.range()
        if end <= start:
            self._session.playing = False
            self.status.emit("Nothing to play: the clip has no length")
            return
        self._came_from = self._session.playhead
        if not start <= self._session.playhead < end:
            self._session.playhead = start
        self._last = self._session.playhead
        self._anchor = (self._clock(), self._last)
        self._timer.start()

    def _clip_replaced(self) -> None:
        self._session.playing = False
        self._came_from = None


def _key_beside(channel: Channel, time: float, direction: int) -> Keyframe | None:
    before, after = channel.neighbours(time)
    if direction > 0:
        return after
    return before.previous if before is not None and before.time >= time else before
