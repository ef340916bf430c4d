"""One look, dark or light: everything legible, every curve told apart, every icon drawn."""

import xml.etree.ElementTree as ElementTree
from itertools import combinations, product
from types import SimpleNamespace

import numpy as np
import pytest
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QIcon, QPalette
from PySide6.QtTest import QSignalSpy
from PySide6.QtWidgets import QApplication, QToolButton

from widgets.colors import AXIS_COLORS, COLORS, CURVE_COLORS, DASHES, contrast, legible
from widgets.guard import unguarded
from widgets.icons import ICONS_FOLDER, TintedIcon
from widgets.theme import Theme, axis_of

ICONS = sorted(path.stem for path in ICONS_FOLDER.glob("*.svg"))
THEMES = ("dark", "light")
# How people without one kind of cone see linear RGB. Source: Machado, Oliveira, Fernandes 2009, severity 1.
SIGHT = {
    "all cones": np.eye(3),
    "no red": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "no green": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "no blue": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}


def lab(color, sight):
    """CIE L*a*b* of a colour as seen."""
    rgb = np.array([color.redF(), color.greenF(), color.blueF()])
    seen = np.clip(np.array(sight) @ np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4), 0, 1)
    to_xyz = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    xyz = to_xyz @ seen / [0.9505, 1.0, 1.089]
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def channel(name, color=None):
    return SimpleNamespace(name=name, leaf=name.rpartition(".")[2], color=color)


@pytest.fixture
def dressed(qapp):
    theme = Theme()
    yield theme
    qapp.setPalette(QPalette())


@pytest.mark.parametrize("name", THEMES)
def test_every_curve_stands_out_from_the_background(name):
    theme = Theme(name)
    colors = CURVE_COLORS[name] + sum(AXIS_COLORS[name], ())
    assert all(contrast(QColor(color), theme.background) >= 3.0 for color in colors)


@pytest.mark.parametrize(("name", "sight"), list(product(THEMES, SIGHT)))
def test_curves_are_told_apart_with_any_kind_of_sight(name, sight):
    for colors in (CURVE_COLORS[name], *AXIS_COLORS[name]):
        for one, other in combinations(colors, 2):
            distance = np.linalg.norm(lab(QColor(one), SIGHT[sight]) - lab(QColor(other), SIGHT[sight]))
            assert distance >= 12, (one, other)


@pytest.mark.parametrize("name", THEMES)
def test_words_and_marks_are_legible(name):
    theme = Theme(name)
    palette = theme.palette()
    grounds = [palette.color(role) for role in (QPalette.ColorRole.Window, QPalette.ColorRole.Base)]
    for ground in grounds:
        assert contrast(theme.text, ground) >= 7
        assert all(
            contrast(color, ground) >= 4.5 for color in (theme.text_dim, theme.error, theme.accent, theme.warning)
        )
    assert contrast(theme.ruler_text, theme.ruler) >= 4.5
    for mark in (
        theme.key_selected,
        theme.handle,
        theme.handle_line,
        theme.playhead,
        theme.range,
        theme.hover,
        theme.box,
    ):
        assert contrast(mark, theme.background) >= 3
    pairs = ("WindowText", "Window"), ("Text", "Base"), ("ButtonText", "Button"), ("HighlightedText", "Highlight")
    for text, ground in (*pairs, ("ToolTipText", "ToolTipBase"), ("PlaceholderText", "Base")):
        roles = QPalette.ColorRole
        assert contrast(palette.color(roles[text]), palette.color(roles[ground])) >= 4.5, text


def test_every_colour_of_the_table_is_an_attribute_and_named_in_the_class():
    theme = Theme("light")
    named = {name for name, kind in Theme.__annotations__.items() if kind is QColor}
    assert named == set(COLORS)
    assert theme.background == QColor(COLORS["background"][1])


@pytest.mark.parametrize(
    ("leaf", "expected"),
    [
        ("tx", (0, 0)),
        ("y", (1, 0)),
        ("rz", (2, 1)),
        ("rotateX", (0, 1)),
        ("scale_y", (1, 0)),
        ("Zrotation", (2, 1)),
        ("Xposition", (0, 0)),
        ("TranslateZ", (2, 0)),
        ("max", (None, 0)),
        ("index", (None, 0)),
        ("energy", (None, 0)),
        ("fx", (None, 0)),
        ("", (None, 0)),
    ],
)
def test_the_axis_is_read_from_the_last_part_of_the_name(leaf, expected):
    assert axis_of(leaf) == expected


def test_channel_colours_are_red_green_blue_for_axes_and_the_list_for_others():
    theme = Theme("dark")
    assert [theme.channel_color(channel(f"root.t{axis}"), 4).name() for axis in "xyz"] == list(AXIS_COLORS["dark"][0])
    assert theme.channel_color(channel("root.rx"), 0).name() == AXIS_COLORS["dark"][1][0]
    assert theme.channel_color(channel("blink"), 8).name() == CURVE_COLORS["dark"][1]


def test_the_users_colour_is_kept_where_it_is_legible_and_lightened_where_not():
    theme = Theme("dark")
    assert theme.channel_color(channel("a", "#f08040"), 0).name() == "#f08040"
    lightened = theme.channel_color(channel("a", "#101060"), 0)
    assert contrast(lightened, theme.background) >= 3
    assert lightened.blue() > lightened.red()
    assert theme.channel_color(channel("a", "no colour"), 0) == theme.curve(0)
    assert contrast(legible(QColor("#fafafa"), QColor("white")), QColor("white")) >= 3


def test_the_dash_changes_where_the_colours_repeat():
    theme = Theme("dark")
    count = len(CURVE_COLORS["dark"])
    codes = {(theme.curve(i).name(), theme.dash(i)) for i in range(count * len(DASHES))}
    assert len(codes) == count * len(DASHES)
    patterns = [theme.channel_dash(channel(f"j{i // 3}.t{'xyz'[i % 3]}"), i) for i in range(6)]
    assert patterns == [DASHES[0]] * 3 + [DASHES[1]] * 3


def test_apply_dresses_the_application_and_tells(qapp, dressed):
    spy = QSignalSpy(dressed.theme_changed)
    dressed.apply(qapp, "light")
    assert (dressed.name, spy.count()) == ("light", 1)
    assert qapp.palette().color(QPalette.ColorRole.Base) == QColor("white")
    assert qapp.style().name() == "fusion"
    dressed.apply(qapp, "light")
    assert spy.count() == 1
    dressed.apply(qapp, "dark")
    assert (dressed.name, spy.count()) == ("dark", 2)
    assert contrast(qapp.palette().color(QPalette.ColorRole.Base), QColor("black")) < 2


def test_the_system_is_followed_when_it_changes_its_mind(qapp, dressed, monkeypatch):
    dressed.apply(qapp, "system")
    hints = QApplication.styleHints()
    monkeypatch.setattr(type(hints), "colorScheme", lambda self: Qt.ColorScheme.Light)
    hints.colorSchemeChanged.emit(Qt.ColorScheme.Light)
    assert dressed.name == "light"
    monkeypatch.setattr(type(hints), "colorScheme", lambda self: Qt.ColorScheme.Unknown)
    hints.colorSchemeChanged.emit(Qt.ColorScheme.Unknown)
    assert dressed.name == "dark"


def test_an_icon_takes_the_colours_of_the_theme_without_being_set_again(qapp, dressed):
    dressed.apply(qapp, "dark")
    icon = dressed.icon("stop")
    centres = []
    for name in THEMES:
        dressed.apply(qapp, name)
        centres.append(icon.pixmap(20, 20).toImage().pixelColor(10, 10))
        assert centres[-1] == dressed.text
    assert centres[0] != centres[1]
    switched_on = icon.pixmap(QSize(20, 20), QIcon.Mode.Normal, QIcon.State.On).toImage().pixelColor(10, 10)
    disabled = icon.pixmap(QSize(20, 20), QIcon.Mode.Disabled).toImage().pixelColor(10, 10)
    assert switched_on == dressed.accent
    assert disabled not in (dressed.text, dressed.accent)


@pytest.mark.parametrize("name", ICONS)
def test_every_icon_is_drawn_by_us_in_two_colours_and_readable_at_20_pixels(qapp, name):
    root = ElementTree.parse(ICONS_FOLDER / f"{name}.svg").getroot()
    image = Theme("dark").icon(name).pixmap(20, 20).toImage()
    inked = sum(image.pixelColor(x, y).alpha() > 96 for x in range(20) for y in range(20))
    assert inked >= 12
    if name != "hermite":
        assert root.get("viewBox") == "0 0 24 24"
        paints = {node.get(a) for node in root.iter() for a in ("stroke", "fill")} - {None, "none"}
        assert paints <= {"currentColor", "#4a90e2"}


def test_icons_are_sharp_on_screens_of_twice_the_density(qapp):
    pixmap = Theme("dark").icon("play").pixmap(QSize(20, 20), 2.0)
    assert (pixmap.width(), pixmap.devicePixelRatio()) == (40, 2.0)
    assert Theme("dark").pixmap("eye", 16, 1.5).width() == 24


def test_a_button_paints_its_icon(qtbot, dressed, qapp):
    dressed.apply(qapp, "dark")
    button = QToolButton()
    qtbot.addWidget(button)
    button.setIcon(dressed.icon("stop"))
    button.setIconSize(QSize(20, 20))
    button.resize(30, 30)
    assert button.grab().toImage().pixelColor(15, 15) == dressed.text


def test_an_unknown_icon_is_refused_by_name():
    with pytest.raises(FileNotFoundError, match="no-such-icon"):
        Theme("dark").icon("no-such-icon")


def test_pens_are_as_wide_on_the_screen_at_every_zoom():
    pen = Theme("dark").pen(QColor("red"), 2.0, (4, 2))
    assert pen.isCosmetic()
    assert pen.dashPattern() == [4, 2]
    assert unguarded(TintedIcon) == unguarded(Theme) == []
