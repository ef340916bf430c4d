"""Verbs that change where keys are: move, nudge, scale, set a field."""

from collections.abc import Callable, Iterator
from functools import partial
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike, NDArray

from model.change import Change, Shift, Splice
from model.channel import Channel
from model.clip import Clip
from model.hermite import LARGEST, Floats
from model.keyframe import KEY_DTYPE, Run, TangentRule
from model.mapping import Added, Mapping, Stretched, mirrored
from model.placing import placed, rounding_slack, slack_at, strictly_increasing
from model.selection import Selection
from model.short_ways import MOST

# Seconds that a key which must not pass its neighbour stays away from it.
TICK = 1e-9
# Numbers added to at a time: they stay in the processor's cache.
AT_A_TIME = 8192
# Of fewer keys but one, or of fewer than one among so many others, splices are quicker.
FEW, SCATTERED = 12, 64
# A time factor nearer to 0 would put all keys at one time.
SMALLEST_FACTOR = 1e-6


def selected_keys(selection: Selection) -> Iterator[tuple[Channel, Run]]:
    """The selected keys of each channel that is not locked; KeyGoneError if one is gone."""
    for channel in selection.channels:
        if not channel.locked:
            yield channel, channel.keys_of(selection.ids(channel))


def require_finite(**numbers: float) -> None:
    """ValueError that names the first number that is not finite."""
    for name, number in numbers.items():
        if not isfinite(number):
            raise ValueError(f"{name} is {number}; it must be finite")


def clamped(numbers: Floats) -> Floats:
    """*numbers* with what no double can hold at the end of its range."""
    return numbers.clip(-LARGEST, LARGEST)


def _moved(keys: Run, d_time: float, d_value: float) -> Run:
    """Copies of *keys* with both added; sums that no double can hold stop at the end of its range."""
    rows = np.empty(len(keys), KEY_DTYPE)
    with np.errstate(over="ignore"):
        for at in range(0, len(keys), AT_A_TIME):
            part = rows[at : at + AT_A_TIME]
            part[:] = keys[at : at + AT_A_TIME]
            for field, number in (("time", d_time), ("value", d_value)):
                if number:
                    sums = part[field] + number
                    part[field] = np.minimum(sums, LARGEST) if number > 0.0 else np.maximum(sums, -LARGEST)
    return rows


def move(clip: Clip, selection: Selection, d_time: float, d_value: float, *, reorder: bool = True) -> list[Change]:
    """Move the selected keys by *d_time* seconds and *d_value*.

    With *reorder* they go past other keys, and one that lands on another covers it; without, all of them stop short
    of the first unselected neighbour in the way of one. Sums too large for a double stop at the largest.
    """
    require_finite(d_time=d_time, d_value=d_value)
    keys_by_channel = list(selected_keys(selection))
    limits: list[tuple[Floats, Floats] | None] = [None] * len(keys_by_channel)
    if d_time and not reorder:
        # Where all keys move there is none in the way.
        limits = [_limits(channel, keys) if len(keys) < len(channel) else None for channel, keys in keys_by_channel]
        for (_, keys), limit in zip(keys_by_channel, limits, strict=True):
            d_time = _stopped(keys, limit, d_time)
    changes: list[Change] = []
    for (channel, keys), limit in zip(keys_by_channel, limits, strict=True):
        splices = partial(_spliced, channel, keys, d_time, d_value, limit)
        if limit is not None or (len(keys) > 1 and (len(keys) < FEW or len(channel) > SCATTERED * len(keys))):
            changes += splices()
            continue
        first, last = float(keys["time"][0]), float(keys["time"][-1])
        slack = slack_at(first, last, first + d_time, last + d_time) if d_time and len(keys) < len(channel) else 0.0
        changes.append(Shift(channel, keys, Mapping(Added(d_time), Added(d_value)), slack, splices))
    return changes


def _spliced(
    channel: Channel, keys: Run, d_time: float, d_value: float, limit: tuple[Floats, Floats] | None
) -> list[Splice]:
    """The splices that move *keys*, past others unless there is a *limit*."""
    rows = _in_order(keys, d_time, d_value, limit)
    if len(keys) == len(channel):
        return [Splice(channel, keys, rows)]
    return placed(channel, keys, rows, slack=rounding_slack(keys, rows) if d_time and limit is None else 0.0)


def _in_order(keys: Run, d_time: float, d_value: float, limit: tuple[Floats, Floats] | None) -> Run:
    """Copies of *keys* moved by both, at times that increase however much rounding has brought them together."""
    rows = _moved(keys, d_time, d_value)
    if d_time:
        times = rows["time"]
        if limit is not None:
            rows["time"] = _inside(times, limit, keys["time"])
        elif not (times[1:] > times[:-1]).all():
            rows["time"] = strictly_increasing(times.copy())
    return rows


def nudge(
    clip: Clip, selection: Selection, frames: float = 0.0, d_value: float = 0.0, *, reorder: bool = True
) -> list[Change]:
    """Move the selected keys by *frames* of the clip's frame rate and by *d_value*."""
    return move(clip, selection, clip.time_of(frames), d_value, reorder=reorder)


def _limits(channel: Channel, keys: Run) -> tuple[Floats, Floats]:
    """(earliest, latest) time of each of *keys* that is still short of its unmoved neighbours; inf: none there."""
    run = channel.keys_between(float(keys["time"][0]), float(keys["time"][-1]), around=1)
    places = run["time"].searchsorted(keys["time"])
    padded = np.concatenate([[-np.inf], run["time"], [np.inf]])
    moved = np.zeros(len(padded), np.bool_)
    moved[places + 1] = True
    before, after = padded[places], padded[places + 2]
    earliest = np.where(moved[places], -np.inf, np.maximum(before + TICK, np.nextafter(before, np.inf)))
    latest = np.where(moved[places + 2], np.inf, np.minimum(after - TICK, np.nextafter(after, -np.inf)))
    # Neighbours that are nearer than a tick already stay where they are.
    return np.minimum(earliest, keys["time"]), np.maximum(latest, keys["time"])


def _stopped(keys: Run, limit: tuple[Floats, Floats] | None, d_time: float) -> float:
    """As much of *d_time* as leaves all *keys* short of their unmoved neighbours."""
    if limit is None:
        return d_time
    earliest, latest = limit
    with np.errstate(over="ignore"):  # a neighbour too far away for a double is in nobody's way
        if d_time > 0.0:
            return min(d_time, float((latest - keys["time"]).min()))
        return max(d_time, float((earliest - keys["time"]).max()))


def _inside(times: Floats, limit: tuple[Floats, Floats], before: Floats) -> Floats:
    """*times*, brought back where rounding has carried them too far; *before* if they would meet."""
    times = times.clip(*limit)
    return times if (times[1:] > times[:-1]).all() else before


def scale(
    clip: Clip, selection: Selection, center_time: float, center_value: float, f_time: float, f_value: float
) -> list[Change]:
    """Scale the selected keys about a point; factors below 0 mirror, so that the shape between the keys is mirrored.

    Slopes of fixed sides scale with the keys. Mirrored in time, the sides of each key change places and a held span
    stays a held span. A time factor nearer to 0 than SMALLEST_FACTOR counts as that, or all keys would be at one time.
    """
    require_finite(center_time=center_time, center_value=center_value, f_time=f_time, f_value=f_value)
    if abs(f_time) < SMALLEST_FACTOR:
        f_time = float(np.copysign(SMALLEST_FACTOR, f_time))
    mapping = Mapping(
        Stretched(center_time, f_time) if f_time != 1.0 else Added(0.0),
        Stretched(center_value, f_value) if f_value != 1.0 else Added(0.0),
    )
    changes: list[Change] = []
    for channel, keys in selected_keys(selection):
        splices = partial(_scaled_splices, channel, keys, mapping)
        if len(keys) < FEW or len(keys) < MOST * len(channel):
            changes += splices()
            continue
        slack = 0.0
        if f_time != 1.0 and len(keys) < len(channel):
            ends = keys["time"][[0, -1]]
            with np.errstate(over="ignore"):
                slack = slack_at(*ends.tolist(), *_scaled(ends, Stretched(center_time, f_time)).tolist())
        changes.append(Shift(channel, keys, mapping, slack, splices))
    return changes


def _scaled_splices(channel: Channel, keys: Run, mapping: Mapping) -> list[Splice]:
    """The splices that give *keys* the numbers that they become by *mapping*."""
    rows = keys.copy()
    slack = 0.0
    with np.errstate(over="ignore"):
        if isinstance(mapping.value, Stretched):
            rows["value"] = _scaled(keys["value"], mapping.value)
        if mapping.slope != 1.0:
            _scale_slopes(rows, mapping.slope)
        if isinstance(mapping.time, Stretched):
            rows["time"] = _scaled(keys["time"], mapping.time)
            if mapping.mirrored:
                rows = mirrored(rows)
            rows["time"] = strictly_increasing(rows["time"])
            slack = rounding_slack(keys, rows)
    if FEW <= len(keys) == len(channel):
        return [Splice(channel, keys, rows)]
    return placed(channel, keys, rows, slack=slack)


def _scaled(numbers: Floats, stretched: Stretched) -> Floats:
    """*numbers* as they become, with what no double can hold on the way at the end of its range."""
    center, factor = stretched
    return clamped(center + clamped(clamped(numbers - center) * factor))


def _scale_slopes(rows: Run, factor: float) -> None:
    for side in ("in", "out"):
        fixed = rows[f"rule_{side}"] == TangentRule.FIXED
        rows[f"slope_{side}"][fixed] = clamped(rows[f"slope_{side}"][fixed] * factor)


def set_columns(
    clip: Clip, selection: Selection, field: str, compute: Callable[[Channel, Run], ArrayLike]
) -> list[Change]:
    """Set "time", "value", "slope_in" or "slope_out" of the selected keys to what *compute* gives for each channel.

    It gets the channel and its selected keys, and returns one number for all or one for each. A slope makes its side
    fixed, and both sides if the key is unified. ValueError if a number is not finite or two keys would share a time.
    """
    if field not in ("time", "value", "slope_in", "slope_out"):
        raise ValueError(f"{field!r} is no number of a key; it can be time, value, slope_in or slope_out")
    changes: list[Change] = []
    for channel, keys in selected_keys(selection):
        numbers = np.broadcast_to(np.asarray(compute(channel, keys), np.float64), len(keys))
        if not np.isfinite(numbers).all():
            bad = float(numbers[~np.isfinite(numbers)][0])
            raise ValueError(f"{field} of a key of {channel.name} would be {bad}; it must be finite")
        changes += _with_field(channel, keys, field, numbers)
    return changes


def set_field(
    clip: Clip, selection: Selection, field: str, compute: Callable[[NDArray[np.float64]], ArrayLike]
) -> list[Change]:
    """The same as set_columns, where *compute* only needs the field's present numbers of one channel."""
    return set_columns(clip, selection, field, lambda channel, keys: compute(keys[field].copy()))


def _with_field(channel: Channel, keys: Run, field: str, numbers: Floats) -> list[Splice]:
    rows = keys.copy()
    if field == "value":
        rows["value"] = numbers
    elif field == "time":
        rows["time"] = numbers
        rows = rows[rows["time"].argsort(kind="stable")]
        same = np.flatnonzero(rows["time"][1:] == rows["time"][:-1])
        if len(same):
            raise ValueError(f"two keys of {channel.name} would be at {float(rows['time'][same[0]])!r} s")
    else:
        fix_slopes(rows, field.removeprefix("slope_"), numbers)
    return placed(channel, keys, rows)


def fix_slopes(rows: Run, side: str, slopes: ArrayLike) -> None:
    """Fix *side* of *rows* at *slopes*, and the other side too where the tangents are one line.

    A unified key whose two slopes differ is a corner that its rules made (linear): turning one of its tangents
    breaks it rather than bend the other span. A held side stays held.
    """
    other = "in" if side == "out" else "out"
    present_in, present_out = rows["slope_in"], rows["slope_out"]
    corner = ~np.isclose(present_in, present_out, rtol=1e-9, atol=0.0) & (rows["rule_out"] != TangentRule.STEP)
    rows["broken"] |= corner
    both = ~rows["broken"]
    if other == "out":
        both &= rows["rule_out"] != TangentRule.STEP
    rows[f"rule_{side}"], rows[f"slope_{side}"] = TangentRule.FIXED, slopes
    rows[f"rule_{other}"][both] = TangentRule.FIXED
    rows[f"slope_{other}"][both] = rows[f"slope_{side}"][both]
