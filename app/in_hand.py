"""InHand: what the next command is about, looked up once for all actions that ask."""

from collections.abc import Sequence
from typing import NamedTuple

from model.channel import Channel
from model.keyframe import Run, TangentRule
from model.selection import Selection

# Rules of more keys than this are not looked at just to show them on a button.
MOST_KEYS_LOOKED_AT = 1000


class InHand(NamedTuple):
    """The channels chosen in the tree, those whose curves are meant, and the rules that all selected keys share."""

    channels: list[Channel]
    curves: list[Channel]
    rule_in: TangentRule | None
    rule_out: TangentRule | None

    @classmethod
    def of(cls, chosen: list[Channel], selection: Selection) -> "InHand":
        """The curves are those of the selected keys; without selected keys those *chosen*."""
        return cls(chosen, list(selection.channels) or chosen, *common_rules(selection))


def common_rules(selection: Selection) -> tuple[TangentRule | None, TangentRule | None]:
    """(rule in, rule out) that all selected keys share; None where they differ, or are too many to look at."""
    if not selection or selection.count > MOST_KEYS_LOOKED_AT:
        return None, None
    runs = [channel.keys_of(selection.ids(channel)) for channel in selection.channels]
    return _only_rule(runs, "rule_in"), _only_rule(runs, "rule_out")


def _only_rule(runs: Sequence[Run], field: str) -> TangentRule | None:
    rules = {int(rule) for run in runs for rule in run[field]}
    return TangentRule(rules.pop()) if len(rules) == 1 else None
