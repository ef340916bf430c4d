"""What the README says can be typed: every command line and every key of its tables."""

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import QApplication

from app.actions import ACTIONS

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^hermite (.+?)(?:\s+#.*)?$", README, re.MULTILINE)
KEY = re.compile(r"(?:(?:Ctrl|Shift|Alt)\+)*(?:[A-Z1-6\[\]]|F\d+|Left|Right|Home|Space|Del)")


def test_the_readme_has_commands_and_keys_to_check() -> None:
    assert len(COMMANDS) >= 5
    assert len(keys_of_the_tables()) > 40


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_of_the_readme_works_as_printed(command: str, tmp_path: Path) -> None:
    for sample in (ROOT / "resources" / "samples").iterdir():
        shutil.copy(sample, tmp_path)
    words = [sys.executable, str(ROOT / "main.py"), *shlex.split(command)]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=100, check=False)
    assert done.returncode == 0, done.stderr


def keys_of_the_tables() -> list[str]:
    cells = [cell for line in README.splitlines() if line.startswith("|") for cell in line.split("|")[2::2]]
    return [word for cell in cells for word in re.split(r"[\s,]+", cell) if KEY.fullmatch(word)]


def test_every_key_of_the_readme_does_something(qapp: QApplication) -> None:
    known = {
        sequence.toString()
        for action in ACTIONS
        for shortcut in action.shortcuts
        for sequence in (
            QKeySequence.keyBindings(shortcut) if not isinstance(shortcut, str) else [QKeySequence(shortcut)]
        )
    }
    assert {QKeySequence(key).toString() for key in keys_of_the_tables()} <= known
