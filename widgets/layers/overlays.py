"""What belongs to the pointer: hover, the dot where a key would be set, the selection box, the frame to scale by."""

from collections.abc import Sequence
from math import ceil
from typing import Final

from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QPainter, QPen

from model.sampling import FAR
from widgets.chosen import with_neighbours
from widgets.layers.curves import draw_curve
from widgets.layers.handles import KNOB, handles_of
from widgets.layers.keys import SELECTED
from widgets.stage import Stage
from widgets.traces import Trace

DOT: Final = 5.0
HANDLE_BOX: Final = 7.0


def draw_hovered_curve(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """The curve under the pointer, thicker than the rest."""
    hover = stage.overlay.hover
    if hover is None or hover.kind != "curve":
        return
    trace = None if hover.channel is None else stage.trace_of(hover.channel)
    if trace is not None and not trace.active:
        color = stage.theme.channel_color(trace.channel, trace.place)
        draw_curve(painter, stage, trace, color, x0, x1, min(trace.pixels(stage.window.unit) + 1, 4))


def draw_hover(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """A ring around the key or the handle under the pointer."""
    hover = stage.overlay.hover
    if hover is None or hover.channel is None or hover.id not in hover.channel:
        return
    handles = handles_of(with_neighbours(hover.channel, hover.id), hover.channel, stage.window)
    spots = {"key": handles.key, "handle_in": handles.into, "handle_out": handles.out}
    spot = spots.get(hover.kind)
    if spot is None:
        return
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
    painter.setPen(QPen(stage.theme.hover, stage.px(1.4)))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    radius = stage.px((SELECTED if hover.kind == "key" else KNOB) + 3.0)
    painter.drawEllipse(QPointF(*spot), radius, radius)


def draw_insert_preview(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """A dot with a cross on the curve, where Ctrl+click would set a key."""
    if stage.overlay.preview is None:
        return
    channel, time = stage.overlay.preview
    window = stage.window
    y = window.y_from_value(channel.value(time))
    center = QPointF(min(max(window.x_from_time(time), -FAR), FAR), min(max(y, -FAR), FAR))
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
    painter.setPen(QPen(stage.theme.background, stage.px(1)))
    painter.setBrush(stage.theme.accent)
    painter.drawEllipse(center, stage.px(DOT), stage.px(DOT))
    arm = stage.px(DOT - 2.2)
    painter.setPen(QPen(stage.theme.background, stage.px(1.4)))
    painter.drawLine(QLineF(center - QPointF(arm, 0), center + QPointF(arm, 0)))
    painter.drawLine(QLineF(center - QPointF(0, arm), center + QPointF(0, arm)))


def draw_box(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """The selection box while it is drawn."""
    box = stage.overlay.box
    if box is None:
        return
    fill = QColor(stage.theme.box)
    fill.setAlphaF(0.12)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    painter.setPen(QPen(stage.theme.box, max(round(stage.px(1)), 1)))
    painter.setBrush(fill)
    painter.drawRect(_whole(box.normalized(), stage))


def draw_frame(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """The scale and retime tools' box around the selection, its handles and its pivot."""
    frame = stage.overlay.frame
    if frame is None:
        return
    theme = stage.theme
    pen = QPen(theme.accent, max(round(stage.px(1)), 1))
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawRect(_whole(frame.box, stage))
    painter.setBrush(QBrush(theme.background))
    side = ceil(stage.px(HANDLE_BOX))
    for handle in frame.handles:
        center = stage.scaled(handle)
        painter.drawRect(QRectF(round(center.x() - side / 2) + 0.5, round(center.y() - side / 2) + 0.5, side, side))
    if frame.pivot is not None:
        center, arm = stage.scaled(frame.pivot), stage.px(6)
        painter.drawLine(QLineF(center - QPointF(arm, 0), center + QPointF(arm, 0)))
        painter.drawLine(QLineF(center - QPointF(0, arm), center + QPointF(0, arm)))


def _whole(box: QRectF, stage: Stage) -> QRectF:
    """A logical box in whole screen pixels, near enough to the window for Qt."""
    plot = stage.plot().adjusted(-200, -200, 200, 200)
    unit = stage.window.unit
    scaled = QRectF(box.topLeft() * unit, box.bottomRight() * unit).intersected(plot)
    return QRectF(
        QPointF(int(scaled.left()) + 0.5, int(scaled.top()) + 0.5),
        QPointF(int(scaled.right()) + 0.5, int(scaled.bottom()) + 0.5),
    )
