"""Action: one row of the ACTIONS table; Need: what must hold before it can run, and how to say that it does not."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from PySide6.QtGui import QKeySequence

if TYPE_CHECKING:
    from app.main_window import MainWindow
    from model.channel import Channel

type Shortcut = str | QKeySequence.StandardKey


class Need(NamedTuple):
    """A condition on the window, and the words shown when it is not met."""

    met: Callable[["MainWindow"], bool]
    otherwise: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Action:
    """What a menu entry, a button, a shortcut and a line of the command palette have in common."""

    id: str
    menu: str  # path, as in "Edit/Select"
    label: str  # with its mnemonic; ends in … when it asks for more
    function: Callable[["MainWindow"], object]
    tip: str
    shortcuts: tuple[Shortcut, ...] = ()
    icon: str = ""
    needs: tuple[Need, ...] = ()
    checked_when: Callable[["MainWindow"], bool] | None = None
    label_now: Callable[["MainWindow"], str] | None = None
    begins_group: bool = False  # a line above it in its menu
    words: str = ""  # other words by which the palette finds it
    in_mid_drag: bool = False  # may run while a gesture is open
    keeps_entry: bool = True  # what is being typed into a number field is kept before it runs

    def unmet_need(self, window: "MainWindow") -> str:
        """Why it cannot run now; empty when it can."""
        return next((need.otherwise for need in self.needs if not need.met(window)), "")

    @property
    def plain_label(self) -> str:
        """The label as read aloud: no mnemonic, no ellipsis."""
        return self.label.replace("&&", "\0").replace("&", "").replace("\0", "&").removesuffix("…")


def editable_channels(window: "MainWindow") -> list["Channel"]:
    """The shown channels that may be changed, in the clip's order."""
    session = window.session
    return [channel for channel in window.document.clip.channels if session.editable(channel)]


A_CHANNEL = Need(lambda w: bool(w.document.clip.channels), "the clip has no channels")
KEYS = Need(lambda w: any(map(len, w.document.clip.channels)), "the clip has no keys")
SELECTED_KEYS = Need(lambda w: bool(w.session.selection), "no keys are selected")
AN_ACTIVE_CHANNEL = Need(lambda w: w.session.active is not None, "no channel is active")
ACTIVE_IS_SHOWN = Need(
    lambda w: w.session.active is not None and w.session.shown(w.session.active), "the active channel is not shown"
)
EDITABLE_CHANNELS = Need(
    lambda w: any(map(w.session.editable, w.document.clip.channels)), "no channel is shown and unlocked"
)
SHOWN_CHANNELS = Need(lambda w: any(map(w.session.shown, w.document.clip.channels)), "no channel is shown")
