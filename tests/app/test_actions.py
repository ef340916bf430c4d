"""The table of actions: whole, without contradictions, and every row does what it can at any time."""

from collections import Counter
from collections.abc import Callable

import pytest
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import QApplication, QDialog
from pytestqt.qtbot import QtBot

from app.actions import ACTIONS
from app.actions.row import Action
from app.file_menus import samples
from app.main_window import MainWindow
from app.menus import MENUS, TOOLBAR, TOOLBAR_MENUS, key_sequences
from app.questions import Answer
from model.clip import Clip
from model.document import Setting
from model.selection import Selection
from tests.app.conftest import MakeWindow, answers_of, small_clip
from widgets.icons import ICONS_FOLDER

# The default map: every key of it, and the action it calls.
DEFAULT_KEYS = {
    "Ctrl+A": "edit.select_all",
    "Ctrl+Shift+A": "edit.select_none",
    "Ctrl+I": "edit.select_inverse",
    "[": "edit.select_before",
    "]": "edit.select_after",
    "W": "key.tool.select",
    "R": "key.tool.scale",
    "T": "key.tool.retime",
    "1": "tangent.smooth",
    "2": "tangent.linear",
    "3": "tangent.flat",
    "4": "tangent.fixed",
    "5": "tangent.step",
    "6": "tangent.auto",
    "V": "tangent.menu",
    "B": "tangent.break",
    "U": "tangent.unify",
    "Shift+E": "curve.menu",
    "F": "view.frame_selection",
    "A": "view.frame_all",
    "Home": "view.frame_all",
    "Alt+Left": "view.back",
    "Alt+Right": "view.forward",
    "Ctrl+X": "edit.cut",
    "Ctrl+C": "edit.copy",
    "Ctrl+V": "edit.paste",
    "Ctrl+Shift+V": "edit.paste_special",
    "Ctrl+D": "edit.duplicate",
    ",": "key.earlier",
    ".": "key.later",
    "Up": "key.up",
    "Down": "key.down",
    "Shift+Up": "key.up_far",
    "Ctrl+Down": "key.down_fine",
    "Shift+.": "key.later_far",
    "Ctrl+,": "key.earlier_fine",
    "X": "key.snap",
    "Space": "play.toggle",
    "Left": "play.previous_frame",
    "Right": "play.next_frame",
    "Ctrl+Left": "play.previous_key",
    "Ctrl+Right": "play.next_key",
    "S": "key.at_playhead",
    "I": "key.at_playhead",
    "Del": "edit.delete",
    "Backspace": "edit.delete",
    "H": "channel.hide",
    "Shift+H": "channel.show_only",
    "Alt+H": "channel.reveal",
    "Ctrl+K": "edit.find_command",
    "F3": "edit.find_command",
    "Ctrl+F": "channel.filter",
    "Ctrl+Z": "edit.undo",
    "Ctrl+Shift+Z": "edit.redo",
    "Ctrl+Y": "edit.redo",
    "Ctrl+N": "file.new",
    "Ctrl+O": "file.open",
    "Ctrl+S": "file.save",
    "Ctrl+Shift+S": "file.save_as",
    "Ctrl+Q": "file.quit",
}


@pytest.mark.parametrize(("keys", "wanted"), DEFAULT_KEYS.items())
def test_each_key_of_the_default_map_calls_one_action(qapp: QApplication, keys: str, wanted: str) -> None:
    sequence = QKeySequence(keys)
    assert [row.id for row in ACTIONS if sequence in key_sequences(row.shortcuts)] == [wanted]


def test_no_two_actions_share_keys_an_id_or_a_place_in_a_menu(qapp: QApplication) -> None:
    keys = Counter(sequence.toString() for row in ACTIONS for sequence in key_sequences(row.shortcuts))
    ids = Counter(row.id for row in ACTIONS)
    places = Counter((row.menu, row.plain_label) for row in ACTIONS)
    for title in MENUS.values():
        keys[f"Alt+{title[title.index('&') + 1].upper()}"] += 1
    for counter in (keys, ids, places):
        assert not [name for name, times in counter.items() if times > 1]


@pytest.mark.parametrize("row", ACTIONS, ids=lambda row: row.id)
def test_each_row_has_a_menu_a_tip_and_an_icon_that_exists(row: Action) -> None:
    assert row.menu.partition("/")[0] in MENUS
    assert row.label
    assert row.tip
    assert not row.tip.endswith(".")
    assert not row.icon or (ICONS_FOLDER / f"{row.icon}.svg").exists()


def test_mnemonics_of_a_menu_are_its_own(window: MainWindow) -> None:
    for path, menu in window.menus.items():
        texts = [action.text().replace("&&", "") for action in menu.actions()]
        letters = Counter(text[text.index("&") + 1].lower() for text in texts if "&" in text)
        assert not [letter for letter, times in letters.items() if times > 1], path


def test_the_toolbar_has_only_what_exists(window: MainWindow) -> None:
    for name in (name for group in TOOLBAR for name in group):
        assert name in window.actions_by_id or name in TOOLBAR_MENUS


@pytest.mark.parametrize("selected", [False, True], ids=["nothing selected", "all selected"])
@pytest.mark.parametrize("clip", [small_clip, Clip], ids=["small clip", "empty clip"])
def test_every_action_can_be_called_at_any_time(
    qtbot: QtBot, make_window: MakeWindow, clip: Callable[[], Clip], selected: bool
) -> None:
    window = make_window(clip())
    answers_of(window).answers["save_changes"] = Answer.DISCARD
    for name in [row.id for row in ACTIONS if row.id != "file.quit"]:
        window.show_clip(clip())
        if selected:
            window.actions_by_id["edit.select_all"].run()
        window.actions_by_id[name].run()
        window.session.playing = False
        close_popups()
        window.document.clip.check()
        assert window.document.gesture is None, name
        undo_all(window)
    assert not answers_of(window).told


def close_popups() -> None:
    """Close what an action has opened, as Esc would."""
    QApplication.processEvents()
    while (popup := QApplication.activePopupWidget() or QApplication.activeModalWidget()) is not None:
        popup.close()
    for widget in QApplication.topLevelWidgets():
        if isinstance(widget, QDialog):
            widget.close()


def undo_all(window: MainWindow) -> None:
    while window.undo_stack.canUndo():
        window.undo_stack.undo()
    window.document.clip.check()


def test_no_command_touches_keys_that_are_not_shown(window: MainWindow) -> None:
    walk, turn, _ = window.document.clip.channels
    window.actions_by_id["edit.select_all"].run()
    window.session.solo = {turn}
    assert window.session.selection.channels == (turn,)
    window.actions_by_id["edit.delete"].run()
    assert (len(walk), len(turn)) == (4, 0)
    window.session.active = walk
    window.actions_by_id["edit.select_channel"].run()
    assert window.status.message.text().endswith("the active channel is not shown")


def test_the_status_line_says_that_a_nudge_has_replaced_a_key(window: MainWindow) -> None:
    walk = window.document.clip.channels[0]
    window.document.do("Set", lambda clip: [Setting(clip, "frame_rate", clip.frame_rate, 2.0)])
    window.session.selection = Selection.of_key(walk, 2)
    window.actions_by_id["key.later"].run()
    assert len(walk) == 3
    assert window.undo_stack.undoText() == "Nudge 1 key of root.tx by +0.50 s, replacing 1 key"
    assert window.status.message.text() == window.undo_stack.undoText()


def test_what_cannot_run_is_disabled_and_says_why(window: MainWindow) -> None:
    delete = window.actions_by_id["edit.delete"]
    assert not delete.isEnabled()
    window.refresh_tips()
    assert "no keys are selected" in delete.toolTip()
    window.actions_by_id["edit.select_all"].run()
    assert delete.isEnabled()
    window.refresh_tips()
    assert "Not now" not in delete.toolTip()


def test_undo_in_the_menu_says_what_it_takes_back(window: MainWindow) -> None:
    window.actions_by_id["edit.select_all"].run()
    window.actions_by_id["edit.delete"].run()
    assert window.actions_by_id["edit.undo"].text() == "&Undo Delete 6 keys of 2 channels"
    window.actions_by_id["edit.undo"].run()
    assert window.actions_by_id["edit.redo"].text() == "&Redo Delete 6 keys of 2 channels"
    assert window.session.selection.count == 6


def test_the_rule_buttons_show_the_rule_of_the_selected_keys(window: MainWindow) -> None:
    window.actions_by_id["edit.select_all"].run()
    assert window.actions_by_id["tangent.smooth"].isChecked()
    window.actions_by_id["tangent.flat"].run()
    assert window.actions_by_id["tangent.flat"].isChecked()
    assert not window.actions_by_id["tangent.smooth"].isChecked()
    window.actions_by_id["tangent.in.linear"].run()
    assert not window.actions_by_id["tangent.flat"].isChecked()
    assert window.actions_by_id["tangent.out.flat"].isChecked()


def test_copied_keys_come_back_at_the_playhead(window: MainWindow) -> None:
    channel = window.document.clip.channels[0]
    window.session.selection = type(window.session.selection).of({channel: channel.run()["id"][:2]})
    window.actions_by_id["edit.copy"].run()
    window.session.playhead = 3.0
    window.actions_by_id["edit.paste"].run()
    assert channel.run()["time"].tolist() == [0.0, 0.5, 1.0, 2.0, 3.0, 3.5]
    assert window.session.selection.count == 2


def test_text_that_is_no_keys_pastes_nothing_and_says_so(window: MainWindow) -> None:
    QApplication.clipboard().setText("buy milk")
    window.actions_by_id["edit.paste"].run()
    assert window.undo_stack.count() == 0
    assert "no keys" in window.status.message.text()


def test_a_paste_says_in_the_history_where_to(window: MainWindow) -> None:
    window.session.active = window.document.clip.channel("root.rx")
    window.actions_by_id["edit.select_all"].run()
    window.session.selection = window.session.selection.with_only([window.session.active])
    window.actions_by_id["edit.copy"].run()
    window.session.playhead = 0.25
    window.actions_by_id["edit.paste"].run()
    assert window.undo_stack.undoText() == "Paste 2 keys into root.rx"


def test_keys_that_find_no_channel_are_not_dropped_without_a_word(window: MainWindow) -> None:
    lines = [f"elsewhere{n}\t0.0\t{n}.0\t0.0\t0.0\tsmooth\tsmooth\tunified" for n in range(5)]
    QApplication.clipboard().setText("\n".join(["hermite-keys 1", *lines]))
    window.actions_by_id["edit.paste"].run()
    assert window.undo_stack.undoText().startswith("Paste 3 keys into 3 channels")
    assert window.status.message.text().endswith("for the other 2 there is no unlocked channel")


def test_back_and_forward_can_be_chosen_only_where_they_lead_somewhere(qtbot: QtBot, window: MainWindow) -> None:
    back, forward = window.actions_by_id["view.back"], window.actions_by_id["view.forward"]

    def possible() -> tuple[bool, bool]:
        return back.isEnabled(), forward.isEnabled()

    window.open_file(str(samples()[0]))
    qtbot.waitUntil(lambda: possible() == (False, False))
    back.run()
    assert window.status.message.text() == "Back: the view has not been moved"
    window.actions_by_id["view.zoom_in"].run()
    qtbot.waitUntil(lambda: possible() == (True, False))
    back.run()
    qtbot.waitUntil(lambda: possible() == (False, True))
