"""A drag of so many keys that it cannot follow at once: it gets ready in slices, and then follows by itself."""

import pytest
from PySide6.QtTest import QTest

import widgets.tools.base
from tests.widgets.desk import Desk, beside


@pytest.fixture
def slow_to_begin(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two keys count as very many."""
    monkeypatch.setattr(widgets.tools.base, "MANY_KEYS", 2)
    monkeypatch.setattr(widgets.tools.base, "SLICE", 0.0)


@pytest.mark.usefixtures("slow_to_begin")
def test_a_drag_of_very_many_keys_follows_by_itself_as_soon_as_it_can(desk: Desk) -> None:
    desk.select(desk.low, 2, 3)
    before, spot = desk.keys(), desk.spot(desk.low, 3)
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 40, -50))
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
    desk.select(desk.low, 2, 3)
    before, spot = desk.keys(), desk.spot(desk.low, 3)
    desk.hand.press(spot)
    desk.hand.move(beside(spot, 40, -50))
    desk.view.router.cancel()
    desk.hand.release()
    QTest.qWait(50)
    assert desk.keys() == before
    assert desk.edits == []
    assert desk.document.gesture is None
