"""Files: the clip's file, whether the clip differs from it, and opening, saving and reloading with their questions."""

import os
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtWidgets import QApplication

from app.clip_file import (
    Doubt,
    Fingerprint,
    Leave,
    Opened,
    Saved,
    display_name,
    open_clip,
    save_clip,
    version_since,
)
from app.file_menus import SAMPLES_FOLDER
from app.naming import name_channels
from app.questions import Answer, home_folder
from app.undo import Mark
from model.channel import Channel
from model.clip import Clip
from model.formats import FORMATS, FormatError, Loss, format_of_path
from model.formats.content import Content
from model.progress import CancelledError, Report
from model.saving import Durability, SaveError

if TYPE_CHECKING:
    from app.main_window import MainWindow

UNTITLED = "Untitled"
NATIVE = "hermite"
# Up to so much is read and written at once: that takes less than 50 ms.
FEW_BYTES, FEW_KEYS, FEW_CHANNELS = 1 << 17, 10_000, 500


class Files(QObject):
    """Knows the file of the window's clip. The undo stack's clean index is the saved state."""

    changed = Signal()  # the path, or whether the clip differs from it

    def __init__(self, window: "MainWindow") -> None:
        super().__init__(window)
        self._window = window
        self.path: str = ""
        self.name = UNTITLED
        self.format_name = NATIVE
        self._fingerprint: Fingerprint | None = None
        self._opened_losses: list[Loss] = []  # what the file lacked already when it was opened
        self._accepted_losses: list[Loss] = []
        self._saved_state: Mark | None = None
        self._asked_about: Fingerprint | None = None
        self._closing = False  # the window, as soon as the job under way is over
        window.jobs.changed.connect(self._job_changed)

    @property
    def modified(self) -> bool:
        """Whether the clip differs from what was last opened or surely saved."""
        return not self._window.undo_stack.isClean()

    # --- opening

    def new(self) -> bool:
        """An empty clip with one channel to draw in."""
        if self._busy() or not self.may_lose_changes():
            return False
        self._window.show_clip(Clip([Channel("value")], start=0.0, end=2.0))
        self._take_place("", UNTITLED, NATIVE, None, [])
        return True

    def ask_and_open(self) -> bool:
        """Open what the user chooses; a skeleton chosen alone names the channels of the clip that is open."""
        clip, skeleton = self._window.questions.path_to_open(self._folder())
        if clip:
            return self.open(clip, skeleton or None)
        return bool(skeleton) and self.name_channels(skeleton)

    def open(self, path: str, skeleton: str | None = None) -> bool:
        """Open the clip at *path*; a .skel names the channels of the clip that is open. False: nothing has changed."""
        if path.lower().endswith(".skel"):
            return self.name_channels(path)
        if self._busy() or not self.may_lose_changes():
            return False
        return self._read(path, skeleton, f"{display_name(path)} cannot be opened")

    def _read(self, path: str, skeleton: str | None, failure: str, *, keep_playhead: bool = False) -> bool:
        """Read the clip at *path* and show it; False, after a message, if that was not to be."""
        history, session = self._window.undo_stack, self._window.session
        before = history.mark()
        try:
            opened = self._window.jobs.run(
                f"Opening {display_name(path)}",
                lambda report: open_clip(path, skeleton, report),
                at_once=_small_file(path),
            )
        except FormatError as error:
            self._window.questions.tell_error(failure, error.advice)
            return False
        except CancelledError:
            self._window.say(f"{display_name(path)} was not opened")
            return False
        self._window.finish_entry()
        self._window.cancel_gesture()
        if not history.mark().same(before) and not self.may_lose_changes():
            return False  # what the user did to the old clip meanwhile is worth more
        playhead = session.playhead
        self.show_opened(opened)
        if keep_playhead:
            session.playhead = playhead
        return True

    def open_recent(self, path: str) -> bool:
        """Open *path* from the list of recent files, which may have gone."""
        if not os.path.exists(path):
            if self._window.questions.forget_missing(path):
                self._window.settings.remove_recent_file(path)
            return False
        return self.open(path)

    def show_opened(self, opened: Opened) -> None:
        """Show a clip that has been read."""
        self._window.show_clip(opened.clip)
        self.adopt(opened)

    def adopt(self, opened: Opened) -> None:
        """Take the file of *opened*, whose clip is in the window. A sample has no file: saving it asks where to."""
        if Path(opened.path).parent == SAMPLES_FOLDER:
            self._take_place("", Path(opened.path).stem, NATIVE, None, [])
            return
        name = display_name(opened.path)
        self._take_place(opened.path, name, opened.format_name, opened.fingerprint, opened.losses)
        self._remember(opened.path)

    def revert(self) -> bool:
        """Read the file again and forget what was done since."""
        return not self._busy() and self._window.questions.revert(self.name) and self._read_again()

    def name_channels(self, skeleton: str) -> bool:
        """Name the channels by the joints of a .skel, as one step that can be undone."""
        return name_channels(self._window, skeleton)

    def ask_and_name_channels(self) -> bool:
        """Name the channels by a .skel that the user chooses."""
        skeleton = self._window.questions.skeleton_to_open(self._folder())
        return bool(skeleton) and self.name_channels(skeleton)

    # --- saving

    def save(self) -> bool:
        """Write the clip to its file; asks for one if it has none. True when it is there."""
        if self._busy():
            return False
        self._window.finish_entry()
        self._window.cancel_gesture()
        if not self.path:
            return self.save_as()
        return self._save_to(self.path, self.format_name)

    def save_as(self, format_name: str | None = None) -> bool:
        """Write the clip to a file that the user chooses; the extension decides the format, else the kind chosen."""
        if self._busy():
            return False
        self._window.finish_entry()
        self._window.cancel_gesture()
        format_name = format_name or self.format_name
        stem = self.path or os.path.join(self._folder(), self.name)
        suggested = str(Path(stem).with_suffix(FORMATS[format_name].extension))
        path, chosen = self._window.questions.path_to_save(suggested, format_name)
        if not path:
            return False
        return self._save_to(os.path.abspath(path), format_of_path(path) or chosen)

    def _save_to(self, path: str, format_name: str) -> bool:
        name, state = display_name(path), self._window.undo_stack.mark()
        content = Content.of(self._window.document.clip)
        leave = Leave(self._accepted_losses, self._fingerprint, whatever=path != self.path)
        while True:
            try:
                saved = self._write(content, path, format_name, leave)
            except CancelledError:
                self._window.say(f"{name} was not saved")
                return False
            except (SaveError, FormatError) as error:
                self._window.questions.tell_error(f"{name} was not saved", str(error))
                return False
            if isinstance(saved, Saved):
                return self._saved(path, format_name, state, saved)
            if saved.overwrites_another:
                if not self._window.questions.overwrite_changed(name):
                    return False
                leave = leave._replace(whatever=True)
            else:
                answer = self._window.questions.lossy_save(name, saved.losses)
                if answer is Answer.NATIVE:
                    return self.save_as(NATIVE)
                if answer is not Answer.ANYWAY:
                    return False
                leave = leave._replace(losses=saved.losses)

    def _write(self, content: Content, path: str, format_name: str, leave: Leave) -> Saved | Doubt:
        def work(report: Report) -> Saved | Doubt:
            return save_clip(content, path, format_name, leave, report)

        return self._window.jobs.run(f"Saving {display_name(path)}", work, at_once=_small(content), vital=True)

    def _saved(self, path: str, format_name: str, state: Mark, saved: Saved) -> bool:
        """Tell that the clip is in its file as it was in *state*; whether the disk has confirmed it."""
        if path != self.path:
            self._opened_losses = []
        self.path, self.name, self.format_name = path, display_name(path), format_name
        self._fingerprint = self._asked_about = saved.fingerprint
        self._accepted_losses, self._saved_state = saved.losses, state
        self._remember(path)
        whole = not self._lacking()
        confirmed = saved.result.durability is Durability.CONFIRMED
        if whole and confirmed:
            self._window.undo_stack.set_saved(state)
        else:  # the file is another than what is shown, or the disk may still lose it: the clip counts as unsaved
            self._window.undo_stack.resetClean()
        self.changed.emit()
        without = ", ".join(dict.fromkeys(loss.what for loss in saved.losses))
        self._window.say(
            f"Saved to {self.name}" + ("" if whole else f" without {without}; the clip still differs from the file")
        )
        if saved.result.notes:
            self._window.questions.tell_warning(f"{self.name} was saved, but", "\n".join(saved.result.notes))
        return confirmed

    def may_lose_changes(self) -> bool:
        """Whether the clip may go: it is as saved, or the user saves it or gives it up."""
        self._window.finish_entry()
        self._window.cancel_gesture()
        if not self.modified:
            return True
        changed = not (self._saved_state and self._window.undo_stack.mark().same(self._saved_state))
        answer = self._window.questions.save_changes(self.name, self._lacking(), changed=changed)
        if answer not in (Answer.NATIVE, Answer.SAVE):
            return answer is Answer.DISCARD
        before = self._window.undo_stack.mark()
        if not (self.save_as(NATIVE) if answer is Answer.NATIVE else self.save()):
            return False
        # What the user did while it was being saved is not in the file.
        return self._window.undo_stack.mark().same(before) or self.may_lose_changes()

    def may_close(self) -> bool:
        """Whether the window may close now. What is being opened is given up, what is being saved is waited for."""
        job = self._window.jobs.job
        if job is None:
            return self.may_lose_changes()
        self._closing = True
        if not job.vital:
            job.cancel()
        return False

    def _job_changed(self) -> None:
        job = self._window.jobs.job
        self._window.view.set_notice("" if job is None else job.text)
        self._window.refresh_actions()
        if self._closing and self._window.jobs.job is None:
            self._closing = False
            QTimer.singleShot(0, self._window, self._close)

    def _close(self) -> None:
        """Close the window that waited for a job, when what is to be said of the job has been read."""
        if QApplication.activeModalWidget() is None:
            self._window.close()
        else:
            QTimer.singleShot(50, self._window, self._close)

    def _busy(self) -> bool:
        """Whether a file is being read or written, so that no other can be now; it is said then."""
        job = self._window.jobs.job
        if job is not None:
            self._window.say(f"{job.text} is still going on; Esc cancels it")
        return job is not None

    def _lacking(self) -> list[Loss]:
        """What the file has lost of the clip since it was opened, with the user's leave."""
        return [] if self._accepted_losses == self._opened_losses else self._accepted_losses

    # --- the file on disk

    def look_at_disk(self) -> None:
        """Offer to read the file again if another program has changed it; asks once for each version."""
        if not self.path or self._window.jobs.job is not None:
            return
        if self._fingerprint is not None and not os.path.exists(self.path):
            self._say_gone()
            return
        path, known = self.path, self._fingerprint
        try:
            changed, now = self._window.jobs.run(
                f"Looking at {self.name}", lambda _report: version_since(path, known), at_once=_small_file(path)
            )
        except CancelledError:
            return
        if not changed or now == self._asked_about:
            return
        self._asked_about = now
        reload = self._window.questions.reload_changed(self.name, modified=self.modified)
        if not (reload and self._read_again()):  # what is shown may now be the only copy
            self._window.undo_stack.resetClean()
            self.changed.emit()

    def _say_gone(self) -> None:
        self._fingerprint = None
        self._window.undo_stack.resetClean()
        self.changed.emit()
        self._window.say(f"{self.name} is gone from the disk; saving writes it again")

    def _read_again(self) -> bool:
        return self._read(self.path, None, f"{self.name} cannot be read again", keep_playhead=True)

    # --- common

    def _take_place(
        self, path: str, name: str, format_name: str, fingerprint: Fingerprint | None, lacks: list[Loss]
    ) -> None:
        self.path, self.name, self.format_name = path, name, format_name
        self._fingerprint = self._asked_about = fingerprint
        # What the file does not hold already is no news when it is saved there again.
        self._opened_losses = self._accepted_losses = lacks
        self.changed.emit()

    def _remember(self, path: str) -> None:
        self._window.settings.add_recent_file(path)
        self._window.settings.last_folder = str(Path(path).parent)

    def _folder(self) -> str:
        folder = str(Path(self.path).parent) if self.path else self._window.settings.last_folder
        return folder if os.path.isdir(folder) else home_folder()


def _small_file(path: str) -> bool:
    try:
        return os.path.getsize(path) <= FEW_BYTES
    except OSError:
        return True  # what is wrong is found at once


def _small(content: Content) -> bool:
    return len(content.channels) <= FEW_CHANNELS and sum(len(c.run) for c in content.channels) <= FEW_KEYS
