"""Extrapolation: before the first and after the last key, dim and dashed, as far as the view reaches."""

from collections.abc import Sequence
from typing import Final

from PySide6.QtCore import Qt
from PySide6.QtGui import QPainter

from model.channel import Spans
from model.keyframe import Keyframe
from model.lines import line_through, straight_dashes
from model.sampling import FAR, slope_outside, spans_outside
from widgets.layers.curves import REACH, anchor_of, draw_columns, draw_line
from widgets.painting import draw_lines, hair
from widgets.stage import Stage
from widgets.traces import Trace

DASH: Final = (5.0, 4.0)
# How many pixel columns are drawn, and then left out, where repeats are too dense for dashes.
STRIPES: Final = 4.0


def draw_extrapolation(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """Both sides of each trace between *x0* and *x1*."""
    window = stage.window
    for trace in traces:
        for after, end in ((False, trace.channel.first), (True, trace.channel.last)):
            if end is None:
                continue
            edge = window.x_from_time(end.time)
            low, high = (max(x0, edge), x1) if after else (x0, min(x1, edge))
            if low > high:
                continue
            slope = slope_outside(trace.channel, after=after)
            if slope is None:
                _draw_repeats(painter, stage, trace, low, high, after=after)
            else:
                _draw_straight(painter, stage, trace, slope, end, (x0 - REACH, x1 + REACH), after=after)


def _draw_straight(
    painter: QPainter,
    stage: Stage,
    trace: Trace,
    slope: float,
    end: Keyframe,
    seen: tuple[float, float],
    *,
    after: bool,
) -> None:
    window = stage.window
    x = min(max(window.x_from_time(end.time), -FAR), FAR)
    # From a key far beside the window the line is measured at the window's edge, where pixels are exact.
    start = max(x, window.left - REACH) if after else min(x, window.right + REACH)
    value = end.value + slope * (window.time_from_x(start) - end.time)
    fall = -slope * (window.px_per_value / window.px_per_second)
    y = min(max(window.y_from_value(value), -1e15), 1e15)
    if not slope and not window.top - REACH <= y <= window.bottom + REACH:
        return
    pattern = tuple(part * window.unit for part in DASH)
    x0, x1 = (start, window.right + REACH) if after else (window.left - REACH, start)
    y0 = y if after else y + (x0 - start) * fall
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, trace.soft)
    pen = hair(trace.faint)
    pen.setCapStyle(Qt.PenCapStyle.FlatCap)
    painter.setPen(pen)
    lines = straight_dashes(x0, x1, min(max(y0, -1e15), 1e15), fall, pattern, anchor_of(window, pattern), seen)
    draw_lines(painter, lines, _thickness(trace, window.unit))


def _draw_repeats(painter: QPainter, stage: Stage, trace: Trace, x0: float, x1: float, *, after: bool) -> None:
    """Exact spans, or exact columns where the repeats are denser than the pixels."""
    window = stage.window
    t0, t1 = window.time_from_x(window.left - REACH), window.time_from_x(window.right + REACH)
    spans = spans_outside(trace.channel, t0, t1, after=after, most=int(window.width / 2))
    if spans is None:
        stripes = max(round(STRIPES * window.unit), 2)
        draw_columns(painter, window, trace, trace.faint, x0, x1, inside=False, every=stripes)
        return
    shown = (spans.time1 >= window.time_from_x(x0 - REACH)) & (spans.time0 <= window.time_from_x(x1 + REACH))
    spans = Spans(*(column[shown] for column in spans))
    line = line_through(spans, window)
    draw_line(painter, window, line, trace, trace.faint, _thickness(trace, window.unit), DASH)


def _thickness(trace: Trace, unit: float) -> int:
    return max(trace.pixels(unit) - 1, 1)
