"""Strip: keys and curves of all shown channels in a strip of the view, ready to be asked what is near a pixel.

Keys lie merged in time order, and curves as straight segments of two pixels, so that a hover looks at a few of them
only. A strip reads a channel again when its revision has changed, and is thrown away when the time axis moves.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.channel import Channel
from model.keyframe import TangentRule
from model.selection import Selection
from widgets.lens import Lens

# Strips are as wide as one pass over the channels is worth, narrower where a channel alone fills them with keys, and
# overlap by more than the radius of a hit; pixels.
WIDE, NARROW = 128, 16
MARGIN = 16
MANY_KEYS = 20_000
SEGMENT = 2.0
MAX_NEAR = 32
# With more keys than this in a strip, thousands a pixel, nobody can mean one of them: the curve is met, no key.
MOST_KEYS = 100_000

type Floats = NDArray[np.float64]
type Ints = NDArray[np.int64]
type Flags = NDArray[np.bool_]

# With more channels changed than this, all are merged anew.
MOST_LOOSE = 8
NONE_STALE: Flags = np.zeros(0, np.bool_)


@dataclass(slots=True)
class _Row:
    """One channel in one strip: its keys there, one more on each side, and its curve beyond its ends there."""

    channel: Channel
    revision: int
    numbers: Floats  # (4, n): time, value, slope in, slope out
    ids: Ints
    held: NDArray[np.bool_]
    outside: Floats  # (4, m): segments as time0, value0, time1, value1


class Near:
    """What was found: owners (channels), ids (0 for curves), times, values and distances in pixels, not sorted."""

    def __init__(self, owners: list[Channel], ids: Ints, times: Floats, values: Floats, distances: Floats) -> None:
        self.owners, self.ids, self.times, self.values, self.distances = owners, ids, times, values, distances


NO_SEGMENTS: Floats = np.empty((4, 0))
NO_IDS: Ints = np.empty(0, np.int64)
NOTHING = Near([], NO_IDS, np.empty(0), np.empty(0), np.empty(0))


def strip_width(lens: Lens, channels: list[Channel]) -> int:
    """Pixels of the strips into which the view is best cut."""
    keys = sum(channel.count_between(lens.t0, lens.t1) for channel in channels)
    return NARROW if keys > MANY_KEYS * len(channels) else WIDE


class Strip:
    """*width* pixel columns of the view from the one at *left* on, and a margin on each side."""

    def __init__(self, lens: Lens, left: float, width: int) -> None:
        self.columns = lens.time(left - MARGIN + np.arange(0.0, width + 2 * MARGIN + SEGMENT, SEGMENT))
        self.t0, self.t1 = float(self.columns[0]), float(self.columns[-1])
        self.segment = float(self.columns[1] - self.columns[0])
        self._channels: list[Channel] = []
        self._revisions: list[int] = []
        self._rows: list[_Row] = []
        self._settled = self._merged([])
        # Channels that have changed since: what they were is left out of the settled ones.
        self._loose = self._merged([])
        self._stale = np.zeros(0, np.bool_)

    def refresh(self, channels: list[Channel]) -> None:
        """Read again the channels that have changed since, and no others."""
        revisions = [channel.revision for channel in channels]
        same = channels == self._channels
        if same and revisions == self._revisions:
            return
        known = {row.channel: row for row in self._rows}
        self._rows = [
            row if (row := known.get(channel)) and row.revision == channel.revision else self._read(channel)
            for channel in channels
        ]
        self._channels, self._revisions = channels, revisions
        changed = [i for i, row in enumerate(self._rows) if row is not self._settled.rows[i]] if same else None
        if changed is None or len(changed) > MOST_LOOSE:
            self._settled, changed = self._merged(self._rows), []
        self._loose = self._merged([self._rows[i] for i in changed])
        self._stale = np.zeros(len(self._rows), np.bool_)
        self._stale[changed] = True

    def _merged(self, rows: list[_Row]) -> "_Merged":
        return _Merged(rows, (self.t0, self.t1), self.segment)

    def keys_near(self, lens: Lens, selection: Selection, x: float, y: float, radius: float) -> Near:
        """Keys within the radius; where there are very many the nearest and the selected ones."""
        return _joined(
            self._settled.keys_near(lens, selection, x, y, radius, self._stale),
            self._loose.keys_near(lens, selection, x, y, radius),
        )

    def curves_near(self, lens: Lens, x: float, y: float, radius: float) -> Near:
        """The nearest point of every curve within the radius, by true distance, so that steep spans can be hit too."""
        return _joined(
            self._settled.curves_near(lens, x, y, radius, self._stale), self._loose.curves_near(lens, x, y, radius)
        )

    def _read(self, channel: Channel) -> _Row:
        if channel.count_between(self.t0, self.t1) > MOST_KEYS:
            middles = (self.columns[:-1] + self.columns[1:]) / 2
            low, high = channel.envelope(self.columns)
            upright = np.array([middles, low, middles, high])
            return _Row(channel, channel.revision, np.empty((4, 0)), NO_IDS, np.zeros(0, np.bool_), upright)
        run = channel.keys_between(self.t0, self.t1, around=1)
        numbers = np.array([run["time"], run["value"], run["slope_in"], run["slope_out"]])
        held = run["rule_out"] == TangentRule.STEP
        return _Row(channel, channel.revision, numbers, run["id"].copy(), held, self._outside(channel, numbers[0]))

    def _outside(self, channel: Channel, times: Floats) -> Floats:
        """The curve before the first and after the last key, if *times*, with a key more on each side, end here."""
        parts = []
        if len(times) and times[0] > self.t0:
            parts.append(np.append(self.columns[self.columns < times[0]], min(times[0], self.t1)))
        if len(times) and times[-1] < self.t1:
            parts.append(np.insert(self.columns[self.columns > times[-1]], 0, max(times[-1], self.t0)))
        if not parts:
            return NO_SEGMENTS
        values = [channel.evaluate(part) for part in parts]
        pairs = list(zip(parts, values, strict=True))
        return np.concatenate([np.array([t[:-1], v[:-1], t[1:], v[1:]]) for t, v in pairs], axis=1)


class _Merged:
    """The rows of several channels in the order of time."""

    def __init__(self, rows: list[_Row], times: tuple[float, float], segment: float) -> None:
        self.rows, self.segment = rows, segment
        if not rows:
            return
        self._times_seen = times
        self._cut: tuple[Floats, Ints] | None = None
        if len(rows) == 1:  # in order, as it is
            self.times, self.values, self.ids = rows[0].numbers[0], rows[0].numbers[1], rows[0].ids
            self.key_owners = np.zeros(len(self.ids), np.int64)
            return
        numbers = np.concatenate([row.numbers[:2] for row in rows], axis=1)
        owners = np.repeat(np.arange(len(rows)), [len(row.ids) for row in rows])
        order = np.argsort(numbers[0], kind="stable")
        self.times, self.values = numbers[0][order], numbers[1][order]
        self.ids = np.concatenate([row.ids for row in rows])[order]
        self.key_owners = owners[order]

    def _segments(self) -> tuple[Floats, Ints]:
        """The curves in short pieces in the order of time, and their owners; cut up when asked for first."""
        if self._cut is None:
            rows = self.rows
            numbers = np.concatenate([row.numbers for row in rows], axis=1)
            owners = np.repeat(np.arange(len(rows)), [len(row.ids) for row in rows])
            held = np.concatenate([row.held for row in rows])
            inside, inside_owners = _cut(numbers, held, owners, self._times_seen, self.segment)
            outside_owners = np.repeat(np.arange(len(rows)), [row.outside.shape[1] for row in rows])
            segments = np.concatenate([inside, *(row.outside for row in rows)], axis=1)
            order = np.argsort(segments[0], kind="stable")
            self._cut = segments.take(order, axis=1), np.concatenate([inside_owners, outside_owners]).take(order)
        return self._cut

    def keys_near(
        self, lens: Lens, selection: Selection, x: float, y: float, radius: float, stale: Flags = NONE_STALE
    ) -> Near:
        """As `Strip.keys_near`, without the *stale* owners."""
        if not self.rows:
            return NOTHING
        first = int(self.times.searchsorted(lens.time(x - radius), "left"))
        last = int(self.times.searchsorted(lens.time(x + radius), "right"))
        if first >= last:
            return NOTHING
        low, high = sorted((lens.value(y - radius), lens.value(y + radius)))
        values = self.values[first:last]
        near = _without(stale, np.flatnonzero((values >= low) & (values <= high)) + first, self.key_owners)
        distances = np.hypot(lens.x(self.times[near]) - x, lens.y(self.values[near]) - y)
        inside = distances <= radius
        near, distances = near[inside], distances[inside]
        if len(near) > MAX_NEAR:
            kept = np.argpartition(distances, MAX_NEAR)[:MAX_NEAR]
            kept = np.union1d(kept, np.flatnonzero(self._selected(selection, near))[:MAX_NEAR])
            near, distances = near[kept], distances[kept]
        owners = [self.rows[owner].channel for owner in self.key_owners[near].tolist()]
        return Near(owners, self.ids[near], self.times[near], self.values[near], distances)

    def _selected(self, selection: Selection, places: Ints) -> NDArray[np.bool_]:
        chosen = np.zeros(len(places), np.bool_)
        owners, ids = self.key_owners[places], self.ids[places]
        for owner in np.unique(owners).tolist():
            selected = selection.ids(self.rows[owner].channel)
            if len(selected):
                mine = owners == owner
                at = selected.searchsorted(ids[mine])
                chosen[mine] = selected.take(at, mode="clip") == ids[mine]
        return chosen

    def curves_near(self, lens: Lens, x: float, y: float, radius: float, stale: Flags = NONE_STALE) -> Near:
        """As `Strip.curves_near`, without the *stale* owners."""
        if not self.rows:
            return NOTHING
        segments, segment_owners = self._segments()
        first = int(segments[0].searchsorted(lens.time(x - radius) - self.segment, "left"))
        last = int(segments[0].searchsorted(lens.time(x + radius), "right"))
        if first >= last:
            return NOTHING
        low, high = sorted((lens.value(y - radius), lens.value(y + radius)))
        value0, value1 = segments[1, first:last], segments[3, first:last]
        near = np.flatnonzero((np.maximum(value0, value1) >= low) & (np.minimum(value0, value1) <= high)) + first
        near = _without(stale, near, segment_owners)
        if not len(near):
            return NOTHING
        time0, value0, time1, value1 = segments[:, near]
        with np.errstate(all="ignore"):
            x0, y0 = lens.x(time0) - x, lens.y(value0) - y
            dx, dy = lens.x(time1) - x - x0, lens.y(value1) - y - y0
            along = -(x0 * dx + y0 * dy) / (dx * dx + dy * dy)
            along = np.where(along > 0.0, np.minimum(along, 1.0), 0.0)  # where there is no way along, its start counts
            distances = np.hypot(x0 + along * dx, y0 + along * dy)
        inside = np.flatnonzero(distances <= radius)
        inside = inside[np.argsort(distances[inside], kind="stable")]
        _, nearest = np.unique(segment_owners[near[inside]], return_index=True)
        best = inside[np.sort(nearest)[:MAX_NEAR]]
        owners = [self.rows[owner].channel for owner in segment_owners[near[best]].tolist()]
        times = time0[best] + along[best] * (time1[best] - time0[best])
        values = value0[best] + along[best] * (value1[best] - value0[best])
        return Near(owners, np.zeros(len(best), np.int64), times, values, distances[best])


def _without(stale: Flags, near: Ints, owners: Ints) -> Ints:
    """What is *near* without what stale owners had there."""
    return near[~stale[owners[near]]] if stale.any() else near


def _joined(one: Near, other: Near) -> Near:
    if not other.owners or not one.owners:
        return one if one.owners else other
    columns = (
        np.concatenate(pair)
        for pair in zip(
            (one.ids, one.times, one.values, one.distances),
            (other.ids, other.times, other.values, other.distances),
            strict=True,
        )
    )
    return Near([*one.owners, *other.owners], *columns)


def _cut(
    numbers: Floats, held: NDArray[np.bool_], owners: Ints, times: tuple[float, float], segment: float
) -> tuple[Floats, Ints]:
    """(4, m) segments of the spans between neighbouring keys of one owner, and their owners.

    Spans shorter than a *segment* (seconds) are one; of longer ones only what lies within *times* is cut up.
    """
    spans = np.flatnonzero(owners[1:] == owners[:-1])
    if len(spans) == len(owners) - 1:  # of one owner
        (time0, value0, _, slope0), (time1, value1, slope1, _) = numbers[:, :-1], numbers[:, 1:]
        held, owners = held[:-1], owners[:-1]
    else:
        time0, value0, _, slope0 = numbers.take(spans, axis=1)
        time1, value1, slope1, _ = numbers.take(spans + 1, axis=1)
        held, owners = held[spans], owners[spans]
    low, high = np.maximum(time0, times[0]), np.minimum(time1, times[1])
    with np.errstate(over="ignore"):
        counts = np.ceil((high - low) / segment)
        short = (time1 - time0 <= segment) & ~held
    long = np.flatnonzero(~short & (counts > 0))
    which, step, width = _steps(long, low, high, counts)
    start = low[which] + step * width
    end = np.where(step + 1 == counts[which], high[which], start + width)
    with np.errstate(all="ignore"):
        d_time, d_value = time1[which] - time0[which], value1[which] - value0[which]
        m0, m1 = np.where(held[which], 0.0, slope0[which] * d_time), np.where(held[which], 0.0, slope1[which] * d_time)
        rise = np.where(held[which], 0.0, d_value)
        u0, u1 = (start - time0[which]) / d_time, (end - time0[which]) / d_time
        from_value, to_value = (
            value0[which] + u * (m0 + u * (3 * rise - 2 * m0 - m1 + u * (m0 + m1 - 2 * rise))) for u in (u0, u1)
        )
    jump = np.flatnonzero(held)  # a held span ends in a jump, drawn upright
    ends = np.array([time0, value0, time1, value1])
    segments = (
        ends if short.all() else ends.take(np.flatnonzero(short), axis=1),
        np.array([start, from_value, end, to_value]),
        np.array([time1[jump], value0[jump], time1[jump], value1[jump]]),
    )
    return np.concatenate(segments, axis=1), np.concatenate([owners[short], owners[which], owners[jump]])


def _steps(spans: Ints, low: Floats, high: Floats, counts: Floats) -> tuple[Ints, Floats, Floats]:
    """For each piece of *spans*, cut into *counts* pieces: its span, its number there and its width."""
    pieces = counts[spans].astype(np.int64)
    which = np.repeat(spans, pieces)
    step = np.arange(len(which)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    return which, step.astype(np.float64), (high[which] - low[which]) / counts[which]
