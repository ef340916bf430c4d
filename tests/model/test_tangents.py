"""The tangent rules: a table, the slopes it gives, and the same bits for one key as for many."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.channel import Channel
from model.hermite import LARGEST, Floats
from model.keyframe import TangentRule, make_run
from model.tangents import TANGENT_RULES, slope_between, slope_pair, slopes_of
from tests.model.drawn import bits, finite, quarters

SIDES = [(rule, side) for rule, row in TANGENT_RULES.items() for side in row.sides]


def slopes(times: list[float], values: list[float], rule: TangentRule, side: str) -> Floats:
    """The slopes when every key has *rule* on *side*; the slopes given are 9."""
    n = len(times)
    rules = np.full(n, rule, np.uint8)
    flat = np.zeros(n, np.uint8)
    given = np.full(n, 9.0)
    both = slopes_of(
        np.array(times), np.array(values), given, given, *((rules, flat) if side == "in" else (flat, rules))
    )
    return both[side == "out"]


def test_every_rule_has_a_row_and_a_word() -> None:
    assert list(TANGENT_RULES) == list(TangentRule)
    for rule, row in TANGENT_RULES.items():
        assert row.label.lower() == rule.word
        assert row.tip
        assert TangentRule.from_word(rule.word) is rule
        assert (row.slope_in is None) == (row.key_slope_in is None)
        assert (row.slope_out is None) == (row.key_slope_out is None)
    assert TANGENT_RULES[TangentRule.STEP].sides == ("out",)


def test_numbers_of_rules_never_change() -> None:
    assert [(rule.word, int(rule)) for rule in TangentRule] == [
        ("flat", 0),
        ("linear", 1),
        ("smooth", 2),
        ("fixed", 3),
        ("step", 4),
        ("auto", 5),
    ]
    for word in ("", "Flat", "smooth ", "cubic"):
        with pytest.raises(ValueError, match="known: flat, linear"):
            TangentRule.from_word(word)


TIMES, VALUES = [0.0, 1.0, 3.0, 4.0], [0.0, 2.0, 1.0, 7.0]
EXPECTED = {
    ("flat", "in"): [0.0, 0.0, 0.0, 0.0],
    ("flat", "out"): [0.0, 0.0, 0.0, 0.0],
    ("linear", "in"): [2.0, 2.0, -0.5, 6.0],
    ("linear", "out"): [2.0, -0.5, 6.0, 6.0],
    ("smooth", "in"): [2.0, 1 / 3, 5 / 3, 6.0],
    ("smooth", "out"): [2.0, 1 / 3, 5 / 3, 6.0],
    ("fixed", "in"): [9.0, 9.0, 9.0, 9.0],
    ("fixed", "out"): [9.0, 9.0, 9.0, 9.0],
    ("step", "out"): [0.0, 0.0, 0.0, 0.0],
    ("auto", "in"): [2.0, 0.0, 0.0, 6.0],
    ("auto", "out"): [2.0, 0.0, 0.0, 6.0],
}


@pytest.mark.parametrize(("rule", "side"), SIDES)
def test_slopes_by_rule(rule: TangentRule, side: str) -> None:
    assert slopes(TIMES, VALUES, rule, side).tolist() == pytest.approx(EXPECTED[rule.word, side], rel=1e-15)


@pytest.mark.parametrize(("rule", "side"), SIDES)
def test_a_lone_key_is_level_unless_its_slope_was_given(rule: TangentRule, side: str) -> None:
    assert slopes([5.0], [3.0], rule, side).tolist() == [9.0 if rule is TangentRule.FIXED else 0.0]


@pytest.mark.parametrize(("rule", "side"), SIDES)
@given(data=st.data())
def test_one_key_has_the_bits_that_many_have(rule: TangentRule, side: str, data: st.DataObject) -> None:
    numbers = data.draw(st.sampled_from([quarters, finite]))
    times = sorted(data.draw(st.lists(numbers, min_size=1, max_size=5, unique=True)))
    values = data.draw(st.lists(numbers, min_size=len(times), max_size=len(times)))
    many = slopes(times, values, rule, side)
    assert np.isfinite(many).all()
    for i in range(len(times)):
        j = max(i - 1, 0)
        rules = (rule, TangentRule.FLAT) if side == "in" else (TangentRule.FLAT, rule)
        pair = slope_pair(times[j : i + 2], values[j : i + 2], i - j, *rules, 9.0, 9.0)
        assert bits(pair[side == "out"]) == bits(many[i])


@pytest.mark.parametrize(
    ("values", "slope"),
    [
        ([0.0, 1.0, 3.0], 1.5),  # rising: as smooth
        ([0.0, 1.0, 0.5], 0.0),  # a hilltop
        ([0.0, 1.0, 1.0], 0.0),  # the edge of a plateau
        ([0.0, 0.1, 9.0], 0.3),  # steep after gentle: three times the gentle chord
        ([0.0, -8.9, -9.0], -0.3),
    ],
)
def test_auto_never_swings_past_the_keys(values: list[float], slope: float) -> None:
    assert slopes([0.0, 1.0, 2.0], values, TangentRule.AUTO, "in")[1] == pytest.approx(slope)


@given(st.lists(st.integers(-50, 50), min_size=2, max_size=8), st.data())
def test_auto_curves_stay_between_neighbouring_values(values: list[int], data: st.DataObject) -> None:
    gaps = data.draw(st.lists(st.sampled_from([0.1, 1.0, 7.0]), min_size=len(values), max_size=len(values)))
    times = np.cumsum(gaps)
    channel = Channel("x", make_run(times, values, 0, 0, TangentRule.AUTO, TangentRule.AUTO))
    for t0, t1, v0, v1 in zip(times, times[1:], values, values[1:], strict=False):
        found = channel.evaluate(np.linspace(t0, t1, 40))
        assert found.min() >= min(v0, v1) - 1e-9
        assert found.max() <= max(v0, v1) + 1e-9


def test_slopes_too_steep_for_a_double_are_the_largest() -> None:
    assert slope_between(0.0, -1e308, 1e-9, 1e308) == LARGEST
    assert slope_between(0.0, 1.0, 5e-324, -1.0) == -LARGEST
    assert slope_between(-1.5e308, 0.0, 1.5e308, 3.0) == pytest.approx(1e-308)
    assert slope_between(0.0, -1.5e308, 2.0, 1.5e308) == pytest.approx(1.5e308)
    assert slope_between(-1e308, -1e308, 1e308, 1e308) == pytest.approx(1.0)
