"""Curves between the first and the last key: soft lines where keys are few, exact columns where they are many."""

from collections.abc import Sequence
from itertools import groupby
from math import ceil, floor
from typing import Final

import numpy as np
from PySide6.QtGui import QColor, QPainter

from model.lines import TOLERANCE, Line, dashes, line_through, lines_through
from model.sampling import Window, columns
from widgets.painting import draw_boxes, draw_chain, draw_lines, hair
from widgets.stage import Stage
from widgets.traces import Trace

# How far a line reaches beside its mathematical place.
REACH: Final = 4.0
# How far, in pixels, the hard lines of a thicket may lie beside a steep curve.
THICKET: Final = 0.8


def draw_curves(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """Each trace's curve from *x0* to *x1*; how it is drawn is decided by the whole window, never by this part."""
    window = stage.window
    t0, t1 = window.time_from_x(x0 - REACH), window.time_from_x(x1 + REACH)
    for soft, group in groupby(traces, lambda trace: trace.soft):
        lined = []
        for trace in group:
            ends = trace.channel.ends()
            if ends is None or ends.time1 < t0 or ends.time0 > t1:
                continue
            if len(trace.channel) > 1 and not _drawn_crowded(painter, stage, trace, trace.color, x0, x1):
                spans = trace.channel.spans_between(t0, t1)
                if len(spans.time0):
                    lined.append((trace, spans))
        lines = lines_through([spans for _, spans in lined], window, TOLERANCE if soft else THICKET)
        for (trace, _), line in zip(lined, lines, strict=True):
            pattern = _dash_of(stage, trace)
            draw_line(painter, window, line, trace, trace.color, trace.pixels(window.unit), pattern)


def draw_curve(painter: QPainter, stage: Stage, trace: Trace, color: QColor, x0: float, x1: float, width: int) -> None:
    """One curve in one colour."""
    window, channel = stage.window, trace.channel
    if len(channel) > 1 and not _drawn_crowded(painter, stage, trace, color, x0, x1):
        spans = channel.spans_between(window.time_from_x(x0 - REACH), window.time_from_x(x1 + REACH))
        line = line_through(spans, window, TOLERANCE if trace.soft else THICKET)
        draw_line(painter, window, line, trace, color, width, _dash_of(stage, trace))


def _dash_of(stage: Stage, trace: Trace) -> tuple[float, ...]:
    return () if trace.dash and stage.manner_of(trace.channel).undashed else trace.dash


def _drawn_crowded(painter: QPainter, stage: Stage, trace: Trace, color: QColor, x0: float, x1: float) -> bool:
    if not stage.manner_of(trace.channel).columns:
        return False
    draw_columns(painter, stage.window, trace, color, x0, x1, inside=True)
    return True


def draw_line(
    painter: QPainter,
    window: Window,
    line: Line,
    trace: Trace,
    color: QColor,
    width: int,
    pattern: tuple[float, ...],
) -> None:
    """One chain, dashed if there is a pattern (in logical pixels)."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, trace.soft)
    painter.setPen(hair(color, flat=True))
    if not pattern:
        draw_chain(painter, line, width)
        return
    scaled = tuple(part * window.unit for part in pattern)
    draw_lines(painter, dashes(line, scaled, window.top - REACH, window.bottom + REACH), width)


def draw_columns(
    painter: QPainter,
    window: Window,
    trace: Trace,
    color: QColor,
    x0: float,
    x1: float,
    *,
    inside: bool,
    every: int = 1,
) -> None:
    """The exact lowest to highest value of each pixel column; of the extrapolation every other group of *every*."""
    ends = trace.channel.ends()
    if ends is None:
        return
    low, high = max(floor(x0 - window.left) - 1, 0), min(ceil(x1 - window.left) + 1, ceil(window.width))
    if inside:
        low = max(low, floor(min(max(window.x_from_time(ends.time0) - window.left, -1e9), 1e9)))
        high = min(high, floor(min(max(window.x_from_time(ends.time1) - window.left, -1e9), 1e9)) + 1)
    if high <= low:
        return
    top, bottom = columns(trace.channel, window, low, high, inside=inside)
    more = 1 if trace.active else 0
    boxes = np.empty((high - low, 4), np.int32)
    x = boxes[:, 0] = np.arange(window.left + low, window.left + high)
    boxes[:, 1], boxes[:, 2], boxes[:, 3] = np.floor(top), x + more, np.floor(bottom) + more
    if every > 1:
        phase = floor(window.t0 * window.px_per_second) % (2 * every)
        boxes = boxes[(np.arange(low, high) + phase) // every % 2 == 0]
    draw_boxes(painter, color, boxes)
