"""A drag repaints only the rows that its curve leaves or enters, and that is enough however the steps follow."""

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF
from pytestqt.qtbot import QtBot

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule, make_run
from model.selection import Selection
from tests.widgets.screens import Pixels, Screen, view_of
from widgets.curve_view import CurveView
from widgets.hit_test import Hit

RULES = [TangentRule.SMOOTH, TangentRule.LINEAR, TangentRule.FLAT, TangentRule.AUTO]
# Where a clip begins inside a soft line, Qt may round its cover otherwise: by two of 255 levels.
ROUNDING = 2


def a_clip(keys: int, rng: np.random.Generator) -> Clip:
    channels = []
    # What goes on beside the keys of the first changes with every key, that of the others only with the ends.
    for name, pre in (("a", Extrapolation.CYCLE), ("b", Extrapolation.CONSTANT), ("c", Extrapolation.LINEAR)):
        times = np.cumsum(rng.uniform(0.5, 1.5, keys)) * (60.0 / keys)
        out = rng.choice([*RULES, TangentRule.STEP], keys)
        run = make_run(times, rng.normal(0, 1, keys).cumsum(), rules_in=rng.choice(RULES, keys), rules_out=out)
        channels.append(Channel(name, run, pre=pre, post=Extrapolation.LINEAR))
    return Clip(channels, start=0.0, end=60.0)


def levels_of(pixels: Pixels) -> NDArray[np.int16]:
    return np.stack([(pixels >> shift & 255).astype(np.int16) for shift in (0, 8, 16)], axis=2)


def drag_and_compare(view: CurveView, screen: Screen, rng: np.random.Generator) -> None:
    """Steps of a drag of a key or two, each painted as far as is asked for; then all must be as painted anew."""
    channel = view.document.clip.channels[int(rng.integers(3))]
    ids = channel.run()["id"]
    first = int(rng.integers(len(ids) // 4, 3 * len(ids) // 4))
    chosen = Selection.of({channel: ids[first : first + int(rng.integers(1, 3))]})
    view.document.session.selection = chosen
    view.document.session.active = channel if rng.random() < 0.5 else None
    screen.shown()
    span = view.view_range.t1 - view.view_range.t0
    with view.document.begin("Move") as gesture:
        d_time = d_value = 0.0
        for _ in range(int(rng.integers(2, 9))):
            # Mostly by little, as a hand goes, now and then far, past many keys or out of the view.
            far = rng.random() < 0.15
            d_time += float(rng.normal(0, 0.3 if far else 0.01)) * span
            d_value += float(rng.normal(0, 8.0 if far else 0.4))
            gesture.preview(lambda clip, way=(d_time, d_value): edits.move(clip, chosen, *way))
            if rng.random() < 0.3:  # painted farther than the change reaches
                view.document.session.playhead = float(rng.uniform(view.view_range.t0, view.view_range.t1))
            if rng.random() < 0.8:
                screen.refresh()
            if rng.random() < 0.1:
                view.set_hover(Hit("curve", channel, 0, d_time, d_value))
        screen.refresh()
        kept, anew = (levels_of(pixels) for pixels in (screen.shown(), screen.painted_anew()))
        differ = np.argwhere((np.abs(kept - anew) > ROUNDING).any(axis=2))
        assert not len(differ), differ[:5]
        gesture.cancel()
    view.set_hover(None)


@pytest.mark.parametrize("ratio", [1.0, 1.5, 2.0])
@pytest.mark.parametrize("keys", [3, 12, 150, 6000])
def test_every_step_paints_what_it_changes(qtbot: QtBot, keys: int, ratio: float) -> None:
    rng = np.random.default_rng([keys, int(10 * ratio)])
    view = view_of(a_clip(keys, rng))
    qtbot.addWidget(view)
    screen = Screen(view, ratio)
    view.frame_all()
    for round_ in range(14):
        if round_ == 7:
            view.zoom(6.0, 2.0, QPointF(view.plot_rect.center()))
        drag_and_compare(view, screen, rng)


def test_a_small_step_repaints_a_small_part(qtbot: QtBot) -> None:
    view = view_of(a_clip(12, np.random.default_rng(3)))
    qtbot.addWidget(view)
    screen, channel = Screen(view), view.document.clip.channels[1]
    chosen = Selection.of({channel: channel.run()["id"][5:6]})
    view.document.session.selection = chosen
    screen.shown()
    with view.document.begin("Move") as gesture:
        for d_value in (0.01, 0.02, 0.03):
            gesture.preview(lambda clip, up=d_value: edits.move(clip, chosen, 0.0, up))
            region = QRectF(screen.refresh().boundingRect())
        assert 0 < region.height() < view.plot_rect.height() * 0.7
        gesture.cancel()
