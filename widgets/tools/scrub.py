"""Scrub and ChangeRange: what the left button drags in the time ruler."""

from collections.abc import Iterable
from typing import ClassVar, Literal

from PySide6.QtCore import Qt

from model.clip import Clip
from model.document import Change, Setting
from widgets.graph import Graph
from widgets.tools.base import TIME_AXIS, Axes, Cursor, EditDrag, Point
from widgets.tools.steering import Steering


class Scrub:
    """The playhead follows the pointer; it is not part of the clip, so there is nothing to undo."""

    cursor: ClassVar[Qt.CursorShape] = Cursor.SplitHCursor
    scrolls = TIME_AXIS

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        session = graph.document.session
        self.before = session.playhead
        session.playing = False  # the hand and the clock would pull at it both

    def move(self, point: Point) -> None:
        """Put the playhead under the pointer, on a whole frame if it snaps."""
        self.graph.document.session.playhead = snapped(self.graph, point, point.time)

    def finish(self, point: Point) -> None:
        """The playhead stays."""

    def cancel(self) -> None:
        """The playhead goes back."""
        self.graph.document.session.playhead = self.before

    @property
    def hint(self) -> str:
        """Where the playhead is."""
        document = self.graph.document
        time = document.session.playhead
        return f"{time:.3f} s  frame {document.clip.frame_of(time):.6g} · Ctrl: no snap · Esc: cancel"


class ChangeRange(EditDrag):
    """One end of the clip's range follows the pointer and stays a frame away from the other."""

    cursor: ClassVar[Qt.CursorShape] = Cursor.SizeHorCursor

    def __init__(self, graph: Graph, start: Point, end: Literal["start", "end"]) -> None:
        clip = graph.document.clip
        self.end = end
        self.before = self.after = clip.start if end == "start" else clip.end
        frame = 1.0 / clip.frame_rate
        self.limit = clip.end - frame if end == "start" else clip.start + frame
        self.steering = Steering(graph, start)
        super().__init__(graph, "Change range")

    def move(self, point: Point) -> None:
        """Preview the end under the pointer."""
        d_time, _ = self.steering.steer(point, locks=False)
        time = snapped(self.graph, point, self.before + d_time) if d_time else self.before
        time = min(time, self.limit) if self.end == "start" else max(time, self.limit)
        end, before = self.end, self.before

        def changed(clip: Clip) -> Iterable[Change]:
            return [Setting(clip, end, before, time)] if time != before else []

        self.gesture.preview(changed)
        self.after = time

    @property
    def scrolls(self) -> Axes:
        """The range lies in time."""
        return TIME_AXIS

    @property
    def hint(self) -> str:
        """Where the end is."""
        frame = self.graph.document.clip.frame_of(self.after)
        return f"range {self.end} {self.after:.3f} s  frame {frame:.6g} · Ctrl: no snap · Alt: fine · Esc: cancel"


def snapped(graph: Graph, point: Point, time: float) -> float:
    """*time* on a whole frame if snapping is on; Ctrl turns that round."""
    document = graph.document
    session = document.session
    return session.snap_time(document.clip, time) if session.snap is not point.ctrl else time
