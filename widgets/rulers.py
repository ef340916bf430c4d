"""The two rulers: time above the plot, with the playhead's head and the clip's range; value to its left."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPolygonF

from model.sampling import Window
from widgets.painting import draw_lines, hair
from widgets.stage import LABEL_SIZE, Stage
from widgets.ticks import frame_ticks, plain

# Logical pixels; multiples of four stay whole at the device ratios 1.25, 1.5 and 1.75.
TIME_HEIGHT: Final = 40.0
BAND_HEIGHT: Final = 5.0
HEAD_HALF: Final = 6.0
FRAME_SIZE: Final = 0.78
FRAMES_APART: Final = 44.0
# How far from the playhead its head may reach, or the numbers that make room for it.
HEAD_REACH: Final = 110.0


def draw_value_ruler(painter: QPainter, stage: Stage) -> None:
    """Numbers of values, right-aligned, each beside its line; a number that would be cut is left out."""
    window, theme = stage.window, stage.theme
    painter.fillRect(QRectF(0, window.top, window.left, window.height), theme.ruler)
    painter.setFont(stage.font(LABEL_SIZE))
    words = stage.words(LABEL_SIZE)
    y = np.floor(window.y_from_value(stage.value_ticks.major)) + 0.5
    painter.setPen(hair(theme.ruler_line))
    start, end = np.full(len(y), window.left - stage.px(4)), np.full(len(y), window.left - 1)
    draw_lines(painter, np.stack((start, y, end, y), axis=1))
    painter.setPen(theme.ruler_text)
    half = words.cap_height / 2
    for label, middle in zip(stage.value_ticks.labels, y.tolist(), strict=True):
        if window.top + half + 1 <= middle <= window.bottom - half - 1:
            words.draw(painter, window.left - stage.px(7) - words.width(label), middle + half, label)
    painter.setPen(hair(theme.ruler_line))
    painter.drawLine(QPointF(window.left - 0.5, window.top), QPointF(window.left - 0.5, window.bottom))


def draw_time_ruler(painter: QPainter, stage: Stage) -> None:
    """Seconds, below them the frame numbers, and the band of the clip's range; in the corner the units of both axes."""
    window, theme = stage.window, stage.theme
    height = window.top
    painter.fillRect(QRectF(0, 0, window.right, height), theme.ruler)
    painter.save()
    painter.setClipRect(QRectF(window.left, 0, window.width, height), Qt.ClipOperation.IntersectClip)
    _draw_band(painter, stage)
    x = np.floor(window.x_from_time(stage.time_ticks.major)) + 0.5
    minor = np.floor(window.x_from_time(stage.time_ticks.minor)) + 0.5
    low = height - stage.px(BAND_HEIGHT)
    painter.setPen(hair(theme.ruler_line))
    draw_lines(
        painter, np.stack((minor, np.full(len(minor), low - stage.px(3)), minor, np.full(len(minor), low)), axis=1)
    )
    draw_lines(painter, np.stack((x, np.full(len(x), low - stage.px(7)), x, np.full(len(x), low)), axis=1))
    painter.setFont(stage.font(LABEL_SIZE))
    painter.setPen(theme.ruler_text)
    _draw_centred(painter, stage, x.tolist(), stage.time_ticks.labels, LABEL_SIZE, stage.px(13))
    _draw_frames(painter, stage)
    painter.restore()
    painter.fillRect(QRectF(0, 0, window.left, height), theme.ruler)
    painter.setPen(hair(theme.ruler_line))
    painter.drawLine(QPointF(0, height - 0.5), QPointF(window.right, height - 0.5))
    painter.setPen(theme.text_dim)
    painter.setFont(stage.font(FRAME_SIZE))
    unit = "°" if stage.degrees else stage.unit
    room = window.left - stage.px(14)
    for text, top in (
        ("s", 0.0),
        (stage.words(FRAME_SIZE).metrics.elidedText(unit, Qt.TextElideMode.ElideRight, room), 20.0),
    ):
        box = QRectF(0, stage.px(top), window.left - stage.px(7), stage.px(18))
        painter.drawText(box, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, text)


def _draw_frames(painter: QPainter, stage: Stage) -> None:
    """Numbers of frames: each, or every second, fifth, tenth one, so that they have room at every zoom."""
    window, rate = stage.window, stage.document.clip.frame_rate
    longest = "f" + plain(max(abs(window.t0), abs(window.t1)) * rate, 0)
    apart = max(stage.px(FRAMES_APART), stage.words(FRAME_SIZE).width(longest) + stage.px(14))
    frames = frame_ticks(window.t0, window.t1, rate, window.width, apart)
    painter.setFont(stage.font(FRAME_SIZE))
    painter.setPen(stage.theme.text_dim)
    labels = ["f" + plain(frame, 0) for frame in frames.tolist()]
    _draw_centred(painter, stage, window.x_from_time(frames / rate).tolist(), labels, FRAME_SIZE, stage.px(25))


def _draw_centred(
    painter: QPainter, stage: Stage, x: list[float], labels: Sequence[str], size: float, baseline: float
) -> None:
    """Words centred at x, without those that would be cut at an end or by the playhead's head."""
    window, words = stage.window, stage.words(size)
    gap, tip, playhead = stage.px(3), stage.px(HEAD_HALF), window.x_from_time(stage.document.session.playhead)
    taken = [(playhead - tip, playhead + tip)]
    head = _head(stage)[0]
    if baseline - words.cap_height < head.bottom() and head.top() < baseline:
        taken.append((head.left(), head.right()))
    first, last = window.left - 1, window.right + 1
    for label, middle in zip(labels, x, strict=True):
        half = words.width(label) / 2
        left, right = middle - half - gap, middle + half + gap
        if first <= left and right <= last and not any(left < end and begin < right for begin, end in taken):
            words.draw(painter, middle - half, baseline, label)


def _draw_band(painter: QPainter, stage: Stage) -> None:
    window, clip, theme = stage.window, stage.document.clip, stage.theme
    if not clip.end > clip.start:
        return
    with np.errstate(over="ignore"):
        edges = window.x_from_time(np.array([clip.start, clip.end]))
    x0, x1 = np.clip(edges, window.left - 9, window.right + 9).tolist()
    top = window.top - stage.px(BAND_HEIGHT)
    band = theme.range
    painter.setOpacity(0.45)
    painter.fillRect(QRectF(x0, top, x1 - x0, stage.px(BAND_HEIGHT)), band)
    painter.setOpacity(1.0)
    for x in (x0, x1):
        painter.fillRect(
            QRectF(round(x) - stage.px(1), top - stage.px(4), stage.px(2), stage.px(BAND_HEIGHT + 4)), band
        )


def head_reach(window: Window, time: float) -> QRectF:
    """What the playhead's head at *time* paints or makes room for; empty outside the window."""
    x = window.x_from_time(time)
    if not window.left - 1 <= x <= window.right + 1:
        return QRectF()
    reach = HEAD_REACH * window.unit
    return QRectF(x - reach, 0, 2 * reach, window.top)


def _head(stage: Stage) -> tuple[QRectF, str]:
    """The box of the playhead's head and the time in it; empty outside the window."""
    window, time = stage.window, stage.document.session.playhead
    x = window.x_from_time(time)
    if not window.left - 1 <= x <= window.right + 1:
        return QRectF(), ""
    major = stage.time_ticks.major
    step = major[1] - major[0] if len(major) > 1 else 1.0
    label = plain(time, min(max(3, 2 - int(np.floor(np.log10(step)))), 9))
    width = stage.words(LABEL_SIZE).width(label) + stage.px(10)
    left = x - width / 2
    if window.width > width:
        left = min(max(left, window.left), window.right - width)
    return QRectF(round(left), stage.px(1), round(width), stage.px(17)), label


def draw_playhead_head(painter: QPainter, stage: Stage) -> None:
    """The head of the playhead in the time ruler, with the time in it."""
    window, theme = stage.window, stage.theme
    box, label = _head(stage)
    if box.isEmpty():
        return
    x = int(window.x_from_time(stage.document.session.playhead)) + max(round(stage.px(1)), 1) / 2
    tip = stage.px(HEAD_HALF)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(theme.playhead)
    painter.drawRoundedRect(box, stage.px(3), stage.px(3))
    low = box.bottom()
    painter.drawPolygon(QPolygonF([QPointF(x - tip, low), QPointF(x + tip, low), QPointF(x, low + tip)]))
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    width = max(round(stage.px(1)), 1)
    painter.fillRect(QRectF(x - width / 2, low, width, window.top - low), theme.playhead)
    painter.setFont(stage.font(LABEL_SIZE))
    painter.setPen(theme.playhead_text)
    painter.drawText(QPointF(box.left() + stage.px(5), stage.px(13)), label)
