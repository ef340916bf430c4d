"""Actions of the Edit menu that copy, paste and remove keys."""

from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from PySide6.QtGui import QGuiApplication, QKeySequence

from app.actions.popups import pop_up_menu
from app.actions.row import A_CHANNEL, SELECTED_KEYS, Action
from model import edits
from model.clipboard import keys_from_text, text_from_keys
from model.document import Splice, added_keys
from model.labels import channels_text, counted, keys_text, label_of
from model.progress import CancelledError

if TYPE_CHECKING:
    from app.main_window import MainWindow


# More keys than this are written and read as text on another thread: about 50 ms.
MANY_LINES = 8_000


class Paste(NamedTuple):
    """A way to paste: where the first key comes to lie, what happens to keys in between, to which channel."""

    at_playhead: bool = False
    replace: bool = False
    onto_active: bool = False


PASTES = (
    ("own_times", "At Their Own &Times", Paste(), "Paste the keys at the times they were copied from"),
    (
        "replacing",
        "At Playhead, &Replacing What Lies Between",
        Paste(at_playhead=True, replace=True),
        "Paste with the first key at the playhead and remove the keys that lie between the pasted ones",
    ),
    (
        "replacing_own_times",
        "At Their Own Times, Re&placing What Lies Between",
        Paste(replace=True),
        "Paste the keys at the times they were copied from and remove the keys that lie between them",
    ),
    (
        "onto_active",
        "At Playhead, onto the &Active Channel",
        Paste(at_playhead=True, onto_active=True),
        "Paste the keys of one channel into the active channel, whatever its name",
    ),
)


def _paste(how: Paste, window: "MainWindow") -> None:
    """Paste the keys that the clipboard holds; what cannot be pasted is said."""
    session, text = window.session, QGuiApplication.clipboard().text()
    try:
        copied = window.document.at_length(
            "Read the clipboard", partial(keys_from_text, text), many=text.count("\n") > MANY_LINES
        )
        changes = edits.paste(
            window.document.clip,
            copied,
            session.playhead if how.at_playhead else None,
            active=session.active,
            replace=how.replace,
            onto_active=how.onto_active,
        )
        splices = [change for change in changes if isinstance(change, Splice)]
        count = sum(int((splice.after["id"] == 0).sum()) for splice in splices)
        places = channels_text(dict.fromkeys(splice.channel for splice in splices))
        label = f"Paste {counted(count, 'key')} into {places}"
        edit = window.document.do(label, lambda clip: changes, selection=added_keys, keys=count)
        if edit is not None and not edit.replaced:
            window.say(label.replace("Paste", "Pasted", 1))
        if count < copied.key_count:
            window.say(f"{label}: for the other {copied.key_count - count} there is no unlocked channel")
    except CancelledError:
        return
    except ValueError as error:
        window.say(f"Nothing was pasted: {error}")


def _copy(window: "MainWindow") -> bool:
    """Put the selected keys on the clipboard as text; False, with a message, if they are too many."""
    document, selection = window.document, window.session.selection
    try:
        text = document.at_length(
            label_of("Copy", selection), partial(text_from_keys, selection), many=selection.count > MANY_LINES
        )
    except CancelledError:
        return False
    except ValueError as error:
        window.say(str(error))
        return False
    QGuiApplication.clipboard().setText(text)
    window.say(f"Copied {keys_text(selection)}")
    return True


def _cut(window: "MainWindow") -> None:
    if _copy(window):
        _delete(window, "Cut")


def _delete(window: "MainWindow", verb: str = "Delete") -> None:
    selection = window.session.selection
    window.document.do(label_of(verb, selection), lambda clip: edits.delete(clip, selection), keys=selection.count)


def _duplicate(window: "MainWindow") -> None:
    """Copies one frame later, so that no key lies under another; they are selected, ready to be dragged."""
    document, selection = window.document, window.session.selection
    d_time = document.clip.time_of(1)
    document.do(
        label_of("Duplicate", selection, d_time),
        lambda clip: edits.duplicate(clip, selection, d_time),
        selection=added_keys,
        keys=selection.count,
    )


CLIPBOARD_ACTIONS = (
    Action(
        id="edit.cut",
        menu="Edit",
        label="Cu&t",
        function=_cut,
        shortcuts=(QKeySequence.StandardKey.Cut,),
        icon="cut",
        tip="Copy the selected keys as text, then delete them",
        needs=(SELECTED_KEYS,),
        begins_group=True,
    ),
    Action(
        id="edit.copy",
        menu="Edit",
        label="&Copy",
        function=_copy,
        shortcuts=(QKeySequence.StandardKey.Copy,),
        icon="copy",
        tip="Copy the selected keys as text, which other programs can read too",
        needs=(SELECTED_KEYS,),
    ),
    Action(
        id="edit.paste",
        menu="Edit",
        label="&Paste",
        function=partial(_paste, Paste(at_playhead=True)),
        shortcuts=(QKeySequence.StandardKey.Paste,),
        icon="paste",
        tip="Paste keys with the first one at the playhead, into the channels they came from",
        needs=(A_CHANNEL,),
    ),
    *(
        Action(
            id=f"edit.paste.{name}",
            menu="Edit/Paste Special",
            label=label,
            function=partial(_paste, how),
            tip=tip,
            needs=(A_CHANNEL,),
        )
        for name, label, how, tip in PASTES
    ),
    Action(
        id="edit.paste_special",
        menu="Edit/Paste Special",
        label="Show at the &Mouse",
        function=lambda w: pop_up_menu(w, "Edit/Paste Special"),
        shortcuts=("Ctrl+Shift+V",),
        tip="Show the other ways to paste in a menu at the mouse",
        needs=(A_CHANNEL,),
        begins_group=True,
    ),
    Action(
        id="edit.duplicate",
        menu="Edit",
        label="&Duplicate",
        function=_duplicate,
        shortcuts=("Ctrl+D",),
        icon="duplicate",
        tip="Copy the selected keys to one frame later and select the copies",
        needs=(SELECTED_KEYS,),
    ),
    Action(
        id="edit.delete",
        menu="Edit",
        label="De&lete",
        function=_delete,
        shortcuts=("Del", "Backspace"),  # the desktop's own list for Delete has Ctrl+D in it on X11
        icon="delete",
        tip="Remove the selected keys",
        needs=(SELECTED_KEYS,),
    ),
)
