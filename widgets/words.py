"""Words: how wide they are in one font, and how they are painted; each is measured and laid out once."""

from typing import Final

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QFont, QFontMetricsF, QPainter, QStaticText

# Rulers write a few hundred different words an hour.
MOST_KEPT: Final = 4096
MOST_FONTS: Final = 64


class Words:
    """The words of one font; sizes are pixels of the screen."""

    def __init__(self, font: QFont) -> None:
        self.font = font
        self.metrics = QFontMetricsF(font)
        self.ascent, self.cap_height = self.metrics.ascent(), self.metrics.capHeight()
        self._widths: dict[str, float] = {}
        self._texts: dict[str, QStaticText] = {}

    def width(self, text: str) -> float:
        """How far the next word would begin from this one's beginning."""
        width = self._widths.get(text)
        if width is None:
            if len(self._widths) >= MOST_KEPT:
                self._widths.clear()
            width = self._widths[text] = self.metrics.horizontalAdvance(text)
        return width

    def draw(self, painter: QPainter, x: float, baseline: float, text: str) -> None:
        """Paint the word in this font, which the painter must already have, with the painter's pen."""
        static = self._texts.get(text)
        if static is None:
            if len(self._texts) >= MOST_KEPT:
                self._texts.clear()
            static = self._texts[text] = QStaticText(text)
            static.setTextFormat(Qt.TextFormat.PlainText)
        painter.drawStaticText(QPointF(x, baseline - self.ascent), static)


_KNOWN: dict[str, Words] = {}


def words_in(font: QFont) -> Words:
    """The words of a font with a size in pixels."""
    words = _KNOWN.get(key := font.key())
    if words is None:
        if len(_KNOWN) >= MOST_FONTS:
            _KNOWN.clear()
        words = _KNOWN[key] = Words(QFont(font))
    return words
