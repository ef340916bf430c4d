"""The range of the curve in each column: never too small, and no larger than the curve."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from model.channel import Channel
from model.extrapolation import Extrapolation
from model.hermite import Floats
from model.keyframe import TangentRule, make_run
from tests.exact import exact_channel, scale_of
from tests.model.drawn import bits, channels, random_run


def ranges_by_looking(channel: Channel, edges: Floats, samples: int = 300) -> tuple[Floats, Floats, Floats]:
    """(lowest, highest, how much the curve may do between two samples), from many samples of each column."""
    run = channel.run()
    times = run["time"]
    length = float(times[-1] - times[0])
    copies = np.arange(*((edges[[0, -1]] - times[0]) // (length or 1e9) + [-1, 3]))
    # Keys, their images and mirror images, and just before them: where the curve jumps or turns round.
    special = np.add.outer(times, copies * length).reshape(-1)
    mirrored = np.add.outer(times[0] + times[-1] - times, copies * length).reshape(-1)
    special = np.concatenate([special, mirrored])
    # So near that the curve does nothing else, so far that rounding does not carry the time over the join.
    beside = 1e-11 * (np.abs(special) + 1.0)
    special = np.concatenate([special, special - beside, special + beside])
    low, high, between = [], [], []
    for begin, end in pairwise(edges):
        at = np.concatenate([np.linspace(begin, end, samples), special[(special >= begin) & (special <= end)]])
        values = channel.evaluate(at)
        low.append(values.min())
        high.append(values.max())
        spans = channel.spans_between(-np.inf, np.inf)
        gaps = np.diff(times).min() if len(times) > 1 else 1.0
        bend = np.abs(2 * spans.b).max(initial=0) + np.abs(6 * spans.a).max(initial=0)
        between.append(bend * ((end - begin) / (samples - 1) / gaps) ** 2)
    return np.array(low), np.array(high), np.array(between)


@given(channels(least=1, values=st.floats(-100, 100)), st.floats(-300, 300), st.floats(0.01, 300), st.integers(1, 12))
def test_columns_cover_the_curve_and_nothing_more(channel: Channel, start: float, length: float, columns: int) -> None:
    edges = np.linspace(start, start + length, columns + 1)
    low, high = channel.envelope(edges)
    seen_low, seen_high, between = ranges_by_looking(channel, edges)
    exact = exact_channel(channel)
    drift = abs(float(channel.run()["value"][-1] - channel.run()["value"][0])) * 1e4 if len(channel) else 0.0
    slack = 1e-12 * (scale_of(exact) + drift + np.abs(seen_low) + np.abs(seen_high) + 1.0)
    steepest = max(abs(float(s)) for pair in exact.slopes for s in pair) + 4.0 * scale_of(exact)
    slack += 1e-10 * (abs(start) + length + 1.0) * steepest
    assert (low <= seen_low + slack).all()
    assert (high >= seen_high - slack).all()
    assert (low >= seen_low - slack - between).all()
    assert (high <= seen_high + slack + between).all()


@given(channels(least=1))
def test_all_of_a_channel_is_one_column_from_its_first_to_its_last_key(channel: Channel) -> None:
    ends = channel.ends()
    assert ends is not None
    low, high = channel.envelope([ends.time0, ends.time1])
    assert channel.extrema() == (low[0], high[0])


@pytest.mark.parametrize("n", [3, 40, 384, 1500])
@pytest.mark.parametrize("seed", range(4))
def test_columns_among_many_keys(n: int, seed: int) -> None:
    channel = Channel("x", random_run(seed, n))
    run = channel.run()
    edges = np.unique(np.concatenate([np.linspace(run["time"][0], run["time"][-1], 37), run["time"][:: n // 3]]))
    low, high = channel.envelope(edges)
    # Many samples of each span but its end, where a held one has jumped already; every key; just before every jump.
    spans = channel.spans_between(-np.inf, np.inf)
    u = np.linspace(0.0, 1.0, 400, endpoint=False)[:, None]
    sampled = (spans.d + u * (spans.c + u * (spans.b + u * spans.a))).reshape(-1)
    held = np.flatnonzero(run["rule_out"][:-1] == TangentRule.STEP)
    just_before = np.nextafter(run["time"][held + 1], -np.inf)
    times = (spans.time0 + u * (spans.time1 - spans.time0)).reshape(-1)
    times = np.concatenate([times, run["time"], just_before, edges])
    values = np.concatenate([sampled, run["value"], run["value"][held], channel.evaluate(edges)])
    bend = (np.abs(2 * spans.b) + np.abs(6 * spans.a)).max() / 400**2
    for j in range(len(edges) - 1):
        here = values[(times >= edges[j]) & (times <= edges[j + 1])]
        assert low[j] <= here.min() + 1e-12
        assert high[j] >= here.max() - 1e-12
        assert low[j] >= here.min() - bend
        assert high[j] <= here.max() + bend


@pytest.mark.parametrize("mode", Extrapolation)
def test_a_column_of_many_copies_covers_a_whole_copy(mode: Extrapolation) -> None:
    run = make_run([0.0, 1.0, 2.0], [0.0, 8.0, 2.0], 0.0, 0.0, TangentRule.FLAT, TangentRule.FLAT)
    channel = Channel("x", run, pre=mode, post=mode)
    edges = np.array([-11.0, -0.5, 0.5, 2.0, 10.0, 11.0])
    low, high = channel.envelope(edges)
    seen_low, seen_high, between = ranges_by_looking(channel, edges, 5000)
    assert low == pytest.approx(seen_low, abs=between.max())
    assert high == pytest.approx(seen_high, abs=between.max())
    # By hand: from -11 to -0.5 are five whole copies and half of one.
    by_hand = {
        Extrapolation.CONSTANT: (0.0, 0.0),
        Extrapolation.LINEAR: (0.0, 0.0),
        Extrapolation.CYCLE: (0.0, 8.0),
        Extrapolation.CYCLE_OFFSET: (-10.0, 6.0),
        Extrapolation.BOUNCE: (0.0, 8.0),
    }
    assert (low[0], high[0]) == by_hand[mode]


def test_a_value_that_no_copy_reaches_is_not_shown() -> None:
    # The last span is held, so 100 is the value at the last key alone.
    run = make_run([0.0, 1.0, 2.0], [1.0, 2.0, 100.0], 0, 0, TangentRule.FLAT, TangentRule.STEP)
    channel = Channel("x", run, post=Extrapolation.CYCLE)
    low, high = channel.envelope([0.0, 2.0, 3.0, 4.0, 11.0])
    assert (low.tolist(), high.tolist()) == ([1.0, 1.0, 1.0, 1.0], [100.0, 100.0, 2.0, 2.0])


def test_one_spike_among_many_keys_is_seen_in_every_column_that_holds_it() -> None:
    n = 20_000
    values = np.zeros(n)
    values[13_337] = 1e6
    channel = Channel("x", make_run(np.arange(n) / 30.0, values, 0, 0, TangentRule.LINEAR, TangentRule.LINEAR))
    where = 13_337 / 30.0
    for columns in (1, 7, 100, 1600, 50_000):
        for start, end in ((0.0, n / 30.0), (where - 1.0, where + 2.0), (where - 1e5, where + 1e5)):
            edges = np.linspace(start, end, columns + 1)
            high = channel.envelope(edges)[1]
            column = int(edges.searchsorted(where, "right")) - 1
            assert high[column] == 1e6


@pytest.mark.parametrize("columns", [1, 5, 37, 700, 9_000, 90_000])
def test_columns_of_very_many_straight_spans_are_what_their_keys_and_edges_show(columns: int) -> None:
    n = 60_000
    values = np.random.default_rng(columns).normal(size=n).cumsum()
    channel = Channel("x", make_run(np.arange(n) / 30.0, values, 0, 0, TangentRule.LINEAR, TangentRule.LINEAR))
    edges = np.linspace(3.01, (n - 77) / 30.0, columns + 1)
    low, high = channel.envelope(edges)
    times = np.concatenate([edges, np.arange(n) / 30.0])
    order = np.argsort(times, kind="stable")
    seen = np.concatenate([channel.evaluate(edges), values])[order]
    at = np.flatnonzero(order < len(edges))
    assert low == pytest.approx([seen[i : j + 1].min() for i, j in pairwise(at.tolist())], abs=1e-9)
    assert high == pytest.approx([seen[i : j + 1].max() for i, j in pairwise(at.tolist())], abs=1e-9)


@given(channels(least=1, most=5), st.data())
def test_what_is_known_of_old_keys_is_forgotten(channel: Channel, data: st.DataObject) -> None:
    edges = np.linspace(-120.0, 120.0, 30)
    for _ in range(4):
        run = channel.run()
        begin = data.draw(st.integers(0, len(run) - 1))
        after = run[begin : begin + 1].copy()
        after["value"] = data.draw(st.floats(-100, 100))
        channel.splice(run[begin : begin + 1], after)
        assert bits(channel.envelope(edges)) == bits(
            Channel("y", channel.run(), pre=channel.pre, post=channel.post).envelope(edges)
        )


@settings(max_examples=30)
@given(channels(least=2, values=st.floats(-1.7e308, 1.7e308), most=4), st.integers(1, 9))
def test_huge_values_have_ranges_too(channel: Channel, columns: int) -> None:
    run = channel.run()
    edges = np.linspace(run["time"][0] - 1.0, run["time"][-1] + 1.0, columns + 1)
    low, high = channel.envelope(edges)
    assert np.isfinite(low).all()
    assert np.isfinite(high).all()
    times = np.linspace(edges[0], edges[-1], 500)
    place = np.clip(np.searchsorted(edges, times, "right") - 1, 0, columns - 1)
    values = channel.evaluate(times)
    assert (values * 0.5 <= high[place] * 0.5 + 1e-12 * np.abs(high[place])).all()
    assert (values * 0.5 >= low[place] * 0.5 - 1e-12 * np.abs(low[place])).all()


def test_extrema_of_the_whole_curve_and_of_a_part() -> None:
    run = make_run([0.0, 1.0, 2.0], [0.0, 0.0, 0.0], 6.0, 6.0, TangentRule.FIXED, TangentRule.FIXED)
    channel = Channel("x", run)
    top = 12**-0.5  # 6 u (1 - u) (1 - 2u) is greatest at 1/2 - 1/sqrt(12), where it is 1/sqrt(3)
    assert channel.extrema() == pytest.approx((-2 * top, 2 * top))
    assert channel.extrema(0.0, 0.5) == pytest.approx((0.0, 2 * top))
    assert channel.extrema(5.0, 6.0) == (0.0, 0.0)
    assert Channel("x").extrema() == (0.0, 0.0)
    assert Channel("x", make_run([1.0], [7.0])).extrema() == (7.0, 7.0)


@pytest.mark.parametrize("n", [0, 1, 5])
def test_columns_without_width_or_number(n: int) -> None:
    channel = Channel("x", random_run(1, n))
    assert [len(side) for side in channel.envelope([])] == [0, 0]
    assert [len(side) for side in channel.envelope([1.0])] == [0, 0]
    low, high = channel.envelope([0.3, 0.3, 0.3])
    assert low.tolist() == high.tolist() == [channel.value(0.3)] * 2


@pytest.mark.parametrize("seed", range(20))
def test_the_extrema_of_the_whole_curve_are_those_of_now_after_every_change(seed: int) -> None:
    chance = np.random.default_rng(seed)
    channel = Channel("x", random_run(seed, 30))
    for _ in range(30):
        before = channel.run()
        first, count = int(chance.integers(0, len(before) - 4)), int(chance.integers(1, 4))
        after = before[first : first + count].copy()
        if chance.random() < 0.4 or len(before) < 8:
            after["value"] += chance.normal(size=count) * 10.0
        channel.splice(before[first : first + count], after[: 0 if chance.random() < 0.2 else count])
        assert channel.extrema() == channel.copy().extrema()
        if len(channel) < 8:
            break
