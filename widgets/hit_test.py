"""What lies under the pointer: keys, handles and curves within a few pixels, the nearest first."""

from collections.abc import Iterator
from enum import Enum, auto
from math import hypot
from typing import NamedTuple
from weakref import WeakKeyDictionary

from model.channel import Channel
from widgets.graph import Graph
from widgets.hit_strips import Near, Strip, strip_width
from widgets.lens import Lens

RADIUS = 8.0


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
    kinds = _test_of(graph).by_kind(graph, x, y, radius)
    return sorted((found.hit(i) for found in kinds for i in range(len(found.kinds))), key=_is_locked)


def hit(graph: Graph, x: float, y: float, cycle: int = 0, radius: float = RADIUS) -> Hit:
    """What a press at a pixel of the plot meets; *cycle* steps through what overlaps of the same kind.

    What is locked covers nothing that can be taken.
    """
    locked: Hit | None = None
    for found in _test_of(graph).by_kind(graph, x, y, radius):
        free = [i for i, channel in enumerate(found.near.owners) if not channel.locked]
        if free:
            return found.hit(free[cycle % len(free)])
        if found.kinds and locked is None:
            locked = found.hit(0)
    return locked or Hit("empty", time=graph.time_from_x(x), value=graph.value_from_y(y))


class Found(NamedTuple):
    """What is near of one sort, what is meant most likely first."""

    kinds: list[str]
    near: Near

    def hit(self, place: int) -> Hit:
        """One of them."""
        channels, ids, times, values, distances = self.near
        return Hit(self.kinds[place], channels[place], ids[place], times[place], values[place], distances[place])


class End(NamedTuple):
    """The end of a tangent on the screen."""

    x: float
    y: float
    kind: str  # "handle_in" or "handle_out"
    channel: Channel
    id: int


class HitTest:
    """What one view remembers between two hovers."""

    def __init__(self) -> None:
        self._axis: tuple[float, ...] = ()
        self._strips: dict[int, Strip] = {}
        self._width = 1
        self._handle_stamp: tuple[object, ...] = ()
        self._handles: list[End] = []

    def by_kind(self, graph: Graph, x: float, y: float, radius: float) -> Iterator[Found]:
        """Keys, handles and curves within the radius, worked out as they are asked for."""
        session = graph.document.session
        channels = session.shown_channels(graph.document.clip)
        if not channels:
            return
        lens = Lens(graph)
        strip = self._strip(lens, channels, x)
        keys = strip.keys_near(lens, session.selection, x, y, radius)
        yield Found(["key"] * len(keys.ids), keys)
        yield self._handles_near(graph, lens, x, y, radius)
        curves = strip.curves_near(lens, session.active, x, y, radius)
        yield Found(["curve"] * len(curves.ids), curves)

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

    def _handles_near(self, graph: Graph, lens: Lens, x: float, y: float, radius: float) -> Found:
        away = [(hypot(end.x - x, end.y - y), i) for i, end in enumerate(self._handle_ends(graph, lens))]
        near = sorted(pair for pair in away if pair[0] <= radius)
        ends = [self._handles[i] for _, i in near]
        times, values = [lens.time(end.x) for end in ends], [lens.value(end.y) for end in ends]
        found = Near([end.channel for end in ends], [end.id for end in ends], times, values, [pair[0] for pair in near])
        return Found([end.kind for end in ends], found)

    def _handle_ends(self, graph: Graph, lens: Lens) -> list[End]:
        """The ends of the tangents as the view draws them."""
        selection = graph.document.session.selection
        if not selection:
            return []
        window = (*self._axis, lens.top, lens.bottom, lens.v0, lens.v1)
        # No key is selected of a channel that is not shown.
        stamp = (window, selection, [(channel, channel.revision, channel.locked) for channel in selection.channels])
        if stamp != self._handle_stamp:
            handles = [
                End(*end, kind, drawn.channel, drawn.id)
                for drawn in graph.drawn_handles()
                for kind, end in (("handle_in", drawn.into), ("handle_out", drawn.out))
                if end is not None
            ]
            self._handle_stamp, self._handles = stamp, handles
        return self._handles


def _is_locked(hit: Hit) -> bool:
    return hit.channel is not None and hit.channel.locked


def _test_of(graph: Graph) -> HitTest:
    test = _TESTS.get(graph)
    if test is None:
        test = _TESTS[graph] = HitTest()
    return test


_TESTS: WeakKeyDictionary[Graph, HitTest] = WeakKeyDictionary()
