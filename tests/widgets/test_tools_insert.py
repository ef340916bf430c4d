"""Inserting keys on a curve with the mouse, on a real view."""

import numpy as np
import pytest
from PySide6.QtCore import Qt

from model.keyframe import KeyGoneError
from model.selection import Selection
from tests.widgets.desk import Desk, beside
from tests.widgets.hand import CTRL

TIMES = np.linspace(-1.0, 5.0, 2001)


def test_ctrl_click_on_a_curve_inserts_a_key_and_keeps_its_shape(desk: Desk) -> None:
    before = desk.low.evaluate(TIMES)
    desk.hand.click(desk.hand.spot_of(1.37, desk.low.value(1.37)), modifiers=CTRL)
    assert [key.time for key in desk.low] == pytest.approx([0.0, 1.0, 1.37, 2.0, 3.0, 4.0], abs=1e-9)
    assert np.allclose(desk.low.evaluate(TIMES), before, rtol=0, atol=1e-12)
    assert len(desk.edits) == 1
    assert desk.edits[0].label == "Insert key on low at 1.370 s"
    new = desk.low.key_at(desk.low.keys_between(1.3, 1.4)["time"][0])
    assert new is not None
    assert desk.session.selection == Selection.of_key(desk.low, new.id)
    assert desk.session.active is desk.low


def test_undo_takes_the_key_away_and_redo_brings_it_back_selected(desk: Desk) -> None:
    before = desk.keys()
    desk.hand.click(desk.hand.spot_of(1.37, desk.low.value(1.37)), modifiers=CTRL)
    after, chosen = desk.keys(), desk.session.selection
    desk.document.apply(desk.edits[0].inverse())
    assert desk.keys() == before
    desk.document.apply(desk.edits[0])
    assert desk.keys() == after
    assert desk.session.selection == chosen


def test_the_key_snaps_to_a_frame_although_ctrl_is_held(desk: Desk) -> None:
    desk.session.snap = True
    desk.hand.click(desk.hand.spot_of(1.37, desk.low.value(1.37)), modifiers=CTRL)
    assert 1.4 in [key.time for key in desk.low]


def test_a_dot_shows_where_the_key_would_go_while_ctrl_is_held(desk: Desk) -> None:
    spot = desk.hand.spot_of(1.37, desk.low.value(1.37))
    overlay = desk.view.canvas.overlay
    desk.hand.move(spot)
    assert overlay.preview is None
    desk.hand.move(spot, CTRL)
    assert overlay.preview is not None
    assert overlay.preview[0] is desk.low
    assert overlay.preview[1] == pytest.approx(1.37)
    desk.hand.move(spot)
    assert overlay.preview is None
    desk.hand.move(spot, CTRL)
    desk.hand.move(desk.hand.spot_of(1.37, 5.0), CTRL)
    assert overlay.preview is None


def test_a_drag_slides_the_key_along_the_curve_before_it_is_inserted(desk: Desk) -> None:
    before = desk.low.evaluate(TIMES)
    start = desk.hand.spot_of(1.37, desk.low.value(1.37))
    desk.hand.drag(start, desk.hand.spot_of(1.5, 3.0), desk.hand.spot_of(1.7, 3.0), modifiers=CTRL)
    assert [key.time for key in desk.low] == pytest.approx([0.0, 1.0, 1.7, 2.0, 3.0, 4.0])
    assert np.allclose(desk.low.evaluate(TIMES), before, rtol=0, atol=1e-12)
    assert len(desk.edits) == 1
    assert desk.view.canvas.overlay.preview is None


def test_escape_inserts_nothing(desk: Desk) -> None:
    before = desk.keys()
    start = desk.hand.spot_of(1.37, desk.low.value(1.37))
    desk.hand.drag(start, desk.hand.spot_of(1.5, 3.0), modifiers=CTRL, drop=False)
    desk.hand.key(Qt.Key.Key_Escape)
    desk.hand.release()
    assert desk.keys() == before
    assert desk.edits == []


def test_no_key_is_inserted_where_there_is_one(desk: Desk) -> None:
    desk.session.snap = True
    before = desk.keys()
    start = desk.hand.spot_of(1.5, desk.low.value(1.5))
    desk.hand.drag(start, desk.hand.spot_of(2.01, -1.0), modifiers=CTRL)
    assert desk.keys() == before
    assert desk.edits == []


def test_ctrl_and_a_key_is_a_drag_without_snapping_not_an_insertion(desk: Desk) -> None:
    desk.session.snap = True
    spot = desk.spot(desk.low, 2)
    desk.hand.drag(spot, beside(spot, 37, 0), modifiers=CTRL)
    assert len(desk.low) == 5
    assert desk.low.key(2).time == pytest.approx(1.0 + desk.way(37, 0)[0])


def test_a_locked_curve_gets_no_key(desk: Desk) -> None:
    desk.low.locked = True
    before = desk.keys()
    desk.hand.click(desk.hand.spot_of(1.37, desk.low.value(1.37)), modifiers=CTRL)
    assert desk.keys() == before
    with pytest.raises(KeyGoneError):
        desk.low.key(6)
