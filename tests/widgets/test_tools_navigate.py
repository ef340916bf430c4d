"""Panning, zooming, scrubbing and the clip's range with the mouse, on a real view."""

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QNativeGestureEvent, QPointingDevice
from PySide6.QtTest import QTest

from tests.widgets.desk import Desk, beside
from tests.widgets.hand import ALT, CTRL, LEFT, MIDDLE, RIGHT, SHIFT

MIDDLE_OF_PLOT = (400.0, 300.0)


def under(desk: Desk, spot: tuple[float, float]) -> tuple[float, float]:
    """(time, value) at a pixel now."""
    return desk.view.time_from_x(spot[0]), desk.view.value_from_y(spot[1])


def spans(desk: Desk) -> tuple[float, float]:
    """How much time and value the view shows."""
    view = desk.view.view_range
    return view.t1 - view.t0, view.v1 - view.v0


def ruler(desk: Desk, time: float) -> tuple[float, float]:
    """A pixel in the time ruler."""
    return desk.view.x_from_time(time), desk.view.plot_rect.top() - 6.0


@pytest.mark.parametrize("modifiers", [Qt.KeyboardModifier.NoModifier, ALT])
def test_the_middle_button_pans(desk: Desk, modifiers: Qt.KeyboardModifier) -> None:
    held = under(desk, MIDDLE_OF_PLOT)
    before = spans(desk)
    target = beside(MIDDLE_OF_PLOT, 130, -70)
    desk.hand.drag(MIDDLE_OF_PLOT, beside(MIDDLE_OF_PLOT, 2, 1), target, button=MIDDLE, modifiers=modifiers)
    assert under(desk, target) == pytest.approx(held, abs=1e-9)
    assert spans(desk) == pytest.approx(before)
    assert desk.edits == []


def test_the_wheel_zooms_both_axes_and_keeps_what_is_under_the_pointer(desk: Desk) -> None:
    held, before = under(desk, MIDDLE_OF_PLOT), spans(desk)
    desk.hand.wheel(MIDDLE_OF_PLOT, 120)
    assert spans(desk) == pytest.approx((before[0] / 1.2, before[1] / 1.2))
    assert under(desk, MIDDLE_OF_PLOT) == pytest.approx(held)
    desk.hand.wheel(MIDDLE_OF_PLOT, -120)
    assert spans(desk) == pytest.approx(before)


@pytest.mark.parametrize(("modifier", "axis"), [(CTRL, 0), (SHIFT, 1)])
def test_ctrl_zooms_time_alone_and_shift_value_alone(desk: Desk, modifier: Qt.KeyboardModifier, axis: int) -> None:
    before = spans(desk)
    desk.hand.wheel(MIDDLE_OF_PLOT, 120, modifier)
    after = spans(desk)
    assert after[axis] == pytest.approx(before[axis] / 1.2)
    assert after[1 - axis] == before[1 - axis]


def test_small_steps_of_a_trackpad_add_up_to_a_notch(desk: Desk) -> None:
    before = spans(desk)
    for _ in range(40):
        desk.hand.wheel(MIDDLE_OF_PLOT, 3)
    assert spans(desk) == pytest.approx((before[0] / 1.2, before[1] / 1.2))


def test_a_device_that_sends_only_pixels_zooms_too(desk: Desk) -> None:
    before = spans(desk)
    desk.hand.wheel(MIDDLE_OF_PLOT, 0, pixels=QPoint(0, 30))
    assert spans(desk)[0] < before[0]


@pytest.mark.parametrize("modifier", [ALT, SHIFT])
def test_a_wheel_that_the_platform_turned_sideways_still_zooms(desk: Desk, modifier: Qt.KeyboardModifier) -> None:
    before = spans(desk)
    desk.hand.wheel(MIDDLE_OF_PLOT, 0, modifier, sideways=120)
    assert spans(desk)[1] == pytest.approx(before[1] / 1.2)


def test_a_tilted_wheel_pans_in_time(desk: Desk) -> None:
    before, size = desk.view.view_range, spans(desk)
    desk.hand.wheel(MIDDLE_OF_PLOT, 0, sideways=60)
    assert spans(desk) == pytest.approx(size)
    assert desk.view.view_range.t0 < before.t0
    assert desk.view.view_range[2:] == before[2:]


def test_over_a_ruler_the_wheel_zooms_its_axis(desk: Desk) -> None:
    before = spans(desk)
    desk.hand.wheel(ruler(desk, 2.0), 120)
    assert spans(desk) == pytest.approx((before[0] / 1.2, before[1]))
    desk.hand.wheel((5.0, 300.0), 120)
    assert spans(desk) == pytest.approx((before[0] / 1.2, before[1] / 1.2))


def test_dragging_the_value_ruler_zooms_values_about_where_it_was_taken(desk: Desk) -> None:
    start = (10.0, 300.0)
    held, before = under(desk, start)[1], spans(desk)
    desk.hand.drag(start, beside(start, 0, -50), beside(start, 0, -100))
    assert spans(desk)[0] == before[0]
    assert spans(desk)[1] == pytest.approx(before[1] / 1.01**100)
    assert under(desk, start)[1] == pytest.approx(held)


@pytest.mark.parametrize("button", [MIDDLE, RIGHT])
def test_dragging_the_time_ruler_with_another_button_zooms_time(desk: Desk, button: Qt.MouseButton) -> None:
    before, start = spans(desk), ruler(desk, 2.0)
    asked: list[object] = []
    desk.view.router.context_menu_requested.connect(lambda position, hit: asked.append(hit))
    desk.hand.drag(start, beside(start, 40, 0), button=button)
    assert spans(desk)[0] < before[0]
    assert spans(desk)[1] == before[1]
    assert under(desk, start)[0] == pytest.approx(2.0)
    assert desk.session.playhead == 0.0
    assert asked == []


def test_alt_and_the_right_button_zoom_both(desk: Desk) -> None:
    before = spans(desk)
    desk.hand.drag(MIDDLE_OF_PLOT, beside(MIDDLE_OF_PLOT, 30, -10), button=RIGHT, modifiers=ALT)
    assert spans(desk)[0] / before[0] == pytest.approx(spans(desk)[1] / before[1])
    assert spans(desk)[0] < before[0]


def test_a_pinch_zooms_between_the_fingers(desk: Desk) -> None:
    held, before = under(desk, MIDDLE_OF_PLOT), spans(desk)
    place = QPointF(*MIDDLE_OF_PLOT)
    device = QPointingDevice.primaryPointingDevice()
    event = QNativeGestureEvent(
        Qt.NativeGestureType.ZoomNativeGesture, device, 2, place, place, place, 0.25, QPointF(), 0
    )
    assert desk.view.router.handle(event)
    assert spans(desk) == pytest.approx((before[0] / 1.25, before[1] / 1.25))
    assert under(desk, MIDDLE_OF_PLOT) == pytest.approx(held)


def test_clicks_do_not_move_the_view(desk: Desk) -> None:
    before = desk.view.view_range
    desk.hand.click(MIDDLE_OF_PLOT)
    desk.hand.click(MIDDLE_OF_PLOT, MIDDLE)
    desk.hand.click(MIDDLE_OF_PLOT, RIGHT)
    assert desk.view.view_range == before


# The playhead and the range


def test_a_press_in_the_time_ruler_puts_the_playhead_there_at_once(desk: Desk) -> None:
    desk.hand.press(ruler(desk, 1.234))
    assert desk.session.playhead == pytest.approx(1.234)
    desk.hand.move(ruler(desk, 2.5))
    desk.hand.release()
    assert desk.session.playhead == pytest.approx(2.5)
    assert desk.edits == []


def test_the_playhead_snaps_to_frames_and_ctrl_turns_that_round(desk: Desk) -> None:
    desk.session.snap = True
    desk.hand.press(ruler(desk, 1.234))
    assert desk.session.playhead == 1.2
    desk.hand.move(ruler(desk, 1.234), CTRL)
    assert desk.session.playhead == pytest.approx(1.234)
    desk.hand.release()


def test_escape_puts_the_playhead_back(desk: Desk) -> None:
    desk.session.playhead = 3.0
    desk.hand.press(ruler(desk, 1.5))
    desk.hand.key(Qt.Key.Key_Escape)
    desk.hand.release()
    assert desk.session.playhead == 3.0


def test_scrubbing_stops_playing(desk: Desk) -> None:
    desk.session.playing = True
    desk.hand.click(ruler(desk, 1.5))
    assert not desk.session.playing


def test_the_view_scrolls_while_the_playhead_is_held_at_its_edge(desk: Desk) -> None:
    before = desk.view.view_range
    desk.hand.press(ruler(desk, 3.0))
    desk.hand.move((desk.view.plot_rect.right() + 10.0, ruler(desk, 3.0)[1]))
    QTest.qWait(80)
    assert desk.view.view_range.t0 > before.t0
    assert desk.view.view_range[2:] == before[2:], "only time scrolls: the pointer is above the plot all along"
    assert desk.session.playhead > 5.0
    desk.hand.release()


def test_an_end_of_the_range_follows_the_pointer_as_one_step(desk: Desk) -> None:
    desk.session.snap = True
    desk.hand.drag(ruler(desk, 4.0), ruler(desk, 3.0), ruler(desk, 2.52))
    assert (desk.clip.start, desk.clip.end) == (0.0, 2.5)
    assert [edit.label for edit in desk.edits] == ["Change range"]
    desk.document.apply(desk.edits[0].inverse())
    assert desk.clip.end == 4.0
    assert desk.session.playhead == 0.0


def test_the_ends_of_the_range_stay_a_frame_apart(desk: Desk) -> None:
    desk.session.playhead = 2.0
    desk.hand.drag(ruler(desk, 0.0), ruler(desk, 6.0))
    assert desk.clip.start == pytest.approx(3.9)
    desk.hand.drag(ruler(desk, 4.0), ruler(desk, -1.0))
    assert desk.clip.end == pytest.approx(4.0)


def test_the_start_of_the_range_under_the_playhead_is_taken_from_its_outer_side(desk: Desk) -> None:
    desk.hand.drag(beside(ruler(desk, 0.0), -3), beside(ruler(desk, -0.5), -3))
    assert desk.clip.start == pytest.approx(-0.5)
    assert desk.session.playhead == 0.0


def test_escape_gives_back_the_range(desk: Desk) -> None:
    desk.hand.drag(ruler(desk, 4.0), ruler(desk, 3.0), drop=False)
    assert desk.clip.end == pytest.approx(3.0)
    desk.hand.key(Qt.Key.Key_Escape)
    desk.hand.release()
    assert desk.clip.end == 4.0
    assert desk.edits == []


def test_the_rulers_say_what_they_do(desk: Desk) -> None:
    for spot, words in (
        (ruler(desk, 2.0), "move the playhead"),
        (ruler(desk, 4.0), "end of the clip's range"),
        ((10.0, 300.0), "zoom values"),
    ):
        desk.hand.move(spot)
        assert words in desk.hints[-1]
    desk.hand.move(MIDDLE_OF_PLOT)
    assert "select with a box" in desk.hints[-1]


def test_the_press_of_a_button_nobody_uses_is_harmless(desk: Desk) -> None:
    before = desk.keys()
    spot = desk.spot(desk.low, 2)
    desk.hand.drag(spot, beside(spot, 40), button=Qt.MouseButton.BackButton)
    assert desk.keys() == before
    desk.hand.drag(spot, beside(spot, 40), button=LEFT)
    assert desk.keys() != before
