"""What the panels are put together from can be seen, read and scrolled past."""

import gc
import weakref

import pytest
from PySide6.QtCore import Qt

from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.keyframe import make_run
from widgets.channel_tree import ChannelTree
from widgets.form import DimLabel, DimText, PanelButton, QuietCombo
from widgets.guard import unguarded
from widgets.key_inspector import KeyInspector
from widgets.theme import Theme
from widgets.transport import Transport


@pytest.fixture
def button(qtbot):
    widget = PanelButton(Theme("dark"), "loop", "Loop")
    widget.setCheckable(True)
    widget.setAutoRaise(True)
    widget.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    qtbot.addWidget(widget)
    widget.show()
    return widget


def border(button):
    """The colours of the button's rim."""
    image = button.grab().toImage()
    return {image.pixelColor(image.width() // 2 + x, 0).name() for x in range(-3, 4)}


def test_a_button_that_is_on_has_a_rim_and_one_that_is_off_has_none(button):
    accent = Theme("dark").accent.name()
    assert accent not in border(button)
    button.setChecked(True)
    assert accent in border(button)


def test_the_focus_can_be_seen(button, qtbot):
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    button.activateWindow()
    qtbot.waitUntil(button.isActiveWindow)
    button.setFocus()
    assert Theme("dark").accent.name() in border(button)


def test_a_combo_box_says_when_its_things_differ(qtbot):
    combo = QuietCombo("Rule")
    qtbot.addWidget(combo)
    combo.addItem("Flat", 0)
    combo.show_data(0, "mixed")
    assert combo.currentText() == "Flat"
    combo.show_data(None, "mixed")
    assert (combo.currentIndex(), combo.placeholderText()) == (-1, "mixed")


@pytest.mark.parametrize("kind", [DimLabel, DimText])
def test_words_that_explain_follow_the_theme(qtbot, kind):
    theme = Theme("dark")
    label = kind(theme)
    label.setText("5 keys")
    qtbot.addWidget(label)
    assert label.palette().windowText().color() == theme.text_dim
    theme._set_name("light")
    theme.theme_changed.emit()
    assert label.palette().windowText().color() == Theme("light").text_dim


@pytest.mark.parametrize("panel", [ChannelTree, KeyInspector, Transport])
def test_a_panel_that_nobody_holds_is_gone(qtbot, panel):
    document = Document(Clip([Channel("a.x", make_run([0, 1], [0, 1]))]))
    widget = panel(document, Theme("dark"))
    gone = weakref.ref(widget)
    del widget
    gc.collect()
    assert gone() is None
    document.session.playhead = 0.5
    document.session.active = document.clip.channels[0]
    document.replace(Clip())


def test_every_override_is_guarded():
    assert unguarded(PanelButton) == unguarded(QuietCombo) == unguarded(DimLabel) == []
