"""Channels are found, chosen, renamed, coloured and framed by mouse and keyboard."""

import time

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QContextMenuEvent, QPalette
from PySide6.QtTest import QAbstractItemModelTester, QSignalSpy, QTest
from PySide6.QtWidgets import QApplication, QLineEdit, QMenu

from model.channel import Channel
from model.clip import Clip
from model.document import Document, Membership
from model.keyframe import make_run
from tests.widgets.tree_hand import center, channel, click, group_center, names, six_channels, tree_of
from widgets.channel_cells import ChannelCells
from widgets.channel_rows import ChannelRows, Column
from widgets.channel_tree import ChannelTree
from widgets.channel_view import ChannelView
from widgets.guard import unguarded

Key = Qt.Key
Left = Qt.MouseButton.LeftButton


@pytest.fixture
def document():
    return six_channels()


@pytest.fixture
def tree(qtbot, document):
    return tree_of(document, qtbot)


@pytest.fixture
def edits(document):
    seen = []
    document.committed.connect(seen.append)
    return seen


def shown_texts(tree):
    """Every row as a person reads it, from top to bottom."""
    rows, texts = tree.view.rows, []
    for row in range(rows.rowCount()):
        index = rows.index(row, 0)
        texts.append(rows.data(index))
        texts += ["  " + rows.data(rows.index(child, 0, index)) for child in range(rows.rowCount(index))]
    return texts


def test_channels_stand_in_the_groups_that_their_names_tell(tree):
    assert shown_texts(tree) == ["root", "  tx", "  ty", "  tz", "blink", "head", "  rx", "  ry"]
    assert all(tree.view.isExpanded(tree.view.rows.index(row, 0)) for row in (0, 2))


def test_the_rows_are_a_sound_model_for_qt(tree, document, qtbot):
    QAbstractItemModelTester(tree.view.rows, QAbstractItemModelTester.FailureReportingMode.QtTest)
    tree.filter.setText("r")
    document.replace(Clip([Channel("a.b.c"), Channel("d")]))
    assert shown_texts(tree) == ["a.b", "  c", "d"]


def test_a_click_makes_the_channel_active_and_chosen(tree, document):
    click(tree, center(tree, "root.ty"))
    assert document.session.active is channel(tree, "root.ty")
    assert names(tree.chosen()) == ["root.ty"]
    click(tree, center(tree, "head.rx"), Qt.KeyboardModifier.ControlModifier)
    assert names(tree.chosen()) == ["root.ty", "head.rx"]
    assert document.session.active is channel(tree, "head.rx")


def test_a_chosen_group_stands_for_its_channels(tree):
    click(tree, group_center(tree, 2))
    assert names(tree.chosen()) == ["head.rx", "head.ry"]


def test_the_active_channel_is_chosen_wherever_it_was_activated(tree, document):
    document.session.active = channel(tree, "head.ry")
    assert names(tree.chosen()) == ["head.ry"]
    click(tree, center(tree, "root.tx"))
    click(tree, center(tree, "root.ty"), Qt.KeyboardModifier.ControlModifier)
    document.session.active = channel(tree, "root.tx")
    assert names(tree.chosen()) == ["root.tx", "root.ty"]


def test_the_filter_finds_all_words_in_the_full_name_in_any_case(tree):
    tree.focus_filter()
    QTest.keyClicks(tree.filter, "X oo")
    assert shown_texts(tree) == ["root", "  tx"]
    QTest.keyClick(tree.filter, Key.Key_Escape)
    assert len(shown_texts(tree)) == 8
    channel(tree, "blink").name = "BLINK"
    QTest.keyClicks(tree.filter, "blI")
    assert shown_texts(tree) == ["BLINK"]


def test_from_the_filter_the_down_key_goes_to_what_was_found(tree, document):
    tree.focus_filter()
    QTest.keyClicks(tree.filter, "head")
    QTest.keyClick(tree.filter, Key.Key_Down)
    assert tree.view.hasFocus()
    assert document.session.active is channel(tree, "head.rx")


def test_chosen_channels_and_folds_outlive_the_filter(tree):
    click(tree, center(tree, "head.rx"))
    tree.view.collapse(tree.view.rows.index(0, 0))
    tree.filter.setText("r")
    assert tree.view.isExpanded(tree.view.rows.index(0, 0))
    tree.filter.clear()
    assert not tree.view.isExpanded(tree.view.rows.index(0, 0))
    assert tree.view.isExpanded(tree.view.rows.index(2, 0))
    assert names(tree.chosen()) == ["head.rx"]


def test_what_is_folded_while_filtering_is_not_folded_afterwards(tree):
    tree.filter.setText("root")
    tree.view.collapse(tree.view.rows.index(0, 0))
    tree.filter.clear()
    assert tree.view.isExpanded(tree.view.rows.index(0, 0))


def test_hide_only_these_and_reveal_act_on_the_chosen(tree, document):
    click(tree, group_center(tree, 2))
    tree.hide_chosen()
    assert names(document.session.shown_channels(document.clip)) == ["root.tx", "root.ty", "root.tz", "blink"]
    tree.reveal_all()
    tree.show_only_chosen()
    assert names(document.session.shown_channels(document.clip)) == ["head.rx", "head.ry"]
    tree.reveal_all()
    assert len(document.session.shown_channels(document.clip)) == 6


def test_f2_renames_in_place_and_undo_brings_the_old_name_back(tree, document, edits, qtbot):
    click(tree, center(tree, "root.ty"))
    QTest.keyClick(tree.view, Key.Key_F2)
    editor = tree.view.findChild(QLineEdit)
    assert editor.text() == "root.ty"
    editor.selectAll()
    QTest.keyClicks(editor, "hip.ty")
    QTest.keyClick(editor, Key.Key_Return)
    qtbot.waitUntil(lambda: document.clip.channels[1].name == "hip.ty")
    assert shown_texts(tree)[:5] == ["root", "  tx", "  tz", "hip", "  ty"]
    document.apply(edits[0].inverse())
    assert shown_texts(tree)[:3] == ["root", "  tx", "  ty"]


def test_renaming_a_group_renames_all_its_channels_in_one_step(tree, document, edits, qtbot):
    click(tree, group_center(tree, 0))
    tree.rename_chosen()
    editor = tree.view.findChild(QLineEdit)
    editor.selectAll()
    QTest.keyClicks(editor, "hip")
    QTest.keyClick(editor, Key.Key_Return)
    qtbot.waitUntil(lambda: names(document.clip.channels)[:3] == ["hip.tx", "hip.ty", "hip.tz"])
    assert len(edits) == 1


@pytest.mark.parametrize("text", ["root.tx", "  ", "hip.", "a\tb"])
def test_a_name_that_cannot_be_is_refused_in_words(tree, edits, text):
    spy = QSignalSpy(tree.status)
    index = tree.view.rows.index_of(channel(tree, "root.ty"))
    assert not tree.view.rows.setData(index, text, Qt.ItemDataRole.EditRole)
    assert spy.count() == 1
    assert not edits


def test_a_double_click_and_enter_ask_to_frame_the_channel(tree):
    spy = QSignalSpy(tree.frame_requested)
    QTest.mouseDClick(tree.view.viewport(), Left, pos=center(tree, "root.ty"))
    click(tree, center(tree, "head.rx"))
    QTest.keyClick(tree.view, Key.Key_Return)
    assert [spy.at(i)[0].name for i in range(spy.count())] == ["root.ty", "head.rx"]


def test_colours_come_from_the_menu_and_can_be_undone(tree, document, edits, monkeypatch):
    opened = []
    monkeypatch.setattr(QMenu, "popup", lambda menu, where: opened.append(menu))
    click(tree, center(tree, "root.ty"))
    where = center(tree, "root.ty")
    QApplication.sendEvent(
        tree.view.viewport(),
        QContextMenuEvent(QContextMenuEvent.Reason.Mouse, where, tree.view.viewport().mapToGlobal(where)),
    )
    color = next(a.menu() for a in opened[0].actions() if a.text() == "Color")
    next(a for a in color.actions() if a.text() == "Amber").trigger()
    assert channel(tree, "root.ty").color == "#f2b01e"
    assert [edit.label for edit in edits] == ["Color root.ty"]


def test_an_edit_keeps_folds_choice_and_place(tree, document, qtbot):
    document.replace(Clip([Channel(f"g{i // 10}.c{i}", make_run([0], [i])) for i in range(500)]))
    tree.view.collapse(tree.view.rows.index(0, 0))
    tree.view.choose([document.clip.channels[205], document.clip.channels[207]])
    document.session.active = document.clip.channels[207]
    tree.view.verticalScrollBar().setValue(700)
    before = tuple(document.clip.channels)
    document.do("Remove", lambda clip: [Membership(before, before[:-1])])
    assert tree.view.verticalScrollBar().value() == 700
    assert names(tree.chosen()) == ["g20.c205", "g20.c207"]
    assert not tree.view.isExpanded(tree.view.rows.index(0, 0))


def test_an_empty_clip_says_what_to_do(tree, document, qtbot):
    document.replace(Clip())
    assert "Open a clip" in tree.view.empty_text
    blank = tree.view.viewport().grab().toImage()
    colors = {blank.pixelColor(x, blank.height() // 2 + y).name() for x in range(280) for y in range(-30, 30)}
    assert len(colors) > 2
    document.replace(Clip([Channel("a")]))
    tree.filter.setText("zzz")
    assert "zzz" in tree.view.empty_text


def test_thousands_of_channels_are_listed_and_filtered_at_once(tree, document):
    document.replace(Clip([Channel(f"joint{i // 3}.r{'xyz'[i % 3]}", make_run([0], [0])) for i in range(3000)]))
    start = time.perf_counter()
    tree.filter.setText("99 x")
    tree.filter.clear()
    assert time.perf_counter() - start < 1.5


def test_every_override_is_guarded():
    for cls in (ChannelTree, ChannelView, ChannelCells, ChannelRows):
        assert unguarded(cls) == []


@pytest.mark.parametrize("with_focus", [True, False])
def test_a_value_that_changes_keeps_the_ground_of_its_row(tree, document, qtbot, with_focus):
    click(tree, center(tree, "root.ty"))
    (tree.view if with_focus else tree.filter).setFocus()
    qtbot.wait(50)
    document.session.playhead = 0.7
    qtbot.wait(50)  # only the value has been painted anew
    index = tree.view.rows.index_of(channel(tree, "root.ty"))
    screen = tree.screen().grabWindow(tree.winId()).toImage()
    corners = [tree.view.visualRect(index.siblingAtColumn(column)).topLeft() for column in (Column.NAME, Column.VALUE)]
    spots = [tree.view.viewport().mapTo(tree, corner + QPoint(1, 1)) for corner in corners]
    name, value = (screen.pixelColor(spot).name() for spot in spots)
    group = QPalette.ColorGroup.Active if with_focus else QPalette.ColorGroup.Inactive
    assert name == value == tree.view.palette().color(group, QPalette.ColorRole.Highlight).name()


def test_esc_clears_the_filter_and_then_leaves_it(tree, qtbot):
    tree.focus_filter()
    QTest.keyClicks(tree.filter, "head")
    with qtbot.assertNotEmitted(tree.left):
        QTest.keyClick(tree.filter, Key.Key_Escape)
    assert tree.filter.text() == ""
    with qtbot.waitSignal(tree.left):
        QTest.keyClick(tree.filter, Key.Key_Escape)


def test_the_name_of_a_group_goes_on_where_a_value_would_be(qtbot):
    name = "rig_control_000_of_the_left_hand"
    document = Document(Clip([Channel(f"{name}.tx", make_run([0, 1], [0, 1]))], end=1))
    tree = tree_of(document, qtbot)
    view, index = tree.view, tree.view.rows.index(0, 0)
    assert view.fontMetrics().horizontalAdvance(name) > view.visualRect(index).width()
    value = view.visualRect(index.siblingAtColumn(Column.VALUE))
    image = view.viewport().grab(value).toImage()
    inked = [
        x
        for x in range(value.width() - 4)
        if any(image.pixelColor(x, y) != image.pixelColor(0, 0) for y in range(2, value.height() - 2))
    ]
    assert len(inked) > 10
