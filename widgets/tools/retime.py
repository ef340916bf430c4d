"""RetimeTool: stretch keys in time between two brackets; the other end stays where it is."""

from typing import ClassVar

from PySide6.QtCore import QRectF, Qt

from model.labels import counted
from model.selection import Selection
from widgets.hit_test import Hit
from widgets.tools.base import Cursor, Drag, Point
from widgets.tools.scale import MIN_FACTOR, PADDING, SIDES, Bounds, ScaleKeys, ScaleTool, near


class RetimeKeys(ScaleKeys):
    """One stretch in time alone, which never turns the order of the keys round."""

    cursor: ClassVar[Qt.CursorShape] = Cursor.SizeHorCursor
    verb: ClassVar[str] = "Retime"

    def time_factor(self, factor: float) -> float:
        """*factor*, never so small that keys could meet."""
        return max(factor, MIN_FACTOR)

    @property
    def hint(self) -> str:
        """The factor so far."""
        return f"{self._amount(*self.factors)}{self.landing} · Ctrl: no snap · Alt: fine · Esc: cancel"


class RetimeTool(ScaleTool):
    """Works on the selected keys, or on all shown ones if fewer than two are selected."""

    drag_class = RetimeKeys
    wanting = "there are no two keys to stretch"

    def keys(self) -> Selection:
        """The selected keys that may be edited, or all that are shown."""
        chosen = super().keys()
        if chosen.count > 1:
            return chosen
        shown = self.session.shown_channels(self.graph.document.clip)
        return Selection.of_all(channel for channel in shown if not channel.locked)

    def sides(self, bounds: Bounds) -> list[tuple[int, int]]:
        """Only the two ends in time."""
        return [(-1, 0), (1, 0)] if bounds.t1 > bounds.t0 else []

    def box(self, bounds: Bounds) -> QRectF:
        """As high as the plot."""
        x0, x1 = near(self.graph.x_from_time(bounds.t0)), near(self.graph.x_from_time(bounds.t1))
        plot = self.graph.plot_rect
        return QRectF(x0 - PADDING, plot.top(), x1 - x0 + 2 * PADDING, plot.height()).adjusted(0, 2, 0, -2)

    def pivot_of(self, bounds: Bounds) -> None:
        """The end that stays is plain to see."""
        return

    def drag_inside(self, start: Point, bounds: Bounds, grip: tuple[float, float]) -> Drag:
        """The nearer end follows, the other stays."""
        later = grip[0] >= bounds.center[0]
        pivot = bounds.at((-1, 0)) if later else bounds.at((1, 0))
        return self.drag_class(self.graph, start, self.keys(), pivot, grip, (True, False))

    def stretch_hint(self, hit: Hit, bounds: Bounds) -> str:
        """What a drag of a bracket, of a key or of the ground between them does: the nearer end follows."""
        if hit.kind == "frame":
            later = SIDES[hit.id][0] > 0
        else:
            time = hit.time if hit.kind == "key" or self._under is None else self._under.time
            later = time >= bounds.center[0]
        return f"Drag: stretch {self._keys_text(hit)} in time from the far edge, the {'left' if later else 'right'} one"

    def _keys_text(self, hit: Hit) -> str:
        """How many keys a press on *hit* and a drag would stretch."""
        chosen = super().keys()
        chooses_anew = (
            hit.kind == "key" and hit.channel is not None and not self.session.selection.contains(hit.channel, hit.id)
        )
        if chosen.count > 1 and not chooses_anew:
            return counted(chosen.count, "key")
        shown = self.session.shown_channels(self.graph.document.clip)
        return f"all {counted(sum(len(channel) for channel in shown if not channel.locked), 'key')}"
