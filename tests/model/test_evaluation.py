"""Values and slopes: through the keys, the same bits one by one and all at once, finite whatever the numbers."""

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from model import curve, evaluation, lookup
from model.channel import Channel
from model.extrapolation import Extrapolation
from model.keyframe import Run, TangentRule, make_run
from model.lookup import TABLE_TIMES
from model.rows import FILLED, Rows
from tests.exact import exact_channel, rounded, scale_of
from tests.model.drawn import bits, channels, finite, modes, random_run, runs


def one_by_one(channel: Channel, times: Any) -> list[float]:
    return [channel.value(time) for time in np.asarray(times).tolist()]


@given(channels())
def test_the_curve_passes_through_its_keys_bit_for_bit(channel: Channel) -> None:
    run = channel.run()
    assert bits(channel.evaluate(run["time"])) == bits(run["value"])
    assert bits(one_by_one(channel, run["time"])) == bits(run["value"])


@given(channels(finite, finite, most=6), st.lists(finite, max_size=20))
def test_every_finite_time_has_a_finite_value_and_slope(channel: Channel, times: list[float]) -> None:
    channel.check()
    run = channel.run()
    # Between and beyond keys, however near or far they are.
    times += [0.5 * t0 + 0.5 * t1 for t0 in run["time"].tolist() for t1 in run["time"].tolist()]
    values = channel.evaluate(times)
    assert np.isfinite(values).all()
    assert bits(one_by_one(channel, times)) == bits(values)
    assert bits(channel.evaluate(run["time"])) == bits(run["value"])
    assert np.isfinite(channel.slopes(times)).all()
    assert np.isfinite(channel.slopes(times, "in")).all()
    assert np.isfinite(channel.envelope(np.sort(times))).all()
    assert all(np.isfinite(np.concatenate(channel.spans_between(-np.inf, np.inf)))) or len(channel) < 2
    assert all(np.isfinite(key.coefficients).all() for key in channel)


@given(channels(), st.lists(st.floats(-500, 500), max_size=30))
def test_one_value_and_many_have_the_same_bits(channel: Channel, times: list[float]) -> None:
    run = channel.run()
    # Exactly on and beside keys, joins and turns.
    ends = run["time"][[0, -1]] if len(run) else np.zeros(2)
    joins = np.add.outer(run["time"], np.arange(-3, 4) * (ends[1] - ends[0])).reshape(-1)
    everything = np.concatenate([times, joins, np.nextafter(joins, -np.inf), np.nextafter(joins, np.inf)])
    assert bits(one_by_one(channel, everything)) == bits(channel.evaluate(everything))


@given(runs(least=2, values=st.floats(-1e3, 1e3)), modes, modes, st.floats(-500, 500))
def test_values_are_those_of_rational_arithmetic(
    run: Run, pre: Extrapolation, post: Extrapolation, time: float
) -> None:
    channel = Channel("x", run, pre=pre, post=post)
    exact = exact_channel(channel)
    assume(exact.clear_of_jumps(time))
    expected = rounded(exact.value(time))
    # A time among many copies is known to its own rounding only, which a steep slope makes worse.
    steepest = max(abs(float(slope)) for pair in exact.slopes for slope in pair) + scale_of(exact)
    tolerance = 1e-12 * (scale_of(exact) + abs(expected)) + 1e-13 * steepest * (abs(time) + 100.0)
    assert channel.value(time) == pytest.approx(expected, abs=tolerance, rel=0.0)


@pytest.mark.parametrize("n", [0, 1, 2, 50, 1500])
def test_nothing_known_about_a_time_gives_nothing(n: int) -> None:
    channel = Channel("x", random_run(1, n))
    assert np.isnan(channel.value(np.nan))
    found = channel.evaluate([0.1, np.nan, 0.2])
    assert np.isnan(found).tolist() == [False, True, False]
    assert np.isnan(channel.slopes([0.1, np.nan])).tolist() == [False, True]
    assert np.isnan(channel.evaluate(np.full(9000, np.nan))).all()


def test_times_of_any_shape_give_values_of_that_shape() -> None:
    channel = Channel("x", random_run(1, 5))
    assert channel.evaluate(0.5).shape == ()
    assert channel.evaluate([]).shape == (0,)
    assert channel.evaluate(np.zeros((2, 3, 4))).shape == (2, 3, 4)
    assert channel.evaluate([1, 2]).dtype == np.float64
    assert channel.slopes(np.zeros((2, 3))).shape == (2, 3)
    assert isinstance(channel.value(np.float64(0.3)), float)


def test_a_held_span_holds_until_the_next_key() -> None:
    channel = Channel("x", make_run([0.0, 1.0], [5.0, 7.0], 3.0, 3.0, TangentRule.FIXED, TangentRule.STEP))
    assert one_by_one(channel, [0.0, 0.5, np.nextafter(1.0, 0.0), 1.0]) == [5.0, 5.0, 5.0, 7.0]


# Each way of finding keys must give the bits that bisection gives.


@pytest.mark.parametrize("n", [2, 9, 384, 385, 1500])
@pytest.mark.parametrize("order", ["rising", "random", "rising with equals"])
def test_many_times_are_found_as_one_is(n: int, order: str) -> None:
    channel = Channel("x", random_run(n, n), pre=Extrapolation.BOUNCE, post=Extrapolation.CYCLE_OFFSET)
    run = channel.run()
    chance = np.random.default_rng(n)
    low, high = run["time"][0], run["time"][-1]
    for begin, end in ((low, high), (low - 3.0, high + 5.0)):
        times = chance.uniform(begin, end, 40_000)
        times[:n] = run["time"]
        if order != "random":
            times.sort()
        if order == "rising with equals":
            times[1::2] = times[::2]
        sample = slice(None, None, 17)
        assert bits(channel.evaluate(times)[sample]) == bits(one_by_one(channel, times[sample]))
        few = channel.evaluate(times[:100])
        assert bits(few) == bits(channel.evaluate(times)[:100])


def test_keys_crowded_in_a_corner_are_found_too() -> None:
    times = np.concatenate([np.geomspace(1e-9, 1.0, 6000), [1e6]])
    channel = Channel("x", make_run(times, np.arange(6001.0), 0, 0, TangentRule.LINEAR, TangentRule.STEP))
    many = np.concatenate([times, np.geomspace(1e-9, 1e6, 20_000)])
    expected = np.searchsorted(times, many, "right") - 1.0
    assert (channel.evaluate(many) == expected).all()
    assert one_by_one(channel, many[::7]) == expected[::7].tolist()


def test_values_of_a_long_channel_are_the_same_once_a_table_finds_them() -> None:
    n = 2 * curve._KEPT_SPANS
    channel = Channel("x", random_run(4, n), post=Extrapolation.CYCLE)
    times = channel.run()["time"]
    asked = np.concatenate(
        [np.random.default_rng(1).uniform(-1.0, times[-1] + 3.0, 3000), times[:: n // 500], times[-1:]]
    )
    expected = channel.evaluate(asked)
    for _ in range(2):
        assert bits(one_by_one(channel, asked)) == bits(expected)
    assert channel._seekable is not curve._NOT_YET


def test_values_are_found_behind_the_spare_places_of_rows_without_another_table(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tables: list[lookup.Table] = []

    def counted(rows: Rows) -> lookup.Table:
        tables.append(lookup.Table(rows))
        return tables[-1]

    monkeypatch.setattr(curve, "Table", counted)
    n = 2 * curve._KEPT_SPANS
    channel = Channel("x", random_run(6, n))
    # A row of few keys has more spare places than are looked at one by one.
    gone = channel.run()[FILLED + 20 : FILLED + 300]
    channel.splice(gone, gone[:0])
    times = channel.run()["time"]
    beside = np.concatenate([times, np.nextafter(times, -np.inf)[1:], np.nextafter(times, np.inf)[:-1]])
    expected = channel.evaluate(beside[:TABLE_TIMES])
    one_by_one(channel, times[: n // 4])
    seekable = channel._seekable
    assert bits(one_by_one(channel, beside[:TABLE_TIMES])) == bits(expected)
    assert bits(one_by_one(channel, beside)) == bits(channel.evaluate(beside))
    assert channel._seekable is seekable is not curve._NOT_YET
    assert len(tables) == 1


def test_what_is_kept_for_speed_never_outlives_an_edit() -> None:
    channel = Channel("x", random_run(3, 1000))
    times = np.linspace(-5.0, channel.run()["time"][-1] + 5.0, 50_000)
    for step in range(12):
        run = channel.run()
        before = run[step * 50 : step * 50 + step % 4]
        after = before.copy()
        after["value"] += 1.0
        channel.splice(before, after if step % 2 else after[:0])
        fresh = Channel("fresh", channel.run())
        edges = times[::500]
        assert bits(channel.evaluate(times)) == bits(fresh.evaluate(times))
        assert bits(one_by_one(channel, edges)) == bits(fresh.evaluate(edges))
        assert bits(channel.envelope(edges)) == bits(fresh.envelope(edges))


@pytest.mark.parametrize("edit", ["raised", "later", "thinned", "gone in part", "repeated"])
def test_one_value_of_a_long_channel_follows_an_edit(edit: str) -> None:
    channel = Channel("x", random_run(5, 2 * curve._KEPT_SPANS))
    run = channel.run()
    asked = np.random.default_rng(2).uniform(0.0, run["time"][-1], 3000)
    one_by_one(channel, asked)
    assert channel._seekable is not curve._NOT_YET
    after = run.copy()
    if edit == "raised":
        after["value"] += 1.0
    elif edit == "later":
        after["time"][:-1] += 0.5 * np.diff(run["time"])
    elif edit == "thinned":
        after = after[::2]
    elif edit == "gone in part":
        run, after = run[300:1200], after[300:300]
    if edit == "repeated":
        channel.set_extrapolation(Extrapolation.CYCLE, Extrapolation.BOUNCE)
        asked += 10.0
    else:
        channel.splice(run, after)
    for _ in range(2):
        assert bits(one_by_one(channel, asked)) == bits(channel.evaluate(asked))


@pytest.mark.parametrize("n", [5, 10_000])
def test_the_same_time_asked_again_after_an_edit_has_the_new_value(n: int) -> None:
    channel = Channel("x", make_run(np.arange(float(n)), 0.0))
    assert channel.value(2.0) == 0.0
    run = channel.run()[2:3]
    after = run.copy()
    after["value"] = 7.0
    channel.splice(run, after)
    assert channel.value(2.0) == 7.0


def test_spans_are_kept_only_for_short_channels() -> None:
    channel = Channel("x", random_run(3, 3 * curve._KEPT_SPANS))
    for time in np.linspace(0.0, channel.run()["time"][-1], 500).tolist():
        channel.value(time)
    assert len(channel._spans_kept) == 1


# --- slopes


@given(runs(least=2))
def test_slopes_at_keys_are_the_tangents(run: Run) -> None:
    channel = Channel("x", run)
    stored = channel.run()
    held = stored["rule_out"][:-1] == TangentRule.STEP
    assert channel.slopes(stored["time"][:-1]) == pytest.approx(
        np.where(held, 0.0, stored["slope_out"][:-1]), rel=1e-9, abs=1e-6
    )
    # The error of a slope at a span's end is that of its coefficients.
    scale = np.abs(stored["value"]).max() + np.abs(stored["slope_in"]).max() + np.abs(stored["slope_out"]).max()
    expected = np.where(held, 0.0, stored["slope_in"][1:])
    assert channel.slopes(stored["time"][1:], "in") == pytest.approx(expected, rel=1e-9, abs=1e-9 * (1.0 + scale))


@given(runs(least=2, values=st.floats(-100, 100)), st.floats(0.01, 0.99), modes, modes)
def test_slopes_are_those_of_the_values(run: Run, share: float, pre: Extrapolation, post: Extrapolation) -> None:
    channel = Channel("x", run, pre=pre, post=post)
    times = channel.run()["time"]
    length = times[-1] - times[0]
    inside = times[:-1] + np.diff(times) * share
    step = 1e-4 * np.diff(times)
    for copy in (-2, -1, 0, 1, 2):
        mirrored = copy % 2 and (pre if copy < 0 else post) is Extrapolation.BOUNCE
        at = (times[0] + times[-1] - inside if mirrored else inside) + copy * length
        measured = (channel.evaluate(at + step) - channel.evaluate(at - step)) / (2 * step)
        scale = 1.0 + scale_of(exact_channel(channel)) / np.diff(times).min()
        assert channel.slopes(at) == pytest.approx(measured, rel=1e-4, abs=1e-3 * scale)
        assert channel.slopes(at, "in") == pytest.approx(channel.slopes(at), rel=1e-6, abs=1e-6 * scale)


def test_slopes_beyond_the_keys() -> None:
    run = make_run([0.0, 1.0], [0.0, 1.0], [3.0, 4.0], [5.0, 6.0], TangentRule.FIXED, TangentRule.FIXED)
    found = {}
    for mode in Extrapolation:
        channel = Channel("x", run, pre=mode, post=mode)
        found[mode] = [channel.slope(-1.0), channel.slope(0.0, "in"), channel.slope(1.0), channel.slope(2.0, "in")]
    assert found == {
        Extrapolation.CONSTANT: [0.0, 0.0, 0.0, 0.0],
        Extrapolation.LINEAR: [3.0, 3.0, 6.0, 6.0],
        Extrapolation.CYCLE: pytest.approx([5.0, 4.0, 5.0, 4.0]),
        Extrapolation.CYCLE_OFFSET: pytest.approx([5.0, 4.0, 5.0, 4.0]),
        Extrapolation.BOUNCE: pytest.approx([-4.0, -5.0, -4.0, -5.0]),
    }
    with pytest.raises(ValueError, match="side"):
        Channel("x", run).slopes([0.0], "both")


def test_slopes_without_keys_and_of_a_lone_key() -> None:
    assert Channel("x").slopes([1.0]).tolist() == [0.0]
    run = make_run([0.0], [1.0], 2.0, -3.0, TangentRule.FIXED, TangentRule.FIXED)
    channel = Channel("x", run, pre=Extrapolation.LINEAR, post=Extrapolation.LINEAR)
    assert [channel.slope(t) for t in (-1.0, 1.0)] == [2.0, -3.0]


# --- spans


def test_the_span_at_a_time() -> None:
    channel = Channel("x", make_run([0.0, 1.0, 3.0], [0.0, 1.0, 0.0], rules_in=0, rules_out=0))
    assert channel.span_at(0.5) == (0.0, 1.0, -2.0, 3.0, 0.0, 0.0)
    assert [channel.span_at(t) is None for t in (-0.1, 0.0, 1.0, 3.0, 3.1)] == [True, False, False, False, True]
    second, last = channel.span_at(1.0), channel.span_at(3.0)
    assert second == last == (1.0, 3.0, 2.0, -3.0, 0.0, 1.0)
    assert Channel("x", make_run([1.0])).span_at(1.0) is None
    assert Channel("x").span_at(1.0) is None


@pytest.mark.parametrize("n", [0, 1, 2, 20, 1200])
def test_spans_between_two_times_are_those_that_touch_them(n: int) -> None:
    channel = Channel("x", random_run(6, n))
    times = channel.run()["time"]
    probes = [-1.0, *times[:3], *(times[:3] + 1e-4), *times[-3:], 1e4]
    for t0 in probes:
        for t1 in probes:
            spans = channel.spans_between(t0, t1)
            touching = (times[1:] >= t0) & (times[:-1] <= t1) & (t0 <= t1)
            if t0 <= t1:
                assert spans.time0.tolist() == times[:-1][touching].tolist()
                assert spans.time1.tolist() == times[1:][touching].tolist()
            middle = 0.5 * spans.time0 + 0.5 * spans.time1
            u = (middle - spans.time0) / (spans.time1 - spans.time0)
            values = spans.d + u * (spans.c + u * (spans.b + u * spans.a))
            assert values == pytest.approx(channel.evaluate(middle), rel=1e-12, abs=1e-12)


def test_spans_from_a_time_are_neighbours_with_one_place_for_the_last_key() -> None:
    channel = Channel("x", random_run(8, 900))
    times = channel.run()["time"]
    for time in (times[0], times[100] + 1e-5, times[-2], times[-1]):
        spans = channel.spans_from(float(time), 7)
        assert spans[0, 0] <= time < spans[1, 0]
        assert 1 <= spans.shape[1] <= 7
        assert (spans[1, :-1] == spans[0, 1:]).all()
    assert channel.spans_from(float(times[-1]), 7)[:, 0].tolist() == [
        times[-1],
        np.nextafter(times[-1], np.inf),
        1.0,
        0.0,
        0.0,
        0.0,
        channel.run()["value"][-1],
    ]


def test_careful_evaluation_gives_what_the_quick_one_gives_on_ordinary_numbers() -> None:
    channel = Channel("x", random_run(9, 500))
    rows = channel._rows
    times = np.random.default_rng(0).uniform(rows.times[0], rows.times[-1], 3000)
    slots = rows.times.searchsorted(times, "right") - 1
    assert evaluation.careful(rows, slots, times) == pytest.approx(channel.evaluate(times), rel=1e-12, abs=1e-12)
