"""Turning tangents by their handles, on a real view."""

import pytest
from PySide6.QtCore import Qt

from model.channel import Channel
from model.keyframe import TangentRule
from tests.widgets.desk import Desk, beside
from tests.widgets.hand import ALT, PLAIN, SHIFT
from widgets.view_range import ViewRange


def handle(desk: Desk, channel: Channel, key_id: int, side: str) -> tuple[float, float]:
    """Where the end of a handle is drawn."""
    end = desk.view.handle_points(channel, key_id)[0 if side == "in" else 1]
    assert end is not None
    return end


def turn(desk: Desk, side: str, time: float, value: float, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
    """Drag a handle of key 3 of "low" so that its end lies at a time and a value."""
    desk.select(desk.low, 3)
    desk.hand.drag(handle(desk, desk.low, 3, side), desk.hand.spot_of(time, value), modifiers=modifiers)


def test_the_slope_is_that_of_the_line_from_the_key_to_the_pointer(desk: Desk) -> None:
    turn(desk, "out", 2.5, 0.0)
    key = desk.low.key(3)
    assert key.slope_out == pytest.approx((0.0 - -2.0) / 0.5, rel=1e-9)
    assert key.rule_out is TangentRule.FIXED
    assert len(desk.edits) == 1
    assert (key.time, key.value) == (2.0, -2.0)


@pytest.mark.parametrize("side", ["in", "out"])
def test_unified_tangents_turn_together(desk: Desk, side: str) -> None:
    turn(desk, side, 2.5 if side == "out" else 1.5, 0.0)
    key = desk.low.key(3)
    assert key.slope_in == key.slope_out == pytest.approx(4.0 if side == "out" else -4.0, rel=1e-9)
    assert (key.rule_in, key.rule_out) == (TangentRule.FIXED, TangentRule.FIXED)


@pytest.mark.parametrize("side", ["in", "out"])
def test_broken_tangents_turn_apart(desk: Desk, side: str) -> None:
    run = desk.low.run_of([3])
    row = run.copy()
    row["broken"] = True
    desk.low.splice(run, row)
    turn(desk, side, 2.5 if side == "out" else 1.5, 0.0)
    key = desk.low.key(3)
    turned, still = (key.slope_out, key.slope_in) if side == "out" else (key.slope_in, key.slope_out)
    rules = (key.rule_out, key.rule_in) if side == "out" else (key.rule_in, key.rule_out)
    assert turned == pytest.approx(4.0 if side == "out" else -4.0, rel=1e-9)
    assert still == 0.0
    assert rules == (TangentRule.FIXED, TangentRule.SMOOTH)


@pytest.mark.parametrize(
    "view", [ViewRange(-1.0, 5.0, -5.0, 15.0), ViewRange(1.0, 3.0, -3.0, 3.0), ViewRange(-40.0, 60.0, -90.0, 70.0)]
)
def test_the_slope_does_not_depend_on_the_zoom(desk: Desk, view: ViewRange) -> None:
    desk.view.set_view(view)
    turn(desk, "out", 2.75, 1.0)
    assert desk.low.key(3).slope_out == pytest.approx(4.0, rel=1e-9)


def test_the_length_of_the_way_does_not_matter_only_its_direction(desk: Desk) -> None:
    turn(desk, "out", 2.25, -1.0)
    near = desk.low.key(3).slope_out
    turn(desk, "out", 2.75, 1.0)
    assert desk.low.key(3).slope_out == pytest.approx(near, rel=1e-9)


def test_a_handle_taken_beside_its_end_does_not_jump(desk: Desk) -> None:
    desk.select(desk.low, 3)
    spot = beside(handle(desk, desk.low, 3, "out"), 3, 5)
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 6, 0))
    assert desk.low.key(3).slope_out == pytest.approx(0.0, abs=1e-9)
    desk.hand.release()


@pytest.mark.parametrize(("side", "sign"), [("out", 1.0), ("in", -1.0)])
def test_a_handle_cannot_cross_the_vertical(desk: Desk, side: str, sign: float) -> None:
    turn(desk, side, 2.0 - 0.5 * sign, 2.0)
    slope = desk.low.key(3).slope_out
    pixel = desk.way(1, 0)[0]
    assert slope == pytest.approx(sign * 4.0 / pixel, rel=1e-6)
    desk.low.check()


def test_shift_takes_the_nearest_of_flat_the_chords_and_what_it_was(desk: Desk) -> None:
    chord = (2.0 - -2.0) / (3.0 - 2.0)
    turn(desk, "out", 2.5, -2.0 + 0.5 * chord * 1.1, SHIFT)
    assert desk.low.key(3).slope_out == chord
    turn(desk, "out", 2.5, -2.0 + 0.01, SHIFT)
    assert desk.low.key(3).slope_out == 0.0


def test_alt_turns_a_tenth_as_fast(desk: Desk) -> None:
    desk.select(desk.low, 3)
    start = handle(desk, desk.low, 3, "out")
    desk.hand.drag(start, beside(start, 0, -40), modifiers=ALT)
    length = start[0] - desk.spot(desk.low, 3)[0]
    d_time, d_value = desk.way(length, -4)
    assert desk.low.key(3).slope_out == pytest.approx(d_value / d_time, rel=1e-6)


def test_a_handle_wins_over_the_curve_it_lies_on_and_leaves_the_selection(desk: Desk) -> None:
    desk.select(desk.low, 1, 3)
    desk.hand.move(handle(desk, desk.low, 3, "in"))
    assert "turn the tangent" in desk.hints[-1]
    start = handle(desk, desk.low, 3, "in")
    desk.hand.drag(start, beside(start, 0, 30))
    assert desk.selected(desk.low) == [1, 3]
    assert desk.low.key(1).rule_out is TangentRule.SMOOTH, "only the taken handle turns"


def test_escape_gives_back_slope_and_rule(desk: Desk) -> None:
    before = desk.keys()
    desk.select(desk.low, 3)
    start = handle(desk, desk.low, 3, "out")
    desk.hand.drag(start, beside(start, 0, 30), drop=False)
    assert desk.keys() != before
    desk.hand.key(Qt.Key.Key_Escape)
    desk.hand.release()
    assert desk.keys() == before
    assert desk.edits == []


def test_coming_back_to_where_it_was_is_no_step_if_the_rule_was_fixed_already(desk: Desk) -> None:
    turn(desk, "out", 2.5, 0.0)
    before = desk.keys()
    start = handle(desk, desk.low, 3, "out")
    desk.hand.drag(start, beside(start, 0, 30), beside(start, 0, 30), drop=False)
    desk.hand.move(start, SHIFT)
    desk.hand.release()
    assert desk.keys() == before
    assert len(desk.edits) == 1
