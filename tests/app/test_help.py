"""Help tells what is there: every command with its keys, and what the mouse does."""

from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from app.about import versions
from app.actions import ACTIONS
from app.help import MouseDialog, ShortcutsDialog
from app.main_window import MainWindow


def shown_rows(dialog: ShortcutsDialog | MouseDialog) -> list[list[str]]:
    model = dialog.table.model()
    return [
        [str(model.index(row, column).data()) for column in range(model.columnCount())]
        for row in range(model.rowCount())
        if not dialog.table.isRowHidden(row)
    ]


def test_every_command_is_in_the_table_and_the_filter_finds_it_by_its_keys(qtbot: QtBot, window: MainWindow) -> None:
    dialog = ShortcutsDialog(window)
    assert len(shown_rows(dialog)) == len(ACTIONS)
    dialog.field.setText("ctrl+d")
    assert [row[1] for row in shown_rows(dialog)][:1] == ["Duplicate"]


def test_the_mouse_table_can_be_searched(qtbot: QtBot, window: MainWindow) -> None:
    dialog = MouseDialog(window)
    dialog.field.setText("insert key")
    assert any("Ctrl+click" in row[1] for row in shown_rows(dialog))


def test_about_names_the_versions_it_runs_on() -> None:
    assert dict(versions()).keys() >= {"Hermite", "Python", "numpy", "pyqtgraph"}


def test_no_text_of_the_table_is_cut(qtbot: QtBot, window: MainWindow) -> None:
    dialog = ShortcutsDialog(window)
    dialog.show()
    qtbot.waitExposed(dialog)
    table, model = dialog.table, dialog.table.model()
    metrics, last = table.fontMetrics(), model.columnCount() - 1
    for row in range(model.rowCount()):
        for column in range(last):
            text = str(model.index(row, column).data())
            assert metrics.horizontalAdvance(text) <= table.columnWidth(column), text
        text = str(model.index(row, last).data())
        needed = metrics.boundingRect(0, 0, table.columnWidth(last) - 8, 0, Qt.TextFlag.TextWordWrap, text)
        assert needed.height() <= table.rowHeight(row), text
