"""SelectTool: choose keys, move them, turn their handles, insert new ones on a curve."""

from collections.abc import Callable
from math import hypot

from PySide6.QtCore import Qt

from model.channel import Channel
from model.keyframe import Keyframe
from model.labels import counted, short_name
from model.selection import Selection
from widgets.graph import Graph
from widgets.hit_test import EMPTY, Hit, hit_all
from widgets.hit_test import hit as hit_at
from widgets.tools.base import Cursor, Drag, Modifier, Point, Tool
from widgets.tools.box_select import BoxSelect
from widgets.tools.insert_key import InsertKey, insert_key, insert_time
from widgets.tools.move_keys import MoveKeys
from widgets.tools.steering import place_text
from widgets.tools.turn_handle import TurnHandle

# Clicks no further apart than this are at the same spot, and cycle through what overlaps there; pixels.
SAME_SPOT = 4.0
# Keys whose times differ by less than this part of a frame stand in one column.
COLUMN_WIDTH = 1e-3


def nothing() -> None:
    """What a click does when the press has done it all."""


class SelectTool(Tool):
    """The press chooses, so that a drag can follow at once; what only a click may do waits for the button to go up."""

    def __init__(self, graph: Graph) -> None:
        super().__init__(graph)
        self.session = graph.document.session
        self.grabbed = EMPTY
        self.before: tuple[Selection, Channel | None] = (Selection.NONE, None)
        self._on_click: Callable[[], None] = nothing
        self._last_click: tuple[float, float] | None = None

    # A stroke

    def press(self, point: Point) -> bool:
        """Select what is under the pointer; one of many selected keys keeps them all for the drag."""
        self._begin(point)
        found = self.grabbed
        self._on_click = nothing
        if found.kind == "empty":
            self._on_click = nothing if point.shift or point.ctrl else self._clear
        elif found.channel is None:
            pass  # a part of what a tool of another kind draws around the keys
        elif found.channel.locked:
            self._on_click = self._activate
            if found.kind == "key":
                self.graph.say(f"{short_name(found.channel)} is locked")
        elif found.kind == "key":
            self._press_key(point, found.channel, found.id)
        elif found.kind == "curve":
            self._on_click = self._insert if point.ctrl else self._choose_curve
        else:
            self._activate()
        return False

    def click(self, point: Point) -> None:
        """Do what the press left for the click; a plain one is remembered, for the next may be at the same spot."""
        act, self._on_click = self._on_click, nothing
        act()
        plain = not (point.shift or point.ctrl or point.alt)
        self._last_click = (point.x, point.y) if plain else None
        super().click(point)

    def double_click(self, point: Point) -> bool:
        """On a curve: select all its keys; elsewhere it is one more press."""
        found = self.hit(point)
        if found.kind != "curve" or found.channel is None or found.channel.locked or point.ctrl:
            return False
        self._begin(point)
        self._on_click = nothing
        chosen = Selection.of_all([found.channel])
        self.session.selection = self.session.selection.union(chosen) if point.shift else chosen
        self.session.active = found.channel
        return True

    def drag(self, point: Point) -> None:
        """The first call ends what a hover or the last click left behind."""
        if self.current is None:
            self._last_click = None
            self.leave()
        super().drag(point)

    def drag_from(self, start: Point) -> Drag:
        """Keys, and spans of the active curve, are moved, handles turned; everything else begins a box.

        A dense clip has a curve under nearly every pixel: only the one that was chosen before is taken by its line.
        """
        found, channel = self.grabbed, self.grabbed.channel
        gone = channel is not None and found.id != 0 and found.id not in channel  # since the button went down
        if channel is not None and not channel.locked and not gone:
            if found.kind == "key":
                return MoveKeys(self.graph, start, channel.key(found.id))
            if found.is_handle:
                return TurnHandle(self.graph, start, channel, found.id, "in" if found.kind == "handle_in" else "out")
            if found.kind == "curve" and start.ctrl:
                return InsertKey(self.graph, channel)
            if found.kind == "curve" and channel is self.before[1] and (span := self._span(channel, found.time)):
                return MoveKeys(self.graph, start, self._take_span(start, channel, span))
        return BoxSelect(self.graph, start, self.before[0])

    def cancel(self) -> None:
        """Take the gesture back, and give back the selection there was before the press."""
        stroke = self.pressed is not None
        super().cancel()
        if stroke:
            selection, active = self.before
            alive = self.graph.document.clip.channels  # another clip may be why the stroke was cancelled
            self.session.selection = selection.pruned(alive)
            self.session.active = active if active in alive else None

    # What a press does

    def _begin(self, point: Point) -> None:
        self.pressed = point
        self.grabbed = self.hit(point)
        self.before = self.session.selection, self.session.active

    def _press_key(self, point: Point, channel: Channel, key_id: int) -> None:
        session = self.session
        was_selected = session.selection.contains(channel, key_id)
        chosen = Selection.of_key(channel, key_id)
        if point.alt:
            chosen = self._column(self.grabbed.time)
            session.selection = session.selection.union(chosen) if point.shift else chosen
        elif point.shift and was_selected:
            self._on_click = lambda: self._select(session.selection.minus(chosen))
        elif point.shift:
            session.selection = session.selection.union(chosen)
        elif was_selected:
            self._on_click = self._reduce
        else:
            session.selection = chosen
        session.active = channel

    # What a click does

    def _select(self, selection: Selection) -> None:
        self.session.selection = selection

    def _clear(self) -> None:
        self.session.selection = Selection.NONE

    def _activate(self) -> None:
        self.session.active = self.grabbed.channel

    def _reduce(self) -> None:
        """Leave only the clicked key; clicked again at the same spot, take the next one that lies there."""
        found = self.grabbed
        if self._again() and self.before[0].count == 1:
            found = self._next(
                lambda other: other.kind == "key" and (other.channel, other.id) == (found.channel, found.id)
            )
        if found.channel is not None:
            self.session.selection = Selection.of_key(found.channel, found.id)
            self.session.active = found.channel

    def _choose_curve(self) -> None:
        """Make the curve's channel the active one; clicked again at the same spot, the next curve that lies there."""
        found = self.grabbed
        if self._again() and self.before[1] is found.channel:
            found = self._next(lambda other: other.channel is found.channel)
        self.session.active = found.channel
        if self.pressed is not None and not self.pressed.shift:
            self._clear()

    def _insert(self) -> None:
        assert self.pressed is not None
        channel = self.grabbed.channel
        time = insert_time(self.graph, channel, self.pressed) if channel is not None else None
        self.graph.set_insert_preview(None, None)
        if channel is not None and time is not None:
            insert_key(self.graph, channel, time)

    def _again(self) -> bool:
        point, last = self.pressed, self._last_click
        return point is not None and last is not None and hypot(point.x - last[0], point.y - last[1]) <= SAME_SPOT

    def _next(self, is_current: Callable[[Hit], bool]) -> Hit:
        """What lies at the pressed spot after the present choice, round and round, in an order that stays."""
        assert self.pressed is not None
        order = {channel: place for place, channel in enumerate(self.graph.document.clip.channels)}
        same = [
            (order[other.channel], other.time if other.kind == "key" else 0.0, other)
            for other in hit_all(self.graph, self.pressed.x, self.pressed.y)
            if other.kind == self.grabbed.kind and other.channel is not None and not other.channel.locked
        ]
        same.sort(key=lambda row: row[:2])
        hits = [row[2] for row in same]
        place = next((i for i, other in enumerate(hits) if is_current(other)), -1)
        return hits[(place + 1) % len(hits)] if hits else self.grabbed

    # What they need

    def _column(self, time: float) -> Selection:
        """The keys of all shown channels at *time*."""
        clip, near = self.graph.document.clip, COLUMN_WIDTH / self.graph.document.clip.frame_rate
        return Selection.of(
            {
                channel: channel.keys_between(time - near, time + near)["id"]
                for channel in self.session.shown_channels(clip)
                if not channel.locked
            }
        )

    def _span(self, channel: Channel, time: float) -> tuple[Keyframe, Keyframe] | None:
        """The keys of the span at *time*; None before the first and after the last key."""
        before, after = channel.neighbours(time)
        return (before, after) if before is not None and after is not None else None

    def _take_span(self, start: Point, channel: Channel, span: tuple[Keyframe, Keyframe]) -> Keyframe:
        """Select the span's keys, unless both already are, and say which one is nearer to the pointer."""
        chosen = Selection.of({channel: [key.id for key in span]})
        selection = self.session.selection
        if not all(selection.contains(channel, key.id) for key in span):
            self.session.selection = selection.union(chosen) if start.shift else chosen
        self.session.active = channel
        return min(span, key=lambda key: abs(key.time - start.time))

    # Hover

    def hit(self, point: Point) -> Hit:
        """The nearest thing."""
        return hit_at(self.graph, point.x, point.y)

    def hover(self, point: Point) -> None:
        """Light up what a press would meet; with Ctrl over a curve, show where a key would go."""
        found = self.hovered = self.hit(point)
        self.graph.set_hover(found if found.channel is not None else None)
        if point.ctrl and found.kind == "curve" and found.channel is not None and not found.channel.locked:
            self.graph.set_insert_preview(found.channel, insert_time(self.graph, found.channel, point))
        else:
            self.graph.set_insert_preview(None, None)

    def leave(self) -> None:
        """Nothing is under the pointer."""
        self.hovered = EMPTY
        self.graph.set_hover(None)
        self.graph.set_insert_preview(None, None)

    def hints(self, hit: Hit, modifiers: Qt.KeyboardModifier) -> str:
        """What the mouse does here, with these modifiers held."""
        if hit.channel is not None and hit.channel.locked:
            return f"{hit.channel.name} is locked · Click: make it the active channel · Drag: select with a box"
        shift, ctrl = modifiers & Modifier.ShiftModifier, modifiers & Modifier.ControlModifier
        if hit.kind == "key" and hit.channel is not None:
            selected = self.session.selection.contains(hit.channel, hit.id)
            count = self.session.selection.count if selected else 1
            if modifiers & Modifier.AltModifier:
                return "Click: select the keys of all shown channels at this time · Shift: add them"
            if shift:
                return f"Click: {'take out of' if selected else 'add to'} the selection · Drag: move along one axis"
            return f"{place_text(hit)} · Drag: move {counted(count, 'key')} · Shift+click: toggle · Alt+click: column"
        if hit.is_handle:
            return "Drag: turn the tangent · Shift: flat, chord or as it was · Alt: fine"
        if hit.kind == "curve" and hit.channel is not None:
            if ctrl:
                return f"Click: insert a key on {hit.channel.name}, the curve keeps its shape"
            drag = "move the span" if hit.channel is self.session.active else "box · Click: make active"
            return f"{place_text(hit)} · Drag: {drag} · Double-click: all its keys · Ctrl+click: insert a key"
        if ctrl:
            return "Drag: take out of the selection"
        return "Drag: add to the selection" if shift else "Drag: select with a box · Middle drag: pan · Wheel: zoom"

    def cursor(self, hit: Hit, modifiers: Qt.KeyboardModifier) -> Qt.CursorShape:
        """A hand for what can be taken, a cross where a key would be inserted."""
        if hit.channel is None:
            return Cursor.ArrowCursor
        if hit.channel.locked:
            return Cursor.ForbiddenCursor
        if hit.kind == "curve":
            return Cursor.CrossCursor if modifiers & Modifier.ControlModifier else Cursor.PointingHandCursor
        return Cursor.OpenHandCursor if hit.is_handle else Cursor.SizeAllCursor
