"""Splice, Setting, Membership: the three changes a clip knows; Edit: the changes of one undo step.

Each holds both sides, so taking one back is putting the other side in: nothing is ever subtracted.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from math import inf, isfinite
from typing import Any, NamedTuple

import numpy as np

from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.keyframe import Run
from model.mapping import Mapping
from model.selection import Selection
from model.touched import Near, Touched

LONGEST_TEXT = 1024
KEYS_AT_A_TIME = 4096


class Splice(NamedTuple):
    """The neighbouring keys *before* of *channel* give way to *after*."""

    channel: Channel
    before: Run
    after: Run

    def inverse(self) -> "Splice":
        """The way back."""
        return Splice(self.channel, self.after, self.before)


class Setting(NamedTuple):
    """A field of a channel or of the clip changes its value; SETTINGS names the fields."""

    target: Channel | Clip
    field: str
    before: Any
    after: Any

    def inverse(self) -> "Setting":
        """The way back."""
        return Setting(self.target, self.field, self.after, self.before)


class Membership(NamedTuple):
    """The clip's channels change: some are added, removed or stand in another order."""

    before: tuple[Channel, ...]
    after: tuple[Channel, ...]

    def inverse(self) -> "Membership":
        """The way back."""
        return Membership(self.after, self.before)


class Shift(NamedTuple):
    """The keys *before* of *channel*, which need not be neighbours, change alike: splices that are seldom asked for.

    None of its keys may be changed by what is put in before it.
    """

    channel: Channel
    before: Run
    mapping: Mapping
    slack: float  # keys that come no more than so many seconds near to each other are a matter for splices
    splices: Callable[[], list[Splice]]  # the same as splices, worked out while the channel is as it was
    within: Run | None = None  # now that it has been put in: the neighbouring keys among which its own were
    passed: bool = False  # now that it has been put in: its only key stands among others than before


type Change = Splice | Shift | Setting | Membership


@dataclass(frozen=True, eq=False, slots=True)
class Edit:
    """One undo step: its label, its changes as stored, and what was selected and active on both sides of it.

    *replaced* is how many keys gave way to others as it was made.
    """

    label: str
    changes: tuple[Change, ...]
    selection_before: Selection = Selection.NONE
    selection_after: Selection = Selection.NONE
    active_before: Channel | None = None
    active_after: Channel | None = None
    replaced: int = 0

    @property
    def key_count(self) -> int:
        """How many keys it takes away or puts in, whichever are more."""
        splices = spliced(self.changes)
        return max(sum(len(splice.before) for splice in splices), sum(len(splice.after) for splice in splices))

    def inverse(self) -> "Edit":
        """The step back."""
        return Edit(
            self.label,
            tuple(change.inverse() for change in reversed(self.changes)),
            self.selection_after,
            self.selection_before,
            self.active_after,
            self.active_before,
        )


def spliced(changes: Iterable[Change]) -> list[Splice]:
    """The splices among *changes*."""
    return [change for change in changes if isinstance(change, Splice)]


def shifted(shift: Shift, touched: Touched) -> Change | None:
    """Put *shift* in by its channel's short way; it, or the splice it was, or None if that way is closed."""
    done = shift.channel.shift(shift.before, shift.mapping, shift.slack)
    if done is None:
        return None
    touched.widen(shift.channel, done.t0, done.t1)
    touched.keys_came_or_went |= not done.same_order
    channel, before = shift.channel, done.before
    if done.near is not None:
        touched.nearest[channel] = Near(int(before["id"][0]), *done.near)
        return shift._replace(within=before, passed=not done.same_order)
    if done.after is not None:
        return Splice(channel, before, done.after)
    return shift if len(before) == len(shift.before) else shift._replace(within=before)


def unshifted(changes: Iterable[Change]) -> list[Splice | Setting | Membership]:
    """*changes* with splices for what has been shifted as a whole, or is to be while its channel is as it was."""
    found: list[Splice | Setting | Membership] = []
    for change in changes:
        if not isinstance(change, Shift):
            found.append(change)
        elif change.within is None:
            found += change.splices()
        else:
            found += replacing(change.channel, change.within, change.channel.stored(change.within), change.passed)
    return found


def replacing(channel: Channel, before: Run, after: Run, passed: bool) -> list[Splice]:
    """The splices that make *after* of *before*: two if keys that stay where they are have been *passed*."""
    if not passed:
        return [Splice(channel, before, after)]
    return [Splice(channel, before, before[:0]), Splice(channel, after[:0], after)]


def validated(change: Change) -> Change:
    """*change* with its setting in canonical form; ValueError if that is no value for it.

    Only what a user asks for is validated: the way back leads to what was there, whatever it was.
    """
    if not isinstance(change, Setting):
        return change
    settings = CHANNEL_SETTINGS if isinstance(change.target, Channel) else CLIP_SETTINGS
    if change.field not in settings:
        kind = type(change.target).__name__.lower()
        raise ValueError(f"a {kind} has no setting {change.field!r}; it has {', '.join(settings)}")
    return change._replace(after=settings[change.field](change.field, change.after))


def put(clip: Clip, change: Change, touched: Touched, *, read_back: bool = True) -> Change:
    """Make one change and return it as stored, with the ids that new keys got; ValueError if it cannot be made.

    Without *read_back* the keys of a splice keep the slopes that they were given with.

    Nothing has changed after an error. Unique names and the order of the range are the business of `check_whole`,
    since a list of changes may pass through what it must not end with.
    """
    if isinstance(change, Splice):
        channel, before, after = change
        t0, t1, given, same_ids = channel.replace(before, after)
        touched.widen(channel, t0, t1)
        touched.keys_came_or_went |= not same_ids
        return Splice(channel, before, channel.stored(given) if read_back else given)
    if isinstance(change, Setting):
        return _set(change, touched)
    assert isinstance(change, Membership), "a shift is put in by its channel"
    if tuple(clip.channels) != change.before:
        raise ValueError("the channels of the clip are not those that the change starts from")
    if len(set(change.after)) < len(change.after):
        raise ValueError("a channel cannot be in the clip twice")
    clip.channels[:] = change.after
    touched.membership = True
    return change


def check_whole(clip: Clip, touched: Touched) -> None:
    """ValueError if names are not unique or the clip ends before it starts, as far as either was touched."""
    fields = {field for _, field in touched.settings}
    if touched.membership or "name" in fields:
        names = set()
        for channel in clip.channels:
            if channel.name in names:
                raise ValueError(f"there already is a channel {channel.name!r}")
            names.add(channel.name)
    if fields & {"start", "end"} and clip.end < clip.start:
        raise ValueError(f"the clip would end at {clip.end!r} s, before its start at {clip.start!r} s")


def _set(change: Setting, touched: Touched) -> Setting:
    target, field = change.target, change.field
    before, after = getattr(target, field), change.after
    if isinstance(target, Channel) and field in ("pre", "post"):
        pre, post = (after, target.post) if field == "pre" else (target.pre, after)
        target.set_extrapolation(pre, post)
        first, last = target.first, target.last
        if first is None or last is None:
            touched.widen(target, -inf, inf)
        elif field == "pre":
            touched.widen(target, -inf, first.time)
        else:
            touched.widen(target, last.time, inf)
    else:
        setattr(target, field, after)
    touched.settings[target, field] = None
    return Setting(target, field, before, after)


def _text(field: str, value: Any) -> str:
    if not isinstance(value, str) or not value.isprintable() or len(value.encode()) > LONGEST_TEXT:
        raise ValueError(f"{field} must be a line of printable characters, at most {LONGEST_TEXT} bytes of UTF-8")
    return value


def _name(field: str, value: Any) -> str:
    if not _text(field, value).strip():
        raise ValueError("a channel needs a name")
    return str(value)


def _color(field: str, value: Any) -> str | None:
    if value is None:
        return None
    if (
        isinstance(value, str)
        and len(value) == 7
        and value[0] == "#"
        and set(value[1:]) <= set("0123456789abcdefABCDEF")
    ):
        return value.lower()
    raise ValueError(f"{field} is {value!r}; it must be like #1a9fe0")


def _truth(field: str, value: Any) -> bool:
    if value is True or value is False:
        return bool(value)
    raise ValueError(f"{field} is {value!r}; it must be true or false")


def _extrapolation(field: str, value: Any) -> Extrapolation:
    return Extrapolation(value)


def _time(field: str, value: Any) -> float:
    number = float(value)
    if not isfinite(number):
        raise ValueError(f"{field} is {number}; it must be finite")
    return number


def _frame_rate(field: str, value: Any) -> float:
    number = _time(field, value)
    if number <= 0.0:
        raise ValueError(f"the frame rate is {number:g}; it must be above 0")
    return number


# Each field that a user may set, and what makes sure of its value: a new setting is a new row.
CHANNEL_SETTINGS: dict[str, Callable[[str, Any], Any]] = {
    "name": _name,
    "unit": _text,
    "color": _color,
    "locked": _truth,
    "pre": _extrapolation,
    "post": _extrapolation,
}
CLIP_SETTINGS: dict[str, Callable[[str, Any], Any]] = {
    "start": _time,
    "end": _time,
    "frame_rate": _frame_rate,
    "title": _text,
}


def differing(changes: Sequence[Change]) -> list[Change]:
    """*changes* without those that, alone or taken together, leave everything as it was."""
    by_channel: dict[Channel, list[Splice]] = {}
    for change in changes:
        if isinstance(change, Splice):
            by_channel.setdefault(change.channel, []).append(change)
    same = {channel for channel, splices in by_channel.items() if _cancel_out(splices)}
    return [change for change in changes if not _in_vain(change, same)]


def _in_vain(change: Change, same: set[Channel]) -> bool:
    if isinstance(change, Splice):
        return change.channel in same
    if isinstance(change, Setting):
        return repr(change.before) == repr(change.after)  # 0.0 and -0.0 are equal, and yet two states
    return isinstance(change, Membership) and change.before == change.after


def _cancel_out(splices: list[Splice]) -> bool:
    """Whether the keys taken away are those put in, bit for bit: a channel's order follows from its keys."""
    if sum(len(splice.before) for splice in splices) != sum(len(splice.after) for splice in splices):
        return False
    if len(splices) == 1:
        return _same_bytes(splices[0].before, splices[0].after)
    return _keys(splice.before for splice in splices) == _keys(splice.after for splice in splices)


def _same_bytes(before: Run, after: Run) -> bool:
    """Whether two runs of one length are the same; mostly the first keys tell already."""
    starts = range(0, len(before), KEYS_AT_A_TIME)
    return all(before[i : i + KEYS_AT_A_TIME].tobytes() == after[i : i + KEYS_AT_A_TIME].tobytes() for i in starts)


def _keys(runs: Iterable[Run]) -> bytes:
    joined = np.concatenate(list(runs))
    return joined[np.argsort(joined["id"], kind="stable")].tobytes()
