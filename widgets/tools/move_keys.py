"""MoveKeys: the selected keys follow the pointer in time and value."""

from collections.abc import Iterable

from model import edits
from model.clip import Clip
from model.document import Change
from model.keyframe import Keyframe
from model.labels import counted
from widgets.graph import Graph
from widgets.tools.base import BOTH_AXES, TIME_AXIS, VALUE_AXIS, Axes, EditDrag, Point
from widgets.tools.steering import Steering, time_text, value_text

HINT = "Shift: lock axis · Ctrl: no snap · Alt: fine · Esc: cancel"


class MoveKeys(EditDrag):
    """One drag of all selected keys; *anchor* is the key that snaps, and the others keep their distance to it."""

    def __init__(self, graph: Graph, start: Point, anchor: Keyframe) -> None:
        session = graph.document.session
        self.selection = session.selection
        self.channel, self.anchor_time = anchor.channel, anchor.time
        self.steering = Steering(graph, start)
        self.d_time = self.d_value = 0.0
        super().__init__(graph, f"Move {counted(session.selection.count, 'key')}", session.selection)

    def pass_by(self, point: Point) -> None:
        """Only steer."""
        self.steering.steer(point)

    def move(self, point: Point) -> None:
        """Preview the keys where the pointer has taken them."""
        document = self.graph.document
        session, selection = document.session, self.selection
        d_time, d_value = self.steering.steer(point)
        if d_time and session.snap is not point.ctrl:
            snapped = session.snap_time(document.clip, self.anchor_time + d_time)
            d_time = snapped - self.anchor_time
        reorder = session.reorder

        def moved(clip: Clip) -> Iterable[Change]:
            return edits.move(clip, selection, d_time, d_value, reorder=reorder)

        self.preview(moved, lambda: document.label_of("Move", selection, d_time, d_value))
        self.d_time, self.d_value = d_time, d_value

    @property
    def scrolls(self) -> Axes:
        """Only along the axis that Shift has left free."""
        return {"time": TIME_AXIS, "value": VALUE_AXIS}.get(self.steering.lock or "", BOTH_AXES)

    @property
    def hint(self) -> str:
        """The way so far."""
        return f"dt {time_text(self.d_time)}  dv {value_text(self.channel, self.d_value)}{self.landing} · {HINT}"
