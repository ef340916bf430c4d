"""Writes the clips in resources/samples: python -m tools.make_samples

They are worked out here, number by number, so that what each shows can be read and changed; a test compares them.
"""

import math
from pathlib import Path

from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.formats import write_bytes
from model.keyframe import TangentRule, make_run

SAMPLES = Path(__file__).resolve().parent.parent / "resources" / "samples"

FLAT, LINEAR, SMOOTH = TangentRule.FLAT, TangentRule.LINEAR, TangentRule.SMOOTH
FIXED, STEP, AUTO = TangentRule.FIXED, TangentRule.STEP, TangentRule.AUTO
CONSTANT, CYCLE, CYCLE_OFFSET = Extrapolation.CONSTANT, Extrapolation.CYCLE, Extrapolation.CYCLE_OFFSET
ONWARD, BOUNCE = Extrapolation.LINEAR, Extrapolation.BOUNCE


def curve(
    name: str,
    keys: dict[float, float],
    rule: TangentRule = SMOOTH,
    pre: Extrapolation = CONSTANT,
    post: Extrapolation = CONSTANT,
    *,
    unit: str = "",
    color: str | None = None,
) -> Channel:
    """A channel through {time: value}, all keys by one rule (which for STEP holds on the out side only)."""
    rule_in = LINEAR if rule is STEP else rule
    run = make_run(list(keys), list(keys.values()), rules_in=rule_in, rules_out=rule, broken=rule is STEP)
    return Channel(name, run, pre=pre, post=post, unit=unit, color=color)


def loop(name: str, keys: dict[float, float], unit: str = "") -> Channel:
    """A channel that cycles without a corner: its end keys, fixed, have the slope of the curve across the seam."""
    times, values = list(keys), list(keys.values())
    rise, time = values[1] - values[0] + values[-1] - values[-2], times[1] - times[0] + times[-1] - times[-2]
    ends, between = [FIXED], [SMOOTH] * (len(keys) - 2)
    rules, slope = ends + between + ends, round(rise / time, 4) + 0.0
    return Channel(name, make_run(times, values, slope, slope, rules, rules), pre=CYCLE, post=CYCLE, unit=unit)


def falling(name: str, top: float, left: float, gravity: float) -> Channel:
    """Heights of a ball dropped from *top* that keeps *left* of its speed at each of five bounces.

    Between two keys a fall is a parabola, which a span holds exactly: fixed slopes, broken where it hits the ground.
    """
    keys = [(0.0, top, 0.0, 0.0)]
    time, speed = math.sqrt(2 * top / gravity), math.sqrt(2 * top * gravity)
    for _ in range(5):
        keys.append((time, 0.0, -speed, speed * left))
        speed *= left
        keys.append((time + speed / gravity, speed * speed / (2 * gravity), 0.0, 0.0))
        time += 2 * speed / gravity
    keys.append((time, 0.0, -speed, 0.0))
    times, values, slopes_in, slopes_out = zip(*[[round(x, 4) for x in key] for key in keys], strict=True)
    broken = [slope_in != slope_out for slope_in, slope_out in zip(slopes_in, slopes_out, strict=True)]
    return Channel(name, make_run(times, values, slopes_in, slopes_out, FIXED, FIXED, broken), unit="m")


def bounce() -> Clip:
    """A ball falls, bounces and rolls to rest on a stage that goes on: every rule and every extrapolation at work."""
    hits = (0.7821, 1.9082, 2.7192, 3.3030, 3.7234)
    squash = {0.0: 1.0}
    for hit, depth in zip(hits, (0.5, 0.36, 0.26, 0.19, 0.13), strict=True):
        squash |= {hit - 0.1: 1.0, hit: round(1.0 - depth, 4), hit + 0.12: 1.0}
    squash = {round(time, 4): value for time, value in squash.items()}
    return Clip(
        [
            curve("ball.tx", {0.0: -2.4, 0.7821: -1.3, 2.7192: 0.9, 4.4: 1.8}, AUTO, unit="m"),
            falling("ball.ty", 3.0, 0.72, 9.81),
            curve("ball.squash", squash, AUTO, color="#cc79a7"),
            curve("stage.belt", {0.0: -2.8, 0.8: -2.2, 1.2: -2.2}, LINEAR, CYCLE_OFFSET, CYCLE_OFFSET, unit="m"),
            curve("stage.lamp", {0.0: -1.0, 0.6: -0.6, 0.9: -1.0, 1.0: -0.6, 1.1: -1.0, 1.6: -1.0}, STEP, CYCLE, CYCLE),
            loop("stage.fan", {0.0: -3.4, 0.4: -2.9, 1.1: -3.9, 1.5: -3.4}),
            curve("camera.tx", {0.4: -1.8, 2.0: 0.2, 4.0: 0.6}, FLAT, CONSTANT, ONWARD, unit="m", color="#3f8fc4"),
            curve("camera.roll", {0.0: 2.2, 1.1: 2.5, 2.2: 1.9}, SMOOTH, BOUNCE, BOUNCE),
        ],
        start=0.0,
        end=4.8,
        frame_rate=30.0,
        title="A ball comes to rest",
    )


def rules() -> Clip:
    """The same five keys by every tangent rule, and one short wave by every extrapolation, one above the other."""
    channels = []
    for row, rule in enumerate((AUTO, SMOOTH, LINEAR, FLAT, STEP)):
        low = 10.0 - 1.5 * row
        keys = {0.0: low, 1.0: low + 0.2, 1.5: low + 1.0, 3.0: low + 0.9, 4.0: low}
        channels.append(curve(f"rule.{rule.word}", keys, rule, ONWARD, ONWARD))
    times, slopes = [0.0, 1.0, 1.5, 3.0, 4.0], [0.5, -0.5, 0.5, -1.0, 0.4]
    fixed = make_run(times, [2.5, 2.7, 3.5, 3.4, 2.5], slopes, slopes, FIXED, FIXED)
    channels.append(Channel("rule.fixed", fixed, pre=ONWARD, post=ONWARD))
    for row, mode in enumerate((CONSTANT, ONWARD, CYCLE, CYCLE_OFFSET, BOUNCE)):
        low = 0.5 - 1.5 * row
        wave = {1.5: low, 2.0: low + 0.9, 2.5: low + 0.4}
        channels.append(curve(f"outside.{mode.word}", wave, SMOOTH, mode, mode))
    return Clip(channels, start=0.0, end=4.0, frame_rate=24.0, title="Tangent rules and extrapolations")


# Of each joint: where it hangs on its parent, its children, and its swing about x over one walk of 1.2 s (a lead in
# radians, how far, how often, and when, as a part of the walk).
BODY = {
    "pelvis": ((0.0, 0.95, 0.0), ("spine", "hip_l", "hip_r"), (0.05, 0.03, 2, 0.0)),
    "spine": ((0.0, 0.12, 0.0), ("head", "arm_l", "arm_r"), (0.08, 0.04, 2, 0.1)),
    "head": ((0.0, 0.45, 0.0), (), (-0.1, 0.03, 2, 0.2)),
    "arm_l": ((0.2, 0.38, 0.0), ("elbow_l",), (0.05, 0.5, 1, 0.5)),
    "elbow_l": ((0.0, -0.28, 0.0), (), (-0.5, 0.25, 1, 0.55)),
    "arm_r": ((-0.2, 0.38, 0.0), ("elbow_r",), (0.05, 0.5, 1, 0.0)),
    "elbow_r": ((0.0, -0.28, 0.0), (), (-0.5, 0.25, 1, 0.05)),
    "hip_l": ((0.1, -0.05, 0.0), ("knee_l",), (-0.1, 0.55, 1, 0.0)),
    "knee_l": ((0.0, -0.45, 0.0), ("foot_l",), (0.55, 0.5, 1, 0.2)),
    "foot_l": ((0.0, -0.42, 0.0), (), (0.0, 0.35, 1, 0.35)),
    "hip_r": ((-0.1, -0.05, 0.0), ("knee_r",), (-0.1, 0.55, 1, 0.5)),
    "knee_r": ((0.0, -0.45, 0.0), ("foot_r",), (0.55, 0.5, 1, 0.7)),
    "foot_r": ((0.0, -0.42, 0.0), (), (0.0, 0.35, 1, 0.85)),
}
WALK = 1.2


def joints_from(name: str = "pelvis") -> list[str]:
    """The joints in the order of the skeleton file: each before its children."""
    return [name, *(below for child in BODY[name][1] for below in joints_from(child))]


def swing(middle: float, reach: float, times: int, late: float) -> dict[float, float]:
    """Nine keys of a wave that begins and ends alike: *times* waves in a walk, *late* by a part of it."""
    parts = [index / 8 for index in range(9)]
    return {
        round(part * WALK, 4): round(middle + reach * math.sin(2 * math.pi * times * (part % 1.0 - late)), 4) + 0.0
        for part in parts
    }


def walk() -> Clip:
    """Two steps of a walk that goes on for ever: cycles everywhere, and a cycle with offset that carries it forward."""
    height, stride = BODY["pelvis"][0][1], 1.3
    channels = [
        loop("pelvis.tx", swing(0.0, 0.03, 1, 0.1)),
        loop("pelvis.ty", swing(height, 0.025, 2, 0.15)),
        curve("pelvis.tz", {0.0: 0.0, WALK: stride}, LINEAR, CYCLE_OFFSET, CYCLE_OFFSET),
    ]
    for joint in joints_from():
        turns = joint in ("pelvis", "spine")
        still = {0.0: 0.0}
        channels += [
            loop(f"{joint}.rx", swing(*BODY[joint][2]), "angle"),
            loop(f"{joint}.ry", swing(0.0, 0.12, 1, 0.25), "angle")
            if turns
            else curve(f"{joint}.ry", still, FLAT, unit="angle"),
            curve(f"{joint}.rz", still, FLAT, unit="angle"),
        ]
    return Clip(channels, start=0.0, end=2 * WALK)


def skeleton(name: str = "pelvis", indent: str = "") -> str:
    """The skeleton that names the channels of the walk."""
    x, y, z = BODY[name][0]
    inner = "".join(skeleton(child, indent + "  ") for child in BODY[name][1])
    return f"{indent}balljoint {name} {{\n{indent}  offset {x} {y} {z}\n{inner}{indent}}}\n"


def samples() -> dict[str, bytes]:
    """The bytes of every shipped sample, by file name."""
    return {
        "bounce.hermite": write_bytes(bounce(), "hermite"),
        "rules.hermite": write_bytes(rules(), "hermite"),
        "walk.anim": write_bytes(walk(), "anim"),
        "walk.skel": skeleton().encode(),
    }


if __name__ == "__main__":
    SAMPLES.mkdir(parents=True, exist_ok=True)
    for file_name, data in samples().items():
        (SAMPLES / file_name).write_bytes(data)
        print(f"{SAMPLES / file_name}: {len(data):,} bytes")
