"""What the window shows and lets the user do while very many keys are changed on another thread."""

import threading
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QImage, QKeyEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit
from pytestqt.qtbot import QtBot

import model.document
from app.main_window import MainWindow
from app.progress_row import PATIENCE_MILLISECONDS
from model import edits
from model.change import Change, put, shifted
from model.channel import Channel
from model.clip import Clip
from model.clipboard import text_from_keys
from model.document import Edit
from model.keyframe import make_run
from model.progress import Report
from model.selection import Selection
from tests.app.conftest import MakeWindow, answers_of
from tests.app.test_jobs import meanwhile, press_escape, progress
from widgets.soon import Soon

KEYS = 40_000


class Gate:
    """Holds up each change of a clip, when it has been made, until it is opened; *fail* makes it an error."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self._open = threading.Event()
        self.threads: list[threading.Thread] = []
        self.fail = False
        monkeypatch.setattr(model.document, "put", partial(self._held_up, put))
        monkeypatch.setattr(model.document, "shifted", partial(self._held_up, shifted))

    def _held_up(self, make: Callable[..., Change | None], *args: Any, **settings: Any) -> Change | None:
        self.threads.append(threading.current_thread())
        if self.fail and threading.current_thread() is not threading.main_thread():
            raise ValueError("it cannot be")
        made = make(*args, **settings)
        if made is not None and threading.current_thread() is not threading.main_thread():
            self._open.wait(20)
        return made

    def open(self) -> None:
        self._open.set()


@pytest.fixture
def gate(monkeypatch: pytest.MonkeyPatch) -> Iterator[Gate]:
    gate = Gate(monkeypatch)
    yield gate
    gate.open()


@pytest.fixture
def window(make_window: MakeWindow) -> MainWindow:
    run = make_run(np.arange(KEYS) / 24.0, np.sin(np.arange(KEYS) / 3000.0))
    window = make_window(Clip([Channel("root.tx", run), Channel("root.ty", run)], end=KEYS / 24.0))
    window.activateWindow()
    window.actions_by_id["edit.select_all"].run()
    QApplication.processEvents()
    window.view.canvas.settle()
    QTest.qWait(50)
    return window


def data(window: MainWindow) -> list[bytes]:
    return [channel.run().tobytes() for channel in window.document.clip.channels]


def picture(window: MainWindow) -> QImage:
    return window.view.grab().toImage()


def nudge(window: MainWindow) -> None:
    window.actions_by_id["key.up"].run()


def raise_all(window: MainWindow) -> Edit | None:
    selection = window.session.selection
    return window.document.do(
        "Raise", lambda clip: edits.nudge(clip, selection, 0.0, 0.1), keys=window.session.selection.count
    )


def test_the_picture_is_the_last_one_until_the_change_is_made(window: MainWindow, gate: Gate) -> None:
    before, old = picture(window), data(window)

    def look() -> QImage:
        window.view.canvas.repaint_all()
        QApplication.processEvents()
        return picture(window)

    seen = meanwhile(look, lambda: window.grab() is not None, gate.open)
    nudge(window)
    assert seen[0] == before
    QApplication.processEvents()
    assert picture(window) != before
    assert data(window) != old
    assert threading.main_thread() not in gate.threads


def test_nobody_is_told_and_nothing_is_refreshed_before_all_is_done(window: MainWindow, gate: Gate) -> None:
    told: list[tuple[str, bool]] = []

    def listen(name: str) -> Callable[..., None]:
        return lambda *_: told.append((name, window.document.working))

    slots = {name: listen(name) for name in ("changed", "committed")}
    for name, slot in slots.items():
        getattr(window.document, name).connect(slot)
    window.inspector.key.refresh = listen("inspector")  # type: ignore[method-assign]
    window.view.router.tool.refresh = listen("tool")  # type: ignore[method-assign]
    window.view.router.tool.hover = listen("hover")  # type: ignore[method-assign, assignment]
    QTest.mouseMove(window.view.viewport(), QPoint(300, 200))
    window.view.router.look_again()
    Soon(window, listen("soon"), document=window.document).ask()
    meanwhile(lambda: QTest.qWait(150), gate.open)
    nudge(window)
    QTest.qWait(200)
    assert {name for name, _ in told} >= {"changed", "committed", "tool", "soon"}
    assert not any(working for _, working in told)


def test_no_other_edit_is_possible_meanwhile(window: MainWindow, gate: Gate) -> None:
    document, actions, viewport = window.document, window.actions_by_id, window.view.viewport()
    window.view.setFocus()
    steps = window.undo_stack.count()
    spot = window.view.plot_rect.center().toPoint()
    selection = window.session.selection

    def refused() -> bool:
        with pytest.raises(RuntimeError, match=r"still going on|another thread"):
            document.begin("Another")
        return document.working

    seen = meanwhile(
        actions["key.up"].trigger,
        actions["edit.undo"].trigger,
        lambda: QTest.keyClick(window.view, Qt.Key.Key_Up),
        lambda: QTest.keyClick(window.view, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier),
        lambda: QTest.keyClick(window, Qt.Key.Key_Space),
        lambda: QTest.mouseClick(viewport, Qt.MouseButton.LeftButton, pos=spot),
        lambda: QTest.mouseDClick(viewport, Qt.MouseButton.LeftButton, pos=spot),
        lambda: QTest.mouseClick(window.windowHandle(), Qt.MouseButton.LeftButton, pos=QPoint(100, 300)),
        refused,
        gate.open,
        pause=10,
    )
    nudge(window)
    QTest.qWait(50)
    assert seen[-2] is True
    assert window.undo_stack.count() == window.undo_stack.index() == steps + 1
    assert window.session.selection == selection
    assert not window.session.playing
    assert window.focusWidget() is window.view
    nudge(window)
    assert window.undo_stack.index() == steps + 2


def test_what_is_typed_meanwhile_goes_nowhere_and_the_focus_stays(window: MainWindow, gate: Gate) -> None:
    field = window.tree.filter
    field.setFocus()
    meanwhile(lambda: QTest.keyClicks(field, "up"), gate.open)
    raise_all(window)
    assert field.text() == ""
    assert window.focusWidget() is field
    QTest.keyClicks(field, "tx")
    assert field.text() == "tx"


def test_ctrl_that_was_let_go_meanwhile_is_not_held_for_ever(window: MainWindow, gate: Gate) -> None:
    control = Qt.KeyboardModifier.ControlModifier
    press = QKeyEvent(QEvent.Type.KeyPress, Qt.Key.Key_Control, control)
    QApplication.sendEvent(window.view, press)
    assert window.view.router._modifiers == control
    meanwhile(lambda: QTest.keyRelease(window.view, Qt.Key.Key_Control), gate.open)
    nudge(window)
    assert window.view.router._modifiers == Qt.KeyboardModifier.NoModifier


@pytest.mark.parametrize("by", ["escape", "button"])
def test_cancelled_it_has_never_been(window: MainWindow, gate: Gate, by: str) -> None:
    before, steps, selection = data(window), window.undo_stack.count(), window.session.selection
    row = progress(window)

    def cancel() -> None:
        if by == "escape":
            press_escape(window)
        else:
            QTest.mouseClick(row.cancel, Qt.MouseButton.LeftButton)

    seen = meanwhile(lambda: row.isVisible(), cancel, gate.open, pause=PATIENCE_MILLISECONDS + 50)
    nudge(window)
    assert seen[0] is True
    assert data(window) == before
    assert window.undo_stack.count() == steps
    assert window.session.selection == selection
    assert "cancelled" in window.status.message.text()
    assert window.document.gesture is None
    for channel in window.document.clip.channels:
        channel.check()
    nudge(window)
    assert data(window) != before


def cancelled_step(window: MainWindow, gate: Gate, take: Callable[[], object]) -> None:
    """Take a step of the history, press Esc in it, and see that it has never been and can be taken again."""
    here, before, selection = window.undo_stack.index(), data(window), window.session.selection
    gate._open.clear()
    seen = meanwhile(
        lambda: progress(window).cancel.isVisible(),
        lambda: press_escape(window),
        gate.open,
        pause=PATIENCE_MILLISECONDS + 50,
    )
    take()
    QApplication.processEvents()
    assert seen[0] is True
    assert data(window) == before
    assert window.undo_stack.index() == here
    assert window.session.selection == selection
    assert "cancelled" in window.status.message.text()
    for channel in window.document.clip.channels:
        channel.check()


def test_an_undo_or_redo_that_is_cancelled_has_never_been(window: MainWindow, gate: Gate) -> None:
    states, stack, actions = [data(window)], window.undo_stack, window.actions_by_id
    gate.open()
    for _ in range(3):
        nudge(window)
        states.append(data(window))
    cancelled_step(window, gate, actions["edit.undo"].run)
    cancelled_step(window, gate, lambda: stack.setIndex(0))  # as the list of steps does
    actions["edit.undo"].run()
    assert data(window) == states[2]
    actions["edit.undo"].run()
    cancelled_step(window, gate, actions["edit.redo"].run)
    cancelled_step(window, gate, lambda: stack.setIndex(3))
    actions["edit.redo"].run()
    assert (data(window), stack.index()) == (states[2], 2)
    stack.setIndex(0)
    assert (data(window), stack.isClean()) == (states[0], True)


def test_a_change_right_after_a_cancelled_undo_is_the_next_step(window: MainWindow, gate: Gate) -> None:
    gate.open()
    nudge(window)
    once = data(window)
    gate._open.clear()
    meanwhile(lambda: press_escape(window), gate.open)
    channel = window.document.clip.channels[0]
    one = Selection.of_key(channel, channel.ids_between(0.0, 0.0)[0])
    window.undo_stack.setIndex(0)
    assert window.document.do("Raise", lambda clip: edits.nudge(clip, one, 0.0, 0.1)) is not None
    assert window.undo_stack.index() == window.undo_stack.count() == 2
    window.undo_stack.undo()
    assert (data(window), window.undo_stack.index()) == (once, 1)


def test_a_mark_right_after_a_cancelled_undo_is_where_the_document_is(window: MainWindow, gate: Gate) -> None:
    gate.open()
    nudge(window)
    gate._open.clear()
    meanwhile(lambda: press_escape(window), gate.open)
    window.undo_stack.setIndex(0)
    assert window.undo_stack.mark().step == 1


def test_an_error_is_told_once_and_nothing_has_changed(window: MainWindow, gate: Gate) -> None:
    before, steps = data(window), window.undo_stack.count()
    gate.fail = True
    gate.open()
    with pytest.raises(ValueError, match="it cannot be"):
        raise_all(window)
    assert data(window) == before
    assert window.undo_stack.count() == steps
    assert window.document.gesture is None
    gate.fail = False
    assert raise_all(window) is not None
    assert data(window) != before


def test_closing_waits_until_the_change_is_made(qtbot: QtBot, window: MainWindow, gate: Gate) -> None:
    seen = meanwhile(window.close, window.isVisible, gate.open)
    nudge(window)
    assert seen[:2] == [False, True]
    qtbot.waitUntil(lambda: bool(answers_of(window).asked))
    assert answers_of(window).asked == ["save_changes"]
    assert window.undo_stack.count() == 1


def test_the_playhead_stands_still_meanwhile_and_then_goes_on(window: MainWindow, gate: Gate) -> None:
    window.actions_by_id["play.toggle"].run()
    QTest.qWait(50)
    places = meanwhile(lambda: window.session.playhead, lambda: window.session.playhead, gate.open)
    nudge(window)
    assert places[0] == places[1]
    QTest.qWait(50)
    assert window.session.playing
    assert window.session.playhead > places[0]  # type: ignore[operator]


def test_few_keys_are_changed_here_and_now(window: MainWindow, gate: Gate) -> None:
    jobs: list[object] = []
    window.jobs.changed.connect(lambda: jobs.append(window.jobs.job))
    channel = window.document.clip.channels[0]
    ids = channel.keys_between(0.0, 100.0)["id"]
    window.session.selection = Selection.of({channel: ids})
    nudge(window)
    assert set(gate.threads) == {threading.main_thread()}
    assert jobs == []


def test_a_change_during_another_job_is_made_at_once(window: MainWindow, gate: Gate) -> None:
    gate.open()
    before, done = data(window), threading.Event()
    meanwhile(lambda: nudge(window), done.set)
    window.jobs.run("Something else", lambda _report: done.wait(20), at_once=False)
    assert data(window) != before
    assert set(gate.threads) == {threading.main_thread()}


def test_a_click_elsewhere_does_not_move_the_focus(window: MainWindow, gate: Gate) -> None:
    line, other = window.inspector.findChildren(QLineEdit)[0], window.tree.filter
    spot = other.mapTo(window, other.rect().center())

    def click() -> None:
        QTest.mouseClick(window.windowHandle(), Qt.MouseButton.LeftButton, pos=spot)

    line.setFocus()
    meanwhile(click, gate.open)
    raise_all(window)
    assert window.focusWidget() is line
    click()
    assert window.focusWidget() is other


def test_the_wheel_does_not_move_the_view_meanwhile(window: MainWindow, gate: Gate) -> None:
    viewport, before = window.view.viewport(), window.view.view_range
    spot = QPointF(viewport.rect().center())
    none, phase = Qt.MouseButton.NoButton, Qt.ScrollPhase.NoScrollPhase

    def turn() -> None:
        there = QPointF(viewport.mapToGlobal(spot))
        held = Qt.KeyboardModifier.NoModifier
        QApplication.sendEvent(viewport, QWheelEvent(spot, there, QPoint(), QPoint(0, 120), none, held, phase, False))

    meanwhile(turn, gate.open)
    nudge(window)
    assert window.view.view_range == before
    turn()
    assert window.view.view_range != before


def test_keys_are_written_and_read_as_text_on_another_thread_and_that_can_be_stopped(
    window: MainWindow, monkeypatch: pytest.MonkeyPatch
) -> None:
    clipboard, threads = QApplication.clipboard(), []
    clipboard.setText("before")

    def written(selection: Selection, report: Report) -> str:
        threads.append(threading.current_thread())
        while cancel.is_set():
            report(0.5)
        return text_from_keys(selection, report)

    cancel = threading.Event()
    cancel.set()
    monkeypatch.setattr("app.actions.clipboard.text_from_keys", written)
    meanwhile(lambda: press_escape(window))
    window.actions_by_id["edit.cut"].run()
    assert clipboard.text() == "before"
    assert window.document.clip.key_count == 2 * KEYS
    cancel.clear()
    window.actions_by_id["edit.copy"].run()
    assert clipboard.text().count("\n") == 2 * KEYS + 1
    assert threading.main_thread() not in threads
    window.session.playhead = 1e6
    window.actions_by_id["edit.paste"].run()
    assert window.document.clip.key_count == 4 * KEYS
