"""With a million keys the window never stands still for more than a tenth of a second."""

from collections.abc import Callable
from pathlib import Path
from time import perf_counter

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

import app.files
from app.main_window import MainWindow
from app.questions import Answer
from model.channel import Channel
from model.clip import Clip
from model.formats import write_bytes
from model.keyframe import make_run
from model.selection import Selection
from tests.app.conftest import MakeWindow, answers_of, small_clip
from tests.app.heart import Heart

KEYS = 1_000_000
MOST_SECONDS = 0.1
TRIES = 3
# To add 4,000,000 numbers to others takes so long where the limit was set.
USUAL_SECONDS = 8e-3


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("large") / "large.hermite"
    values = np.round(np.random.default_rng(5).normal(size=KEYS).cumsum(), 4)
    clip = Clip([Channel("root.tx", make_run(np.arange(KEYS) / 24.0, values))], end=KEYS / 24.0)
    path.write_bytes(write_bytes(clip, "hermite"))
    return path


def held_up(work: Callable[[], object], settle: int = 300) -> float:
    """The longest that the window stood still while *work* was done and its effects were painted."""
    with Heart() as heart:
        QTest.qWait(20)
        work()
        QTest.qWait(settle)
    return heart.longest


def slowness() -> float:
    """How many times as long as usual memory takes now, 1 at least: it is what drags of very many keys wait for."""
    a, b, total = np.ones((3, 4_000_000))
    taken = []
    for _ in range(3):
        start = perf_counter()
        np.add(a, b, out=total)
        taken.append(perf_counter() - start)
    return max(min(taken) / USUAL_SECONDS, 1.0)


def too_long(
    scenario: Callable[[], dict[str, float]], tries: int = TRIES, most: float = MOST_SECONDS
) -> dict[str, float]:
    """The works of *scenario* that hold the window up; each time, since what a busy machine adds is not ours."""
    least: dict[str, float] = {}
    for _ in range(tries):
        for work, pause in scenario().items():
            least[work] = min(pause, least.get(work, pause))
        if max(least.values()) <= most:
            break
    return {work: pause for work, pause in least.items() if pause > most}


def edit_some(window: MainWindow) -> None:
    channel = window.document.clip.channels[0]
    window.session.selection = Selection.of({channel: channel.keys_between(100.0, 104.0)["id"]})
    window.actions_by_id["key.up"].run()


def pan_and_zoom(window: MainWindow) -> None:
    for step in range(10):
        window.view.pan_pixels(40.0, 3.0)
        QTest.qWait(10)
        window.view.zoom(1.3 if step % 2 else 0.8, 1.0, QPointF(400.0, 300.0))
        QTest.qWait(10)


def cancel_half_way(window: MainWindow, path: Path) -> None:
    watch = QTimer()
    watch.timeout.connect(lambda: window.jobs.job and window.jobs.job.share > 0.5 and press_escape(window))
    watch.start(5)
    assert not window.open_file(str(path))


def press_escape(window: MainWindow) -> None:
    QTest.keyClick(window.view, Qt.Key.Key_Escape)


def test_nothing_that_files_need_stops_the_window(make_window: MakeWindow, large: Path, tmp_path: Path) -> None:
    window = make_window(small_clip())
    window.activateWindow()
    QApplication.processEvents()
    answers, actions = answers_of(window).answers, window.actions_by_id
    answers |= {"path_to_save": (str(tmp_path / "out.anim"), "anim"), "lossy_save": Answer.ANYWAY}
    answers["save_changes"] = Answer.DISCARD
    mine = tmp_path / "mine.hermite"

    def scenario() -> dict[str, float]:
        mine.write_bytes(large.read_bytes())
        pauses = {"opening": held_up(lambda: window.open_file(str(mine)))}
        assert window.document.clip.key_count == KEYS
        pauses["playing"] = held_up(actions["play.toggle"].run)
        actions["play.toggle"].run()
        pauses["panning and zooming"] = held_up(lambda: pan_and_zoom(window))
        pauses["editing"] = held_up(lambda: edit_some(window))
        pauses["undoing"] = held_up(window.undo_stack.undo)
        pauses["doing it again"] = held_up(window.undo_stack.redo)
        pauses["saving"] = held_up(lambda: window.save())
        assert not window.isWindowModified()
        pauses["saving in another format"] = held_up(lambda: window.save_as())
        assert (tmp_path / "out.anim").stat().st_size > KEYS
        clip = window.document.clip
        pauses["cancelling half-way"] = held_up(lambda: cancel_half_way(window, mine))
        assert window.document.clip is clip
        return pauses

    assert too_long(scenario) == {}


def test_no_change_of_a_million_keys_stops_the_window(make_window: MakeWindow, large: Path) -> None:
    window = make_window(small_clip())
    answers_of(window).answers["save_changes"] = Answer.DISCARD
    names = {"up": "key.up", "flat": "tangent.flat"}
    steps = ("select_all", "up", "undo", "redo", "flat", "delete", "undo", "duplicate", "undo")

    def scenario() -> dict[str, float]:
        assert window.open_file(str(large))
        QTest.qWait(300)
        pauses = {}
        for number, step in enumerate(steps):
            if step == "duplicate":
                # Two million keys with every second one selected take longer to paint if all are in view.
                window.view.set_view(window.view.view_range._replace(t0=100.0, t1=104.0))
                QTest.qWait(100)
            action = window.actions_by_id[names.get(step, f"edit.{step}")]
            pauses[f"{number + 1}: {step}"] = held_up(action.run)
        assert window.session.selection.count == KEYS
        assert window.undo_stack.index() == 2
        return pauses

    assert too_long(scenario) == {}


def drag_all(window: MainWindow, tool: str, grip: Callable[[], QPointF], step: QPoint) -> None:
    window.session.tool = tool
    QTest.qWait(200)
    viewport, start = window.view.viewport(), grip().toPoint()
    QTest.mouseMove(viewport, start)
    QTest.mousePress(viewport, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, start)
    for number in range(1, 6):
        QTest.mouseMove(viewport, start + number * step)
        QTest.qWait(20)
    QTest.qWait(150)  # as a hand does: else the last step and the release would be one to the timer
    QTest.mouseRelease(viewport, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, start + 5 * step)


def test_no_drag_of_a_million_keys_stops_the_window(make_window: MakeWindow, large: Path) -> None:
    window = make_window(small_clip())
    answers_of(window).answers["save_changes"] = Answer.DISCARD
    view = window.view

    def a_key() -> QPointF:
        channel = window.document.clip.channels[0]
        key = channel.nearest_key(view.time_from_x(view.plot_rect.center().x()))
        assert key is not None
        return QPointF(view.x_from_time(key.time), view.y_from_value(key.value))

    def the_right_edge() -> QPointF:
        frame = view.canvas.overlay.frame
        assert frame is not None
        return max(frame.handles, key=lambda spot: (spot.x(), -spot.y()))

    def scenario() -> dict[str, float]:
        assert window.open_file(str(large))
        window.actions_by_id["edit.select_all"].run()
        view.frame_all()
        QTest.qWait(300)
        pauses = {}
        for tool, grip, step in (
            ("select", a_key, QPoint(2, -6)),
            ("scale", the_right_edge, QPoint(-12, 3)),
            ("retime", the_right_edge, QPoint(-12, 0)),
        ):
            before = window.document.clip.channels[0].ends()
            pauses[tool] = held_up(lambda t=tool, g=grip, s=step: drag_all(window, t, g, s))
            assert window.document.clip.channels[0].ends() != before
        assert window.undo_stack.index() == 3
        return pauses

    # Memory is what these wait for most, and other programs use it too.
    assert too_long(scenario, tries=5, most=MOST_SECONDS * slowness()) == {}


def test_no_text_of_very_many_keys_stops_the_window(make_window: MakeWindow, large: Path) -> None:
    window = make_window(small_clip())
    answers_of(window).answers["save_changes"] = Answer.DISCARD

    def scenario() -> dict[str, float]:
        assert window.open_file(str(large))
        channel = window.document.clip.channels[0]
        window.view.set_view(window.view.view_range._replace(t0=100.0, t1=104.0))
        window.session.selection = Selection.of({channel: channel.keys_between(0.0, 6_000.0)["id"]})
        window.session.playhead = 10_000.01
        QTest.qWait(300)
        pauses = {step: held_up(window.actions_by_id[f"edit.{step}"].run) for step in ("copy", "paste", "undo", "cut")}
        assert len(channel) == KEYS - 144_001
        return pauses

    assert too_long(scenario) == {}


def test_no_clip_of_very_many_channels_stops_the_window(make_window: MakeWindow, tmp_path: Path) -> None:
    window = make_window(small_clip())
    answers_of(window).answers["save_changes"] = Answer.DISCARD
    values = np.round(np.random.default_rng(6).normal(size=(500, 100)).cumsum(axis=1), 3)
    channels = [
        Channel(f"joint{i // 3}.t{'xyz'[i % 3]}", make_run(np.arange(100.0), row)) for i, row in enumerate(values)
    ]
    path = tmp_path / "many.hermite"
    path.write_bytes(write_bytes(Clip(channels, end=100.0), "hermite"))

    def scenario() -> dict[str, float]:
        pauses = {"opening": held_up(lambda: window.open_file(str(path)), settle=600)}
        assert len(window.document.clip.channels) == 500
        pauses["filtering"] = held_up(lambda: QTest.keyClick(window.tree.filter, "j"))
        window.tree.filter.clear()
        return pauses

    assert too_long(scenario) == {}


def test_a_window_that_does_stop_is_noticed(
    make_window: MakeWindow, large: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    window = make_window(small_clip())
    monkeypatch.setattr(app.files, "FEW_BYTES", 1 << 40)
    assert held_up(lambda: window.open_file(str(large))) > MOST_SECONDS


def test_a_change_made_in_the_window_s_own_thread_is_noticed(make_window: MakeWindow, large: Path) -> None:
    window = make_window(small_clip())
    assert window.open_file(str(large))
    window.actions_by_id["edit.select_all"].run()
    window.document.long_work = None
    assert held_up(window.actions_by_id["edit.duplicate"].run) > MOST_SECONDS
