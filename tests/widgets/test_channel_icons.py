"""The columns beside a channel's name: its live value, and the icons show, lock and solo."""

import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from model.document import Splice
from tests.widgets.tree_hand import center, channel, click, group_center, names, six_channels, tree_of
from widgets.channel_rows import Column

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


def test_the_eye_hides_and_shows_a_channel_and_chooses_nothing(tree, document, edits):
    click(tree, center(tree, "root.ty", Column.SHOW))
    assert not document.session.shown(channel(tree, "root.ty"))
    assert document.session.active is None
    click(tree, center(tree, "root.ty", Column.SHOW))
    assert document.session.shown(channel(tree, "root.ty"))
    assert not edits


def test_the_eye_of_a_group_acts_on_all_its_channels(tree, document):
    click(tree, center(tree, "root.ty", Column.SHOW))
    click(tree, group_center(tree, 0, Column.SHOW))
    assert not document.session.hidden
    click(tree, group_center(tree, 0, Column.SHOW))
    assert {c.name for c in document.session.hidden} == {"root.tx", "root.ty", "root.tz"}


def test_dragging_over_eyes_gives_all_the_state_of_the_first(tree, document):
    click(tree, center(tree, "root.ty", Column.SHOW))
    viewport = tree.view.viewport()
    QTest.mousePress(viewport, Left, pos=center(tree, "root.tx", Column.SHOW))
    for name in ("root.ty", "root.tz", "blink"):
        QTest.mouseMove(viewport, center(tree, name, Column.SHOW))
    QTest.mouseRelease(viewport, Left, pos=center(tree, "blink", Column.SHOW))
    assert {c.name for c in document.session.hidden} == {"root.tx", "root.ty", "root.tz", "blink"}


def test_dragging_over_locks_is_one_undo_step(tree, document, edits):
    viewport = tree.view.viewport()
    QTest.mousePress(viewport, Left, pos=center(tree, "root.tx", Column.LOCK))
    QTest.mouseMove(viewport, center(tree, "root.ty", Column.LOCK))
    assert channel(tree, "root.ty").locked
    QTest.mouseRelease(viewport, Left, pos=center(tree, "root.ty", Column.LOCK))
    assert [edit.label for edit in edits] == ["Lock 2 channels"]
    document.apply(edits[0].inverse())
    assert not any(c.locked for c in document.clip.channels)


def test_solo_shows_only_the_marked_channels(tree, document):
    click(tree, center(tree, "blink", Column.SOLO))
    assert names(document.session.shown_channels(document.clip)) == ["blink"]
    click(tree, center(tree, "blink", Column.SOLO))
    assert len(document.session.shown_channels(document.clip)) == 6


def test_arrow_keys_reach_the_icons_and_space_turns_them(tree, document):
    click(tree, center(tree, "root.tx"))
    for key in (Key.Key_Right, Key.Key_Right, Key.Key_Space):
        QTest.keyClick(tree.view, key)
    assert channel(tree, "root.tx").locked
    for key in (Key.Key_Left, Key.Key_Space, Key.Key_Left, Key.Key_Down):
        QTest.keyClick(tree.view, key)
    assert channel(tree, "root.tx") in document.session.hidden
    assert document.session.active is channel(tree, "root.ty")


@pytest.mark.parametrize(
    ("key", "column", "own"),
    [
        (Key.Key_Up, Column.NAME, True),
        (Key.Key_Home, Column.NAME, True),
        (Key.Key_Space, Column.NAME, False),
        (Key.Key_Space, Column.SHOW, True),
        (Key.Key_H, Column.NAME, False),
    ],
)
def test_the_tree_keeps_the_keys_it_needs_from_the_shortcuts_of_the_window(tree, key, column, own):
    tree.view.setCurrentIndex(tree.view.rows.index_of(channel(tree, "root.tx"), column))
    event = QKeyEvent(QEvent.Type.ShortcutOverride, key, Qt.KeyboardModifier.NoModifier)
    event.ignore()
    QApplication.sendEvent(tree.view, event)
    assert event.isAccepted() == own


def test_values_at_the_playhead_are_shown_in_the_channels_unit(tree, document):
    rows = tree.view.rows
    document.session.playhead = 1.0
    assert rows.data(rows.index_of(channel(tree, "root.ty"), Column.VALUE)) == "2.000"
    assert rows.data(rows.index_of(channel(tree, "head.rx"), Column.VALUE)) == "286.48°"


def value_pixels(tree, name):
    rect = tree.view.visualRect(tree.view.rows.index_of(channel(tree, name), Column.VALUE))
    image = tree.view.viewport().grab(rect).toImage()
    return bytes(image.constBits())


def test_only_values_that_read_differently_are_painted_again_and_they_are_right(tree, document, qtbot, monkeypatch):
    flat = document.clip.channel("blink")
    document.do("Flat", lambda clip: [_flattened(flat)])
    qtbot.wait(50)
    document.session.playhead = 0.4
    qtbot.wait(50)
    painted = []
    paint = tree.view.cells.paint_values
    monkeypatch.setattr(tree.view.cells, "paint_values", lambda *a: (painted.append(len(a[3])), paint(*a)))
    document.session.playhead = 0.5
    qtbot.waitUntil(lambda: bool(painted))
    assert painted == [5]
    half = value_pixels(tree, "root.tx")
    document.session.playhead = 0.0
    qtbot.wait(50)
    assert value_pixels(tree, "root.tx") != half
    document.session.playhead = 0.5
    qtbot.wait(50)
    assert value_pixels(tree, "root.tx") == half


def test_a_value_painted_with_all_in_between_is_painted_again(tree, document, qtbot, monkeypatch):
    document.session.playhead = 0.5
    qtbot.wait(50)
    painted = []
    monkeypatch.setattr(tree.view.cells, "paint_values", lambda *a: painted.append(len(a[3])))
    document.session.playhead = 0.7
    tree.view.viewport().repaint()
    document.session.playhead = 0.5
    qtbot.waitUntil(lambda: painted == [6])


def _flattened(channel):
    run = channel.run()
    after = run.copy()
    after["value"] = 7.0
    return Splice(channel, run, after)


def test_a_value_painted_alone_looks_like_one_painted_with_all(tree, document):
    click(tree, center(tree, "root.ty"))
    tree.view.update_values()
    rect = tree.view.visualRect(tree.view.rows.index_of(channel(tree, "root.ty"), Column.VALUE))
    alone = tree.view.viewport().grab(rect).toImage()
    whole = tree.view.viewport().grab().toImage().copy(rect)
    assert alone == whole


def test_icons_are_words_for_a_screen_reader(tree, document):
    rows = tree.view.rows
    index = rows.index_of(channel(tree, "root.tx"), Column.SHOW)
    assert rows.data(index, Qt.ItemDataRole.AccessibleTextRole) == "shown"
    click(tree, center(tree, "root.tx", Column.SHOW))
    assert rows.data(index, Qt.ItemDataRole.AccessibleTextRole) == "hidden"
    assert rows.data(rows.index(0, Column.SHOW), Qt.ItemDataRole.AccessibleTextRole) == "some shown"
    assert tree.view.accessibleName() == "Channels"
    assert tree.filter.accessibleName()
