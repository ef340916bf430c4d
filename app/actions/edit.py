"""Actions of the Edit menu: history, clipboard, selection."""

from typing import TYPE_CHECKING

from app.actions.clipboard import CLIPBOARD_ACTIONS
from app.actions.row import Action, Need
from app.actions.select import SELECT_ACTIONS

if TYPE_CHECKING:
    from app.main_window import MainWindow


def _undo(window: "MainWindow") -> None:
    """Take back the last step; while something is dragged or typed, that is what is taken back."""
    if window.take_back_entry():
        window.say("What was typed is taken back")
    elif window.document.gesture is not None:
        window.cancel_gesture()
        window.say("The drag was cancelled")
    else:
        window.undo_stack.undo()


def _undo_label(window: "MainWindow") -> str:
    if window.document.gesture is not None:
        return "&Undo Drag" if window.view.router.busy else f"&Undo {escaped(window.document.gesture.label)}"
    return f"&Undo {escaped(window.undo_stack.undoText())}".rstrip()


def _redo_label(window: "MainWindow") -> str:
    return f"&Redo {escaped(window.undo_stack.redoText())}".rstrip()


def escaped(text: str) -> str:
    """*text* with its ampersands shown instead of taken as mnemonics."""
    return text.replace("&", "&&")


def _find_command(window: "MainWindow") -> None:
    from app.palette import CommandPalette

    CommandPalette(window).open()


CAN_UNDO = Need(lambda w: w.undo_stack.canUndo() or w.document.gesture is not None, "nothing has been done")
CAN_REDO = Need(lambda w: w.undo_stack.canRedo(), "nothing has been taken back")

EDIT_ACTIONS = (
    Action(
        id="edit.undo",
        menu="Edit",
        label="&Undo",
        function=_undo,
        shortcuts=("Ctrl+Z",),
        icon="undo",
        tip="Take back the last step; the view stays where it is",
        needs=(CAN_UNDO,),
        label_now=_undo_label,
        in_mid_drag=True,
        keeps_entry=False,
    ),
    Action(
        id="edit.redo",
        menu="Edit",
        label="&Redo",
        function=lambda w: w.undo_stack.redo(),
        shortcuts=("Ctrl+Shift+Z", "Ctrl+Y"),
        icon="redo",
        tip="Do again what was taken back",
        needs=(CAN_REDO,),
        label_now=_redo_label,
    ),
    *CLIPBOARD_ACTIONS,
    *SELECT_ACTIONS,
    Action(
        id="edit.find_command",
        menu="Edit",
        label="&Find Command…",
        function=_find_command,
        shortcuts=("Ctrl+K", "F3"),
        icon="search",
        tip="Run any command, or go to any channel, by typing part of its name",
        begins_group=True,
    ),
)
