"""InsertKey: Ctrl and a click on a curve put a key there, and the curve keeps its shape."""

from typing import ClassVar

from PySide6.QtCore import Qt

from model import edits
from model.channel import Channel
from model.document import added_keys
from model.labels import short_name
from widgets.graph import Graph
from widgets.tools.base import NO_AXIS, Cursor, Point


class InsertKey:
    """The dot slides along the curve with the pointer; the key is inserted where the button goes up."""

    cursor: ClassVar[Qt.CursorShape] = Cursor.CrossCursor
    scrolls = NO_AXIS

    def __init__(self, graph: Graph, channel: Channel) -> None:
        self.graph = graph
        self.channel = channel
        self.time: float | None = None

    def move(self, point: Point) -> None:
        """Show where the key would go."""
        self.time = insert_time(self.graph, self.channel, point)
        self.graph.set_insert_preview(self.channel, self.time)

    def finish(self, point: Point) -> None:
        """Insert it, unless there is a key at that time already."""
        self.graph.set_insert_preview(None, None)
        if self.time is not None:
            insert_key(self.graph, self.channel, self.time)

    def cancel(self) -> None:
        """No key."""
        self.graph.set_insert_preview(None, None)

    @property
    def hint(self) -> str:
        """Where the key would go."""
        if self.time is None:
            return "There is a key at this time already · Esc: cancel"
        return f"Insert a key at {self.time:.3f} s, the curve keeps its shape · Esc: cancel"


def insert_time(graph: Graph, channel: Channel, point: Point) -> float | None:
    """The time a key inserted from *point* would get; None where the channel has one.

    Ctrl is what asks for the key, so it does not turn snapping round here.
    """
    session = graph.document.session
    time = session.snap_time(graph.document.clip, point.time) if session.snap else point.time
    return None if channel.key_at(time) is not None else time


def insert_key(graph: Graph, channel: Channel, time: float) -> None:
    """Insert a key on the curve at *time* (seconds) as one undo step, and select it."""
    document = graph.document
    document.do(
        f"Insert key on {short_name(channel)} at {time:.3f} s",
        lambda clip: edits.insert(clip, channel, time),
        selection=added_keys,
    )
    document.session.active = channel
