"""InHand: what the next command is about, looked up once for all actions that ask."""

from collections.abc import Sequence
from typing import NamedTuple

from model.channel import Channel
from model.keyframe import Run, TangentRule
from model.selection import Selection

# Rules of more keys than this are not looked at just to show them on a button.
MOST_KEYS_LOOKED_AT = 1000


class InHand(NamedTuple):
    """The channels chosen in the tree, those whose curves are meant, and what all selected keys share."""

    channels: list[Channel]
    curves: list[Channel]
    rule_in: TangentRule | None
    rule_out: TangentRule | None
    broken: bool | None

    @classmethod
    def of(cls, chosen: list[Channel], selection: Selection) -> "InHand":
        """The curves are those of the selected keys; without selected keys those *chosen*."""
        return cls(chosen, list(selection.channels) or chosen, *shared_by(selection))


def shared_by(selection: Selection) -> tuple[TangentRule | None, TangentRule | None, bool | None]:
    """(rule in, rule out, broken) of all selected keys; None where they differ, or are too many to look at."""
    if not selection or selection.count > MOST_KEYS_LOOKED_AT:
        return None, None, None
    runs = [channel.keys_of(selection.ids(channel)) for channel in selection.channels]
    rule_in, rule_out, broken = (_only(runs, field) for field in ("rule_in", "rule_out", "broken"))
    return (
        None if rule_in is None else TangentRule(rule_in),
        None if rule_out is None else TangentRule(rule_out),
        None if broken is None else bool(broken),
    )


def _only(runs: Sequence[Run], field: str) -> int | None:
    """The one number that this column of all *runs* holds."""
    numbers = {int(number) for run in runs for number in run[field]}
    return numbers.pop() if len(numbers) == 1 else None
