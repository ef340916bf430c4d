"""Keys too near to tell apart become one mark, and no selected one is lost in it: to the eye or to the mouse."""

from typing import Final

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtGui import QColor
from pytestqt.qtbot import QtBot

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.keyframe import Run, make_run
from model.sampling import Window
from model.selection import Selection
from tests.widgets.screens import Pixels, Screen, view_of
from widgets.curve_view import CurveView
from widgets.hit_test import hit
from widgets.layers.keys import CELL
from widgets.layers.selected_keys import MOST_SELECTED, one_a_cell
from widgets.view_range import ViewRange

COUNT: Final = 1_000_000
SIZE: Final = (560, 300)
# In keys: from all in view down to a quarter of the way from one to the next.
ZOOMS: Final = (*(COUNT / 4**k for k in range(10)), 1.0, 0.25)
# How far, in logical pixels, the nearest selected mark may be from a selected key that has merged with others.
NEAR: Final = 5


@pytest.fixture(scope="module")
def noise() -> Channel:
    """A million keys, a hundred a second, whose values fill the view, in a colour unlike that of selected keys."""
    values = np.random.default_rng(4).uniform(-1.0, 1.0, COUNT)
    return Channel("c", make_run(np.arange(COUNT) / 100, values), color="#2050ff")


def shown(qtbot: QtBot, *channels: Channel) -> CurveView:
    view = view_of(Clip(channels, start=-1e9, end=1e9), SIZE)
    qtbot.addWidget(view)
    view.document.session.playhead = -1e9  # it would cover a column
    return view


def look_at(view: CurveView, time: float, keys: float) -> None:
    """So many keys' worth of time around *time*."""
    view.set_view(ViewRange(time - keys / 200, time + keys / 200, -1.2, 1.2))


def selected_pixels(view: CurveView, screen: Screen) -> NDArray[np.bool_]:
    """Where the colour is nearer to that of selected keys than to that of their rims, which overlap in a crowd."""
    pixels: Pixels = screen.shown()
    parts = np.stack([pixels >> 16 & 255, pixels >> 8 & 255, pixels & 255], axis=-1).astype(np.int64)
    selected, rim = (
        ((parts - (color.red(), color.green(), color.blue())) ** 2).sum(axis=-1)
        for color in (QColor(view.theme.key_selected), QColor(view.theme.key))
    )
    return np.asarray(selected < rim)


def widened(mask: NDArray[np.bool_], reach: int) -> NDArray[np.bool_]:
    """The mask and all pixels up to *reach* beside it."""
    for axis in (0, 1):
        mask = np.logical_or.reduce([np.roll(mask, way, axis) for way in range(-reach, reach + 1)])
    return mask


def assert_none_is_lost(view: CurveView, screen: Screen, ratio: float, channel: Channel, reach: int) -> int:
    """Every selected key in view has a selected mark within *reach* pixels; the answer is how many there are."""
    window = view.window_at(ratio)
    run = channel.keys_between(window.t0, window.t1)
    run = run[np.isin(run["id"], view.document.session.selection.ids(channel))]
    columns = np.floor(window.x_from_time(run["time"])).astype(np.intp)
    rows = np.floor(window.y_from_value(run["value"])).astype(np.intp)
    inside = (columns >= window.left) & (columns < window.right)
    marked = widened(selected_pixels(view, screen), reach) if reach else selected_pixels(view, screen)
    seen = marked[rows[inside], columns[inside]]
    assert seen.all(), f"{int((~seen).sum())} of {len(seen)} have no mark"
    return len(seen)


@pytest.mark.parametrize("ratio", [1.0, 2.0])
@pytest.mark.parametrize("active", [False, True], ids=["at rest", "active"])
def test_the_mark_of_a_selected_key_is_seen_at_every_zoom(
    qtbot: QtBot, noise: Channel, ratio: float, active: bool
) -> None:
    above = Channel("above", make_run([0.0, COUNT / 100], [1.0, -1.0]), color="#2050ff")
    view = shown(qtbot, noise, above)
    view.document.session.active = noise if active else above
    screen = Screen(view, ratio)
    for place in (0, 271_828, COUNT - 1):
        key = noise.run()[place]
        view.document.session.selection = Selection.of_key(noise, int(key["id"]))
        for keys in ZOOMS:
            look_at(view, float(key["time"]), keys)
            assert assert_none_is_lost(view, screen, ratio, noise, 0) == 1


@pytest.mark.parametrize("share", [1, 20, 5_000], ids=["all", "one in 20", "one in 5,000"])
def test_no_selected_key_is_far_from_a_mark_at_any_zoom(qtbot: QtBot, noise: Channel, share: int) -> None:
    view = shown(qtbot, noise)
    screen, run = Screen(view), noise.run()
    view.document.session.selection = Selection.of({noise: run["id"][::share]})
    for keys in ZOOMS:
        look_at(view, float(run["time"][500_000]), keys)
        assert assert_none_is_lost(view, screen, 1.0, noise, NEAR) > 0


def test_a_selected_key_is_hit_at_every_zoom_however_many_lie_over_it(qtbot: QtBot, noise: Channel) -> None:
    view = shown(qtbot, noise)
    key = noise.run()[271_828]
    view.document.session.selection = Selection.of_key(noise, int(key["id"]))
    for keys in ZOOMS:
        look_at(view, float(key["time"]), keys)
        x, y = view.x_from_time(float(key["time"])), view.y_from_value(float(key["value"]))
        found = hit(view, x + 2.0, y + 2.0)  # on its mark, and nearer to others where they are dense
        assert (found.kind, found.id) == ("key", int(key["id"]))


def test_handles_too_many_to_tell_apart_come_back_as_the_view_comes_near(qtbot: QtBot, noise: Channel) -> None:
    view = shown(qtbot, noise)
    run = noise.run()
    key = run[500_000]
    view.document.session.selection = Selection.of({noise: run["id"][::100]})
    counts = []
    for keys in ZOOMS:
        look_at(view, float(key["time"]), keys)
        drawn = {handle.id for handle in view.drawn_handles()}
        points = view.handle_points(noise, int(key["id"]))
        assert (None not in points) is (int(key["id"]) in drawn)
        counts.append(len(drawn))
    assert counts[0] == 0
    assert counts[-1] == 1
    assert max(counts) > 10


def test_the_handles_of_one_selected_key_are_there_at_every_zoom(qtbot: QtBot, noise: Channel) -> None:
    view = shown(qtbot, noise)
    key = noise.run()[271_828]
    view.document.session.selection = Selection.of_key(noise, int(key["id"]))
    for keys in ZOOMS:
        look_at(view, float(key["time"]), keys)
        assert None not in view.handle_points(noise, int(key["id"]))
        assert [handle.id for handle in view.drawn_handles()] == [int(key["id"])]


def test_among_very_many_selected_keys_none_is_far_from_a_mark(qtbot: QtBot) -> None:
    n = 3 * MOST_SELECTED
    values = np.random.default_rng(1).normal(size=n)
    channel = Channel("c", make_run(np.arange(n) / 100, values))
    view = view_of(Clip([channel]))
    qtbot.addWidget(view)
    view.frame_all()
    stage, run = view.canvas.stage(1.0), channel.run()
    kept = run[one_a_cell(run, stage)]
    assert len(kept) < n / 2
    window = stage.window
    marked = np.zeros((int(window.width) // 3 + 9, int(window.height) // 3 + 9), np.bool_)
    marked[cells_of(kept, window)] = True
    assert marked[cells_of(run, window)].all()


def cells_of(run: Run, window: Window) -> tuple[np.ndarray, np.ndarray]:
    column = np.floor(run["time"] * (window.px_per_second / CELL)) - np.floor(window.t0 * window.px_per_second / CELL)
    row = np.floor((window.y_from_value(run["value"]) - window.top) / CELL)
    return column.astype(np.intp) + 1, row.astype(np.intp) + 1


def test_strips_of_very_many_selected_keys_meet_the_rest(qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("widgets.layers.selected_keys.MOST_SELECTED", 50)
    rng = np.random.default_rng(2)
    channel = Channel("c", make_run(np.arange(3000) / 100, rng.normal(size=3000)))
    view = view_of(Clip([channel]))
    qtbot.addWidget(view)
    screen = Screen(view)
    view.document.session.selection = Selection.of_all([channel])
    screen.shown()
    middle = Selection.of({channel: channel.run()["id"][1500:1501]})
    gesture = view.document.begin("Move")
    for step in (0.3, -0.8, 1.9):
        gesture.preview(lambda clip, step=step: edits.move(clip, middle, 0.0, step))
        assert (screen.shown() == screen.painted_anew()).all()
    gesture.cancel()


def test_a_strip_takes_its_part_of_many_selected_keys_and_reads_none(
    qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(3)
    clip = Clip([Channel(f"c{i}", make_run(np.arange(40.0), rng.normal(size=40))) for i in range(30)])
    view = view_of(clip)
    qtbot.addWidget(view)
    screen, session = Screen(view), view.document.session
    session.selection = Selection.of_all(clip.channels)
    before = screen.shown()
    asked: list[str] = []
    for name in ("keys_between", "keys_of", "count_between"):
        monkeypatch.setattr(Channel, name, lambda self, *args, n=name, **kwargs: asked.append(n) or self.run())
    session.playhead = 20.5
    screen.refresh()
    assert asked == []
    session.playhead = 0.0
    assert (screen.shown() == before).all()
