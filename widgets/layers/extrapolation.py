"""Extrapolation: before the first and after the last key, dim and dashed, as far as the view reaches."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt
from PySide6.QtGui import QPainter

from model.channel import Spans
from model.lines import HUGE, line_through, straight_dashes
from model.sampling import Window, slope_outside, spans_outside
from widgets.layers.curves import REACH, draw_columns, draw_line
from widgets.painting import draw_lines, hair
from widgets.stage import Stage
from widgets.traces import Trace

type Floats = NDArray[np.float64]
type Ray = tuple[float, float, float, float, float]

DASH: Final = (3.0, 4.0)
# How many pixel columns are drawn, and then left out, where repeats are too dense for dashes.
STRIPES: Final = 4.0


def draw_extrapolation(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """Both sides of each trace between *x0* and *x1*."""
    window = stage.window
    sides: list[tuple[Trace, bool, float, float]] = []
    rays: dict[int, Ray] = {}
    # A dash that is cut here must lie beside what is painted: its slope is not quite that of the whole one.
    reach = REACH + DASH[0] * window.unit
    left, t0, per_second = window.left, window.t0, window.px_per_second
    for trace in traces:
        ends = trace.channel.ends()
        if ends is None:
            continue
        for after, time, value in ((False, ends.time0, ends.value0), (True, ends.time1, ends.value1)):
            edge = left + (time - t0) * per_second
            low, high = (max(x0, edge), x1) if after else (x0, min(x1, edge))
            if low > high:
                continue
            slope = slope_outside(trace.channel, after=after)
            if slope is not None:
                seen = (max(x0 - reach, edge), x1 + reach) if after else (x0 - reach, min(x1 + reach, edge))
                ray = _ray(window, slope, edge, value, seen)
                if ray is None:
                    continue
                rays[len(sides)] = ray
            sides.append((trace, after, low, high))
    # Cut together, as nearly all work on a few dashes is fixed; painted in turn, so that the same ones lie on top.
    dash, gap = (part * window.unit for part in DASH)
    anchor = window.x_from_time(0.0)
    cut = straight_dashes(np.array(list(rays.values())), dash, gap, anchor, left) if rays else []
    lines = dict(zip(rays, cut, strict=True))
    for i, (trace, after, low, high) in enumerate(sides):
        if i in lines and i + 1 in lines and sides[i + 1][0] is trace:
            lines[i + 1] = np.concatenate((lines[i], lines[i + 1]))
        elif i in lines:
            _draw_straight(painter, stage, trace, lines[i])
        else:
            _draw_repeats(painter, stage, trace, low, high, after=after)


def _ray(window: Window, slope: float, x: float, value: float, seen: tuple[float, float]) -> Ray | None:
    """The line through x, value with this slope as (x, y, fall, low, high) in pixels; None if nobody sees it."""
    fall = min(max(-slope * (window.px_per_value / window.px_per_second), -HUGE), HUGE)
    y = min(max(window.y_from_value(value), -HUGE), HUGE)
    low, high = seen
    if fall:
        edges = sorted(x + (edge - y) / fall for edge in (window.top - REACH, window.bottom + REACH))
        low, high = max(low, edges[0]), min(high, edges[1])
    elif not window.top - REACH <= y <= window.bottom + REACH:
        return None
    return (x, y, fall, low, high) if low < high else None


def _draw_straight(painter: QPainter, stage: Stage, trace: Trace, lines: Floats) -> None:
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, trace.soft)
    pen = hair(trace.faint)
    pen.setCapStyle(Qt.PenCapStyle.FlatCap)
    painter.setPen(pen)
    draw_lines(painter, lines, _thickness(trace, stage.window.unit))


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
