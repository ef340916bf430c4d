"""The colours of both themes, one row each, and the arithmetic of contrast."""

from typing import Final

from PySide6.QtGui import QColor, QPalette

R = QPalette.ColorRole

# What Qt's own widgets are painted with: role, dark, light.
PALETTE_ROLES: Final = (
    (R.Window, "#2a2c31", "#f1f2f4"),
    (R.WindowText, "#e3e5e9", "#1d2126"),
    (R.Base, "#1f2125", "#ffffff"),
    (R.AlternateBase, "#24262b", "#f6f7f9"),
    (R.Text, "#e3e5e9", "#1d2126"),
    (R.PlaceholderText, "#9298a3", "#66707d"),
    (R.ToolTipBase, "#3a3d44", "#ffffff"),
    (R.ToolTipText, "#eceef1", "#1d2126"),
    (R.Button, "#2f3238", "#fbfbfc"),
    (R.ButtonText, "#e3e5e9", "#1d2126"),
    (R.BrightText, "#ffffff", "#ffffff"),
    (R.Light, "#4b4f57", "#ffffff"),
    (R.Midlight, "#3e4249", "#e6e9ed"),
    (R.Mid, "#3a3d44", "#c9ced5"),
    (R.Dark, "#17181b", "#a7aeb8"),
    (R.Shadow, "#000000", "#6d7580"),
    (R.Link, "#6aaaff", "#0b5cc4"),
    (R.LinkVisited, "#b79cff", "#6b3fc4"),
    (R.Highlight, "#2d62a8", "#1f68cf"),
    (R.HighlightedText, "#ffffff", "#ffffff"),
    (R.Accent, "#6aaaff", "#0b5cc4"),
)
DISABLED_ROLES: Final = (
    (R.WindowText, "#747a84", "#9aa1ab"),
    (R.Text, "#747a84", "#9aa1ab"),
    (R.ButtonText, "#747a84", "#9aa1ab"),
    (R.Highlight, "#3c424c", "#d3d9e1"),
    (R.HighlightedText, "#a4aab4", "#66707d"),
    (R.Base, "#26282c", "#f1f2f4"),
)

# What our own widgets are painted with; every row is an attribute of Theme. Last: what for.
COLORS: Final = {
    "background": ("#1b1d21", "#ffffff", "behind the curves"),
    "outside": ("#16181b", "#eff1f4", "behind the curves before and after the clip's range"),
    "grid": ("#26292e", "#eceef1", "thin lines of the grid"),
    "grid_strong": ("#33373e", "#d5dae0", "labelled lines of the grid"),
    "zero_line": ("#4a5059", "#a9b1bb", "the line of value zero"),
    "ruler": ("#24262b", "#f6f7f9", "behind the numbers of time and value"),
    "ruler_line": ("#4a4f58", "#b4bbc5", "ticks of the rulers"),
    "ruler_text": ("#b4b9c2", "#4b535e", "numbers of the rulers"),
    "text": ("#e3e5e9", "#1d2126", "words that matter"),
    "text_dim": ("#9aa0ab", "#5c6570", "words that explain"),
    "accent": ("#6aaaff", "#0b5cc4", "what is chosen, switched on or has the focus"),
    "key": ("#1b1d21", "#ffffff", "the rim that lifts a key off its curve"),
    "key_selected": ("#ffd34d", "#141414", "selected keys"),
    "key_locked": ("#7d838d", "#98a0aa", "keys of locked channels"),
    "handle": ("#f0f1f3", "#2a2f36", "ends of the tangent handles"),
    "handle_line": ("#8d939d", "#6d7682", "the line from a key to its handle"),
    "hover": ("#ffffff", "#000000", "what lies under the pointer"),
    "playhead": ("#ff8b3d", "#c44a00", "the playhead's line and head"),
    "playhead_text": ("#1b1d21", "#ffffff", "the time in the playhead's head"),
    "range": ("#8a94a3", "#6b7685", "ends of the clip's range"),
    "box": ("#6aaaff", "#0b5cc4", "the rim of the selection box, its filling at a tenth"),
    "ghost": ("#7a818c", "#959da8", "frozen curves to compare with, covered keys"),
    "error": ("#ff7b72", "#c1251d", "text that cannot be taken"),
    "warning": ("#f2b84b", "#8f5a00", "what may surprise"),
    "good": ("#5fcf9a", "#0d7a4a", "what has been confirmed"),
}

# Told apart by people with any kind of colour vision (least distance 12 dark, 18 light), each >= 3:1 on its background.
CURVE_COLORS: Final = {
    "dark": ("#f2b01e", "#35b1e8", "#20d0a0", "#e9eb9a", "#ea4a8e", "#c2650f", "#7d82e0"),
    "light": ("#c08200", "#2a9bd8", "#00705c", "#7d7a30", "#d13aa6", "#7a2c0c", "#1c3fb8"),
}
# x, y, z of a place and, lighter, of a rotation.
AXIS_COLORS: Final = {
    "dark": (("#ff4a63", "#8bdc00", "#3d98ff"), ("#ff8a98", "#c6f28a", "#86c1ff")),
    "light": (("#b3321f", "#00735c", "#1f5fbf"), ("#d0604e", "#2b937c", "#4f86d8")),
}
# The second code beside colour, in pen widths: drawn, gap, ... ; () is a whole line.
DASHES: Final[tuple[tuple[float, ...], ...]] = ((), (7, 3), (2, 2), (9, 3, 2, 3), (5, 2, 1, 2, 1, 2))
LEAST_CONTRAST: Final = 3.0


def luminance(color: QColor) -> float:
    """Relative luminance, 0 black to 1 white. Source: WCAG 2.2."""
    red, green, blue = (
        c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
        for c in (color.redF(), color.greenF(), color.blueF())
    )
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(color: QColor, other: QColor) -> float:
    """Contrast ratio, 1 to 21. Source: WCAG 2.2."""
    low, high = sorted((luminance(color), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def legible(color: QColor, background: QColor, least: float = LEAST_CONTRAST) -> QColor:
    """The colour, made lighter or darker as far as it needs to stand out from *background*."""
    towards = QColor("white") if luminance(background) < 0.18 else QColor("black")
    for step in range(21):
        mixed = mix(color, towards, step / 20)
        if contrast(mixed, background) >= least:
            return mixed
    return towards


def mix(color: QColor, other: QColor, part: float) -> QColor:
    """The colour with *part* (0 to 1) of *other* in it."""
    return QColor.fromRgbF(
        color.redF() + (other.redF() - color.redF()) * part,
        color.greenF() + (other.greenF() - color.greenF()) * part,
        color.blueF() + (other.blueF() - color.blueF()) * part,
    )
