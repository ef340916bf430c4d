"""Player: plays a clip in sequence with cursors of its own, so that many players can share one clip."""

from operator import attrgetter

import numpy as np

from model.channel import Channel
from model.clip import Clip
from model.extrapolation import EXTRAPOLATIONS, Ends
from model.hermite import LARGEST, Floats

# Spans that a cursor holds ahead of the playhead.
AHEAD = 32

_revision = attrgetter("revision")


class Player:
    """Gives the pose of a clip at one time after the other; it notices edits, and channels that come or go, by itself.

    The cost of a pose depends on the number of channels, not on their length: all cursors are evaluated together in
    numpy, and a channel is searched only when the time leaves the spans that its cursor holds.
    """

    def __init__(self, clip: Clip) -> None:
        self.clip = clip
        self._channels: list[Channel] = []
        self._revisions: list[int] = []
        self._ends: list[Ends | None] = []
        self._read_all()

    def _read_all(self) -> None:
        """Begin with cursors that hold nothing."""
        self._channels = list(self.clip.channels)
        n = len(self._channels)
        self._revisions = [-1] * n
        self._ends = [None] * n
        self._first, self._last = np.full(n, -np.inf), np.full(n, np.inf)
        # (time0, time1, d_time, a, b, c, d) of the span each cursor is in, and of those it holds.
        self._now = np.zeros((7, n))
        self._held = np.zeros((n, 7, AHEAD))
        self._count = np.zeros(n, np.int64)

    def pose(self, time: float) -> Floats:
        """The values of all channels at *time* (seconds), in the order of clip.channels: (channels,)."""
        self._notice_edits()
        time = float(time)
        if time != time:
            return np.full(len(self._channels), np.nan)
        times = np.full(len(self._channels), time)
        outside = np.flatnonzero((self._first > time) | (self._last < time)).tolist()
        shifts = self._fold(outside, times)
        gone = np.flatnonzero((times < self._now[0]) | (times >= self._now[1]))
        if len(gone):
            self._advance(gone, times)
        time0, _, d_time, a, b, c, d = self._now
        with np.errstate(all="ignore"):
            u = (times - time0) / d_time
            values = d + u * (c + u * (b + u * a))
        values = np.where(times == time0, d, values)
        for i in np.flatnonzero(~np.isfinite(values)).tolist():
            values[i] = self._channels[i].value(float(times[i]))
        for i, shift in shifts:
            values[i] = min(max(float(values[i]) + shift, -LARGEST), LARGEST)
        return values

    def _notice_edits(self) -> None:
        if self._channels != self.clip.channels:
            self._read_all()
        revisions = list(map(_revision, self._channels))
        if revisions == self._revisions:
            return
        for i, (old, new) in enumerate(zip(self._revisions, revisions, strict=True)):
            if old == new:
                continue
            ends = self._ends[i] = self._channels[i].ends()
            self._first[i], self._last[i] = (ends.time0, ends.time1) if ends else (-np.inf, np.inf)
            # A span that no time is in: the cursor is looked up at the next pose. Without keys: 0 for ever.
            self._now[:, i] = (np.inf, -np.inf, 1.0, 0.0, 0.0, 0.0, 0.0) if ends else (-np.inf, np.inf, 1.0, 0, 0, 0, 0)
            self._count[i] = 0
        self._revisions = revisions

    def _fold(self, outside: list[int], times: Floats) -> list[tuple[int, float]]:
        """Bring the times of the channels that are beyond their keys back among them: (channel, shift) where not 0."""
        shifts = []
        for i in outside:
            channel, ends = self._channels[i], self._ends[i]
            if ends is None:
                continue
            time = float(times[i])
            mode = channel.pre if time < ends.time0 else channel.post
            times[i], shift = EXTRAPOLATIONS[mode].fold_one(time, ends)
            if shift:
                shifts.append((i, shift))
        return shifts

    def _advance(self, gone: np.ndarray[tuple[int], np.dtype[np.int64]], times: Floats) -> None:
        """Move the cursors that the time has left."""
        held = self._held[gone]
        passed = (held[:, 1] <= times[gone, None]).sum(axis=1)
        lost = (times[gone] < held[:, 0, 0]) | (passed >= self._count[gone])
        for k in np.flatnonzero(lost).tolist():
            i = int(gone[k])
            spans = self._channels[i].spans_from(float(times[i]), AHEAD)
            count = spans.shape[1]
            self._held[i, :, :count] = spans
            # Spans end later and later, and what is not held never ends: so the count of those that ended is a place.
            self._held[i, 1, count:] = np.inf
            self._count[i] = count
            passed[k] = 0
        self._now[:, gone] = self._held[gone, :, passed].T
