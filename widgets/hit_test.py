"""What lies under the pointer: keys, handles and curves within a few pixels, the nearest first."""

from collections.abc import Iterator
from enum import Enum, auto
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from model.channel import Channel
from widgets.graph import Graph
from widgets.hit_strips import Near, Strip, strip_width
from widgets.lens import Lens

RADIUS = 8.0
# How much nearer an unselected thing must be than a selected one to be preferred, pixels.
PREFERENCE = 4.0

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
    """Everything within *radius* pixels: keys, handles, curves, then what is locked; the nearest of each first."""
    found = [hit for kind in _test_of(graph).by_kind(graph, x, y, radius) for hit in kind]
    return sorted(found, key=_is_locked)


def hit(graph: Graph, x: float, y: float, cycle: int = 0, radius: float = RADIUS) -> Hit:
    """What a press at a pixel of the plot meets; *cycle* steps through what overlaps of the same kind.

    What is locked covers nothing that can be taken.
    """
    locked: list[Hit] = []
    for kind in _test_of(graph).by_kind(graph, x, y, radius):
        free = [found for found in kind if not _is_locked(found)]
        if free:
            return free[cycle % len(free)]
        locked += kind
    return locked[0] if locked else Hit("empty", time=graph.time_from_x(x), value=graph.value_from_y(y))


type Owner = tuple[str, Channel, int]  # "handle_in" or "handle_out" of a key

NO_HANDLES: tuple[Floats, list[Owner]] = (np.empty((0, 2)), [])


class HitTest:
    """What one view remembers between two hovers."""

    def __init__(self) -> None:
        self._axis: tuple[float, ...] = ()
        self._strips: dict[int, Strip] = {}
        self._width = 1
        self._handle_stamp: tuple[object, ...] = ()
        self._handles = NO_HANDLES

    def by_kind(self, graph: Graph, x: float, y: float, radius: float) -> Iterator[list[Hit]]:
        """Keys, handles and curves within the radius, worked out as they are asked for."""
        session = graph.document.session
        channels = session.shown_channels(graph.document.clip)
        if not channels:
            return
        lens = Lens(graph)
        strip = self._strip(lens, channels, x)
        chosen, active = session.selection, session.active
        keys = _hits("key", strip.keys_near(lens, chosen, x, y, radius))
        yield sorted(keys, key=lambda hit: (_preferred(hit, chosen.contains(_channel(hit), hit.id)), hit.distance))
        yield self._handles_near(graph, lens, channels, x, y, radius)
        curves = _hits("curve", strip.curves_near(lens, x, y, radius))
        yield sorted(curves, key=lambda hit: _preferred(hit, hit.channel is active))

    def _strip(self, lens: Lens, channels: list[Channel], x: float) -> Strip:
        axis = (lens.left, lens.right, lens.t0, lens.t1)
        if axis != self._axis:
            self._strips.clear()
            self._axis, self._width = axis, strip_width(lens, channels)
        index = int((x - lens.left) // self._width)
        strip = self._strips.get(index)
        if strip is None:
            strip = self._strips[index] = Strip(lens, lens.left + index * self._width, self._width)
        strip.refresh(channels)
        return strip

    def _handles_near(
        self, graph: Graph, lens: Lens, channels: list[Channel], x: float, y: float, radius: float
    ) -> list[Hit]:
        spots, owners = self._handle_spots(graph, lens, channels)
        if not owners:
            return []
        distances = np.hypot(spots[:, 0] - x, spots[:, 1] - y)
        near = np.flatnonzero(distances <= radius)
        hits = []
        for i in near[np.argsort(distances[near], kind="stable")].tolist():
            kind, channel, key_id = owners[i]
            time, value = lens.time(float(spots[i, 0])), lens.value(float(spots[i, 1]))
            hits.append(Hit(kind, channel, key_id, time, value, float(distances[i])))
        return hits

    def _handle_spots(self, graph: Graph, lens: Lens, channels: list[Channel]) -> tuple[Floats, list[Owner]]:
        """The ends of the tangents as the view draws them."""
        selection = graph.document.session.selection
        if not selection:
            return NO_HANDLES
        chosen = [channel for channel in channels if len(selection.ids(channel))]
        window = (*self._axis, lens.top, lens.bottom, lens.v0, lens.v1)
        stamp = (window, selection, chosen, [(channel.revision, channel.locked) for channel in chosen])
        if stamp != self._handle_stamp:
            ends = [
                (end, (kind, drawn.channel, drawn.id))
                for drawn in graph.drawn_handles()
                for kind, end in (("handle_in", drawn.into), ("handle_out", drawn.out))
                if end is not None
            ]
            spots = np.array([end for end, _ in ends]).reshape(-1, 2)
            self._handle_stamp, self._handles = stamp, (spots, [owner for _, owner in ends])
        return self._handles


def _hits(kind: str, near: Near) -> list[Hit]:
    columns = (near.ids.tolist(), near.times.tolist(), near.values.tolist(), near.distances.tolist())
    return [Hit(kind, *columns_of_one) for columns_of_one in zip(near.owners, *columns, strict=True)]


def _channel(hit: Hit) -> Channel:
    assert hit.channel is not None
    return hit.channel


def _is_locked(hit: Hit) -> bool:
    return hit.channel is not None and hit.channel.locked


def _preferred(hit: Hit, chosen: bool) -> float:
    return hit.distance + (0.0 if chosen else PREFERENCE)


def _test_of(graph: Graph) -> HitTest:
    test = _TESTS.get(graph)
    if test is None:
        test = _TESTS[graph] = HitTest()
    return test


_TESTS: WeakKeyDictionary[Graph, HitTest] = WeakKeyDictionary()
