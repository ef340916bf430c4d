"""Verbs that turn tangents: set rules and slopes, break, unify."""

import numpy as np

from model.change import Change
from model.channel import Channel
from model.clip import Clip
from model.edits.moving import fix_slopes, require_finite, selected_keys
from model.keyframe import Run, TangentRule
from model.placing import placed
from model.selection import Selection

_ONE_LINE = (TangentRule.FLAT, TangentRule.LINEAR, TangentRule.SMOOTH, TangentRule.AUTO)


def _require_side(side: str, sides: tuple[str, ...]) -> None:
    if side not in sides:
        raise ValueError(f"side is {side!r}; it can be {' or '.join(sides)}")


def set_rule(clip: Clip, selection: Selection, rule: TangentRule, side: str = "both") -> list[Change]:
    """Let *rule* set the slopes of the selected keys on *side*: "in", "out" or "both".

    Step is a rule of the side out, so with it the side in stays. Fixed keeps the slopes there are. Afterwards a key
    with two different rules is broken, and one with the same automatic rule on both sides is unified; two fixed sides
    stay as they were, but for slopes that differ.
    """
    _require_side(side, ("both", "in", "out"))
    rule = TangentRule(rule)
    sides = [one for one in ("in", "out") if side in (one, "both") and not (rule == TangentRule.STEP and one == "in")]
    changes: list[Change] = []
    for channel, keys in selected_keys(selection) if sides else ():
        rows = keys.copy()
        for one in sides:
            rows[f"rule_{one}"] = rule
        rows["broken"] = _broken_by_rules(rows)
        changes += placed(channel, keys, rows)
    return changes


def _broken_by_rules(rows: Run) -> np.ndarray:
    """Whether the sides of each key turn apart now; a held side has no tangent, so it changes nothing."""
    same = rows["rule_in"] == rows["rule_out"]
    fixed = rows["rule_in"] == TangentRule.FIXED
    broken = ~same | (fixed & (rows["broken"] | (rows["slope_in"] != rows["slope_out"])))
    return np.where(rows["rule_out"] == TangentRule.STEP, rows["broken"], broken)


def set_slope(clip: Clip, channel: Channel, key_id: int, side: str, slope: float) -> list[Change]:
    """Fix one side ("in" or "out") of one key at *slope* (value per second); a unified key turns on both sides."""
    _require_side(side, ("in", "out"))
    require_finite(slope=slope)
    if channel.locked:
        return []
    keys = channel.keys_of([key_id])
    rows = keys.copy()
    fix_slopes(rows, side, slope)
    return [*placed(channel, keys, rows)]


def break_tangents(clip: Clip, selection: Selection) -> list[Change]:
    """Let the two sides of the selected keys turn apart; the shape stays."""
    changes: list[Change] = []
    for channel, keys in selected_keys(selection):
        rows = keys.copy()
        rows["broken"] = True
        changes += placed(channel, keys, rows)
    return changes


def unify_tangents(clip: Clip, selection: Selection) -> list[Change]:
    """Make one line of the two sides of the selected keys: fixed at the mean of their slopes.

    Keys whose sides share an automatic rule keep it; beside a held span there is nothing to make one line with.
    """
    changes: list[Change] = []
    for channel, keys in selected_keys(selection):
        rows = keys.copy()
        rows["broken"] = False
        automatic = (keys["rule_in"] == keys["rule_out"]) & np.isin(keys["rule_in"], _ONE_LINE)
        joined = ~automatic & (keys["rule_out"] != TangentRule.STEP)
        slopes_in, slopes_out = keys["slope_in"][joined], keys["slope_out"][joined]
        mean = np.where(slopes_in == slopes_out, slopes_in, 0.5 * slopes_in + 0.5 * slopes_out)
        for side in ("in", "out"):
            rows[f"rule_{side}"][joined] = TangentRule.FIXED
            rows[f"slope_{side}"][joined] = mean
        changes += placed(channel, keys, rows)
    return changes
