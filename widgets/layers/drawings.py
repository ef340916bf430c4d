"""Drawing: what one curve looks like between two x, worked out where a change is told and painted a moment later."""

from math import ceil, floor, inf
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.channel import Channel
from model.lines import TOLERANCE, Line, line_through
from model.sampling import Window, columns
from widgets.traces import Trace

if TYPE_CHECKING:
    from widgets.stage import Stage

# How far a line reaches beside its mathematical place.
REACH: Final = 4.0
# How far, in pixels, the hard lines of a thicket may lie beside a steep curve.
THICKET: Final = 0.8

type Boxes = NDArray[np.int32]


class Drawing(NamedTuple):
    """A chain of points or, where keys are many, boxes (n, 4) from left to right, of a channel at this revision."""

    revision: int
    x0: float
    x1: float
    line: Line | None
    boxes: Boxes | None

    def serves(self, revision: int, x0: float, x1: float) -> bool:
        """Whether it is what is to be painted between these x."""
        return self.revision == revision and self.x0 <= x0 and x1 <= self.x1

    def rows_between(self, x0: float, x1: float) -> tuple[float, float] | None:
        """The highest and lowest y between two x; None if it does not reach that far, or nothing is there."""
        if not self.x0 <= x0 <= x1 <= self.x1:
            return None
        if self.boxes is not None:
            here = self.boxes_between(x0, x1)
            return (float(here[:, 1].min()), float(here[:, 3].max())) if len(here) else None
        if self.line is None or not len(self.line.x):
            return None
        x, y = self.line.x, self.line.y
        seen = y[max(int(x.searchsorted(x0)) - 1, 0) : int(x.searchsorted(x1, "right")) + 1]
        return float(seen.min()), float(seen.max())

    def boxes_between(self, x0: float, x1: float) -> Boxes:
        """Those of its boxes, one for each column, that touch what lies between two x."""
        boxes = self.boxes
        if boxes is None or not len(boxes):
            return np.empty((0, 4), np.int32)
        first = int(boxes[0, 0])
        return boxes[max(floor(x0) - 1 - first, 0) : max(ceil(x1) + 1 - first, 0)]


def drawing_of(stage: "Stage", trace: Trace, x0: float, x1: float) -> Drawing:
    """The curve of a channel of two keys or more between two x; it is drawn as the whole window says."""
    channel, window = trace.channel, stage.window
    if stage.in_columns(trace):
        # All that can be seen, so that steps that follow find most of it at hand.
        boxes = boxes_of(window, trace, window.left, window.right, inside=True)
        return Drawing(channel.revision, -inf, inf, None, boxes)
    return Drawing(channel.revision, x0, x1, line_of(window, trace, x0, x1), None)


def changed_drawing(stage: "Stage", trace: Trace, before: Drawing | None, times: tuple[float, float]) -> Drawing | None:
    """What a curve in columns looks like after a change between two times; None if it cannot be made of *before*.

    *before* must be what it looked like when the change before was told: nothing else has changed since.
    """
    channel, window = trace.channel, stage.window
    if before is None or before.boxes is None or not stage.in_columns(trace):
        return None
    boxes, (low, high) = before.boxes, _columns_of(window, trace, window.left, window.right)
    if not low < high or len(boxes) != high - low or boxes[0, 0] != int(window.left) + low:
        return None
    new = boxes_of(window, trace, *(window.x_from_time(time) for time in times), inside=True)
    if len(new):
        first = int(new[0, 0]) - int(boxes[0, 0])
        boxes = boxes.copy()
        boxes[first : first + len(new)] = new
    return before._replace(revision=channel.revision, boxes=boxes)


def rows_changed(stage: "Stage", channel: Channel, x0: float, x1: float) -> tuple[float, float] | None:
    """The highest and lowest y, between two x, of a curve as painted last or as at hand; None if one is unknown."""
    before, now = stage.painted.get(channel), stage.ready.get(channel)
    if before is None or now is None:
        return None
    rows, rows_now = before.rows_between(x0, x1), now.rows_between(x0, x1)
    if rows is None or rows_now is None:
        return None
    return min(rows[0], rows_now[0]), max(rows[1], rows_now[1])


def line_of(window: Window, trace: Trace, x0: float, x1: float) -> Line:
    """The chain of the spans that touch what lies between two x."""
    spans = trace.channel.spans_between(window.time_from_x(x0 - REACH), window.time_from_x(x1 + REACH))
    return line_through(spans, window, TOLERANCE if trace.soft else THICKET)


def _columns_of(window: Window, trace: Trace, x0: float, x1: float) -> tuple[int, int]:
    """Between two x, which columns hold some of the curve from the first to the last key: from, up to before."""
    ends = trace.channel.ends()
    if ends is None:
        return 0, 0
    low, high = _columns_between(window, x0, x1)
    low = max(low, floor(min(max(window.x_from_time(ends.time0) - window.left, -1e9), 1e9)))
    return low, min(high, floor(min(max(window.x_from_time(ends.time1) - window.left, -1e9), 1e9)) + 1)


def _columns_between(window: Window, x0: float, x1: float) -> tuple[int, int]:
    return max(floor(x0 - window.left) - 1, 0), min(ceil(x1 - window.left) + 1, ceil(window.width))


def boxes_of(window: Window, trace: Trace, x0: float, x1: float, *, inside: bool, every: int = 1) -> Boxes:
    """The exact lowest to highest value of each pixel column; of the extrapolation every other group of *every*."""
    low, high = _columns_of(window, trace, x0, x1) if inside else _columns_between(window, x0, x1)
    if high <= low or not len(trace.channel):
        return np.empty((0, 4), np.int32)
    top, bottom = columns(trace.channel, window, low, high, inside=inside)
    more = 1 if trace.active else 0
    boxes = np.empty((high - low, 4), np.int32)
    x = boxes[:, 0] = np.arange(window.left + low, window.left + high)
    boxes[:, 1], boxes[:, 2], boxes[:, 3] = np.floor(top), x + more, np.floor(bottom) + more
    if every > 1:
        phase = floor(window.t0 * window.px_per_second) % (2 * every)
        boxes = boxes[(np.arange(low, high) + phase) // every % 2 == 0]
    return boxes
