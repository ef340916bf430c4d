"""A command changes what is shown as chosen, and says so where it is more or less than that."""

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu

from app.main_window import MainWindow
from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule, make_run
from model.selection import Selection
from tests.app.conftest import MakeWindow
from widgets.channel_rows import Column
from widgets.channel_verbs import set_locked

TIMES = np.arange(5.0)


@pytest.fixture
def window(make_window: MakeWindow) -> MainWindow:
    sizes = {"a.tx": 1.0, "a.ty": 10.0, "b.tx": 99.0}
    channels = [Channel(name, make_run(TIMES, TIMES**2 * size)) for name, size in sizes.items()]
    window = make_window(Clip(channels, end=4.0))
    window.session.active = channels[0]
    window.session.snap = False
    QApplication.processEvents()
    return window


def channel(window: MainWindow, name: str) -> Channel:
    return window.document.clip.channel(name)


def run(window: MainWindow, action: str) -> None:
    window.refresh_actions()
    window.actions_by_id[action].run()


def said(window: MainWindow) -> str:
    return window.status.message.text()


def label(window: MainWindow) -> str:
    return window.undo_stack.undoText()


def test_extrapolations_are_of_the_unlocked_channels_with_selected_keys_and_that_is_said(window: MainWindow) -> None:
    window.session.selection = Selection.of_all(window.document.clip.channels)
    channel(window, "b.tx").locked = True
    run(window, "curve.post.cycle_offset")
    modes = [each.post for each in window.document.clip.channels]
    assert modes == [Extrapolation.CYCLE_OFFSET, Extrapolation.CYCLE_OFFSET, Extrapolation.CONSTANT]
    assert label(window) == "Set cycle with offset after 2 channels"
    assert said(window) == "Set cycle with offset after 2 channels; 1 channel locked"


def test_the_menu_of_extrapolations_says_of_what(window: MainWindow) -> None:
    run(window, "curve.menu")
    menu = QApplication.activePopupWidget()
    assert isinstance(menu, QMenu)
    titles = [action.text() for action in menu.actions() if action.isSeparator()]
    menu.close()
    assert titles == ["Before the First Key of a.tx", "After the Last Key of a.tx"]


def test_a_locked_channel_takes_no_extrapolation_and_says_why(window: MainWindow) -> None:
    channel(window, "a.tx").locked = True
    run(window, "curve.pre.linear")
    assert channel(window, "a.tx").pre is Extrapolation.CONSTANT
    assert window.undo_stack.count() == 0
    assert "locked" in said(window)


def test_without_selected_keys_f_frames_all_chosen_channels(window: MainWindow) -> None:
    window.tree.view.choose([channel(window, "a.tx"), channel(window, "a.ty")])
    run(window, "view.frame_selection")
    seen = window.view.view_range
    assert seen.v0 < 0.0
    assert 160.0 < seen.v1 < 300.0
    assert seen.t1 > 4.0


def test_no_key_is_put_on_a_hidden_channel(window: MainWindow) -> None:
    window.session.hidden = {channel(window, "a.tx")}
    window.session.active = channel(window, "a.tx")
    window.session.playhead = 0.5
    run(window, "curve.insert_key")
    assert len(channel(window, "a.tx")) == 5
    assert "not shown" in said(window)


def test_locked_keys_are_not_selected_and_come_back_with_an_undo(window: MainWindow) -> None:
    everything = Selection.of_all(window.document.clip.channels)
    window.session.selection = everything
    set_locked(window.document, [channel(window, "a.ty")], locked=True)
    assert window.session.selection == everything.with_only([channel(window, "a.tx"), channel(window, "b.tx")])
    run(window, "key.up")
    assert label(window).startswith("Nudge 10 keys of 2 channels")
    window.undo_stack.undo()
    window.undo_stack.undo()
    assert window.session.selection == everything


def test_the_lock_in_the_tree_takes_the_keys_out_of_the_selection_too(window: MainWindow) -> None:
    window.session.selection = Selection.of_all(window.document.clip.channels)
    view, rows = window.tree.view, window.tree.view.rows
    index = rows.index_of(channel(window, "a.ty"))
    view.toggle(index.siblingAtColumn(Column.LOCK))
    assert channel(window, "a.ty").locked
    assert channel(window, "a.ty") not in window.session.selection.channels


def test_an_inserted_key_says_what_it_has_fixed_beside_it(window: MainWindow) -> None:
    window.session.active = channel(window, "a.tx")
    window.session.playhead = 1.5
    run(window, "curve.insert_key")
    key = channel(window, "a.tx").neighbours(1.4)[0]
    assert key is not None
    assert key.rule_out is TangentRule.FIXED
    assert said(window) == (
        "Insert key on a.tx at 1.5 s: 2 keys beside it are fixed now, so that the curve keeps its shape"
    )


def test_a_paste_says_where_it_went(window: MainWindow) -> None:
    window.session.selection = Selection.of({channel(window, "a.ty"): channel(window, "a.ty").run()["id"][:2]})
    run(window, "edit.copy")
    window.session.playhead = 10.0
    window.session.active = channel(window, "b.tx")
    run(window, "edit.paste")
    assert said(window) == "Pasted 2 keys into a.ty"


def test_esc_takes_the_view_back_too_where_the_edge_has_moved_it(window: MainWindow) -> None:
    view, viewport = window.view, window.view.viewport()
    key = channel(window, "a.tx").neighbours(2.0)[0]
    assert key is not None
    before = view.view_range
    start = view.plot_rect.topLeft().toPoint()
    start.setX(round(float(view.x_from_time(key.time))))
    start.setY(round(float(view.y_from_value(key.value))))
    edge = view.plot_rect.topRight().toPoint()
    edge.setX(edge.x() + 12)
    edge.setY(start.y())
    QTest.mousePress(viewport, Qt.MouseButton.LeftButton, pos=start)
    QTest.mouseMove(viewport, start + (edge - start) / 2)
    QTest.mouseMove(viewport, edge)
    QTest.qWait(200)
    assert view.view_range.t0 > before.t0
    QTest.keyClick(view, Qt.Key.Key_Escape)
    QTest.mouseRelease(viewport, Qt.MouseButton.LeftButton, pos=edge)
    after = view.view_range
    assert (after.t0, after.t1) == pytest.approx((before.t0, before.t1), abs=1e-9)
    assert channel(window, "a.tx").run()["time"].tolist() == TIMES.tolist()
