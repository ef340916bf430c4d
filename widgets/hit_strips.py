"""Strip: keys and curves of all shown channels in a strip of the view, ready to be asked what is near a pixel.

Keys lie merged in time order, and curves as straight segments of two pixels, so that a hover looks at a few of them
only. What was read of a channel counts as long as its revision is the same; a channel that has changed since is asked
itself, each time, for what lies around the pointer. A strip is thrown away when the time axis moves.
"""

from dataclasses import dataclass
from math import inf
from operator import attrgetter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.channel import Channel
from model.keyframe import TangentRule
from model.selection import Selection
from model.within import SpansWithin
from widgets.hit_segments import (
    NO_SEGMENTS,
    SEGMENT,
    Box,
    begun_within,
    box_around,
    cut,
    nearest_points,
    outside,
    segments_near,
    touching,
)
from widgets.lens import Lens

# Strips are as wide as one pass over the channels is worth, narrower where a channel alone fills them with keys, and
# overlap by more than the radius of a hit; pixels.
WIDE, NARROW = 128, 16
MARGIN = 16
MANY_KEYS = 20_000
MAX_NEAR = 32
# How much nearer an unselected thing must be than a selected one to be preferred, pixels.
PREFERENCE = 4.0
# With more keys than this in a strip, thousands a pixel, nobody can mean one of them: the curve is met, no key.
MOST_KEYS = 100_000
# With more channels changed than this, all are merged anew. Up to so many that are full of keys are never merged: to
# ask them for what lies around the pointer takes less time than to read a strip.
MOST_LOOSE = 8

type Floats = NDArray[np.float64]
type Ints = NDArray[np.int64]
type Flags = NDArray[np.bool_]

NO_IDS: Ints = np.empty(0, np.int64)
_revision = attrgetter("revision")


@dataclass(slots=True)
class _Row:
    """One channel in one strip: its keys there, one more on each side, and its curve beyond its ends there."""

    channel: Channel
    revision: int
    numbers: Floats  # (4, n): time, value, slope in, slope out
    ids: Ints
    held: NDArray[np.bool_]
    outside: Floats  # (4, m): segments as time0, value0, time1, value1


class Near(NamedTuple):
    """What was found, what is meant most likely first: channels, ids (0 for curves), times, values, pixels away."""

    owners: list[Channel]
    ids: list[int]
    times: list[float]
    values: list[float]
    distances: list[float]


NOTHING = Near([], [], [], [], [])


def strip_width(lens: Lens, channels: list[Channel]) -> int:
    """Pixels of the strips into which the view is best cut."""
    keys = sum(channel.count_between(lens.t0, lens.t1) for channel in channels)
    return NARROW if keys > MANY_KEYS * len(channels) else WIDE


class Strip:
    """*width* pixel columns of the view from the one at *left* on, and a margin on each side."""

    def __init__(self, lens: Lens, left: float, width: int) -> None:
        self.columns = lens.time(left - MARGIN + np.arange(0.0, width + 2 * MARGIN + SEGMENT, SEGMENT))
        self.times = float(self.columns[0]), float(self.columns[-1])
        self.segment = float(self.columns[1] - self.columns[0])
        self._narrow = width == NARROW
        self._channels: list[Channel] = []
        self._revisions: list[int] = []
        self._settled = _Merged([], self.times, self.segment)
        # The places of the channels that are asked themselves; of each that is crowded, its curve.
        self._loose: dict[int, Floats | None] = {}
        self._places: dict[Channel, int] = {}

    def refresh(self, channels: list[Channel]) -> None:
        """Notice what has changed since; read channels anew only where many have."""
        revisions = list(map(_revision, channels))
        same = channels == self._channels
        if same and revisions == self._revisions:
            return
        self._channels, self._revisions = channels, revisions
        if self._narrow and len(channels) <= MOST_LOOSE:
            changed = list(range(len(channels)))
            if self._settled.rows:
                self._settled = _Merged([], self.times, self.segment)
        else:
            settled = self._settled.revisions if same else []
            changed = [i for i, revision in enumerate(settled) if revision != revisions[i]]
            if not settled or len(changed) > MOST_LOOSE:
                self._settle()
                changed = []
        if self._settled.rows:
            self._settled.drop([i for i in changed if i not in self._loose])
        self._loose = {i: self._upright(channels[i]) for i in changed}
        if not same:
            self._places = {channel: i for i, channel in enumerate(channels)}

    def _settle(self) -> None:
        known = {row.channel: row for row in self._settled.rows}
        rows = [
            row if (row := known.get(channel)) and row.revision == channel.revision else self._read(channel)
            for channel in self._channels
        ]
        self._settled = _Merged(rows, self.times, self.segment)

    def _upright(self, channel: Channel) -> Floats | None:
        """The curve of a channel that is crowded here, as upright segments; None if it is not crowded."""
        if len(channel) <= MOST_KEYS or channel.count_between(*self.times) <= MOST_KEYS:
            return None
        middles = (self.columns[:-1] + self.columns[1:]) / 2
        low, high = channel.envelope(self.columns)
        return np.array([middles, low, middles, high])

    def _read(self, channel: Channel) -> _Row:
        upright = self._upright(channel)
        if upright is not None:
            return _Row(channel, channel.revision, np.empty((4, 0)), NO_IDS, np.zeros(0, np.bool_), upright)
        run = channel.keys_between(*self.times, around=1)
        numbers = np.array([run["time"], run["value"], run["slope_in"], run["slope_out"]])
        held = run["rule_out"] == TangentRule.STEP
        return _Row(channel, channel.revision, numbers, run["id"].copy(), held, outside(channel, self.columns))

    def keys_near(self, lens: Lens, selection: Selection, x: float, y: float, radius: float) -> Near:
        """Keys within the radius; where there are very many the nearest, and the nearest of the selected ones."""
        box = box_around(lens, x, y, radius)
        found = [self._settled.keys_within(box)] if self._settled.rows else []
        for place, upright in self._loose.items():
            if upright is None:
                times, values, ids = self._channels[place].keys_within(*box)
                if len(ids):
                    found.append(part := np.empty((4, len(ids))))
                    part[0], part[1], part[2], part[3] = times, values, ids, place
        if not found:
            return NOTHING
        keys = np.concatenate(found, axis=1) if len(found) > 1 else found[0]
        distances = np.hypot(lens.x(keys[0]) - x, lens.y(keys[1]) - y)
        (near,) = (distances <= radius).nonzero()
        if not len(near):
            return NOTHING
        keys, distances = keys.take(near, axis=1), distances.take(near)
        chosen = self._selected(selection, keys)
        if len(near) > MAX_NEAR:
            kept = distances <= _reach(distances)
            if chosen.any():
                kept |= chosen & (distances <= _reach(distances[chosen]))
            (near,) = kept.nonzero()
            keys, distances, chosen = keys.take(near, axis=1), distances.take(near), chosen.take(near)
        preferred = np.where(chosen, distances, distances + PREFERENCE)
        order = np.lexsort((keys[3], keys[0], distances, preferred))
        times, values, ids, places = keys.take(order, axis=1).tolist()
        return Near(self._channels_at(places), list(map(int, ids)), times, values, distances.take(order).tolist())

    def _channels_at(self, places: list[float]) -> list[Channel]:
        return [self._channels[int(place)] for place in places]

    def _selected(self, selection: Selection, keys: Floats) -> Flags:
        chosen = np.zeros(keys.shape[1], np.bool_)
        wanted = {self._places.get(channel) for channel in selection.channels}
        if len(wanted) > MOST_LOOSE:
            wanted.intersection_update(map(int, keys[3].tolist()))
        for place in wanted.difference((None,)):
            selected, mine = selection.ids(self._channels[place or 0]), keys[3] == place
            if len(selected) > 1:
                ids = keys[2].astype(np.int64)
                mine &= selected.take(selected.searchsorted(ids), mode="clip") == ids
            else:
                mine &= keys[2] == selected[0]
            chosen |= mine
        return chosen

    def curves_near(self, lens: Lens, active: Channel | None, x: float, y: float, radius: float) -> Near:
        """The nearest point of every curve within the radius; of very many curves, the nearest."""
        box = box_around(lens, x, y, radius, self.segment)
        found = [self._settled.segments_within(box)] if self._settled.rows else []
        for place, upright in self._loose.items():
            segments = self._segments_of(self._channels[place], upright, box)
            if segments.shape[1]:
                found.append((np.full(segments.shape[1], place), segments))
        if not found:
            return NOTHING
        owners = np.concatenate([part[0] for part in found])
        segments = np.concatenate([part[1] for part in found], axis=1)
        if not len(owners):
            return NOTHING
        points = nearest_points(lens, segments, x, y)
        (inside,) = (points.distances <= radius).nonzero()
        inside = inside[np.argsort(points.distances[inside], kind="stable")]
        _, first = np.unique(owners[inside], return_index=True)
        best = inside[first]
        best = best[points.distances[best] <= _reach(points.distances[best])]
        distances, curves = points.distances[best], self._channels_at(owners[best].tolist())
        preferred = distances + [0.0 if curve is active else PREFERENCE for curve in curves]
        best = best[np.lexsort((owners[best], segments[0][best], distances, preferred))]
        columns = (column[best].tolist() for column in points)
        return Near(self._channels_at(owners[best].tolist()), [0] * len(best), *columns)

    def _segments_of(self, channel: Channel, upright: Floats | None, box: Box) -> Floats:
        if upright is not None:
            segments = begun_within(upright, box)
        else:
            segments, ends = segments_near(channel, box, self.times, self.segment), channel.ends()
            if ends is not None and (ends.time0 > box.t0 or ends.time1 <= box.t1):
                beyond = outside(channel, self.columns)
                both = np.concatenate([segments, beyond], axis=1)
                segments = begun_within(both[:, np.argsort(both[0], kind="stable")], box)
        return segments[:, touching(segments, box)] if segments.shape[1] else segments


class _Merged:
    """The rows of several channels in the order of time."""

    def __init__(self, rows: list[_Row], times: tuple[float, float], segment: float) -> None:
        self.rows, self.revisions = rows, [row.revision for row in rows]
        self._times_seen, self._segment = times, segment
        self._dropped: set[int] = set()
        self._segments: tuple[Ints, Floats] | None = None if rows else (NO_IDS, NO_SEGMENTS)
        # (4, n): times, values, ids, places of their channels.
        columns = [np.array([*row.numbers[:2], row.ids, np.full(len(row.ids), i)]) for i, row in enumerate(rows)]
        keys = np.concatenate([NO_SEGMENTS, *columns], axis=1)
        self._keys = keys.take(np.argsort(keys[0], kind="stable"), axis=1)

    def drop(self, places: list[int]) -> None:
        """Leave the channels at these places out from now on: no value is near none."""
        for place in places:
            self._keys[1, self._keys[3] == place] = np.nan
            if self._segments is not None:
                owners, segments = self._segments
                segments[1::2, owners == place] = np.nan
        self._dropped.update(places)

    def keys_within(self, box: Box) -> Floats:
        """The keys in the box, as columns."""
        times = self._keys[0]
        first, last = int(times.searchsorted(box.t0, "left")), int(times.searchsorted(box.t1, "right"))
        values = self._keys[1, first:last]
        (near,) = ((values >= box.low) & (values <= box.high)).nonzero()
        near += first
        found: Floats = self._keys.take(near, axis=1)
        return found

    def segments_within(self, box: Box) -> tuple[Ints, Floats]:
        """The segments that begin in the box and touch its values, and the places of their channels."""
        if self._segments is None:
            self._segments = self._cut_up()
        owners, segments = self._segments
        first, last = int(segments[0].searchsorted(box.t0, "left")), int(segments[0].searchsorted(box.t1, "right"))
        near = touching(segments[:, first:last], box) + first
        return owners[near], segments[:, near]

    def _cut_up(self) -> tuple[Ints, Floats]:
        """The curves in short pieces in the order of time, and their owners, without those that are dropped."""
        rows = [row for i, row in enumerate(self.rows) if i not in self._dropped]
        places = np.array([i for i in range(len(self.rows)) if i not in self._dropped], np.int64)
        numbers = np.concatenate([NO_SEGMENTS, *(row.numbers for row in rows)], axis=1)
        owners = places.repeat([len(row.ids) for row in rows])
        held = np.concatenate([np.zeros(0, np.bool_), *(row.held for row in rows)])
        firsts = np.flatnonzero(owners[1:] == owners[:-1])
        (time0, value0, _, slope0), (time1, value1, slope1, _) = numbers[:, firsts], numbers[:, firsts + 1]
        spans = SpansWithin(time0, value0, slope0, time1, value1, slope1, held[firsts])
        inside, inside_owners = cut(spans, owners[firsts], self._times_seen, self._segment)
        outside_owners = places.repeat([row.outside.shape[1] for row in rows])
        segments = np.concatenate([inside, *(row.outside for row in rows)], axis=1)
        order = np.argsort(segments[0], kind="stable")
        return np.concatenate([inside_owners, outside_owners]).take(order), segments.take(order, axis=1)


def _reach(distances: Floats) -> float:
    """Up to which distance the nearest are; very many only if all are equally near."""
    if len(distances) <= MAX_NEAR:
        return inf
    parted = distances.copy()
    parted.partition(MAX_NEAR - 1)
    return float(parted[MAX_NEAR - 1])
