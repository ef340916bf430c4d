"""Numbers by the million: the same text as repr, the same double as float, for each one of them."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from model.channel import Channel
from model.clip import Clip
from model.formats import read_bytes, write_bytes
from model.formats.decimals import quotients, shortest_digits
from model.formats.spelling import MOST_BEFORE, spelled
from model.keyframe import TangentRule, make_run

RANDOM = np.random.default_rng(20)
NEAR = np.array([m * 10.0**e for e in range(-6, 17) for m in (1, 2, 5, 9, 9.5, 9.999999, 9.007199254740993)])
SETS = {
    "normal": RANDOM.normal(size=20_000),
    "frames": np.arange(20_000) / 30,
    "six decimals": np.round(RANDOM.normal(size=20_000), 6),
    "all sizes": np.exp(RANDOM.uniform(-20, 50, 20_000)),
    "all bit patterns": np.nan_to_num(RANDOM.integers(0, 1 << 63, 20_000).view(np.float64)),
    "whole": RANDOM.integers(-(10**9), 10**9, 20_000).astype(np.float64),
    "16 digits": RANDOM.integers(1, 10**16, 20_000) / 10.0 ** RANDOM.integers(2, 16, 20_000),
    "short in binary": RANDOM.integers(1, 1 << 40, 20_000) / 2.0 ** RANDOM.integers(0, 50, 20_000),
    "above 9": RANDOM.uniform(9, 10, 20_000),
    "powers of two": 2.0 ** np.arange(-60, 80),
    "beside powers of two": np.concatenate(
        [power + np.spacing(power) * np.arange(-20, 21) for power in 2.0 ** np.arange(-20, 60)]
    ),
    "zeros": np.array([0.0, -0.0, 1.0, -1.0, 5e-324, 1.7976931348623157e308]),
    "beside round ones": np.concatenate([NEAR + k * np.spacing(NEAR) for k in range(-9, 10)]),
}


BEFORE = [b" ", b" " * MOST_BEFORE]


def texts(numbers: NDArray[np.float64], before: bytes) -> list[str]:
    columns = np.array(spelled(numbers, before))
    return [row.tobytes().replace(b"\0", b"").decode() for row in columns.T]


@pytest.mark.parametrize("before", BEFORE, ids=len)
@pytest.mark.parametrize("numbers", SETS.values(), ids=SETS.keys())
def test_the_text_of_a_number_is_its_repr(numbers: NDArray[np.float64], before: bytes) -> None:
    assert texts(numbers, before) == [before.decode() + repr(number) for number in numbers.tolist()]
    assert texts(-numbers, before) == [before.decode() + repr(-number) for number in numbers.tolist()]


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=20), st.sampled_from(BEFORE))
def test_the_text_of_any_number_is_its_repr(numbers: list[float], before: bytes) -> None:
    assert texts(np.array(numbers), before) == [before.decode() + repr(number) for number in numbers]


@pytest.mark.parametrize("before", BEFORE, ids=len)
@pytest.mark.parametrize("whole", [0, 999, 9_999, 10_000, 999_999, 9_999_999, 10_000_000, 10_009_999, 99_999_999])
def test_the_text_of_a_number_does_not_hang_on_its_neighbours(whole: int, before: bytes) -> None:
    for number in (float(whole), whole + 0.5, -whole - 0.0625):
        assert texts(np.array([number]), before) == [before.decode() + repr(number)]


def test_few_numbers_are_spelled_one_by_one() -> None:
    easy = np.concatenate([numbers[(np.abs(numbers) >= 1e-4) & (np.abs(numbers) < 1e8)] for numbers in SETS.values()])
    places = 16 - np.floor(np.log10(np.abs(easy))).astype(np.int64)
    _, certain = shortest_digits(np.abs(easy), places)
    assert certain.mean() > 0.99


def read_as_values(words: list[str]) -> list[float]:
    keys = "".join(f"{i} {word} flat {word}\n" for i, word in enumerate(words))
    head = f"animation {{ range 0 1 numchannels 1 channel {{ extrapolate constant constant keys {len(words)} {{\n"
    run = read_bytes(f"{head}{keys} }} }} }}".encode(), "x").channels[0].run()
    assert run["slope_out"].tobytes() == run["value"].tobytes()
    return run["value"].tolist()


@pytest.mark.parametrize("numbers", SETS.values(), ids=SETS.keys())
def test_a_number_reads_back_as_the_same_double(numbers: NDArray[np.float64]) -> None:
    assert np.array(read_as_values(list(map(repr, numbers.tolist())))).tobytes() == numbers.tobytes()


DECIMALS = st.from_regex(r"\A[+-]?([0-9]{1,25}(\.[0-9]{0,25})?|\.[0-9]{1,25})([eE][+-]?[0-9]{1,2})?\Z")


@given(st.lists(DECIMALS, min_size=1, max_size=20))
def test_any_decimal_reads_as_the_nearest_double(words: list[str]) -> None:
    expected = [float(word).hex() for word in words]
    assert list(map(float.hex, read_as_values(words))) == expected
    again = 1000 // len(words)  # enough of them to be read by column
    assert list(map(float.hex, read_as_values(words * again))) == expected * again


def test_decimals_with_more_digits_than_a_double_has_are_rounded_right() -> None:
    digits = "12345678901234567890123456"
    words = [
        f"{whole}.{'0' * zeros}{digits[:count]}" for whole in (0, 7) for zeros in range(10) for count in range(1, 27)
    ]
    words += [f"{digits[:count]}{tail}" for count in range(1, 27) for tail in ("", ".", ".5", ".0000001")]
    words += [f"-{word}" for word in words]
    assert read_as_values(words * 10) == list(map(float, words * 10))


def test_decimals_half_way_between_two_doubles_are_rounded_right() -> None:
    words = [f"{k}.{half}" for k in range(1 << 20, (1 << 20) + 2000) for half in ("00000000011641532", "5000000000116")]
    words += [repr(float(number)) + "5" for number in RANDOM.uniform(1, 2, 5000)]
    assert read_as_values(words) == list(map(float, words))


def test_a_division_of_integers_is_certain_nearly_everywhere_and_then_right() -> None:
    digits = RANDOM.integers(0, 10**18, 20_000) // 10 ** RANDOM.integers(0, 19, 20_000)
    places = RANDOM.integers(0, 23, 20_000)
    values, certain = quotients(digits, places)
    right = np.array([int(d) / 10 ** int(p) for d, p in zip(digits, places, strict=True)])
    assert values[certain].tolist() == right[certain].tolist()
    assert certain[right < 2.0**52].mean() > 0.99


def test_a_division_near_a_power_of_two_is_right_where_it_is_certain() -> None:
    powers = np.repeat(2.0 ** np.arange(-20, 28), 1000)
    places = np.minimum(17 - np.floor(np.log10(powers)).astype(np.int64), 22)
    digits = [int(Fraction(power) * 10 ** int(p)) for power, p in zip(powers, places, strict=True)]
    digits = np.array(digits) + np.tile(np.arange(-500, 500) // 4, 48)
    values, certain = quotients(digits, places)
    right = np.array([int(d) / 10 ** int(p) for d, p in zip(digits, places, strict=True)])
    assert values[certain].tolist() == right[certain].tolist()
    assert certain.mean() > 0.6


@pytest.mark.parametrize("format_name", ["anim", "hermite"])
def test_a_clip_longer_than_what_is_worked_on_at_once_comes_back(format_name: str) -> None:
    n = 30_000
    rules = RANDOM.choice([TangentRule.FLAT, TangentRule.SMOOTH, TangentRule.FIXED], n)
    slopes = np.where(rules == TangentRule.FIXED, RANDOM.normal(size=n), 0.0)
    run = make_run(np.arange(n) / 24, RANDOM.normal(size=n), slopes, slopes, rules, rules, False)
    again = read_bytes(write_bytes(Clip([Channel("c", run)]), format_name), "x").channels[0].run()
    fixed = rules == TangentRule.FIXED
    for field in ("time", "value", "rule_in", "rule_out", "broken"):
        assert again[field].tobytes() == run[field].tobytes()
    assert again["slope_in"][fixed].tobytes() == slopes[fixed].tobytes()
