"""Actions of the Edit menu that choose keys."""

from typing import TYPE_CHECKING

from PySide6.QtGui import QKeySequence

from app.actions.row import ACTIVE_IS_SHOWN, AN_ACTIVE_CHANNEL, KEYS, SELECTED_KEYS, Action, editable_channels
from model.selection import Selection

if TYPE_CHECKING:
    from app.main_window import MainWindow

INFINITY = float("inf")


def _select(window: "MainWindow", start: float, end: float) -> None:
    """Select the keys of the shown channels from *start* to *end*, both included."""
    window.session.selection = Selection.of(
        {channel: channel.ids_between(start, end) for channel in editable_channels(window)}
    )


def _select_inverse(window: "MainWindow") -> None:
    everything = Selection.of({channel: channel.run()["id"] for channel in editable_channels(window)})
    window.session.selection = everything.minus(window.session.selection)


def _select_channel(window: "MainWindow") -> None:
    channel = window.session.active
    if channel is not None:
        window.session.selection = Selection.of({channel: channel.run()["id"]})


SELECT_ACTIONS = (
    Action(
        id="edit.select_all",
        menu="Edit/Select",
        label="Select &All",
        function=lambda w: _select(w, -INFINITY, INFINITY),
        shortcuts=(QKeySequence.StandardKey.SelectAll,),
        tip="Select every key of the shown channels",
        needs=(KEYS,),
    ),
    Action(
        id="edit.select_none",
        menu="Edit/Select",
        label="Select &None",
        function=lambda w: setattr(w.session, "selection", Selection.NONE),
        shortcuts=("Ctrl+Shift+A",),
        tip="Select nothing",
        needs=(SELECTED_KEYS,),
    ),
    Action(
        id="edit.select_inverse",
        menu="Edit/Select",
        label="Select &Inverse",
        function=_select_inverse,
        shortcuts=("Ctrl+I",),
        tip="Select the keys of the shown channels that are not selected",
        needs=(KEYS,),
    ),
    Action(
        id="edit.select_channel",
        menu="Edit/Select",
        label="Select All of the Active &Channel",
        function=_select_channel,
        shortcuts=("Ctrl+L",),
        tip="Select every key of the active channel",
        needs=(AN_ACTIVE_CHANNEL, ACTIVE_IS_SHOWN),
        begins_group=True,
    ),
    Action(
        id="edit.select_before",
        menu="Edit/Select",
        label="Select &Before Playhead",
        function=lambda w: _select(w, -INFINITY, w.session.playhead),
        shortcuts=("[",),
        tip="Select the keys of the shown channels up to the playhead",
        needs=(KEYS,),
    ),
    Action(
        id="edit.select_after",
        menu="Edit/Select",
        label="Select A&fter Playhead",
        function=lambda w: _select(w, w.session.playhead, INFINITY),
        shortcuts=("]",),
        tip="Select the keys of the shown channels from the playhead on",
        needs=(KEYS,),
    ),
)
