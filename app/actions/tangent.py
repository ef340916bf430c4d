"""Actions of the Tangent menu: rules, broken and unified tangents."""

from functools import partial
from typing import TYPE_CHECKING

from app.actions.popups import pop_up_menu
from app.actions.row import SELECTED_KEYS, Action
from model import edits
from model.keyframe import TangentRule
from model.labels import keys_text
from model.tangents import TANGENT_RULES

if TYPE_CHECKING:
    from app.main_window import MainWindow

# In the order of the number keys.
RULES = (
    TangentRule.SMOOTH,
    TangentRule.LINEAR,
    TangentRule.FLAT,
    TangentRule.FIXED,
    TangentRule.STEP,
    TangentRule.AUTO,
)
SIDES = {"in": "In Side Only", "out": "Out Side Only"}


def _set_rule(rule: TangentRule, side: str, window: "MainWindow") -> None:
    selection = window.session.selection
    where = {"both": "", "in": " on the in side", "out": " on the out side"}[side]
    window.document.do(
        f"Set {keys_text(selection)} to {rule.word}{where}",
        lambda clip: edits.set_rule(clip, selection, rule, side=side),
        keys=selection.count,
    )


def _rules_agree(rule: TangentRule, side: str, window: "MainWindow") -> bool:
    """Whether every selected key has *rule* on *side*; a step, which is on the out side only, counts as both."""
    rule_in, rule_out = window.in_hand.rule_in, window.in_hand.rule_out
    if side == "both":
        return rule_out is rule and (rule_in is rule or rule is TangentRule.STEP)
    return (rule_in if side == "in" else rule_out) is rule


def _break(window: "MainWindow") -> None:
    selection = window.session.selection
    label = f"Break tangents of {keys_text(selection)}"
    window.document.do(label, lambda clip: edits.break_tangents(clip, selection), keys=selection.count)


def _unify(window: "MainWindow") -> None:
    selection = window.session.selection
    label = f"Unify tangents of {keys_text(selection)}"
    window.document.do(label, lambda clip: edits.unify_tangents(clip, selection), keys=selection.count)


def _rule_actions(side: str) -> tuple[Action, ...]:
    rules = [rule for rule in RULES if rule is not TangentRule.STEP or side != "in"]
    return tuple(
        Action(
            id=f"tangent.{rule.word}" if side == "both" else f"tangent.{side}.{rule.word}",
            menu="Tangent" if side == "both" else f"Tangent/{SIDES[side]}",
            label=TANGENT_RULES[rule].label,
            function=partial(_set_rule, rule, side),
            shortcuts=(str(RULES.index(rule) + 1),) if side == "both" else (),
            icon=rule.word,
            tip=TANGENT_RULES[rule].tip,
            needs=(SELECTED_KEYS,),
            checked_when=partial(_rules_agree, rule, side),
        )
        for rule in rules
    )


TANGENT_ACTIONS = (
    *_rule_actions("both"),
    *_rule_actions("in"),
    *_rule_actions("out"),
    Action(
        id="tangent.break",
        menu="Tangent",
        label="&Break",
        function=_break,
        shortcuts=("B",),
        icon="break",
        tip="Let the tangents of the selected keys turn apart",
        needs=(SELECTED_KEYS,),
        checked_when=lambda w: w.in_hand.broken is True,
        begins_group=True,
    ),
    Action(
        id="tangent.unify",
        menu="Tangent",
        label="&Unify",
        function=_unify,
        shortcuts=("U",),
        icon="unify",
        tip="Let the tangents of the selected keys turn together",
        needs=(SELECTED_KEYS,),
        checked_when=lambda w: w.in_hand.broken is False,
    ),
    Action(
        id="tangent.menu",
        menu="Tangent",
        label="Rules at the &Mouse",
        function=lambda w: pop_up_menu(w, "Tangent"),
        shortcuts=("V",),
        tip="Show these rules in a menu at the mouse",
        needs=(SELECTED_KEYS,),
        begins_group=True,
    ),
)
