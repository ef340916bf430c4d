"""Icons: our own SVG drawings in the colours of the theme, sharp at every size."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

from PySide6.QtCore import QByteArray, QRect, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QIcon, QIconEngine, QPainter, QPixmap
from PySide6.QtSvg import QSvgRenderer

from widgets.guard import guarded

ICONS_FOLDER = Path(__file__).resolve().parent.parent / "resources" / "icons"
# The drawings use two colours: the one of the text around them, and this one for the part that matters.
ACCENT_IN_DRAWINGS = "#4a90e2"

# Gives (stroke, accent) for how an icon is shown.
type Tint = Callable[[QIcon.Mode, QIcon.State], tuple[QColor, QColor]]


class TintedIcon(QIconEngine):
    """Paints one drawing in the colours of that moment, so that a change of theme needs only a repaint."""

    def __init__(self, name: str, tint: Tint) -> None:
        super().__init__()
        _drawing(name)  # an unknown name fails here, not in a paint event
        self._name = name
        self._tint = tint

    @guarded()
    def paint(self, painter: QPainter, rect: QRect, mode: QIcon.Mode, state: QIcon.State) -> None:
        ratio = painter.device().devicePixelRatio()
        painter.drawPixmap(rect, self._picture(rect.size() * ratio, mode, state))

    @guarded(lambda icon: QPixmap())
    def pixmap(self, size: QSize, mode: QIcon.Mode, state: QIcon.State) -> QPixmap:
        return self._picture(size, mode, state)

    @guarded(lambda icon: QPixmap())
    def scaledPixmap(self, size: QSize, mode: QIcon.Mode, state: QIcon.State, scale: float) -> QPixmap:
        pixmap = QPixmap(self._picture(size * scale, mode, state))
        pixmap.setDevicePixelRatio(scale)
        return pixmap

    @guarded()
    def clone(self) -> QIconEngine:
        return TintedIcon(self._name, self._tint)

    def _picture(self, size: QSize, mode: QIcon.Mode, state: QIcon.State) -> QPixmap:
        stroke, accent = self._tint(mode, state)
        return picture(self._name, size.width(), size.height(), stroke, accent)


def picture(name: str, width: int, height: int, stroke: QColor, accent: QColor) -> QPixmap:
    """The drawing in physical pixels, centred, kept for the next time."""
    return _picture(name, width, height, stroke.name(), accent.name())


@lru_cache(maxsize=2048)
def _picture(name: str, width: int, height: int, stroke: str, accent: str) -> QPixmap:
    pixmap = QPixmap(max(width, 1), max(height, 1))
    pixmap.fill(Qt.GlobalColor.transparent)
    drawing = _drawing(name).replace("currentColor", stroke).replace(ACCENT_IN_DRAWINGS, accent)
    side = min(width, height)
    with QPainter(pixmap) as painter:
        place = QRectF((width - side) / 2, (height - side) / 2, side, side)
        QSvgRenderer(QByteArray(drawing.encode())).render(painter, place)
    return pixmap


@lru_cache(maxsize=512)
def _drawing(name: str) -> str:
    return (ICONS_FOLDER / f"{name}.svg").read_text(encoding="utf-8")
