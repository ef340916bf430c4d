"""The graph under the hand, from an event to the end of its paint: against an empty plot and the obvious code."""

from collections.abc import Callable, Iterator
from itertools import cycle
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QApplication, QStackedWidget, QWidget

from app.main_window import MainWindow
from app.settings import Settings
from model import edits
from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.selection import Selection
from tests.bench.evaluating import a_channel
from tests.bench.table import Line, Times, summed_up
from widgets.curve_view import CurveView
from widgets.hit_test import hit
from widgets.theme import Theme
from widgets.view_range import ViewRange

SIZE = (1600, 900)
STEPS = 240
LEFT, NONE = Qt.MouseButton.LeftButton, Qt.MouseButton.NoButton
CLIPS: dict[str, Callable[[], Clip]] = {
    "200 x 1,000 keys": lambda: Clip([a_channel(1_000, i, f"c{i:03}") for i in range(200)]),
    "1 x 1,000,000 keys": lambda: Clip([a_channel(1_000_000, name="c")]),
}


def send(target: QWidget, kind: QEvent.Type, at: QPointF, button: Qt.MouseButton, held: Qt.MouseButton) -> None:
    """One mouse event, as the window system would bring it."""
    event = QMouseEvent(kind, at, target.mapToGlobal(at), button, held, Qt.KeyboardModifier.NoModifier)
    QApplication.sendEvent(target, event)


def step_times(step: Callable[[], object], n: int = STEPS) -> Times:
    """Durations of a step and of all the painting that it asks for."""
    taken = []
    for i in range(n + 10):
        start = perf_counter()
        step()
        QApplication.processEvents()
        if i >= 10:
            taken.append(perf_counter() - start)
    return summed_up(taken)


class Shown(NamedTuple):
    """A curve view on a clip, in a window of the size of the figures, with one key in the middle selected."""

    view: CurveView
    channel: Channel
    key_id: int


def shown(stack: QStackedWidget, clip: Clip, keys_in_view: int | None) -> Shown:
    """The view on a clip: all of it, or around the middle key."""
    view = CurveView(Document(clip), Theme.current())
    stack.addWidget(view)
    stack.setCurrentWidget(view)
    QApplication.processEvents()
    return looking_at(view, keys_in_view)


def looking_at(view: CurveView, keys_in_view: int | None) -> Shown:
    """The view on all of its clip, or around the middle key of its middle channel, which is selected."""
    document, clip = view.document, view.document.clip
    channel = clip.channels[len(clip.channels) // 2]
    run = channel.run()
    middle = len(run) // 2
    document.session.active = channel
    view.frame_all()
    if keys_in_view is not None:
        near = run[middle - keys_in_view // 2 : middle + keys_in_view // 2 + 1]
        low, high = float(near["value"].min()) - 1.0, float(near["value"].max()) + 1.0
        view.set_view(ViewRange(float(near["time"][0]), float(near["time"][-1]), low, high))
    key_id = int(run["id"][middle])
    document.session.selection = Selection.of({channel: [key_id]})
    document.session.snap = False
    settle(view)
    return Shown(view, channel, key_id)


def settle(view: CurveView) -> None:
    """Let everything be painted that is still to be painted."""
    QApplication.processEvents()
    view.canvas.settle()
    for _ in range(5):
        QApplication.processEvents()


def wander(at: QPointF) -> Iterator[QPointF]:
    """Places around a place, never twice the same in a row."""
    angles = cycle(np.linspace(0.0, 2.0 * np.pi, 97)[:-1].tolist())
    for i, angle in enumerate(angles):
        reach = 30.0 + i % 23
        yield at + QPointF(reach * float(np.cos(angle)), reach * float(np.sin(angle)))


def drag_times(scene: Shown, n: int = STEPS) -> Times:
    """Steps of a drag of the selected key, by mouse events on the viewport."""
    view, key = scene.view, scene.channel.key(scene.key_id)
    at = QPointF(float(view.x_from_time(key.time)), float(view.y_from_value(key.value)))
    return stroke_times(view, at, at, n)


def stroke_times(view: CurveView, at: QPointF, around: QPointF, n: int) -> Times:
    """Steps of a drag of what is at a place, which goes round another one."""
    viewport = view.viewport()
    send(viewport, QEvent.Type.MouseMove, at, NONE, NONE)
    send(viewport, QEvent.Type.MouseButtonPress, at, LEFT, LEFT)
    places = wander(around)
    for _ in range(5):
        send(viewport, QEvent.Type.MouseMove, next(places), NONE, LEFT)
        QApplication.processEvents()
    assert view.document.gesture is not None, "the drag did not begin"
    times = step_times(lambda: send(viewport, QEvent.Type.MouseMove, next(places), NONE, LEFT), n)
    view.router.cancel()
    settle(view)
    return times


def empty_repaint(stack: QStackedWidget) -> Times:
    """A full repaint of an empty plot with axes."""
    plot = pg.PlotWidget()
    stack.addWidget(plot)
    stack.setCurrentWidget(plot)
    QApplication.processEvents()
    return step_times(plot.viewport().repaint, 120)


def beside_empty(stack: QStackedWidget, measure: Callable[[], Times]) -> tuple[Times, float]:
    """What *measure* gives, and an empty repaint before and after it: the machine's speed drifts within a run."""
    before = empty_repaint(stack).median
    times = measure()
    return times, (before + empty_repaint(stack).median) / 2.0


def obvious_drag(stack: QStackedWidget, clip: Clip) -> Times:
    """The code one writes first: a PlotDataItem and a ScatterPlotItem a channel, and a grid."""
    plot: Any = pg.PlotWidget()
    plot.showGrid(x=True, y=True, alpha=0.3)
    stack.addWidget(plot)
    stack.setCurrentWidget(plot)
    items = []
    for channel in clip.channels:
        run = channel.run()
        times = np.linspace(run["time"][0], run["time"][-1], max(4_000, len(run)))
        curve, keys = (
            pg.PlotDataItem(times, channel.evaluate(times)),
            pg.ScatterPlotItem(run["time"], run["value"], size=7),
        )
        plot.addItem(curve)
        plot.addItem(keys)
        items.append((channel, run, times, curve, keys))
    QApplication.processEvents()
    channel, run, times, curve, keys = items[len(items) // 2]
    values, amounts = run["value"].copy(), iter(np.linspace(0.1, 3.0, 1_000).tolist())

    def step() -> None:
        values[len(values) // 2] += next(amounts)
        curve.setData(times, channel.evaluate(times))
        keys.setData(run["time"], values)

    return step_times(step, 8)


def drags(stack: QStackedWidget, clips: dict[str, Clip]) -> list[Line]:
    """One key dragged: the whole clip in view, and zoomed in."""
    lines = []
    for name, clip in clips.items():
        for where, keys_in_view in (("all in view", None), ("30 keys in view", 30), ("3 keys fill the view", 2)):
            times, empty = beside_empty(stack, lambda c=clip, n=keys_in_view: drag_times(shown(stack, c, n)))
            work = f"a drag step of one key, {name}, {where}"
            most = 2e-3 if keys_in_view != 2 else None
            ratio = 1.5 if keys_in_view != 2 else None
            lines.append(Line(work, times.median, "empty repaint, PlotWidget with axes", empty, ratio, most))
            lines.append(Line(f"{work}, 99 %", times.p99, most=6e-3))
        if len(clip.channels) > 1:
            obvious = obvious_drag(stack, clip)
            lines.append(
                Line(
                    f"a drag step of one key, {name}, all in view",
                    lines[-6].ours,
                    "the obvious pyqtgraph code",
                    obvious.median,
                )
            )
    return lines


def drag_in_the_editor(clip: Clip) -> Line:
    """One key dragged in the whole window: tree, inspector, transport and the line of words follow."""
    with TemporaryDirectory() as folder:
        window = MainWindow(settings=Settings(str(Path(folder, "bench.ini"))))
        window.resize(*SIZE)
        window.show()
        window.show_clip(clip)
        QApplication.processEvents()
        times = drag_times(looking_at(window.view, 30))
        window.close()
        window.deleteLater()
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    work = "a drag step of one key, 200 x 1,000 keys, 30 keys in view"
    return Line(work, times.median, note="in the whole window", most=2e-3)


def drag_of_some(stack: QStackedWidget, clip: Clip) -> Line:
    """A thousand selected keys over twenty channels."""
    scene = shown(stack, clip, None)
    middle = len(clip.channels) // 2
    chosen = {channel: channel.run()["id"][::20] for channel in clip.channels[middle : middle + 20]}
    ids = chosen[scene.channel]
    key_id = int(ids[len(ids) // 2])
    scene.view.document.session.selection = Selection.of(chosen)
    settle(scene.view)
    times = drag_times(scene._replace(key_id=key_id))
    return Line("a drag step of 1,000 keys over 20 channels", times.median, note="with its paint", most=8e-3)


def drag_of_all(stack: QStackedWidget, clip: Clip) -> Line:
    """Every key of a clip of one channel."""
    scene = shown(stack, clip, None)
    scene.view.document.session.selection = Selection.of_all(clip.channels)
    settle(scene.view)
    times = drag_times(scene, 12)
    return Line("a drag step of all 1,000,000 keys", times.median, note="with its paint", most=60e-3)


def stretches_of_all(stack: QStackedWidget, clip: Clip) -> list[Line]:
    """Every key of a clip of one channel scaled by the corner of its box, retimed by its bracket; one handle turned."""
    lines = []
    for tool in ("scale", "retime"):
        scene = shown(stack, clip, None)
        view, session = scene.view, scene.view.document.session
        session.selection = Selection.of_all(clip.channels)
        session.tool = tool
        settle(view)
        frame = view.canvas.overlay.frame
        assert frame is not None
        at = max(frame.handles, key=lambda spot: (spot.x(), -spot.y()))
        times = stroke_times(view, at, at - QPointF(100.0, 0.0), 12)
        lines.append(Line(f"a {tool} step of all 1,000,000 keys", times.median, note="with its paint", most=100e-3))
    scene = shown(stack, clip, 10)
    view = scene.view
    view.document.session.selection = Selection.of_all(clip.channels)
    settle(view)
    handle = next(end for each in view.drawn_handles() if each.id == scene.key_id for end in each[2:] if end)
    times = stroke_times(view, QPointF(*handle), QPointF(*handle), STEPS)
    work = "a drag step of one handle, all 1,000,000 keys selected"
    lines.append(Line(work, times.median, note="with its paint", most=100e-3))
    return lines


def view_steps(stack: QStackedWidget, name: str, clip: Clip) -> list[Line]:
    """Pan, zoom and the full picture after a zoom, everything in view."""
    scene = shown(stack, clip, None)
    view = scene.view
    pans = cycle([12.0, -12.0])
    pan = step_times(lambda: view.pan_pixels(next(pans), 0.0), 60)
    settle(view)
    zooms, center = cycle([1.15, 1 / 1.15]), view.plot_rect.center()
    zoom = step_times(lambda: view.zoom(next(zooms), 1.0, center), 60)
    full = []
    for _ in range(12):
        view.zoom(next(zooms), 1.0, center)
        QApplication.processEvents()  # what a zoom step shows at once; the full picture comes later
        start = perf_counter()
        settle(view)
        full.append(perf_counter() - start)
    return [
        Line(f"a pan step, {name}, all in view", pan.median, most=14e-3),
        Line(f"a zoom step, {name}, all in view", zoom.median, most=5e-3),
        Line(f"the full picture after a zoom, {name}", summed_up(full).median, most=60e-3),
    ]


def hit_tests(stack: QStackedWidget, name: str, clip: Clip) -> list[Line]:
    """What lies under the pointer, at places all over the plot; and where a key has just been moved."""
    scene = shown(stack, clip, None)
    view = scene.view
    rect = view.plot_rect
    random = np.random.default_rng(3)
    places = cycle(random.uniform((rect.left(), rect.top()), (rect.right(), rect.bottom()), (200, 2)).tolist())
    taken = [_hit_time(view, *next(places)) for _ in range(600)][200:]  # all over the plot once, then again
    one, after_edits, ups = Selection.of_key(scene.channel, scene.key_id), [], cycle((0.5, -0.5))
    x = float(view.x_from_time(scene.channel.key(scene.key_id).time))
    for _ in range(100):
        up = next(ups)
        view.document.do("Move", lambda clip, up=up: edits.move(clip, one, 0.0, up))
        QApplication.processEvents()  # it is painted before anybody can point at it
        after_edits.append(_hit_time(view, x + 3.0, rect.center().y()))
    times, first = summed_up(taken), summed_up(after_edits)
    return [
        Line(f"hit test, {name}", times.median, most=0.3e-3),
        Line(f"hit test, {name}, 99 %", times.p99),
        Line(f"the first hit test after an edit, {name}", first.median, most=0.3e-3),
        Line(f"the first hit test after an edit, {name}, 99 %", first.p99),
    ]


def _hit_time(view: CurveView, x: float, y: float) -> float:
    start = perf_counter()
    hit(view, x, y)
    return perf_counter() - start


def run() -> list[Line]:
    """All figures of the picture."""
    stack = QStackedWidget()
    stack.resize(*SIZE)
    stack.show()
    clips = {name: make() for name, make in CLIPS.items()}
    lines = drags(stack, clips)
    lines.append(drag_in_the_editor(clips["200 x 1,000 keys"]))
    lines.append(drag_of_some(stack, clips["200 x 1,000 keys"]))
    lines.append(drag_of_all(stack, clips["1 x 1,000,000 keys"]))
    lines += stretches_of_all(stack, clips["1 x 1,000,000 keys"])
    for name, clip in clips.items():
        lines += [*view_steps(stack, name, clip), *hit_tests(stack, name, clip)]
    stack.close()
    return lines
