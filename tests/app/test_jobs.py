"""What the window lets the user do while a large file is opened or saved, and what becomes of it."""

import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

import app.clip_file
import app.files
from app.main_window import MainWindow
from app.progress_row import PATIENCE_MILLISECONDS, ProgressRow
from app.questions import Answer
from model import saving
from model.channel import Channel
from model.clip import Clip
from model.formats import read_clip, read_file, write_bytes
from model.keyframe import make_run
from tests.app.conftest import MakeWindow, answers_of


class Gate:
    """Holds up the reading of files, and the last moment of a save, until it is opened."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self._open = threading.Event()
        self._replace = saving.os.replace
        monkeypatch.setattr(app.clip_file, "read_file", self._read)
        monkeypatch.setattr(saving.os, "replace", self._put)

    def _read(self, name: str) -> bytes:
        data = read_file(name)
        self._open.wait(20)
        return data

    def _put(self, source: str, target: str) -> None:
        self._open.wait(20)
        self._replace(source, target)

    def open(self) -> None:
        self._open.set()

    def shut(self) -> None:
        self._open.clear()


@pytest.fixture
def gate(monkeypatch: pytest.MonkeyPatch) -> Iterator[Gate]:
    gate = Gate(monkeypatch)
    yield gate
    gate.open()


@pytest.fixture
def large(tmp_path: Path) -> Path:
    path = tmp_path / "large & long.hermite"
    run = make_run(np.arange(12_000) / 24.0, np.sin(np.arange(12_000)))
    path.write_bytes(write_bytes(Clip([Channel("root.tx", run)], end=500.0), "hermite"))
    return path


@pytest.fixture
def with_large(window: MainWindow, gate: Gate, large: Path) -> MainWindow:
    """The window with the large clip in it, the gate shut again."""
    window.activateWindow()
    gate.open()
    assert window.open_file(str(large))
    gate.shut()
    return window


def meanwhile(*steps: Callable[[], object], pause: int = 30) -> list[object]:
    """Take *steps* one after the other while the test waits for a job; what they gave."""
    found: list[object] = []

    def take(number: int) -> None:
        found.append(steps[number]())
        if number + 1 < len(steps):
            QTimer.singleShot(pause, lambda: take(number + 1))

    QTimer.singleShot(pause, lambda: take(0))
    return found


def raise_all(window: MainWindow) -> None:
    window.actions_by_id["edit.select_all"].run()
    window.actions_by_id["key.up"].run()


def progress(window: MainWindow) -> ProgressRow:
    return window.status.findChildren(ProgressRow)[0]


def press_escape(window: MainWindow) -> None:
    QTest.keyClick(window.view, Qt.Key.Key_Escape)


def test_the_window_goes_on_while_a_large_file_is_opened(window: MainWindow, gate: Gate, large: Path) -> None:
    before = window.view.view_range
    seen = meanwhile(
        lambda: window.view.pan_pixels(50.0, 0.0), lambda: window.view.view_range != before, gate.open, pause=20
    )
    assert window.open_file(str(large))
    assert seen[1] is True
    assert window.document.clip.key_count == 12_000
    assert not window.isWindowModified()


def test_an_empty_picture_says_what_is_being_opened(make_window: MakeWindow, gate: Gate, large: Path) -> None:
    window = make_window(Clip())
    QApplication.processEvents()
    assert window.view.canvas.stage(1.0).hint.startswith("Nothing here yet")
    said = meanwhile(lambda: window.view.canvas.stage(1.0).hint, gate.open, pause=20)
    assert window.open_file(str(large))
    assert said[0] == "Opening large & long.hermite ..."
    assert window.view.canvas.stage(1.0).hint == ""


def test_progress_comes_into_sight_only_after_a_moment(window: MainWindow, gate: Gate, large: Path) -> None:
    row = progress(window)
    early = meanwhile(row.isVisible, pause=20)
    late = meanwhile(lambda: (row.isVisible(), row.text.text()), gate.open, pause=PATIENCE_MILLISECONDS + 150)
    assert window.open_file(str(large))
    assert early == [False]
    assert late[0] == (True, "Opening large & long.hermite")
    assert not row.isVisible()


def test_esc_cancels_opening_and_the_clip_stays(window: MainWindow, gate: Gate, large: Path) -> None:
    window.activateWindow()
    clip = window.document.clip
    meanwhile(lambda: press_escape(window), gate.open)
    assert not window.open_file(str(large))
    assert window.document.clip is clip
    assert window.status.message.text() == "large & long.hermite was not opened"
    assert answers_of(window).told == []


def test_nothing_else_is_opened_or_saved_meanwhile(window: MainWindow, gate: Gate, large: Path, path: Path) -> None:
    window.activateWindow()
    said: list[str] = []
    tries = meanwhile(
        lambda: window.open_file(str(path)),
        lambda: said.append(window.status.message.text()),
        window.save,
        window.files.new,
        lambda: window.actions_by_id["file.open"].isEnabled(),
        gate.open,
    )
    assert window.open_file(str(large))
    assert tries == [False, None, False, False, False, None]
    assert said == ["Opening large & long.hermite is still going on; Esc cancels it"]
    assert window.files.path == str(large)
    assert window.actions_by_id["file.open"].isEnabled()


def test_what_is_changed_while_another_clip_is_opened_is_not_lost_unasked(
    window: MainWindow, gate: Gate, large: Path
) -> None:
    clip = window.document.clip
    meanwhile(lambda: raise_all(window), gate.open)
    assert not window.open_file(str(large))
    assert answers_of(window).asked == ["save_changes"]
    assert window.document.clip is clip
    assert window.isWindowModified()


def test_a_fault_found_on_the_other_thread_is_told_as_any(window: MainWindow, gate: Gate, large: Path) -> None:
    large.write_bytes(large.read_bytes().replace(b"smooth smooth", b"smooth smoth", 1))
    gate.open()
    assert not window.open_file(str(large))
    assert "large & long.hermite:8:" in answers_of(window).told[0]
    assert window.jobs.job is None


def test_a_save_keeps_the_clip_as_it_was_at_that_moment_and_the_mark_is_exact(
    with_large: MainWindow, gate: Gate, large: Path
) -> None:
    window = with_large
    raise_all(window)
    wanted = window.document.clip.channels[0].run()["value"].tolist()
    meanwhile(lambda: raise_all(window), gate.open)
    assert window.save()
    assert read_clip(large).channels[0].run()["value"].tolist() == wanted
    assert window.isWindowModified()
    window.undo_stack.undo()
    assert not window.isWindowModified()
    window.undo_stack.undo()
    assert window.isWindowModified()


def test_a_state_that_was_saved_but_given_up_meanwhile_is_not_called_saved(with_large: MainWindow, gate: Gate) -> None:
    window = with_large
    raise_all(window)
    meanwhile(window.undo_stack.undo, lambda: window.actions_by_id["tangent.flat"].run(), gate.open)
    assert window.save()
    for move in (window.undo_stack.undo, window.undo_stack.redo):
        assert window.isWindowModified()
        move()


def test_a_cancelled_save_leaves_the_file_alone_and_nothing_beside_it(
    with_large: MainWindow, gate: Gate, large: Path
) -> None:
    window, before = with_large, large.read_bytes()
    raise_all(window)
    others = sorted(large.parent.iterdir())
    QTimer.singleShot(0, progress(window).stop)
    assert not window.save()
    assert large.read_bytes() == before
    assert sorted(large.parent.iterdir()) == others
    assert window.isWindowModified()


def test_closing_waits_for_the_save_and_then_closes(
    qtbot: QtBot, with_large: MainWindow, gate: Gate, large: Path
) -> None:
    window, before = with_large, large.read_bytes()
    raise_all(window)
    seen = meanwhile(window.close, window.isVisible, gate.open)
    assert window.save()
    assert seen[:2] == [False, True]
    qtbot.waitUntil(lambda: not window.isVisible())
    assert large.read_bytes() != before
    assert answers_of(window).asked == []


def test_what_is_changed_while_the_window_waits_for_its_save_is_asked_about(with_large: MainWindow, gate: Gate) -> None:
    window, answers = with_large, answers_of(with_large)
    raise_all(window)
    answers.answers["save_changes"] = Answer.SAVE

    def change_and_think_again() -> None:
        raise_all(window)
        answers.answers["save_changes"] = Answer.CANCEL

    meanwhile(change_and_think_again, gate.open)
    assert not window.close()
    assert answers.asked == ["save_changes", "save_changes"]
    assert window.isVisible()


def test_closing_gives_up_what_is_being_opened(qtbot: QtBot, window: MainWindow, gate: Gate, large: Path) -> None:
    meanwhile(window.close, gate.open)
    assert not window.open_file(str(large))
    qtbot.waitUntil(lambda: not window.isVisible())


def test_a_program_told_to_quit_finishes_its_save(with_large: MainWindow, gate: Gate, large: Path) -> None:
    window, before = with_large, large.read_bytes()
    raise_all(window)
    QTimer.singleShot(0, window.save)
    QTimer.singleShot(100, lambda: QApplication.exit(0))
    threading.Timer(0.4, gate.open).start()
    QApplication.exec()
    assert large.read_bytes() != before
    assert not window.isWindowModified()
