"""The inspector says what holds for the selected keys and the active channel, and sets it."""

import time

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QSignalSpy, QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QComboBox, QLineEdit

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule, make_run
from model.selection import Selection
from model.tangents import TANGENT_RULES
from widgets.form import QuietCombo
from widgets.guard import unguarded
from widgets.key_inspector import KeyInspector
from widgets.theme import Theme


@pytest.fixture
def document():
    tx = Channel("root.tx", make_run([0, 1, 2], [0, 2, 4], rules_in=TangentRule.FLAT, rules_out=[0, 1, 0]))
    rx = Channel("root.rx", make_run([0, 0.5], [-np.pi / 2, np.pi], broken=True), unit="angle")
    return Document(Clip([tx, rx], end=3))


@pytest.fixture
def tx(document):
    return document.clip.channel("root.tx")


@pytest.fixture
def inspector(qtbot, document):
    widget = KeyInspector(document, Theme("dark"))
    qtbot.addWidget(widget)
    widget.show()
    widget.activateWindow()
    qtbot.waitUntil(widget.isActiveWindow)
    return widget


def select(document, channel, rows):
    document.session.selection = Selection.of({channel: channel.run()["id"][rows]})


def choose(combo, data):
    """Choose a row of the combo box by the keyboard, as a person does."""
    combo.setFocus()
    while combo.currentData() != data:
        before = combo.currentIndex()
        QTest.keyClick(combo, Qt.Key.Key_Down if combo.findData(data) > before else Qt.Key.Key_Up)
        assert combo.currentIndex() != before


def test_a_selection_is_shown_in_the_next_turn_of_the_event_loop(inspector, document, tx, qtbot):
    select(document, tx, [1])
    qtbot.waitUntil(lambda: inspector.key.fields["time"].text() == "1")
    assert inspector.key.fields["value"].text() == "2"
    assert inspector.key.heading.detail.text() == "1 key of root.tx"
    assert inspector.key.rules["in"].currentText() == "Flat"
    assert inspector.key.rules["out"].currentText() == "Linear"


def test_the_fields_follow_a_drag(inspector, document, tx, qtbot):
    select(document, tx, [1])
    selection = document.session.selection
    with document.begin("Move") as gesture:
        gesture.preview(lambda clip: edits.move(clip, selection, 0.25, 1.0))
        qtbot.waitUntil(lambda: inspector.key.fields["time"].text() == "1.25")
        assert inspector.key.fields["value"].text() == "3"


def test_a_drag_step_does_not_wait_for_the_inspector(inspector, document, tx, monkeypatch):
    select(document, tx, [1])
    selection = document.session.selection
    QApplication.processEvents()
    refreshed = []
    monkeypatch.setattr(inspector.key, "refresh", lambda: refreshed.append(1))
    with document.begin("Move") as gesture:
        for step in range(50):
            gesture.preview(lambda clip, step=step: edits.move(clip, selection, 0.01 * step, 0.0))
        assert not refreshed


def test_asking_for_a_refresh_costs_microseconds(inspector, document, tx):
    start = time.perf_counter()
    for _ in range(1000):
        document.changed.emit(tx, 0.0, 1.0)
    assert (time.perf_counter() - start) / 1000 < 0.2e-3


def test_the_frame_stands_beside_the_time(inspector, document, tx):
    document.clip.frame_rate = 24.0
    select(document, tx, [1])
    inspector.key.refresh()
    assert any(label.text() == "s  f 24" for label in inspector.key.units.values())


def test_a_rule_is_set_on_one_side_of_all_selected_keys(inspector, document, tx):
    select(document, tx, [0, 1, 2])
    inspector.key.refresh()
    combo = inspector.key.rules["out"]
    assert (combo.currentIndex(), combo.placeholderText()) == (-1, "mixed")
    choose(combo, int(TangentRule.SMOOTH))
    assert tx.run()["rule_out"].tolist() == [TangentRule.SMOOTH] * 3
    assert tx.run()["rule_in"].tolist() == [TangentRule.FLAT] * 3


@pytest.mark.parametrize("side", ["in", "out"])
def test_each_side_offers_the_rules_it_can_have_with_icon_and_word(inspector, side):
    combo = inspector.key.rules[side]
    rows = [TangentRule(combo.itemData(i)) for i in range(combo.count())]
    assert rows == [rule for rule, row in TANGENT_RULES.items() if side in row.sides]
    assert not any(combo.itemIcon(i).isNull() for i in range(combo.count()))
    assert [combo.itemText(i) for i in range(combo.count())] == [TANGENT_RULES[rule].label for rule in rows]


def test_broken_and_unified_show_what_holds_and_turn_it(inspector, document, tx):
    rx = document.clip.channel("root.rx")
    select(document, rx, [0, 1])
    inspector.key.refresh()
    assert (inspector.key.broken.isChecked(), inspector.key.unified.isChecked()) == (True, False)
    QTest.mouseClick(inspector.key.unified, Qt.MouseButton.LeftButton)
    assert not rx.run()["broken"].any()
    assert (inspector.key.broken.isChecked(), inspector.key.unified.isChecked()) == (False, True)
    document.session.selection = Selection.of_all([tx, rx]).with_only([rx])
    QTest.mouseClick(inspector.key.broken, Qt.MouseButton.LeftButton)
    assert rx.run()["broken"].all()


def test_neither_holds_where_the_keys_differ(inspector, document, tx):
    document.session.selection = Selection.of_all(document.clip.channels)
    document.do("Unify", lambda clip: edits.unify_tangents(clip, Selection.of_all([tx])))
    inspector.key.refresh()
    assert not inspector.key.broken.isChecked()
    assert not inspector.key.unified.isChecked()


@pytest.mark.parametrize("side", ["pre", "post"])
@pytest.mark.parametrize("mode", list(Extrapolation))
def test_each_extrapolation_can_be_chosen_on_each_side_and_undone(inspector, document, tx, side, mode):
    start = Extrapolation.BOUNCE if mode == Extrapolation.CONSTANT else Extrapolation.CONSTANT
    document.do("Start", lambda clip: edits.set_extrapolation(clip, [tx], start, start))
    document.session.active = tx
    inspector.channel.refresh()
    seen = []
    document.committed.connect(seen.append)
    choose(inspector.channel.modes[side], int(mode))
    assert getattr(tx, side) == mode
    assert getattr(tx, "post" if side == "pre" else "pre") == start
    for edit in reversed(seen):
        document.apply(edit.inverse())
    assert getattr(tx, side) == start


def test_the_active_channel_is_named_and_renamed(inspector, document, tx):
    document.session.active = tx
    inspector.channel.refresh()
    name = inspector.channel.name
    assert name.text() == "root.tx"
    name.setFocus()
    name.selectAll()
    QTest.keyClicks(name, "hip.tx")
    QTest.keyClick(name, Qt.Key.Key_Return)
    assert tx.name == "hip.tx"


def test_a_name_that_is_taken_is_refused_in_words(inspector, document, tx):
    document.session.active = tx
    inspector.channel.refresh()
    spy = QSignalSpy(inspector.status)
    name = inspector.channel.name
    name.setFocus()
    name.selectAll()
    QTest.keyClicks(name, "root.rx")
    QTest.keyClick(name, Qt.Key.Key_Return)
    assert [spy.at(i)[0] for i in range(spy.count())] == ["There already is a channel root.rx"]
    assert (tx.name, name.text()) == ("root.tx", "root.tx")


def test_the_unit_may_be_one_of_the_list_or_any_other(inspector, document, tx):
    document.session.active = tx
    inspector.channel.refresh()
    choose(inspector.channel.unit, "angle")
    assert tx.unit == "angle"
    line = inspector.channel.unit.lineEdit()
    line.setFocus()
    line.selectAll()
    QTest.keyClicks(line, "furlong")
    QTest.keyClick(line, Qt.Key.Key_Return)
    assert tx.unit == "furlong"
    inspector.channel.refresh()
    assert line.text() == "furlong"


def test_the_facts_of_the_channel_are_exact(inspector, document):
    document.session.active = document.clip.channel("root.rx")
    inspector.channel.refresh()
    assert inspector.channel.facts.text().splitlines() == ["2 keys", "Times 0 to 0.5 s", "Values -90 to 180°"]


def test_a_locked_channel_keeps_its_extrapolation(inspector, document, tx):
    tx.locked = True
    document.session.active = tx
    inspector.channel.refresh()
    assert not inspector.channel.modes["pre"].isEnabled()
    assert inspector.channel.heading.detail.text() == "locked"


def test_a_name_that_looks_like_markup_is_plain_text(inspector, document, tx):
    tx.name = "<b>x</b>"
    select(document, tx, [0])
    inspector.key.refresh()
    assert inspector.key.heading.detail.text() == "1 key of <b>x</b>"
    assert inspector.key.heading.detail.textFormat() == Qt.TextFormat.PlainText


def test_the_wheel_passes_over_a_combo_box(inspector, document, tx):
    select(document, tx, [0])
    inspector.key.refresh()
    combo = inspector.key.rules["in"]
    wheel = QWheelEvent(
        QPointF(5, 5), QPointF(5, 5), QPoint(), QPoint(0, -120), Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(combo, wheel)
    assert combo.currentData() == int(TangentRule.FLAT)
    assert not wheel.isAccepted()


def test_a_large_selection_is_read_again_only_after_the_drag(inspector, document, qtbot, monkeypatch):
    channel = Channel("x", make_run(np.arange(30_000.0), 0.0))
    document.replace(Clip([channel]))
    document.session.selection = Selection.of_all([channel])
    qtbot.waitUntil(lambda: inspector.key.heading.detail.text() == "30,000 keys of x")
    qtbot.wait(400)
    refreshed = []
    monkeypatch.setattr(inspector.key, "refresh", lambda: refreshed.append(1))
    selection = document.session.selection
    with document.begin("Move") as gesture:
        gesture.preview(lambda clip: edits.move(clip, selection, 0.0, 1.0))
        qtbot.wait(400)
        assert not refreshed
    qtbot.waitUntil(lambda: bool(refreshed))


def test_every_part_has_a_name_for_a_screen_reader(inspector):
    parts = [p for kind in (QLineEdit, QComboBox, QAbstractButton) for p in inspector.findChildren(kind)]
    assert len(parts) > 10
    assert all(part.accessibleName() for part in parts)


def test_tab_walks_down_the_fields(inspector, document, tx):
    select(document, tx, [0])
    document.session.active = tx
    inspector.key.refresh()
    inspector.channel.refresh()
    fields = inspector.key.fields
    fields["time"].setFocus()
    order = []
    for _ in range(10):
        order.append(QApplication.focusWidget())
        QTest.keyClick(order[-1], Qt.Key.Key_Tab)
    expected = [*fields.values(), *inspector.key.rules.values(), inspector.key.unified, inspector.key.broken]
    assert order[:8] == expected
    assert order[8] is inspector.channel.name


def test_every_override_is_guarded():
    assert unguarded(QuietCombo) == []


def test_numbers_of_very_many_keys_are_set_when_enter_is_pressed(inspector, document, tx, monkeypatch):
    monkeypatch.setattr("widgets.key_targets.MOST_SHOWN", 2)
    select(document, tx, [0, 1, 2])
    inspector.key.refresh()
    field = inspector.key.fields["value"]
    said, before = QSignalSpy(field.status), tx.run()["value"].tolist()
    edits_made = []
    document.committed.connect(edits_made.append)
    field.setFocus()
    QTest.keyClicks(field, "*=0.5")
    assert tx.run()["value"].tolist() == before
    assert document.gesture is None
    assert "Enter" in said.at(said.count() - 1)[0]
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert tx.run()["value"].tolist() == [value / 2 for value in before]
    QTest.keyClicks(field, "+=1")
    QTest.keyClick(field, Qt.Key.Key_Escape)
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert len(edits_made) == 1
    QTest.keyClicks(field, "1/(v-1)")  # one of them is 1 by now: what cannot be done is said, and nothing is done
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert len(edits_made) == 1
    assert field.editing
    QTest.keyClick(field, Qt.Key.Key_Escape)
    assert not field.editing
