"""Where the keyboard goes: a shortcut pressed after an entry acts on the graph and never types into the field."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox
from pytestqt.qtbot import QtBot

from app.main_window import MainWindow
from model.keyframe import TangentRule
from model.selection import Selection
from tests.app.conftest import MakeWindow, small_clip
from widgets.value_field import ValueField


@pytest.fixture
def chosen(make_window: MakeWindow, qtbot: QtBot) -> MainWindow:
    """A window with all keys of the first channel selected."""
    window = make_window(small_clip())
    channel = window.document.clip.channels[0]
    window.session.active = channel
    window.session.selection = Selection.of({channel: channel.run()["id"]})
    window.activateWindow()
    QTest.qWait(50)
    return window


def value_field(window: MainWindow) -> ValueField:
    return next(field for field in window.inspector.findChildren(ValueField) if field.accessibleName() == "Value")


@pytest.mark.parametrize("last", [Qt.Key.Key_Return, Qt.Key.Key_Escape])
def test_a_rule_key_pressed_after_an_entry_sets_the_rule(chosen: MainWindow, qtbot: QtBot, last: Qt.Key) -> None:
    field, channel = value_field(chosen), chosen.document.clip.channels[0]
    before = channel.run()["value"].tolist()
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, "*=2")
    QTest.keyClick(field, last)
    qtbot.waitUntil(lambda: QApplication.focusWidget() is chosen.view)
    QTest.keyClick(chosen.view, Qt.Key.Key_3)
    after = channel.run()
    factor = 2.0 if last == Qt.Key.Key_Return else 1.0
    assert after["value"].tolist() == [value * factor for value in before]
    assert (after["rule_in"] == TangentRule.FLAT).all()


def test_a_choice_in_a_list_gives_the_keyboard_back(chosen: MainWindow, qtbot: QtBot) -> None:
    combo = chosen.inspector.findChildren(QComboBox)[0]
    combo.setFocus()
    combo.activated.emit(combo.currentIndex())
    qtbot.waitUntil(lambda: QApplication.focusWidget() is chosen.view)


def test_a_formula_that_is_none_keeps_the_keyboard(chosen: MainWindow) -> None:
    field = value_field(chosen)
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, "*=")
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert QApplication.focusWidget() is field
