"""The drawn line is the curve: to a quarter of a pixel where keys are few, exact per column where they are many."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from model.channel import Channel, Spans
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule, make_run
from model.lines import TOLERANCE, Line, dashes, kept_near, line_through, lines_through, straight_dashes
from model.sampling import FAR, Window, columns, keys_in, spans_outside

type Floats = NDArray[np.float64]


def random_channel(seed: int, count: int = 12, **settings: Extrapolation) -> Channel:
    rng = np.random.default_rng(seed)
    times = np.cumsum(rng.uniform(0.02, 1.0, count))
    rules = rng.choice(list(TangentRule), count)
    into = np.where(rules == TangentRule.STEP, TangentRule.FLAT, rules)
    run = make_run(times, rng.normal(size=count), rng.normal(size=count) * 5, rng.normal(size=count) * 5, into, rules)
    return Channel("c", run, **settings)  # type: ignore[arg-type]


def window_of(channel: Channel, t0: float, t1: float, v0: float = -3.0, v1: float = 3.0) -> Window:
    return Window(60.0, 40.0, 1600.0, 900.0, t0, t1, v0, v1)


def distance(x: Floats, y: Floats, line: Line) -> Floats:
    """How far each point lies from the chain, pixels."""
    best = np.full(len(x), np.inf)
    for x0, y0, x1, y1 in zip(line.x[:-1], line.y[:-1], line.x[1:], line.y[1:], strict=True):
        dx, dy = x1 - x0, y1 - y0
        size = dx * dx + dy * dy
        along = np.clip(((x - x0) * dx + (y - y0) * dy) / size, 0, 1) if size else np.zeros(len(x))
        best = np.minimum(best, np.hypot(x - x0 - along * dx, y - y0 - along * dy))
    return best


@pytest.mark.parametrize("zoom", [0.01, 0.3, 1.0, 40.0, 3000.0])
@pytest.mark.parametrize("seed", range(6))
def test_a_line_stays_within_a_quarter_of_a_pixel_of_the_curve(seed: int, zoom: float) -> None:
    channel = random_channel(seed)
    first, last = channel.run()["time"][[0, -1]]
    half, middle = (last - first) / zoom, first + (last - first) * 0.37
    level = channel.value(middle)
    window = window_of(channel, middle - half, middle + half, level - 3 / zoom, level + 3 / zoom)
    line = line_through(channel.spans_between(window.t0, window.t1), window)
    times = np.random.default_rng(seed).uniform(max(first, window.t0), min(last, window.t1), 4000)
    x, y = window.x_from_time(times), window.y_from_value(channel.evaluate(times))
    seen = (y > -500) & (y < 1500)
    assert seen.any()
    assert distance(x[seen], y[seen], line).max() <= TOLERANCE


def test_keys_and_extrema_are_points_of_the_line() -> None:
    run = make_run([0, 1, 2], [0, 0, 1], 0, [8, -3, 0], TangentRule.FIXED, TangentRule.FIXED)
    channel = Channel("c", run)
    window = window_of(channel, -0.1, 2.1)
    line = line_through(channel.spans_between(0, 2), window)
    for time, value in zip(run["time"], run["value"], strict=True):
        assert np.hypot(line.x - window.x_from_time(time), line.y - window.y_from_value(value)).min() < 1e-9
    lowest, highest = channel.extrema()
    assert line.y.min() == pytest.approx(window.y_from_value(highest), abs=1e-9)
    assert line.y.max() == pytest.approx(window.y_from_value(lowest), abs=1e-9)


def test_a_step_is_level_and_then_upright() -> None:
    channel = Channel("c", make_run([0, 1, 2], [0, 1, 1], rules_in=TangentRule.FLAT, rules_out=TangentRule.STEP))
    window = window_of(channel, 0, 2)
    line = line_through(channel.spans_between(0, 2), window)
    moves = {(bool(dx), bool(dy)) for dx, dy in zip(np.diff(line.x), np.diff(line.y), strict=True)}
    assert moves == {(True, False), (False, True)}
    upright = line.x[:-1][(np.diff(line.x) == 0) & (np.diff(line.y) != 0)]
    assert upright == pytest.approx([window.x_from_time(1.0)])


def test_a_part_has_the_points_of_the_whole() -> None:
    channel = random_channel(3, 40)
    window = window_of(channel, 0, 20)
    whole = line_through(channel.spans_between(window.t0, window.t1), window)
    part = line_through(channel.spans_between(6.0, 9.0), window)
    start = np.flatnonzero(np.isclose(whole.x, part.x[0], atol=1e-9))[0]
    of_whole = slice(start, start + len(part.x))
    assert part.x[:-1].tolist() == whole.x[of_whole][:-1].tolist()
    assert part.y[:-1].tolist() == whole.y[of_whole][:-1].tolist()
    assert (part.x[-1], part.y[-1]) == pytest.approx((whole.x[of_whole][-1], whole.y[of_whole][-1]), abs=1e-9)


def test_chains_worked_out_together_are_those_worked_out_alone() -> None:
    channels = [random_channel(seed, 3 + 4 * seed) for seed in range(5)]
    window = Window(60.0, 40.0, 1600.0, 900.0, 0, 20, -1, 1)
    many = [channel.spans_between(1.0, 9.0) for channel in channels]
    for together, spans in zip(lines_through([*many, many[0]], window), [*many, many[0]], strict=True):
        alone = line_through(spans, window)
        assert (together.x.tolist(), together.y.tolist()) == (alone.x.tolist(), alone.y.tolist())


@given(st.floats(-1e300, 1e300), st.floats(-1e300, 1e300), st.floats(-1e300, 1e300), st.floats(1e-12, 1e12))
def test_whatever_the_numbers_qt_gets_only_near_ones(v0: float, v1: float, slope: float, span: float) -> None:
    run = make_run([0, 1], [v0, v1], slope, slope, TangentRule.FIXED, TangentRule.FIXED)
    channel = Channel("c", run, pre=Extrapolation.LINEAR, post=Extrapolation.CYCLE_OFFSET)
    window = Window(60, 40, 1600, 900, -span, span, -span, span)
    lines = [line_through(channel.spans_between(-span, span), window)]
    for after in (False, True):
        spans = spans_outside(channel, -span, span, after=after, most=800)
        if spans is not None:
            lines.append(line_through(spans, window))
    for line in lines:
        assert np.isfinite(line.x).all()
        assert np.isfinite(line.y).all()
        assert np.abs(line.x).max(initial=0) <= FAR
        assert np.abs(line.y).max(initial=0) <= FAR
    for edge in columns(channel, window, 0, 50):
        assert np.abs(edge).max() <= FAR


def test_a_steep_line_keeps_its_slope_where_it_is_cut() -> None:
    line = kept_near(np.array([0.0, 1000.0]), np.array([-1e9, 1e9]), np.array([2]))
    assert np.abs(line.y).max() == FAR
    inside = np.flatnonzero(np.abs(line.y[:-1] - line.y[1:]) == 2 * FAR)
    assert line.x[inside] == pytest.approx([500 - 0.05], abs=1e-6)
    assert line.x[inside + 1] == pytest.approx([500 + 0.05], abs=1e-6)


@pytest.mark.parametrize("after", [False, True])
@pytest.mark.parametrize("mode", list(Extrapolation))
def test_extrapolation_is_drawn_where_it_is_evaluated(mode: Extrapolation, after: bool) -> None:
    channel = random_channel(5, pre=mode, post=mode)
    first, last = channel.run()["time"][[0, -1]]
    t0, t1 = first - 30.0, last + 30.0
    spans = spans_outside(channel, t0, t1, after=after, most=10_000)
    assert spans is not None
    times = np.random.default_rng(1).uniform(*((last, t1) if after else (t0, first)), 3000)
    row = np.searchsorted(spans.time0, times, "right") - 1
    u = (times - spans.time0[row]) / (spans.time1[row] - spans.time0[row])
    drawn = spans.d[row] + u * (spans.c[row] + u * (spans.b[row] + u * spans.a[row]))
    assert (u < 1 + 1e-9).all()
    assert drawn == pytest.approx(channel.evaluate(times), abs=1e-9)


def test_repeats_denser_than_pixels_are_left_to_the_columns() -> None:
    channel = random_channel(5, post=Extrapolation.CYCLE)
    assert spans_outside(channel, 0.0, 1e6, after=True, most=800) is None


@pytest.mark.parametrize("zoom", [1.0, 0.02])
def test_a_column_is_as_high_as_the_curve_in_it(zoom: float) -> None:
    channel = random_channel(9, 3000)
    first, last = channel.run()["time"][[0, -1]]
    window = window_of(channel, first, first + (last - first) * zoom)
    top, bottom = columns(channel, window, 100, 140)
    fine = np.linspace(window.left + 100, window.left + 140, 40 * 1000 + 1)
    y = window.y_from_value(channel.evaluate(window.time_from_x(fine)))
    for j in range(40):
        inside = y[j * 1000 : j * 1000 + 1001]
        assert top[j] <= inside.min() + 1e-6
        assert bottom[j] >= inside.max() - 1e-6
        assert top[j] >= inside.min() - 1.0
        assert bottom[j] <= inside.max() + 1.0


def test_one_spike_among_a_million_keys_reaches_its_pixel_at_every_zoom() -> None:
    count, at = 1_000_000, 617_283
    values = np.zeros(count)
    values[at] = 1.0
    channel = Channel(
        "c", make_run(np.arange(count) / 1000.0, values, rules_in=TangentRule.FLAT, rules_out=TangentRule.FLAT)
    )
    spike = at / 1000.0
    for span in (1000.0, 100.0, 10.0, 1.7):
        window = Window(0, 0, 1600, 900, spike - span * 0.41, spike + span * 0.59, -0.5, 1.5)
        assert keys_in(channel, window) > window.width
        top, _ = columns(channel, window, 0, 1600)
        column = int(window.x_from_time(spike))
        assert top[column] == pytest.approx(window.y_from_value(1.0), abs=1e-6)
        assert (top[np.abs(np.arange(1600) - column) > 1 + 1600 * 0.001 / span] > 300).all()


@pytest.mark.parametrize("pattern", [(5.0, 4.0), (9.0, 3.0, 2.0, 3.0)])
def test_dashes_are_as_long_as_the_pattern_says_and_lie_on_the_line(pattern: tuple[float, ...]) -> None:
    x = np.linspace(0.0, 300.0, 701)
    line = Line(x, 100 + 80 * np.sin(x / 20), np.array([len(x)]))
    pieces = dashes(line, pattern, -1e3, 1e3)
    pieces = pieces[np.argsort(pieces[:, 0])]
    length = np.hypot(pieces[:, 2] - pieces[:, 0], pieces[:, 3] - pieces[:, 1])
    whole = np.hypot(np.diff(line.x), np.diff(line.y)).sum()
    assert length.sum() == pytest.approx(whole * sum(pattern[::2]) / sum(pattern), abs=max(pattern))
    gaps = np.hypot(*(pieces[1:, :2] - pieces[:-1, 2:]).T)
    assert set(np.round(gaps[gaps > 1e-6], 0)) <= set(pattern[1::2])
    assert distance(pieces[:, 0], pieces[:, 1], line).max() < 1e-9


def test_dashes_begin_anew_at_every_key_so_that_edits_move_none_beside_them() -> None:
    run = make_run([0, 1, 2, 3, 4, 5], [0, 1, 0, 1, 0, 1])
    window = Window(0, 0, 600, 400, 0, 5, -1, 2)
    before = dashes(line_through(Channel("c", run).spans_between(0, 5), window), (7.0, 5.0), 0, 400)
    run["value"][1] = 1.5
    after = dashes(line_through(Channel("c", run).spans_between(0, 5), window), (7.0, 5.0), 0, 400)
    right = [pieces[pieces[:, 0] > window.x_from_time(3.001)].tolist() for pieces in (before, after)]
    assert right[0] == right[1] != []


def test_where_no_span_is_seen_there_are_no_dashes() -> None:
    nothing = line_through(
        Channel("c", make_run([0.0, 1.0], [0.0, 1.0])).spans_between(2.0, 3.0), Window(0, 0, 9, 9, 2, 3, 0, 1)
    )
    assert dashes(nothing, (3.0, 4.0), 0.0, 9.0).shape == (0, 4)


def test_a_line_of_a_million_pixels_costs_no_million_dashes() -> None:
    line = Line(np.array([0.0, 1.0]), np.array([-FAR, FAR]), np.array([2]))
    assert len(dashes(line, (3.0, 4.0), 0.0, 900.0)) == pytest.approx(900 / 7, abs=2)
    (pieces,) = straight_dashes(np.array([[0.0, 0.0, 0.5, 1e6, 1e6 + 100]]), 3.0, 4.0, 0.0, 1e6)
    assert len(pieces) == pytest.approx(112 / 7, abs=2)


def test_a_key_set_on_a_straight_line_moves_none_of_its_dashes() -> None:
    rays = np.array([[100.0, 50.0, 0.75, 100.0, 180.0], [140.0, 80.0, 0.75, 140.0, 180.0]])
    pieces, later = straight_dashes(rays, 3.0, 4.0, 13.0, 0.0)
    assert (pieces[:, 1] - 50) == pytest.approx((pieces[:, 0] - 100) * 0.75)
    assert np.hypot(*(pieces[1:-1, 2:] - pieces[1:-1, :2]).T) == pytest.approx(3.0)
    assert pieces[pieces[:, 0] > 140] == pytest.approx(later[later[:, 0] > 140])


@pytest.mark.parametrize("slope", [0.0, 0.3, -7.1])
def test_a_dash_is_the_same_to_the_last_bit_wherever_its_line_begins(slope: float) -> None:
    ends = [(low, 140.0) for low in np.linspace(1.0, 90.0, 41).tolist()]
    whole, *parts = straight_dashes(np.array([(3.3, 1.7, slope, *end) for end in ends]), 3.0, 4.0, 13.1, 0.0)
    for (low, _), part in zip(ends[1:], parts, strict=True):
        inner = part[part[:, 0] > low + 1e-6]
        assert len(inner) > 5
        assert (inner == whole[len(whole) - len(inner) :]).all()


def test_a_narrow_span_is_cut_only_where_it_turns() -> None:
    window = Window(0, 0, 400, 400, 0, 400, -50, 50)
    times, values = [0.0, 1.5, 3.0], [0.0, 10.0, 20.0]
    slopes = {"bends": (1.0, 12.0), "bends back": (1.0, 1.0), "turns": (-30.0, 12.0), "turns twice": (-30.0, -30.0)}
    pieces = {}
    for name, (out, into) in slopes.items():
        run = make_run(times, values, into, out, TangentRule.FIXED, TangentRule.FIXED)
        line = line_through(Channel("c", run).spans_between(0.0, 1.4), window, 0.8)
        pieces[name] = len(line.x) - 1
    assert pieces == {"bends": 1, "bends back": 1, "turns": 2, "turns twice": 3}


@pytest.mark.parametrize("bend", [0.02, 0.3, 1.0])
@pytest.mark.parametrize("shift", np.linspace(-0.4, 0.4, 9).tolist())
def test_both_extrema_of_a_narrow_span_are_points_of_its_chain(bend: float, shift: float) -> None:
    window = Window(0, 0, 400, 400, 0, 400, -50, 50)
    # Its derivative is 0 at two places in the middle, which come near to each other.
    middle, reach = 0.5 + shift * 0.5, 0.2 * bend
    u0, u1 = max(middle - reach, 0.01), min(middle + reach, 0.99)
    a, b, c = 1.0, -1.5 * (u0 + u1), 3.0 * u0 * u1
    large = 30.0 / max(abs(a * u**3 + b * u**2 + c * u) for u in (u0, u1, 1.0))
    columns = (0.0, 0.9, a * large, b * large, c * large, 0.0)
    line = line_through(Spans(*(np.array([number]) for number in columns)), window, 0.8)
    ends = [(a * u**3 + b * u**2 + c * u) * large for u in (u0, u1)]
    if abs(ends[0] - ends[1]) > 1.0:  # else no more than a quarter of a pixel is missing
        for value in ends:
            assert np.abs(line.y - window.y_from_value(value)).min() < 1e-6
    assert (np.diff(line.x) >= 0.0).all()
