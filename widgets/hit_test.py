"""What lies under the pointer: keys, handles and curves within a few pixels, the nearest first."""

from enum import Enum, auto
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from model.channel import Channel
from widgets.graph import Graph
from widgets.hit_strips import STRIP, Near, Strip

RADIUS = 8.0
# How much nearer an unselected thing must be than a selected one to be preferred, pixels.
PREFERENCE = 4.0
# Above this no view draws a handle for every selected key, and nobody could aim at one.
MAX_HANDLE_KEYS = 400

type Floats = NDArray[np.float64]


class Hit(NamedTuple):
    """What a press would meet: "key", "handle_in", "handle_out", "curve", a part of a ruler, or "empty".

    *time* and *value* are the key's, for a curve those of its nearest point, else the pointer's; *distance*: pixels.
    """

    kind: str
    channel: Channel | None = None
    id: int = 0
    time: float = 0.0
    value: float = 0.0
    distance: float = 0.0

    @property
    def is_handle(self) -> bool:
        """Whether it is the end of a tangent."""
        return self.kind in ("handle_in", "handle_out")


EMPTY = Hit("empty")


class Place(Enum):
    """The parts of the view."""

    PLOT = auto()
    TIME_RULER = auto()
    VALUE_RULER = auto()
    CORNER = auto()


def place(graph: Graph, x: float, y: float) -> Place:
    """The part of the view at a viewport pixel; pixels outside the view belong to the part they are level with."""
    plot = graph.plot_rect
    beside = not plot.left() <= x <= plot.right()
    above = not plot.top() <= y <= plot.bottom()
    if beside and above:
        return Place.CORNER
    return Place.VALUE_RULER if beside else Place.TIME_RULER if above else Place.PLOT


def hit_ruler(graph: Graph, x: float, y: float, radius: float = RADIUS) -> Hit:
    """The playhead, an end of the clip's range, or the ruler; the playhead wins over an end that is not nearer.

    Beside both, on the outer side of the range, the end is meant: else an end under the playhead could not be reached.
    """
    where = place(graph, x, y)
    time, value = graph.time_from_x(x), graph.value_from_y(y)
    if where is not Place.TIME_RULER:
        return Hit("value_ruler" if where is Place.VALUE_RULER else "empty", time=time, value=value)
    document = graph.document
    clip, playhead = document.clip, document.session.playhead
    found = Hit("time_ruler", time=time, value=value, distance=radius)
    to_playhead = abs(x - graph.x_from_time(playhead))
    if to_playhead <= radius:
        found = Hit("playhead", time=playhead, value=value, distance=to_playhead)
    for kind, end, outwards in (("range_start", clip.start, -1.0), ("range_end", clip.end, 1.0)):
        offset = (x - graph.x_from_time(end)) * outwards
        if abs(offset) < found.distance or (abs(offset) == found.distance and offset > 1.0):
            found = Hit(kind, time=end, value=value, distance=abs(offset))
    return found


def hit_all(graph: Graph, x: float, y: float, radius: float = RADIUS) -> list[Hit]:
    """Everything within *radius* pixels: keys, then handles, then curves; selected, then nearest first."""
    test = _TESTS.get(graph)
    if test is None:
        test = _TESTS[graph] = HitTest()
    return test.hit_all(graph, x, y, radius)


def hit(graph: Graph, x: float, y: float, cycle: int = 0, radius: float = RADIUS) -> Hit:
    """What a press at a pixel of the plot meets; *cycle* steps through what overlaps of the same kind."""
    found = hit_all(graph, x, y, radius)
    if not found:
        return Hit("empty", time=graph.time_from_x(x), value=graph.value_from_y(y))
    same = [other for other in found if other.kind == found[0].kind]
    return same[cycle % len(same)]


class HitTest:
    """What one view remembers between two hovers."""

    def __init__(self) -> None:
        self._axis: tuple[float, ...] = ()
        self._strips: dict[int, Strip] = {}
        self._handle_stamp: tuple[object, ...] = ()
        self._handles: tuple[Floats, list[tuple[str, Channel, int]]] = (np.empty((0, 2)), [])

    def hit_all(self, graph: Graph, x: float, y: float, radius: float) -> list[Hit]:
        """See hit_all() of the module."""
        session = graph.document.session
        channels = session.shown_channels(graph.document.clip)
        if not channels:
            return []
        strip = self._strip(graph, channels, x)
        keys = _hits("key", strip.keys_near(graph, x, y, radius))
        curves = _hits("curve", strip.curves_near(graph, x, y, radius))
        chosen, active = session.selection, session.active
        keys.sort(key=lambda hit: (_preferred(hit, chosen.contains(_channel(hit), hit.id)), hit.distance))
        curves.sort(key=lambda hit: _preferred(hit, hit.channel is active))
        found = [*keys, *self._handles_near(graph, channels, x, y, radius), *curves]
        return sorted(found, key=lambda hit: _channel(hit).locked)  # what cannot be grabbed covers nothing that can

    def _strip(self, graph: Graph, channels: list[Channel], x: float) -> Strip:
        left, right = graph.plot_rect.left(), graph.plot_rect.right()
        axis = (left, right, graph.time_from_x(left), graph.time_from_x(right))
        if axis != self._axis:
            self._strips.clear()
            self._axis = axis
        index = int((x - left) // STRIP)
        strip = self._strips.get(index)
        if strip is None:
            strip = self._strips[index] = Strip(graph, index)
        strip.refresh(channels)
        return strip

    def _handles_near(self, graph: Graph, channels: list[Channel], x: float, y: float, radius: float) -> list[Hit]:
        spots, owners = self._handle_spots(graph, channels)
        if not owners:
            return []
        distances = np.hypot(spots[:, 0] - x, spots[:, 1] - y)
        near = np.flatnonzero(distances <= radius)
        hits = []
        for i in near[np.argsort(distances[near], kind="stable")].tolist():
            kind, channel, key_id = owners[i]
            time, value = graph.time_from_x(float(spots[i, 0])), graph.value_from_y(float(spots[i, 1]))
            hits.append(Hit(kind, channel, key_id, time, value, float(distances[i])))
        return hits

    def _handle_spots(self, graph: Graph, channels: list[Channel]) -> tuple[Floats, list[tuple[str, Channel, int]]]:
        """The drawn ends of the tangents of the selected keys in view."""
        session, plot = graph.document.session, graph.plot_rect
        chosen = [channel for channel in channels if len(session.selection.ids(channel))]
        values = (plot.top(), plot.bottom(), graph.value_from_y(plot.top()), graph.value_from_y(plot.bottom()))
        stamp = (self._axis, values, session.selection, [(channel, channel.revision) for channel in chosen])
        if stamp == self._handle_stamp:
            return self._handles
        spots: list[tuple[float, float]] = []
        owners: list[tuple[str, Channel, int]] = []
        for channel, key_id in _selected_in_view(graph, chosen):
            ends = graph.handle_points(channel, key_id)
            for kind, end in zip(("handle_in", "handle_out"), ends, strict=True):
                if end is not None:
                    spots.append(end)
                    owners.append((kind, channel, key_id))
        self._handle_stamp, self._handles = stamp, (np.array(spots).reshape(-1, 2), owners)
        return self._handles


def _selected_in_view(graph: Graph, channels: list[Channel]) -> list[tuple[Channel, int]]:
    """Selected keys between the edges of the view; none if they are too many to have handles."""
    plot, selection = graph.plot_rect, graph.document.session.selection
    t0, t1 = graph.time_from_x(plot.left()), graph.time_from_x(plot.right())
    keys: list[tuple[Channel, int]] = []
    for channel in channels:
        chosen = selection.ids(channel)
        if len(chosen) <= MAX_HANDLE_KEYS:
            run = channel.keys_of([key_id for key_id in chosen.tolist() if key_id in channel])
            inside = run["id"][(run["time"] >= t0) & (run["time"] <= t1)]
        else:
            inside = np.intersect1d(channel.keys_between(t0, t1)["id"], chosen)
        if len(keys) + len(inside) > MAX_HANDLE_KEYS:
            return []
        keys += [(channel, key_id) for key_id in inside.tolist()]
    return keys


def _hits(kind: str, near: Near) -> list[Hit]:
    columns = (near.ids.tolist(), near.times.tolist(), near.values.tolist(), near.distances.tolist())
    return [Hit(kind, *columns_of_one) for columns_of_one in zip(near.owners, *columns, strict=True)]


def _channel(hit: Hit) -> Channel:
    assert hit.channel is not None
    return hit.channel


def _preferred(hit: Hit, chosen: bool) -> float:
    return hit.distance + (0.0 if chosen else PREFERENCE)


_TESTS: WeakKeyDictionary[Graph, HitTest] = WeakKeyDictionary()
