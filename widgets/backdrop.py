"""Backdrop: the picture at rest, kept in a pixmap; moved or scaled at once when the view changes, then drawn anew."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import batched
from math import floor, hypot
from operator import attrgetter
from time import perf_counter
from typing import Final, NamedTuple

import numpy as np
from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QPainter, QPixmap, QRegion

from model.channel import Channel
from model.sampling import Window
from widgets.layers import LAYERS, Plane
from widgets.stage import Stage
from widgets.traces import Trace

# A picture that took no longer than this is drawn anew at once, without a preview.
QUICK: Final = 0.006
# What takes longer than this comes in slices even where there is nothing to preview it by, or only what was before.
LONG: Final = 0.02
# How long one slice of a slow picture may hold up the mouse.
SLICE: Final = 0.005
# A picture scaled further than this tells nothing.
MOST_SCALED: Final = 40.0


# What is freed in pieces up to so many bytes is kept for the next ones: glibc takes the largest block that was ever
# freed as a measure, and giving memory back and asking for it again took half the time of a large picture.
KEPT: Final = 8 << 20
np.empty(KEPT, np.uint8)


_revision = attrgetter("channel.revision")


class Look(NamedTuple):
    """Everything but the window that the backdrop's pixels depend on."""

    theme: str
    degrees: bool
    start: float
    end: float
    traces: tuple[Trace, ...]
    revisions: tuple[int, ...]

    @classmethod
    def of(cls, stage: Stage) -> "Look":
        """What the stage asks for now."""
        clip = stage.document.clip
        revisions = tuple(map(_revision, stage.resting))
        return cls(stage.theme.name, stage.degrees, clip.start, clip.end, stage.resting, revisions)


class Picture:
    """A pixmap of the plot area in the making: a window, a look, and what remains to be drawn."""

    def __init__(self, stage: Stage) -> None:
        self.window = stage.window
        self.look = Look.of(stage)
        self.seconds = 0.0
        self.pixmap = QPixmap(max(round(self.window.width), 1), max(round(self.window.height), 1))
        self._jobs = _jobs(stage, self.look.traces)
        self.done = False

    def draw(self, seconds: float) -> None:
        """Go on for about so long."""
        start = perf_counter()
        painter = QPainter(self.pixmap)
        try:
            # It is all of the pixmap; without any clip Qt takes three times as long for thin lines.
            painter.setClipRect(self.pixmap.rect())
            painter.translate(-self.window.left, -self.window.top)
            for job in self._jobs:
                job(painter)
                if perf_counter() - start > seconds:
                    break
            else:
                self.done = True
        finally:
            painter.end()
        self.seconds += perf_counter() - start


def _jobs(stage: Stage, traces: Sequence[Trace]) -> Iterator[Callable[[QPainter], None]]:
    left, right = stage.window.left, stage.window.right
    for layer in LAYERS:
        if layer.plane is Plane.GROUND:
            yield lambda painter, draw=layer.draw: draw(painter, stage, (), left, right)  # type: ignore[misc]
        elif layer.plane is Plane.RESTING:
            for few in batched(traces, layer.together):
                yield lambda painter, draw=layer.draw, few=few: draw(painter, stage, few, left, right)  # type: ignore[misc]


class Backdrop:
    """Ground, grid and resting traces; `contents` are the channels whose present curve the pixmap shows."""

    def __init__(self) -> None:
        self.contents: dict[Channel, int] = {}
        self._pixmap: QPixmap | None = None
        self._window: Window | None = None
        self._look: Look | None = None
        self._exact = False
        self._building: Picture | None = None
        self._cost = 0.0
        # Whether what is shown stands where it is to stand, and only rounding is still to be seen to.
        self.in_place = False
        self._strips: dict[Channel, list[tuple[float, float]]] = {}

    def drop(self) -> None:
        """Forget the picture: nothing of it will be shown again."""
        self._pixmap = self._look = self._window = self._building = None
        self.contents, self._strips = {}, {}
        self._cost = 0.0

    def mark(self, channel: Channel, t0: float, t1: float) -> None:
        """The channel's curve has changed between two times."""
        if channel in self.contents:
            self._strips.setdefault(channel, []).append((t0, t1))

    @property
    def busy(self) -> bool:
        """Whether `refine` has something to do."""
        return self._building is not None

    def prepare(self, stage: Stage) -> None:
        """Bring the pixmap as near to the stage as a few milliseconds allow."""
        look = Look.of(stage)
        if self._pixmap is None or self._look is None or self._look.theme != look.theme:
            self._begin(stage)
            return
        if self._strips:
            self._draw_strips(stage)
        if self._is_exact(stage, look):
            self._building = None
            return
        if self._cost < QUICK:
            self._show(self._drawn(stage))
            return
        if self._building is None or self._building.look != look:
            self._building = Picture(stage)
        self._scroll(stage)
        self.in_place = self._window == stage.window and self._look == look

    def refine(self, stage: Stage, seconds: float = SLICE) -> bool:
        """Draw a slice of the exact picture; True if there is something new to show."""
        picture = self._building
        if picture is None:
            return False
        if picture.look != Look.of(stage):
            picture = self._building = Picture(stage)
        picture.draw(seconds)
        if not picture.done:
            return False
        self._show(picture)
        return True

    def paint(self, painter: QPainter, stage: Stage) -> None:
        """Put the pixmap where its times and values are now, under the painter's clip."""
        pixmap, window, shown = self._pixmap, stage.window, self._window
        if pixmap is None or shown is None:
            return
        if shown == window:
            painter.drawPixmap(QPointF(window.left, window.top), pixmap)
            return
        target = QRectF(
            QPointF(window.x_from_time(shown.t0), window.y_from_value(shown.v1)),
            QPointF(window.x_from_time(shown.t1), window.y_from_value(shown.v0)),
        )
        fx, fy = target.width() / pixmap.width(), target.height() / pixmap.height()
        telling = 1 / MOST_SCALED < fx < MOST_SCALED and 1 / MOST_SCALED < fy < MOST_SCALED
        if not telling or not target.contains(stage.plot()):
            for layer in LAYERS:
                if layer.plane is Plane.GROUND:
                    layer.draw(painter, stage, (), window.left, window.right)
        seen = target.intersected(stage.plot())
        if telling and not seen.isEmpty():
            source = QRectF(
                (seen.left() - target.left()) / fx,
                (seen.top() - target.top()) / fy,
                seen.width() / fx,
                seen.height() / fy,
            )
            painter.drawPixmap(seen, pixmap, source)

    def _drawn(self, stage: Stage) -> Picture:
        picture = Picture(stage)
        while not picture.done:
            picture.draw(60.0)
        return picture

    def _begin(self, stage: Stage) -> None:
        """Show what can be drawn at once, and go on from there."""
        picture = Picture(stage)
        picture.draw(LONG)
        self._show(picture)
        if not picture.done:
            self._pixmap = QPixmap(picture.pixmap)  # a copy: from now on both are drawn upon
            self._exact, self._building = False, picture

    def _show(self, picture: Picture) -> None:
        self._pixmap, self._window, self._look = picture.pixmap, picture.window, picture.look
        self._cost = picture.seconds
        self._building = None
        self._exact = True
        self._strips = {}
        self.contents = {
            trace.channel: revision for trace, revision in zip(picture.look.traces, picture.look.revisions, strict=True)
        }

    def _is_exact(self, stage: Stage, look: Look) -> bool:
        return self._exact and self._window == stage.window and self._look == look

    def _draw_strips(self, stage: Stage) -> None:
        """Draw anew, in the pixmap's own window, the strips of what has changed; what is live now is only taken out."""
        window = self._window
        if window is None or self._look is None:
            return
        resting = {trace.channel for trace in stage.resting}
        seconds = self._cost * _strip(window, *_around(self._strips.values())).boundingRect().width() / window.width
        if seconds > LONG and resting.issuperset(self._strips):
            self._strips, self._exact = {}, False
            return
        strips = QRegion()
        for channel, intervals in self._strips.items():
            if channel not in resting:
                self.contents.pop(channel, None)
                self._exact = False
            else:
                self.contents[channel] = channel.revision
            for t0, t1 in intervals:
                strips += _strip(window, t0, t1)
        self._strips = {}
        at_rest = Stage.at(stage, window)
        traces = tuple(trace for trace in stage.resting if trace.channel in self.contents)
        self._redraw(at_rest, strips, traces)
        if self._exact:
            # What has changed without being marked keeps its old revision here, and so is found out.
            revisions = tuple([self.contents[trace.channel] for trace in self._look.traces])
            self._look = self._look._replace(revisions=revisions)

    def _redraw(self, stage: Stage, region: QRegion, traces: Sequence[Trace]) -> None:
        pixmap, window = self._pixmap, stage.window
        if pixmap is None or region.isEmpty():
            return
        painter = QPainter(pixmap)
        try:
            painter.setClipRegion(region)
            painter.translate(-window.left, -window.top)
            bounds = region.boundingRect()
            x0, x1 = window.left + bounds.left(), window.left + bounds.right() + 1
            for layer in LAYERS:
                if layer.plane is not Plane.LIVE:
                    layer.draw(painter, stage, traces, x0, x1)
        finally:
            painter.end()

    def _scroll(self, stage: Stage) -> None:
        """If the view has only been moved by whole pixels, move the pixmap and draw what comes into view."""
        pixmap, old, new = self._pixmap, self._window, stage.window
        if pixmap is None or old is None or old == new or pixmap.width() != new.width or pixmap.height() != new.height:
            return
        dx, dy = new.x_from_time(old.t0) - new.left, new.y_from_value(old.v1) - new.top
        far = hypot(new.x_from_time(old.t1) - new.right - dx, new.y_from_value(old.v0) - new.bottom - dy)
        right, down = round(dx), round(dy)
        if max(abs(dx - right), abs(dy - down), far) > 1e-2 or abs(right) >= new.width or abs(down) >= new.height:
            return
        whole = pixmap.rect()
        pixmap.scroll(right, down, whole)
        self._window, self._exact = new, False
        bare = QRegion(whole) - QRegion(whole.translated(right, down))
        traces = tuple(trace for trace in stage.resting if trace.channel in self.contents)
        for rect in iter(bare):  # type: ignore[call-overload]
            self._redraw(stage, QRegion(rect), traces)


def _around(intervals: Iterable[Sequence[tuple[float, float]]]) -> tuple[float, float]:
    """From the first to the last time of all."""
    return min(t0 for some in intervals for t0, _ in some), max(t1 for some in intervals for _, t1 in some)


def _strip(window: Window, t0: float, t1: float) -> QRegion:
    """The pixels, from the plot's corner, that a change between two times may touch."""
    margin = 12 * window.unit
    x0 = min(max(window.x_from_time(t0) - window.left - margin, 0.0), window.width)
    x1 = min(max(window.x_from_time(t1) - window.left + margin, 0.0), window.width)
    left, right = floor(x0), floor(x1) + 1
    return QRegion(left, 0, right - left, round(window.height))
