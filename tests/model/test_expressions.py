"""What may be typed into a number field, and what it does to the numbers of many keys."""

import math
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from model.expressions import FUNCTIONS, ExpressionError, Formula

NUMBERS = np.array([1.0, 2.0, 4.0])
TIMES = np.array([0.5, 1.0, 2.5])


def applied(text, numbers=NUMBERS, times=TIMES, values=NUMBERS):
    return Formula(text)(np.asarray(numbers, float), times, values).tolist()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("5", [5, 5, 5]),
        ("  -2.5e-1 ", [-0.25] * 3),
        ("3/4", [0.75] * 3),
        ("= 3", [3, 3, 3]),
        ("+=10", [11, 12, 14]),
        ("-= 1", [0, 1, 3]),
        ("*=1.5", [1.5, 3, 6]),
        ("/=2", [0.5, 1, 2]),
        ("v*0.5 + t", [1.0, 2.0, 4.5]),
        ("x - first", [0, 1, 3]),
        ("last - x", [3, 2, 0]),
        ("(x-min)/(max-min)", [0, 1 / 3, 1]),
        ("i", [0, 1, 2]),
        ("i/n", [0, 1 / 3, 2 / 3]),
        ("u", [0, 0.25, 1]),
        ("lerp(10, 20, u)", [10, 12.5, 20]),
        ("max(x, 2)", [2, 2, 4]),
        ("clamp(x, 1.5, 3)", [1.5, 2, 3]),
        ("2^3", [8, 8, 8]),
        ("2*3^2", [18, 18, 18]),
        ("-x % 3", [2, 1, 2]),
        ("x // 2", [0, 1, 2]),
        ("round(x / 3)", [0, 1, 1]),
        ("deg(pi)", [180] * 3),
        ("90°", [90] * 3),
        ("2 × −3", [-6] * 3),
        ("12 ÷ 4", [3] * 3),
    ],
)
def test_a_formula_sets_the_numbers_of_all_keys(text, expected):
    assert applied(text) == pytest.approx(expected, abs=0, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "number"), [("0,5", 0.5), ("+=0,25", 1.25), ("12,75", 12.75), ("0,125", 0.125), (",5", 0.5)]
)
def test_a_decimal_comma_is_taken_where_it_can_mean_nothing_else(text, number):
    assert applied(text, [1.0], np.zeros(1))[0] == number


@pytest.mark.parametrize("text", ["1,234", "1.234,5", "1,234.5", "12,345,678"])
def test_a_comma_that_may_group_thousands_is_asked_about(text):
    with pytest.raises(ExpressionError, match="comma"):
        Formula(text)


def test_a_comma_between_the_arguments_of_a_function_stays_one():
    assert applied("max(1,234)", [0.0], np.zeros(1)) == [234.0]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "   ",
        "+=",
        "junk+",
        "().__class__.__bases__",
        '__import__("os")',
        "v.real",
        "v[0]",
        "lambda: 1",
        "[x for x in v]",
        "'a'*10**10",
        'f"{v}"',
        "1<<10",
        "1 if t else 2",
        "True",
        "3j",
        "5; 6",
        "x := 3",
        "min(x)",
        "sin(x, x)",
        "abs(x=1)",
        "max(*v)",
        "getattr(v, t)",
        "(" * 200,
        "-" * 60 + "1",
        "+".join("1" * 100),
        "1" * 257,
        "max(max(max(max(1,1),max(1,1)),max(max(1,1),max(1,1))),max(max(max(1,1),max(1,1)),max(max(1,1),max(1,1))))+1+1",
        "١٢",
        "1\x00",
        "1\u202e2",
        "0_or 1",
        "1e999",
        "(0,5)",
    ],
)
def test_what_is_no_formula_is_refused_before_it_is_applied(text):
    with pytest.raises(ExpressionError):
        Formula(text)


@pytest.mark.parametrize(
    "text", ["1/0", "x/(x-1)", "9**9**9**9", "10.0**10**10", "sqrt(-1)", "log(0)", "/=0", "1e308*10"]
)
def test_a_result_that_is_not_finite_is_refused_as_a_whole(text):
    with pytest.raises(ExpressionError, match="finite"):
        applied(text)


@pytest.mark.parametrize("text", ["9**9**9", "10**10**10", "9**9**9**9", "x**x**x**x**x**x**x"])
def test_giant_powers_cost_no_time(text):
    start = time.perf_counter()
    with pytest.raises(ExpressionError):
        applied(text)
    assert time.perf_counter() - start < 0.05


def test_an_unknown_name_is_told_together_with_those_known():
    with pytest.raises(ExpressionError, match=r"unknown name “frame”; known here: .*first"):
        applied("frame*2")
    with pytest.raises(ExpressionError, match="unknown name “t”"):
        Formula("t")(np.ones(2))


def test_the_numbers_given_are_not_written_to():
    numbers = NUMBERS.copy()
    Formula("x")(numbers)[0] = 99
    Formula("+=1")(numbers)
    assert_array_equal(numbers, NUMBERS)


def test_a_number_is_taken_to_the_last_bit():
    for number in (0.1, math.pi, 1e-300, 123456789.123456789, 5e-324):
        assert applied(repr(number), [0.0], np.zeros(1)) == [number]


def test_one_key_and_no_key_are_numbers_too():
    assert applied("lerp(3, 9, u)", [1.0], np.array([7.0])) == [3.0]
    assert applied("+=1", [], np.array([]), np.array([])) == []


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_takes_as_many_numbers_as_it_says(name):
    function, count = FUNCTIONS[name]
    result = applied(f"{name}({', '.join(['x/4'] * count)})")
    assert result == pytest.approx(function(*[NUMBERS / 4] * count))


@settings(max_examples=400, deadline=None)
@given(st.text(alphabet="0123456789.,+-*/=^%()xtvinu ehlrpsmafc_", max_size=40))
def test_any_text_gives_finite_numbers_or_one_kind_of_error(text):
    try:
        result = Formula(text)(NUMBERS, TIMES, NUMBERS)
    except ExpressionError:
        return
    assert result.shape == NUMBERS.shape
    assert np.isfinite(result).all()
