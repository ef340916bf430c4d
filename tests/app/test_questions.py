"""The dialogs that ask: each answer comes from its button, Esc is cancel, and no text is taken for HTML."""

from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog, QFileDialog, QLabel, QMessageBox, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from app.questions import Answer, Questions, format_filters, listed
from model.formats import Loss

NAME = "<b>walk</b>.anim"
LOST = [
    Loss("steps", "18 keys of lamp no longer hold their values", in_motion=True),
    Loss("names", "the name of lamp is lost", in_motion=False),
]

type Ask = Callable[[Questions], object]

ASKED: list[tuple[Ask, str, object]] = [
    (lambda q: q.save_changes(NAME), "Save", Answer.SAVE),
    (lambda q: q.save_changes(NAME), "Don't Save", Answer.DISCARD),
    (lambda q: q.save_changes(NAME), "Cancel", Answer.CANCEL),
    (lambda q: q.save_changes(NAME, LOST), "Save as Hermite Clip…", Answer.NATIVE),
    (lambda q: q.save_changes(NAME, LOST), "Save to .anim", Answer.SAVE),
    (lambda q: q.save_changes(NAME, LOST), "Don't Save", Answer.DISCARD),
    (lambda q: q.lossy_save(NAME, LOST), "Save as Hermite Clip…", Answer.NATIVE),
    (lambda q: q.lossy_save(NAME, LOST), "Save Anyway", Answer.ANYWAY),
    (lambda q: q.overwrite_changed(NAME), "Replace It", True),
    (lambda q: q.reload_changed(NAME, modified=True), "Read Again", True),
    (lambda q: q.reload_changed(NAME, modified=False), "Keep This", False),
    (lambda q: q.revert(NAME), "Revert", True),
    (lambda q: q.forget_missing(NAME), "Remove from List", True),
]
ESCAPED: list[tuple[Ask, object]] = [
    (lambda q: q.save_changes(NAME), Answer.CANCEL),
    (lambda q: q.save_changes(NAME, LOST), Answer.CANCEL),
    (lambda q: q.lossy_save(NAME, LOST), Answer.CANCEL),
    (lambda q: q.overwrite_changed(NAME), False),
    (lambda q: q.reload_changed(NAME, modified=False), False),
    (lambda q: q.revert(NAME), False),
    (lambda q: q.forget_missing(NAME), False),
    (lambda q: q.tell_error("Not saved", NAME), None),
]


@pytest.fixture
def questions(qtbot: QtBot) -> Questions:
    parent = QWidget()
    qtbot.addWidget(parent)
    parent.show()
    return Questions(parent)


def in_the_dialog(act: Callable[[QDialog], object]) -> None:
    """Call *act* with the dialog that is about to open."""

    def meet() -> None:
        dialog = QApplication.activeModalWidget()
        assert isinstance(dialog, QDialog)
        act(dialog)

    QTimer.singleShot(0, meet)


@pytest.mark.parametrize(("ask", "button", "answer"), ASKED)
def test_each_button_gives_its_answer(questions: Questions, ask: Ask, button: str, answer: object) -> None:
    def press(dialog: QDialog) -> None:
        assert isinstance(dialog, QMessageBox)
        texts = {one.text().replace("&", ""): one for one in dialog.buttons()}
        texts[button].click()

    in_the_dialog(press)
    assert ask(questions) == answer


@pytest.mark.parametrize("changed", [True, False])
def test_only_what_has_changed_is_said_to_be_lost_too(questions: Questions, changed: bool) -> None:
    texts = []

    def read(dialog: QDialog) -> None:
        assert isinstance(dialog, QMessageBox)
        texts.append(dialog.informativeText())
        dialog.reject()

    in_the_dialog(read)
    questions.save_changes(NAME, LOST, changed=changed)
    assert ("would be lost too" in texts[0]) is changed


@pytest.mark.parametrize(("ask", "answer"), ESCAPED)
def test_esc_is_cancel_and_names_are_shown_as_they_are(questions: Questions, ask: Ask, answer: object) -> None:
    def escape(dialog: QDialog) -> None:
        labels = [label for label in dialog.findChildren(QLabel) if label.text()]
        assert any(NAME in label.text() for label in labels)
        assert all(label.textFormat() == Qt.TextFormat.PlainText for label in labels)
        QTest.keyClick(dialog, Qt.Key.Key_Escape)

    in_the_dialog(escape)
    assert ask(questions) == answer


def test_the_name_follows_the_kind_that_is_chosen(questions: Questions, tmp_path: Path) -> None:
    def choose_course_format(dialog: QDialog) -> None:
        assert isinstance(dialog, QFileDialog)
        dialog.selectNameFilter(format_filters()["anim"])
        dialog.filterSelected.emit(format_filters()["anim"])
        dialog.accept()

    in_the_dialog(choose_course_format)
    path, chosen = questions.path_to_save(str(tmp_path / "walk.hermite"), "hermite")
    assert (Path(path).name, chosen) == ("walk.anim", "anim")


def test_a_name_without_an_extension_gets_that_of_its_kind(questions: Questions, tmp_path: Path) -> None:
    def accept(dialog: QDialog) -> None:
        assert isinstance(dialog, QFileDialog)
        dialog.selectFile("run")
        dialog.accept()

    in_the_dialog(accept)
    path, chosen = questions.path_to_save(str(tmp_path / "walk.hermite"), "hermite")
    assert (Path(path).name, chosen) == ("run.hermite", "hermite")


def test_a_skeleton_chosen_with_a_clip_is_kept_apart(questions: Questions, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(QFileDialog, "getOpenFileNames", lambda *_: (["/a/walk.skel", "/a/walk.anim"], ""))
    assert questions.path_to_open("/a") == ("/a/walk.anim", "/a/walk.skel")


def test_what_changes_the_motion_is_told_apart_from_what_changes_the_editing() -> None:
    assert listed(LOST).splitlines() == [
        "The motion changes:",
        "•  18 keys of lamp no longer hold their values",
        "",
        "Lost for editing, the motion stays:",
        "•  the name of lamp is lost",
    ]
    assert "motion changes" not in listed(LOST[1:])


def test_no_button_wears_an_icon_of_the_style(questions: Questions) -> None:
    icons: list[bool] = []

    def look(dialog: QDialog) -> None:
        buttons = dialog.findChildren(QPushButton)
        icons.extend(button.icon().isNull() for button in buttons)
        QTest.keyClick(dialog, Qt.Key.Key_Escape)

    for tell in (questions.tell_error, questions.tell_warning):
        in_the_dialog(look)
        tell("Not opened", NAME)
    assert icons == [True, True]
