"""Watcher: keeps title, actions and the selection's summary true while the document and the session change."""

from typing import TYPE_CHECKING, Final

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QLineEdit
from shiboken6 import isValid

from model.channel import Channel
from model.document import Edit, Splice
from model.extrapolation import EXTRAPOLATIONS
from model.labels import counted, keys_text
from widgets.fitting import MARGINS
from widgets.soon import Soon
from widgets.theme import Theme
from widgets.view_range import fitted

if TYPE_CHECKING:
    from app.main_window import MainWindow


# What is inserted changes few keys beside it; longer runs are something else.
MOST_BESIDE: Final = 8


class Watcher(QObject):
    """Listens for the window; it lives as long as the window does."""

    def __init__(self, window: "MainWindow") -> None:
        super().__init__(window)
        self._window = window
        self._in_gesture = False
        self._index = 0
        # While the mouse is at work shortcuts wait anyway, so what a selection box changes is looked at now and then.
        self._later = Soon(self, self.refresh, document=window.document)
        self._listen_to_document()
        self._listen_to_widgets()

    def _listen_to_document(self) -> None:
        document, session = self._window.document, self._window.session
        document.gesture_changed.connect(self._gesture_changed)
        document.committed.connect(self._committed)
        for event in (document.clip_replaced, document.membership_changed):
            event.connect(self.refresh)
        for event in (session.selection_changed, session.active_changed, session.visibility_changed):
            event.connect(self._session_changed)
        document.setting_changed.connect(self._something_changed)
        session.option_changed.connect(self._something_changed)

    def _listen_to_widgets(self) -> None:
        window = self._window
        window.undo_stack.indexChanged.connect(self._history_moved)
        window.undo_stack.indexChanged.connect(self._undone)
        window.undo_stack.stayed.connect(self._stayed)
        window.undo_stack.cleanChanged.connect(self._history_moved)
        window.files.changed.connect(window.refresh_title)
        window.view.view_changed.connect(Soon(self, self._view_moved).ask)
        window.view.hint_changed.connect(window.status.show_hint)
        for panel in (window.view, window.tree, window.inspector, window.transport):
            panel.status.connect(window.say)
        for line in window.inspector.findChildren(QLineEdit):
            line.textEdited.connect(self._typed)
        window.tree.frame_requested.connect(self._frame)
        window.tree.view.selectionModel().selectionChanged.connect(self._something_changed)
        window.statusBar().messageChanged.connect(window.status.show_tip)
        Theme.current().theme_changed.connect(window.refresh_actions)

    def refresh(self) -> None:
        """Look at everything again."""
        if self._window.document.working:
            return
        if not isValid(self._window):  # the history still tells that it is empty while Qt destroys it with the window
            return
        self._window.refresh_actions()
        self._window.status.show_selection(selection_summary(self._window))

    def _session_changed(self) -> None:
        if self._window.view.router.busy:
            self._later.ask()
        else:
            self.refresh()

    def _something_changed(self, *_what: object) -> None:
        self._session_changed()

    def _gesture_changed(self) -> None:
        in_gesture = self._window.document.gesture is not None
        if in_gesture != self._in_gesture and isValid(
            self._window
        ):  # previews change nothing that an action asks about
            self._in_gesture = in_gesture
            self._window.actions_by_id["edit.undo"].refresh({})
            if in_gesture:  # what was said of the change before is over
                self._window.say("")

    def _undone(self, index: int) -> None:
        if index < self._index and isValid(self._window) and isValid(self._window.status):
            self._window.say("")
        self._index = index

    def _stayed(self, label: str) -> None:
        self._window.say(f"{label}: cancelled, nothing has changed")

    def _committed(self, edit: Edit) -> None:
        if edit.replaced:  # keys nobody pointed at are gone: say so where it is seen
            self._window.say(edit.label)
        elif repeats_more(edit):
            self._window.say(f"{edit.label}: what is repeated outside the keys has become longer")
        elif beside := fixed_beside(edit):
            keys = "the key beside it is" if beside == 1 else f"{counted(beside, 'key')} beside it are"
            self._window.say(f"{edit.label}: {keys} fixed now, so that the curve keeps its shape")

    def _view_moved(self) -> None:
        if isValid(self._window):
            for name in ("view.back", "view.forward"):
                self._window.actions_by_id[name].refresh({})
            self._window.tips.ask()

    def _typed(self, _text: str) -> None:
        self._window.actions_by_id["file.save"].refresh({})

    def _history_moved(self, *_place: object) -> None:
        self.refresh()
        if isValid(self._window):
            self._window.refresh_title()

    def _frame(self, channel: Channel) -> None:
        """Show all of one channel."""
        first, last = channel.first, channel.last
        if first is not None and last is not None:
            self._window.view.set_view(fitted(first.time, last.time, *channel.extrema(), MARGINS))


def repeats_more(edit: Edit) -> bool:
    """Whether it adds a first or last key to a curve that is repeated before or after."""
    for change in edit.changes:
        if isinstance(change, Splice) and len(change.before) < len(change.after) <= MOST_BESIDE:
            channel, old = change.channel, set(change.before["id"].tolist())
            ends = {key.id for key in (channel.first, channel.last) if key is not None}
            repeats = any(EXTRAPOLATIONS[mode].repeats for mode in (channel.pre, channel.post))
            if repeats and ends & (set(change.after["id"].tolist()) - old):
                return True
    return False


def fixed_beside(edit: Edit) -> int:
    """How many keys have other rules than before beside one that was inserted."""
    count = 0
    for change in edit.changes:
        if isinstance(change, Splice) and len(change.before) < len(change.after) <= MOST_BESIDE:
            rules = {key["id"]: (key["rule_in"], key["rule_out"]) for key in change.before}
            kept = [key for key in change.after if key["id"] in rules]
            count += sum(rules[key["id"]] != (key["rule_in"], key["rule_out"]) for key in kept)
    return count


def selection_summary(window: "MainWindow") -> str:
    """What is selected; without a selection, how much there is."""
    selection, clip = window.session.selection, window.document.clip
    if selection:
        return f"{keys_text(selection)} selected"
    return f"{counted(clip.key_count, 'key')} in {counted(len(clip.channels), 'channel')}" if clip.channels else ""
