"""Verbs that bring in copies of keys: paste, duplicate."""

import numpy as np

from model.change import Change
from model.channel import Channel
from model.clip import Clip
from model.clipboard import CopiedKeys, keys_from_text, onto_channels
from model.edits.moving import clamped, require_finite, selected_keys
from model.keyframe import Run
from model.placing import NO_KEYS, placed, rounding_slack, strictly_increasing
from model.selection import Selection


def paste(
    clip: Clip,
    copied: CopiedKeys | str,
    time: float | None,
    *,
    active: Channel | None = None,
    onto_active: bool = False,
    replace: bool = False,
) -> list[Change]:
    """Put copied keys into the channels of the same name, the first of them at *time* (None: at their own times).

    If no name is known they go to the channels from *active* on, one by one; with *onto_active* all that comes from
    one channel goes to the active one. Keys at the same times give way, and with *replace* all keys in between.
    ValueError if the text is damaged or there is no unlocked channel to paste to.
    """
    if isinstance(copied, str):
        copied = keys_from_text(copied)
    if time is not None:
        require_finite(time=time)
    d_time = 0.0 if time is None else time - copied.start
    if onto_active and active is not None and len(copied.runs) == 1:
        places = {active: next(iter(copied.runs.values()))}
    else:
        places = onto_channels(copied, clip.channels, active)
    places = {channel: run for channel, run in places.items() if not channel.locked}
    if not places:
        raise ValueError("there is no unlocked channel to paste to")
    changes: list[Change] = []
    for channel, run in places.items():
        rows, slack = _shifted(run, d_time, 0.0)
        times = rows["time"]
        removed = channel.keys_between(float(times[0]), float(times[-1])) if replace else NO_KEYS
        changes += placed(channel, removed, rows, slack=slack)
    return changes


def duplicate(clip: Clip, selection: Selection, d_time: float, d_value: float = 0.0) -> list[Change]:
    """Put copies of the selected keys *d_time* seconds later and *d_value* higher; keys they land on give way.

    Nothing happens without a *d_time*: two keys never share a time.
    """
    require_finite(d_time=d_time, d_value=d_value)
    changes: list[Change] = []
    for channel, keys in selected_keys(selection) if d_time else ():
        rows, slack = _shifted(keys, d_time, d_value)
        changes += placed(channel, NO_KEYS, rows, slack=slack)
    return changes


def _shifted(run: Run, d_time: float, d_value: float) -> tuple[Run, float]:
    """Copies of *run* without ids, and how far rounding may have carried them."""
    rows = run.copy()
    rows["id"] = 0
    slack = 0.0
    with np.errstate(over="ignore"):
        if d_time:
            rows["time"] = strictly_increasing(clamped(run["time"] + d_time))
            slack = rounding_slack(run, rows)
        if d_value:
            rows["value"] = clamped(run["value"] + d_value)
    return rows, slack
