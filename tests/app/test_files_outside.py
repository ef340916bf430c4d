"""Files that other programs write, damage, delete or replace while they are open."""

import os
from pathlib import Path

import pytest

from app.main_window import MainWindow
from model.clip import Clip
from model.formats import write_bytes
from tests.app.conftest import answers_of


def change(window: MainWindow) -> None:
    window.actions_by_id["edit.select_all"].run()
    window.actions_by_id["key.up"].run()


def test_a_clip_whose_file_was_damaged_by_another_program_counts_as_unsaved(opened: MainWindow, path: Path) -> None:
    path.write_text("hermite 1\ngarb")
    answers_of(opened).answers["reload_changed"] = True
    opened.files.look_at_disk()
    assert "cannot be read again" in answers_of(opened).told[0]
    assert opened.isWindowModified()
    assert not opened.close()


def test_a_file_that_another_program_wrote_is_not_overwritten_unasked(opened: MainWindow, path: Path) -> None:
    theirs = write_bytes(Clip(title="theirs"), "hermite")
    path.write_bytes(theirs)
    change(opened)
    assert not opened.save()
    assert path.read_bytes() == theirs
    answers_of(opened).answers["overwrite_changed"] = True
    assert opened.save()
    assert path.read_bytes() != theirs


def test_a_file_that_another_program_wrote_is_offered_once_for_reading_again(opened: MainWindow, path: Path) -> None:
    path.write_bytes(write_bytes(Clip(title="theirs"), "hermite"))
    opened.files.look_at_disk()
    opened.files.look_at_disk()
    assert answers_of(opened).asked == ["reload_changed"]
    assert opened.isWindowModified()  # what is shown is not what is on the disk
    path.write_bytes(write_bytes(Clip(title="theirs again"), "hermite"))
    answers_of(opened).answers["reload_changed"] = True
    opened.files.look_at_disk()
    assert opened.document.clip.title == "theirs again"
    assert not opened.isWindowModified()


def test_a_touched_file_is_no_reason_to_ask(opened: MainWindow, path: Path) -> None:
    os.utime(path, ns=(1, 1))
    opened.files.look_at_disk()
    change(opened)
    assert opened.save()
    assert answers_of(opened).asked == []


def test_a_file_that_is_gone_makes_the_clip_unsaved_and_saving_brings_it_back(opened: MainWindow, path: Path) -> None:
    path.unlink()
    opened.files.look_at_disk()
    assert opened.isWindowModified()
    assert opened.save()
    assert path.exists()


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes in folders")
def test_a_pipe_in_the_place_of_a_file_stops_nothing(opened: MainWindow, path: Path, tmp_path: Path) -> None:
    path.unlink()
    os.mkfifo(path)
    opened.files.look_at_disk()
    assert opened.isWindowModified()
    assert not opened.save()
    skeleton = tmp_path / "pipe.skel"
    os.mkfifo(skeleton)
    assert not opened.open_file(str(skeleton))
    assert "not a regular file" in answers_of(opened).told[-1]
