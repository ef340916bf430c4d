"""The channels of the research, compared there with five evaluators of others."""

import json
from functools import cache
from typing import Any

import numpy as np
import pytest

from model.channel import Channel
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule, make_run
from model.tangents import slopes_of
from tests.conftest import SHARED

GOLDEN = SHARED / "golden" / "channels.json"
MODES = {
    "constant": Extrapolation.CONSTANT,
    "linear": Extrapolation.LINEAR,
    "cyclic": Extrapolation.CYCLE,
    "cyclic_offset": Extrapolation.CYCLE_OFFSET,
    "bounce": Extrapolation.BOUNCE,
}

pytestmark = pytest.mark.skipif(not GOLDEN.exists(), reason="the shared golden channels are not beside the checkout")


@cache
def golden() -> dict[str, Any]:
    loaded: dict[str, Any] = json.loads(GOLDEN.read_text(encoding="utf-8"))
    return loaded


def channel_of(case: dict[str, Any]) -> Channel:
    columns = np.array(case["keys"], float).reshape(-1, 5).T
    rules_out = np.where(columns[4] != 0, TangentRule.STEP, TangentRule.FIXED)
    run = make_run(*columns[:4], TangentRule.FIXED, rules_out)
    return Channel(case["id"], run, pre=MODES[case["pre"]], post=MODES[case["post"]])


def wrong_samples(case: dict[str, Any], values: np.ndarray) -> list[str]:
    wrong = []
    for j, (value, expected) in enumerate(zip(values.tolist(), case["expected"], strict=True)):
        welcome = [expected]
        if case["conv"][j] == "join_float":
            welcome += [case[name][j] for name in ("left", "right", "alt") if case[name][j] is not None]
        if not any(abs(value - other) <= 1e-9 * max(case["scale"], abs(other)) for other in welcome):
            wrong.append(f"{case['id']} at {case['t'][j]!r} ({case['kind'][j]}): {value!r}, not {expected!r}")
    return wrong


def test_golden_channels_have_their_exact_values() -> None:
    wrong = []
    for case in golden()["cases"]:
        channel = channel_of(case)
        channel.check()
        wrong += wrong_samples(case, channel.evaluate(case["t"]))
    assert len(golden()["cases"]) == 439
    assert not wrong


def test_golden_channels_have_the_same_values_one_by_one() -> None:
    for case in golden()["cases"]:
        channel = channel_of(case)
        one_by_one = np.array([channel.value(time) for time in case["t"]])
        assert one_by_one.tobytes() == channel.evaluate(case["t"]).tobytes(), case["id"]


def test_golden_tangents() -> None:
    cases = golden()["tangent_cases"]
    assert len(cases) == 40
    for case in cases:
        times, values = np.array(case["times"]), np.array(case["values"])
        n = len(times)
        for rule, slope_in, slope_out in (
            (TangentRule.LINEAR, "linear_in", "linear_out"),
            (TangentRule.SMOOTH, "smooth", "smooth"),
        ):
            rules = np.full(n, rule, np.uint8)
            found = slopes_of(times, values, np.zeros(n), np.zeros(n), rules, rules)
            for name, slopes in ((slope_in, found[0]), (slope_out, found[1])):
                expected = np.array(case[name])
                assert np.abs(slopes - expected) == pytest.approx(0, abs=1e-9 * max(1.0, np.abs(expected).max()))
                assert np.allclose(slopes, expected, rtol=1e-9, atol=0.0), (case["id"], name)
