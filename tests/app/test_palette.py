"""The command palette finds commands and channels, runs them, and says why something cannot run."""

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from app.main_window import MainWindow
from app.palette import CommandPalette


def opened(qtbot: QtBot, window: MainWindow) -> CommandPalette:
    window.actions_by_id["edit.find_command"].run()
    (palette,) = window.findChildren(CommandPalette)
    return palette


def typed(palette: CommandPalette, text: str) -> list[str]:
    palette.field.setText(text)
    return [entry.title for entry in palette.model.found]


def test_enter_runs_the_best_command(qtbot: QtBot, window: MainWindow) -> None:
    palette = opened(qtbot, window)
    assert typed(palette, "sel all")[0] == "Select All"
    QTest.keyClick(palette.field, Qt.Key.Key_Return)
    assert window.session.selection.count == 6


def test_arrows_choose_another_one_while_typing(qtbot: QtBot, window: MainWindow) -> None:
    palette = opened(qtbot, window)
    titles = typed(palette, "tool")
    QTest.keyClick(palette.field, Qt.Key.Key_Down)
    assert palette.list.currentIndex().data() == titles[1]
    assert palette.field.text() == "tool"


def test_a_channel_becomes_active_and_shown(qtbot: QtBot, window: MainWindow) -> None:
    channel = window.document.clip.channel("root.rx")
    window.session.hidden = {channel}
    palette = opened(qtbot, window)
    assert typed(palette, "root.rx")[0] == "root.rx"
    palette.run_chosen()
    assert window.session.active is channel
    assert window.session.shown(channel)


def test_what_cannot_run_says_why_and_stays_open(qtbot: QtBot, window: MainWindow) -> None:
    palette = opened(qtbot, window)
    typed(palette, "duplicate")
    entry = palette.model.found[0]
    assert entry.unmet == "no keys are selected"
    palette.run_chosen()
    assert palette.isVisible()
    assert window.undo_stack.count() == 0
    palette.grab()


def test_rubbish_finds_nothing_and_enter_does_nothing(qtbot: QtBot, window: MainWindow) -> None:
    palette = opened(qtbot, window)
    assert typed(palette, "qqqq") == []
    palette.run_chosen()
    assert palette.isVisible()


def test_extrapolations_are_found_by_that_word_and_nothing_else_is(qtbot: QtBot, window: MainWindow) -> None:
    palette = opened(qtbot, window)
    typed(palette, "extrap")
    assert palette.model.found[0].title == "Extrapolations at the Mouse"
    assert {entry.place for entry in palette.model.found[1:]} == {
        "Curve ▸ Before the First Key",
        "Curve ▸ After the Last Key",
    }
    assert len(palette.model.found) == 11
