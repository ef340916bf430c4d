"""Extrapolation: before the first and after the last key, dim and dashed, as far as the view reaches."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QPainter

from model.channel import Spans
from model.lines import HUGE, line_through, straight_dashes
from model.sampling import Window, slope_outside, spans_outside
from widgets.layers.curves import draw_line
from widgets.layers.drawings import REACH, boxes_of
from widgets.painting import draw_boxes, draw_lines, hair
from widgets.stage import Stage
from widgets.traces import Trace

type Floats = NDArray[np.float64]

DASH: Final = (3.0, 4.0)
# How many pixel columns are drawn, and then left out, where repeats are too dense for dashes.
STRIPES: Final = 4.0
NO_LINES: Final[Floats] = np.empty((0, 4))


def draw_extrapolation(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """Both sides of each trace between *x0* and *x1*."""
    window = stage.window
    left, t0, per_second = window.left, window.t0, window.px_per_second
    sides: list[tuple[Trace, bool, float, float]] = []
    straight: list[tuple[float, float, float, float, float]] = []
    places: list[int] = []
    # A dash that is cut here must lie beside what is painted: its slope is not quite that of the whole one.
    reach = REACH + DASH[0] * window.unit
    for trace in traces:
        ends = trace.channel.ends()
        if ends is None:
            continue
        for after, time, value in ((False, ends.time0, ends.value0), (True, ends.time1, ends.value1)):
            edge = min(max(left + (time - t0) * per_second, -HUGE), HUGE)
            low, high = (max(x0, edge), x1) if after else (x0, min(x1, edge))
            if low > high:
                continue
            slope = slope_outside(trace.channel, after=after)
            if slope is not None:
                seen = (max(x0 - reach, edge), x1 + reach) if after else (x0 - reach, min(x1 + reach, edge))
                straight.append((edge, value, slope, *seen))
                places.append(len(sides))
            sides.append((trace, after, low, high))
    if not sides:
        return
    lines = dict(zip(places, _straight_lines(window, np.array(straight)), strict=True)) if straight else {}
    for i, (trace, after, low, high) in enumerate(sides):
        if i in lines and i + 1 in lines and sides[i + 1][0] is trace:
            lines[i + 1] = np.concatenate((lines[i], lines[i + 1]))
        elif i in lines and len(lines[i]):
            _draw_straight(painter, stage, trace, lines[i])
        elif i not in lines:
            _draw_repeats(painter, stage, trace, low, high, after=after)


def _straight_lines(window: Window, straight: Floats) -> list[Floats]:
    """The dashes of lines (n, 5) through an x and a value with a slope, between two x; one takes as long as many."""
    x, value, slope, low, high = straight.T
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        fall = np.clip(slope * -(window.px_per_value / window.px_per_second), -HUGE, HUGE)
        y = np.clip(window.y_from_value(value), -HUGE, HUGE)
        top, bottom = window.top - REACH, window.bottom + REACH
        edges = x + (np.array(((top,), (bottom,))) - y) / fall
    level = fall == 0.0
    low = np.where(level, low, np.maximum(low, edges.min(axis=0)))
    high = np.where(level, np.where((y >= top) & (y <= bottom), high, low), np.minimum(high, edges.max(axis=0)))
    (seen,) = (low < high).nonzero()
    dash, gap = (part * window.unit for part in DASH)
    rays = np.stack((x, y, fall, low, high), axis=1)[seen]
    found: list[Floats] = [NO_LINES] * len(straight)
    if len(seen):
        cut = straight_dashes(rays, dash, gap, window.x_from_time(0.0), window.left)
        for i, lines in zip(seen.tolist(), cut, strict=True):
            found[i] = lines
    return found


def _draw_straight(painter: QPainter, stage: Stage, trace: Trace, lines: Floats) -> None:
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, trace.soft)
    painter.setPen(hair(trace.faint, flat=True))
    draw_lines(painter, lines, _thickness(trace, stage.window.unit))


def _draw_repeats(painter: QPainter, stage: Stage, trace: Trace, x0: float, x1: float, *, after: bool) -> None:
    """Exact spans, or exact columns where the repeats are denser than the pixels."""
    window = stage.window
    t0, t1 = window.time_from_x(window.left - REACH), window.time_from_x(window.right + REACH)
    spans = spans_outside(trace.channel, t0, t1, after=after, most=int(window.width / 2))
    if spans is None:
        stripes = max(round(STRIPES * window.unit), 2)
        draw_boxes(painter, trace.faint, boxes_of(window, trace, x0, x1, inside=False, every=stripes))
        return
    shown = (spans.time1 >= window.time_from_x(x0 - REACH)) & (spans.time0 <= window.time_from_x(x1 + REACH))
    spans = Spans(*(column[shown] for column in spans))
    line = line_through(spans, window)
    draw_line(painter, window, line, trace, trace.faint, _thickness(trace, window.unit), DASH)


def _thickness(trace: Trace, unit: float) -> int:
    return max(trace.pixels(unit) - 1, 1)
