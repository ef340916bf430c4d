"""Keys pressed on the X server's keyboard, where Shift turns a comma into another letter, reach their actions."""

import shutil
import subprocess
from contextlib import suppress

import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.main_window import MainWindow
from app.menus import WindowAction
from tests.app.test_actions import DEFAULT_KEYS

# How xdotool calls what shortcuts call otherwise.
NAMES = {
    ",": "comma",
    ".": "period",
    "[": "bracketleft",
    "]": "bracketright",
    "Del": "Delete",
    "Backspace": "BackSpace",
    "Space": "space",
}


def pressed(keys: str) -> str:
    """*keys* as an argument of xdotool."""
    *modifiers, key = keys.split("+")
    return "+".join(
        [*(modifier.lower() for modifier in modifiers), NAMES.get(key, key if len(key) > 1 else key.lower())]
    )


@pytest.mark.window
@pytest.mark.skipif(shutil.which("xdotool") is None, reason="needs xdotool to press the X server's keys")
def test_each_key_of_the_default_map_reaches_its_action(
    qtbot: QtBot, window: MainWindow, monkeypatch: pytest.MonkeyPatch
) -> None:
    called: list[str] = []
    monkeypatch.setattr(WindowAction, "run", lambda action: called.append(action.row.id))
    # Whether an action can run now is another test's matter; nothing may take it back in the middle of this one.
    monkeypatch.setattr(WindowAction, "refresh", lambda action, *_: None)
    for action in window.actions_by_id.values():
        action.setEnabled(True)
    window.activateWindow()
    window.view.setFocus()
    qtbot.waitUntil(lambda: QApplication.focusWidget() is window.view)
    for keys, wanted in DEFAULT_KEYS.items():
        called.clear()
        subprocess.run(["xdotool", "key", pressed(keys)], check=True, timeout=20)
        with suppress(qtbot.TimeoutError):
            qtbot.waitUntil(lambda: bool(called), timeout=5000)
        assert called == [wanted], keys
