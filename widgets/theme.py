"""Theme: one look for all widgets, dark or light, and the colour of every channel."""

import re
from functools import lru_cache
from typing import TYPE_CHECKING, Final, Self

from PySide6.QtCore import QObject, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QIcon, QPalette, QPen, QPixmap
from PySide6.QtWidgets import QApplication, QToolTip

from widgets.colors import AXIS_COLORS, COLORS, CURVE_COLORS, DASHES, DISABLED_ROLES, PALETTE_ROLES, legible, mix
from widgets.icons import TintedIcon, picture

if TYPE_CHECKING:
    from collections.abc import Sequence

    from model.channel import Channel

SCHEMES: Final = {
    "system": Qt.ColorScheme.Unknown,
    "dark": Qt.ColorScheme.Dark,
    "light": Qt.ColorScheme.Light,
}
# tx, rotateY, pos.z, scale_x end with the axis; Xrotation, Zposition begin with it.
AXIS_LAST: Final = re.compile(
    r"(?i)^(?P<what>|[trspvw]|(?:local|world)?(?:trans(?:late|lation)?|rot(?:ate|ation)?|scale|pos(?:ition)?|loc(?:ation)?"
    r"|euler|angle|orient|dir(?:ection)?|vel(?:ocity)?)?)[._ -]?(?P<axis>[xyz])$"
)
AXIS_FIRST: Final = re.compile(r"(?i)^(?P<axis>[xyz])[._ -]?(?P<what>rotation|position|translation|location|scale)$")


class Theme(QObject):
    """Colours, pens, fonts and icons; attributes named in COLORS change with the theme, then theme_changed tells."""

    theme_changed = Signal()

    background: QColor
    outside: QColor
    grid: QColor
    grid_strong: QColor
    zero_line: QColor
    ruler: QColor
    ruler_line: QColor
    ruler_text: QColor
    text: QColor
    text_dim: QColor
    accent: QColor
    key: QColor
    key_selected: QColor
    key_locked: QColor
    handle: QColor
    handle_line: QColor
    hover: QColor
    playhead: QColor
    playhead_text: QColor
    range: QColor
    box: QColor
    ghost: QColor
    error: QColor
    warning: QColor
    good: QColor

    _current: "Theme | None" = None

    def __init__(self, name: str = "dark") -> None:
        super().__init__()
        self.name = ""
        self.wanted = name
        self._follows = False
        self._set_name(name)

    @classmethod
    def current(cls) -> "Theme":
        """The one theme of the application."""
        if Theme._current is None:
            Theme._current = Theme()
        return Theme._current

    def apply(self, app: QApplication, wanted: str = "system") -> Self:
        """Dress the application: "dark", "light", or "system" for what the desktop says (dark if it says nothing)."""
        self.wanted = wanted
        hints = app.styleHints()
        if not self._follows:
            self._follows = True
            app.setStyle("Fusion")  # the only style that follows the palette on every system
            hints.colorSchemeChanged.connect(self._follow_system)
        hints.setColorScheme(SCHEMES[wanted])
        self._follow_system()
        return self

    def palette(self) -> QPalette:
        """The palette of Qt's own widgets."""
        column = self._column()
        palette = QPalette()
        for role, *colors in PALETTE_ROLES:
            palette.setColor(role, QColor(colors[column]))
        for role, *colors in DISABLED_ROLES:
            palette.setColor(QPalette.ColorGroup.Disabled, role, QColor(colors[column]))
        return palette

    def icon(self, name: str) -> QIcon:
        """The drawing resources/icons/<name>.svg, tinted; FileNotFoundError if there is none."""
        return QIcon(TintedIcon(name, self._tint))

    def pixmap(self, name: str, size: int, ratio: float = 1.0, color: QColor | None = None) -> QPixmap:
        """The drawing in *size* logical pixels in one colour (the text's by default)."""
        color = color or self.text
        side = round(size * ratio)
        pixmap = QPixmap(picture(name, side, side, color, color))
        pixmap.setDevicePixelRatio(ratio)
        return pixmap

    def curve(self, index: int) -> QColor:
        """The colour of the channel at this place of a clip, whatever its name."""
        colors = CURVE_COLORS[self.name]
        return QColor(colors[index % len(colors)])

    def dash(self, index: int) -> tuple[float, ...]:
        """The dash pattern of the channel at this place, in pen widths: it changes where the colours repeat."""
        return DASHES[index // len(CURVE_COLORS[self.name]) % len(DASHES)]

    def channel_color(self, channel: "Channel", index: int) -> QColor:
        """The channel's own colour, made legible, else red, green, blue for x, y, z, else the next of the list."""
        if channel.color and QColor.isValidColorName(channel.color):
            return legible(QColor(channel.color), self.background)
        axis, turns = axis_of(channel.leaf)
        return self.curve(index) if axis is None else QColor(AXIS_COLORS[self.name][turns][axis])

    def channel_dash(self, channel: "Channel", index: int) -> tuple[float, ...]:
        """The second code beside the colour: x, y, z of one joint share a pattern, the next joint has another."""
        return self.dash(index) if axis_of(channel.leaf)[0] is None else DASHES[index // 3 % len(DASHES)]

    def channel_dashes(self, channels: "Sequence[Channel]") -> list[tuple[float, ...]]:
        """The patterns of all channels of a clip: of one colour no two have the same, as far as patterns go."""
        taken: set[tuple[int, tuple[float, ...]]] = set()
        dashes = []
        for index, channel in enumerate(channels):
            color, own = self.channel_color(channel, index).rgba(), self.channel_dash(channel, index)
            dash = next((dash for dash in (own, *DASHES) if (color, dash) not in taken), own)
            taken.add((color, dash))
            dashes.append(dash)
        return dashes

    def pen(self, color: QColor, width: float = 1.0, dash: tuple[float, ...] = ()) -> QPen:
        """A cosmetic pen: as wide on the screen at every zoom."""
        pen = QPen(color, width)
        pen.setCosmetic(True)
        if dash:
            pen.setDashPattern(dash)
        return pen

    def button_style(self) -> str:
        """A style sheet for tool buttons or a tool bar: what is on, or has the focus, can be seen from afar."""
        accent, ground = self.accent, mix(self.palette().color(QPalette.ColorRole.Window), self.accent, 0.3)
        checked = f"background-color: {ground.name()}; border: 1px solid {accent.name()}; border-radius: 4px;"
        focus = f"border: 1px solid {accent.name()}; border-radius: 4px;"
        return f"QToolButton:checked {{ {checked} }} QToolButton:focus {{ {focus} }}"

    def number_font(self, font: QFont) -> QFont:
        """The font with digits of one width, so that changing numbers stand still."""
        font = QFont(font)
        font.setFeature(QFont.Tag.fromString("tnum"), 1)
        return font

    def _column(self) -> int:
        return 0 if self.name == "dark" else 1

    def _set_name(self, name: str) -> None:
        self.name = name
        for field, colors in COLORS.items():
            setattr(self, field, QColor(colors[self._column()]))

    def _follow_system(self) -> None:
        app = QApplication.instance()
        if not isinstance(app, QApplication):
            return
        known = app.styleHints().colorScheme()
        name = self.wanted
        if name == "system":
            name = "light" if known == Qt.ColorScheme.Light else "dark"
        changed = name != self.name
        self._set_name(name)
        app.setPalette(self.palette())
        QToolTip.setPalette(self.palette())
        if changed:
            self.theme_changed.emit()

    def _tint(self, mode: QIcon.Mode, state: QIcon.State) -> tuple[QColor, QColor]:
        if mode == QIcon.Mode.Disabled:
            dim = mix(self.text_dim, self.background, 0.5)
            return dim, dim
        if mode == QIcon.Mode.Selected:
            white = QColor("white")
            return white, white
        return (self.accent, self.accent) if state == QIcon.State.On else (self.text, self.accent)


@lru_cache(maxsize=4096)
def axis_of(leaf: str) -> tuple[int | None, int]:
    """(0, 1, 2 for x, y, z or None, 1 for a rotation else 0) by the last part of a channel's name."""
    found = AXIS_LAST.match(leaf) or AXIS_FIRST.match(leaf)
    if found is None:
        return None, 0
    return "xyz".index(found["axis"].lower()), int(
        found["what"].lower().startswith("r") or "rot" in found["what"].lower()
    )


ICON_SIZE: Final = QSize(20, 20)
