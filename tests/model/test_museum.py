"""The museum against values worked out in rational numbers, and against pxr.Ts where it is installed."""

import json
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from model.channel import Channel
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule
from tests.exact import BASELINES, exact_channel, museum_samples, sample_times, scale_of
from tests.museum import museum

SAMPLES: dict[str, list[list[str]]] = json.loads(BASELINES.read_text(encoding="utf-8"))
MUSEUM = museum()


def samples(name: str) -> tuple[np.ndarray, np.ndarray]:
    pairs = np.array([[float(time), float(value)] for time, value in SAMPLES[name]]).reshape(-1, 2)
    return pairs[:, 0], pairs[:, 1]


def test_the_museum_is_large_enough_and_every_channel_has_its_baseline() -> None:
    assert len(MUSEUM) >= 40
    assert set(SAMPLES) == set(MUSEUM)


def test_baselines_are_those_of_the_exact_evaluator() -> None:
    assert museum_samples() == SAMPLES, "run python -m tests.exact if the museum was meant to change"


@pytest.mark.parametrize("name", MUSEUM)
def test_channels_of_the_museum_have_their_exact_values(name: str) -> None:
    channel, (times, expected) = MUSEUM[name], samples(name)
    channel.check()
    values = channel.evaluate(times)
    assert np.isfinite(values).all()
    scale = max(scale_of(exact_channel(channel)), 1e-300)
    ends = channel.ends()
    outside = (times < ends.time0) | (times > ends.time1) if ends else np.zeros(len(times), bool)
    # Halves, since the difference of two huge values may be too large for a double.
    error = np.abs(0.5 * values - 0.5 * expected)
    assert (error <= np.where(outside, 1e-9, 1e-12) * np.maximum(0.5 * scale, 0.5 * np.abs(expected))).all()


@pytest.mark.parametrize("name", MUSEUM)
def test_channels_of_the_museum_give_the_same_bits_one_by_one(name: str) -> None:
    channel, (times, _) = MUSEUM[name], samples(name)
    assert np.array([channel.value(time) for time in times.tolist()]).tobytes() == channel.evaluate(times).tobytes()


# --- pxr.Ts


def ts_spline(ts: Any, channel: Channel) -> Any:
    """The same channel as a spline of pxr.Ts; its `linear` has the inward slope, so ours is given as `sloped`."""
    modes = {
        Extrapolation.CONSTANT: ts.ExtrapHeld,
        Extrapolation.LINEAR: ts.ExtrapSloped,
        Extrapolation.CYCLE: ts.ExtrapLoopReset,
        Extrapolation.CYCLE_OFFSET: ts.ExtrapLoopRepeat,
        Extrapolation.BOUNCE: ts.ExtrapLoopOscillate,
    }
    spline = ts.Spline("double")
    spline.SetCurveType(ts.CurveTypeHermite)
    for key in channel:
        knot = ts.Knot("double")
        knot.SetTime(key.time)
        knot.SetValue(key.value)
        knot.SetPreTanSlope(key.slope_in)
        knot.SetPostTanSlope(key.slope_out)
        held = key.rule_out is TangentRule.STEP
        knot.SetNextInterpolation(ts.InterpHeld if held else ts.InterpCurve)
        spline.SetKnot(knot)
    ends = channel.ends()
    assert ends
    for mode, slope, give in (
        (channel.pre, ends.slope0, spline.SetPreExtrapolation),
        (channel.post, ends.slope1, spline.SetPostExtrapolation),
    ):
        extrapolation = ts.Extrapolation(modes[mode])
        extrapolation.slope = slope
        give(extrapolation)
    return spline


# Ts adds and multiplies without regard to overflow.
FOR_TS = [
    name
    for name, channel in MUSEUM.items()
    if 2 <= len(channel) < 100 and "huge" not in name and "denormal" not in name
]


@pytest.mark.parametrize("name", FOR_TS)
def test_pxr_ts_agrees(name: str) -> None:
    ts = pytest.importorskip("pxr.Ts", reason="usd-core is not installed")
    channel = MUSEUM[name]
    exact = exact_channel(channel)
    spline, scale = ts_spline(ts, channel), scale_of(exact)
    compared = 0
    for time in sample_times(exact):
        # On keys, their images and joins, where the curve may jump, Ts has conventions of its own.
        place, _ = exact.folded(Fraction(time))
        if all(abs(place - key) > (exact.times[-1] - exact.times[0]) / 10**9 for key in exact.times):
            assert channel.value(time) == pytest.approx(spline.Eval(time), abs=1e-9 * scale, rel=1e-9), time
            compared += 1
    assert compared or name == "neighbouring doubles"
