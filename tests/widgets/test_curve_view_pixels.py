"""No cache goes stale: painting strip by strip leaves the same pixels as painting everything."""

from collections.abc import Callable
from typing import Final

import numpy as np
import pytest
from PySide6.QtCore import QPointF, QRectF
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.document import Edit
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule, make_run
from model.selection import Selection
from tests.widgets.screens import Screen, sample_clip, view_of
from widgets.curve_view import CurveView
from widgets.hit_test import Hit
from widgets.theme import Theme
from widgets.view_range import ViewRange

RATIOS: Final = (1.0, 1.5, 2.0)


class User:
    """Does one thing after another, at random."""

    def __init__(self, view: CurveView, screen: Screen, seed: int) -> None:
        self.view = view
        self.screen = screen
        self.document = view.document
        self.session = view.document.session
        self.rng = np.random.default_rng(seed)
        self.done: list[Edit] = []
        self.undone: list[Edit] = []
        self.document.committed.connect(self.committed)

    def committed(self, edit: Edit) -> None:
        self.done.append(edit)
        self.undone.clear()

    def channel(self) -> Channel:
        channels = [channel for channel in self.document.clip.channels if len(channel)]
        return channels[int(self.rng.integers(len(channels)))]

    def some_keys(self) -> Selection:
        chosen = {}
        for _ in range(int(self.rng.integers(1, 3))):
            channel = self.channel()
            ids = channel.run()["id"]
            chosen[channel] = ids[self.rng.random(len(ids)) < 0.3]
        return Selection.of(chosen)

    def select(self) -> None:
        self.session.selection = self.some_keys()

    def activate(self) -> None:
        self.session.active = self.channel() if self.rng.random() < 0.8 else None

    def drag(self) -> None:
        selection = self.session.selection if self.session.selection else self.some_keys()
        gesture = self.document.begin("Move")
        for _ in range(int(self.rng.integers(1, 5))):
            d_time, d_value = (self.rng.normal(size=2) * (0.4, 1.0)).tolist()
            gesture.preview(lambda clip, dt=d_time, dv=d_value: edits.move(clip, selection, dt, dv))
            if self.rng.random() < 0.5:
                self.screen.refresh()
        if self.rng.random() < 0.3:
            gesture.cancel()
        elif self.rng.random() < 0.7:
            gesture.commit()

    def end_drag(self) -> None:
        if self.document.gesture is not None:
            self.document.gesture.commit()

    def set_rule(self) -> None:
        rule = TangentRule(int(self.rng.integers(6)))
        selection = self.some_keys()
        self.document.do("Rule", lambda clip: edits.set_rule(clip, selection, rule, "out"))

    def turn_handle(self) -> None:
        channel = self.channel()
        key_id = int(self.rng.choice(channel.run()["id"]))
        slope = float(self.rng.normal() * 4)
        self.document.do("Turn", lambda clip: edits.set_slope(clip, channel, key_id, "out", slope))

    def insert(self) -> None:
        channel, time = self.channel(), float(self.rng.uniform(0, 3))
        self.document.do("Insert", lambda clip: edits.insert(clip, channel, time))

    def delete(self) -> None:
        selection = self.some_keys()
        if all(len(channel) > len(selection.ids(channel)) + 1 for channel in selection.channels):
            self.document.do("Delete", lambda clip: edits.delete(clip, selection))

    def extrapolate(self) -> None:
        channel = self.channel()
        mode = Extrapolation(int(self.rng.integers(5)))
        self.document.do("Extrapolate", lambda clip: edits.set_extrapolation(clip, [channel], pre=mode))

    def undo(self) -> None:
        if self.done:
            edit = self.done.pop()
            self.document.apply(edit.inverse())
            self.undone.append(edit)

    def redo(self) -> None:
        if self.undone:
            edit = self.undone.pop()
            self.document.apply(edit)
            self.done.append(edit)

    def hide(self) -> None:
        self.session.hidden = {self.channel()} if self.rng.random() < 0.6 else set()

    def lock(self) -> None:
        channel = self.channel()
        self.document.do("Lock", lambda clip: edits.set_setting(clip, [channel], "locked", not channel.locked))

    def move_playhead(self) -> None:
        self.session.playhead = float(self.rng.uniform(-0.5, 3.5))

    def hover(self) -> None:
        channel = self.channel()
        run = channel.run()
        key = run[int(self.rng.integers(len(run)))]
        kind = str(self.rng.choice(["key", "curve", "handle_in", "empty"]))
        self.view.set_hover(Hit(kind, channel, int(key["id"]), float(key["time"]), float(key["value"]), 1.0))

    def draw_box(self) -> None:
        corner = QPointF(*self.rng.uniform(0, 400, 2).tolist())
        self.view.set_box(QRectF(corner, QPointF(*self.rng.uniform(0, 400, 2).tolist())))

    def drop_box(self) -> None:
        self.view.set_box(None)

    def preview_insertion(self) -> None:
        self.view.set_insert_preview(self.channel(), float(self.rng.uniform(0, 3)))

    def drop_preview(self) -> None:
        self.view.set_insert_preview(None, None)

    def pan(self) -> None:
        self.view.pan_pixels(*self.rng.normal(size=2).__mul__(60).tolist())

    def zoom(self) -> None:
        self.view.zoom(*self.rng.uniform(0.7, 1.5, 2).tolist(), QPointF(300, 200))

    def frame(self) -> None:
        self.view.frame_all()

    def back(self) -> None:
        self.view.view_back()

    def change_theme(self) -> None:
        app = QApplication.instance()
        assert isinstance(app, QApplication)
        Theme.current().apply(app, str(self.rng.choice(["dark", "light"])))


ACTIONS: Final[tuple[Callable[[User], None], ...]] = (
    User.select,
    User.activate,
    User.drag,
    User.drag,
    User.drag,
    User.set_rule,
    User.turn_handle,
    User.insert,
    User.delete,
    User.extrapolate,
    User.undo,
    User.undo,
    User.redo,
    User.hide,
    User.lock,
    User.move_playhead,
    User.hover,
    User.draw_box,
    User.drop_box,
    User.preview_insertion,
    User.drop_preview,
    User.pan,
    User.zoom,
    User.frame,
    User.back,
    User.change_theme,
)
IN_A_GESTURE: Final = (User.end_drag, User.move_playhead, User.pan, User.hover, User.drop_preview)


@pytest.mark.parametrize("slow", [False, True], ids=["at once", "in slices"])
@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize(("seed", "keys"), [(0, 9), (1, 9), (2, 48), (12, 9)])
def test_strips_leave_the_pixels_of_a_full_repaint(
    qtbot: QtBot, monkeypatch: pytest.MonkeyPatch, seed: int, keys: int, ratio: float, slow: bool
) -> None:
    if slow:  # every picture is previewed first, and finished in slices
        monkeypatch.setattr("widgets.backdrop.QUICK", -1.0)
        monkeypatch.setattr("widgets.backdrop.LONG", -1.0)
    view = view_of(sample_clip(seed, keys=keys))
    qtbot.addWidget(view)
    screen = Screen(view, ratio)
    user = User(view, screen, seed)
    told = []
    for step in range(40):
        actions = ACTIONS if user.document.gesture is None else IN_A_GESTURE
        action = actions[int(user.rng.integers(len(actions)))]
        told.append(action.__name__)
        action(user)
        if user.rng.random() < 0.5:
            shown = screen.shown()
            wrong = int((shown != screen.painted_anew()).sum())
            assert wrong == 0, f"{wrong} pixels are stale after step {step}: {told[-12:]}"


@pytest.mark.parametrize("active", [True, False], ids=["under the hand", "at rest"])
@pytest.mark.parametrize("most", [192, 576], ids=["marks go", "lines become columns"])
def test_a_key_too_many_changes_the_look_of_the_whole_channel(qtbot: QtBot, most: int, active: bool) -> None:
    times = np.linspace(0.1, 9.9, most)
    channel = Channel("a", make_run(times, np.sin(times) + times % 0.37))
    clip = Clip([Channel("b", make_run([0, 10], [-2, 3])), channel])
    view = view_of(clip, (636, 400))
    qtbot.addWidget(view)
    view.document.session.active = channel if active else clip.channels[0]
    screen = Screen(view)
    view.set_view(ViewRange(0.0, 10.0, -2.0, 3.0))
    assert view.window_now.width == 576
    before = screen.shown()
    view.document.do("Insert", lambda clip: edits.insert(clip, channel, 5.003))
    after = screen.shown()
    assert (before != after)[:, 80:300].any(), "what is far from the new key looks as before"
    assert (after == screen.painted_anew()).all()


def test_names_appear_when_few_enough_channels_have_keys(qtbot: QtBot) -> None:
    clip = Clip([Channel(f"c{i}", make_run([0.0, 10.0], [i, i + 1.0])) for i in range(27)])
    view = view_of(clip)
    qtbot.addWidget(view)
    screen, document = Screen(view), view.document
    edit = document.do("Delete", lambda clip: edits.delete(clip, Selection.of_all(clip.channels[::9])))
    assert edit is not None
    few = screen.shown()
    document.apply(edit.inverse())
    many = screen.shown()
    assert (few != many)[100:, 560:].sum() > 500, "no name at the end of a line"
    assert (many == screen.painted_anew()).all()
    document.apply(edit)
    assert (screen.shown() == few).all()


def test_something_in_view_ends_the_words_about_nothing_whichever_channel_it_is(qtbot: QtBot) -> None:
    clip = Clip([Channel(f"c{i}", make_run([0.0, 10.0], [i, i + 1.0])) for i in range(30)])
    view = view_of(clip)
    qtbot.addWidget(view)
    screen, document = Screen(view), view.document
    every, last = Selection.of_all(clip.channels), Selection.of_all(clip.channels[29:])
    away = document.do("Move", lambda clip: edits.move(clip, every, 0.0, 1e3))
    back = document.do("Move", lambda clip: edits.move(clip, last, 0.0, -1e3))
    assert away is not None
    assert back is not None
    steps = ((back.inverse(), True), (away.inverse(), False), (away, True), (back, False), (back.inverse(), True))
    for edit, nothing in steps:
        document.apply(edit)
        shown = screen.shown()
        assert bool(view.canvas.stage(1.0).hint) is nothing
        assert (shown == screen.painted_anew()).all()


def test_the_ring_of_a_key_that_an_undo_moved_away_goes_with_the_pointer(qtbot: QtBot) -> None:
    channel = Channel("a", make_run([0.0, 5.0, 10.0], [0.0, 4.0, 1.0]))
    view = view_of(Clip([channel]))
    qtbot.addWidget(view)
    screen, key = Screen(view), Selection.of_key(channel, 2)
    edit = view.document.do("Move", lambda clip: edits.move(clip, key, 3.0, 0.5))
    assert edit is not None
    view.set_hover(Hit("key", channel, 2, 8.0, 4.5))
    screen.shown()
    view.document.apply(edit.inverse())
    screen.shown()
    view.set_hover(None)
    assert (screen.shown() == screen.painted_anew()).all()


def test_one_key_too_many_makes_all_lines_hard(qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("widgets.traces.MOST_SOFT_KEYS", 6)
    channels = [
        Channel(name, make_run([0.0, 5.0, 10.0], values)) for name, values in (("a", [0, 4, 1]), ("b", [3, 0, 2]))
    ]
    view = view_of(Clip(channels))
    qtbot.addWidget(view)
    screen = Screen(view)
    before = screen.shown()
    view.document.do("Insert", lambda clip: edits.insert(clip, channels[0], 9.0))
    after = screen.shown()
    assert (before != after)[:, 80:300].any()
    assert (after == screen.painted_anew()).all()


@pytest.mark.parametrize("every", [1, 2], ids=["all", "every other"])
def test_very_many_selected_keys_are_seen_and_leave_no_stale_pixel(qtbot: QtBot, every: int) -> None:
    times = np.linspace(0.0, 10.0, 4001)
    channel = Channel("a", make_run(times, np.sin(times) + times % 0.37))
    view = view_of(Clip([channel]))
    qtbot.addWidget(view)
    screen, document = Screen(view), view.document
    without = screen.shown()
    chosen = Selection.of({channel: channel.run()["id"][::every]})
    document.session.selection = chosen
    selected = screen.shown()
    assert (selected != without)[:, 80:].any(axis=0).mean() > 0.8, "most columns show that keys are selected"
    some = Selection.of({channel: chosen.ids(channel)[100:120]})
    for compute in (
        lambda clip: edits.move(clip, some, 0.0, 0.5),
        lambda clip: edits.insert(clip, channel, 5.003),
        lambda clip: edits.delete(clip, Selection.of({channel: channel.run()["id"][200:202]})),
    ):
        edit = document.do("Edit", compute)
        assert edit is not None
        for change in (edit.inverse(), edit):
            document.session.selection = chosen
            screen.shown()
            document.apply(change)
            document.session.selection = chosen
            assert (screen.shown() == screen.painted_anew()).all()
