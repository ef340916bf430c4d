"""The program does not grow heavier with what has been done in it: counted in calls and objects, not in seconds."""

from collections.abc import Callable
from itertools import cycle

import pytest
from PySide6.QtCore import QCoreApplication
from pytestqt.qtbot import QtBot

from app.main_window import MainWindow
from app.questions import Answer
from app.settings import Settings
from model import edits
from model.document import Document
from model.selection import Selection
from tests.app.conftest import Answers, MakeWindow, answers_of, small_clip
from tests.counting import alive, least_calls
from tests.widgets.hand import Hand

STEPS = 2_000
WINDOWS = 20


def drag_step(window: MainWindow) -> Callable[[], None]:
    """A step of a drag of the second key, from the mouse event to the end of the paint; the drag goes on."""
    channel, hand = window.document.clip.channels[0], Hand(window.view)
    window.session.snap = False
    key = list(channel)[1]
    window.session.selection = Selection.of_key(channel, key.id)
    x, y = hand.spot_of(key.time, key.value)
    places = iter(range(1_000))
    hand.press((x, y))

    def step() -> None:
        i = next(places)
        hand.move((x + 20 + i % 7, y - 20 - i % 5))
        QCoreApplication.processEvents()

    for _ in range(5):
        step()
    assert window.document.gesture is not None
    return step


def cost_of_a_drag(window: MainWindow) -> int:
    """Calls of a step; the drag is given up in the end."""
    QCoreApplication.processEvents()
    window.view.canvas.settle()
    (cost,) = least_calls(drag_step(window))
    end_drag(window)
    return cost


def end_drag(window: MainWindow) -> None:
    window.view.router.cancel()
    Hand(window.view).release((0.0, 0.0))
    QCoreApplication.processEvents()


def nudge(window: MainWindow, up: bool) -> None:
    everything = Selection.of_all(window.document.clip.channels[:1])
    window.document.do("Nudge", lambda clip: edits.move(clip, everything, 0.0, 0.125 if up else -0.125))


def costs_of_a_step(window: MainWindow) -> list[int]:
    """Calls of an edit, of taking it back, and of doing it again."""
    stack, ups = window.undo_stack, cycle((True, False))
    return least_calls(lambda: nudge(window, next(ups)), stack.undo, stack.redo)


def test_neither_a_drag_nor_an_undo_costs_more_after_very_many_steps(window: MainWindow) -> None:
    nudge(window, True)
    nudge(window, False)
    QCoreApplication.processEvents()
    drag = cost_of_a_drag(window)
    costs = costs_of_a_step(window)
    for i in range(STEPS + 1):
        nudge(window, bool(i % 2))
    assert window.undo_stack.count() > STEPS
    QCoreApplication.processEvents()
    assert cost_of_a_drag(window) == pytest.approx(drag, rel=0.05)
    assert costs_of_a_step(window) == pytest.approx(costs, rel=0.05)


def open_and_close(qtbot: QtBot, settings: Settings) -> None:
    """A window with its own document, used for a moment."""
    window = MainWindow(Document(small_clip()), settings)
    window.questions = Answers()
    answers_of(window).answers["save_changes"] = Answer.DISCARD
    window.show()
    qtbot.waitExposed(window)
    QCoreApplication.processEvents()
    drag_step(window)
    end_drag(window)
    nudge(window, True)
    window.close()
    window.deleteLater()


def test_windows_that_are_closed_leave_nothing_behind(
    qtbot: QtBot, make_window: MakeWindow, settings: Settings
) -> None:
    window = make_window(small_clip())
    for _ in range(2):
        open_and_close(qtbot, settings)
    before, drag = alive(), cost_of_a_drag(window)
    for _ in range(WINDOWS):
        open_and_close(qtbot, settings)
    now = alive()
    assert {name: (before[name], now[name]) for name in before | now if now[name] > before[name]} == {}
    assert cost_of_a_drag(window) == pytest.approx(drag, rel=0.05)
