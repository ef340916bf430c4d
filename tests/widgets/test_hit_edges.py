"""How far what lies under the pointer reaches, and that nothing is remembered of what was there before."""

import numpy as np
import pytest

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.keyframe import TangentRule, make_run
from model.selection import Selection
from tests.widgets.desk import Desk
from tests.widgets.fake_graph import HANDLE, FakeGraph
from widgets.hit_test import RADIUS, hit, hit_all, hit_ruler


def graph_of(*channels: Channel, **clip: float) -> FakeGraph:
    return FakeGraph(Document(Clip(channels, **clip)))  # type: ignore[arg-type]


@pytest.fixture
def line() -> Channel:
    """Keys at (2, 2), (4, 2), (6, 2): at x 250, 450, 650 and y 730."""
    return Channel("line", make_run([2.0, 4.0, 6.0], 2.0))


def test_a_handle_is_hit_within_eight_pixels_as_a_key_is(line: Channel) -> None:
    graph = graph_of(line)
    graph.document.session.selection = Selection.of_key(line, 2)
    assert hit(graph, 450 + HANDLE, 730 - 7.5).kind == "handle_out"
    assert hit(graph, 450 + HANDLE, 730 - 8.5).kind == "empty"


def test_the_handles_of_another_key_of_the_channel_are_hit_as_soon_as_it_is_selected(line: Channel) -> None:
    graph = graph_of(line)
    for key_id, x in ((2, 450), (1, 250), (2, 450)):
        graph.document.session.selection = Selection.of_key(line, key_id)
        assert hit(graph, x + HANDLE, 730).kind == "handle_out"
        assert hit(graph, 700 - x + HANDLE, 730).kind == "curve"


def test_a_handle_is_hit_where_it_has_been_turned_to(line: Channel) -> None:
    graph = graph_of(line)
    graph.document.session.selection = Selection.of_key(line, 2)
    assert hit(graph, 450 + HANDLE, 730).kind == "handle_out"
    graph.document.do("Turn", lambda clip: edits.set_slope(clip, line, 2, "out", 1.0))
    away = HANDLE / np.sqrt(2.0)
    assert hit(graph, 450 + away, 730 - away).kind == "handle_out"
    assert hit(graph, 450 + HANDLE, 730).kind != "handle_out"


def test_what_can_be_taken_comes_before_what_is_locked_even_if_that_is_a_key() -> None:
    locked, free = Channel("locked", make_run([2.0], 2.0), locked=True), Channel("free", make_run([1.0, 9.0], 2.0))
    graph = graph_of(locked, free)
    assert [(found.kind, found.channel) for found in hit_all(graph, 250, 730)] == [
        ("curve", free),
        ("key", locked),
        ("curve", locked),
    ]


def test_all_of_a_dozen_keys_that_overlap_are_stepped_through() -> None:
    channels = [Channel(f"c{i}", make_run([2.0], 2.0)) for i in range(12)]
    graph = graph_of(*channels)
    assert {hit(graph, 250, 730, cycle).channel for cycle in range(12)} == set(channels)


def test_a_curve_is_hit_just_before_its_first_and_just_behind_its_last_key(line: Channel) -> None:
    graph = graph_of(line)
    for x in (250 - 20, 250 - 40, 650 + 20, 650 + 40):
        assert hit(graph, x, 730 + 5).kind == "curve"
        assert hit(graph, x, 730 + 9).kind == "empty"


def test_a_tip_reaches_no_further_than_a_key() -> None:
    linear = TangentRule.LINEAR
    tip = Channel("tip", make_run([2.0, 2.2, 2.4], [0.0, 5.0, 0.0], rules_in=linear, rules_out=linear))
    graph = graph_of(tip)
    assert hit(graph, 270, 430 - 7).kind == "key"
    assert hit(graph, 270, 430 - 12).kind == "empty"


def test_a_narrow_bend_is_hit_where_it_is() -> None:
    fixed = TangentRule.FIXED
    bent = Channel("bent", make_run([2.0, 2.4], 2.0, [0.0, -4.0], [4.0, 0.0], fixed, fixed, True))
    graph = graph_of(bent)
    assert bent.value(2.2) == pytest.approx(2.4)
    found = hit(graph, 270, 690 - 4)
    assert found.kind == "curve"
    assert found.distance == pytest.approx(4.0, abs=0.3)


def test_there_is_nothing_between_the_last_key_of_a_channel_and_the_first_of_the_next() -> None:
    graph = graph_of(Channel("low", make_run([2.0, 3.0], 2.0)), Channel("high", make_run([5.0, 6.0], 6.0)))
    assert [hit(graph, 50 + 100 * time, 930 - 100 * time).kind for time in (3.5, 4.0, 4.5)] == ["empty"] * 3


def test_a_channel_shown_in_the_place_of_another_is_hit_and_that_one_no_longer() -> None:
    low, high = Channel("low", make_run([2.0], 2.0)), Channel("high", make_run([2.0], 6.0))
    graph = graph_of(low, high)
    for hidden, y in ((high, 730), (low, 330), (high, 730)):
        graph.document.session.hidden = {hidden}
        assert hit(graph, 250, y).kind == "key"
        assert hit(graph, 250, 1060 - y).kind == "empty"


def test_the_handles_of_a_channel_that_is_locked_can_no_longer_be_hit(desk: Desk) -> None:
    desk.select(desk.low, 3)
    end = desk.view.handle_points(desk.low, 3)[1]
    assert end is not None
    assert hit(desk.view, *end).kind == "handle_out"
    desk.document.do("Lock", lambda clip: edits.set_setting(clip, [desk.low], "locked", True))
    assert hit(desk.view, *end).kind != "handle_out"


def test_the_playhead_and_the_ends_of_the_range_are_hit_within_eight_pixels(line: Channel) -> None:
    graph = graph_of(line, start=2.0, end=8.0)
    graph.document.session.playhead = 5.0
    for x, kind in ((550, "playhead"), (250, "range_start"), (850, "range_end")):
        for away, found in ((RADIUS - 0.5, kind), (RADIUS + 0.5, "time_ruler")):
            assert hit_ruler(graph, x + away, 10).kind == found
            assert hit_ruler(graph, x - away, 10).kind == found


def test_an_end_of_the_range_under_the_playhead_is_taken_from_outside_and_the_playhead_from_inside(
    line: Channel,
) -> None:
    graph = graph_of(line, start=2.0, end=8.0)
    for time, kind, outwards in ((2.0, "range_start", -1), (8.0, "range_end", 1)):
        graph.document.session.playhead = time
        x = float(graph.x_from_time(time))
        assert hit_ruler(graph, x + 4 * outwards, 10).kind == kind
        assert hit_ruler(graph, x - 4 * outwards, 10).kind == "playhead"


def test_of_keys_too_many_for_a_pixel_the_curve_is_hit_and_none_of_them() -> None:
    times = np.linspace(2.0, 2.02, 200_001)
    graph = graph_of(Channel("many", make_run(times, np.where(np.arange(200_001) % 2, 1.0, 2.0))))
    x = float(graph.x_from_time(2.01))
    assert hit(graph, x, float(graph.y_from_value(1.5))).kind == "curve"
    assert hit(graph, x, float(graph.y_from_value(2.0))).kind == "curve"
    assert hit(graph, x, float(graph.y_from_value(2.5))).kind == "empty"
    assert hit(graph, x + 40.0, float(graph.y_from_value(2.0))).kind in ("curve", "empty")
