"""Draws a clip into a picture, without a window: what the curve view would show."""

import os
from collections.abc import Sequence

from PySide6.QtCore import QBuffer, QIODevice, Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication

from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.saving import SaveError, save_atomic
from widgets.curve_view import CurveView
from widgets.fitting import all_fitted, fitted_between
from widgets.theme import Theme


def render(
    clip: Clip,
    channels: Sequence[Channel],
    out: str,
    *,
    size: tuple[int, int] = (1600, 900),
    start: float | None = None,
    end: float | None = None,
) -> None:
    """Write a PNG of *channels* from *start* to *end* (seconds), each the clip's own unless given; SaveError."""
    if QApplication.instance() is None:
        os.environ["QT_QPA_PLATFORM"] = "offscreen"  # a picture needs no screen, and a server has none
        os.environ.setdefault("QT_NO_GUI_THREADPOOL", "1")
    app = QApplication.instance() or QApplication(["hermite"])
    save_atomic(out, png_of(image_of(clip, channels, size, start, end)))
    del app


def image_of(
    clip: Clip, channels: Sequence[Channel], size: tuple[int, int], start: float | None = None, end: float | None = None
) -> QImage:
    """The picture, as large as asked for."""
    document = Document(clip)
    if len(channels) < len(clip.channels):
        document.session.solo = frozenset(channels)
    document.session.playhead = clip.start
    view = CurveView(document, Theme.current())
    try:
        view.setAttribute(Qt.WidgetAttribute.WA_DontShowOnScreen)
        view.resize(*size)
        view.show()
        if start is not None or end is not None:
            shown = all_fitted(document)
            view.set_view(
                fitted_between(document, shown.t0 if start is None else start, shown.t1 if end is None else end)
            )
        image = QImage(*size, QImage.Format.Format_RGB32)
        view.viewport().render(image)
        view.canvas.settle()  # a picture that takes long is begun with what can be drawn at once
        view.viewport().render(image)
    finally:
        view.close()
        view.deleteLater()
    return image


def png_of(image: QImage) -> bytes:
    """The picture as the bytes of a PNG file; SaveError if it cannot be encoded."""
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    if not image.save(buffer, "PNG"):  # type: ignore[call-overload]  # Qt takes the name as text
        raise SaveError("the picture", "it could not be encoded as PNG")
    return bytes(buffer.data().data())
