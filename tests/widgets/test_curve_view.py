"""The graph shows what the document holds, and moves only when asked."""

from collections.abc import Callable

import numpy as np
import pytest
from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule, make_run
from model.selection import Selection
from tests.widgets.screens import Screen, sample_clip, view_of
from widgets.backdrop import Backdrop
from widgets.curve_view import CurveView
from widgets.guard import unguarded
from widgets.hit_test import hit_all
from widgets.layers import LAYERS
from widgets.layers.handles import LENGTH
from widgets.layers.keys import SHAPES
from widgets.view_range import ViewRange

type Make = Callable[..., CurveView]


@pytest.fixture
def make(qtbot: QtBot) -> Make:
    def made(clip: Clip) -> CurveView:
        view = view_of(clip)
        qtbot.addWidget(view)
        return view

    return made


def lone(times: object = (0, 1, 2), values: object = (0, 1, 0), **settings: object) -> Channel:
    return Channel("a.x", make_run(times, values), **settings)  # type: ignore[arg-type]


def rows_of(view: CurveView, channel: Channel, time: float) -> list[int]:
    """The rows that the channel paints at a time: those that change when it is hidden."""
    screen = Screen(view)
    x = round(float(view.x_from_time(time)))
    seen = screen.shown()[:, x - 1 : x + 2]
    view.document.session.hidden = {channel}
    without = screen.shown()[:, x - 1 : x + 2]
    view.document.session.hidden = frozenset()
    return np.flatnonzero((seen != without).any(axis=1)).tolist()


def test_every_override_is_guarded(make: Make) -> None:
    assert unguarded(CurveView) == []
    assert unguarded(type(make(Clip()).canvas)) == []


def test_every_rule_has_a_shape_and_every_layer_its_own_name() -> None:
    assert set(SHAPES) == set(TangentRule)
    assert len({layer.name for layer in LAYERS}) == len(LAYERS)


def test_a_new_clip_is_shown_whole(make: Make) -> None:
    view = make(Clip())
    view.document.replace(Clip([lone((5, 6, 9), (100, 300, 200))], start=5, end=9))
    shown = view.view_range
    assert shown.t0 < 5
    assert shown.t1 > 9
    assert shown.v0 < 100
    assert shown.v1 > 300
    assert shown.t1 - shown.t0 < 6


def test_pixels_and_times_are_each_others_inverse(make: Make) -> None:
    view = make(sample_clip())
    for time in (-1.0, 0.3, 7.5):
        assert view.time_from_x(view.x_from_time(time)) == pytest.approx(time)
        assert view.value_from_y(view.y_from_value(time)) == pytest.approx(time)
    times = np.linspace(0, 3, 5)
    assert view.time_from_x(view.x_from_time(times)) == pytest.approx(times)
    assert view.y_from_value(1.0) < view.y_from_value(0.0)


def test_the_view_moves_only_when_asked(make: Make) -> None:
    view = make(sample_clip())
    before = view.view_range
    channel = view.document.clip.channels[0]
    everything = Selection.of_all(view.document.clip.channels)
    edit = view.document.do("Move", lambda clip: edits.move(clip, everything, 40.0, 900.0))
    assert edit is not None
    view.document.apply(edit.inverse())
    view.document.do("Insert", lambda clip: edits.insert_key(clip, channel, 99.0, 99.0))
    view.document.session.selection = everything
    view.document.session.playhead = 1e6
    view.document.session.hidden = {channel}
    assert view.view_range == before


def test_back_takes_a_whole_zoom_back_and_frames_are_steps(make: Make) -> None:
    view = make(sample_clip())
    start = view.view_range
    for _ in range(5):
        view.zoom(1.2, 1.2, QPointF(300, 200))
    zoomed = view.view_range
    view.frame_all()
    view.view_back()
    assert view.view_range == zoomed
    view.view_back()
    assert view.view_range == start
    view.view_forward()
    assert view.view_range == zoomed


def test_framing_the_selection_shows_it_large(make: Make) -> None:
    view = make(Clip([lone(range(20), range(20))], start=0, end=19))
    ids = view.document.clip.channels[0].run()["id"]
    view.document.session.selection = Selection.of({view.document.clip.channels[0]: ids[5:8]})
    view.frame_selection()
    assert 4 < view.view_range.t0 < 5
    assert 7 < view.view_range.t1 < 8
    view.document.session.selection = Selection.NONE
    view.frame_selection()
    assert view.view_range.t1 > 19


def test_with_nothing_selected_the_active_channel_is_framed_and_else_everything(make: Make) -> None:
    near, far = Channel("near", make_run([0.0, 1.0], 0.0)), Channel("far", make_run([50.0, 60.0], [7.0, 9.0]))
    view = make(Clip([near, far, Channel("bare")]))
    everything, session = view.view_range, view.document.session
    session.active = far
    view.frame_selection()
    assert 49 < view.view_range.t0 < 50 < 60 < view.view_range.t1 < 61
    assert 6 < view.view_range.v0 < 7 < 9 < view.view_range.v1 < 10
    session.active = view.document.clip.channels[2]
    view.frame_selection()
    assert view.view_range == everything
    session.active, session.hidden = far, {far}
    view.frame_selection()
    assert view.view_range.t1 < 2
    session.selection = Selection.of_all([near])
    session.active = near
    view.frame_selection()
    assert view.view_range.t1 < 2


def test_panning_moves_the_picture_like_a_hand(make: Make) -> None:
    view = make(sample_clip())
    x, y = view.x_from_time(1.0), view.y_from_value(0.5)
    for _ in range(4):
        view.pan_pixels(7.25, -3.5)
    assert view.x_from_time(1.0) == pytest.approx(x + 29)
    assert view.y_from_value(0.5) == pytest.approx(y - 14)


def test_a_picture_that_is_only_pushed_is_gone_over_when_it_rests(
    make: Make, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("widgets.backdrop.QUICK", -1.0)
    monkeypatch.setattr("widgets.canvas.PAUSE", 60)
    view = make(sample_clip())
    view.show()
    view.canvas.settle()
    gone_over = []
    monkeypatch.setattr(Backdrop, "refine", lambda self, *_: gone_over.append(True) or False)
    for push in (12, -12) * 8:
        view.pan_pixels(push, 0)
        qtbot.wait(10)
    assert view.canvas.backdrop.busy
    assert not gone_over
    qtbot.waitUntil(lambda: bool(gone_over))
    monkeypatch.undo()
    view.canvas.settle()
    screen = Screen(view)
    assert (screen.shown() == screen.painted_anew()).all()


def test_a_curve_is_drawn_where_its_values_are(make: Make) -> None:
    channel = lone((0, 2), (-1, 3))
    view = make(Clip([channel], start=0, end=2))
    for time in (0.2, 0.31, 0.5):
        rows = rows_of(view, channel, time)
        y = view.y_from_value(channel.value(time))
        assert rows
        assert all(abs(row - y) < 4 for row in rows)


def test_a_step_is_level_and_then_upright(make: Make) -> None:
    channel = Channel("s", make_run((0, 1, 2), (0, 1, 1), rules_in=0, rules_out=TangentRule.STEP))
    view = make(Clip([channel], start=0, end=2))
    low, high = view.y_from_value(1.0), view.y_from_value(0.0)
    assert set(range(int(low) + 8, int(high) - 8)) <= set(rows_of(view, channel, 1.0))
    assert max(rows_of(view, channel, 0.5)) - min(rows_of(view, channel, 0.5)) <= 3


@pytest.mark.parametrize("mode", list(Extrapolation))
def test_extrapolation_reaches_the_edges_of_the_view(make: Make, mode: Extrapolation) -> None:
    channel = lone((0, 1, 2), (0, 1, 0.5), pre=mode, post=mode)
    view = make(Clip([channel], start=0, end=2))
    view.set_view(ViewRange(-6, 8, -9, 9))
    alone = Screen(view).shown()
    view.document.session.hidden = {channel}
    without = Screen(view).shown()
    drawn = np.flatnonzero((alone != without).any(axis=0))
    plot = view.plot_rect
    assert drawn.min() < plot.left() + 12
    assert drawn.max() > plot.right() - 12


def test_one_spike_among_many_keys_is_seen_in_its_column(make: Make) -> None:
    values = np.zeros(100_000)
    values[61_803] = 1.0
    channel = Channel("spike", make_run(np.arange(100_000) / 100, values, rules_in=0, rules_out=0))
    view = make(Clip([channel], start=0, end=1000))
    rows = rows_of(view, channel, 618.03)
    assert min(rows) == pytest.approx(view.y_from_value(1.0), abs=2)
    assert max(rows) == pytest.approx(view.y_from_value(0.0), abs=2)


def test_handles_are_as_long_as_the_screen_wants_and_as_steep_as_the_curve(make: Make) -> None:
    channel = Channel("h", make_run((0, 1, 2), (0, 1, 0), 2.0, 2.0, TangentRule.FIXED, TangentRule.FIXED))
    view = make(Clip([channel], start=0, end=2))
    key_id = int(channel.run()["id"][1])
    assert view.handle_points(channel, key_id) == (None, None)
    view.document.session.selection = Selection.of_key(channel, key_id)
    for zoom in (1.0, 7.0):
        view.zoom(zoom, 1.0, QPointF(view.x_from_time(1.0), view.y_from_value(1.0)))
        into, out = view.handle_points(channel, key_id)
        x, y = view.x_from_time(1.0), view.y_from_value(1.0)
        assert into is not None
        assert out is not None
        assert np.hypot(out[0] - x, out[1] - y) == pytest.approx(LENGTH)
        assert np.hypot(into[0] - x, into[1] - y) == pytest.approx(LENGTH)
        d_time, d_value = view.time_from_x(out[0]) - 1.0, view.value_from_y(out[1]) - 1.0
        assert d_value / d_time == pytest.approx(2.0)


def test_a_side_without_a_say_has_no_handle(make: Make) -> None:
    run = make_run((0, 1, 2), (0, 1, 0), rules_in=0, rules_out=(0, TangentRule.STEP, 0))
    channel = Channel("h", run, post=Extrapolation.LINEAR)
    view = make(Clip([channel], start=0, end=2))
    view.document.session.selection = Selection.of_all([channel])
    sides = [tuple(side is not None for side in view.handle_points(channel, key.id)) for key in channel]
    assert sides == [(False, True), (True, False), (False, True)]


def test_names_never_cover_each_other(make: Make) -> None:
    view = make(Clip([Channel(f"arm.t{i}", make_run((0, 1), (0.0, 0.01 * i))) for i in range(14)], start=0, end=1))
    Screen(view).shown()
    boxes = [label.box for label in view.canvas.stage(1.0).labels]
    assert len(boxes) == 14
    for i, (_, top, _, high) in enumerate(boxes):
        assert view.plot_rect.top() <= top
        assert top + high <= view.plot_rect.bottom() + 1
        assert all(top + high <= other[1] or other[1] + other[3] <= top for other in boxes[i + 1 :])


@pytest.mark.parametrize(
    ("clip", "words"),
    [
        (Clip(), "Nothing here yet"),
        (Clip([Channel("empty")]), "No keys yet"),
        (Clip([lone()], start=0, end=2), ""),
    ],
)
def test_an_empty_picture_says_what_to_do(make: Make, clip: Clip, words: str) -> None:
    view = make(clip)
    Screen(view).shown()
    assert view.canvas.stage(1.0).hint.startswith(words)
    assert bool(view.canvas.stage(1.0).hint) == bool(words)


def test_where_nothing_is_seen_the_way_home_is_told(make: Make) -> None:
    view = make(Clip([lone()], start=0, end=2))
    view.set_view(ViewRange(0, 2, 50, 60))
    assert "Press A" in view.canvas.stage(1.0).hint
    view.document.session.solo = {Channel("elsewhere")}
    assert "hidden" in view.canvas.stage(1.0).hint


@pytest.mark.parametrize("span", [1e-12, 1e-6, 1.0, 1e6, 1e12])
@pytest.mark.parametrize("center", [0.0, 1.0, -1e9, 1e12])
def test_every_zoom_can_be_painted(make: Make, center: float, span: float) -> None:
    view = make(sample_clip(4))
    half = span / 2
    view.set_view(ViewRange(center - half, center + half, center - half, center + half))
    assert len(np.unique(Screen(view).shown())) > 2


@pytest.mark.parametrize("most", [1e300, 1.7e308])
@pytest.mark.parametrize("mode", Extrapolation)
def test_huge_values_are_painted_without_harm(make: Make, mode: Extrapolation, most: float) -> None:
    channel = lone((0, 1, 2, 3), (-most, most, 0, most / 2), pre=mode, post=mode)
    view = make(Clip([channel], start=0, end=3))
    view.set_view(ViewRange(-5, 9, -1, 1))
    assert len(np.unique(Screen(view).shown())) > 2
    assert hit_all(view, view.x_from_time(0.5), 200) is not None


def test_a_move_of_the_playhead_repaints_narrow_strips(make: Make) -> None:
    view = make(sample_clip())
    screen = Screen(view)
    screen.shown()
    view.document.session.playhead = 1.5
    screen.refresh()
    view.document.session.playhead = 1.52
    region = screen.refresh()
    area = sum(rect.width() * rect.height() for rect in iter(region))  # type: ignore[call-overload]
    assert area < 0.1 * view.width() * view.height()


def test_a_drag_of_one_key_repaints_only_its_reach(make: Make) -> None:
    channel = lone(np.arange(100), np.sin(np.arange(100)))
    view = make(Clip([channel], start=0, end=99))
    view.document.session.active = channel
    screen = Screen(view)
    screen.shown()
    with view.document.begin("Move") as gesture:
        for step in (0.1, 0.2):
            one = Selection.of_key(channel, int(channel.run()["id"][50]))
            gesture.preview(lambda clip, one=one, step=step: edits.move(clip, one, 0.0, step))
            region = screen.refresh()
        assert region.boundingRect().width() < 0.35 * view.width()
        gesture.cancel()


def test_a_view_that_is_gone_hears_nothing(qtbot: QtBot) -> None:
    view = view_of(sample_clip())
    document = view.document
    view.close()
    view.deleteLater()
    del view
    QApplication.processEvents()
    QApplication.sendPostedEvents(None, 52)  # deferred deletions
    document.session.playhead = 2.0
    document.do("Move", lambda clip: edits.move(clip, Selection.of_all(clip.channels), 0.1, 0.1))


@pytest.mark.parametrize(("active", "unit", "label"), [(0, "m", "2"), (1, "angle", "90°"), (None, "", "2")])
def test_the_value_ruler_is_in_the_unit_of_the_active_channel(
    qtbot: QtBot, active: int | None, unit: str, label: str
) -> None:
    run = make_run([0.0, 1.0], [-3.0, 3.0])
    view = view_of(Clip([Channel("hip.tx", run, unit="m"), Channel("hip.rx", run, unit="angle")]))
    qtbot.addWidget(view)
    screen = Screen(view)
    before = screen.shown()
    view.document.session.active = None if active is None else view.document.clip.channels[active]
    assert active is None or (screen.shown() != before).any()
    assert (screen.shown() == screen.painted_anew()).all()
    stage = view.canvas.stage(1.0)
    assert stage.unit == unit
    assert label in stage.value_ticks.labels


def test_a_new_unit_is_at_once_that_of_ruler_and_grid(qtbot: QtBot) -> None:
    view = view_of(Clip([Channel("hip.rx", make_run([0.0, 1.0], [-3.0, 3.0]))]))
    qtbot.addWidget(view)
    screen = Screen(view)
    screen.shown()
    view.document.do("Unit", lambda clip: edits.set_setting(clip, clip.channels, "unit", "angle"))
    assert (screen.shown() == screen.painted_anew()).all()
    assert "90°" in view.canvas.stage(1.0).value_ticks.labels
