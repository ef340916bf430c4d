"""A change of very many keys is worked out and made by somebody else, told here when it is done, or has never been."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from model import edits
from model.change import Change
from model.channel import Channel
from model.clip import Clip
from model.document import MANY_KEYS, Document
from model.keyframe import make_run
from model.progress import CancelledError, Report
from model.selection import Selection
from tests.model.editing import Record, everything


class Worker:
    """Does long work at once; *meanwhile* is called in the middle of it, *stop_at* cancels at that report."""

    def __init__(self) -> None:
        self.texts: list[str] = []
        self.shares: list[float] = []
        self.stop_at = -1
        self.meanwhile: Callable[[], object] = lambda: None

    def __call__[T](self, text: str, work: Callable[[Report], T]) -> T:
        self.texts.append(text)
        self.shares = []
        self.meanwhile()
        return work(self._heard)

    def _heard(self, share: float) -> None:
        if len(self.shares) == self.stop_at:
            raise CancelledError
        self.shares.append(share)


class Desk:
    """Two channels of very many keys, all selected."""

    def __init__(self) -> None:
        times = np.arange(MANY_KEYS) / 24.0
        self.clip = Clip([Channel(name, make_run(times, np.sin(times))) for name in ("root.tx", "root.ty")])
        self.document = Document(self.clip)
        self.worker = Worker()
        self.document.long_work = self.worker
        self.selection = Selection.of({channel: channel.run()["id"] for channel in self.clip.channels})
        self.document.session.selection = self.selection

    def raised(self, clip: Clip) -> list[Change]:
        return list(edits.nudge(clip, self.selection, 0.0, 1.0))

    def do(self, compute: Callable[[Clip], list[Change]] | None = None) -> Any:
        return self.document.do("Raise", compute or self.raised, keys=self.selection.count)


@pytest.fixture
def desk() -> Desk:
    return Desk()


def test_it_is_the_same_edit_whoever_makes_it(desk: Desk) -> None:
    other = Desk()
    other.document.long_work = None
    assert everything(desk.clip) == everything(other.clip)
    ours, theirs = desk.do(), other.do()
    assert everything(desk.clip) == everything(other.clip)
    for mine, its in zip(ours.changes, theirs.changes, strict=True):
        assert mine.before.tobytes() == its.before.tobytes()
        assert mine.after.tobytes() == its.after.tobytes()
    desk.document.apply(ours.inverse())
    other.document.apply(theirs.inverse())
    assert everything(desk.clip) == everything(other.clip)
    assert desk.worker.texts == ["Raise", "Raise"]


def test_how_far_it_is_only_grows(desk: Desk) -> None:
    desk.do()
    shares = desk.worker.shares
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert len(shares) >= 4


@pytest.mark.parametrize("place", range(5))
def test_cancelled_anywhere_it_has_never_been(desk: Desk, place: int) -> None:
    before, record = everything(desk.clip), Record(desk.document)
    desk.worker.stop_at = place
    assert desk.do() is None
    assert everything(desk.clip) == before
    assert (record.edits, record.events) == ([], [])
    assert desk.document.gesture is None
    assert not desk.document.working
    assert desk.document.session.selection is desk.selection
    desk.worker.stop_at = -1
    assert desk.do() is not None


def test_an_error_of_the_other_thread_is_raised_here_and_nothing_has_changed(desk: Desk) -> None:
    before = everything(desk.clip)

    def failing(clip: Clip) -> list[Change]:
        first, second = desk.raised(clip)
        (bad,) = second.splices()
        bad.after["value"][7] = np.nan
        return [first, bad]

    with pytest.raises(ValueError, match="value"):
        desk.do(failing)
    assert everything(desk.clip) == before
    assert desk.document.gesture is None
    assert not desk.document.working


def test_nothing_else_can_be_begun_kept_or_taken_back_meanwhile(desk: Desk) -> None:
    document, refused = desk.document, []

    def try_all() -> None:
        gesture = document.gesture
        ways: list[Callable[[], object]] = [lambda: document.begin("Another"), lambda: document.replace(Clip())]
        if gesture is not None:
            ways += [gesture.cancel, gesture.commit, lambda: gesture.preview(lambda clip: [])]
        for way in ways:
            with pytest.raises(RuntimeError):
                way()
            refused.append(way)

    desk.worker.meanwhile = try_all
    edit = desk.do()
    assert len(refused) == 5
    document.apply(edit.inverse())
    assert len(refused) == 7


def test_it_is_told_when_the_document_may_be_read_again(desk: Desk) -> None:
    told: list[bool] = []

    def listen(*_: object) -> None:
        told.append(desk.document.working)

    desk.document.changed.connect(listen)
    desk.document.committed.connect(listen)
    edit = desk.do()
    desk.document.apply(edit.inverse())
    assert told
    assert not any(told)


def test_few_keys_and_previews_are_changed_at_once(desk: Desk) -> None:
    channel = desk.clip.channels[0]
    few = Selection.of({channel: channel.keys_between(0.0, 10.0)["id"]})
    edit = desk.document.do("Raise", lambda clip: edits.nudge(clip, few, 0.0, 1.0), keys=few.count)
    assert edit is not None
    desk.document.apply(edit.inverse())
    with desk.document.begin("Drag") as gesture:
        gesture.preview(desk.raised)
    assert desk.worker.texts == []


def test_few_keys_of_very_many_channels_are_long_work_too() -> None:
    clip = Clip([Channel(f"c{i}", make_run([0.0, 1.0], [0.0, 1.0])) for i in range(400)])
    document, worker = Document(clip), Worker()
    document.long_work = worker
    chosen = document.session.selection = Selection.of_all(clip.channels)
    edit = document.do("Raise", lambda clip: edits.nudge(clip, chosen, 0.0, 1.0), keys=chosen.count)
    assert edit is not None
    document.apply(edit.inverse())
    assert worker.texts == ["Raise", "Raise"]
