"""Verbs that make and remove keys: insert on the curve, insert at a value, delete."""

from collections.abc import Iterable

import numpy as np

from model.change import Change, Splice
from model.channel import Channel
from model.clip import Clip
from model.edits.moving import require_finite, selected_keys
from model.keyframe import Run, TangentRule, make_run
from model.placing import NO_KEYS, placed
from model.selection import Selection
from model.tangents import slopes_of

# A rule that gives the wanted slope but for this share of it may keep the side.
SAME_SLOPE = 1e-12


def insert(clip: Clip, channel: Channel, time: float) -> list[Change]:
    """Put a key on the curve at *time* and keep the curve's shape; nothing where there is a key already.

    The new key is fixed at the curve's slope, and held in a held span. A side of the keys next to it whose rule would
    now give another slope becomes fixed at the slope it has; the key stays unified if its two slopes are equal, so that
    its handles still turn as one. Outside the keys the extrapolated curve becomes part of the channel: its shape stays
    if it is constant or linear, but what repeats now repeats another stretch.
    """
    require_finite(time=time)
    if channel.locked or channel.key_at(time) is not None:
        return []
    if not len(channel):
        return [Splice(channel, NO_KEYS, make_run([time]))]
    run = channel.keys_between(time, time, around=2)
    at = int(run["time"].searchsorted(time))
    held = at > 0 and run["rule_out"][at - 1] == TangentRule.STEP
    slope = 0.0 if held else channel.slope(time)
    rule_out = TangentRule.STEP if held else TangentRule.FIXED
    row = make_run([time], channel.value(time), slope, slope, TangentRule.FIXED, rule_out)
    window = np.concatenate([run[:at], row, run[at:]])
    wanted = _slopes_now(channel, run, at)
    for place in (at - 1, at + 1):
        if 0 <= place < len(window):
            _keep_slopes(window, place, *wanted[place])
    begin, end = max(at - 1, 0), min(at + 1, len(run))
    return [Splice(channel, run[begin:end], window[begin : end + 1])]


def _slopes_now(channel: Channel, run: Run, at: int) -> dict[int, tuple[float, float]]:
    """(in, out) by place in the window with the new key: what the curve has on both sides of the keys next to it.

    Beyond an end key that is the slope of the extrapolation, not that of the tangent, which nobody saw so far.
    """
    slopes = {}
    if at > 0:
        key = run[at - 1]
        outer = channel.slope(float(key["time"])) if at == len(run) else float(key["slope_out"])
        slopes[at - 1] = float(key["slope_in"]), outer
    if at < len(run):
        key = run[at]
        outer = channel.slope(float(key["time"]), "in") if at == 0 else float(key["slope_in"])
        slopes[at + 1] = outer, float(key["slope_out"])
    return slopes


def _keep_slopes(window: Run, place: int, slope_in: float, slope_out: float) -> None:
    """Fix the sides of the key at *place* whose rules would not give these slopes in *window*."""
    columns = (window[name] for name in ("time", "value", "slope_in", "slope_out", "rule_in", "rule_out"))
    given_in, given_out = slopes_of(*columns)
    fixed = False
    # In Python's numbers, whose differences may overflow without a word.
    for side, wanted, given in (("in", slope_in, float(given_in[place])), ("out", slope_out, float(given_out[place]))):
        if window[f"rule_{side}"][place] == TangentRule.STEP or abs(wanted - given) <= SAME_SLOPE * abs(wanted):
            continue
        window[f"rule_{side}"][place], window[f"slope_{side}"][place] = TangentRule.FIXED, wanted
        fixed = True
    key = window[place]
    if fixed and key["rule_out"] != TangentRule.STEP:
        window["broken"][place] |= slope_in != slope_out or key["rule_in"] != key["rule_out"]


def insert_key(
    clip: Clip, channel: Channel, time: float, value: float, rule: TangentRule = TangentRule.SMOOTH
) -> list[Change]:
    """Put a key at *time* and *value*; a key that is there already gets the value and keeps its rules."""
    require_finite(time=time, value=value)
    if channel.locked:
        return []
    present = channel.key_at(time)
    if present is None:
        row = make_run([time], value, rules_in=TangentRule.FLAT if rule == TangentRule.STEP else rule, rules_out=rule)
        return [*placed(channel, NO_KEYS, row)]
    keys = channel.keys_of([present.id])
    rows = keys.copy()
    rows["value"] = value
    return [*placed(channel, keys, rows)]


def key_all(clip: Clip, channels: Iterable[Channel], time: float) -> list[Change]:
    """Put a key on the curve of each of *channels* at *time*, where there is none."""
    return [change for channel in channels for change in insert(clip, channel, time)]


def delete(clip: Clip, selection: Selection) -> list[Change]:
    """Remove the selected keys."""
    changes: list[Change] = []
    for channel, keys in selected_keys(selection):
        changes += placed(channel, keys, NO_KEYS)
    return changes
