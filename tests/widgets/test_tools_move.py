"""Moving keys and spans with the mouse, on a real view."""

from time import perf_counter

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from model.channel import Channel
from model.keyframe import KeyGoneError, make_run
from model.selection import Selection
from tests.widgets.desk import Desk, beside
from tests.widgets.hand import ALT, CTRL, LEFT, PLAIN, SHIFT
from widgets.view_range import ViewRange


def test_a_key_goes_where_the_pointer_takes_it(desk: Desk) -> None:
    spot = desk.spot(desk.low, 2)
    desk.hand.drag(spot, beside(spot, 3, 3), beside(spot, 20, -31), beside(spot, 57, -83))
    d_time, d_value = desk.way(57, -83)
    key = desk.low.key(2)
    assert (key.time, key.value) == pytest.approx((1.0 + d_time, 2.0 + d_value), rel=1e-9)
    assert len(desk.edits) == 1
    assert desk.edits[0].label.startswith("Move 1 key of low by +")


def test_the_mouse_of_qt_test_does_the_same(desk: Desk) -> None:
    x, y = desk.spot(desk.low, 2)
    start, viewport = QPoint(round(x), round(y)), desk.view.viewport()
    QTest.mousePress(viewport, LEFT, PLAIN, start)
    QTest.mouseMove(viewport, start + QPoint(30, 10))
    QTest.mouseMove(viewport, start + QPoint(40, 20))
    QTest.mouseRelease(viewport, LEFT, PLAIN, start + QPoint(40, 20))
    d_time, d_value = desk.way(40, 20)
    key = desk.low.key(2)
    assert (key.time, key.value) == pytest.approx((1.0 + d_time, 2.0 + d_value), rel=1e-9)
    assert len(desk.edits) == 1


def test_a_tremble_of_less_than_four_pixels_moves_nothing(desk: Desk) -> None:
    before = desk.keys()
    spot = desk.spot(desk.low, 2)
    desk.hand.drag(spot, beside(spot, 3, 2))
    assert desk.keys() == before
    assert desk.edits == []


def test_all_selected_keys_move_together(desk: Desk) -> None:
    desk.select(desk.low, 2, 3)
    desk.session.selection |= Selection.of_key(desk.high, 3)
    before = {channel: channel.run().copy() for channel in (desk.low, desk.high)}
    spot = desk.spot(desk.low, 3)
    desk.hand.drag(spot, beside(spot, 40, -50))
    d_time, d_value = desk.way(40, -50)
    for channel, moved in ((desk.low, [2, 3]), (desk.high, [3])):
        for row in before[channel]:
            far = 1.0 if row["id"] in moved else 0.0
            key = channel.key(int(row["id"]))
            assert key.time == pytest.approx(row["time"] + far * d_time, rel=1e-9, abs=1e-12)
            assert key.value == pytest.approx(row["value"] + far * d_value, rel=1e-9, abs=1e-12)
    assert len(desk.edits) == 1
    assert desk.selected(desk.low) == [2, 3]


def test_dragging_an_unselected_key_drags_it_alone(desk: Desk) -> None:
    desk.select(desk.low, 1, 2)
    spot = desk.spot(desk.low, 4)
    desk.hand.drag(spot, beside(spot, 0, -50))
    assert desk.selected(desk.low) == [4]
    assert desk.low.key(1).value == 0.0
    assert desk.low.key(4).value > 2.0


def test_the_curve_changes_with_every_step_of_the_drag(desk: Desk) -> None:
    spot = desk.spot(desk.low, 3)
    values = []
    desk.hand.press(spot)
    for dy in (-20, -40, -60):
        desk.hand.move(beside(spot, 0, dy))
        values.append(desk.low.value(2.5))
    assert values == sorted(values)
    assert len(set(values)) == 3
    desk.hand.release()


def test_a_key_dragged_past_its_neighbours_and_back_harms_neither(desk: Desk) -> None:
    before = desk.keys()
    spot = desk.spot(desk.low, 2)
    desk.hand.press(spot)
    for time in np.linspace(1.0, 4.5, 60):
        desk.hand.move(desk.hand.spot_of(float(time), 2.0))
        desk.low.check()
    assert [key.id for key in desk.low] == [1, 3, 4, 5, 2]
    desk.hand.move(spot)
    assert desk.keys() == before
    desk.hand.release()
    assert desk.edits == []


def test_a_key_landed_upon_comes_back_if_the_drag_moves_on_and_is_replaced_if_it_ends_there(desk: Desk) -> None:
    desk.session.snap = True
    spot = desk.spot(desk.low, 2)
    desk.hand.press(spot)
    desk.hand.move(desk.hand.spot_of(2.01, 2.0))
    assert [key.id for key in desk.low] == [1, 2, 4, 5]
    assert desk.document.gesture is not None
    assert [int(row["id"]) for row in desk.document.gesture.covered[desk.low]] == [3]
    assert "lands on 1 key" in desk.hints[-1]
    desk.hand.move(desk.hand.spot_of(2.3, 2.0))
    assert [key.id for key in desk.low] == [1, 3, 2, 4, 5]
    desk.hand.move(desk.hand.spot_of(2.01, 2.0))
    desk.hand.release()
    with pytest.raises(KeyGoneError):
        desk.low.key(3)
    assert desk.edits[0].label.endswith("replacing 1 key")
    desk.document.apply(desk.edits[0].inverse())
    assert [key.time for key in desk.low] == [0.0, 1.0, 2.0, 3.0, 4.0]


def test_with_reordering_off_a_key_stops_short_of_its_neighbour(desk: Desk) -> None:
    desk.session.reorder = False
    spot = desk.spot(desk.low, 2)
    desk.hand.drag(spot, desk.hand.spot_of(3.7, 2.0))
    assert [key.id for key in desk.low] == [1, 2, 3, 4, 5]
    assert desk.low.key(2).time == pytest.approx(2.0, abs=1e-6)


# Snapping, locking, fine speed


def test_the_key_under_the_pointer_lands_on_a_frame_and_the_others_keep_their_distance(desk: Desk) -> None:
    ragged = Channel("ragged", make_run([0.52, 1.03], [5.0, 6.0]))
    desk.clip.channels.append(ragged)
    desk.session.snap = True
    desk.select(ragged, 1, 2)
    spot = desk.spot(ragged, 2)
    desk.hand.drag(spot, beside(spot, *desk_pixels(desk, 0.41)))
    assert ragged.key(2).time == 1.4
    assert ragged.key(2).time - ragged.key(1).time == pytest.approx(0.51, rel=1e-12)


def desk_pixels(desk: Desk, d_time: float) -> tuple[float, float]:
    """The way on the screen of a difference in time."""
    return desk.view.x_from_time(d_time) - desk.view.x_from_time(0.0), 0.0


def test_ctrl_turns_snapping_round_and_may_change_in_the_middle_of_a_drag(desk: Desk) -> None:
    spot = desk.spot(desk.low, 2)
    target = beside(spot, *desk_pixels(desk, 0.43))
    desk.hand.press(spot)
    desk.hand.move(target)
    assert desk.low.key(2).time == pytest.approx(1.43)
    desk.hand.move(target, CTRL)
    assert desk.low.key(2).time == 1.4
    desk.hand.move(target)
    assert desk.low.key(2).time == pytest.approx(1.43)
    desk.hand.release()
    desk.session.snap = True
    spot = desk.spot(desk.low, 4)
    desk.hand.drag(spot, beside(spot, *desk_pixels(desk, 0.27)), modifiers=CTRL)
    assert desk.low.key(4).time == pytest.approx(3.27)


def test_dragging_straight_up_does_not_pull_a_key_onto_a_frame(desk: Desk) -> None:
    ragged = Channel("ragged", make_run([1.03], [5.0]))
    desk.clip.channels.append(ragged)
    desk.session.snap = True
    spot = desk.spot(ragged, 1)
    desk.hand.drag(spot, beside(spot, 0, -40))
    assert ragged.key(1).time == 1.03


@pytest.mark.parametrize(("first", "locked"), [((30, -12), "value"), ((12, -30), "time")])
def test_shift_locks_the_first_direction(desk: Desk, first: tuple[int, int], locked: str) -> None:
    spot = desk.spot(desk.low, 2)
    desk.hand.press(spot)
    desk.hand.move(beside(spot, *first), SHIFT)
    desk.hand.move(beside(spot, 60, -61), SHIFT)
    d_time, d_value = desk.way(60, -61)
    expected = (1.0 + d_time, 2.0) if locked == "value" else (1.0, 2.0 + d_value)
    assert (desk.low.key(2).time, desk.low.key(2).value) == pytest.approx(expected, rel=1e-9)
    desk.hand.move(beside(spot, 60, -61))
    assert (desk.low.key(2).time, desk.low.key(2).value) == pytest.approx((1.0 + d_time, 2.0 + d_value), rel=1e-9)
    desk.hand.release()


def test_a_press_with_shift_adds_the_key_and_then_locks_the_drag_of_all(desk: Desk) -> None:
    desk.select(desk.low, 2)
    spot = desk.spot(desk.low, 4)
    desk.hand.drag(spot, beside(spot, 5, -60), modifiers=SHIFT)
    assert desk.selected(desk.low) == [2, 4]
    assert (desk.low.key(2).time, desk.low.key(4).time) == (1.0, 3.0)
    assert desk.low.key(2).value == desk.low.key(4).value == pytest.approx(2.0 + desk.way(0, -60)[1])


def test_alt_is_a_tenth_of_the_speed_from_where_it_is_pressed(desk: Desk) -> None:
    spot = desk.spot(desk.low, 2)
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 40, 0))
    desk.hand.move(beside(spot, 90, 0), ALT)
    assert desk.low.key(2).time == pytest.approx(1.0 + desk.way(45, 0)[0], rel=1e-9)
    desk.hand.move(beside(spot, 100, 0))
    assert desk.low.key(2).time == pytest.approx(1.0 + desk.way(55, 0)[0], rel=1e-9)
    desk.hand.release()


def test_a_modifier_key_alone_is_enough_to_change_the_drag(desk: Desk) -> None:
    spot = desk.spot(desk.low, 2)
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 40, -13))
    QTest.keyPress(desk.view, Qt.Key.Key_Shift)
    assert desk.low.key(2).value == 2.0
    QTest.keyRelease(desk.view, Qt.Key.Key_Shift, SHIFT)
    assert desk.low.key(2).value > 2.0
    desk.hand.release()


def test_the_hint_tells_the_way_so_far(desk: Desk) -> None:
    spot = desk.spot(desk.low, 2)
    desk.hand.press(spot)
    pixels = desk.view.y_from_value(2.25) - desk.view.y_from_value(2.0)
    desk.hand.move(beside(spot, desk_pixels(desk, 0.1)[0], pixels))
    assert desk.hints[-1].startswith("dt +0.10 s  dv +0.25 · Shift: lock axis")
    desk.hand.release()


# Spans


def test_dragging_a_span_moves_its_two_keys(desk: Desk) -> None:
    desk.session.active = desk.low
    start = desk.hand.spot_of(1.5, desk.low.value(1.5))
    desk.hand.drag(start, beside(start, 0, -40))
    d_value = desk.way(0, -40)[1]
    assert [key.value for key in desk.low] == pytest.approx([0.0, 2.0 + d_value, -2.0 + d_value, 2.0, 0.0])
    assert desk.selected(desk.low) == [2, 3]
    assert desk.session.active is desk.low
    assert len(desk.edits) == 1


def test_dragging_a_span_of_selected_keys_moves_all_that_are_selected(desk: Desk) -> None:
    start = desk.hand.spot_of(1.5, desk.low.value(1.5))
    desk.hand.double_click(start)
    desk.hand.drag(start, beside(start, 0, -40))
    d_value = desk.way(0, -40)[1]
    assert [key.value for key in desk.low] == pytest.approx([v + d_value for v in (0.0, 2.0, -2.0, 2.0, 0.0)])


def test_dragging_a_curve_that_is_not_active_draws_a_box_and_moves_nothing(desk: Desk) -> None:
    before = desk.keys()
    desk.session.active = None
    start = desk.hand.spot_of(1.5, desk.low.value(1.5))
    desk.hand.drag(start, beside(start, 0, -40))
    assert desk.keys() == before
    assert desk.edits == []
    assert desk.session.active is None


def test_dragging_the_curve_beyond_its_keys_boxes(desk: Desk) -> None:
    before = desk.keys()
    start = desk.hand.spot_of(4.5, 0.0)
    desk.hand.drag(start, desk.hand.spot_of(3.5, -1.0))
    assert desk.keys() == before
    assert desk.selected(desk.low) == [5]


# The view under the drag


def test_the_drag_goes_on_outside_the_view(desk: Desk) -> None:
    spot = desk.spot(desk.low, 2)
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 0, 3000))
    desk.hand.release()
    assert desk.low.key(2).value < -20.0


def test_the_view_scrolls_while_a_drag_is_held_at_its_edge(desk: Desk) -> None:
    plot = desk.view.plot_rect
    start_range = desk.view.view_range
    spot = desk.spot(desk.low, 5)
    edge = (plot.right() + 15.0, spot[1])
    desk.hand.press(spot)
    desk.hand.move(edge)
    QTest.qWait(120)
    assert desk.view.view_range.t0 > start_range.t0
    assert desk.view.view_range[2:] == start_range[2:]
    assert desk.low.key(5).time == pytest.approx(desk.view.time_from_x(edge[0]), rel=1e-9)
    desk.hand.move(beside(spot, 0, 0))
    stopped = desk.view.view_range
    QTest.qWait(60)
    assert desk.view.view_range == stopped
    desk.hand.key(Qt.Key.Key_Escape)
    assert desk.low.key(5).time == 4.0


def test_the_view_scrolls_so_slowly_at_its_edge_that_a_hand_can_stop_it(desk: Desk) -> None:
    spot = desk.spot(desk.low, 5)
    desk.hand.press(spot)
    desk.hand.move((desk.view.plot_rect.right() + 3000.0, spot[1]))
    before, began = desk.view.view_range, perf_counter()
    QTest.qWait(250)
    passed = perf_counter() - began
    plots = (desk.view.view_range.t0 - before.t0) / (before.t1 - before.t0)
    assert 0.0 < plots <= 0.5 * (passed + 0.05)
    desk.hand.release()


def test_the_view_does_not_leave_behind_a_key_that_alt_slows_down(desk: Desk) -> None:
    before = desk.view.view_range
    spot = desk.spot(desk.low, 3)
    edge = (desk.view.plot_rect.right() + 20.0, spot[1])
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 20), ALT)
    desk.hand.move(edge, ALT)
    QTest.qWait(80)
    assert desk.view.view_range == before
    desk.hand.move(edge)
    QTest.qWait(80)
    assert desk.view.view_range.t0 > before.t0
    desk.hand.move(beside(spot, 100))
    stopped = desk.view.view_range
    QTest.qWait(60)
    assert desk.view.view_range == stopped
    desk.hand.release()


@pytest.mark.parametrize(("key", "view"), [(5, ViewRange(-1.0, 4.004, -5.0, 15.0)), (1, ViewRange(-0.004, 5, -5, 15))])
def test_the_view_does_not_scroll_by_itself_when_a_key_at_its_edge_is_pressed(
    desk: Desk, key: int, view: ViewRange
) -> None:
    desk.view.set_view(view)
    before = desk.view.view_range
    spot = desk.spot(desk.low, key)
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 0, -30))
    QTest.qWait(60)
    assert desk.view.view_range == before
    desk.hand.release()


def test_a_drag_that_shift_has_locked_scrolls_along_its_axis_only(desk: Desk) -> None:
    before = desk.view.view_range
    spot = desk.spot(desk.low, 5)
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 2, -30), SHIFT)
    desk.hand.move((desk.view.plot_rect.right() + 20.0, desk.view.plot_rect.top() - 20.0), SHIFT)
    QTest.qWait(80)
    assert desk.view.view_range.v1 > before.v1
    assert desk.view.view_range[:2] == before[:2]
    desk.hand.release(modifiers=SHIFT)
    assert desk.low.key(5).time == 4.0


def test_a_key_stays_under_the_pointer_when_the_view_is_panned_in_the_middle_of_a_drag(desk: Desk) -> None:
    spot = desk.spot(desk.low, 2)
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 50, 0))
    desk.hand.wheel(beside(spot, 50, 0), 0, sideways=90)
    assert desk.view.x_from_time(desk.low.key(2).time) == pytest.approx(spot[0] + 50)
    desk.hand.release()


def test_zooming_in_the_middle_of_a_drag_does_not_disturb_it(desk: Desk) -> None:
    spot = desk.spot(desk.low, 2)
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 50, 0))
    time = desk.low.key(2).time
    desk.hand.wheel(beside(spot, 50, 0), 240)
    assert desk.low.key(2).time == pytest.approx(time, rel=1e-9)
    desk.hand.release()
    assert desk.low.key(2).time == pytest.approx(time, rel=1e-9)


def test_one_drag_is_one_step_and_undo_gives_back_the_bits_and_the_selection(desk: Desk) -> None:
    before = desk.keys()
    desk.select(desk.low, 2, 3)
    chosen = desk.session.selection
    spot = desk.spot(desk.low, 3)
    desk.hand.drag(spot, *(beside(spot, dx, dx / 3) for dx in range(5, 90, 7)))
    assert len(desk.edits) == 1
    desk.session.selection = Selection.NONE
    desk.document.apply(desk.edits[0].inverse())
    assert desk.keys() == before
    assert desk.session.selection == chosen
