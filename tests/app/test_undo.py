"""What was committed can be taken back and done again, and the mark of the saved state is exact."""

from collections.abc import Iterable

import pytest
from pytestqt.qtbot import QtBot

from app.undo import UndoStack
from model.change import Change, Splice
from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.keyframe import make_run


@pytest.fixture
def document() -> Document:
    return Document(Clip([Channel("root.tx", make_run([0.0, 1.0], [0.0, 1.0]))]))


@pytest.fixture
def stack(qtbot: QtBot, document: Document) -> UndoStack:
    return UndoStack(document)


def raised(clip: Clip) -> Iterable[Change]:
    """The first key one higher."""
    channel = clip.channels[0]
    before = channel.run()[:1]
    after = before.copy()
    after["value"] += 1.0
    return [Splice(channel, before, after)]


def first_value(document: Document) -> float:
    return float(document.clip.channels[0].run()["value"][0])


def test_a_step_goes_back_and_forth_under_its_name(document: Document, stack: UndoStack) -> None:
    document.do("Raise", raised)
    assert (first_value(document), stack.undoText(), stack.count()) == (1.0, "Raise", 1)
    stack.undo()
    assert first_value(document) == 0.0
    stack.redo()
    assert first_value(document) == 1.0


def test_the_saved_state_is_found_again_from_both_sides(document: Document, stack: UndoStack) -> None:
    assert stack.isClean()
    document.do("Raise", raised)
    stack.setClean()
    document.do("Raise", raised)
    assert not stack.isClean()
    stack.undo()
    assert stack.isClean()
    stack.undo()
    assert not stack.isClean()
    stack.redo()
    assert stack.isClean()


def test_a_saved_state_that_was_undone_and_overwritten_is_gone(document: Document, stack: UndoStack) -> None:
    document.do("Raise", raised)
    stack.setClean()
    stack.undo()
    document.do("Raise", raised)
    assert not stack.isClean()


def test_an_earlier_state_is_found_to_be_the_saved_one_without_a_drag_noticing(
    document: Document, stack: UndoStack
) -> None:
    document.do("Raise", raised)
    saved = stack.mark()
    document.do("Raise", raised)
    gesture = document.begin("Raise more")
    gesture.preview(raised)
    stack.set_saved(saved)
    assert document.gesture is gesture
    assert first_value(document) == 3.0
    gesture.cancel()
    assert not stack.isClean()
    stack.undo()
    assert (first_value(document), stack.isClean()) == (1.0, True)


def test_a_state_of_another_clip_is_not_the_saved_one(document: Document, stack: UndoStack) -> None:
    saved = stack.mark()
    document.replace(Clip())
    stack.set_saved(saved)
    assert not stack.isClean()


def test_undo_in_the_middle_of_a_gesture_cancels_the_gesture_first(document: Document, stack: UndoStack) -> None:
    document.do("Raise", raised)
    gesture = document.begin("Raise more")
    gesture.preview(raised)
    assert first_value(document) == 2.0
    stack.undo()
    assert document.gesture is None
    assert first_value(document) == 0.0


def test_a_preview_that_is_cancelled_leaves_no_step(document: Document, stack: UndoStack) -> None:
    gesture = document.begin("Raise")
    gesture.preview(raised)
    gesture.cancel()
    assert stack.count() == 0
    assert stack.isClean()


def test_another_clip_begins_a_history_of_its_own(document: Document, stack: UndoStack) -> None:
    document.do("Raise", raised)
    document.replace(Clip())
    assert (stack.count(), stack.isClean()) == (0, True)


def test_a_history_that_does_not_fit_the_clip_is_dropped_and_the_clip_counts_as_unsaved(
    qtbot: QtBot, document: Document, stack: UndoStack, monkeypatch: pytest.MonkeyPatch
) -> None:
    document.do("Raise", raised)
    stack.setClean()
    reports: list[BaseException] = []
    monkeypatch.setattr("sys.excepthook", lambda kind, error, trace: reports.append(error))
    channel = document.clip.channels[0]
    channel.splice(channel.run(), channel.run()[:0])  # behind the document's back
    stack.undo()
    qtbot.waitUntil(lambda: stack.count() == 0)
    assert len(reports) == 1
    assert not stack.isClean()
