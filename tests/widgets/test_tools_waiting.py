"""A drag of so many keys that it cannot follow at once: it gets ready in slices, and then follows by itself."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

import widgets.tools.base
from model.channel import Channel
from model.gesture import Gesture
from model.selection import Selection
from tests.widgets.desk import Desk, beside
from tests.widgets.hand import ALT, PLAIN, SHIFT
from widgets.tools.move_keys import MoveKeys


def begun(desk: Desk) -> None:
    """The button is down on one of two selected keys, and the pointer has gone on by (40, -50) pixels."""
    desk.select(desk.low, 2, 3)
    spot = desk.spot(desk.low, 3)
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 40, -50))


@pytest.fixture
def slow_to_begin(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two keys count as very many."""
    monkeypatch.setattr(widgets.tools.base, "MANY_KEYS", 2)
    monkeypatch.setattr(widgets.tools.base, "SLICE", 0.0)


@pytest.mark.usefixtures("slow_to_begin")
def test_a_drag_of_very_many_keys_follows_by_itself_as_soon_as_it_can(desk: Desk) -> None:
    before = desk.keys()
    begun(desk)
    assert desk.keys() == before
    assert desk.document.gesture is not None
    QTest.qWait(50)
    d_time, d_value = desk.way(40, -50)
    key = desk.low.key(3)
    assert (key.time, key.value) == pytest.approx((2.0 + d_time, -2.0 + d_value), rel=1e-9)
    desk.hand.release()
    assert len(desk.edits) == 1


@pytest.mark.usefixtures("slow_to_begin")
def test_a_button_that_goes_up_before_very_many_keys_could_follow_leaves_them_where_it_was(desk: Desk) -> None:
    desk.select(desk.low, 2, 3)
    spot = desk.spot(desk.low, 3)
    desk.hand.drag(spot, beside(spot, 40, -50))
    d_time, d_value = desk.way(40, -50)
    key = desk.low.key(3)
    assert (key.time, key.value) == pytest.approx((2.0 + d_time, -2.0 + d_value), rel=1e-9)
    assert len(desk.edits) == 1
    QTest.qWait(50)
    assert len(desk.edits) == 1


@pytest.mark.usefixtures("slow_to_begin")
def test_a_drag_that_is_cancelled_before_very_many_keys_could_follow_changes_nothing(desk: Desk) -> None:
    before = desk.keys()
    begun(desk)
    desk.view.router.cancel()
    desk.hand.release()
    QTest.qWait(50)
    assert desk.keys() == before
    assert desk.edits == []
    assert desk.document.gesture is None


@pytest.mark.parametrize(
    "steps",
    [
        [(200, 0, PLAIN), (200, 0, ALT), (210, 0, ALT)],
        [(60, 0, SHIFT), (65, 80, SHIFT)],
        [(40, 10, PLAIN), (50, 20, ALT), (70, 60, PLAIN)],
    ],
)
@pytest.mark.parametrize("ends", ["soon", "late"])
def test_what_is_held_down_while_very_many_keys_get_ready_counts(
    desk: Desk, monkeypatch: pytest.MonkeyPatch, steps: list[tuple[int, int, Qt.KeyboardModifier]], ends: str
) -> None:
    outcomes = []
    for many in (1000, 2):
        monkeypatch.setattr(widgets.tools.base, "MANY_KEYS", many)
        monkeypatch.setattr(widgets.tools.base, "SLICE", 0.0)
        desk.select(desk.low, 2, 3)
        spot = desk.spot(desk.low, 3)
        desk.hand.press(spot)
        for dx, dy, held in steps:
            desk.hand.move(beside(spot, dx, dy), held)
        if ends == "late":
            QTest.qWait(50)
        desk.hand.release(beside(spot, *steps[-1][:2]), modifiers=steps[-1][2])
        key = desk.low.key(3)
        outcomes.append((key.time, key.value))
        desk.document.apply(desk.edits[-1].inverse())
    assert outcomes[0] == pytest.approx(outcomes[1], rel=1e-12)


@pytest.mark.usefixtures("slow_to_begin")
def test_while_very_many_keys_get_ready_the_words_say_so(desk: Desk) -> None:
    hints: list[str] = []
    desk.view.router.hint_changed.connect(hints.append)
    begun(desk)
    assert hints[-1] == "Getting 2 keys ready · Esc: cancel"
    QTest.qWait(50)
    assert hints[-1].startswith("dt +")
    desk.hand.release()


@pytest.mark.usefixtures("slow_to_begin")
@pytest.mark.parametrize("when", ["at the release", "in a slice"])
def test_an_error_while_very_many_keys_get_ready_leaves_nothing_open(
    desk: Desk, monkeypatch: pytest.MonkeyPatch, when: str
) -> None:
    def fails(*_: object, **__: object) -> None:
        raise MemoryError(when)

    errors: list[type[BaseException]] = []
    monkeypatch.setattr("sys.excepthook", lambda kind, *_: errors.append(kind))
    before = desk.keys()
    begun(desk)
    if when == "at the release":
        monkeypatch.setattr(MoveKeys, "move", fails)
    else:
        monkeypatch.setattr(Gesture, "preview", fails)
        QTest.qWait(50)
        assert not desk.view.router.busy
    desk.hand.release()
    assert errors == [MemoryError]
    assert desk.document.gesture is None
    assert desk.keys() == before


@pytest.mark.usefixtures("slow_to_begin")
def test_a_gesture_that_somebody_else_ends_while_it_gets_ready_holds_nothing(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.excepthook", lambda *_: None)
    desk.session.selection = Selection.of_all([desk.low, desk.high])
    spot = desk.spot(desk.low, 3)
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 40, -50))
    assert desk.document.gesture is not None
    desk.document.gesture.cancel()
    QTest.qWait(50)
    desk.hand.release()
    channels: list[Channel] = [desk.low, desk.high]
    assert [channel._rows.start for channel in channels] == [None, None]
    assert not desk.view.router.busy
