"""The list of undo steps: those taken back are dim, and long ones are told in full by the mouse."""

from PySide6.QtCore import QEvent, QPoint
from PySide6.QtGui import QHelpEvent, QPalette
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QStyleOptionViewItem, QToolTip
from pytestqt.qtbot import QtBot

from app.main_window import MainWindow
from app.undo import UndoSteps


def steps_of(window: MainWindow) -> UndoSteps:
    window.docks["history"].show()
    for _ in range(3):
        window.actions_by_id["edit.select_all"].run()
        window.actions_by_id["key.up"].run()
    QApplication.processEvents()
    (steps,) = window.docks["history"].findChildren(UndoSteps)
    return steps


def inks(steps: UndoSteps) -> list[str]:
    """The colour of each row's words."""
    found = []
    for row in range(steps.model().rowCount()):
        option = QStyleOptionViewItem()
        option.palette = steps.palette()
        steps.itemDelegate().initStyleOption(option, steps.model().index(row, 0))
        found.append(option.palette.color(QPalette.ColorRole.Text).name())
    return found


def test_steps_that_are_taken_back_are_dim(opened: MainWindow) -> None:
    steps = steps_of(opened)
    assert len(set(inks(steps))) == 1
    opened.undo_stack.undo()
    opened.undo_stack.undo()
    plain, *rest = inks(steps)
    assert [ink == plain for ink in rest] == [True, False, False]


def test_a_long_step_is_cut_to_the_list_and_told_in_full(qtbot: QtBot, opened: MainWindow) -> None:
    steps = steps_of(opened)
    assert not steps.horizontalScrollBar().isVisible()
    row = steps.visualRect(steps.model().index(1, 0))
    assert row.width() <= steps.viewport().width()
    spot = row.center()
    QTest.mouseMove(steps.viewport(), spot)
    tip = QHelpEvent(QEvent.Type.ToolTip, spot, steps.viewport().mapToGlobal(QPoint(spot)))
    QApplication.sendEvent(steps.viewport(), tip)
    qtbot.waitUntil(lambda: QToolTip.text() == opened.undo_stack.text(0))
    QToolTip.hideText()
