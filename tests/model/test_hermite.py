"""One span: its coefficients, values, slopes, cuts, turns and bends."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model import hermite

numbers = st.floats(-1e3, 1e3)
places = st.floats(0.0, 1.0)


@given(st.floats(1e-3, 1e3), numbers, numbers, numbers, numbers)
def test_a_span_has_its_keys_values_and_slopes_at_its_ends(
    d_time: float, value0: float, value1: float, slope0: float, slope1: float
) -> None:
    a, b, c = hermite.coefficients(d_time, value0, value1, slope0, slope1)
    scale = abs(value0) + abs(value1) + d_time * (abs(slope0) + abs(slope1)) + 1.0
    assert hermite.value(0.0, a, b, c, value0) == value0
    assert hermite.value(1.0, a, b, c, value0) == pytest.approx(value1, abs=1e-14 * scale)
    assert hermite.slope(0.0, a, b, c, d_time) == pytest.approx(slope0, abs=1e-14 * scale / d_time)
    assert hermite.slope(1.0, a, b, c, d_time) == pytest.approx(slope1, abs=2e-14 * scale / d_time)


def test_the_formulas_of_the_definition() -> None:
    # a = 2p0 - 2p1 + dt(m0 + m1), b = -3p0 + 3p1 - dt(2m0 + m1), c = dt m0
    assert hermite.coefficients(2.0, 1.0, 4.0, 0.5, 3.0) == (1.0, 1.0, 1.0)
    assert hermite.coefficients(0.5, -1.0, 2.0, 8.0, -2.0) == (-3.0, 2.0, 4.0)


def test_numbers_and_arrays_have_the_same_bits() -> None:
    chance = np.random.default_rng(1)
    columns = chance.normal(size=(5, 1000)) * np.array([[1], [1e3], [1e-3], [7], [1e5]])
    many = np.array(hermite.coefficients(*columns))
    one_by_one = np.array([hermite.coefficients(*column) for column in columns.T.tolist()]).T
    assert many.tobytes() == one_by_one.tobytes()


@given(st.floats(0.1, 10.0), numbers, numbers, numbers, numbers, st.floats(0.05, 0.95), places)
def test_a_cut_keeps_the_shape(
    d_time: float, value0: float, value1: float, slope0: float, slope1: float, u: float, at: float
) -> None:
    whole = hermite.coefficients(d_time, value0, value1, slope0, slope1)
    cut = hermite.subdivided(u, *whole, value0, d_time)
    left = hermite.coefficients(u * d_time, value0, cut.value, slope0, cut.slope)
    right = hermite.coefficients((1.0 - u) * d_time, cut.value, value1, cut.slope, slope1)
    scale = abs(value0) + abs(value1) + d_time * (abs(slope0) + abs(slope1)) + 1.0
    assert hermite.value(at, *left, value0) == pytest.approx(hermite.value(at * u, *whole, value0), abs=1e-12 * scale)
    assert hermite.value(at, *right, cut.value) == pytest.approx(
        hermite.value(u + at * (1.0 - u), *whole, value0), abs=1e-12 * scale
    )


@pytest.mark.parametrize(
    ("a", "b", "c", "turns"),
    [
        (0.0, 0.0, 0.0, []),
        (0.0, 0.0, 1.0, []),
        (0.0, -1.0, 1.0, [0.5]),
        (0.0, 1.0, -1.5, [0.75]),
        (1.0, -1.5, 0.5, [0.5 - 12**-0.5, 0.5 + 12**-0.5]),
        (-2.0, 3.0, 0.0, []),
        (4.0, -6.0, 2.25, [0.25, 0.75]),
        (1.0, 0.0, -0.75, [0.5]),
        (1.0, 1.0, 1.0, []),
        (1e-300, -1e-300, 0.0, [2 / 3]),
        (1e300, -1e300, 0.0, [2 / 3]),
        (1e-20, -1.0, 1.0, [0.5]),
    ],
)
def test_a_span_turns_where_its_slope_is_zero(a: float, b: float, c: float, turns: list[float]) -> None:
    found = np.array(hermite.extremum_places(np.array([a]), np.array([b]), np.array([c]))).reshape(-1)
    assert found[~np.isnan(found)] == pytest.approx(turns, rel=1e-12)


@given(numbers, numbers, numbers)
def test_no_value_lies_beyond_the_turns_and_the_ends(a: float, b: float, c: float) -> None:
    u = np.linspace(0.0, 1.0, 301)
    values = hermite.value(u, np.float64(a), np.float64(b), np.float64(c), np.float64(0.0))
    turns = np.array(hermite.extremum_places(np.array([a]), np.array([b]), np.array([c]))).reshape(-1)
    special = hermite.value(np.append(turns, [0.0, 1.0]), np.float64(a), np.float64(b), np.float64(c), np.float64(0.0))
    slack = 1e-13 * (abs(a) + abs(b) + abs(c))
    assert values.max() <= np.nanmax(special) + slack
    assert values.min() >= np.nanmin(special) - slack


def test_a_span_bends_the_other_way_at_its_inflection() -> None:
    found = hermite.inflection_places(np.array([1.0, 2.0, 0.0, -2.0]), np.array([-1.5, 0.0, 1.0, 9.0]))
    assert found[0] == 0.5
    assert np.isnan(found[1:]).all()


@pytest.mark.parametrize("size", [1e-310, 1e-200, 1.0, 1e150, 1e300])
def test_scaled_spans_hold_what_plain_ones_cannot(size: float) -> None:
    times = np.zeros(1), np.full(1, 3.0)
    values = np.array([0.5 * size]), np.array([-1.5 * size])
    slopes = np.array([0.25 * size]), np.array([size])
    spans = hermite.scaled(*times, *values, *slopes)
    expected = hermite.value(0.375, *hermite.coefficients(3.0, 0.5, -1.5, 0.25, 1.0), 0.5) * size
    assert spans.value(np.array([0.375]))[0] == pytest.approx(expected, rel=1e-12, abs=0.0)


def test_a_span_too_long_for_a_double_keeps_its_digits() -> None:
    times = np.array([-1.5e308]), np.array([1.5e308])
    spans = hermite.scaled(*times, *(np.array([x]) for x in (1e-10, 3e-10, 0.0, 0.0)))
    u = hermite.places(np.array([0.0]), *times)
    assert u[0] == 0.5
    assert spans.value(u)[0] == pytest.approx(2e-10, rel=1e-15, abs=0.0)


def test_what_no_double_can_hold_becomes_the_largest() -> None:
    spans = hermite.scaled(*(np.array([x]) for x in (0.0, 1e9, 1e308, 1e308, 1e308, -1e308)))
    assert spans.value(np.array([0.5]))[0] == hermite.LARGEST
    assert hermite.finite(np.array([np.inf, -np.inf, 1.0])).tolist() == [hermite.LARGEST, -hermite.LARGEST, 1.0]
