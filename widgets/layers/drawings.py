"""Drawing: what one curve looks like between two x, worked out where a change is told and painted a moment later."""

from math import ceil, floor
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

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
            lefts = self.boxes[:, 0]
            here = self.boxes[lefts.searchsorted(floor(x0) - 1) : lefts.searchsorted(ceil(x1) + 1)]
            return (float(here[:, 1].min()), float(here[:, 3].max())) if len(here) else None
        if self.line is None or not len(self.line.x):
            return None
        x, y = self.line.x, self.line.y
        seen = y[max(int(x.searchsorted(x0)) - 1, 0) : int(x.searchsorted(x1, "right")) + 1]
        return float(seen.min()), float(seen.max())


def drawing_of(stage: "Stage", trace: Trace, x0: float, x1: float) -> Drawing:
    """The curve of a channel of two keys or more between two x; it is drawn as the whole window says."""
    channel = trace.channel
    if stage.manner_of(channel).columns:
        return Drawing(channel.revision, x0, x1, None, boxes_of(stage.window, trace, x0, x1, inside=True))
    return Drawing(channel.revision, x0, x1, line_of(stage.window, trace, x0, x1), None)


def line_of(window: Window, trace: Trace, x0: float, x1: float) -> Line:
    """The chain of the spans that touch what lies between two x."""
    spans = trace.channel.spans_between(window.time_from_x(x0 - REACH), window.time_from_x(x1 + REACH))
    return line_through(spans, window, TOLERANCE if trace.soft else THICKET)


def boxes_of(window: Window, trace: Trace, x0: float, x1: float, *, inside: bool, every: int = 1) -> Boxes:
    """The exact lowest to highest value of each pixel column; of the extrapolation every other group of *every*."""
    ends = trace.channel.ends()
    low, high = max(floor(x0 - window.left) - 1, 0), min(ceil(x1 - window.left) + 1, ceil(window.width))
    if ends is not None and inside:
        low = max(low, floor(min(max(window.x_from_time(ends.time0) - window.left, -1e9), 1e9)))
        high = min(high, floor(min(max(window.x_from_time(ends.time1) - window.left, -1e9), 1e9)) + 1)
    if ends is None or high <= low:
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
