"""Insert, delete, key all: the curve keeps its shape, and only what has to be fixed is."""

from math import nan

import numpy as np
import pytest

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.document import added_keys
from model.extrapolation import EXTRAPOLATIONS, Extrapolation
from model.keyframe import TangentRule, make_run
from model.tangents import TANGENT_RULES
from tests.model.editing import channel_of, document_of, ids, select, times, values

FIXED, FLAT, LINEAR, SMOOTH, STEP = (
    TangentRule.FIXED,
    TangentRule.FLAT,
    TangentRule.LINEAR,
    TangentRule.SMOOTH,
    TangentRule.STEP,
)


def insert(channel: Channel, time: float) -> None:
    document = document_of(channel)
    document.do("Insert", lambda clip: edits.insert(clip, channel, time), selection=added_keys)
    channel.check()


def assert_same_shape(channel: Channel, time: float) -> None:
    """Inserting a key at *time* must change the curve nowhere."""
    before_keys = len(channel)
    places = np.linspace(-3.0, 8.0, 400)
    before = channel.evaluate(places)
    insert(channel, time)
    assert len(channel) == before_keys + 1
    np.testing.assert_allclose(channel.evaluate(places), before, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("rule_out", TANGENT_RULES)
@pytest.mark.parametrize("rule_in", [rule for rule in TANGENT_RULES if rule != STEP])
@pytest.mark.parametrize("time", [0.3, 1.5, 2.25, 3.999])
def test_inserting_keeps_the_shape_under_every_rule(rule_in: TangentRule, rule_out: TangentRule, time: float) -> None:
    run = make_run([0.0, 1.0, 2.0, 3.0, 4.0], [0.0, 2.0, -1.0, 1.0, 0.5], 1.5, -2.0, rule_in, rule_out)
    assert_same_shape(Channel("x", run), time)


@pytest.mark.parametrize("mode", [Extrapolation.CONSTANT, Extrapolation.LINEAR])
@pytest.mark.parametrize("rule", [SMOOTH, FLAT, FIXED, LINEAR, STEP])
@pytest.mark.parametrize("time", [-1.5, 6.0])
@pytest.mark.parametrize("keys", [1, 2, 3])
def test_inserting_outside_keeps_a_straight_extrapolation(
    mode: Extrapolation, rule: TangentRule, time: float, keys: int
) -> None:
    rule_in = FIXED if rule == STEP else rule
    run = make_run(np.arange(float(keys)), np.arange(float(keys)) ** 2, 1.5, -2.0, rule_in, rule)
    assert_same_shape(Channel("x", run, pre=mode, post=mode), time)


@pytest.mark.parametrize("mode", EXTRAPOLATIONS)
@pytest.mark.parametrize("keys", [0, 1, 2, 5])
def test_inserting_far_outside_never_fails(mode: Extrapolation, keys: int) -> None:
    for time in (-1e300, -7.25, 1e-320, 9.5, 1e300):
        channel = channel_of([0.0, 1.0, -2.0, 5.0, 1.0][:keys], pre=mode, post=mode)
        value = channel.value(time)
        insert(channel, time)
        key = channel.key_at(time)
        assert key is not None
        assert key.value == value


def test_a_key_inserted_in_a_held_span_holds_too() -> None:
    channel = Channel("x", make_run([0.0, 2.0], [1.0, 5.0], rules_in=SMOOTH, rules_out=[STEP, SMOOTH]))
    insert(channel, 1.0)
    assert channel.run()["rule_out"][:2].tolist() == [STEP, STEP]
    assert values(channel) == [1.0, 1.0, 5.0]


def test_a_side_that_keeps_its_slope_keeps_its_rule() -> None:
    channel = channel_of([0.0, 1.0, 2.0, 3.0])
    document_of(channel).do("Flat", lambda clip: edits.set_rule(clip, select(channel, 2), FLAT))
    document_of(channel).do("Linear", lambda clip: edits.set_rule(clip, select(channel, 3), LINEAR))
    document_of(channel).do("Linear", lambda clip: edits.set_rule(clip, select(channel, 4), LINEAR))
    insert(channel, 1.5)
    assert channel.key(2).rule_in == channel.key(2).rule_out == FLAT
    assert channel.key(3).rule_in == FIXED
    assert channel.key(3).rule_out == LINEAR
    insert(channel, 2.5)
    assert channel.key(4).rule_in == LINEAR


def test_a_smooth_neighbour_becomes_fixed_and_its_handles_still_turn_as_one() -> None:
    channel = channel_of([0.0, 1.0, 5.0, 3.0])
    insert(channel, 1.5)
    key = channel.key(2)
    assert (key.rule_in, key.rule_out, key.broken) == (FIXED, FIXED, False)
    document_of(channel).do("Turn", lambda clip: edits.set_slope(clip, channel, 2, "out", 9.0))
    assert channel.key(2).slope_in == 9.0


def test_a_linear_corner_keeps_its_other_side_when_the_handle_is_turned() -> None:
    channel = channel_of([0.0, 1.0, 5.0, 3.0])
    document_of(channel).do("Linear", lambda clip: edits.set_rule(clip, select(channel, 2), LINEAR))
    insert(channel, 1.5)
    document_of(channel).do("Turn", lambda clip: edits.set_slope(clip, channel, 2, "out", 9.0))
    assert channel.key(2).slope_in == 1.0


def test_inserting_reaches_no_further_than_the_keys_beside_it() -> None:
    channel = channel_of([0.0, 1.0, 5.0, 3.0, 2.0, 7.0])
    changes = edits.insert(Clip([channel]), channel, 2.5)
    (splice,) = changes
    assert splice.before["id"].tolist() == [3, 4]  # type: ignore[union-attr, call-overload, index]


def test_nothing_is_inserted_where_a_key_is() -> None:
    channel = channel_of([0.0, 1.0])
    assert edits.insert(Clip([channel]), channel, 1.0) == []
    with pytest.raises(ValueError, match="time is nan"):
        edits.insert(Clip([channel]), channel, nan)


def test_the_first_key_of_a_channel_is_at_the_value_of_its_curve() -> None:
    channel = Channel("x")
    insert(channel, 2.0)
    assert (times(channel), values(channel)) == ([2.0], [0.0])


def test_a_key_put_at_a_value_takes_the_place_of_the_value_only() -> None:
    channel = channel_of([0.0, 1.0])
    document = document_of(channel)
    document.do("Put", lambda clip: edits.insert_key(clip, channel, 0.5, 9.0))
    assert values(channel) == [0.0, 9.0, 1.0]
    document.do("Turn", lambda clip: edits.set_slope(clip, channel, 3, "in", 4.0))
    document.do("Put", lambda clip: edits.insert_key(clip, channel, 0.5, 3.0))
    assert ids(channel) == [1, 3, 2]
    assert values(channel) == [0.0, 3.0, 1.0]
    assert channel.key(3).slope_in == 4.0
    document.do("Hold", lambda clip: edits.insert_key(clip, channel, 0.75, 3.0, STEP))
    assert channel.value(0.99) == 3.0


def test_keys_are_put_on_all_channels_but_where_there_are_some() -> None:
    channel, other = channel_of([0.0, 1.0]), channel_of([0.0, 4.0], "root.ty", step=0.5)
    document = document_of(channel, other)
    document.do("Key", lambda clip: edits.key_all(clip, clip.channels, 0.5), selection=added_keys)
    assert len(channel) == 3
    assert len(other) == 2
    assert document.session.selection == select(channel, 3)


def test_deleting_takes_the_selected_keys_and_no_others() -> None:
    channel = Channel("x", make_run(np.arange(5000.0), 0.0))
    document = document_of(channel)
    document.do("Delete", lambda clip: edits.delete(clip, select(channel, 1, 2, 2500, 5000)))
    channel.check()
    assert ids(channel) == [*range(3, 2500), *range(2501, 5000)]
    document.do("All", lambda clip: edits.delete(clip, select(channel, *ids(channel))))
    assert len(channel) == 0


def test_slopes_as_large_as_there_are_keep_a_curve_s_shape_without_a_warning() -> None:
    slopes = [-1e308, -1e308, 1e308, 1.7e308], [1e308, -1e308, 1.7e308, 1.7e308]
    rules = [[TangentRule(number) for number in side] for side in ((1, 5, 3, 3), (3, 1, 2, 3))]
    run = make_run([1.0, 2.0, 3.0, 3.001], [1e308, 1e308, -1e308, 0.0], *slopes, *rules)
    channel = Channel("x", run)
    document = document_of(channel)
    assert document.do("Insert", lambda clip: edits.insert(clip, channel, 2.978379362069007)) is not None
    channel.check()
