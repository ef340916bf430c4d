"""Keys and spans in a box are those that a walk over all of them finds."""

import numpy as np
import pytest

from model.channel import Channel
from model.keyframe import TangentRule
from tests.model.drawn import bits, random_run


def boxes(channel: Channel, n: int) -> list[tuple[float, float, float, float]]:
    """Boxes around random places and around keys, some without any length or height, some beyond all keys."""
    chance = np.random.default_rng(n)
    run = channel.run()
    found = [(-np.inf, np.inf, -np.inf, np.inf), (-9.0, -8.0, -9.0, 9.0), (1e6, 2e6, -9.0, 9.0)]
    for _ in range(60):
        time, value = chance.uniform(-2.0, 2.0 + (run["time"][-1] if len(run) else 1.0)), chance.normal()
        if len(run) and chance.random() < 0.5:
            time, value = chance.choice(run[["time", "value"]]).tolist()
        width, height = chance.choice([0.0, 0.3, 30.0], 2)
        found.append((time - width, time + width, value - height, value + height))
    return found


def after_edits(n: int) -> Channel:
    """A channel whose rows hold unevenly many keys."""
    channel = Channel("x", random_run(n, n))
    for first in range(40, n - 300, 500):
        gone = channel.run()[first : first + 200]
        channel.splice(gone, gone[:0])
    return channel


@pytest.mark.parametrize("n", [0, 1, 2, 30, 2_500])
def test_the_keys_in_a_box_are_those_that_lie_in_it(n: int) -> None:
    channel = after_edits(n)
    run = channel.run()
    for t0, t1, low, high in boxes(channel, n):
        inside = run[(run["time"] >= t0) & (run["time"] <= t1) & (run["value"] >= low) & (run["value"] <= high)]
        times, values, ids = channel.keys_within(t0, t1, low, high)
        assert (bits(times), bits(values)) == (bits(inside["time"]), bits(inside["value"]))
        assert ids.tolist() == inside["id"].tolist()


@pytest.mark.parametrize("n", [0, 1, 2, 30, 2_500])
def test_the_spans_in_a_box_are_those_that_touch_it_and_the_long_ones(n: int) -> None:
    channel = after_edits(n)
    run = channel.run()
    begin, end = run[:-1], run[1:]
    lower, upper = np.minimum(begin["value"], end["value"]), np.maximum(begin["value"], end["value"])
    for t0, t1, low, high in boxes(channel, n):
        for long in (0.0, 0.05, 0.5):
            near = (upper >= low) & (lower <= high) | (end["time"] - begin["time"] > long)
            near &= (end["time"] >= t0) & (begin["time"] <= t1)
            spans = channel.spans_within(t0, t1, low, high, long)
            a, b = begin[near], end[near]
            expected = (a["time"], a["value"], a["slope_out"], b["time"], b["value"], b["slope_in"])
            assert [bits(column) for column in spans[:6]] == [bits(column) for column in expected]
            assert spans.held.tolist() == (a["rule_out"] == TangentRule.STEP).tolist()
