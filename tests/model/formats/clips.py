"""Random clips for the tests of the formats, and what it means that two are the same."""

from typing import Any

import numpy as np
from hypothesis import strategies as st

from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.keyframe import KEY_DTYPE, TangentRule

IN_RULES = [rule for rule in TangentRule if rule is not TangentRule.STEP]
PLAIN = [TangentRule.FLAT, TangentRule.LINEAR, TangentRule.SMOOTH, TangentRule.FIXED]
finite = st.floats(allow_nan=False, allow_infinity=False)
short = st.integers(-(10**6), 10**6).map(lambda number: number / 1000)
numbers = st.one_of(short, finite, st.sampled_from([0.0, -0.0, 5e-324, 1.7976931348623157e308, 0.1 + 0.2, 1e16, 1e-7]))


@st.composite
def channels(draw: st.DrawFn, rules: list[TangentRule] | None = None) -> Channel:
    """A channel of 0 to 12 keys with any finite numbers."""
    out = rules or list(TangentRule)
    times = sorted(draw(st.lists(numbers, unique_by=lambda time: time + 0.0, max_size=12)))
    run = np.zeros(len(times), KEY_DTYPE)
    run["time"] = times
    for i in range(len(times)):
        run["value"][i], run["slope_in"][i], run["slope_out"][i] = draw(st.tuples(numbers, numbers, numbers))
        run["rule_in"][i] = draw(st.sampled_from([rule for rule in IN_RULES if rule in out]))
        run["rule_out"][i] = draw(st.sampled_from(out))
        run["broken"][i] = draw(st.booleans())
    modes = st.sampled_from(list(Extrapolation))
    return Channel("", run, pre=draw(modes), post=draw(modes))


names = st.one_of(
    st.sampled_from(["root.tx", "channel 0", 'with "quotes"', "brace } {", "keys {", "# no remark", "", " ", "a\nb"]),
    st.text(max_size=20),
)


@st.composite
def clips(draw: st.DrawFn) -> Clip:
    """A clip that uses everything a clip can hold."""
    made = draw(st.lists(channels(), max_size=4))
    for channel, name in zip(made, draw(st.lists(names, unique=True, min_size=4, max_size=4)), strict=False):
        channel.name = name
        channel.unit = draw(st.sampled_from(["", "angle", "m", "°", 'in "quotes"']))
        channel.color = draw(st.sampled_from([None, "#ff8000", "#00AAff"]))
        channel.locked = draw(st.booleans())
    rate = draw(st.one_of(st.sampled_from([24.0, 30.0, 23.976]), st.floats(1e-3, 1e6)))
    return Clip(made, start=draw(numbers), end=draw(numbers), frame_rate=rate, title=draw(names))


@st.composite
def course_clips(draw: st.DrawFn) -> Clip:
    """A clip of which a course .anim can hold everything."""
    made = draw(st.lists(channels(PLAIN), max_size=4))
    plain = []
    for i, channel in enumerate(made):
        run = channel.run().copy()
        both = (run["rule_in"] == TangentRule.FIXED) & (run["rule_out"] == TangentRule.FIXED)
        run["broken"] = (run["rule_in"] != run["rule_out"]) | (both & (run["slope_in"] != run["slope_out"]))
        plain.append(Channel(f"channel {i}", run, pre=channel.pre, post=channel.post))
    return Clip(plain, start=draw(numbers), end=draw(numbers))


def facts(clip: Clip) -> list[Any]:
    """Everything that a file has to keep of *clip*, numbers as their bits."""

    def bits(number: float) -> str:
        return float(number).hex()

    result: list[Any] = [clip.title, bits(clip.start), bits(clip.end), bits(clip.frame_rate)]
    for channel in clip.channels:
        result.append([channel.name, channel.unit, channel.color, channel.locked, channel.pre, channel.post])
        for key in channel.run():
            columns = [bits(key[name]) for name in ("time", "value", "slope_in", "slope_out")]
            result.append([*columns, int(key["rule_in"]), int(key["rule_out"]), bool(key["broken"])])
    return result
