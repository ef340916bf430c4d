"""A picture costs what is in it and not what is behind it: counted in calls, in numbers drawn and in memory."""

import gc
import tracemalloc
from collections.abc import Callable
from typing import Final
from weakref import WeakSet

import numpy as np
import pytest
from PySide6.QtCore import QCoreApplication, QEvent
from PySide6.QtGui import QImage
from pytestqt.qtbot import QtBot

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.keyframe import make_run
from model.selection import Selection
from tests.counting import calls_in, drawn_bytes, least_calls
from tests.widgets.screens import blank, view_of
from widgets.curve_view import CurveView
from widgets.theme import Theme
from widgets.view_range import ViewRange

WIDE: Final = 640
SPANS: Final = tuple(10.0**power for power in range(-12, 13))
# Of a picture, for each pixel of its width: a column is a line of 32 bytes, drawn twice as it is the active curve's,
# and where keys are not too dense for it their marks take some hundred more.
MOST_BYTES_A_COLUMN: Final = 1_000
MOST_CALLS: Final = 10_000
MOST_MEMORY: Final = 2 << 20


def dense(keys: int = 200_000) -> Channel:
    """Keys at every hundredth of a second around time 0, repeated for ever to both sides."""
    times = (np.arange(keys) - keys // 2) / 100
    values = np.random.default_rng(2).normal(size=keys)
    return Channel("a.x", make_run(times, values), pre=Extrapolation.CYCLE, post=Extrapolation.BOUNCE)


def sparse() -> Channel:
    """Three keys, repeated for ever and climbing."""
    return Channel("a.y", make_run([0.0, 1.0, 2.0], [0.0, 1.0, 0.5]), post=Extrapolation.CYCLE_OFFSET)


def look_at(view: CurveView, span: float) -> None:
    view.set_view(ViewRange(-span / 2, span / 2, -3.0, 3.0))


@pytest.mark.parametrize("make", [dense, sparse])
def test_at_every_zoom_a_picture_is_drawn_of_no_more_than_its_width(qtbot: QtBot, make: Callable[[], Channel]) -> None:
    channel = make()
    view = view_of(Clip([channel]), (WIDE, 400))
    qtbot.addWidget(view)
    view.document.session.active = channel
    image = blank(view, 1.0)
    for span in SPANS:
        look_at(view, span)
        assert drawn_bytes(view) < MOST_BYTES_A_COLUMN * WIDE, f"at {span:g} s"
        assert calls_in(lambda: paint_anew(view, image)) < MOST_CALLS, f"at {span:g} s"
        tracemalloc.start()
        paint_anew(view, image)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak < MOST_MEMORY, f"at {span:g} s"


def paint_anew(view: CurveView, image: QImage) -> None:
    view.canvas.forget()
    view.viewport().render(image)


def test_a_drag_step_in_a_channel_of_very_many_keys_makes_as_many_calls_as_in_one_of_a_few(qtbot: QtBot) -> None:
    costs = []
    for keys in (1_000, 200_000):
        channel = dense(keys)
        view = view_of(Clip([channel]), (WIDE, 400))
        qtbot.addWidget(view)
        view.document.session.active = channel
        look_at(view, 0.2)
        key = channel.nearest_key(0.0)
        assert key is not None
        costs.append(cost_of_a_step(view, Selection.of_key(channel, key.id)))
    assert costs[1] == pytest.approx(costs[0], rel=0.05)


def cost_of_a_step(view: CurveView, selection: Selection) -> int:
    """Calls of one preview of a move and of the paint that it asks for."""
    view.document.session.selection = selection
    amounts = iter(np.linspace(0.1, 0.2, 100).tolist())
    image = blank(view, 1.0)
    with view.document.begin("Move") as gesture:

        def step() -> None:
            amount = next(amounts)
            gesture.preview(lambda clip: edits.move(clip, selection, 0.0, amount))
            view.viewport().render(image)
            QCoreApplication.processEvents()

        step()
        (cost,) = least_calls(step)
        gesture.cancel()
    return cost


def test_views_that_are_closed_leave_no_listener_and_no_view_behind(qtbot: QtBot) -> None:
    view = view_of(Clip([sparse()]), (WIDE, 400))
    qtbot.addWidget(view)
    document, channel = view.document, view.document.clip.channels[0]
    one = Selection.of_key(channel, 2)
    theme = Theme.current()
    before, listeners = cost_of_a_step(view, one), theme.receivers("2theme_changed()")
    views: WeakSet[CurveView] = WeakSet()
    for _ in range(20):
        other = CurveView(document)
        views.add(other)
        other.show()
        QCoreApplication.processEvents()
        other.close()
        other.deleteLater()
    del other
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    gc.collect()
    assert len(views) == 0
    assert theme.receivers("2theme_changed()") <= listeners
    assert cost_of_a_step(view, one) == pytest.approx(before, rel=0.01)
