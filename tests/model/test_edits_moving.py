"""Move, nudge, scale, set a field: order, covering, stopping, rounding, mirrors."""

from itertools import pairwise
from math import inf, nan

import numpy as np
import pytest

from model import edits
from model.change import spliced, unshifted
from model.channel import Channel
from model.clip import Clip
from model.document import Splice
from model.hermite import LARGEST
from model.keyframe import TangentRule, make_run
from model.placing import FEW, strictly_increasing
from model.selection import Selection
from tests.model.editing import channel_of, document_of, ids, select, times, values

FIXED, FLAT, LINEAR, SMOOTH, STEP = (
    TangentRule.FIXED,
    TangentRule.FLAT,
    TangentRule.LINEAR,
    TangentRule.SMOOTH,
    TangentRule.STEP,
)


def moved(channel: Channel, key_ids: list[int], d_time: float, d_value: float = 0.0, *, reorder: bool = True) -> None:
    document = document_of(channel)
    document.do("Move", lambda clip: edits.move(clip, select(channel, *key_ids), d_time, d_value, reorder=reorder))
    channel.check()


def test_keys_go_past_their_neighbours() -> None:
    channel = channel_of([0.0, 1.0, 2.0, 3.0, 4.0])
    moved(channel, [1, 2], 2.5, 10.0)
    assert ids(channel) == [3, 1, 4, 2, 5]
    assert times(channel) == [2.0, 2.5, 3.0, 3.5, 4.0]
    assert values(channel) == [2.0, 10.0, 3.0, 11.0, 4.0]


def test_a_key_that_lands_on_another_but_for_rounding_takes_its_exact_time() -> None:
    channel = Channel("x", make_run([0.1, 0.3, 0.7], 0.0))
    assert 0.1 + 0.2 != 0.3
    moved(channel, [1], 0.2)
    assert times(channel) == [0.3, 0.7]
    assert ids(channel) == [1, 3]


def test_a_move_in_value_never_covers_a_key_however_near() -> None:
    channel = Channel("x", make_run([1.0, np.nextafter(1.0, 2.0)], 0.0))
    moved(channel, [1], 0.0, 1.0)
    assert len(channel) == 2


def test_a_move_in_value_leaves_the_bits_of_times() -> None:
    channel = Channel("x", make_run([-0.0, 1.0], [1.0, -0.0]))
    moved(channel, [1], 0.0, 1.0)
    assert np.signbit(channel.run()["time"][0])
    moved(channel, [2], 1.0, 0.0)
    assert np.signbit(channel.run()["value"][1])


def test_moved_keys_that_rounding_would_put_together_stay_apart() -> None:
    channel = Channel("x", make_run([0.0, 1e-9, 2e-9, 1.0], [1.0, 2.0, 3.0, 4.0]))
    moved(channel, [1, 2, 3], 1e9)
    assert values(channel) == [4.0, 1.0, 2.0, 3.0]
    assert all(a < b for a, b in pairwise(times(channel)))


def test_a_move_beyond_all_numbers_stops_at_the_largest() -> None:
    channel = channel_of([1.0, 2.0, 3.0])
    moved(channel, [2, 3], LARGEST, LARGEST)
    moved(channel, [2, 3], LARGEST, LARGEST)
    assert ids(channel) == [1, 2, 3]
    assert times(channel)[-1] == LARGEST
    assert values(channel)[-1] == LARGEST
    moved(channel, [2, 3], -1.5e308)
    moved(channel, [2, 3], -1.5e308)
    assert ids(channel) == [2, 3, 1]


@pytest.mark.parametrize("number", [nan, inf, -inf])
def test_a_way_that_is_not_finite_is_refused_by_name(number: float) -> None:
    channel = channel_of([1.0, 2.0])
    clip, selection = Clip([channel]), select(channel, 1)
    with pytest.raises(ValueError, match="d_time is"):
        edits.move(clip, selection, number, 0.0)
    with pytest.raises(ValueError, match="d_value is"):
        edits.move(clip, selection, 0.0, number)
    with pytest.raises(ValueError, match="f_value is"):
        edits.scale(clip, selection, 0.0, 0.0, 1.0, number)


def test_without_reordering_the_whole_selection_stops_short_of_the_first_key_in_the_way() -> None:
    channel, other = channel_of([0.0, 1.0, 2.0, 3.0]), channel_of([0.0, 1.0], "root.ty", step=0.5)
    document = document_of(channel, other)
    both = select(channel, 2, 3).union(select(other, 1))
    document.do("Move", lambda clip: edits.move(clip, both, 2.0, 0.0, reorder=False))
    assert ids(other) == [1, 2]
    assert times(other)[0] == pytest.approx(0.5 - 1e-9)
    assert times(channel) == pytest.approx([0.0, 1.5 - 1e-9, 2.5 - 1e-9, 3.0])
    document.do("Back", lambda clip: edits.move(clip, both, -9.0, 0.0, reorder=False))
    assert times(channel) == pytest.approx([0.0, 1e-9, 1.0 + 1e-9, 3.0], abs=1e-15)
    assert times(channel)[1] > 0.0


@pytest.mark.parametrize("gap", [5e-324, 1e-300, 1e-16, 1e-9, 2e-9, 1.0, 1e9, 1e300])
@pytest.mark.parametrize("base", [0.0, 1.0, -1e9, 1e15])
def test_stopping_keeps_keys_apart_at_every_scale(gap: float, base: float) -> None:
    times_before = [base, max(base + gap, float(np.nextafter(base, inf)))]
    times_before.append(times_before[1] + max(gap, 4.0 * float(np.spacing(abs(times_before[1])))))
    for d_time in (-inf, -1.0, 1.0, inf):
        channel = Channel("x", make_run(times_before, 0.0))
        moved(channel, [2], float(np.clip(d_time * gap, -LARGEST, LARGEST)), reorder=False)
        assert ids(channel) == [1, 2, 3]
        assert times(channel)[::2] == times_before[::2]


@pytest.mark.parametrize("d_time", [-0.5, 0.5])
def test_a_neighbour_too_far_away_for_a_double_is_not_in_the_way(d_time: float) -> None:
    channel = Channel("x", make_run([-1.7e308, 1.7e308], 0.0))
    chosen = select(channel, 1 if d_time > 0.0 else 2)
    document_of(channel).do("Move", lambda clip: edits.move(clip, chosen, 1e300 * d_time, 0.0, reorder=False))
    assert sorted(map(abs, times(channel))) == [1.7e308 - 5e299, 1.7e308]


def test_a_key_far_from_where_it_goes_is_moved_without_touching_what_lies_between() -> None:
    channel = Channel("x", make_run(np.arange(10_000.0), np.sin(np.arange(10_000.0))))
    clip = Clip([channel])
    changes = edits.move(clip, select(channel, 100), 9000.5, 0.0)
    assert sum(len(splice.before) + len(splice.after) for splice in spliced(unshifted(changes))) == 2
    for d_time in (9000.5, -9000.5, 9000.0):
        moved(channel, [100], d_time)
    assert len(channel) == 9999


def test_a_scattered_selection_is_moved_in_few_splices_that_leave_the_gaps_alone() -> None:
    channel = Channel("x", make_run(np.arange(20_000.0), np.sin(np.arange(20_000.0))))
    expected = channel.run().copy()
    chosen = [1, 2, 3, 9000, 9001, 19_000]
    expected["time"][np.array(chosen) - 1] += 10.5
    changes = edits.move(Clip([channel]), select(channel, *chosen), 10.5, 0.0)
    assert 1 < len(changes) <= 3
    assert sum(len(change.before) for change in changes if isinstance(change, Splice)) < 6 * FEW
    moved(channel, chosen, 10.5)
    assert times(channel) == sorted(expected["time"].tolist())


@pytest.mark.parametrize("d_time", [-12_000.25, -3000.0, 3000.0, 12_000.25])
def test_keys_that_change_places_between_far_parts_arrive(d_time: float) -> None:
    channel = Channel("x", make_run(np.arange(20_000.0), 0.0))
    chosen = [6001, 9001, 12_001]
    moved(channel, chosen, d_time)
    assert [channel.key(key_id).time for key_id in chosen] == [t + d_time for t in (6000.0, 9000.0, 12_000.0)]
    mirrored = Channel("x", make_run(np.arange(20_000.0), 0.0))
    document = document_of(mirrored)
    document.do("Mirror", lambda clip: edits.scale(clip, select(mirrored, 101, 19_901), 10_000.0, 0.0, -1.0, 1.0))
    mirrored.check()
    assert mirrored.key(101).time == 19_900.0
    assert mirrored.key(19_901).time == 100.0
    assert len(mirrored) == 20_000


def test_locked_channels_stay() -> None:
    locked, free = channel_of([0.0, 1.0], locked=True), channel_of([0.0, 1.0], "root.ty")
    document = document_of(locked, free)
    everything = Selection.of_all([locked, free])
    before = locked.run().tobytes()
    for verb in (
        lambda clip: edits.move(clip, everything, 0.25, 1.0),
        lambda clip: edits.move(clip, everything, 0.25, 1.0, reorder=False),
        lambda clip: edits.nudge(clip, everything, 1.0, 0.5),
        lambda clip: edits.scale(clip, everything, 0.0, 0.0, 2.0, 2.0),
        lambda clip: edits.set_field(clip, everything, "value", lambda v: v + 1.0),
        lambda clip: edits.set_rule(clip, everything, LINEAR),
        lambda clip: edits.set_slope(clip, locked, 1, "in", 3.0),
        lambda clip: edits.break_tangents(clip, everything),
        lambda clip: edits.unify_tangents(clip, everything),
        lambda clip: edits.insert_key(clip, locked, 0.5, 3.0),
        lambda clip: edits.key_all(clip, [locked, free], 0.1),
        lambda clip: edits.duplicate(clip, everything, 7.0),
        lambda clip: edits.delete(clip, everything),
    ):
        document.do("Verb", verb)  # type: ignore[arg-type, misc]
        assert locked.run().tobytes() == before
    assert edits.set_extrapolation(document.clip, [locked], pre=free.pre) == []


def test_a_nudge_is_in_frames_of_the_clip() -> None:
    channel = channel_of([0.0, 1.0])
    document = document_of(channel)
    document.clip.frame_rate = 24.0
    document.do("Nudge", lambda clip: edits.nudge(clip, select(channel, 1), -6.0, 0.5))
    assert times(channel)[0] == -0.25
    assert values(channel)[0] == 0.5


def mixed_channel() -> Channel:
    run = make_run(
        [0.0, 1.0, 1.5, 3.0, 4.0],
        [0.0, 2.0, -1.0, 1.0, 0.5],
        slopes_in=[1.0, 2.0, 3.0, 4.0, -5.0],
        slopes_out=[-1.0, -2.0, 0.5, 4.0, 9.0],
        rules_in=[SMOOTH, FIXED, LINEAR, FIXED, FLAT],
        rules_out=[FIXED, LINEAR, FIXED, SMOOTH, FIXED],
        broken=True,
    )
    return Channel("x", run)


@pytest.mark.parametrize(
    ("f_time", "f_value"), [(2.0, 1.0), (1.0, 3.0), (-1.0, 1.0), (1.0, -1.0), (-0.5, 2.0), (-2.0, -3.0), (1.0, 0.0)]
)
def test_a_scaled_curve_has_the_scaled_shape(f_time: float, f_value: float) -> None:
    channel = mixed_channel()
    inside = np.linspace(0.0, 4.0, 200)
    before = channel.evaluate(inside)
    document = document_of(channel)
    document.do("Scale", lambda clip: edits.scale(clip, Selection.of_all([channel]), 2.0, 1.0, f_time, f_value))
    channel.check()
    after = channel.evaluate(2.0 + (inside - 2.0) * f_time)
    np.testing.assert_allclose(after, 1.0 + (before - 1.0) * f_value, atol=1e-12)


def test_mirroring_twice_gives_back_the_keys() -> None:
    channel = mixed_channel()
    before = channel.run()
    document = document_of(channel)
    for _ in range(2):
        document.do("Mirror", lambda clip: edits.scale(clip, Selection.of_all([channel]), 2.0, 0.0, -1.0, 1.0))
    assert channel.run().tolist() == before.tolist()


def test_a_mirrored_held_span_is_still_held() -> None:
    channel = Channel("x", make_run([0.0, 1.0, 2.0], [0.0, 5.0, 7.0], rules_in=FLAT, rules_out=[FLAT, STEP, FLAT]))
    document = document_of(channel)
    document.do("Mirror", lambda clip: edits.scale(clip, Selection.of_all([channel]), 1.0, 0.0, -1.0, 1.0))
    assert values(channel) == [7.0, 5.0, 0.0]
    assert channel.run()["rule_out"].tolist() == [STEP, FLAT, FLAT]
    assert channel.value(0.9) == 7.0


def test_a_time_factor_of_zero_keeps_the_keys_apart() -> None:
    channel = channel_of([0.0, 1.0, 2.0])
    document = document_of(channel)
    document.do("Scale", lambda clip: edits.scale(clip, Selection.of_all([channel]), 1.0, 0.0, 0.0, 1.0))
    assert ids(channel) == [1, 2, 3]
    assert times(channel) == pytest.approx([1.0, 1.0, 1.0], abs=1e-5)


def test_scaled_keys_cover_what_they_land_on() -> None:
    channel = channel_of([0.0, 1.0, 2.0, 3.0, 4.0])
    document = document_of(channel)
    gesture = document.begin("Scale")
    gesture.preview(lambda clip: edits.scale(clip, select(channel, 1, 2, 3), 0.0, 0.0, 2.0, 1.0))
    assert ids(channel) == [1, 2, 4, 3]
    assert gesture.covered[channel]["id"].tolist() == [5]
    gesture.cancel()


def test_a_field_is_computed_from_the_selected_keys_of_each_channel() -> None:
    channel, other = channel_of([1.0, 2.0, 3.0]), channel_of([5.0], "root.ty")
    document = document_of(channel, other)
    selection = select(channel, 1, 3).union(select(other, 1))
    document.do("Double", lambda clip: edits.set_field(clip, selection, "value", lambda v: v * 2.0))
    assert values(channel) == [2.0, 2.0, 6.0]
    assert values(other) == [10.0]
    document.do("By time", lambda clip: edits.set_columns(clip, selection, "value", lambda c, keys: keys["time"] + 0.5))
    assert values(channel) == [0.5, 2.0, 2.5]
    document.do("Constant", lambda clip: edits.set_field(clip, selection, "time", lambda t: t - 3.0))
    assert ids(channel) == [1, 3, 2]


def test_two_keys_cannot_be_given_one_time() -> None:
    channel = channel_of([1.0, 2.0, 3.0])
    clip = Clip([channel])
    with pytest.raises(ValueError, match=r"two keys of root.tx would be at 0.5 s"):
        edits.set_field(clip, select(channel, 1, 2), "time", lambda t: 0.5)
    assert len(edits.set_field(clip, select(channel, 1), "time", lambda t: 0.5)) == 1


def test_a_field_that_would_not_be_finite_is_refused() -> None:
    channel = channel_of([1.0, 2.0, 3.0])
    clip = Clip([channel])
    for field in ("time", "value", "slope_in", "slope_out"):
        with pytest.raises(ValueError, match=f"{field} of a key of root.tx would be inf"):
            edits.set_field(clip, select(channel, 1, 2), field, lambda v: v + inf)
    with pytest.raises(ValueError, match="'id' is no number of a key"):
        edits.set_field(clip, select(channel, 1), "id", lambda v: 1.0)


def test_increasing_times_never_fall_back() -> None:
    for column in (
        [0.0, 0.0, 0.0],
        [-0.0, 0.0, 5e-324],
        [-5e-324, -5e-324, 0.0, 0.0],
        [1.0, 1.0, np.nextafter(1.0, 2.0), 2.0],
        [LARGEST, LARGEST, LARGEST],
        [-LARGEST, -LARGEST],
        [1e300, LARGEST, LARGEST],
    ):
        result = strictly_increasing(np.array(column))
        assert np.isfinite(result).all()
        assert (np.diff(result) > 0.0).all()
        np.testing.assert_allclose(result, column, rtol=1e-12, atol=1e-300)
