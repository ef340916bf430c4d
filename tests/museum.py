"""A museum of named channels: every rule, every extrapolation, and whatever once made a curve editor stumble."""

import math
import random
from collections.abc import Callable, Sequence

from model.channel import Channel
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule, make_run

_ROOMS: dict[str, Callable[[], Channel]] = {}

FLAT, LINEAR, SMOOTH = TangentRule.FLAT, TangentRule.LINEAR, TangentRule.SMOOTH
FIXED, STEP, AUTO = TangentRule.FIXED, TangentRule.STEP, TangentRule.AUTO


def museum() -> dict[str, Channel]:
    """All channels by name, new ones at each call."""
    return {name: make() for name, make in _ROOMS.items()}


def _shown(
    name: str,
    times: Sequence[float],
    values: Sequence[float],
    rules_in: Sequence[int] | int = SMOOTH,
    rules_out: Sequence[int] | int | None = None,
    slopes_in: Sequence[float] | float = 0.0,
    slopes_out: Sequence[float] | float | None = None,
    pre: Extrapolation = Extrapolation.CONSTANT,
    post: Extrapolation = Extrapolation.CONSTANT,
) -> None:
    """Hang a channel; what is not said of the out side is as on the in side."""
    out = rules_in if rules_out is None else rules_out
    slope = slopes_in if slopes_out is None else slopes_out
    # A step has no in side.
    into = [SMOOTH if rule == STEP else rule for rule in rules_in] if isinstance(rules_in, Sequence) else rules_in
    if into == STEP:
        into = SMOOTH
    _ROOMS[name] = lambda: Channel(
        name, make_run(times, values, slopes_in, slope, into, out, broken=rules_out is not None), pre=pre, post=post
    )


_TIMES, _VALUES = (0.0, 1.0, 1.5, 3.0, 4.0), (0.0, 2.0, -1.0, 0.5, 3.0)

# Every rule, alone and against every other on the two sides of its keys.
for _rule in TangentRule:
    _shown(f"rule {_rule.word}", _TIMES, _VALUES, _rule, slopes_in=1.25, slopes_out=-0.75)
_shown("rules in turn", _TIMES, _VALUES, (FLAT, LINEAR, SMOOTH, FIXED, AUTO), slopes_in=2.0)
_shown("broken: flat in, linear out", _TIMES, _VALUES, FLAT, LINEAR)
_shown("broken: fixed both", _TIMES, _VALUES, FIXED, FIXED, 4.0, -4.0)
_shown("broken: smooth in, step out", _TIMES, _VALUES, SMOOTH, STEP)
_shown("broken: linear in, auto out", _TIMES, _VALUES, LINEAR, AUTO)

# Every extrapolation on each side, over ends that differ in value and slope.
for _pre in Extrapolation:
    _post = Extrapolation((_pre + 1) % len(Extrapolation))
    _shown(f"beyond: {_pre.word}, {_post.word}", _TIMES, _VALUES, FIXED, None, 0.5, -1.5, pre=_pre, post=_post)
    _shown(f"beyond on both sides: {_pre.word}", (-2.0, 0.5, 6.0), (1.0, 4.0, -2.0), SMOOTH, pre=_pre, post=_pre)

# Few keys.
_shown("empty", (), ())
_shown("empty, cycling", (), (), pre=Extrapolation.CYCLE, post=Extrapolation.BOUNCE)
_shown("one key", (2.0,), (5.0,))
_shown("one key, cycling", (2.0,), (5.0,), pre=Extrapolation.CYCLE_OFFSET, post=Extrapolation.CYCLE)
_shown(
    "one key, straight on by its slopes",
    (2.0,),
    (5.0,),
    FIXED,
    None,
    1.0,
    -3.0,
    Extrapolation.LINEAR,
    Extrapolation.LINEAR,
)
_shown("one smooth key, straight on", (2.0,), (5.0,), pre=Extrapolation.LINEAR, post=Extrapolation.LINEAR)
_shown("two keys", (1.0, 3.0), (2.0, -2.0), post=Extrapolation.LINEAR)
_shown(
    "two flat keys: ease in and out", (0.0, 1.0), (0.0, 1.0), FLAT, pre=Extrapolation.BOUNCE, post=Extrapolation.BOUNCE
)
_shown("two equal keys", (0.0, 1.0), (7.0, 7.0), pre=Extrapolation.CYCLE_OFFSET, post=Extrapolation.LINEAR)

# Steps.
_shown("step chain", (0.0, 1.0, 2.0, 3.0), (1.0, 5.0, -2.0, 0.0), STEP)
_shown(
    "step chain, cycling",
    (0.0, 1.0, 2.0, 3.0),
    (1.0, 5.0, -2.0, 0.0),
    STEP,
    pre=Extrapolation.CYCLE,
    post=Extrapolation.CYCLE,
)
_shown(
    "step chain, bouncing",
    (0.0, 1.0, 2.0, 3.0),
    (1.0, 5.0, -2.0, 0.0),
    STEP,
    pre=Extrapolation.BOUNCE,
    post=Extrapolation.BOUNCE,
)
_shown(
    "last key steps, straight on",
    (0.0, 1.0, 2.0),
    (0.0, 1.0, 3.0),
    SMOOTH,
    (SMOOTH, SMOOTH, STEP),
    post=Extrapolation.LINEAR,
)
_shown(
    "last span held, cycling",
    (0.0, 1.0, 2.5),
    (0.0, 2.0, 9.0),
    SMOOTH,
    (SMOOTH, STEP, SMOOTH),
    post=Extrapolation.CYCLE,
)
_shown(
    "first span held, with offset",
    (0.0, 1.0, 2.5),
    (0.0, 2.0, 9.0),
    SMOOTH,
    (STEP, SMOOTH, SMOOTH),
    pre=Extrapolation.CYCLE_OFFSET,
    post=Extrapolation.CYCLE_OFFSET,
)

# Shapes.
_shown("overshoot", (0.0, 1.0, 2.0), (0.0, 1.0, 0.0), FIXED, None, 12.0)
_shown("no overshoot: auto plateau", (0.0, 1.0, 1.1, 2.0, 3.0), (0.0, 5.0, 5.1, 5.1, -1.0), AUTO)
_shown("no overshoot: auto cliff", (0.0, 1.0, 1.01, 2.0), (0.0, 0.1, 9.9, 10.0), AUTO)
_shown("cliff", (0.0, 1.0, 1.0 + 1e-9, 2.0), (0.0, 0.0, 1.0, 1.0), LINEAR)
_shown("spike", (0.0, 0.999, 1.0, 1.001, 2.0), (0.0, 0.0, 1e6, 0.0, 0.0), SMOOTH)
_shown("loop of slopes inside one span", (0.0, 1.0), (0.0, 0.0), FIXED, None, 30.0, pre=Extrapolation.CYCLE)
_shown(
    "constant",
    (0.0, 1.0, 2.0, 7.0),
    (3.0, 3.0, 3.0, 3.0),
    SMOOTH,
    pre=Extrapolation.CYCLE_OFFSET,
    post=Extrapolation.BOUNCE,
)
_shown(
    "closed walk cycle",
    (0.0, 0.25, 0.5, 0.75, 1.0),
    (0.0, 0.3, 0.0, -0.3, 0.0),
    SMOOTH,
    pre=Extrapolation.CYCLE,
    post=Extrapolation.CYCLE,
)
_shown("root motion", (0.0, 0.25, 0.5, 1.0), (0.0, 0.4, 0.7, 1.5), LINEAR, post=Extrapolation.CYCLE_OFFSET)
_shown("zeros of both signs", (-1.0, 0.0, 1.0), (-0.0, 0.0, -0.0), SMOOTH)

# Sizes: of times, of values, of both.
_shown("a nanosecond", (0.0, 1e-9, 3e-9), (0.0, 1.0, -1.0), SMOOTH, pre=Extrapolation.CYCLE, post=Extrapolation.LINEAR)
_shown(
    "thirty years", (0.0, 5e8, 1e9), (0.0, 1.0, -1.0), SMOOTH, pre=Extrapolation.BOUNCE, post=Extrapolation.CYCLE_OFFSET
)
_shown("from 1e-9 to 1e9 apart", (0.0, 1e-9, 1.0, 1e9), (0.0, 1.0, 2.0, 3.0), AUTO)
_shown(
    "far from zero",
    (1e5, 1e5 + 0.5, 1e5 + 2.0),
    (1.0, 2.0, 0.0),
    SMOOTH,
    pre=Extrapolation.BOUNCE,
    post=Extrapolation.CYCLE,
)
_shown("neighbouring doubles", (1.0, math.nextafter(1.0, 2.0), 2.0), (0.0, 1.0, 0.0), LINEAR)
_shown("denormal times", (0.0, 5e-324, 1e-323, 1.0), (0.0, 1.0, -1.0, 2.0), FLAT)
_shown("denormal values", (0.0, 1.0, 2.0), (5e-324, 0.0, 1e-320), SMOOTH)
_shown("huge values", (0.0, 1.0, 2.0, 3.0), (1e308, -1e308, 1.7e308, 0.0), SMOOTH, post=Extrapolation.CYCLE)
_shown("huge values, flat", (0.0, 1e9), (1.7e308, -1.7e308), FLAT)
_shown("huge slopes", (0.0, 1.0, 2.0), (0.0, 1.0, 0.0), FIXED, None, 1e308, -1e308)
_shown("huge times", (-1.5e308, 0.0, 1.5e308), (0.0, 1.0, 3.0), SMOOTH)


def _noise(n: int, seed: int) -> tuple[list[float], list[float]]:
    chance = random.Random(seed)
    times, values, time, value = [], [], 0.0, 0.0
    for _ in range(n):
        time += chance.choice((0.01, 0.1, 1.0)) * chance.uniform(0.2, 1.0)
        value += chance.gauss(0.0, 1.0)
        times.append(time)
        values.append(value)
    return times, values


# Long ones: more than a row of keys, and evenly sampled motion.
_shown("noise of 700 keys", *_noise(700, 7), rules_in=SMOOTH, pre=Extrapolation.CYCLE, post=Extrapolation.BOUNCE)
_shown("noise of 1500 keys, auto", *_noise(1500, 8), rules_in=AUTO)
_shown("motion at 30 frames a second", [i / 30.0 for i in range(450)], [math.sin(i * 0.07) for i in range(450)], LINEAR)
