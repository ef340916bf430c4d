"""Names at the lines' ends, none over another; and the words that help when there is nothing to see."""

from collections.abc import Sequence
from itertools import islice
from math import inf, nan
from typing import Final

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter

from model.channel import Channel
from model.sampling import Window
from widgets.stage import Label, Stage
from widgets.traces import Trace

SIZE: Final = 0.92
# With more curves than this only the active one is named: the rest would be a column of words.
MOST: Final = 24
PAD: Final = 5.0
EDGE: Final = 6.0
LONGEST: Final = 0.3


def labels_of(stage: Stage) -> tuple[Label, ...]:
    """Where the names go: at the right edge, level with the lines, pushed apart where they would overlap."""
    window = stage.window
    traces = (*stage.resting, *stage.live)
    named = list(islice((trace for trace in traces if len(trace.channel)), MOST + 1))
    if len(named) > MOST:
        named = [trace for trace in traces if trace.active and len(trace.channel)]
    if not named:
        return ()
    words = stage.words(SIZE)
    metrics = words.metrics
    high = metrics.height() + stage.px(1)
    placed = []
    for trace in named:
        y = window.y_from_value(trace.channel.value(window.t1))
        if window.top <= y <= window.bottom or trace.active:
            arrow = "▲ " if y < window.top else "▼ " if y > window.bottom else ""
            placed.append((min(max(y, window.top), window.bottom), trace, arrow))
    placed.sort(key=lambda each: (each[0], each[1].place))
    room = int(window.height / high)
    if len(placed) > room:
        placed = [each for each in placed if each[1].active] or placed[:room]
    tops = _apart([y - high - stage.px(1) for y, _, _ in placed], high, window.top, window.bottom)
    found = []
    for (_, trace, arrow), top in zip(placed, tops, strict=True):
        text = metrics.elidedText(
            arrow + (trace.channel.name or "unnamed"), Qt.TextElideMode.ElideMiddle, window.width * LONGEST
        )
        width = words.width(text) + stage.px(2 * PAD)
        found.append(Label(trace, text, (window.right - stage.px(EDGE) - width, top, width, high)))
    return tuple(found)


def may_be_named(stage: Stage, channel: Channel) -> bool:
    """Whether what has changed of the channel may change a name in the picture."""
    filled = stage.filled
    many = len(filled) > MOST
    if len(channel):
        filled.add(channel)
    else:
        filled.discard(channel)
    return not many or len(filled) <= MOST or channel is stage.document.session.active


def _apart(tops: list[float], high: float, low: float, most: float) -> list[float]:
    """Ascending tops moved as little as it takes to stand below each other between *low* and *most*."""
    tops = [round(top) for top in tops]
    floor = low
    for i, top in enumerate(tops):
        tops[i] = floor = max(top, floor)
        floor += high
    ceiling = most
    for i in range(len(tops) - 1, -1, -1):
        tops[i] = min(tops[i], ceiling - high)
        ceiling = tops[i]
    return tops


def draw_labels(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """Each name in its channel's colour on a veil of the background."""
    shown = [label for label in stage.labels if label.box[0] <= x1]
    if not shown:
        return
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
    painter.setFont(stage.font(SIZE))
    descent = stage.words(SIZE).metrics.descent()
    veil = QColor(stage.theme.background)
    veil.setAlphaF(0.72)
    for label in shown:
        left, top, width, high = label.box
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(veil)
        painter.drawRoundedRect(QRectF(left, top, width, high), stage.px(3), stage.px(3))
        painter.setPen(label.trace.color)
        painter.drawText(QPointF(left + stage.px(PAD), top + high - descent), label.text)


def hint_of(stage: Stage, changed: tuple[float, float] = (inf, -inf)) -> str:
    """What to say in the middle of an empty picture, "" if there is something to see.

    Where something was seen is noted in the stage, best beside the times that are being *changed*.
    """
    stage.seen = None
    document, window = stage.document, stage.window
    if not document.clip.channels:
        if stage.overlay.notice:
            return f"{stage.overlay.notice} ..."
        return "Nothing here yet\nOpen a file with Ctrl+O, or drop one here"
    traces = (*stage.live, *stage.resting)
    if not traces:
        return "All channels are hidden\nAlt+H shows them again"
    # The first curve in view ends the search.
    for trace in traces:
        time = _seen_at(trace.channel, window, changed) if len(trace.channel) else None
        if time is not None:
            stage.seen = (trace.channel, time)
            return ""
    if not any(len(trace.channel) for trace in traces):
        return "No keys yet\nCtrl+click sets one, S keys all shown channels at the playhead"
    return "Nothing in view\nPress A to see all"


def _seen_at(channel: Channel, window: Window, changed: tuple[float, float]) -> float | None:
    """A time at which the curve lies in the window, NaN if it is not known which; None if there is none.

    A few of its values mostly tell, and cost next to nothing.
    """
    times = [window.t0 + part * (window.t1 - window.t0) for part in (0.5, 0.25, 0.75, 0.0, 1.0)]
    for time in sorted(times, key=lambda time: changed[0] <= time <= changed[1]):
        if window.v0 <= channel.value(time) <= window.v1:
            return time
    low, high = channel.extrema(window.t0, window.t1)
    return nan if low <= window.v1 and high >= window.v0 else None


def draw_hint(painter: QPainter, stage: Stage, traces: Sequence[Trace], x0: float, x1: float) -> None:
    """The words of `hint_of`, centred: the first line large, the next ones small."""
    if not stage.hint:
        return
    title, _, rest = stage.hint.partition("\n")
    plot = stage.plot()
    middle = plot.center().y()
    for text, size, color, y in (
        (title, 1.5, stage.theme.text, middle - stage.px(14)),
        (rest, 1.0, stage.theme.text_dim, middle + stage.px(14)),
    ):
        painter.setFont(stage.font(size))
        painter.setPen(color)
        box = QRectF(plot.left(), y - stage.px(20), plot.width(), stage.px(40))
        painter.drawText(box, int(Qt.AlignmentFlag.AlignCenter), text)
