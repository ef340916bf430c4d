"""Scaling and retiming selected keys with the mouse, on a real view."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication

from model.keyframe import Run, TangentRule
from model.selection import Selection
from tests.widgets.desk import Desk, beside
from tests.widgets.hand import SHIFT
from widgets.graph import Frame
from widgets.tools import TOOLS


def begin(desk: Desk, tool: str, *ids: int) -> Frame:
    """Choose a tool and keys of "low", and return the box around them."""
    desk.select(desk.low, *ids)
    desk.session.tool = tool
    QApplication.processEvents()
    frame = desk.view.canvas.overlay.frame
    assert frame is not None
    return frame


def handle(frame: Frame, x: int, y: int) -> tuple[float, float]:
    """A handle of the box by its side: -1 left or top, 0 middle, 1 right or bottom."""
    box = frame.box
    spot = (box.center().x() + x * box.width() / 2, box.center().y() + y * box.height() / 2)
    assert any(abs(each.x() - spot[0]) + abs(each.y() - spot[1]) < 1e-6 for each in frame.handles)
    return spot


def columns(desk: Desk) -> tuple[list[float], list[float]]:
    run = desk.low.run()
    return run["time"].tolist(), run["value"].tolist()


def test_the_right_edge_stretches_time_about_the_left_one(desk: Desk) -> None:
    frame = begin(desk, "scale", 2, 3, 4)
    start = handle(frame, 1, 0)
    desk.hand.drag(start, beside(start, desk.view.x_from_time(1.0) - desk.view.x_from_time(0.5), 30))
    times, values = columns(desk)
    assert times == pytest.approx([0.0, 1.0, 2.25, 3.5, 4.0])
    assert values == [0.0, 2.0, -2.0, 2.0, 0.0]
    assert len(desk.edits) == 1
    assert desk.edits[0].label == "Scale 3 keys by time ×1.25"


def test_a_corner_stretches_both_about_the_opposite_corner(desk: Desk) -> None:
    frame = begin(desk, "scale", 2, 3, 4)
    start = handle(frame, 1, -1)
    way = desk.hand.spot_of(0.5, 2.0)[0] - desk.hand.spot_of(0.0, 0.0)[0], -40.0
    desk.hand.drag(start, beside(start, *way))
    d_value = desk.way(0, -40)[1]
    times, values = columns(desk)
    assert times == pytest.approx([0.0, 1.0, 2.25, 3.5, 4.0])
    assert values == pytest.approx([0.0, 2.0 + d_value, -2.0, 2.0 + d_value, 0.0])


def test_shift_keeps_a_corner_to_one_axis(desk: Desk) -> None:
    frame = begin(desk, "scale", 2, 3, 4)
    start = handle(frame, 1, -1)
    desk.hand.drag(start, beside(start, 10, -40), modifiers=SHIFT)
    assert columns(desk)[0] == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert columns(desk)[1] != [0.0, 2.0, -2.0, 2.0, 0.0]


def test_dragging_an_edge_across_the_other_mirrors(desk: Desk) -> None:
    desk.low.splice(desk.low.run_of([3]), with_value(desk, 3, -1.0))
    frame = begin(desk, "scale", 3, 4)
    start = handle(frame, 0, -1)
    desk.hand.drag(start, beside(start, 0, desk.view.y_from_value(0.0) - desk.view.y_from_value(6.0)))
    assert columns(desk)[1] == pytest.approx([0.0, 2.0, -1.0, -4.0, 0.0])


def with_value(desk: Desk, key_id: int, value: float) -> Run:
    run = desk.low.run_of([key_id]).copy()
    run["value"] = value
    return run


def test_the_edge_lands_on_a_frame_if_snapping_is_on(desk: Desk) -> None:
    desk.session.snap = True
    frame = begin(desk, "scale", 2, 3)
    start = handle(frame, 1, 0)
    desk.hand.drag(start, beside(start, desk.view.x_from_time(0.47) - desk.view.x_from_time(0.0)))
    assert columns(desk)[0][2] == pytest.approx(2.5)


def test_a_selected_key_is_stretched_about_the_middle(desk: Desk) -> None:
    begin(desk, "scale", 2, 3, 4)
    spot = desk.spot(desk.low, 4)
    desk.hand.drag(spot, beside(spot, desk.view.x_from_time(0.5) - desk.view.x_from_time(0.0)))
    assert columns(desk)[0] == pytest.approx([0.0, 0.5, 2.0, 3.5, 4.0])


def test_keys_squeezed_to_nothing_stay_apart(desk: Desk) -> None:
    frame = begin(desk, "scale", 1, 2, 3, 4, 5)
    start = handle(frame, 1, 0)
    left = handle(frame, -1, 0)[0] + 24.0
    desk.hand.press(start)
    for x in (start[0] - 100, left + 1, left, left - 1):
        desk.hand.move((x, start[1]))
        desk.low.check()
        assert len(desk.low) == 5
    desk.hand.release()


def test_the_box_follows_selection_view_and_edits(desk: Desk) -> None:
    frame = begin(desk, "scale", 2, 3)
    desk.select(desk.low, 2, 3, 4)
    QApplication.processEvents()
    wider = desk.view.canvas.overlay.frame
    assert wider is not None
    assert wider.box.right() > frame.box.right()
    desk.view.pan_pixels(50, 0)
    QApplication.processEvents()
    moved = desk.view.canvas.overlay.frame
    assert moved is not None
    assert moved.box.left() == pytest.approx(wider.box.left() + 50)
    desk.session.tool = "select"
    assert desk.view.canvas.overlay.frame is None


def test_one_key_or_none_has_no_box(desk: Desk) -> None:
    desk.select(desk.low, 2)
    desk.session.tool = "scale"
    QApplication.processEvents()
    assert desk.view.canvas.overlay.frame is None
    desk.hand.drag(desk.hand.spot_of(0.5, 5.0), desk.hand.spot_of(2.5, -3.0))
    assert desk.selected(desk.low) == [2, 3]


def test_level_keys_can_only_be_stretched_in_time(desk: Desk) -> None:
    frame = begin(desk, "scale", 2, 4)
    assert len(frame.handles) == 2


def test_a_click_inside_the_box_still_chooses(desk: Desk) -> None:
    begin(desk, "scale", 1, 2, 3, 4, 5)
    desk.hand.click(desk.spot(desk.low, 3))
    assert desk.selected(desk.low) == [3]
    begin(desk, "scale", 1, 2, 3, 4, 5)
    desk.hand.click(desk.hand.spot_of(2.0, 0.5))
    assert not desk.session.selection


def test_the_ground_inside_the_box_stretches_about_the_middle_and_outside_it_boxes(desk: Desk) -> None:
    begin(desk, "scale", 2, 3, 4)
    start = desk.hand.spot_of(2.5, 1.7)
    desk.hand.drag(start, beside(start, desk.view.x_from_time(0.25) - desk.view.x_from_time(0.0)), modifiers=SHIFT)
    assert columns(desk)[0] == pytest.approx([0.0, 0.5, 2.0, 3.5, 4.0])
    before = desk.keys()
    desk.hand.drag(desk.hand.spot_of(-0.5, 14.0), desk.hand.spot_of(0.2, 9.0))
    assert desk.keys() == before
    assert desk.selected(desk.high) == [1]


def test_a_click_on_a_curve_inside_the_box_makes_it_active(desk: Desk) -> None:
    begin(desk, "scale", 1, 2, 3, 4, 5)
    desk.session.active = desk.high
    desk.hand.click(desk.hand.spot_of(1.5, desk.low.value(1.5)))
    assert desk.session.active is desk.low


@pytest.mark.parametrize("tool", ["scale", "retime"])
def test_escape_gives_everything_back(desk: Desk, tool: str) -> None:
    before = desk.keys()
    frame = begin(desk, tool, 2, 3, 4)
    chosen = desk.session.selection
    start = handle(frame, 1, 0)
    desk.hand.drag(start, beside(start, 60), drop=False)
    assert desk.keys() != before
    desk.hand.key(Qt.Key.Key_Escape)
    desk.hand.release()
    assert desk.keys() == before
    assert desk.session.selection == chosen
    assert desk.edits == []
    QApplication.processEvents()
    assert desk.view.canvas.overlay.frame == frame


def test_fixed_slopes_keep_the_shape_when_time_is_stretched(desk: Desk) -> None:
    rows = desk.low.run().copy()
    rows["rule_in"] = rows["rule_out"] = TangentRule.FIXED
    rows["slope_in"] = rows["slope_out"] = 3.0
    desk.low.splice(desk.low.run(), rows)
    frame = begin(desk, "retime", 1, 2, 3, 4, 5)
    before = [desk.low.value(t) for t in (0.3, 1.7, 2.2, 3.9)]
    start = handle(frame, 1, 0)
    desk.hand.drag(start, beside(start, desk.view.x_from_time(2.0) - desk.view.x_from_time(0.0)))
    assert [desk.low.value(1.5 * t) for t in (0.3, 1.7, 2.2, 3.9)] == pytest.approx(before)


def test_retime_stretches_the_selected_keys_about_the_other_end(desk: Desk) -> None:
    begin(desk, "retime", 2, 3, 4)
    spot = desk.spot(desk.low, 2)
    desk.hand.drag(spot, beside(spot, desk.view.x_from_time(-0.5) - desk.view.x_from_time(0.0), 55))
    times, values = columns(desk)
    assert times == pytest.approx([0.0, 0.5, 1.75, 3.0, 4.0])
    assert values == [0.0, 2.0, -2.0, 2.0, 0.0]
    assert desk.edits[0].label == "Retime 3 keys by time ×1.25"


def test_retime_takes_all_shown_keys_if_none_are_selected(desk: Desk) -> None:
    desk.session.tool = "retime"
    QApplication.processEvents()
    frame = desk.view.canvas.overlay.frame
    assert frame is not None
    start = handle(frame, 1, 0)
    desk.hand.drag(start, beside(start, desk.view.x_from_time(-2.0) - desk.view.x_from_time(0.0)))
    for channel in (desk.low, desk.high):
        assert channel.run()["time"].tolist() == pytest.approx([0.0, 0.5, 1.0, 1.5, 2.0])
    assert not desk.session.selection
    desk.low.locked = True
    before = desk.low.run().tobytes()
    QApplication.processEvents()
    frame = desk.view.canvas.overlay.frame
    assert frame is not None
    start = handle(frame, 1, 0)
    desk.hand.drag(start, beside(start, 100))
    assert desk.low.run().tobytes() == before


def test_retime_never_turns_the_order_round(desk: Desk) -> None:
    frame = begin(desk, "retime", 1, 2, 3, 4, 5)
    start = handle(frame, 1, 0)
    desk.hand.drag(start, beside(start, -700))
    assert [key.id for key in desk.low] == [1, 2, 3, 4, 5]
    assert 0.0 < desk.low.key(5).time < 0.1


def hint_at(desk: Desk, spot: tuple[float, float]) -> str:
    desk.hand.move(beside(spot, 40, 200))
    desk.hand.move(spot)
    return desk.hints[-1]


def test_the_scale_tool_says_what_a_drag_does_here(desk: Desk) -> None:
    frame = begin(desk, "scale", 2, 3, 4)
    assert hint_at(desk, handle(frame, 1, 0)).startswith("Scale · Drag: scale 3 keys about the edge across")
    assert hint_at(desk, handle(frame, 1, -1)).startswith("Scale · Drag: scale 3 keys about the corner across")
    assert hint_at(desk, desk.spot(desk.low, 2)).startswith("Scale · Drag: scale 3 keys about the middle")
    assert hint_at(desk, desk.hand.spot_of(2.5, 1.7)).startswith("Scale · Drag: scale 3 keys about the middle")
    assert hint_at(desk, desk.spot(desk.high, 2)).startswith("Scale · Drag: move 1 key")
    assert hint_at(desk, desk.hand.spot_of(-0.5, 5.0)).startswith("Scale · Drag: select with a box")
    desk.session.selection = Selection.NONE
    assert hint_at(desk, desk.hand.spot_of(-0.5, 5.0)).startswith("Scale (select two keys or more) · Drag: select")


def test_the_retime_tool_says_how_many_keys_it_takes_and_which_edge_stays(desk: Desk) -> None:
    frame = begin(desk, "retime", 2, 3, 4)
    three = "Retime · Drag: stretch 3 keys in time from the far edge, the"
    assert hint_at(desk, handle(frame, 1, 0)).startswith(f"{three} left one")
    assert hint_at(desk, handle(frame, -1, 0)).startswith(f"{three} right one")
    assert hint_at(desk, desk.spot(desk.low, 4)).startswith(f"{three} left one")
    assert hint_at(desk, desk.hand.spot_of(1.5, 6.0)).startswith(f"{three} right one")
    desk.session.selection = Selection.NONE
    all_keys = "Retime · Drag: stretch all 10 keys in time from the far edge, the"
    assert hint_at(desk, desk.hand.spot_of(2.2, 6.0)).startswith(f"{all_keys} left one")
    assert hint_at(desk, desk.hand.spot_of(1.8, 6.0)).startswith(f"{all_keys} right one")
    desk.low.locked = True
    assert "all 5 keys" in hint_at(desk, desk.hand.spot_of(2.2, 6.0))


def test_every_tool_of_the_table_can_be_chosen_and_says_what_it_does(desk: Desk) -> None:
    desk.session.selection = Selection.of_all([desk.low])
    for name, row in TOOLS.items():
        desk.session.tool = name
        assert desk.view.router.tool is desk.view.router.tool
        desk.hand.move(desk.spot(desk.low, 2))
        assert "Drag: " in desk.hints[-1]
        assert row.label
        assert row.tip
        assert row.shortcut
