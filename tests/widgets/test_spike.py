"""Of a million keys, one that stands out is seen at every zoom, and just where it is."""

from math import ceil, floor
from typing import Final, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from pytestqt.qtbot import QtBot

from model.channel import Channel
from model.clip import Clip
from model.document import Edit, Splice
from model.keyframe import Run, TangentRule, make_run
from tests.widgets.screens import Pixels, Screen, view_of
from widgets.curve_view import CurveView
from widgets.layers.keys import SELECTED
from widgets.view_range import ViewRange

COUNT: Final = 1_000_000
SIZE: Final = (560, 300)
# In spans: from all in view down to a quarter of one.
ZOOMS: Final = (*(COUNT / 4**k for k in range(10)), 1.0, 0.25)
KINDS: Final = ("key", "bump")
PLACES: Final = {"second": 1, "middle": 618_033, "last": COUNT - 2}
# How far lines and marks may reach beside their place, in logical pixels.
SOFT: Final = 1
REACH: Final = 3 * SELECTED


@pytest.fixture(scope="module")
def level() -> Channel:
    """A million keys at value 0, about a hundred a second and at no regular distance."""
    times = (np.arange(COUNT) + np.random.default_rng(1).uniform(0.0, 0.5, COUNT)) / 100
    return Channel("c", make_run(times, 0.0, rules_in=TangentRule.FLAT, rules_out=TangentRule.FLAT))


class Spike(NamedTuple):
    """An edit that makes the curve reach 1 at one time and leaves it level beside *t0* to *t1*."""

    splice: Splice
    time: float
    t0: float
    t1: float


def spike_of(channel: Channel, kind: str, i: int) -> Spike:
    """Key *i* at value 1; or the span behind it arched up to 1, with both its keys where they were."""
    run = channel.run()
    if kind == "key":
        before, around = run[i : i + 1], run["time"][[max(i - 1, 0), i + 1]]
        after: Run = before.copy()
        after["value"] = 1.0
        return Spike(Splice(channel, before, after), float(before["time"][0]), *around.tolist())
    before = run[i : i + 2]
    after = before.copy()
    t0, t1 = before["time"].tolist()
    after["slope_out"][0], after["slope_in"][1] = 4 / (t1 - t0), -4 / (t1 - t0)
    after["rule_out"][0] = after["rule_in"][1] = TangentRule.FIXED
    after["broken"] = True
    return Spike(Splice(channel, before, after), (t0 + t1) / 2, t0, t1)


class Eye:
    """Looks at a view through a screen, with and without the spike."""

    def __init__(self, view: CurveView, ratio: float, spike: Spike) -> None:
        self.view, self.ratio, self.spike = view, ratio, spike
        self.screen = Screen(view, ratio)

    def named(self) -> NDArray[np.bool_]:
        """Where a name stands: it moves with the end of its curve, and covers it."""
        mask = np.zeros((self.screen.image.height(), self.screen.image.width()), np.bool_)
        for label in self.view.canvas.stage(self.ratio).labels:
            left, top, width, height = label.box
            mask[max(floor(top) - 1, 0) : ceil(top + height) + 2, floor(left) - 1 : ceil(left + width) + 2] = True
        return mask

    def look(self) -> tuple[Pixels, NDArray[np.bool_]]:
        return self.screen.shown(), self.named()

    def changed(self) -> NDArray[np.bool_]:
        """The pixels that the spike changes as it is planted; they go when it is taken away."""
        document, splice = self.view.document, self.spike.splice
        plain, named = self.look()
        edit = document.do("Spike", lambda clip: [splice])
        assert isinstance(edit, Edit)
        spiked, named_then = self.look()
        assert (spiked == self.screen.painted_anew()).all()
        document.apply(edit.inverse())
        assert (self.screen.shown() == plain).all()
        return (plain != spiked) & ~named & ~named_then

    def find(self) -> None:
        """Assert that the tip is painted in its pixel, and nothing beside the spike."""
        window = self.view.window_at(self.ratio)
        channel = self.spike.splice.channel
        x, y = window.x_from_time(self.spike.time), window.y_from_value(1.0)
        x0, x1 = window.x_from_time(self.spike.t0), window.x_from_time(self.spike.t1)
        column, row = floor(x), floor(y)
        changed = self.changed()
        dense = channel.count_between(window.t0, window.t1) > window.width
        wide = self.view.document.session.active is channel
        slack = int(wide) if dense else ceil(SOFT * self.ratio)
        near = changed[row - slack : row + slack + 1, max(column - slack, 0) : column + slack + 1]
        assert near.any(), f"no tip in column {column}, row {row}"
        columns = np.flatnonzero(changed.any(axis=0))
        reach = int(wide) if dense else REACH * self.ratio
        assert columns[0] >= floor(x0) - reach
        assert columns[-1] <= floor(x1) + reach
        if dense:
            foot = floor(window.y_from_value(0.0))
            assert changed[row:foot, column].all(), "the spike is torn"


@pytest.mark.parametrize(("ratio", "active"), [(1.0, False), (2.0, True)], ids=["at rest", "active, ratio 2"])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("place", PLACES)
def test_a_spike_among_a_million_keys_is_found_at_every_zoom(
    qtbot: QtBot, level: Channel, place: str, kind: str, ratio: float, active: bool
) -> None:
    view = view_of(Clip([level], start=-1e9, end=1e9), SIZE)
    qtbot.addWidget(view)
    view.document.session.playhead = -1e9  # it would cover a column
    view.document.session.active = level if active else None
    spike = spike_of(level, kind, PLACES[place])
    eye = Eye(view, ratio, spike)
    span = float(level.run()["time"][-1]) / COUNT
    for spans in ZOOMS:
        columns = view.window_at(ratio).width
        pixel = spans * span / columns
        # In the middle of a column, so that rounding has no say in which one it is.
        t0 = spike.time - (columns // 2 + 0.5) * pixel
        view.set_view(ViewRange(t0, t0 + spans * span, -0.25, 1.25))
        eye.find()
        for way in (-(columns // 2), columns - 1):  # by hand into the first column, then into the last one
            view.pan_pixels(way / ratio, 0.0)
            eye.find()


@pytest.mark.parametrize("kind", KINDS)
def test_a_spike_planted_out_of_sight_is_found_when_it_comes_into_view(qtbot: QtBot, level: Channel, kind: str) -> None:
    view = view_of(Clip([level], start=-1e9, end=1e9), SIZE)
    qtbot.addWidget(view)
    screen, spike = Screen(view), spike_of(level, kind, PLACES["middle"])
    everything = ViewRange(0.0, float(level.run()["time"][-1]), -0.25, 1.25)
    view.set_view(everything)
    plain = screen.shown()
    view.set_view(everything._replace(t1=everything.t1 / 100))
    screen.shown()
    edit = view.document.do("Spike", lambda clip: [spike.splice])
    assert edit is not None
    screen.shown()
    view.set_view(everything)
    spiked = screen.shown()
    view.document.apply(edit.inverse())
    window = view.window_at(1.0)
    column, row = floor(window.x_from_time(spike.time)), floor(window.y_from_value(1.0))
    assert np.flatnonzero((plain != spiked).any(axis=0)).tolist() == [column]
    assert (plain != spiked)[:, column].argmax() == row
