"""Opening and saving: what is asked, what is told, what is on the disk afterwards, and the mark in the title."""

from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

import app.clip_file
from app.file_menus import SAMPLES_FOLDER, RecentMenu, samples
from app.main_window import MainWindow
from app.questions import Answer
from model.channel import Channel
from model.clip import Clip
from model.formats import read_clip, write_bytes
from model.formats.content import Content
from model.keyframe import make_run
from model.progress import Report
from model.saving import Durability, LastLook, SaveError, SaveResult, Witness, save_content
from tests.app.conftest import MakeWindow, answers_of, small_clip


def change(window: MainWindow) -> None:
    window.actions_by_id["edit.select_all"].run()
    window.actions_by_id["key.up"].run()


def test_the_title_names_the_file_and_marks_exactly_what_differs(opened: MainWindow) -> None:
    assert opened.windowTitle() == "walk & run.hermite[*] — Hermite"
    assert not opened.isWindowModified()
    change(opened)
    assert opened.isWindowModified()
    opened.undo_stack.undo()
    assert not opened.isWindowModified()
    opened.undo_stack.redo()
    assert opened.save()
    assert not opened.isWindowModified()
    opened.undo_stack.undo()
    assert opened.isWindowModified()


def test_what_is_saved_is_what_is_read_again(opened: MainWindow, path: Path) -> None:
    change(opened)
    wanted = opened.document.clip.channels[0].run()
    assert opened.save()
    assert read_clip(path).channels[0].run().tolist() == wanted.tolist()
    assert answers_of(opened).asked == []


def test_a_file_that_cannot_be_read_changes_nothing_and_is_named(opened: MainWindow, tmp_path: Path) -> None:
    broken = tmp_path / "broken.hermite"
    broken.write_text("hermite 1\nnonsense\n")
    clip = opened.document.clip
    assert not opened.open_file(str(broken))
    assert opened.document.clip is clip
    assert "broken.hermite:2" in answers_of(opened).told[0]


@pytest.mark.parametrize("data", ["hermite 1\nnonsense\n", "animation {\n range 0 1\n numchannels x", "", "no clip"])
def test_a_message_on_a_bad_file_says_what_to_do(window: MainWindow, tmp_path: Path, data: str) -> None:
    bad = tmp_path / "bad.anim"
    bad.write_text(data)
    assert not window.open_file(str(bad))
    (told,) = answers_of(window).told
    assert any(word in told for word in ("; ", "Mend that place", "Choose another file"))


@pytest.mark.parametrize(
    ("answer", "gone", "saved"),
    [
        (Answer.CANCEL, False, False),
        (Answer.DISCARD, True, False),
        (Answer.SAVE, True, True),
    ],
)
def test_unsaved_changes_are_asked_about(
    opened: MainWindow, path: Path, answer: Answer, gone: bool, saved: bool
) -> None:
    before = path.read_bytes()
    change(opened)
    answers_of(opened).answers["save_changes"] = answer
    assert opened.files.new() is gone
    assert (path.read_bytes() != before) is saved
    assert answers_of(opened).asked == ["save_changes"]


def test_closing_asks_only_when_something_would_be_lost(opened: MainWindow) -> None:
    change(opened)
    assert not opened.close()
    assert opened.isVisible()
    opened.undo_stack.undo()
    assert opened.close()
    assert answers_of(opened).asked == ["save_changes"]


def test_a_sample_has_no_file_to_be_overwritten(window: MainWindow, tmp_path: Path) -> None:
    sample = samples()[0]
    assert window.open_file(str(sample))
    assert window.files.path == ""
    target = tmp_path / "mine.hermite"
    answers_of(window).answers["path_to_save"] = (str(target), "hermite")
    assert window.save()
    assert window.files.path == str(target)
    assert SAMPLES_FOLDER not in Path(window.files.path).parents


def test_the_extension_decides_the_format_and_else_the_chosen_kind(window: MainWindow, tmp_path: Path) -> None:
    answers = answers_of(window).answers
    answers["lossy_save"] = Answer.ANYWAY
    answers["path_to_save"] = (str(tmp_path / "a.anim"), "hermite")
    assert window.save_as()
    assert (tmp_path / "a.anim").read_bytes().startswith(b"animation")
    answers["path_to_save"] = (str(tmp_path / "a.txt"), "hermite")
    assert window.save_as()
    assert (tmp_path / "a.txt").read_bytes().startswith(b"hermite")


def test_a_format_that_cannot_hold_the_clip_is_not_written_unasked(window: MainWindow, tmp_path: Path) -> None:
    answers, target = answers_of(window), tmp_path / "a.anim"
    answers.answers["path_to_save"] = (str(target), "anim")
    assert not window.save_as()
    assert answers.asked == ["path_to_save", "lossy_save"]
    assert not target.exists()
    answers.answers["lossy_save"] = Answer.ANYWAY
    assert window.save_as()
    answers.asked.clear()
    change(window)
    assert window.save()
    assert answers.asked == []  # the same losses are not asked about twice


def test_a_clip_that_its_file_cannot_hold_stays_unsaved_and_is_asked_about_on_closing(
    window: MainWindow, tmp_path: Path
) -> None:
    answers = answers_of(window)
    answers.answers |= {"path_to_save": (str(tmp_path / "out.anim"), "anim"), "lossy_save": Answer.ANYWAY}
    assert window.save_as()
    assert window.files.path == str(tmp_path / "out.anim")
    assert window.isWindowModified()
    said = "Saved to out.anim without names, units; the clip still differs from the file"
    assert window.status.message.text() == said
    answers.asked.clear()
    assert not window.close()
    assert not answers.changed
    answers.answers |= {"save_changes": Answer.NATIVE, "path_to_save": (str(tmp_path / "out.hermite"), "hermite")}
    assert window.close()
    assert answers.asked == ["save_changes", "save_changes", "path_to_save"]
    assert read_clip(tmp_path / "out.hermite").channels[0].name == "root.tx"


def test_what_an_opened_file_lacked_from_the_start_is_no_change(window: MainWindow, tmp_path: Path) -> None:
    course, skeleton = tmp_path / "walk.anim", tmp_path / "elsewhere.skel"
    clip = Clip([Channel(f"c{number}", make_run([0.0, 1.0], [0.0, 1.0])) for number in range(6)])
    course.write_bytes(write_bytes(clip, "anim"))
    skeleton.write_bytes(SKELETON)
    assert window.open_file(str(course), str(skeleton))
    assert window.document.clip.channels[0].name == "root.tx"
    change(window)
    assert window.save()
    assert not window.isWindowModified()
    assert answers_of(window).asked == []


def typed(window: MainWindow, text: str) -> None:
    """Type a value without Enter, with the keyboard elsewhere when the next command comes."""
    window.actions_by_id["edit.select_all"].run()
    field = window.inspector.key.fields["value"]
    field.setText(text)
    field.textEdited.emit(text)


def test_a_number_that_is_being_typed_is_saved_with_the_rest(opened: MainWindow, path: Path) -> None:
    typed(opened, "7")
    assert opened.actions_by_id["file.save"].isEnabled()
    assert opened.save()
    assert read_clip(path).channels[0].run()["value"].tolist() == [7.0] * 4


def test_a_number_that_is_being_typed_is_not_thrown_away_unasked(opened: MainWindow, path: Path) -> None:
    typed(opened, "7")
    assert not opened.close()
    assert answers_of(opened).asked == ["save_changes"]
    assert opened.document.clip.channels[0].run()["value"].tolist() == [7.0] * 4


def test_a_name_that_is_being_typed_is_saved_too(opened: MainWindow, path: Path) -> None:
    name = opened.inspector.channel.name
    name.clear()
    QTest.keyClicks(name, "hip.tx")
    assert opened.actions_by_id["file.save"].isEnabled()
    opened.actions_by_id["file.save"].run()
    assert read_clip(path).channels[0].name == "hip.tx"


def test_a_file_that_may_not_be_written_is_left_alone(opened: MainWindow, path: Path) -> None:
    before = path.read_bytes()
    path.chmod(0o444)
    change(opened)
    assert not opened.save()
    assert "read-only" in answers_of(opened).told[0]
    assert path.read_bytes() == before
    assert opened.isWindowModified()


def test_another_file_is_opened_with_the_playhead_at_its_start_and_read_again_where_it_was(
    window: MainWindow, tmp_path: Path
) -> None:
    file = tmp_path / "late.hermite"
    file.write_bytes(write_bytes(Clip([Channel("a", make_run([5.0], [1.0]))], start=5.0, end=6.0), "hermite"))
    window.session.playhead = 0.7
    assert window.open_file(str(file))
    assert window.session.playhead == 5.0
    window.session.playhead = 5.5
    answers_of(window).answers["revert"] = True
    assert window.files.revert()
    assert window.session.playhead == 5.5


def test_native_is_offered_instead_and_taken(
    window: MainWindow, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    answers = answers_of(window)
    answers.answers["lossy_save"] = Answer.NATIVE
    suggestions: list[str] = []

    def path_to_save(suggested: str, format_name: str) -> tuple[str, str]:
        suggestions.append(suggested)
        return str(tmp_path / f"a.{format_name}"), format_name

    monkeypatch.setattr(answers, "path_to_save", path_to_save)
    assert window.save_as("anim")
    assert [Path(suggested).suffix for suggested in suggestions] == [".anim", ".hermite"]
    assert window.files.path == str(tmp_path / "a.hermite")


def test_a_failed_save_is_told_and_the_clip_stays_unsaved(opened: MainWindow, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*of_the_save: object) -> SaveResult:
        raise SaveError("mine.hermite", "no space left on the device")

    monkeypatch.setattr(app.clip_file, "save_content", fail)
    change(opened)
    assert not opened.save()
    assert "no space left" in answers_of(opened).told[0]
    assert opened.isWindowModified()


def test_a_save_that_the_disk_did_not_confirm_counts_as_unsaved(
    opened: MainWindow, monkeypatch: pytest.MonkeyPatch
) -> None:
    def doubt(
        content: Content, path: str, format_name: str, report: Report, last_look: LastLook, witness: Witness
    ) -> SaveResult:
        save_content(content, path, format_name, report, last_look, witness)
        return SaveResult(Path(path), Durability.UNCONFIRMED, ("the disk did not confirm the save",))

    monkeypatch.setattr(app.clip_file, "save_content", doubt)
    change(opened)
    assert not opened.save()
    assert "did not confirm" in answers_of(opened).told[0]
    assert opened.isWindowModified()
    opened.undo_stack.undo()
    assert opened.isWindowModified()


def test_reverting_reads_the_file_again(opened: MainWindow) -> None:
    change(opened)
    assert not opened.files.revert()
    answers_of(opened).answers["revert"] = True
    assert opened.files.revert()
    assert not opened.isWindowModified()
    assert opened.document.clip.channels[0].run()["value"].tolist() == [0.0, 1.0, -1.0, 0.5]


def test_recent_files_are_shown_as_they_are_called_and_missing_ones_can_go(opened: MainWindow, path: Path) -> None:
    menu = RecentMenu(opened)
    menu.fill()
    first = menu.actions()[0]
    assert first.text() == "walk && run.hermite"
    path.unlink()
    first.trigger()
    assert opened.settings.recent_files == [str(path)]
    answers_of(opened).answers["forget_missing"] = True
    first.trigger()
    assert opened.settings.recent_files == []


def test_a_file_dropped_on_the_graph_is_opened(qtbot: QtBot, window: MainWindow, path: Path) -> None:
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(path))])
    copy, left, plain = Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    middle = window.view.mapTo(window, window.view.rect().center())
    target = window.childAt(middle)
    while target is not None and not target.acceptDrops():
        target = target.parentWidget()
    assert target is window
    enter = QDragEnterEvent(QPointF(middle), copy, mime, left, plain)
    QApplication.sendEvent(window, enter)
    assert enter.isAccepted()
    QApplication.sendEvent(window, QDropEvent(QPointF(middle), copy, mime, left, plain))
    qtbot.waitUntil(lambda: window.files.path == str(path))


SKELETON = b"balljoint root {\n offset 0 0 0\n}\n"


def test_a_skeleton_names_the_channels_as_one_step(make_window: MakeWindow, tmp_path: Path) -> None:
    clip = small_clip()
    clip.channels += [channel.copy() for channel in clip.channels]
    for number, channel in enumerate(clip.channels):
        channel.name = f"channel{number}"
    window = make_window(clip)
    skeleton = tmp_path / "one.skel"
    skeleton.write_bytes(SKELETON)
    assert window.open_file(str(skeleton))
    names = [channel.name for channel in clip.channels]
    assert names == ["root.tx", "root.ty", "root.tz", "root.rx", "root.ry", "root.rz"]
    assert [channel.unit for channel in clip.channels[3:]] == ["angle"] * 3
    assert window.undo_stack.count() == 1
    window.undo_stack.undo()
    assert clip.channels[0].name == "channel0"


def test_a_skeleton_of_another_body_is_refused_with_both_numbers(window: MainWindow, tmp_path: Path) -> None:
    skeleton = tmp_path / "one.skel"
    skeleton.write_bytes(SKELETON)
    assert not window.open_file(str(skeleton))
    assert "6 channels" in answers_of(window).told[0]
    assert "the clip has 3" in answers_of(window).told[0]


def test_a_clip_is_opened_with_both_ends_of_its_range_in_sight(window: MainWindow, tmp_path: Path) -> None:
    file, keys = tmp_path / "walk.anim", make_run([0.0, 1.2], [0.0, 1.0])
    file.write_bytes(write_bytes(Clip([Channel("channel 0", keys)], end=2.4), "anim"))
    assert window.open_file(str(file))
    assert window.view.view_range.t0 < 0.0 < 2.4 < window.view.view_range.t1
    file.write_bytes(write_bytes(Clip([Channel("channel 0", keys)], end=1e6), "anim"))
    assert window.open_file(str(file))
    assert window.view.view_range.t1 < 2.0, "the keys would be one line"
