"""The window as a whole: keys go where they belong, drags and undo agree, state is kept, nothing is left behind."""

import gc
import sys
import weakref

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, QPoint, QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit, QMenu, QUndoView, QWidget
from pytestqt.qtbot import QtBot
from shiboken6 import delete, isValid

from app.main_window import MainWindow
from app.settings import Settings
from model.clip import Clip
from model.document import Document
from model.selection import Selection
from tests.app.conftest import MakeWindow, small_clip
from widgets.guard import unguarded
from widgets.hit_test import hit
from widgets.theme import Theme

LEFT, NONE = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
CTRL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier


def focus(qtbot: QtBot, window: MainWindow, widget: QWidget) -> None:
    window.activateWindow()
    widget.setFocus()
    qtbot.waitUntil(lambda: QApplication.focusWidget() is widget)


def spot_of(window: MainWindow, name: str, index: int) -> QPoint:
    """Where a key is drawn, in pixels of the graph's viewport."""
    run = window.document.clip.channel(name).run()
    view = window.view
    return QPoint(
        round(view.x_from_time(float(run["time"][index]))), round(view.y_from_value(float(run["value"][index])))
    )


def drag_key(window: MainWindow, name: str, index: int, by: QPoint, *, release: bool = True) -> None:
    start, viewport = spot_of(window, name, index), window.view.viewport()
    QTest.mouseMove(viewport, start)
    QTest.mousePress(viewport, LEFT, NONE, start)
    for part in (0.25, 0.5, 0.75, 1.0):
        QTest.mouseMove(viewport, start + QPoint(round(by.x() * part), round(by.y() * part)))
    if release:
        QTest.mouseRelease(viewport, LEFT, NONE, start + by)


# --- keys


@pytest.mark.parametrize(
    ("key", "modifiers", "tool"),
    [(Qt.Key.Key_R, NONE, "scale"), (Qt.Key.Key_T, NONE, "retime"), (Qt.Key.Key_W, NONE, "select")],
)
def test_letters_choose_tools_while_the_graph_has_the_focus(
    qtbot: QtBot, window: MainWindow, key: Qt.Key, modifiers: Qt.KeyboardModifier, tool: str
) -> None:
    focus(qtbot, window, window.view)
    QTest.keyClick(window.view, key, modifiers)
    assert window.session.tool == tool


def test_letters_digits_and_space_are_typed_while_a_field_has_the_focus(qtbot: QtBot, window: MainWindow) -> None:
    field = window.tree.filter
    focus(qtbot, window, field)
    window.actions_by_id["edit.select_all"].run()
    for key in (Qt.Key.Key_R, Qt.Key.Key_X, Qt.Key.Key_1, Qt.Key.Key_Space, Qt.Key.Key_Comma, Qt.Key.Key_BracketLeft):
        QTest.keyClick(field, key)
    assert field.text() == "rx1 ,["
    assert (window.session.tool, window.session.playing, window.undo_stack.count()) == ("select", False, 0)
    QTest.keyClick(field, Qt.Key.Key_Backspace)
    QTest.keyClick(field, Qt.Key.Key_Home)
    QTest.keyClick(field, Qt.Key.Key_Delete)
    assert field.text() == "x1 ,"
    assert window.document.clip.key_count == 6


def test_undo_in_a_field_takes_back_typing_and_with_nothing_typed_the_last_step(
    qtbot: QtBot, window: MainWindow
) -> None:
    window.actions_by_id["edit.select_all"].run()
    window.actions_by_id["edit.delete"].run()
    field = window.tree.filter
    focus(qtbot, window, field)
    QTest.keyClick(field, Qt.Key.Key_Q)
    QTest.keyClick(field, Qt.Key.Key_Z, CTRL)
    assert (field.text(), window.document.clip.key_count) == ("", 0)
    fresh = QLineEdit(window)
    fresh.show()
    focus(qtbot, window, fresh)
    QTest.keyClick(fresh, Qt.Key.Key_Z, CTRL)
    assert window.document.clip.key_count == 6


def test_arrows_belong_to_the_tree_while_it_has_the_focus_and_letters_do_not(qtbot: QtBot, window: MainWindow) -> None:
    tree = window.tree.view
    window.actions_by_id["edit.select_all"].run()
    before = window.session.playhead
    focus(qtbot, window, tree)
    for key in (Qt.Key.Key_Down, Qt.Key.Key_Up, Qt.Key.Key_Right, Qt.Key.Key_Left, Qt.Key.Key_Home):
        QTest.keyClick(tree, key)
    assert (window.session.playhead, window.undo_stack.count()) == (before, 0)
    QTest.keyClick(tree, Qt.Key.Key_R)
    assert window.session.tool == "scale"


def test_arrows_step_frames_and_nudge_while_the_graph_has_the_focus(qtbot: QtBot, window: MainWindow) -> None:
    focus(qtbot, window, window.view)
    QTest.keyClick(window.view, Qt.Key.Key_Right)
    assert window.session.playhead == pytest.approx(1 / 30)
    window.actions_by_id["edit.select_channel"].run()
    for modifiers, wanted in ((NONE, 0.1), (SHIFT, 1.1), (CTRL, 1.11)):
        QTest.keyClick(window.view, Qt.Key.Key_Up, modifiers)
        assert window.document.clip.channel("root.tx").run()["value"][0] == pytest.approx(wanted)


# --- drags and undo


def test_a_drag_is_one_step_that_undo_takes_back_with_the_selection(window: MainWindow) -> None:
    channel = window.document.clip.channel("root.tx")
    before = channel.run()
    drag_key(window, "root.tx", 1, QPoint(40, -60))
    assert window.undo_stack.count() == 1
    assert channel.run()["value"][1] > before["value"][1]
    assert window.session.selection == Selection.of_key(channel, int(before["id"][1]))
    window.undo_stack.undo()
    assert channel.run().tobytes() == before.tobytes()
    assert not window.isWindowModified()


def test_undo_in_mid_drag_cancels_the_drag_and_the_rest_of_it_does_nothing(window: MainWindow) -> None:
    channel = window.document.clip.channel("root.tx")
    before = channel.run().tobytes()
    drag_key(window, "root.tx", 1, QPoint(40, -60), release=False)
    assert channel.run().tobytes() != before
    window.actions_by_id["edit.undo"].run()
    assert channel.run().tobytes() == before
    QTest.mouseMove(window.view.viewport(), spot_of(window, "root.tx", 1) + QPoint(60, 60))
    QTest.mouseRelease(window.view.viewport(), LEFT, NONE, spot_of(window, "root.tx", 1) + QPoint(60, 60))
    assert (channel.run().tobytes(), window.undo_stack.count()) == (before, 0)


def test_commands_wait_for_the_end_of_a_drag(window: MainWindow) -> None:
    drag_key(window, "root.tx", 1, QPoint(40, -60), release=False)
    window.actions_by_id["edit.delete"].run()
    assert window.document.clip.key_count == 6
    assert "finish the drag" in window.status.message.text()


def test_closing_in_mid_drag_keeps_nothing_of_it(window: MainWindow) -> None:
    drag_key(window, "root.tx", 1, QPoint(40, -60), release=False)
    assert window.close()
    assert window.document.gesture is None


def test_the_history_panel_goes_to_any_step(window: MainWindow) -> None:
    window.actions_by_id["edit.select_all"].run()
    for _ in range(3):
        window.actions_by_id["key.up"].run()
    history = window.findChild(QUndoView)
    assert history is not None
    history.setCurrentIndex(history.model().index(1, 0))
    assert window.undo_stack.index() == 1
    assert window.document.clip.channel("root.tx").run()["value"][0] == pytest.approx(0.1)


def test_the_context_menu_of_a_key_selects_it_first(qtbot: QtBot, window: MainWindow) -> None:
    viewport, spot = window.view.viewport(), spot_of(window, "root.tx", 2)
    QTest.mouseMove(viewport, spot)
    QTest.mouseClick(viewport, Qt.MouseButton.RightButton, NONE, spot)
    menu = QApplication.activePopupWidget()
    assert menu is not None
    assert window.session.selection.count == 1
    assert window.actions_by_id["edit.delete"] in menu.actions()
    menu.close()


@pytest.mark.parametrize("place", ["key", "curve"])
def test_the_context_menu_comes_every_time_and_leaves_the_menus_whole(
    qtbot: QtBot, window: MainWindow, place: str
) -> None:
    viewport, spot = window.view.viewport(), spot_of(window, "root.tx", 2)
    if place == "curve":
        channel = window.document.clip.channel("root.tx")
        window.session.active = channel
        y = window.view.y_from_value(channel.value(1.5))
        spot = QPoint(round(float(window.view.x_from_time(1.5))), round(float(y)))
    found = hit(window.view, spot.x(), spot.y())
    assert found.kind == place
    for _ in range(3):
        window.view.router.context_menu_requested.emit(viewport.mapToGlobal(spot), found)
        menu = QApplication.activePopupWidget()
        assert isinstance(menu, QMenu)
        assert any(action.menu() is not None for action in menu.actions())
        menu.close()
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        qtbot.wait(20)
    window.session.selection = Selection.of_all(window.document.clip.channels)
    for name in ("tangent.menu", "curve.menu"):
        window.refresh_actions()
        window.actions_by_id[name].run()
        popup = QApplication.activePopupWidget()
        assert popup is not None
        popup.close()
    assert all(isValid(menu) for menu in window.menus.values())


# --- the window's own state


def test_appearance_and_options_are_remembered(make_window: MakeWindow, settings: Settings) -> None:
    first = make_window(small_clip())
    first.actions_by_id["view.appearance.light"].run()
    first.actions_by_id["key.snap"].run()
    first.actions_by_id["view.panel.inspector"].run()
    assert Theme.current().name == "light"
    assert first.close()
    second = make_window(small_clip())
    assert second.session.snap is False
    assert second.docks["inspector"].isHidden()
    assert second.actions_by_id["view.appearance.light"].isChecked()
    second.actions_by_id["view.reset_layout"].run()
    assert not second.docks["inspector"].isHidden()
    second.actions_by_id["view.appearance.dark"].run()


def test_every_dock_and_toolbar_has_a_name_to_be_remembered_by(window: MainWindow) -> None:
    names = [dock.objectName() for dock in window.docks.values()]
    assert all(names)
    assert len(set(names)) == len(names)


def test_a_layout_of_another_version_is_ignored(make_window: MakeWindow, settings: Settings) -> None:
    settings.layout = settings.geometry = b"rubbish"  # type: ignore[assignment]
    assert not make_window(small_clip()).docks["channels"].isHidden()


def test_windows_that_are_closed_leave_nothing_behind(qtbot: QtBot, settings: Settings) -> None:
    remains: list[weakref.ref[object]] = []
    for _ in range(3):
        window = MainWindow(Document(small_clip()), settings)
        window.show()
        QApplication.processEvents()
        remains += [weakref.ref(part) for part in (window, window.view, window.document, window.undo_stack)]
        window.close()
        window.deleteLater()
        del window
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    gc.collect()
    assert [reference() for reference in remains] == [None] * len(remains)


def test_every_override_of_a_qt_method_is_guarded(window: MainWindow) -> None:
    ours = {
        cls
        for name, module in sys.modules.items()
        if name.partition(".")[0] in ("app", "widgets")
        for cls in vars(module).values()
        if isinstance(cls, type) and cls.__module__.partition(".")[0] in ("app", "widgets")
    }
    assert sorted({name for cls in ours for name in unguarded(cls)}) == []


def test_an_empty_clip_opens(make_window: MakeWindow) -> None:
    window = make_window(Clip())
    assert window.session.active is None
    QTest.mouseClick(window.view.viewport(), LEFT, NONE, QPointF(window.view.plot_rect.center()).toPoint())
    assert window.undo_stack.count() == 0


def test_a_message_about_a_change_ends_with_the_next_one_and_with_its_undo(window: MainWindow) -> None:
    window.actions_by_id["edit.select_all"].run()
    window.actions_by_id["key.up"].run()
    window.say("Move 1 key, replacing 1 key")
    window.actions_by_id["edit.undo"].run()
    assert window.status.message.text() == ""
    window.say("Move 1 key: cancelled")
    window.actions_by_id["key.up"].run()
    assert window.status.message.text() == ""


def test_an_unfinished_formula_is_what_undo_names_and_takes_back(window: MainWindow) -> None:
    window.actions_by_id["edit.select_all"].run()
    window.actions_by_id["key.up"].run()
    field = window.inspector.key.fields["time"]
    for text in ("+=1", "+=1*"):
        field.setText(text)
        field.textEdited.emit(text)
    undo = window.actions_by_id["edit.undo"]
    assert undo.text().startswith("&Undo Set the time of 6 keys")
    undo.run()
    assert window.status.message.text() == "What was typed is taken back"
    assert (window.undo_stack.index(), field.editing) == (1, False)
    assert window.document.gesture is None


def test_a_message_gets_the_room_it_needs_before_the_hint(qtbot: QtBot, window: MainWindow) -> None:
    window.resize(1600, 800)
    window.status.show_hint("Drag: select with a box, " * 10)
    window.say("Value: not a number or a formula that can be worked out for these keys")
    message = window.status.message
    needed = message.fontMetrics().horizontalAdvance(message.text())
    qtbot.waitUntil(lambda: message.width() >= needed)
    window.say("A very long message " * 30)
    qtbot.waitUntil(lambda: window.status.selection.geometry().right() <= window.status.width())


def test_what_a_button_does_stands_where_the_hint_was_and_moves_nothing(qtbot: QtBot, window: MainWindow) -> None:
    window.status.show_hint("Drag: select with a box")
    qtbot.waitUntil(lambda: window.status.hint.width() > 0)
    place = window.status.selection.pos()
    window.statusBar().showMessage("Write the clip to its file")
    assert window.status.hint.text() == "Write the clip to its file"
    assert window.status.message.isHidden()
    qtbot.wait(1)
    assert window.status.selection.pos() == place
    window.statusBar().clearMessage()
    assert window.status.hint.text() == "Drag: select with a box"


def test_the_history_may_be_emptied_after_the_line_of_words_is_gone(qapp: QApplication, settings: Settings) -> None:
    window = MainWindow(Document(small_clip()), settings)
    window.actions_by_id["edit.select_all"].run()
    window.actions_by_id["key.up"].run()
    delete(window.status)  # as Qt does with the parts of a window that ends, in whatever order
    window.undo_stack.clear()
    assert window.undo_stack.count() == 0
    delete(window)
