"""Strip: keys and curves of all shown channels in a strip of the view, ready to be asked what is near a pixel.

Keys lie merged in time order, and curves as straight segments of two pixels, so that a hover looks at a few of them
only. A strip reads a channel again when its revision has changed, and is thrown away when the time axis moves.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from model.channel import Channel
from model.keyframe import KEY_DTYPE, Run, TangentRule
from model.selection import Selection
from widgets.graph import Graph

# Strips are as wide as one pass over the channels is worth, and overlap by more than the radius of a hit.
STRIP = 128
MARGIN = 16
SEGMENT = 2.0
MAX_NEAR = 32

type Floats = NDArray[np.float64]
type Ints = NDArray[np.int64]


@dataclass(slots=True)
class _Row:
    """One channel in one strip: its keys there, one more on each side, and its curve beyond its ends there."""

    channel: Channel
    revision: int
    run: Run
    outside: tuple[Floats, Floats, Floats, Floats]


class Near:
    """What was found: owners (channels), ids (0 for curves), times, values and distances in pixels, not sorted."""

    def __init__(self, owners: list[Channel], ids: Ints, times: Floats, values: Floats, distances: Floats) -> None:
        self.owners, self.ids, self.times, self.values, self.distances = owners, ids, times, values, distances


NOTHING = Near([], np.empty(0, np.int64), np.empty(0), np.empty(0), np.empty(0))


class Strip:
    """STRIP pixel columns of the view from *left* on, and a margin on each side."""

    def __init__(self, graph: Graph, index: int) -> None:
        left = graph.plot_rect.left() + index * STRIP - MARGIN
        self.columns = graph.time_from_x(left + np.arange(0.0, STRIP + 2 * MARGIN + SEGMENT, SEGMENT))
        self.t0, self.t1 = float(self.columns[0]), float(self.columns[-1])
        self.segment = float(self.columns[1] - self.columns[0])
        self.rows: list[_Row] = []
        self._merge()

    def refresh(self, channels: list[Channel]) -> None:
        """Read again the channels that have changed since, and no others."""
        rows = self.rows
        if len(rows) == len(channels) and all(
            row.channel is channel and row.revision == channel.revision
            for row, channel in zip(rows, channels, strict=True)
        ):
            return
        known = {row.channel: row for row in rows}
        self.rows = [
            row if (row := known.get(channel)) and row.revision == channel.revision else self._read(channel)
            for channel in channels
        ]
        self._merge()

    def _read(self, channel: Channel) -> _Row:
        run = channel.keys_between(self.t0, self.t1, around=1)
        return _Row(channel, channel.revision, run, self._outside(channel, run))

    def _outside(self, channel: Channel, run: Run) -> tuple[Floats, Floats, Floats, Floats]:
        """Segments (t0, v0, t1, v1) of the curve before the first and after the last key."""
        first, last = channel.first, channel.last
        if first is None or last is None:
            return (np.empty(0),) * 4
        times = [column for column in (self._before(first.time), self._after(last.time)) if len(column) > 1]
        if not times:
            return (np.empty(0),) * 4
        values = [channel.evaluate(column) for column in times]
        return (
            np.concatenate([column[:-1] for column in times]),
            np.concatenate([column[:-1] for column in values]),
            np.concatenate([column[1:] for column in times]),
            np.concatenate([column[1:] for column in values]),
        )

    def _before(self, time: float) -> Floats:
        columns = self.columns[self.columns < time]
        return np.append(columns, time) if time <= self.t1 else columns

    def _after(self, time: float) -> Floats:
        columns = self.columns[self.columns > time]
        return np.insert(columns, 0, time) if time >= self.t0 else columns

    def _merge(self) -> None:
        rows = self.rows
        keys = np.concatenate([row.run for row in rows]) if rows else np.empty(0, KEY_DTYPE)
        owners = np.repeat(np.arange(len(rows)), [len(row.run) for row in rows])
        self._merge_keys(keys, owners)
        self._merge_segments(keys, owners)

    def _merge_keys(self, keys: Run, owners: Ints) -> None:
        times = keys["time"]
        order = np.argsort(times, kind="stable")
        self.times, self.values, self.ids = times[order], keys["value"][order], keys["id"][order]
        self.key_owners = owners[order]

    def _merge_segments(self, keys: Run, owners: Ints) -> None:
        outside = [row.outside for row in self.rows]
        parts = [
            (*_cut(keys, owners, self.t0, self.t1, self.segment),),
            (
                *(np.concatenate([part[i] for part in outside]) if outside else np.empty(0) for i in range(4)),
                np.repeat(np.arange(len(outside)), [len(part[0]) for part in outside]),
            ),
        ]
        time0, value0, time1, value1, segment_owners = (np.concatenate(columns) for columns in zip(*parts, strict=True))
        order = np.argsort(time0, kind="stable")
        self.segments = np.stack([time0, value0, time1, value1])[:, order]
        self.segment_owners = segment_owners[order]

    def keys_near(self, graph: Graph, x: float, y: float, radius: float) -> Near:
        """Keys within the radius; where there are very many the nearest and the selected ones."""
        first = int(self.times.searchsorted(graph.time_from_x(x - radius), "left"))
        last = int(self.times.searchsorted(graph.time_from_x(x + radius), "right"))
        if first >= last:
            return NOTHING
        times, values = self.times[first:last], self.values[first:last]
        distances = np.hypot(graph.x_from_time(times) - x, graph.y_from_value(values) - y)
        near = np.flatnonzero(distances <= radius)
        if len(near) > MAX_NEAR:
            chosen = near[self._selected(graph.document.session.selection, near + first)]
            near = np.union1d(near[np.argpartition(distances[near], MAX_NEAR)[:MAX_NEAR]], chosen[:MAX_NEAR])
        owners = [self.rows[owner].channel for owner in self.key_owners[first + near].tolist()]
        return Near(owners, self.ids[first + near], times[near], values[near], distances[near])

    def _selected(self, selection: Selection, places: Ints) -> NDArray[np.bool_]:
        chosen = np.zeros(len(places), np.bool_)
        owners, ids = self.key_owners[places], self.ids[places]
        for owner in np.unique(owners).tolist():
            mine = owners == owner
            chosen[mine] = np.isin(ids[mine], selection.ids(self.rows[owner].channel))
        return chosen

    def curves_near(self, graph: Graph, x: float, y: float, radius: float) -> Near:
        """The nearest point of every curve within the radius, by true distance, so that steep spans can be hit too."""
        first = int(self.segments[0].searchsorted(graph.time_from_x(x - radius) - self.segment, "left"))
        last = int(self.segments[0].searchsorted(graph.time_from_x(x + radius), "right"))
        if first >= last:
            return NOTHING
        time0, value0, time1, value1 = self.segments[:, first:last]
        with np.errstate(all="ignore"):
            x0, y0 = graph.x_from_time(time0) - x, graph.y_from_value(value0) - y
            dx, dy = graph.x_from_time(time1) - x - x0, graph.y_from_value(value1) - y - y0
            along = np.clip(np.nan_to_num(-(x0 * dx + y0 * dy) / (dx * dx + dy * dy)), 0.0, 1.0)
            distances = np.hypot(x0 + along * dx, y0 + along * dy)
        near = np.flatnonzero(distances <= radius)
        near = near[np.argsort(distances[near], kind="stable")]
        _, nearest = np.unique(self.segment_owners[first + near], return_index=True)
        near = near[nearest]
        times = time0[near] + along[near] * (time1[near] - time0[near])
        values = value0[near] + along[near] * (value1[near] - value0[near])
        owners = [self.rows[owner].channel for owner in self.segment_owners[first + near].tolist()]
        return Near(owners, np.zeros(len(near), np.int64), times, values, distances[near])


def _cut(keys: Run, owners: Ints, t0: float, t1: float, segment: float) -> tuple[Floats, Floats, Floats, Floats, Ints]:
    """Segments (t0, v0, t1, v1, owner) of the spans between neighbouring keys of one owner, within [t0, t1]."""
    spans = np.flatnonzero(owners[1:] == owners[:-1])
    key0, key1, owners = keys[spans], keys[spans + 1], owners[spans]
    start, d_time = key0["time"], key1["time"] - key0["time"]
    low, high = np.maximum(start, t0), np.minimum(key1["time"], t1)
    counts = np.ceil(np.maximum(high - low, 0.0) / segment).astype(np.int64)
    which = np.repeat(np.arange(len(spans)), counts)
    step = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
    width = ((high - low) / np.maximum(counts, 1))[which]
    time0 = low[which] + step * width
    time1 = np.where(step + 1 == counts[which], high[which], time0 + width)
    p0, p1 = key0["value"], key1["value"]
    held = key0["rule_out"] == TangentRule.STEP
    with np.errstate(all="ignore"):
        m0, m1 = d_time * key0["slope_out"], d_time * key1["slope_in"]
        a = np.where(held, 0.0, 2 * p0 - 2 * p1 + m0 + m1)[which]
        b = np.where(held, 0.0, -3 * p0 + 3 * p1 - 2 * m0 - m1)[which]
        c = np.where(held, 0.0, m0)[which]
        u0, u1 = ((time - start[which]) / d_time[which] for time in (time0, time1))
        value0, value1 = (p0[which] + u * (c + u * (b + u * a)) for u in (u0, u1))
    riser = key1["time"][held]  # a held span ends in a jump, drawn upright
    return (
        np.concatenate([time0, riser]),
        np.concatenate([value0, p0[held]]),
        np.concatenate([time1, riser]),
        np.concatenate([value1, p1[held]]),
        np.concatenate([owners[which], owners[held]]),
    )
