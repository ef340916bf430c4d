"""Actions of the Channel menu: which channels there are, how they are named and shown."""

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtGui import QColor

from app.actions.row import AN_ACTIVE_CHANNEL, SHOWN_CHANNELS, Action, Need
from model.channel import Channel
from model.document import Membership
from model.labels import channels_text
from widgets.channel_verbs import set_color, set_locked, settings

if TYPE_CHECKING:
    from app.main_window import MainWindow

HIDDEN_CHANNELS = Need(lambda w: bool(w.session.hidden or w.session.solo), "every channel is shown")
CHANNELS_IN_HAND = Need(lambda w: bool(w.in_hand.channels), "no channel is active")


def _add(window: "MainWindow") -> None:
    clip = window.document.clip
    name = window.questions.text("New Channel", "Name, as in root.tx:", clip.unique_name("channel"))
    if not name:
        return
    channel = Channel(clip.unique_name(name))
    before = tuple(clip.channels)
    window.document.do(f"Add channel {channel.name}", lambda clip: [Membership(before, (*before, channel))])
    window.session.active = channel


def _remove(window: "MainWindow") -> None:
    gone = window.in_hand.channels
    before = tuple(window.document.clip.channels)
    after = tuple(channel for channel in before if channel not in gone)
    window.document.do(f"Remove {channels_text(gone)}", lambda clip: [Membership(before, after)])


def _move(places: int, window: "MainWindow") -> None:
    channel = window.session.active
    order = list(window.document.clip.channels)
    if channel is None:
        return
    before, place = tuple(order), order.index(channel)
    order.insert(min(max(place + places, 0), len(order) - 1), order.pop(place))
    if tuple(order) != before:
        window.document.do(
            f"Move channel {channel.name} {'up' if places < 0 else 'down'}",
            lambda clip: [Membership(before, tuple(order))],
        )


def _all_locked(window: "MainWindow") -> bool:
    channels = window.in_hand.channels
    return bool(channels) and all(channel.locked for channel in channels)


def _toggle_lock(window: "MainWindow") -> None:
    set_locked(window.document, window.in_hand.channels, not _all_locked(window))


def _all_angles(window: "MainWindow") -> bool:
    channels = window.in_hand.channels
    return bool(channels) and all(channel.unit == "angle" for channel in channels)


def _toggle_angle(window: "MainWindow") -> None:
    channels, angle = window.in_hand.channels, not _all_angles(window)
    how = "in degrees" if angle else "as plain numbers"
    window.document.do(
        f"Show {channels_text(channels)} {how}", lambda clip: settings(channels, "unit", "angle" if angle else "")
    )


def _choose_color(window: "MainWindow") -> None:
    channels = window.in_hand.channels
    color = window.questions.color(QColor(channels[0].color or ""))
    if color.isValid():
        set_color(window.document, channels, color.name())


def _drop_color(window: "MainWindow") -> None:
    set_color(window.document, window.in_hand.channels, None)


def _step_active(places: int, window: "MainWindow") -> None:
    """Make the next shown channel of the clip the active one, going round at the ends."""
    session = window.session
    shown = session.shown_channels(window.document.clip)
    if not shown:
        return
    if session.active in shown:
        session.active = shown[(shown.index(session.active) + places) % len(shown)]
    else:
        session.active = shown[0]


CHANNEL_ACTIONS = (
    Action(
        id="channel.add",
        menu="Channel",
        label="&New Channel…",
        function=_add,
        icon="add",
        tip="Add an empty channel to the clip",
    ),
    Action(
        id="channel.rename",
        menu="Channel",
        label="&Rename",
        function=lambda w: w.tree.rename_chosen(),
        shortcuts=("F2",),
        icon="rename",
        tip="Give the active channel another name",
        needs=(AN_ACTIVE_CHANNEL,),
    ),
    Action(
        id="channel.remove",
        menu="Channel",
        label="Re&move",
        function=_remove,
        icon="remove",
        tip="Take the chosen channels out of the clip",
        needs=(CHANNELS_IN_HAND,),
    ),
    *(
        Action(
            id=f"channel.move_{way}",
            menu="Channel",
            label=f"Move {way.capitalize()}",
            function=partial(_move, places),
            tip=f"Move the active channel one place {way} in the clip",
            needs=(AN_ACTIVE_CHANNEL,),
        )
        for way, places in (("up", -1), ("down", +1))
    ),
    Action(
        id="channel.lock",
        menu="Channel",
        label="&Lock",
        function=_toggle_lock,
        icon="lock",
        tip="Keep the keys of these channels from being changed",
        needs=(CHANNELS_IN_HAND,),
        checked_when=_all_locked,
        begins_group=True,
    ),
    Action(
        id="channel.angle",
        menu="Channel",
        label="Show in Degrees",
        function=_toggle_angle,
        tip="Show the values of these channels, held in radians, as degrees",
        needs=(CHANNELS_IN_HAND,),
        checked_when=_all_angles,
    ),
    Action(
        id="channel.color",
        menu="Channel",
        label="&Color…",
        function=_choose_color,
        icon="color",
        tip="Give these channels a color of their own",
        needs=(CHANNELS_IN_HAND,),
    ),
    Action(
        id="channel.no_color",
        menu="Channel",
        label="Color by Theme",
        function=_drop_color,
        tip="Let the theme choose the color of these channels",
        needs=(Need(lambda w: any(c.color for c in w.in_hand.channels), "the channel has no color of its own"),),
    ),
    Action(
        id="channel.hide",
        menu="Channel",
        label="&Hide",
        function=lambda w: w.tree.hide_chosen(),
        shortcuts=("H",),
        icon="eye-off",
        tip="Hide the chosen channels",
        needs=(CHANNELS_IN_HAND,),
        begins_group=True,
    ),
    Action(
        id="channel.show_only",
        menu="Channel",
        label="Show &Only These",
        function=lambda w: w.tree.show_only_chosen(),
        shortcuts=("Shift+H",),
        icon="solo",
        tip="Hide every other channel",
        needs=(CHANNELS_IN_HAND,),
    ),
    Action(
        id="channel.reveal",
        menu="Channel",
        label="Re&veal All",
        function=lambda w: w.tree.reveal_all(),
        shortcuts=("Alt+H",),
        icon="eye",
        tip="Show every channel",
        needs=(HIDDEN_CHANNELS,),
    ),
    *(
        Action(
            id=f"channel.{name}",
            menu="Channel",
            label=label,
            function=partial(_step_active, places),
            shortcuts=(shortcut,),
            tip=f"Make the next shown channel {where} the active one",
            needs=(SHOWN_CHANNELS,),
            begins_group=name == "previous",
        )
        for name, label, places, shortcut, where in (
            ("previous", "&Previous Channel", -1, "PgUp", "above"),
            ("next", "Nex&t Channel", +1, "PgDown", "below"),
        )
    ),
    Action(
        id="channel.filter",
        menu="Channel",
        label="&Filter…",
        function=lambda w: w.focus_filter(),
        shortcuts=("Ctrl+F",),
        icon="filter",
        tip="Type part of a name to list only the channels that have it",
        begins_group=True,
    ),
)
