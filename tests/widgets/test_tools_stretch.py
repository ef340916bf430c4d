"""What scaling and retiming leave alone, and what their box and its handles say."""

from math import isfinite

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication

from model import edits
from model.document import Membership
from model.selection import Selection
from tests.widgets.desk import TIMES, Desk, beside
from tests.widgets.hand import CTRL, PLAIN, SHIFT, Spot
from tests.widgets.test_tools_scale import begin, columns, handle
from widgets.graph import Frame
from widgets.tools.scale import MIN_FACTOR, PADDING, Bounds, ScaleTool

VALUES = [0.0, 2.0, -2.0, 2.0, 0.0]


def frame_now(desk: Desk) -> Frame:
    QApplication.processEvents()
    frame = desk.view.canvas.overlay.frame
    assert frame is not None
    return frame


def seconds(desk: Desk, d_time: float) -> float:
    """So much time in pixels."""
    return desk.view.x_from_time(d_time) - desk.view.x_from_time(0.0)


def middle_of(frame: Frame) -> Spot:
    return frame.box.center().x(), frame.box.center().y()


def test_a_key_stretches_values_about_the_middle_too(desk: Desk) -> None:
    begin(desk, "scale", 2, 3)
    spot = desk.spot(desk.low, 2)
    desk.hand.drag(spot, beside(spot, 2, -40), modifiers=SHIFT)
    d_value = desk.way(0, -40)[1]
    assert columns(desk) == ([*TIMES], pytest.approx([0.0, 2.0 + d_value, -2.0 - d_value, 2.0, 0.0]))


def test_the_middle_of_very_far_keys_is_a_place() -> None:
    assert all(map(isfinite, Bounds(1e308, 1.7e308, -1.7e308, 1.7e308).center))


def test_ctrl_in_the_drag_turns_snapping_off(desk: Desk) -> None:
    desk.session.snap = True
    start = handle(begin(desk, "scale", 2, 3), 1, 0)
    desk.hand.press(start)
    for modifiers, landed in ((PLAIN, 2.5), (CTRL, 2.47)):
        desk.hand.move(beside(start, seconds(desk, 0.47)), modifiers)
        assert desk.low.key(3).time == pytest.approx(landed)
    desk.hand.release()


def test_a_corner_that_moves_up_alone_leaves_a_time_that_is_on_no_frame(desk: Desk) -> None:
    desk.document.do("Move", lambda clip: edits.move(clip, Selection.of_key(desk.low, 4), 0.03, 0.0))
    desk.session.snap = True
    start = handle(begin(desk, "scale", 2, 3, 4), 1, -1)
    desk.hand.drag(start, beside(start, 0, -40))
    assert desk.low.key(4).time == 3.03
    assert desk.low.key(4).value > 2.5


def test_an_edge_knows_one_axis_only_so_that_shift_takes_none_away(desk: Desk) -> None:
    start = handle(begin(desk, "scale", 2, 3, 4), 1, 0)
    desk.hand.drag(start, beside(start, seconds(desk, 0.5), 200), modifiers=SHIFT)
    assert columns(desk)[0] == pytest.approx([0.0, 1.0, 2.25, 3.5, 4.0])


def test_keys_can_be_squeezed_to_a_thousandth_and_then_turned_round(desk: Desk) -> None:
    start = handle(begin(desk, "scale", 1, 2, 3, 4, 5), 1, 0)
    desk.hand.press(start)
    desk.hand.move(beside(start, -seconds(desk, 4.0)))
    assert desk.low.key(5).time - desk.low.key(1).time == pytest.approx(4.0 * MIN_FACTOR)
    desk.hand.move(beside(start, -seconds(desk, 5.0)))
    assert [key.id for key in desk.low] == [5, 4, 3, 2, 1]
    desk.hand.release()


@pytest.mark.parametrize(("side", "axes"), [((1, 0), (True, False)), ((0, -1), (False, True)), ((1, 1), (True, True))])
def test_the_view_scrolls_only_along_what_is_stretched(
    desk: Desk, side: tuple[int, int], axes: tuple[bool, bool]
) -> None:
    start = handle(begin(desk, "scale", 2, 3, 4), *side)
    desk.hand.drag(start, beside(start, 20, 20), drop=False)
    tool = desk.view.router.tool
    assert isinstance(tool, ScaleTool)
    assert tool.current is not None
    assert tool.current.scrolls == axes


def test_the_box_is_around_the_keys_that_may_be_edited_and_follows_a_lock(desk: Desk) -> None:
    alone = begin(desk, "scale", 2, 3, 4)
    desk.session.selection = Selection.of({desk.low: [2, 3, 4], desk.high: [1, 5]})
    assert frame_now(desk).box.width() > alone.box.width() + seconds(desk, 1.5)
    desk.document.do("Lock", lambda clip: edits.set_setting(clip, [desk.high], "locked", True))
    assert frame_now(desk).box == alone.box


def test_the_box_leaves_out_a_channel_that_is_hidden_or_gone(desk: Desk) -> None:
    alone = begin(desk, "scale", 2, 3, 4)
    desk.session.selection = both = Selection.of({desk.low: [2, 3, 4], desk.high: [1, 5]})
    wide = frame_now(desk).box
    desk.session.hidden = frozenset({desk.high})
    assert frame_now(desk).box == alone.box
    desk.session.hidden = frozenset()
    desk.session.selection = both
    assert frame_now(desk).box == wide
    channels = tuple(desk.document.clip.channels)
    left = tuple(channel for channel in channels if channel is not desk.high)
    desk.document.do("Remove", lambda clip: [Membership(channels, left)])
    assert frame_now(desk).box == alone.box


def test_the_box_follows_an_edit(desk: Desk) -> None:
    before = begin(desk, "scale", 2, 3, 4)
    desk.document.do("Move", lambda clip: edits.move(clip, desk.session.selection, 0.25, 0.0))
    assert frame_now(desk).box.left() == pytest.approx(before.box.left() + seconds(desk, 0.25))


def test_keys_at_one_time_can_only_be_stretched_in_value(desk: Desk) -> None:
    desk.session.tool = "scale"
    desk.session.selection = Selection.of({desk.low: [3], desk.high: [3]})
    frame = frame_now(desk)
    assert {spot.x() for spot in frame.handles} == {frame.box.center().x()}
    assert len(frame.handles) == 2


def test_neither_ctrl_on_the_ground_nor_a_locked_key_nor_what_lies_near_a_handle_stretches(desk: Desk) -> None:
    frame = begin(desk, "scale", 2, 3, 4)
    start = desk.hand.spot_of(2.5, 1.7)
    desk.hand.drag(start, beside(start, 60, 0), modifiers=CTRL)
    assert not any(edit.label.startswith("Scale") for edit in desk.edits)
    for edit in reversed(desk.edits):
        desk.document.apply(edit.inverse())
    begin(desk, "scale", 2, 3, 4)
    outside = beside(handle(frame, 1, 0), 15, 0)
    desk.hand.drag(outside, beside(outside, 40, 0))
    assert columns(desk) == ([*TIMES], VALUES)
    begin(desk, "scale", 2, 3, 4)
    desk.high.locked = True
    spot = desk.spot(desk.high, 5)
    desk.hand.drag(spot, beside(spot, 40, 40))
    assert columns(desk) == ([*TIMES], VALUES)


def test_an_axis_on_which_the_ground_was_taken_near_the_middle_stays(desk: Desk) -> None:
    frame = begin(desk, "scale", 2, 3, 4)
    start = beside(middle_of(frame), 6, -40)
    desk.hand.drag(start, beside(start, 60, -10))
    assert columns(desk)[0] == TIMES
    assert columns(desk)[1] != VALUES
    frame, values = begin(desk, "scale", 2, 3, 4), columns(desk)[1]
    start = beside(middle_of(frame), 100, -6)
    desk.hand.drag(start, beside(start, 30, -40))
    assert columns(desk)[1] == values
    assert columns(desk)[0] != TIMES


def test_the_tangent_of_a_key_inside_the_box_can_be_turned(desk: Desk) -> None:
    begin(desk, "scale", 2, 3, 4)
    end = desk.view.handle_points(desk.low, 3)[1]
    assert end is not None
    slope = desk.low.key(3).slope_out
    desk.hand.drag(end, beside(end, 0, -25))
    assert columns(desk) == ([*TIMES], VALUES)
    assert desk.low.key(3).slope_out > slope + 0.1


def test_the_box_and_the_place_that_stays_are_drawn_as_the_drag_goes_on(desk: Desk) -> None:
    frame = begin(desk, "scale", 2, 3, 4)
    assert frame.pivot is not None
    assert (frame.pivot.x(), frame.pivot.y()) == pytest.approx(middle_of(frame))
    start = handle(frame, -1, 0)
    desk.hand.drag(start, beside(start, -80), drop=False)
    dragged = desk.view.canvas.overlay.frame
    assert dragged is not None
    assert dragged.box.left() == pytest.approx(frame.box.left() - 80)
    assert dragged.pivot is not None
    assert dragged.pivot.x() == pytest.approx(desk.view.x_from_time(3.0))
    desk.hand.release()


def test_a_corner_tells_both_factors(desk: Desk) -> None:
    start = handle(begin(desk, "scale", 2, 3, 4), 1, -1)
    desk.hand.drag(start, beside(start, seconds(desk, 0.5), desk.view.y_from_value(2.0) - desk.view.y_from_value(0.0)))
    assert desk.edits[0].label == "Scale 3 keys by time ×1.25  value ×1.5"


@pytest.mark.parametrize(
    ("side", "cursor"),
    [
        ((1, -1), Qt.CursorShape.SizeBDiagCursor),
        ((-1, 1), Qt.CursorShape.SizeBDiagCursor),
        ((1, 1), Qt.CursorShape.SizeFDiagCursor),
        ((-1, -1), Qt.CursorShape.SizeFDiagCursor),
        ((1, 0), Qt.CursorShape.SizeHorCursor),
        ((0, -1), Qt.CursorShape.SizeVerCursor),
    ],
)
def test_the_cursor_points_where_a_handle_goes(desk: Desk, side: tuple[int, int], cursor: Qt.CursorShape) -> None:
    spot = handle(begin(desk, "scale", 2, 3, 4), *side)  # 1, -1 is right above
    desk.hand.move(spot)
    assert desk.view.viewport().cursor().shape() == cursor


def test_retime_takes_all_shown_keys_if_only_one_is_selected_but_no_hidden_ones(desk: Desk) -> None:
    desk.session.hidden = {desk.high}
    start = handle(begin(desk, "retime", 3), 1, 0)
    high = desk.high.run().tobytes()
    desk.hand.drag(start, beside(start, -seconds(desk, 2.0)))
    assert columns(desk) == (pytest.approx([0.0, 0.5, 1.0, 1.5, 2.0]), VALUES)
    assert desk.high.run().tobytes() == high


def test_the_brackets_of_retime_stand_beside_the_keys_over_the_whole_height_with_nothing_marked_that_stays(
    desk: Desk,
) -> None:
    frame = begin(desk, "retime", 2, 3, 4)
    assert frame.pivot is None
    assert frame.box.left() == pytest.approx(desk.view.x_from_time(1.0) - PADDING)
    assert frame.box.right() == pytest.approx(desk.view.x_from_time(3.0) + PADDING)
    assert frame.box.height() == pytest.approx(desk.view.plot_rect.height(), abs=6)


@pytest.mark.parametrize(("taken", "times"), [(1.25, [0.0, 0.5, 1.75, 3.0, 4.0]), (2.75, [0.0, 1.0, 1.75, 2.5, 4.0])])
def test_the_ground_between_the_brackets_moves_the_nearer_end(desk: Desk, taken: float, times: list[float]) -> None:
    begin(desk, "retime", 2, 3, 4)
    start = desk.hand.spot_of(taken, 6.0)
    way = (taken - 3.0) * 0.25 if taken < 2.0 else (taken - 1.0) * -0.25
    desk.hand.drag(start, beside(start, seconds(desk, way), -50))
    assert columns(desk) == (pytest.approx(times), VALUES)


def test_retime_has_no_brackets_for_keys_at_one_time(desk: Desk) -> None:
    desk.session.tool = "retime"
    desk.session.selection = Selection.of({desk.low: [3], desk.high: [3]})
    QApplication.processEvents()
    assert desk.view.canvas.overlay.frame is None


def test_retime_counts_no_locked_keys(desk: Desk) -> None:
    desk.high.locked = True
    desk.session.tool = "retime"
    start = handle(frame_now(desk), 1, 0)
    desk.hand.drag(start, beside(start, -seconds(desk, 2.0)))
    assert desk.edits[0].label == "Retime 5 keys by time ×0.5"
