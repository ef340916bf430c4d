"""Evaluation against scipy, pxr.Ts and plain numpy; one value; a pose of many channels."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from pxr import Ts
from scipy.interpolate import CubicHermiteSpline

from model.channel import Channel
from model.clip import Clip
from model.keyframe import make_run
from model.player import Player
from tests.bench.table import Line, timed

MANY = 1_000_000


def a_channel(n: int, seed: int = 0, name: str = "bench") -> Channel:
    """A smooth channel of n keys, about 0.1 s apart."""
    random = np.random.default_rng(seed)
    times = np.cumsum(random.uniform(0.05, 0.15, n))
    return Channel(name, make_run(times, np.cumsum(random.normal(0.0, 0.3, n))))


def as_scipy(channel: Channel) -> CubicHermiteSpline:
    """The same curve, between its keys."""
    run = channel.run()
    return CubicHermiteSpline(run["time"], run["value"], run["slope_out"])


def as_ts(channel: Channel) -> "Ts.Spline":
    """The same curve as a USD spline."""
    spline = Ts.Spline("double")
    spline.SetCurveType(Ts.CurveTypeHermite)
    for time, value, slope_in, slope_out in channel.run()[["time", "value", "slope_in", "slope_out"]].tolist():
        knot = Ts.Knot("double")
        knot.SetTime(time)
        knot.SetValue(value)
        knot.SetPreTanSlope(slope_in)
        knot.SetPostTanSlope(slope_out)
        knot.SetNextInterpolation(Ts.InterpCurve)
        spline.SetKnot(knot)
    return spline


def plain_numpy(channel: Channel) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """searchsorted and Horner over flat columns."""
    run = channel.run()
    t, v, m = (np.ascontiguousarray(run[field]) for field in ("time", "value", "slope_out"))
    h = np.diff(t)
    a = 2 * v[:-1] - 2 * v[1:] + h * (m[:-1] + m[1:])
    b = -3 * v[:-1] + 3 * v[1:] - h * (2 * m[:-1] + m[1:])
    c, d = h * m[:-1], v[:-1]

    def evaluate(times: NDArray[np.float64]) -> NDArray[np.float64]:
        i = np.clip(np.searchsorted(t, times, "right") - 1, 0, len(h) - 1)
        u = (times - t[i]) / h[i]
        return d[i] + u * (c[i] + u * (b[i] + u * a[i]))

    return evaluate


def many_times() -> list[Line]:
    """A million times at once, in any order and in order."""
    lines = []
    for keys in (10, 1_000, 100_000):
        channel = a_channel(keys)
        scipy, numpy = as_scipy(channel), plain_numpy(channel)
        first, last = channel.run()["time"][[0, -1]]
        times = np.random.default_rng(1).uniform(first, last, MANY)
        in_order = np.sort(times)
        taken = timed(
            {
                "ours": lambda c=channel, t=times: c.evaluate(t),
                "scipy": lambda s=scipy, t=times: s(t),
                "ours in order": lambda c=channel, t=in_order: c.evaluate(t),
                "numpy in order": lambda n=numpy, t=in_order: n(t),
                "scipy in order": lambda s=scipy, t=in_order: s(t),
            },
            rounds=9,
        )
        what = f"evaluate 1,000,000 times, {keys:,} keys"
        ours = taken["ours in order"].median
        lines += [
            Line(f"{what}, any order", taken["ours"].median, "scipy PPoly", taken["scipy"].median, 1.0),
            Line(f"{what}, increasing", ours, "searchsorted + Horner", taken["numpy in order"].median, 0.5),
            Line(f"{what}, increasing", ours, "scipy PPoly", taken["scipy in order"].median),
        ]
    return lines


def one_value() -> list[Line]:
    """One value by one call, as a script asks for it."""
    lines = []
    for keys in (10, 1_000, 100_000):
        channel = a_channel(keys)
        spline = as_ts(channel)
        first, last = channel.run()["time"][[0, -1]]
        times = np.random.default_rng(2).uniform(first, last, 20_000).tolist()
        for order, asked in (("any order", times), ("increasing", sorted(times))):
            value, evaluate = channel.value, spline.Eval
            taken = timed(
                {
                    "ours": lambda f=value, t=asked: [f(x) for x in t],
                    "ts": lambda f=evaluate, t=asked: [f(x) for x in t],
                },
                rounds=9,
            )
            n = len(asked)
            work = f"one value by one call, {keys:,} keys, {order}"
            lines.append(Line(work, taken["ours"].median / n, "pxr.Ts Eval", taken["ts"].median / n, 2.0))
    return lines


def poses() -> list[Line]:
    """Playing: a pose of a thousand channels after the other."""
    lines, ours = [], {}
    for keys in (100, 10_000):
        channels = [a_channel(keys, seed, f"c{seed}") for seed in range(1_000)]
        curves = [as_scipy(channel) for channel in channels]
        player = Player(Clip(channels))
        clock = iter(np.arange(0.0, 1e6, 1 / 60).tolist())
        taken = timed(
            {"ours": lambda p=player, c=clock: p.pose(next(c)), "scipy": lambda s=curves: [f(1.25) for f in s]},
            rounds=60,
        )
        ours[keys] = taken["ours"].median
        work = f"a pose of 1,000 channels x {keys:,} keys in sequence"
        lines.append(Line(work, ours[keys], "scipy, channel by channel", taken["scipy"].median, 0.25))
    lines.append(Line("the same, 10,000 keys each", ours[10_000], "ours, 100 keys each", ours[100], 1.5))
    return lines


def run() -> list[Line]:
    """All figures of evaluation."""
    return [*many_times(), *one_value(), *poses()]
