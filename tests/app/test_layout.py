"""The layout of a second start: panels as wide as they were left, the rest and the keyboard for the graph."""

from collections.abc import Iterator

import pytest
from PySide6.QtCore import QCoreApplication, QEvent
from PySide6.QtWidgets import QApplication, QToolBar
from pytestqt.qtbot import QtBot

from app.main_window import MainWindow
from app.settings import Settings
from model.document import Document
from tests.app.conftest import small_clip


@pytest.fixture
def started(qtbot: QtBot, settings: Settings) -> Iterator[list[MainWindow]]:
    """Windows made as the program makes them: the frame first, what is in it later."""
    windows: list[MainWindow] = []
    yield windows
    for window in windows:
        window.close()
        window.deleteLater()
    windows.clear()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


def start(windows: list[MainWindow], qtbot: QtBot, settings: Settings) -> MainWindow:
    window = MainWindow(settings=settings, frame_only=True)
    windows.append(window)
    window.resize(1300, 800)
    window.show()
    qtbot.waitExposed(window)
    window.assemble(Document(small_clip()))
    window.activateWindow()
    qtbot.waitUntil(lambda: window.view.isVisible())
    qtbot.wait(30)
    return window


def widths(window: MainWindow) -> tuple[int, int, int]:
    return window.docks["channels"].width(), window.view.width(), window.docks["inspector"].width()


def test_a_second_start_gives_the_graph_as_much_room_as_the_first(
    started: list[MainWindow], qtbot: QtBot, settings: Settings
) -> None:
    first = start(started, qtbot, settings)
    before = widths(first)
    assert before[1] > before[0] + before[2], "most of the window is the graph's"
    first.close()
    second = start(started, qtbot, settings)
    assert widths(second) == pytest.approx(before, abs=4)


def test_the_keyboard_is_the_graphs_at_the_start(started: list[MainWindow], qtbot: QtBot, settings: Settings) -> None:
    for _ in range(2):
        window = start(started, qtbot, settings)
        qtbot.waitUntil(lambda window=window: QApplication.focusWidget() is window.view)  # type: ignore[misc]
        window.close()


def test_reset_layout_brings_back_panels_and_toolbar(
    started: list[MainWindow], qtbot: QtBot, settings: Settings
) -> None:
    window = start(started, qtbot, settings)
    before = widths(window)
    window.docks["inspector"].hide()
    window.docks["channels"].setFloating(True)
    for bar in window.findChildren(QToolBar):
        bar.hide()
    window.actions_by_id["view.reset_layout"].run()
    qtbot.wait(30)
    assert widths(window) == pytest.approx(before, abs=4)
    assert all(bar.isVisible() for bar in window.findChildren(QToolBar))


def test_the_first_window_is_no_larger_than_its_screen(
    qtbot: QtBot, settings: Settings, started: list[MainWindow]
) -> None:
    window = MainWindow(settings=settings)
    started.append(window)
    window.show()
    qtbot.waitExposed(window)
    room = window.screen().availableGeometry()
    assert window.width() < room.width()
    assert window.height() < room.height()
    assert window.minimumSizeHint().width() <= 700


@pytest.mark.parametrize("appearance", ["light", "dark"])
def test_the_menu_bar_has_one_line_along_its_bottom_and_none_below_each_name(
    window: MainWindow, appearance: str
) -> None:
    window.set_appearance(appearance)
    bar = window.menuBar()
    image = bar.grab().toImage()
    beside = image.width() // 2  # where no name is
    between = bar.actionGeometry(bar.actions()[0]).right() - 2
    column = [(image.pixelColor(between, y).name(), image.pixelColor(beside, y).name()) for y in range(bar.height())]
    assert all(here == there for here, there in column)
