"""BoxSelect: a drag on empty ground; what the box holds is selected while it grows."""

from typing import ClassVar

from PySide6.QtCore import QPointF, QRectF, Qt

from model.channel import Channel
from model.labels import counted
from model.selection import Selection
from widgets.graph import Graph
from widgets.tools.base import BOTH_AXES, Cursor, Point


class BoxSelect:
    """One box; plain it replaces the selection, with Shift it adds, with Ctrl it subtracts."""

    cursor: ClassVar[Qt.CursorShape] = Cursor.CrossCursor
    scrolls = BOTH_AXES

    def __init__(self, graph: Graph, start: Point, before: Selection) -> None:
        self.graph = graph
        self.start = start
        self.before = before

    def move(self, point: Point) -> None:
        """Show the box and select what it holds now; it stays fixed where it began if the view scrolls."""
        graph, start = self.graph, self.start
        corner = QPointF(graph.x_from_time(start.time), graph.y_from_value(start.value))
        graph.set_box(QRectF(corner, QPointF(point.x, point.y)).normalized())
        times = sorted((start.time, point.time))
        values = sorted((start.value, point.value))
        session = graph.document.session
        inside = keys_in_box(
            [channel for channel in session.shown_channels(graph.document.clip) if session.editable(channel)],
            (times[0], times[1]),
            (values[0], values[1]),
        )
        if point.ctrl:
            session.selection = self.before.minus(inside)
        elif point.shift:
            session.selection = self.before.union(inside)
        else:
            session.selection = inside

    def finish(self, point: Point) -> None:
        """Keep the selection."""
        self.graph.set_box(None)

    def cancel(self) -> None:
        """No box; the tool gives back the selection there was before the press."""
        self.graph.set_box(None)

    @property
    def hint(self) -> str:
        """How many keys would be selected."""
        return (
            f"{counted(self.graph.document.session.selection.count, 'key')} · Shift: add · Ctrl: subtract · Esc: cancel"
        )


def keys_in_box(channels: list[Channel], times: tuple[float, float], values: tuple[float, float]) -> Selection:
    """Keys of *channels* between these times and these values, ends included."""
    ids = {}
    for channel in channels:
        run = channel.keys_between(*times)
        inside = (run["value"] >= values[0]) & (run["value"] <= values[1])
        ids[channel] = run["id"][inside]
    return Selection.of(ids)
