"""Choosing keys with the mouse, on a real view."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from model import edits
from model.channel import Channel
from model.keyframe import make_run
from model.selection import Selection
from tests.widgets.desk import Desk, beside
from tests.widgets.hand import ALT, CTRL, PLAIN, RIGHT, SHIFT


def test_a_click_on_a_key_selects_it_alone_and_makes_its_channel_active(desk: Desk) -> None:
    desk.select(desk.high, 1, 2)
    desk.hand.click(desk.spot(desk.low, 3))
    assert desk.session.selection == Selection.of_key(desk.low, 3)
    assert desk.session.active is desk.low
    assert desk.edits == []


def test_a_click_on_empty_ground_clears_the_selection(desk: Desk) -> None:
    desk.select(desk.low, 1, 2)
    desk.hand.click(desk.hand.spot_of(1.5, 5.0))
    assert not desk.session.selection


@pytest.mark.parametrize("modifier", [SHIFT, CTRL])
def test_a_click_on_empty_ground_with_a_modifier_keeps_the_selection(desk: Desk, modifier: Qt.KeyboardModifier) -> None:
    desk.select(desk.low, 1, 2)
    desk.hand.click(desk.hand.spot_of(1.5, 5.0), modifiers=modifier)
    assert desk.selected(desk.low) == [1, 2]


def test_shift_click_adds_a_key_and_takes_it_out_again(desk: Desk) -> None:
    desk.hand.click(desk.spot(desk.low, 2))
    desk.hand.click(desk.spot(desk.high, 4), modifiers=SHIFT)
    assert (desk.selected(desk.low), desk.selected(desk.high)) == ([2], [4])
    desk.hand.click(desk.spot(desk.low, 2), modifiers=SHIFT)
    assert (desk.selected(desk.low), desk.selected(desk.high)) == ([], [4])


def test_a_click_on_one_of_many_selected_keys_leaves_it_alone_when_the_button_goes_up(desk: Desk) -> None:
    desk.select(desk.low, 1, 2, 3)
    desk.hand.press(desk.spot(desk.low, 2))
    assert desk.selected(desk.low) == [1, 2, 3]
    desk.hand.release()
    assert desk.selected(desk.low) == [2]


def test_alt_click_selects_the_column_of_all_shown_channels(desk: Desk) -> None:
    locked = Channel("locked", make_run([2.0], 5.0), locked=True)
    late = Channel("late", make_run([2.00004, 2.04], 7.0))
    desk.clip.channels += [locked, late]
    desk.hand.click(desk.spot(desk.low, 3), modifiers=ALT)
    assert desk.session.selection == Selection.of({desk.low: [3], desk.high: [3], late: [1]})
    desk.session.hidden = {desk.high}
    desk.hand.click(desk.spot(desk.low, 4), modifiers=ALT)
    assert desk.session.selection == Selection.of_key(desk.low, 4)
    desk.hand.click(desk.spot(desk.low, 2), modifiers=ALT | SHIFT)
    assert desk.session.selection == Selection.of({desk.low: [2, 4]})


def test_clicks_at_one_spot_go_through_the_keys_that_lie_there(desk: Desk) -> None:
    twins = [Channel(f"twin{i}", make_run([1.5], 5.0)) for i in range(3)]
    desk.clip.channels += twins
    spot = desk.spot(twins[0], 1)
    met = []
    for dx in (0, 1, 2, 1, 0, 2):
        desk.hand.click(beside(spot, dx))
        assert desk.session.selection.count == 1
        met.append(desk.session.selection.channels[0])
        assert desk.session.active is met[-1]
    assert set(met[:3]) == set(twins)
    assert met[3:] == met[:3]


def test_a_drag_between_two_clicks_begins_the_round_anew(desk: Desk) -> None:
    twins = [Channel(f"twin{i}", make_run([1.5], 5.0)) for i in range(2)]
    desk.clip.channels += twins
    spot = desk.spot(twins[0], 1)
    desk.hand.click(spot)
    first = desk.session.selection
    desk.hand.drag(spot, beside(spot, 30), spot)
    assert desk.session.selection == first
    desk.hand.click(spot)
    assert desk.session.selection == first


def test_pressing_a_spot_again_drags_the_selected_key_and_not_the_next(desk: Desk) -> None:
    twins = [Channel(f"twin{i}", make_run([1.5], 5.0)) for i in range(2)]
    desk.clip.channels += twins
    spot = desk.spot(twins[0], 1)
    desk.hand.click(spot)
    desk.hand.click(spot)
    chosen = desk.session.selection.channels[0]
    desk.hand.drag(spot, beside(spot, 50))
    assert chosen.key(1).time > 1.5
    assert all(twin.key(1).time == 1.5 for twin in twins if twin is not chosen)


def test_a_click_on_a_curve_makes_its_channel_active_and_clears_the_selection(desk: Desk) -> None:
    desk.select(desk.low, 1)
    desk.hand.click(desk.hand.spot_of(1.5, desk.high.value(1.5)))
    assert desk.session.active is desk.high
    assert not desk.session.selection


def test_clicks_on_two_crossing_curves_take_turns(desk: Desk) -> None:
    up = Channel("up", make_run([0.0, 4.0], [4.0, 6.0]))
    down = Channel("down", make_run([0.0, 4.0], [6.0, 4.0]))
    desk.clip.channels += [up, down]
    met = []
    for _ in range(4):
        desk.hand.click(desk.hand.spot_of(2.0, 5.0))
        met.append(desk.session.active)
    assert set(met[:2]) == {up, down}
    assert met[2:] == met[:2]


def test_a_double_click_on_a_curve_selects_all_its_keys(desk: Desk) -> None:
    spot = desk.hand.spot_of(1.5, desk.low.value(1.5))
    desk.hand.double_click(spot)
    assert desk.session.selection == Selection.of_all([desk.low])
    desk.hand.double_click(desk.hand.spot_of(2.5, desk.high.value(2.5)), modifiers=SHIFT)
    assert desk.session.selection == Selection.of_all([desk.low, desk.high])


def test_a_box_selects_what_it_holds_while_it_grows(desk: Desk) -> None:
    hand = desk.hand
    hand.press(hand.spot_of(0.5, 5.0))
    hand.move(hand.spot_of(1.5, -1.0))
    assert desk.selected(desk.low) == [2]
    assert desk.view.canvas.overlay.box is not None
    hand.move(hand.spot_of(2.5, -3.0))
    assert desk.selected(desk.low) == [2, 3]
    hand.move(hand.spot_of(2.5, 1.0))
    assert desk.selected(desk.low) == [2]
    hand.release()
    assert desk.session.selection == Selection.of_key(desk.low, 2)
    assert desk.view.canvas.overlay.box is None
    assert desk.edits == []


def test_a_box_with_shift_adds_and_with_ctrl_subtracts(desk: Desk) -> None:
    hand = desk.hand
    desk.select(desk.high, 1, 2)
    hand.drag(hand.spot_of(0.5, 5.0), hand.spot_of(2.5, -3.0), modifiers=SHIFT)
    assert desk.session.selection == Selection.of({desk.high: [1, 2], desk.low: [2, 3]})
    hand.drag(hand.spot_of(-0.5, 5.0), hand.spot_of(1.5, 13.0), modifiers=CTRL)
    assert desk.session.selection == Selection.of({desk.low: [2, 3]})


def test_a_modifier_may_change_while_the_box_grows(desk: Desk) -> None:
    hand = desk.hand
    desk.select(desk.high, 1)
    hand.press(hand.spot_of(0.5, 5.0))
    hand.move(hand.spot_of(2.5, -3.0))
    assert desk.session.selection == Selection.of({desk.low: [2, 3]})
    hand.move(hand.spot_of(2.5, -3.0), SHIFT)
    assert desk.session.selection == Selection.of({desk.high: [1], desk.low: [2, 3]})
    hand.release(modifiers=PLAIN)
    assert desk.session.selection == Selection.of({desk.high: [1], desk.low: [2, 3]})


def test_escape_gives_back_the_selection_of_before_the_box(desk: Desk) -> None:
    hand = desk.hand
    desk.select(desk.high, 1, 2)
    hand.drag(hand.spot_of(0.5, 5.0), hand.spot_of(2.5, -3.0), drop=False)
    desk.hand.key(Qt.Key.Key_Escape)
    assert desk.session.selection == Selection.of({desk.high: [1, 2]})
    hand.move(hand.spot_of(3.5, -3.0))
    hand.release()
    assert desk.session.selection == Selection.of({desk.high: [1, 2]})
    assert desk.view.canvas.overlay.box is None


def test_what_is_hidden_or_locked_is_not_boxed(desk: Desk) -> None:
    hand = desk.hand
    desk.session.hidden = {desk.high}
    hand.drag(hand.spot_of(-0.5, 14.0), hand.spot_of(4.5, -4.0))
    assert desk.session.selection.channels == (desk.low,)
    desk.session.hidden = set()
    desk.low.locked = True
    hand.drag(hand.spot_of(-0.5, 14.0), hand.spot_of(4.5, -4.0))
    assert desk.session.selection.channels == (desk.high,)


def test_a_locked_key_is_not_taken_and_the_hint_says_so(desk: Desk) -> None:
    desk.low.locked = True
    before = desk.keys()
    spot = desk.spot(desk.low, 2)
    desk.hand.move(spot)
    assert "low is locked" in desk.hints[-1]
    said: list[str] = []
    desk.view.status.connect(said.append)
    desk.hand.drag(spot, beside(spot, 40, 40))
    assert desk.keys() == before
    assert not desk.session.selection.contains(desk.low, 2)
    assert said == ["low is locked"]
    desk.hand.click(spot)
    assert desk.session.active is desk.low
    assert not desk.session.selection


def test_the_right_button_asks_for_the_menu_of_what_is_there(desk: Desk) -> None:
    asked = []
    desk.view.router.context_menu_requested.connect(lambda position, hit: asked.append((position, hit.kind, hit.id)))
    spot = desk.spot(desk.low, 2)
    desk.hand.click(spot, RIGHT)
    assert [each[1:] for each in asked] == [("key", 2)]
    assert desk.view.viewport().mapFromGlobal(asked[0][0]).x() == pytest.approx(spot[0], abs=1)
    desk.hand.drag(spot, beside(spot, 9), button=RIGHT)
    assert len(asked) == 2, "a hand that trembles still gets its menu"


def test_what_lay_under_the_pointer_stays_lit_after_a_right_click(desk: Desk) -> None:
    desk.hand.click(desk.spot(desk.low, 2), RIGHT)
    hover = desk.view.canvas.overlay.hover
    assert hover is not None
    assert (hover.kind, hover.id) == ("key", 2)
    assert "Drag: move 1 key" in desk.hints[-1]


def test_hints_follow_the_pointer_and_the_modifiers(desk: Desk) -> None:
    desk.select(desk.low, 1, 2, 3)
    desk.hand.move(desk.spot(desk.low, 2))
    assert desk.hints[-1].startswith("low at 1 s: 2 · Drag: move 3 keys"), "what it is comes first"
    desk.hand.move(desk.spot(desk.low, 5))
    assert "Drag: move 1 key " in desk.hints[-1]
    desk.hand.move(desk.spot(desk.low, 2), SHIFT)
    assert "take out of" in desk.hints[-1]
    desk.hand.move(desk.hand.spot_of(1.5, desk.low.value(1.5)), CTRL)
    assert "insert a key on low" in desk.hints[-1]


def test_the_pointer_shows_what_can_be_taken(desk: Desk) -> None:
    shapes = []
    for spot in (desk.spot(desk.low, 2), desk.hand.spot_of(1.5, desk.low.value(1.5)), desk.hand.spot_of(1.5, 5.0)):
        desk.hand.move(spot)
        shapes.append(desk.view.viewport().cursor().shape())
    assert shapes == [Qt.CursorShape.SizeAllCursor, Qt.CursorShape.PointingHandCursor, Qt.CursorShape.ArrowCursor]


def test_what_is_under_the_pointer_lights_up_until_it_leaves(desk: Desk) -> None:
    desk.hand.move(desk.spot(desk.low, 2))
    hover = desk.view.canvas.overlay.hover
    assert hover is not None
    assert (hover.kind, hover.id) == ("key", 2)
    desk.hand.move(desk.hand.spot_of(1.5, 5.0))
    assert desk.view.canvas.overlay.hover is None


def test_what_is_under_a_resting_pointer_is_looked_up_again_after_an_edit(desk: Desk) -> None:
    desk.hand.move(desk.spot(desk.low, 2))
    desk.document.do("Delete", lambda clip: edits.delete(clip, Selection.of_key(desk.low, 2)))
    QTest.qWait(150)
    hover = desk.view.canvas.overlay.hover
    assert hover is None or hover.kind == "curve"
