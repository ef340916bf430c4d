"""Files: the clip's file, whether the clip differs from it, and opening, saving and reloading with their questions."""

import os
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.clip_file import Fingerprint, Opened, changed_since, display_name, fingerprint_of, open_clip, read_regular
from app.file_menus import SAMPLES_FOLDER
from app.questions import Answer, home_folder
from model.channel import Channel
from model.clip import Clip
from model.document import Setting
from model.formats import FORMATS, FormatError, Loss, format_of_path, losses
from model.formats.error import TextError
from model.formats.skel import channel_names, channel_units, joint_names
from model.saving import Durability, SaveError, save_clip, sweep_temp

if TYPE_CHECKING:
    from app.main_window import MainWindow

UNTITLED = "Untitled"
NATIVE = "hermite"


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
        self._asked_about: Fingerprint | None = None

    @property
    def modified(self) -> bool:
        """Whether the clip differs from what was last opened or surely saved."""
        return not self._window.undo_stack.isClean()

    # --- opening

    def new(self) -> bool:
        """An empty clip with one channel to draw in."""
        if not self.may_lose_changes():
            return False
        self._window.show_clip(Clip([Channel("value")], start=0.0, end=2.0))
        self._take_place("", UNTITLED, NATIVE, None)
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
        if not self.may_lose_changes():
            return False
        try:
            opened = open_clip(path, skeleton)
        except FormatError as error:
            self._window.questions.tell_error(f"{display_name(path)} cannot be opened", error.advice)
            return False
        self.show_opened(opened)
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
            self._take_place("", Path(opened.path).stem, NATIVE, None)
            return
        self._take_place(opened.path, display_name(opened.path), opened.format_name, opened.fingerprint)
        self._remember(opened.path)
        sweep_temp(opened.path)

    def revert(self) -> bool:
        """Read the file again and forget what was done since."""
        return self._window.questions.revert(self.name) and self._read_again()

    def name_channels(self, skeleton: str) -> bool:
        """Name the channels by the joints of a .skel, as one step that can be undone."""
        clip = self._window.document.clip
        try:
            data = read_regular(skeleton)
            joints = joint_names(data)
        except TextError as fault:
            return self._refuse_skeleton(skeleton, str(fault.in_file(skeleton, data)))
        except OSError as error:
            return self._refuse_skeleton(skeleton, f"{skeleton}: {error.strerror or error}")
        names, units = channel_names(joints), channel_units(3 + 3 * len(joints))
        if len(names) != len(clip.channels):
            problem = f"it has {len(joints)} joints, that is {len(names)} channels; the clip has {len(clip.channels)}"
            return self._refuse_skeleton(skeleton, problem)
        self._window.document.do(
            f"Name channels by {display_name(skeleton)}",
            lambda clip: [
                Setting(channel, field, getattr(channel, field), value)
                for channel, name, unit in zip(clip.channels, names, units, strict=True)
                for field, value in (("name", name), ("unit", unit))
            ],
        )
        return True

    def ask_and_name_channels(self) -> bool:
        """Name the channels by a .skel that the user chooses."""
        skeleton = self._window.questions.skeleton_to_open(self._folder())
        return bool(skeleton) and self.name_channels(skeleton)

    def _refuse_skeleton(self, skeleton: str, problem: str) -> bool:
        self._window.questions.tell_error(f"{display_name(skeleton)} does not name these channels", problem)
        return False

    # --- saving

    def save(self) -> bool:
        """Write the clip to its file; asks for one if it has none. True when it is there."""
        self._window.finish_entry()
        self._window.cancel_gesture()
        if not self.path:
            return self.save_as()
        return self._save_to(self.path, self.format_name)

    def save_as(self, format_name: str | None = None) -> bool:
        """Write the clip to a file that the user chooses; the extension decides the format, else the kind chosen."""
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
        lost = losses(self._window.document.clip, format_name, path)
        if lost and lost != self._accepted_losses:
            answer = self._window.questions.lossy_save(display_name(path), lost)
            if answer is Answer.NATIVE:
                return self.save_as(NATIVE)
            if answer is not Answer.ANYWAY:
                return False
        taken = path == self.path and os.path.exists(path) and changed_since(path, self._fingerprint)
        if taken and not self._window.questions.overwrite_changed(display_name(path)):
            return False
        try:
            result = save_clip(self._window.document.clip, path, format_name)
        except (SaveError, FormatError) as error:
            self._window.questions.tell_error(f"{display_name(path)} was not saved", str(error))
            return False
        if path != self.path:
            self._opened_losses = []
        self.path, self.name, self.format_name = path, display_name(path), format_name
        self._fingerprint = self._asked_about = fingerprint_of(path)
        self._accepted_losses = lost
        self._remember(path)
        whole = not self._lacking()
        if whole and result.durability is Durability.CONFIRMED:
            self._window.undo_stack.setClean()
        else:  # the file is another than what is shown, or the disk may still lose it: the clip counts as unsaved
            self._window.undo_stack.resetClean()
        self.changed.emit()
        without = ", ".join(dict.fromkeys(loss.what for loss in lost))
        self._window.say(
            f"Saved to {self.name}" + ("" if whole else f" without {without}; the clip still differs from the file")
        )
        if result.notes:
            self._window.questions.tell_warning(f"{self.name} was saved, but", "\n".join(result.notes))
        return result.durability is Durability.CONFIRMED

    def may_lose_changes(self) -> bool:
        """Whether the clip may go: it is as saved, or the user saves it or gives it up."""
        self._window.finish_entry()
        self._window.cancel_gesture()
        if not self.modified:
            return True
        answer = self._window.questions.save_changes(self.name, self._lacking())
        if answer is Answer.NATIVE:
            return self.save_as(NATIVE)
        return self.save() if answer is Answer.SAVE else answer is Answer.DISCARD

    def _lacking(self) -> list[Loss]:
        """What the file has lost of the clip since it was opened, with the user's leave."""
        return [] if self._accepted_losses == self._opened_losses else self._accepted_losses

    # --- the file on disk

    def look_at_disk(self) -> None:
        """Offer to read the file again if another program has changed it; asks once for each version."""
        if not self.path or not changed_since(self.path, self._fingerprint):
            if self.path and self._fingerprint is not None and not os.path.exists(self.path):
                self._say_gone()
            return
        now = fingerprint_of(self.path)
        if now == self._asked_about:
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
        try:
            opened = open_clip(self.path)
        except FormatError as error:
            self._window.questions.tell_error(f"{self.name} cannot be read again", error.advice)
            return False
        playhead = self._window.session.playhead
        self.show_opened(opened)
        self._window.session.playhead = playhead
        return True

    # --- common

    def _take_place(self, path: str, name: str, format_name: str, fingerprint: Fingerprint | None) -> None:
        self.path, self.name, self.format_name = path, name, format_name
        self._fingerprint = self._asked_about = fingerprint
        # What the file does not hold already is no news when it is saved there again.
        self._opened_losses = losses(self._window.document.clip, format_name, path or None)
        self._accepted_losses = self._opened_losses
        self.changed.emit()

    def _remember(self, path: str) -> None:
        self._window.settings.add_recent_file(path)
        self._window.settings.last_folder = str(Path(path).parent)

    def _folder(self) -> str:
        folder = str(Path(self.path).parent) if self.path else self._window.settings.last_folder
        return folder if os.path.isdir(folder) else home_folder()
