"""Settings come back with their types, and a broken file never hinders the start."""

from pathlib import Path

import pytest
from PySide6.QtCore import QByteArray

from app.settings import RECENT_FILES_KEPT, Settings


def test_values_keep_their_types_when_another_run_reads_them(tmp_path: Path) -> None:
    path = str(tmp_path / "hermite.ini")
    settings = Settings(path)
    settings.snap, settings.appearance, settings.geometry = False, "light", QByteArray(b"\x00\x01geometry")
    settings.recent_files = ["/only/one, two.anim"]
    settings.sync()

    again = Settings(path)
    assert again.snap is False
    assert again.appearance == "light"
    assert again.geometry == QByteArray(b"\x00\x01geometry")
    assert again.recent_files == ["/only/one, two.anim"]


@pytest.mark.parametrize(
    "text", ["[files]\nrecent=\n", '[files]\nrecent="\\n\\n"\n', "\x00\x01", "[editing]\nsnap=perhaps"]
)
def test_a_broken_file_gives_the_defaults(tmp_path: Path, text: str) -> None:
    path = tmp_path / "hermite.ini"
    path.write_text(text)
    settings = Settings(str(path))
    assert settings.recent_files == []
    assert settings.loop is True
    assert isinstance(settings.snap, bool)


def test_the_newest_file_is_first_and_stands_there_once(tmp_path: Path) -> None:
    settings = Settings(str(tmp_path / "hermite.ini"))
    for name in ("a", "b", "a"):
        settings.add_recent_file(name)
    assert settings.recent_files == ["a", "b"]
    settings.remove_recent_file("a")
    assert settings.recent_files == ["b"]
    for number in range(50):
        settings.add_recent_file(str(number))
    assert len(settings.recent_files) == RECENT_FILES_KEPT
