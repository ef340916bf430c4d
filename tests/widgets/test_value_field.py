"""Numbers and formulas typed into the inspector: seen at once, kept by Enter, taken back by Esc, never rounded."""

import math

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QSignalSpy, QTest
from PySide6.QtWidgets import QApplication

from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.edits import set_field
from model.keyframe import TangentRule, make_run
from model.selection import Selection
from widgets.guard import unguarded
from widgets.key_inspector import KeyInspector
from widgets.numbers import DEGREES
from widgets.scrub_label import ScrubLabel
from widgets.theme import Theme
from widgets.value_field import ValueField

Key = Qt.Key
THIRD = 1 / 3
NOT_ROUND = 0.21  # radians that do not come back from degrees


@pytest.fixture
def document():
    tx = Channel("root.tx", make_run([0, 1, 2, 3], [THIRD, 2, 4, 8]))
    rx = Channel("root.rx", make_run([0, 1], [NOT_ROUND, math.pi]), unit="angle")
    return Document(Clip([tx, rx], end=3))


@pytest.fixture
def inspector(qtbot, document):
    widget = KeyInspector(document, Theme("dark"))
    qtbot.addWidget(widget)
    widget.show()
    widget.activateWindow()
    qtbot.waitUntil(widget.isActiveWindow)
    return widget


@pytest.fixture
def edits(document):
    seen = []
    document.committed.connect(seen.append)
    return seen


def select(inspector, document, **places):
    document.session.selection = Selection.of(
        {document.clip.channel(f"root.{name}"): document.clip.channel(f"root.{name}").run()["id"][rows]
         for name, rows in places.items()}
    )  # fmt: skip
    inspector.key.refresh()


def enter(field, text, *, then=Key.Key_Return):
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, text)
    if then is not None:
        QTest.keyClick(field, then)


def values(document, name="root.tx"):
    return document.clip.channel(name).run()["value"].tolist()


def test_a_number_typed_is_seen_while_typing_and_is_one_undo_step(inspector, document, edits):
    select(inspector, document, tx=[1])
    enter(inspector.key.fields["value"], "12", then=None)
    assert values(document)[1] == 12
    assert not edits
    QTest.keyClick(inspector.key.fields["value"], Key.Key_Return)
    assert [edit.label for edit in edits] == ["Set the value of 1 key of root.tx (12)"]
    document.apply(edits[0].inverse())
    assert values(document) == [THIRD, 2, 4, 8]


def test_esc_takes_back_what_is_typed_and_leaves_no_undo_step(inspector, document, edits):
    select(inspector, document, tx=[1, 2])
    field = inspector.key.fields["value"]
    enter(field, "*=10", then=None)
    assert values(document) == [THIRD, 20, 40, 8]
    QTest.keyClick(field, Key.Key_Escape)
    assert values(document) == [THIRD, 2, 4, 8]
    assert not edits
    assert document.gesture is None
    assert field.placeholderText() == "mixed"
    assert field.text() == ""


def test_leaving_the_field_keeps_what_is_typed(inspector, document, edits):
    select(inspector, document, tx=[1])
    enter(inspector.key.fields["value"], "7", then=None)
    inspector.key.fields["time"].setFocus()
    assert values(document)[1] == 7
    assert len(edits) == 1


def test_a_formula_works_on_every_selected_key(inspector, document):
    select(inspector, document, tx=[1, 2, 3])
    enter(inspector.key.fields["value"], "v*0.5 + t")
    assert values(document) == [THIRD, 2, 4, 7]
    enter(inspector.key.fields["value"], "lerp(10, 20, u)")
    assert values(document) == [THIRD, 10, 15, 20]


def test_mixed_numbers_are_told_and_set_together(inspector, document):
    select(inspector, document, tx=[1, 2])
    field = inspector.key.fields["value"]
    assert (field.text(), field.placeholderText()) == ("", "mixed")
    enter(field, "5")
    assert values(document) == [THIRD, 5, 5, 8]
    inspector.key.refresh()
    assert field.text() == "5"


def test_a_rounded_text_is_never_written_back(inspector, document, edits):
    select(inspector, document, tx=[0])
    field = inspector.key.fields["value"]
    assert field.text() == "0.333333"
    field.setFocus()
    assert field.text() == repr(THIRD)
    QTest.keyClick(field, Key.Key_Return)
    inspector.key.fields["time"].setFocus()
    assert values(document)[0] == THIRD
    assert not edits
    assert field.text() == "0.333333"


def test_typing_and_deleting_again_changes_nothing(inspector, document, edits):
    select(inspector, document, tx=[0])
    field = inspector.key.fields["value"]
    field.setFocus()
    field.end(False)
    QTest.keyClicks(field, "9")
    assert values(document)[0] != THIRD
    QTest.keyClick(field, Key.Key_Backspace)
    assert values(document)[0] == THIRD
    QTest.keyClick(field, Key.Key_Return)
    assert not edits


def test_a_slope_typed_and_deleted_again_leaves_the_rule(inspector, document, edits):
    select(inspector, document, tx=[1])
    field = inspector.key.fields["slope_out"]
    field.setFocus()
    field.end(False)
    QTest.keyClicks(field, "5")
    QTest.keyClick(field, Key.Key_Backspace)
    QTest.keyClick(field, Key.Key_Return)
    assert list(document.clip.channel("root.tx"))[1].rule_out == TangentRule.SMOOTH
    assert not edits


def test_what_is_being_typed_stays_when_the_inspector_keeps_up(inspector, document, qtbot):
    select(inspector, document, tx=[1])
    field = inspector.key.fields["value"]
    enter(field, "3/4", then=None)
    qtbot.wait(60)
    assert field.text() == "3/4"
    assert values(document)[1] == 0.75


def test_stepping_goes_on_from_what_was_typed(inspector, document, edits):
    select(inspector, document, tx=[1])
    field = inspector.key.fields["value"]
    enter(field, "5", then=Key.Key_Up)
    QTest.keyClick(field, Key.Key_Return)
    assert values(document)[1] == 5.1
    assert len(edits) == 2


def test_numbers_that_differ_between_channels_are_mixed_too(inspector, document):
    select(inspector, document, tx=[1], rx=[1])
    assert inspector.key.fields["value"].placeholderText() == "mixed"


def test_an_angle_that_a_formula_leaves_alone_keeps_its_bits(inspector, document):
    stored = values(document, "root.rx")
    assert stored[0] * DEGREES / DEGREES != stored[0]
    select(inspector, document, rx=[0, 1])
    enter(inspector.key.fields["value"], "min(x, 90)")
    assert values(document, "root.rx") == [stored[0], math.pi / 2]


def test_angles_are_shown_and_taken_in_degrees_and_keep_their_bits(inspector, document):
    select(inspector, document, rx=[0, 1])
    field = inspector.key.fields["value"]
    enter(field, "max(x, 90)")
    assert values(document, "root.rx") == [math.pi / 2, math.pi]
    select(inspector, document, rx=[1])
    assert field.text() == "180"


def test_an_error_is_shown_in_the_field_and_does_no_harm(inspector, document, edits):
    select(inspector, document, tx=[1])
    field = inspector.key.fields["value"]
    spy = QSignalSpy(inspector.status)
    enter(field, "2*", then=None)
    assert field.palette().text().color() == Theme("dark").error
    assert "not a number or a formula" in field.toolTip()
    assert spy.at(spy.count() - 1)[0].startswith("Value: ")
    QTest.keyClick(field, Key.Key_Return)
    assert field.text() == "2*"
    inspector.key.fields["time"].setFocus()
    assert values(document) == [THIRD, 2, 4, 8]
    assert field.text() == "2"
    assert field.palette().text().color() != Theme("dark").error
    assert not edits


def test_a_problem_is_gone_once_the_text_is_right_again(inspector, document):
    select(inspector, document, tx=[1])
    field = inspector.key.fields["value"]
    enter(field, "6/", then=None)
    assert field.editing
    enter(field, "6/4")
    assert values(document)[1] == 1.5
    assert "formula for all" in field.toolTip().splitlines()[1]


def test_keys_that_would_share_a_time_are_refused_in_the_field(inspector, document, edits):
    select(inspector, document, tx=[1, 2])
    enter(inspector.key.fields["time"], "5")
    assert document.clip.channel("root.tx").run()["time"].tolist() == [0, 1, 2, 3]
    assert "5" in inspector.key.fields["time"].text()
    inspector.key.fields["value"].setFocus()
    assert not edits


def test_a_time_moves_the_key_past_its_neighbours(inspector, document):
    select(inspector, document, tx=[1])
    enter(inspector.key.fields["time"], "2.5")
    assert document.clip.channel("root.tx").run()["time"].tolist() == [0, 2, 2.5, 3]
    document.clip.check()


def test_a_slope_typed_fixes_its_side(inspector, document):
    select(inspector, document, tx=[1])
    enter(inspector.key.fields["slope_out"], "0,5")
    key = list(document.clip.channel("root.tx"))[1]
    assert (key.slope_out, key.rule_out) == (0.5, TangentRule.FIXED)


@pytest.mark.parametrize(
    ("modifier", "expected"),
    [(Qt.KeyboardModifier.NoModifier, 2.3), (Qt.KeyboardModifier.ShiftModifier, 5.0),
     (Qt.KeyboardModifier.ControlModifier, 2.03)],
)  # fmt: skip
def test_up_and_down_step_all_keys_as_one_undo_step(inspector, document, edits, modifier, expected):
    select(inspector, document, tx=[1, 2])
    field = inspector.key.fields["value"]
    field.setFocus()
    for key in (Key.Key_Up, Key.Key_Up, Key.Key_Up, Key.Key_Up, Key.Key_Down):
        QTest.keyClick(field, key, modifier)
    QTest.keyClick(field, Key.Key_Return)
    assert values(document)[1:3] == [pytest.approx(expected), pytest.approx(expected + 2)]
    assert len(edits) == 1


def test_stepping_there_and_back_leaves_everything_as_it_was(inspector, document, edits):
    select(inspector, document, tx=[1])
    field = inspector.key.fields["slope_out"]
    field.setFocus()
    for key in (Key.Key_Up, Key.Key_Down, Key.Key_Return):
        QTest.keyClick(field, key)
    assert not edits
    assert list(document.clip.channel("root.tx"))[1].rule_out == TangentRule.SMOOTH


def test_dragging_the_name_of_a_field_scrubs_the_number(inspector, document, edits, qtbot):
    select(inspector, document, tx=[1])
    label = next(label for label in inspector.findChildren(ScrubLabel) if label.text() == "Value")
    QTest.mousePress(label, Qt.MouseButton.LeftButton, pos=QPoint(5, 5))
    QTest.mouseMove(label, QPoint(25, 5))
    QTest.mouseMove(label, QPoint(45, 5))
    assert values(document)[1] == pytest.approx(3.0)
    assert not edits
    QTest.mouseRelease(label, Qt.MouseButton.LeftButton, pos=QPoint(45, 5))
    assert len(edits) == 1
    QTest.mousePress(label, Qt.MouseButton.LeftButton, pos=QPoint(5, 5))
    QTest.mouseMove(label, QPoint(45, 5))
    QTest.keyClick(QApplication.focusWidget(), Key.Key_Escape)
    QTest.mouseRelease(label, Qt.MouseButton.LeftButton, pos=QPoint(45, 5))
    assert values(document)[1] == pytest.approx(3.0)
    assert len(edits) == 1


def test_keys_of_locked_channels_are_not_changed(inspector, document, edits):
    document.clip.channel("root.tx").locked = True
    select(inspector, document, tx=[1])
    enter(inspector.key.fields["value"], "9")
    assert values(document)[1] == 2
    assert "locked" in inspector.key.fields["value"].toolTip()


@pytest.mark.parametrize("text", ["1e999", "1/0", "sqrt(-1)", "nonsense"])
def test_what_is_refused_holds_nothing_up(inspector, document, text):
    select(inspector, document, tx=[1])
    enter(inspector.key.fields["value"], text, then=None)
    QTest.keyClick(inspector.key.fields["value"], Key.Key_Escape)
    assert document.gesture is None
    assert values(document) == [THIRD, 2, 4, 8]


def test_typing_during_a_drag_is_refused(inspector, document):
    select(inspector, document, tx=[1])
    with document.begin("Drag"):
        enter(inspector.key.fields["value"], "9")
        assert "drag" in inspector.key.fields["value"].toolTip()
    assert values(document)[1] == 2


def test_a_command_can_keep_what_is_being_typed(inspector, document, edits):
    select(inspector, document, tx=[1])
    enter(inspector.key.fields["value"], "9", then=None)
    inspector.key.fields["value"].finish()
    assert document.gesture is None
    assert len(edits) == 1


def test_nothing_selected_means_nothing_to_edit(inspector, document):
    select(inspector, document)
    assert not any(field.isEnabled() for field in inspector.key.fields.values())
    assert all(field.text() == "" for field in inspector.key.fields.values())


def test_every_override_is_guarded():
    assert unguarded(ValueField) == unguarded(ScrubLabel) == unguarded(KeyInspector) == []


def test_an_angle_too_large_for_degrees_is_shown_as_the_largest_number(qtbot):
    document = Document(Clip([Channel("root.rx", make_run([0, 1], [1e308, 0.0]), unit="angle")]))
    inspector = KeyInspector(document, Theme("dark"))
    qtbot.addWidget(inspector)
    select(inspector, document, rx=[0])
    assert float(inspector.key.fields["value"].text()) == pytest.approx(1.797e308, rel=1e-2)
    assert values(document, "root.rx") == [1e308, 0.0]


def test_a_number_too_long_for_its_field_shows_its_sign(inspector, document):
    channel = document.clip.channel("root.tx")
    chosen = Selection.of({channel: channel.run()["id"][1:2]})
    document.session.selection = chosen
    field = inspector.key.fields["value"]
    field.setFixedWidth(48)
    document.do("Set", lambda clip: set_field(clip, chosen, "value", lambda _: -0.000245525))
    inspector.key.refresh()
    assert field.text().startswith("-0.000245")
    assert field.fontMetrics().horizontalAdvance(field.text()) > field.width()
    assert field.cursorPosition() == 0, "the text is scrolled to its end"
