"""Actions of the Key menu: tools, keys at the playhead, nudges, snapping."""

from functools import partial
from math import radians
from typing import TYPE_CHECKING

from app.actions.row import EDITABLE_CHANNELS, SELECTED_KEYS, Action, editable_channels
from model import edits
from model.document import added_keys
from model.labels import channels_text, label_of
from widgets.tools import TOOLS

if TYPE_CHECKING:
    from app.main_window import MainWindow

VALUE_STEP = 0.1  # of the channel's unit
ANGLE_STEP = radians(1.0)
# Name of the size, held modifier, how many steps, what it adds to the label.
NUDGES = (("", "", 1.0, ""), ("_far", "Shift+", 10.0, " × 10"), ("_fine", "Ctrl+", 0.1, " × 0.1"))


def _set_tool(name: str, window: "MainWindow") -> None:
    window.session.tool = name


def _has_tool(name: str, window: "MainWindow") -> bool:
    return window.session.tool == name


def _toggle_option(name: str, window: "MainWindow") -> None:
    setattr(window.session, name, not getattr(window.session, name))


def _has_option(name: str, window: "MainWindow") -> bool:
    return bool(getattr(window.session, name))


def _key_at_playhead(window: "MainWindow") -> None:
    channels, time = editable_channels(window), window.session.playhead
    bare = [channel for channel in channels if channel.key_at(time) is None]
    label = f"Key {channels_text(bare or channels)} at {time:.6g} s"
    if window.document.do(label, lambda clip: edits.key_all(clip, channels, time), selection=added_keys) is None:
        window.say(f"There are keys at {time:.6g} s already")


def _frames(count: float) -> str:
    return "1 frame" if count == 1.0 else f"{count:g} frames"


def _value_steps(count: float) -> str:
    return f"{VALUE_STEP * count:g}, or by {count:g}° for angles"


def _nudge_time(frames: float, window: "MainWindow") -> None:
    session, document = window.session, window.document
    selection, reorder = session.selection, session.reorder
    label = label_of("Nudge", selection, d_time=document.clip.time_of(frames))
    document.do(label, lambda clip: edits.nudge(clip, selection, frames, reorder=reorder), keys=selection.count)


def _nudge_value(steps: float, window: "MainWindow") -> None:
    selection = window.session.selection
    turning = [channel for channel in selection.channels if channel.unit == "angle"]
    other = [channel for channel in selection.channels if channel.unit != "angle"]
    parts = [
        (selection.with_only(channels), steps * size)
        for channels, size in ((turning, ANGLE_STEP), (other, VALUE_STEP))
        if channels
    ]
    label = label_of("Nudge", selection, d_value=parts[0][1] if len(parts) == 1 else 0.0)
    window.document.do(
        label,
        lambda clip: [change for part, d_value in parts for change in edits.nudge(clip, part, 0.0, d_value)],
        keys=selection.count,
    )


KEY_ACTIONS = (
    *(
        Action(
            id=f"key.tool.{row.name}",
            menu="Key",
            label=row.label,
            function=partial(_set_tool, row.name),
            shortcuts=(row.shortcut,),
            icon=row.icon,
            tip=row.tip,
            words="tool",
            checked_when=partial(_has_tool, row.name),
        )
        for row in TOOLS.values()
    ),
    Action(
        id="key.at_playhead",
        menu="Key",
        label="&Key at Playhead on Shown Channels",
        function=_key_at_playhead,
        shortcuts=("S", "I"),
        icon="insert-key",
        tip="Insert a key at the playhead on every shown channel; the curves keep their shape between the keys",
        needs=(EDITABLE_CHANNELS,),
        begins_group=True,
    ),
    *(
        Action(
            id=f"key.{name}{size}",
            menu="Key/Nudge",
            label=f"Nudge {label}{factor}",
            function=partial(nudge, sign * count),
            shortcuts=(f"{held}{key}",),
            tip=f"Move the selected keys {where} by {step(count)}",
            needs=(SELECTED_KEYS,),
            begins_group=not size and name != "earlier",
        )
        for name, label, key, nudge, sign, where, step in (
            ("earlier", "Earlier", ",", _nudge_time, -1, "back", _frames),
            ("later", "Later", ".", _nudge_time, +1, "on", _frames),
            ("up", "Up", "Up", _nudge_value, +1, "up", _value_steps),
            ("down", "Down", "Down", _nudge_value, -1, "down", _value_steps),
        )
        for size, held, count, factor in NUDGES
    ),
    Action(
        id="key.snap",
        menu="Key",
        label="S&nap to Frames",
        function=partial(_toggle_option, "snap"),
        shortcuts=("X",),
        icon="snap",
        tip="Let dragged keys and the playhead stop at whole frames; Ctrl while dragging turns it round",
        checked_when=partial(_has_option, "snap"),
        begins_group=True,
        in_mid_drag=True,
    ),
    Action(
        id="key.reorder",
        menu="Key",
        label="Keys May &Pass Each Other",
        function=partial(_toggle_option, "reorder"),
        icon="reorder",
        tip="Let dragged keys go past their neighbours; if not, they stop short of them",
        checked_when=partial(_has_option, "reorder"),
    ),
)
