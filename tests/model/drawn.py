"""Channels that Hypothesis draws."""

from typing import Any

import numpy as np
from hypothesis import strategies as st

from model.channel import Channel
from model.extrapolation import Extrapolation
from model.keyframe import Run, TangentRule, make_run

OUT_RULES = list(TangentRule)
IN_RULES = [rule for rule in TangentRule if rule != TangentRule.STEP]

# Quarters are exact in a double, so that keys, joins and images of keys meet exactly; the others do not.
quarters = st.integers(-400, 400).map(lambda n: n / 4.0)
finite = st.floats(allow_nan=False, allow_infinity=False)
ordinary = st.floats(-1e6, 1e6).map(lambda x: x + 0.0)
modes = st.sampled_from(list(Extrapolation))


@st.composite
def runs(draw: Any, times: Any = quarters, values: Any = ordinary, *, least: int = 0, most: int = 8) -> Run:
    """Keys in order with any rules; times and values from the strategies given."""
    at = sorted(draw(st.lists(times, min_size=least, max_size=most, unique=True)))
    n = len(at)
    columns = [draw(st.lists(values, min_size=n, max_size=n)) for _ in range(3)]
    rules_in = draw(st.lists(st.sampled_from(IN_RULES), min_size=n, max_size=n))
    rules_out = draw(st.lists(st.sampled_from(OUT_RULES), min_size=n, max_size=n))
    return make_run(at, columns[0], columns[1], columns[2], rules_in, rules_out)


@st.composite
def channels(draw: Any, times: Any = quarters, values: Any = ordinary, *, least: int = 0, most: int = 8) -> Channel:
    """Channels of drawn keys with any extrapolation."""
    return Channel("drawn", draw(runs(times, values, least=least, most=most)), pre=draw(modes), post=draw(modes))


def random_run(seed: int, n: int, start: float = 0.0) -> Run:
    """n keys, unevenly apart, with any rules; the same for the same seed."""
    chance = np.random.default_rng(seed)
    times = start + np.cumsum(chance.choice([0.01, 0.1, 1.0], n) * chance.uniform(0.2, 1.0, n))
    return make_run(
        times,
        chance.normal(size=n),
        chance.normal(size=n) * 3.0,
        chance.normal(size=n) * 3.0,
        chance.choice(IN_RULES, n),
        chance.choice(OUT_RULES, n),
    )


def bits(numbers: Any) -> bytes:
    """The doubles themselves: -0.0 is not 0.0."""
    return np.asarray(numbers, np.float64).tobytes()
