"""TurnHandle: the end of a tangent follows the pointer; its slope is what the clip keeps."""

from collections.abc import Iterable
from math import atan2, pi
from typing import Literal

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.document import Change
from widgets.graph import Graph
from widgets.tools.base import EditDrag, Point
from widgets.tools.steering import Steering, slope_text


class TurnHandle(EditDrag):
    """One drag of one handle, even when more keys are selected: slopes of other channels mean something else.

    The slope is that of the line from the key to the pointer in time and value, so it does not depend on the zoom.
    The handle stays on its own side of the key, at least a pixel of time away from the vertical.
    """

    def __init__(self, graph: Graph, start: Point, channel: Channel, key_id: int, side: Literal["in", "out"]) -> None:
        key = channel.key(key_id)
        self.channel, self.id, self.side = channel, key_id, side
        self.sign = -1.0 if side == "in" else 1.0
        self.time, self.value = key.time, key.value
        self.slope = self.start_slope = key.slope_in if side == "in" else key.slope_out
        neighbours = (key.previous, key.next)
        self.chords = [(self.value - other.value) / (self.time - other.time) for other in neighbours if other]
        self.steering = Steering(graph, start)
        # The handle is held where it was pressed, not by its very end: nothing jumps when the drag begins.
        end = graph.handle_points(channel, key_id)[0 if side == "in" else 1]
        self.end = (graph.time_from_x(end[0]), graph.value_from_y(end[1])) if end else (start.time, start.value)
        super().__init__(graph, f"Turn tangent {side} of {channel.name}")

    def move(self, point: Point) -> None:
        """Preview the slope towards the pointer; Shift takes the nearest of flat, the chords and what it was."""
        d_time, d_value = self.steering.steer(point, locks=False)
        run = self._side(self.end[0] + d_time - self.time)
        rise = self.end[1] + d_value - self.value
        slope = rise / run
        if point.shift:
            slope = min((0.0, *self.chords, self.start_slope), key=lambda other: self._angle_between(slope, other))
        channel, key_id, side = self.channel, self.id, self.side

        def turned(clip: Clip) -> Iterable[Change]:
            return edits.set_slope(clip, channel, key_id, side, slope)

        self.gesture.preview(turned)
        self.slope = slope

    @property
    def hint(self) -> str:
        """The slope now."""
        slope = slope_text(self.channel, self.slope)
        return f"slope {slope} · Shift: flat, chord or as it was · Alt: fine · Esc: cancel"

    def _side(self, d_time: float) -> float:
        """*d_time* kept on the handle's own side, a pixel away from the key at least."""
        pixel = abs(self.graph.time_from_x(1.0) - self.graph.time_from_x(0.0))
        return self.sign * max(self.sign * d_time, pixel)

    def _angle_between(self, slope: float, other: float) -> float:
        """Angle on the screen between two slopes, radians."""
        dx, _ = self.steering.pixels(1.0, 0.0)
        _, dy = self.steering.pixels(0.0, 1.0)
        turn = abs(atan2(slope * dy, dx) - atan2(other * dy, dx))
        return min(turn, pi - turn)
