"""What lies under the pointer, on a plot whose pixels are easy to count: 100 px a second and 100 px a unit of value."""

import numpy as np
import pytest

from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule, make_run
from model.selection import Selection
from tests.widgets.fake_graph import FakeGraph
from widgets.hit_test import Place, hit, hit_all, hit_ruler, place


def graph_of(*channels: Channel, **clip: float) -> FakeGraph:
    return FakeGraph(Document(Clip(channels, **clip)))  # type: ignore[arg-type]


def kinds(graph: FakeGraph, x: float, y: float) -> list[str]:
    return [found.kind for found in hit_all(graph, x, y)]


@pytest.fixture
def line() -> Channel:
    """Keys at (2, 2), (4, 2), (6, 2): at x 250, 450, 650 and y 730."""
    return Channel("line", make_run([2.0, 4.0, 6.0], 2.0))


def test_a_key_within_eight_pixels_is_hit_and_the_one_beyond_is_not(line: Channel) -> None:
    graph = graph_of(line)
    assert hit(graph, 450 + 7.9, 730).kind == "key"
    assert hit(graph, 450 + 8.1, 730).kind == "curve"
    assert hit(graph, 450 + 6, 730 + 6).kind == "curve"
    found = hit(graph, 452, 731)
    assert (found.channel, found.id, found.time, found.value) == (line, 2, 4.0, 2.0)


def test_nothing_within_reach_is_empty_ground_at_the_pointer(line: Channel) -> None:
    found = hit(graph_of(line), 150, 430)
    assert (found.kind, found.channel) == ("empty", None)
    assert (found.time, found.value) == (1.0, 5.0)


def test_keys_come_before_handles_and_handles_before_curves(line: Channel) -> None:
    graph = graph_of(line)
    graph.document.session.selection = Selection.of_key(line, 2)
    assert kinds(graph, 450, 730) == ["key", "curve"]
    assert kinds(graph, 450 + 60, 730) == ["handle_out", "curve"]
    assert kinds(graph, 450 - 60, 730) == ["handle_in", "curve"]
    assert hit(graph, 450 - 60, 730).id == 2


def test_only_selected_keys_have_handles(line: Channel) -> None:
    graph = graph_of(line)
    assert kinds(graph, 450 + 60, 730) == ["curve"]
    graph.document.session.selection = Selection.of_key(line, 2)
    assert "handle_out" in kinds(graph, 450 + 60, 730)
    graph.document.session.selection = Selection.NONE
    assert kinds(graph, 450 + 60, 730) == ["curve"]


def test_of_two_keys_that_lie_on_each_other_the_selected_one_is_hit() -> None:
    below, above = Channel("below", make_run([2.0], 2.0)), Channel("above", make_run([2.0], 2.0))
    graph = graph_of(below, above)
    for chosen in (below, above):
        graph.document.session.selection = Selection.of_key(chosen, 1)
        assert hit(graph, 251, 731).channel is chosen


def test_a_key_under_the_very_pointer_wins_over_a_selected_one_at_the_rim() -> None:
    channel = Channel("c", make_run([2.0, 2.06], 2.0))
    graph = graph_of(channel)
    graph.document.session.selection = Selection.of_key(channel, 2)
    assert hit(graph, 250, 730).id == 1
    assert hit(graph, 252, 730).id == 2


def test_a_cycle_steps_through_what_overlaps_of_the_same_kind() -> None:
    channels = [Channel(name, make_run([2.0], 2.0)) for name in "abc"]
    graph = graph_of(*channels)
    assert {hit(graph, 250, 730, cycle).channel for cycle in range(3)} == set(channels)
    assert hit(graph, 250, 730, 3) == hit(graph, 250, 730, 0)


def test_a_steep_span_is_hit_by_its_true_distance() -> None:
    steep = Channel(
        "steep", make_run([2.0, 2.02], [0.0, 9.0], rules_in=TangentRule.LINEAR, rules_out=TangentRule.LINEAR)
    )
    graph = graph_of(steep)
    middle = hit(graph, 251 + 5, 480)
    assert (middle.kind, middle.channel) == ("curve", steep)
    assert middle.distance == pytest.approx(5.0, abs=0.05)
    assert hit(graph, 251 + 9, 480).kind == "empty"


def test_the_riser_of_a_held_span_can_be_hit() -> None:
    held = Channel("held", make_run([2.0, 4.0, 6.0], [1.0, 5.0, 5.0], rules_out=TangentRule.STEP))
    graph = graph_of(held)
    assert hit(graph, 453, 630).kind == "curve"
    assert hit(graph, 350, 830).kind == "curve"
    assert hit(graph, 350, 630).kind == "empty"


def test_the_curve_beyond_its_keys_can_be_hit_as_it_is_drawn(line: Channel) -> None:
    for mode, value in ((Extrapolation.CONSTANT, 5.0), (Extrapolation.LINEAR, 7.0), (Extrapolation.CYCLE, 4.0)):
        ramp = Channel(
            "ramp",
            make_run([2.0, 4.0], [3.0, 5.0], rules_in=TangentRule.LINEAR, rules_out=TangentRule.LINEAR),
            post=mode,
        )
        graph = graph_of(ramp)
        time = 6.0 if mode is not Extrapolation.CYCLE else 5.0
        found = hit(graph, graph.x_from_time(time) + 3.0, graph.y_from_value(value))
        assert found.kind == "curve", mode


def test_the_nearest_point_of_a_curve_is_what_is_reported(line: Channel) -> None:
    found = hit(graph_of(line), 350, 735)
    assert (found.time, found.value, found.distance) == pytest.approx((3.0, 2.0, 5.0))


def test_one_of_two_crossing_curves_is_preferred_if_it_is_active() -> None:
    up = Channel("up", make_run([2.0, 6.0], [2.0, 6.0]))
    down = Channel("down", make_run([2.0, 6.0], [6.0, 2.0]))
    graph = graph_of(up, down)
    for active in (up, down):
        graph.document.session.active = active
        assert hit(graph, 450, 530).channel is active


def test_hidden_channels_are_not_hit(line: Channel) -> None:
    graph = graph_of(line)
    graph.document.session.hidden = {line}
    assert hit(graph, 450, 730).kind == "empty"
    graph.document.session.hidden = set()
    assert hit(graph, 450, 730).kind == "key"


def test_a_locked_key_covers_nothing_that_can_be_taken(line: Channel) -> None:
    locked = Channel("locked", make_run([4.0], 2.0), locked=True)
    graph = graph_of(locked, line)
    assert hit(graph, 450, 730).channel is line
    assert hit(graph_of(locked), 450, 730).channel is locked


def test_an_edit_is_seen_by_the_next_hit(line: Channel) -> None:
    graph = graph_of(line)
    assert hit(graph, 450, 730).kind == "key"
    run = line.run_of([2])
    moved = run.copy()
    moved["value"] = 5.0
    line.splice(run, moved)
    assert hit(graph, 450, 730).kind == "empty"
    assert hit(graph, 450, 430).id == 2


def test_hits_after_edits_of_some_of_many_channels_are_those_of_a_new_view() -> None:
    rng = np.random.default_rng(5)
    channels = [Channel(f"c{i}", make_run(np.arange(9.0), rng.uniform(0, 8, 9))) for i in range(20)]
    graph = graph_of(*channels)
    for step in range(30):
        for channel in rng.choice(np.array(channels, object), rng.integers(1, 12)):
            run = channel.keys_between(float(rng.integers(1, 8)), 8.0)[:1]
            moved = run.copy()
            moved["value"] = rng.uniform(0, 8)
            channel.splice(run, moved)
        x, y = rng.uniform((60, 60), (800, 800)).tolist()
        found, anew = hit_all(graph, x, y), hit_all(graph_of(*channels), x, y)
        assert sorted(found, key=str) == sorted(anew, key=str), f"step {step}"


def test_a_change_of_extrapolation_is_seen_by_the_next_hit() -> None:
    ramp = Channel("ramp", make_run([2.0, 4.0], [3.0, 5.0], rules_in=TangentRule.LINEAR, rules_out=TangentRule.LINEAR))
    graph = graph_of(ramp)
    assert hit(graph, 650, 430).kind == "curve"
    ramp.set_extrapolation(Extrapolation.CONSTANT, Extrapolation.LINEAR)
    assert hit(graph, 650, 430).kind == "empty"
    assert hit(graph, 650, 230).kind == "curve"


def test_a_view_that_moved_is_seen_by_the_next_hit(line: Channel) -> None:
    graph = graph_of(line)
    assert hit(graph, 450, 730).kind == "key"
    graph.pan_pixels(100.0, 0.0)
    assert hit(graph, 450, 730).kind == "curve"
    assert hit(graph, 550, 730).id == 2
    graph.pan_pixels(0.0, -100.0)
    assert hit(graph, 550, 730).kind == "empty"
    assert hit(graph, 550, 630).id == 2


def test_handles_follow_the_view_and_the_key(line: Channel) -> None:
    graph = graph_of(line)
    graph.document.session.selection = Selection.of_key(line, 2)
    assert hit(graph, 510, 730).kind == "handle_out"
    graph.pan_pixels(0.0, -100.0)
    assert hit(graph, 510, 730).kind == "empty"
    assert hit(graph, 510, 630).kind == "handle_out"


def test_keys_at_the_seam_of_two_strips_are_found_from_both_sides(line: Channel) -> None:
    channel = Channel("seam", make_run(np.arange(0.0, 16.0, 0.32), 2.0))
    graph = graph_of(channel)
    for x in np.arange(60.5, 1600.0):
        nearest = min(abs(x - 50 - key * 32.0) for key in range(50))
        assert (hit(graph, float(x), 730.0).kind == "key") == (nearest <= 8.0), x


def test_a_hit_equals_a_walk_over_every_key() -> None:
    rng = np.random.default_rng(3)
    channels = [
        Channel(f"c{i}", make_run(np.unique(rng.uniform(0, 16, 400)), rng.uniform(0, 9, 400))) for i in range(20)
    ]
    graph = graph_of(*channels)
    for x, y in rng.uniform((50, 30), (1650, 930), (200, 2)):
        away = [
            (float(np.hypot(graph.x_from_time(run["time"]) - x, graph.y_from_value(run["value"]) - y).min()), channel)
            for channel in channels
            for run in (channel.run(),)
        ]
        nearest, channel = min(away, key=lambda pair: pair[0])
        found = hit(graph, float(x), float(y))
        assert (found.kind == "key") == (nearest <= 8.0)
        if nearest <= 8.0:
            assert found.channel is channel
            assert found.distance == pytest.approx(nearest)


def test_a_selected_key_is_found_among_thousands_at_the_same_pixel() -> None:
    channel = Channel("dense", make_run(np.linspace(1.99, 2.01, 5001), 2.0))
    graph = graph_of(channel)
    graph.document.session.selection = Selection.of_key(channel, 17)
    assert hit(graph, 250, 730).id == 17


def test_rulers_lie_around_the_plot(line: Channel) -> None:
    graph = graph_of(line)
    assert place(graph, 500, 500) is Place.PLOT
    assert place(graph, 500, 10) is Place.TIME_RULER
    assert place(graph, 500, 940) is Place.TIME_RULER
    assert place(graph, 10, 500) is Place.VALUE_RULER
    assert place(graph, 10, 10) is Place.CORNER


def test_the_ends_of_the_range_can_be_taken_even_under_the_playhead(line: Channel) -> None:
    graph = graph_of(line, start=2.0, end=6.0)
    graph.document.session.playhead = 2.0
    assert hit_ruler(graph, 250, 15).kind == "playhead"
    assert hit_ruler(graph, 255, 15).kind == "playhead"
    assert hit_ruler(graph, 246, 15).kind == "range_start"
    assert hit_ruler(graph, 652, 15).kind == "range_end"
    assert hit_ruler(graph, 400, 15).kind == "time_ruler"
