"""Actions of the Curve menu: what a curve does before its first and after its last key, keys that keep its shape."""

from functools import partial
from typing import TYPE_CHECKING

from app.actions.popups import pop_up_menu
from app.actions.row import ACTIVE_IS_SHOWN, AN_ACTIVE_CHANNEL, Action, Need
from model import edits
from model.document import added_keys
from model.extrapolation import EXTRAPOLATIONS, Extrapolation
from model.labels import channels_text, counted, short_name

if TYPE_CHECKING:
    from app.main_window import MainWindow

CURVES_IN_HAND = Need(lambda w: bool(w.in_hand.curves), "no channel is active")
UNLOCKED_CURVES = Need(lambda w: not all(c.locked for c in w.in_hand.curves), "the channel is locked")
SIDES = {"pre": "Before the First Key", "post": "After the Last Key"}


def _set_extrapolation(side: str, mode: Extrapolation, window: "MainWindow") -> None:
    channels = [channel for channel in window.in_hand.curves if not channel.locked]
    modes = {side: mode}
    where = "before" if side == "pre" else "after"
    label = f"Set {EXTRAPOLATIONS[mode].label.lower()} {where} {channels_text(channels)}"
    window.document.do(label, lambda clip: edits.set_extrapolation(clip, channels, modes.get("pre"), modes.get("post")))
    locked = len(window.in_hand.curves) - len(channels)
    window.say(label + (f"; {counted(locked, 'channel')} locked" if locked else ""))


def _has_extrapolation(side: str, mode: Extrapolation, window: "MainWindow") -> bool:
    channels = window.in_hand.curves
    return bool(channels) and all(getattr(channel, side) is mode for channel in channels)


def _insert_key(window: "MainWindow") -> None:
    channel, time = window.session.active, window.session.playhead
    if channel is None:
        return
    label = f"Insert key on {short_name(channel)} at {time:.6g} s"
    if window.document.do(label, lambda clip: edits.insert(clip, channel, time), selection=added_keys) is None:
        window.say(
            f"No key was inserted on {channel.name}: " + ("locked" if channel.locked else "there is one already")
        )


CURVE_ACTIONS = (
    Action(
        id="curve.insert_key",
        menu="Curve",
        label="Key at Playhead on the &Active Channel",
        function=_insert_key,
        shortcuts=("Shift+S",),
        icon="insert-key",
        tip="Insert a key at the playhead on the active channel; the curve keeps its shape between the keys",
        needs=(AN_ACTIVE_CHANNEL, ACTIVE_IS_SHOWN),
    ),
    *(
        Action(
            id=f"curve.{side}.{mode.word}",
            menu=f"Curve/{title}",
            label=EXTRAPOLATIONS[mode].label,
            function=partial(_set_extrapolation, side, mode),
            icon=f"{side}-{mode.word.replace('_', '-')}",
            tip=EXTRAPOLATIONS[mode].tip,
            words=f"extrapolation {side} infinity",
            needs=(CURVES_IN_HAND, UNLOCKED_CURVES),
            checked_when=partial(_has_extrapolation, side, mode),
        )
        for side, title in SIDES.items()
        for mode in Extrapolation
    ),
    Action(
        id="curve.menu",
        menu="Curve",
        label="E&xtrapolations at the Mouse",
        function=lambda w: pop_up_menu(
            w, *(f"Curve/{title}" for title in SIDES.values()), of=channels_text(w.in_hand.curves)
        ),
        shortcuts=("Shift+E",),
        tip="Show the extrapolations before and after in a menu at the mouse",
        needs=(CURVES_IN_HAND, UNLOCKED_CURVES),
        begins_group=True,
    ),
)
