"""Splices: undone bit for bit, felt only within their reach, and the same as on a plain Python list."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from model.channel import Channel
from model.extrapolation import Extrapolation
from model.keyframe import KEY_DTYPE, Run, TangentRule, make_run
from tests.model.drawn import IN_RULES, OUT_RULES, bits, channels, modes, quarters, random_run, runs


@st.composite
def splices(draw: Any, channel: Channel, most: int = 5) -> tuple[Run, Run]:
    """A run of the channel and what may stand in its place: new keys, or the same keys changed."""
    run = channel.run()
    begin = draw(st.integers(0, len(run)))
    end = draw(st.integers(begin, min(len(run), begin + most)))
    before = run[begin:end]
    low = run["time"][begin - 1] if begin else -1000.0
    high = run["time"][end] if end < len(run) else 1000.0
    if draw(st.booleans()) and len(before):
        after = before.copy()
        after["value"] += draw(st.sampled_from([0.0, 0.5, -3.0]))
        after["rule_out"] = draw(st.sampled_from(OUT_RULES))
        after["rule_in"] = draw(st.sampled_from(IN_RULES))
        after["slope_out"] = draw(st.sampled_from([0.0, 1.0, -2.5]))
    else:
        after = draw(runs(quarters, most=most))
        after = after[(after["time"] > low) & (after["time"] < high)]
    return before, after


def sample_times(*channels_: Channel) -> np.ndarray:
    times = np.unique(np.concatenate([channel.run()["time"] for channel in channels_] or [[0.0]]))
    if not len(times):
        times = np.array([0.0])
    inside = np.concatenate([times[:-1] + np.diff(times) * share for share in (0.1, 0.5, 0.9)])
    length = times[-1] - times[0] + 1.0
    outside = [times[0] - length * share for share in (1e-6, 0.3, 1.7)] + [times[-1] + length * s for s in (1e-6, 0.4)]
    return np.unique(
        np.concatenate([times, np.nextafter(times, -np.inf), np.nextafter(times, np.inf), inside, outside])
    )


@given(st.data(), channels())
def test_the_inverse_splice_restores_every_bit(data: st.DataObject, channel: Channel) -> None:
    run, revision = channel.run(), channel.revision
    times = sample_times(channel)
    values = bits(channel.evaluate(times))
    before, after = data.draw(splices(channel))
    reach = channel.splice(before, after)
    channel.check()
    back = channel.splice(reach.run, before)
    channel.check()
    assert channel.run().tobytes() == run.tobytes()
    assert bits(channel.evaluate(times)) == values
    assert back.run.tobytes() == before.tobytes()
    if len(before) or len(after):
        assert channel.revision > revision


@given(st.data(), channels())
def test_a_splice_is_felt_only_within_its_reach(data: st.DataObject, channel: Channel) -> None:
    old = channel.copy()
    before, after = data.draw(splices(channel))
    reach = channel.splice(before, after)
    times = sample_times(old, channel)
    changed = old.evaluate(times).view(np.int64) != channel.evaluate(times).view(np.int64)
    assert (times[changed] >= reach.t0).all(), (times[changed], reach)
    assert (times[changed] <= reach.t1).all(), (times[changed], reach)


@given(st.data(), channels())
def test_the_reach_holds_the_keys_as_they_are_stored(data: st.DataObject, channel: Channel) -> None:
    before, after = data.draw(splices(channel))
    reach = channel.splice(before, after)
    assert len(reach.run) == len(after)
    if len(after):
        assert channel.run_of(reach.run["id"]).tobytes() == reach.run.tobytes()
        for field in ("time", "value", "rule_in", "rule_out", "broken"):
            assert reach.run[field].tobytes() == after[field].tobytes()
        fixed = after["rule_in"] == TangentRule.FIXED
        assert reach.run["slope_in"][fixed].tobytes() == after["slope_in"][fixed].tobytes()
        fixed = after["rule_out"] == TangentRule.FIXED
        assert reach.run["slope_out"][fixed].tobytes() == after["slope_out"][fixed].tobytes()


@given(st.data(), channels(), modes, modes)
def test_the_same_keys_are_the_same_channel_however_they_came_there(
    data: st.DataObject, channel: Channel, pre: Extrapolation, post: Extrapolation
) -> None:
    before, after = data.draw(splices(channel))
    channel.splice(before, after)
    channel.set_extrapolation(pre, post)
    fresh = Channel("fresh", channel.run(), pre=pre, post=post)
    times = sample_times(channel)
    assert fresh.run().tobytes() == channel.run().tobytes()
    assert bits(fresh.evaluate(times)) == bits(channel.evaluate(times))
    edges = np.linspace(times[0], times[-1], 8)
    assert bits(fresh.envelope(edges)) == bits(channel.envelope(edges))


def test_nothing_for_nothing_changes_nothing() -> None:
    channel = Channel("x", make_run([0.0, 1.0]))
    none = channel.run()[:0]
    revision = channel.revision
    reach = channel.splice(none, none)
    assert reach.t0 > reach.t1
    assert channel.revision == revision


def test_a_change_of_one_value_reaches_two_spans_to_each_side() -> None:
    channel = Channel("x", make_run(np.arange(9.0), 0.0))
    run = channel.run_of([5])
    after = run.copy()
    after["value"] = 1.0
    assert channel.splice(run, after)[:2] == (2.0, 6.0)
    linear = Channel("x", make_run(np.arange(9.0), 0.0, 0.0, 0.0, TangentRule.FLAT, TangentRule.FLAT))
    assert linear.splice(linear.run_of([5]), after)[:2] == (3.0, 5.0)


def test_a_change_inside_a_cycle_reaches_as_far_as_the_cycle() -> None:
    channel = Channel("x", make_run(np.arange(9.0), 0.0), post=Extrapolation.CYCLE)
    run = channel.run_of([5])
    after = run.copy()
    after["value"] = 1.0
    assert channel.splice(run, after)[:2] == (2.0, np.inf)


@pytest.mark.parametrize(
    ("field", "mode", "reach"),
    [
        ("slope_out", Extrapolation.CONSTANT, (1.0, 2.0)),
        ("slope_out", Extrapolation.LINEAR, (1.0, np.inf)),
        ("slope_out", Extrapolation.BOUNCE, (-np.inf, np.inf)),
        ("value", Extrapolation.CONSTANT, (1.0, np.inf)),
        ("value", Extrapolation.LINEAR, (1.0, np.inf)),
        ("time", Extrapolation.CONSTANT, (1.0, 2.5)),
        ("time", Extrapolation.LINEAR, (1.0, np.inf)),
    ],
)
def test_a_change_of_the_last_key_reaches_beyond_it_if_it_shows_there(
    field: str, mode: Extrapolation, reach: tuple[float, float]
) -> None:
    rules = TangentRule.FIXED
    channel = Channel("x", make_run([0.0, 1.0, 2.0], [0.0, 1.0, 0.5], 0, 0, rules, rules), pre=mode, post=mode)
    before = channel.run_of([3])
    after = before.copy()
    after[field] += 0.5
    found = channel.splice(before, after)
    assert (found.t0, found.t1) == reach


class Walk(RuleBasedStateMachine):
    """A channel and a Python list of the same keys, changed together."""

    def __init__(self) -> None:
        super().__init__()
        self.channel = Channel("walk")
        self.oracle: list[tuple[Any, ...]] = []
        self.history: list[tuple[Run, Run]] = []
        self.steps = 0

    @initialize(n=st.sampled_from([0, 3, 380, 1200]), seed=st.integers(0, 9))
    def begin(self, n: int, seed: int) -> None:
        self.channel = Channel("walk", random_run(seed, n))
        self.oracle = self.channel.run().tolist()

    def splice(self, before: Run, after: Run) -> Run:
        stored = self.channel.splice(before, after).run
        if len(before) or len(after):
            place = sum(key[0] < (before["time"][0] if len(before) else after["time"][0]) for key in self.oracle)
            self.oracle[place : place + len(before)] = stored.tolist()
        self.steps += 1
        return stored

    @rule(seed=st.integers(0, 10**6), place=st.floats(0.0, 1.0), gone=st.sampled_from([0, 0, 1, 2, 5, 60, 700]))
    def replace(self, seed: int, place: float, gone: int) -> None:
        run = self.channel.run()
        begin = int(place * len(run))
        end = min(len(run), begin + gone)
        low = run["time"][begin - 1] if begin else -50.0
        high = run["time"][end] if end < len(run) else 5000.0
        chance = np.random.default_rng(seed)
        times = np.unique(chance.uniform(low, high, int(chance.choice([0, 1, 1, 3, 40, 600]))))
        after = random_run(seed, len(times))
        after["time"] = times
        after = after[(times > low) & (times < high)]
        if len(after) == end - begin and chance.random() < 0.7:
            after["id"] = run["id"][begin:end]
        before = run[begin:end]
        self.history.append((before, self.splice(before, after)))

    @precondition(lambda self: self.history)
    @rule()
    def undo(self) -> None:
        before, after = self.history.pop()
        assert self.splice(after, before).tobytes() == before.tobytes()

    @invariant()
    def the_channel_is_sound_and_equal_to_the_list(self) -> None:
        self.channel.check()
        run = self.channel.run()
        # Slopes of neighbours follow from rules; all else is what was put there.
        own = [name for name in KEY_DTYPE.names or () if not name.startswith("slope")]
        expected = np.array(self.oracle, KEY_DTYPE)
        assert all(run[name].tobytes() == expected[name].tobytes() for name in own)
        if self.steps % 8 == 0 and len(run):
            fresh = Channel("fresh", run)
            assert fresh.run().tobytes() == run.tobytes()
            times = np.linspace(run["time"][0], run["time"][-1], 99)
            assert bits(fresh.evaluate(times)) == bits(self.channel.evaluate(times))


TestWalk = Walk.TestCase
TestWalk.settings = settings(max_examples=18, stateful_step_count=30, deadline=None)
