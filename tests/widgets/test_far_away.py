"""Nothing is too far away to be painted, nor to be left out."""

from math import isfinite

import pytest
from pytestqt.qtbot import QtBot

from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.extrapolation import Extrapolation
from model.keyframe import make_run
from model.selection import Selection
from widgets.curve_view import CurveView
from widgets.hit_test import Hit
from widgets.theme import Theme
from widgets.view_range import ViewRange


def view_on(qtbot: QtBot, clip: Clip) -> CurveView:
    view = CurveView(Document(clip), Theme("dark"))
    qtbot.addWidget(view)
    view.resize(600, 400)
    view.show()
    qtbot.waitExposed(view)
    return view


@pytest.mark.parametrize("tool", ["select", "scale", "retime"])
@pytest.mark.parametrize("span", [1.0, 1e-9])
def test_numbers_however_large_are_painted_without_a_word(qtbot: QtBot, tool: str, span: float) -> None:
    run = make_run([-1e300, 0.0, 0.5, 1e300], [1e300, 0.0, 1.0, -1e300])
    channel = Channel("a", run, pre=Extrapolation.CONSTANT, post=Extrapolation.LINEAR)
    view = view_on(qtbot, Clip([channel], start=-1e308, end=1e308))
    session = view.document.session
    session.tool, session.active = tool, channel
    session.selection = Selection.of_all([channel])
    view.set_view(ViewRange(0.0, span, -1.0, 2.0))
    qtbot.wait(30)
    view.grab()
    frame = view.canvas.overlay.frame
    assert (frame is None) is (tool == "select")
    if frame is not None:
        assert all(isfinite(spot.x()) and isfinite(spot.y()) for spot in frame.handles)


def test_the_line_before_a_key_that_is_infinitely_far_away_is_seen(qtbot: QtBot) -> None:
    channel = Channel("a", make_run([1e300], [0.5]))
    view = view_on(qtbot, Clip([channel], end=1.0))
    view.set_view(ViewRange(0.0, 1e-9, 0.0, 1.0))
    qtbot.wait(30)
    view.canvas.settle()
    image = view.grab().toImage()
    y = round(float(view.y_from_value(0.5)))
    ground = image.pixelColor(300, y + 40).name()
    drawn = [x for x in range(100, 500) if any(image.pixelColor(x, y + d).name() != ground for d in (-1, 0, 1))]
    assert len(drawn) > 100


def test_a_hovered_dashed_curve_that_has_no_span_in_view_is_no_error(qtbot: QtBot) -> None:
    channel = Channel("a", make_run([0.0, 1.0], [0.0, 1.0]), locked=True)
    view = view_on(qtbot, Clip([channel], end=1.0))
    view.document.session.active = channel
    view.set_hover(Hit("curve", channel, 0, 5.0))
    view.set_view(ViewRange(5.0, 6.0, 0.0, 2.0))
    qtbot.wait(30)
    view.grab()
    assert view.canvas.overlay.hover is not None
