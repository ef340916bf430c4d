"""Questions: every dialog that waits for an answer, in one place, so that a test can give the answers."""

import os
from collections.abc import Sequence
from enum import Enum, auto
from functools import partial
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QIcon
from PySide6.QtWidgets import (
    QColorDialog,
    QDialog,
    QFileDialog,
    QInputDialog,
    QLabel,
    QLineEdit,
    QMessageBox,
    QPushButton,
    QWidget,
)

from model.formats import FORMATS, Loss, format_of_path

Icon, Role, Standard = QMessageBox.Icon, QMessageBox.ButtonRole, QMessageBox.StandardButton


class Answer(Enum):
    """What was chosen; CANCEL is also Esc and the window's own close button."""

    SAVE = auto()
    DISCARD = auto()
    NATIVE = auto()
    ANYWAY = auto()
    RELOAD = auto()
    REMOVE = auto()
    CANCEL = auto()


class Questions:
    """Asks in modal dialogs over *parent*. All texts are shown as they are: names of files are never read as HTML."""

    def __init__(self, parent: QWidget) -> None:
        self._parent = parent

    def save_changes(self, name: str, lacking: Sequence[Loss] = (), *, changed: bool = True) -> Answer:
        """Before unsaved changes would be lost: SAVE, DISCARD or CANCEL; NATIVE if the file is *lacking* something.

        *changed* says whether there is more to lose than that.
        """
        if lacking:
            return self._save_what_is_lacking(name, lacking, changed=changed)
        box = self._box(Icon.Warning, f"Save the changes to {name}?", "Otherwise what changed since is lost.")
        box.setStandardButtons(Standard.Save | Standard.Discard | Standard.Cancel)
        box.button(Standard.Discard).setText("&Don't Save")
        box.setDefaultButton(Standard.Save)
        box.setEscapeButton(Standard.Cancel)
        chosen = _run(box)
        return {Standard.Save: Answer.SAVE, Standard.Discard: Answer.DISCARD}.get(Standard(chosen), Answer.CANCEL)

    def _save_what_is_lacking(self, name: str, lacking: Sequence[Loss], *, changed: bool) -> Answer:
        text = "Only a Hermite clip keeps it all."
        if changed:
            text += f" What changed since {name} was saved would be lost too."
        box = self._box(Icon.Warning, f"{name} does not hold all of this clip", f"{listed(lacking)}\n\n{text}")
        native = box.addButton("Save as &Hermite Clip…", Role.AcceptRole)
        again = box.addButton(f"&Save to {Path(name).suffix or 'the File'}", Role.AcceptRole)
        discard = box.addButton("&Don't Save", Role.DestructiveRole)
        cancel = box.addButton(Standard.Cancel)
        answers = {native: Answer.NATIVE, again: Answer.SAVE, discard: Answer.DISCARD}
        return self._chosen(box, answers, default=native, escape=cancel)

    def lossy_save(self, name: str, losses: Sequence[Loss]) -> Answer:
        """The format cannot hold all of the clip: NATIVE, ANYWAY or CANCEL."""
        box = self._box(Icon.Warning, f"{name} cannot hold all of this clip", listed(losses))
        native = box.addButton("Save as &Hermite Clip…", Role.AcceptRole)
        anyway = box.addButton("Save &Anyway", Role.DestructiveRole)
        cancel = box.addButton(Standard.Cancel)
        return self._chosen(box, {native: Answer.NATIVE, anyway: Answer.ANYWAY}, default=native, escape=cancel)

    def overwrite_changed(self, name: str) -> bool:
        """Whether to write over a file that another program has changed since it was opened."""
        box = self._box(
            Icon.Warning,
            f"{name} was changed by another program",
            "It is not what was opened here any more. Saving now replaces that other version.",
        )
        replace = box.addButton("&Replace It", Role.DestructiveRole)
        cancel = box.addButton(Standard.Cancel)
        return self._chosen(box, {replace: Answer.ANYWAY}, default=cancel, escape=cancel) is Answer.ANYWAY

    def reload_changed(self, name: str, *, modified: bool) -> bool:
        """Whether to read a file again that another program has changed."""
        more = " Your own unsaved changes would be lost." if modified else ""
        box = self._box(Icon.Question, f"{name} was changed by another program", f"Read it again?{more}")
        reload = box.addButton("&Read Again", Role.AcceptRole)
        keep = box.addButton("&Keep This", Role.RejectRole)
        default = keep if modified else reload
        return self._chosen(box, {reload: Answer.RELOAD}, default=default, escape=keep) is Answer.RELOAD

    def revert(self, name: str) -> bool:
        """Whether to drop all changes since the file was opened or saved."""
        box = self._box(Icon.Warning, f"Read {name} again?", "All changes since it was saved are lost.")
        revert = box.addButton("&Revert", Role.DestructiveRole)
        cancel = box.addButton(Standard.Cancel)
        return self._chosen(box, {revert: Answer.DISCARD}, default=cancel, escape=cancel) is Answer.DISCARD

    def forget_missing(self, path: str) -> bool:
        """Whether to take a recent file that is gone out of the list."""
        box = self._box(Icon.Information, "This file is not there any more", path)
        remove = box.addButton("&Remove from List", Role.AcceptRole)
        cancel = box.addButton(Standard.Cancel)
        return self._chosen(box, {remove: Answer.REMOVE}, default=remove, escape=cancel) is Answer.REMOVE

    def path_to_open(self, folder: str) -> tuple[str, str]:
        """(clip, skeleton) to open; both may be empty."""
        patterns = " ".join(f"*{row.extension}" for row in FORMATS.values())
        filters = [f"Clips and skeletons ({patterns} *.skel)", *format_filters().values(), "All files (*)"]
        paths, _ = QFileDialog.getOpenFileNames(self._parent, "Open Clip", folder, ";;".join(filters))
        skeletons = [path for path in paths if path.lower().endswith(".skel")]
        clips = [path for path in paths if path not in skeletons]
        return (clips[0] if clips else ""), (skeletons[0] if skeletons else "")

    def skeleton_to_open(self, folder: str) -> str:
        """The .skel file whose joints name the channels, or nothing."""
        filters = "Skeletons (*.skel);;All files (*)"
        path, _ = QFileDialog.getOpenFileName(self._parent, "Name Channels", folder, filters)
        return path

    def path_to_save(self, suggested: str, format_name: str) -> tuple[str, str]:
        """(path, name of the format) to save to, with the extension of the chosen kind; empty if cancelled."""
        filters = format_filters()
        dialog = QFileDialog(self._parent, "Save Clip", str(Path(suggested).parent))
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setNameFilters(list(filters.values()))
        dialog.selectNameFilter(filters[format_name])
        dialog.setDefaultSuffix(FORMATS[format_name].extension)
        dialog.filterSelected.connect(partial(_take_extension, dialog))
        dialog.selectFile(Path(suggested).name)
        if _run(dialog) != QDialog.DialogCode.Accepted:
            return "", ""
        chosen = next(name for name, text in filters.items() if text == dialog.selectedNameFilter())
        return dialog.selectedFiles()[0], chosen

    def text(self, title: str, label: str, text: str) -> str:
        """A line of text, without blanks around it; empty if cancelled."""
        answer, accepted = QInputDialog.getText(self._parent, title, label, QLineEdit.EchoMode.Normal, text)
        return answer.strip() if accepted else ""

    def color(self, color: QColor) -> QColor:
        """A colour; not valid if cancelled."""
        return QColorDialog.getColor(color, self._parent, "Color")

    def tell_error(self, heading: str, text: str) -> None:
        """Something did not work: what, where, and what to do about it."""
        self._tell(Icon.Critical, heading, text)

    def tell_warning(self, heading: str, text: str) -> None:
        """Something worked, but not wholly."""
        self._tell(Icon.Warning, heading, text)

    def _tell(self, icon: QMessageBox.Icon, heading: str, text: str) -> None:
        box = self._box(icon, heading, text)
        box.setStandardButtons(Standard.Ok)  # Qt's own, added when the box opens, would come with an icon
        _run(box)

    def _box(self, icon: QMessageBox.Icon, heading: str, text: str) -> QMessageBox:
        box = QMessageBox(icon, "Hermite", heading, Standard.NoButton, self._parent)
        box.setInformativeText(text)
        box.setTextFormat(Qt.TextFormat.PlainText)
        for label in box.findChildren(QLabel):
            label.setTextFormat(Qt.TextFormat.PlainText)  # the box's own setting reaches the heading only
            if label.objectName() == "qt_msgbox_label":
                label.setStyleSheet("font-weight: bold")
        return box

    def _chosen(
        self, box: QMessageBox, answers: dict[QPushButton, Answer], *, default: QPushButton, escape: QPushButton
    ) -> Answer:
        box.setDefaultButton(default)
        box.setEscapeButton(escape)
        _run(box)
        clicked = box.clickedButton()
        return next((answer for button, answer in answers.items() if button is clicked), Answer.CANCEL)


def _run(dialog: QDialog) -> int:
    """Wait for the answer; the dialog can still be asked until control returns to Qt, then it is gone."""
    for button in dialog.findChildren(QPushButton):
        button.setIcon(QIcon())  # Fusion's own icons ignore dark themes
    answer = dialog.exec()
    dialog.deleteLater()
    return answer


def listed(losses: Sequence[Loss]) -> str:
    """What is lost, first what is seen when the clip plays, then what is only met when it is edited."""
    parts = []
    for heading, in_motion in (("The motion changes:", True), ("Lost for editing, the motion stays:", False)):
        lines = [f"•  {loss}" for loss in losses if loss.in_motion is in_motion]
        if lines:
            parts.append("\n".join([heading, *lines]))
    return "\n\n".join(parts)


def format_filters() -> dict[str, str]:
    """Name of a format -> its line in file dialogs."""
    return {name: f"{row.label} (*{row.extension})" for name, row in FORMATS.items()}


def _take_extension(dialog: QFileDialog, name_filter: str) -> None:
    """Give the name in *dialog* the extension of the kind that was chosen, if it had that of another kind."""
    extension = next(row.extension for row in FORMATS.values() if f"*{row.extension})" in name_filter)
    dialog.setDefaultSuffix(extension)
    path = Path(dialog.selectedFiles()[0])
    if format_of_path(path) is not None:
        dialog.selectFile(path.with_suffix(extension).name)


def home_folder() -> str:
    """Where the first file dialog starts."""
    documents = os.path.join(os.path.expanduser("~"), "Documents")
    return documents if os.path.isdir(documents) else os.path.expanduser("~")
