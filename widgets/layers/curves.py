"""Curves between the first and the last key: soft lines where keys are few, exact columns where they are many."""

from collections.abc import Sequence
from itertools import groupby

from PySide6.QtGui import QColor, QPainter

from model.channel import Spans
from model.lines import TOLERANCE, Line, dashes, lines_through
from model.sampling import Window
from widgets.layers.drawings import REACH, THICKET, boxes_of, line_of
from widgets.painting import draw_boxes, draw_chain, draw_lines, hair
from widgets.stage import Stage
from widgets.traces import Trace


def draw_curves(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """Each trace's curve from *x0* to *x1*; how it is drawn is decided by the whole window, never by this part."""
    window = stage.window
    t0, t1 = window.time_from_x(x0 - REACH), window.time_from_x(x1 + REACH)
    for soft, group in groupby(traces, lambda trace: trace.soft):
        # In the order of the traces: a chain that is at hand, or the spans for one.
        lined: list[tuple[Trace, Line | Spans]] = []
        for trace in group:
            channel = trace.channel
            ready = stage.ready.get(channel) if stage.ready else None
            if ready is not None and ready.serves(channel.revision, x0, x1):
                stage.painted[channel] = ready
                if ready.boxes is not None:
                    draw_boxes(painter, trace.color, ready.boxes_between(x0, x1))
                elif ready.line is not None:
                    lined.append((trace, ready.line))
                continue
            stage.painted.pop(channel, None)
            ends = channel.ends()
            if ends is None or ends.time1 < t0 or ends.time0 > t1 or len(channel) < 2:
                continue
            if stage.in_columns(trace):
                draw_boxes(painter, trace.color, boxes_of(window, trace, x0, x1, inside=True))
                continue
            spans = channel.spans_between(t0, t1)
            if len(spans.time0):
                lined.append((trace, spans))
        several = [spans for _, spans in lined if isinstance(spans, Spans)]
        lines = iter(lines_through(several, window, TOLERANCE if soft else THICKET) if several else ())
        for trace, line in lined:
            pattern = _dash_of(stage, trace)
            chain = next(lines) if isinstance(line, Spans) else line
            draw_line(painter, window, chain, trace, trace.color, trace.pixels(window.unit), pattern)


def draw_curve(painter: QPainter, stage: Stage, trace: Trace, color: QColor, x0: float, x1: float, width: int) -> None:
    """One curve in one colour."""
    window, channel = stage.window, trace.channel
    if len(channel) < 2:
        return
    if stage.in_columns(trace):
        draw_boxes(painter, color, boxes_of(window, trace, x0, x1, inside=True))
    else:
        draw_line(painter, window, line_of(window, trace, x0, x1), trace, color, width, _dash_of(stage, trace))


def _dash_of(stage: Stage, trace: Trace) -> tuple[float, ...]:
    return () if trace.dash and stage.manner_of(trace.channel).undashed else trace.dash


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
