"""Every way out of a drag: Esc, the right button, lost pointers, errors; none leaves a trace."""

import pytest
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QCloseEvent, QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QApplication

from model import edits
from model.clip import Clip
from model.selection import Selection
from tests.widgets.desk import Desk, beside
from tests.widgets.hand import CTRL, LEFT, MIDDLE, PLAIN, RIGHT


@pytest.mark.parametrize(
    "way_out", ["escape", "right button", "focus", "window", "hide", "close", "undo", "other clip", "tool"]
)
def test_every_way_out_of_a_drag_leaves_no_trace(desk: Desk, way_out: str) -> None:
    before = desk.keys()
    desk.select(desk.high, 1)
    chosen = desk.session.selection
    spot = desk.spot(desk.low, 2)
    desk.hand.drag(spot, beside(spot, 60, -40), drop=False)
    assert desk.keys() != before
    leave(desk, way_out)
    assert desk.keys() == before
    assert desk.document.gesture is None
    assert not desk.view.router.busy
    assert desk.edits == []
    if way_out == "other clip":
        assert not desk.session.selection
        assert desk.session.active is None
    else:
        assert desk.session.selection == chosen
        desk.hand.move(beside(spot, 90, -90))
        desk.hand.release(beside(spot, 90, -90))
        assert desk.keys() == before
        assert desk.session.selection == chosen


def leave(desk: Desk, way_out: str) -> None:
    view = desk.view
    match way_out:
        case "escape":
            desk.hand.key(Qt.Key.Key_Escape)
        case "right button":
            desk.hand.press(desk.hand.spot, RIGHT)
            desk.hand.release(desk.hand.spot, RIGHT)
        case "focus":
            view.clearFocus()
        case "window":
            QApplication.sendEvent(view, QEvent(QEvent.Type.WindowDeactivate))
        case "hide":
            QApplication.sendEvent(view, QEvent(QEvent.Type.Hide))
        case "close":
            QApplication.sendEvent(view, QCloseEvent())
        case "undo":
            desk.hand.key(Qt.Key.Key_Z, CTRL)
        case "other clip":
            desk.document.replace(Clip())
        case "tool":
            desk.session.tool = "scale"


def test_the_right_button_in_a_drag_opens_no_menu(desk: Desk) -> None:
    asked = []
    desk.view.router.context_menu_requested.connect(lambda position, hit: asked.append(hit))
    spot = desk.spot(desk.low, 2)
    desk.hand.drag(spot, beside(spot, 60, -40), drop=False)
    desk.hand.press(desk.hand.spot, RIGHT)
    desk.hand.release(desk.hand.spot, RIGHT)
    desk.hand.release(desk.hand.spot)
    assert asked == []


def test_escape_without_a_drag_is_left_to_others(desk: Desk) -> None:
    assert not desk.view.router.handle(key_event(Qt.Key.Key_Escape))


def key_event(key: Qt.Key) -> QKeyEvent:
    return QKeyEvent(QEvent.Type.KeyPress, key, PLAIN)


@pytest.mark.parametrize("code", [0x0416, 0x10FFFF, 0])
def test_keys_without_a_name_are_left_to_others(desk: Desk, code: int) -> None:
    event = QKeyEvent(QEvent.Type.KeyPress, code, PLAIN)
    assert not desk.view.router.handle(event)


def test_no_command_comes_through_in_the_middle_of_a_drag(desk: Desk) -> None:
    spot = desk.spot(desk.low, 2)
    desk.hand.drag(spot, beside(spot, 60, -40), drop=False)
    assert desk.view.router.handle(key_event(Qt.Key.Key_Delete))
    assert desk.view.router.busy
    desk.hand.release()
    assert not desk.view.router.handle(key_event(Qt.Key.Key_Delete))


def test_the_middle_button_in_a_drag_changes_nothing(desk: Desk) -> None:
    spot = desk.spot(desk.low, 2)
    view_range = desk.view.view_range
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 30, 0))
    desk.hand.press(beside(spot, 30, 0), MIDDLE)
    desk.hand.move(beside(spot, 60, 0))
    desk.hand.release(beside(spot, 60, 0), MIDDLE)
    desk.hand.release()
    assert desk.view.view_range == view_range
    assert desk.low.key(2).time == pytest.approx(1.0 + desk.way(60, 0)[0])


def test_a_release_that_never_came_cancels_at_the_next_move(desk: Desk) -> None:
    before = desk.keys()
    spot = desk.spot(desk.low, 2)
    desk.hand.drag(spot, beside(spot, 60, -40), drop=False)
    desk.hand.held = Qt.MouseButton.NoButton
    desk.hand.move(beside(spot, 10, 10))
    assert desk.keys() == before
    assert desk.document.gesture is None


def test_an_error_in_the_middle_of_a_drag_leaves_no_gesture_open(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    before = desk.keys()
    spot = desk.spot(desk.low, 2)
    desk.hand.drag(spot, beside(spot, 20, 0), drop=False)

    def broken(*_: object, **__: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("model.edits.move", broken)
    place = QPointF(*beside(spot, 40))
    event = QMouseEvent(QEvent.Type.MouseMove, place, place, Qt.MouseButton.NoButton, LEFT, PLAIN)
    with pytest.raises(ZeroDivisionError):
        desk.view.router.handle(event)
    assert desk.document.gesture is None
    assert desk.keys() == before


def test_a_press_while_another_edit_is_open_changes_nothing(desk: Desk) -> None:
    before = desk.keys()
    gesture = desk.document.begin("Type a value")
    spot = desk.spot(desk.low, 2)
    desk.hand.drag(spot, beside(spot, 60, -40))
    assert desk.keys() == before
    assert desk.document.gesture is gesture
    gesture.cancel()


def test_what_is_selected_again_after_a_cancelled_press_is_still_there(desk: Desk) -> None:
    chosen = Selection.of({desk.low: desk.low.run()["id"]})
    desk.session.selection = chosen
    desk.hand.press(desk.spot(desk.high, 1))
    gone = Selection.of({desk.low: desk.low.run()["id"][:2]})
    desk.document.do("Delete", lambda clip: edits.delete(clip, gone))
    desk.hand.key(Qt.Key.Key_Escape)
    assert desk.session.selection == chosen.minus(gone)


def test_a_key_that_goes_while_the_button_is_on_it_is_not_dragged(desk: Desk) -> None:
    spot = desk.spot(desk.low, 2)
    desk.hand.press(spot)
    pressed = desk.view.router.tool.grabbed.id
    selection = Selection.of_key(desk.low, pressed)
    desk.document.do("Delete", lambda clip: edits.delete(clip, selection))
    desk.hand.move(beside(spot, 60, -40))
    desk.hand.release(beside(spot, 60, -40))
    assert pressed not in desk.low
    assert desk.document.gesture is None
    assert len(desk.edits) == 1
