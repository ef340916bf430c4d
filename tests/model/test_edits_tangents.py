"""Rules, slopes, break and unify: what an animator's next drag of a handle will do."""

from math import nan

import numpy as np
import pytest

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.keyframe import TangentRule, make_run
from model.tangents import TANGENT_RULES
from tests.model.editing import channel_of, document_of, select

AUTO, FIXED, FLAT, LINEAR, SMOOTH, STEP = (
    TangentRule.AUTO,
    TangentRule.FIXED,
    TangentRule.FLAT,
    TangentRule.LINEAR,
    TangentRule.SMOOTH,
    TangentRule.STEP,
)


def rules(channel: Channel, key_id: int) -> tuple[TangentRule, TangentRule, bool]:
    key = channel.key(key_id)
    return key.rule_in, key.rule_out, key.broken


def slopes(channel: Channel, key_id: int) -> tuple[float, float]:
    key = channel.key(key_id)
    return key.slope_in, key.slope_out


def set_rule(channel: Channel, key_id: int, rule: TangentRule, side: str = "both") -> None:
    document_of(channel).do("Rule", lambda clip: edits.set_rule(clip, select(channel, key_id), rule, side))
    channel.check()


def set_slope(channel: Channel, key_id: int, side: str, slope: float) -> None:
    document_of(channel).do("Turn", lambda clip: edits.set_slope(clip, channel, key_id, side, slope))
    channel.check()


@pytest.mark.parametrize("rule", TANGENT_RULES)
def test_every_rule_can_be_set_on_both_sides(rule: TangentRule) -> None:
    channel = channel_of([0.0, 1.0, 5.0])
    set_rule(channel, 2, rule)
    assert rules(channel, 2) == (SMOOTH if rule == STEP else rule, rule, False)


def test_step_holds_the_span_that_follows_and_leaves_the_side_in() -> None:
    channel = channel_of([0.0, 1.0, 5.0])
    set_rule(channel, 2, STEP)
    assert channel.value(1.99) == 1.0
    assert slopes(channel, 2)[0] == 2.5
    before = channel.run().tobytes()
    set_rule(channel, 2, STEP, "in")
    assert channel.run().tobytes() == before
    set_rule(channel, 2, SMOOTH)
    assert rules(channel, 2) == (SMOOTH, SMOOTH, False)


def test_different_rules_break_a_key_and_the_same_rule_joins_it_again() -> None:
    channel = channel_of([0.0, 1.0, 5.0])
    set_rule(channel, 2, FLAT, "out")
    assert rules(channel, 2) == (SMOOTH, FLAT, True)
    set_rule(channel, 2, FLAT, "in")
    assert rules(channel, 2) == (FLAT, FLAT, False)


def test_fixed_keeps_the_slopes_and_what_was_broken() -> None:
    channel = channel_of([0.0, 1.0, 5.0])
    set_rule(channel, 2, FIXED)
    assert slopes(channel, 2) == (2.5, 2.5)
    assert rules(channel, 2) == (FIXED, FIXED, False)
    set_rule(channel, 2, LINEAR)
    set_rule(channel, 2, FIXED)
    assert slopes(channel, 2) == (1.0, 4.0)
    assert rules(channel, 2) == (FIXED, FIXED, True)


@pytest.mark.parametrize("rule", [FLAT, SMOOTH, AUTO, FIXED])
@pytest.mark.parametrize("side", ["in", "out"])
def test_a_handle_of_a_unified_key_turns_both_sides(rule: TangentRule, side: str) -> None:
    channel = channel_of([0.0, 1.0, 5.0])
    set_rule(channel, 2, rule)
    set_slope(channel, 2, side, -3.0)
    assert slopes(channel, 2) == (-3.0, -3.0)
    assert rules(channel, 2) == (FIXED, FIXED, False)


def test_a_handle_of_a_broken_key_turns_alone() -> None:
    channel = channel_of([0.0, 1.0, 5.0])
    document_of(channel).do("Break", lambda clip: edits.break_tangents(clip, select(channel, 2)))
    set_slope(channel, 2, "out", -3.0)
    assert slopes(channel, 2) == (2.5, -3.0)
    assert rules(channel, 2) == (SMOOTH, FIXED, True)


def test_a_handle_of_a_linear_corner_turns_alone() -> None:
    channel = channel_of([0.0, 1.0, 5.0])
    set_rule(channel, 2, LINEAR)
    set_slope(channel, 2, "in", 0.25)
    assert slopes(channel, 2) == (0.25, 4.0)
    assert rules(channel, 2) == (FIXED, LINEAR, True)


def test_a_handle_beside_a_held_span_leaves_it_held() -> None:
    channel = channel_of([0.0, 1.0, 5.0])
    set_rule(channel, 2, STEP)
    set_slope(channel, 2, "in", 0.25)
    assert rules(channel, 2) == (FIXED, STEP, False)
    assert channel.value(1.99) == 1.0


def test_breaking_keeps_the_shape() -> None:
    channel = channel_of([0.0, 1.0, 5.0])
    before = channel.evaluate(np.linspace(-1.0, 3.0, 50)).tobytes()
    document_of(channel).do("Break", lambda clip: edits.break_tangents(clip, select(channel, 1, 2, 3)))
    assert channel.evaluate(np.linspace(-1.0, 3.0, 50)).tobytes() == before
    assert channel.run()["broken"].all()


def test_unifying_takes_the_mean_slope_but_leaves_a_shared_rule() -> None:
    run = make_run(
        [0.0, 1.0, 2.0, 3.0],
        [0.0, 1.0, 5.0, 2.0],
        slopes_in=[0.0, 1.0, 0.0, 1e308],
        slopes_out=[0.0, 4.0, 0.0, 1.5e308],
        rules_in=[SMOOTH, FIXED, SMOOTH, FIXED],
        rules_out=[FLAT, FIXED, SMOOTH, FIXED],
        broken=True,
    )
    channel = Channel("x", run)
    document_of(channel).do("Unify", lambda clip: edits.unify_tangents(clip, select(channel, 1, 2, 3, 4)))
    channel.check()
    assert rules(channel, 1) == (FIXED, FIXED, False)
    assert slopes(channel, 1) == (0.5, 0.5)
    assert slopes(channel, 2) == (2.5, 2.5)
    assert rules(channel, 3) == (SMOOTH, SMOOTH, False)
    assert slopes(channel, 4) == (1.25e308, 1.25e308)


def test_unifying_beside_a_held_span_leaves_it_held() -> None:
    channel = channel_of([0.0, 1.0, 5.0])
    set_rule(channel, 2, STEP)
    document_of(channel).do("Break", lambda clip: edits.break_tangents(clip, select(channel, 2)))
    document_of(channel).do("Unify", lambda clip: edits.unify_tangents(clip, select(channel, 2)))
    assert rules(channel, 2) == (SMOOTH, STEP, False)


def test_a_slope_field_turns_like_a_handle() -> None:
    channel = channel_of([0.0, 1.0, 5.0, 2.0])
    document = document_of(channel)
    document.do("Break", lambda clip: edits.break_tangents(clip, select(channel, 2)))
    document.do("Slopes", lambda clip: edits.set_field(clip, select(channel, 2, 3), "slope_out", lambda m: m + 1.0))
    assert slopes(channel, 2) == (2.5, 3.5)
    assert slopes(channel, 3) == (1.5, 1.5)


def test_what_makes_no_sense_is_refused() -> None:
    channel = channel_of([0.0, 1.0])
    clip = Clip([channel])
    with pytest.raises(ValueError, match="side is 'left'; it can be both or in or out"):
        edits.set_rule(clip, select(channel, 1), FLAT, "left")
    with pytest.raises(ValueError, match="side is 'both'; it can be in or out"):
        edits.set_slope(clip, channel, 1, "both", 1.0)
    with pytest.raises(ValueError, match="slope is nan"):
        edits.set_slope(clip, channel, 1, "in", nan)
