"""Extrapolation: before the first and after the last key, dim and dashed, as far as the view reaches."""

from collections.abc import Sequence
from typing import Final

from PySide6.QtGui import QPainter

from model.sampling import spans_outside
from widgets.layers.curves import REACH, draw_columns, draw_spans
from widgets.stage import Stage
from widgets.traces import Trace

DASH: Final = (5.0, 4.0)


def draw_extrapolation(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """Both sides of each trace: exact spans, or exact columns where the repeats are denser than the pixels."""
    window = stage.window
    for trace in traces:
        first, last = trace.channel.first, trace.channel.last
        if first is None or last is None:
            continue
        most = int(window.width / 2)
        for after, end in ((False, first), (True, last)):
            edge = window.x_from_time(end.time)
            low, high = (max(x0, edge), x1) if after else (x0, min(x1, edge))
            if low > high:
                continue
            t0, t1 = window.time_from_x(window.left - 9), window.time_from_x(window.right + 9)
            spans = spans_outside(trace.channel, t0, t1, after=after, most=most)
            if spans is None:
                draw_columns(
                    painter, window, trace, trace.faint, low, high, inside=False, every=max(round(4 * window.unit), 2)
                )
                continue
            shown = (spans.time1 >= window.time_from_x(x0 - REACH)) & (spans.time0 <= window.time_from_x(x1 + REACH))
            spans = type(spans)(*(column[shown] for column in spans))
            draw_spans(painter, window, spans, trace, trace.faint, max(trace.pixels(window.unit) - 1, 1), DASH)
