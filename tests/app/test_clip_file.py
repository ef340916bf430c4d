"""A file that another program writes is noticed; one that is only touched is not."""

import os
from collections.abc import Callable
from pathlib import Path
from time import monotonic

import pytest

import app.clip_file
import model.saving
from app.clip_file import Doubt, Leave, Saved, changed_since, fingerprint_of, open_clip, save_clip
from model.formats import FormatError, Loss, read_file
from model.formats.content import Content
from model.saving import SaveError

CLIP = b"""animation {
  range 0 1
  numchannels 1
  channel 0 {
    extrapolate constant constant
    keys 1 {
      0 1 flat flat
    }
  }
}
"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    file = tmp_path / "walk.anim"
    file.write_bytes(CLIP)
    return file


def test_a_touched_file_is_the_same_file(path: Path) -> None:
    known = fingerprint_of(str(path))
    os.utime(path, ns=(1, 1))
    assert not changed_since(str(path), known)


def test_other_bytes_of_the_same_length_are_noticed(path: Path) -> None:
    known = fingerprint_of(str(path))
    path.write_bytes(CLIP.replace(b"0 1 flat", b"0 2 flat"))
    os.utime(path, ns=(1, 1))
    assert changed_since(str(path), known)


def test_a_file_that_appears_where_none_was_is_a_change_and_one_that_goes_is_not(path: Path) -> None:
    assert changed_since(str(path), None)
    known = fingerprint_of(str(path))
    path.unlink()
    assert not changed_since(str(path), known)
    assert fingerprint_of(str(path)) is None


def test_opening_tells_format_and_absolute_path(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(path.parent)
    opened = open_clip("walk.anim")
    assert (opened.path, opened.format_name) == (str(path), "anim")
    assert opened.fingerprint == fingerprint_of(str(path))


def test_a_file_that_is_written_while_it_is_read_counts_as_changed(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def read_and_be_overtaken(name: str) -> bytes:
        data = read_file(name)
        path.write_bytes(CLIP.replace(b"0 1 flat", b"0 25 flat"))
        return data

    monkeypatch.setattr(app.clip_file, "read_file", read_and_be_overtaken)
    opened = open_clip(str(path))
    assert changed_since(str(path), opened.fingerprint)


def test_a_file_that_is_changed_behind_its_times_counts_as_changed(path: Path) -> None:
    opened, status = open_clip(str(path)), path.stat()
    path.write_bytes(CLIP.replace(b"0 1 flat", b"0 2 flat"))
    os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
    assert path.stat().st_size == status.st_size
    assert changed_since(str(path), opened.fingerprint)
    path.write_bytes(CLIP)
    assert not changed_since(str(path), opened.fingerprint)


def test_what_cannot_be_read_is_one_sentence_that_names_the_file(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match=r"nothing\.anim"):
        open_clip(str(tmp_path / "nothing.anim"))


def saved_while(path: Path, monkeypatch: pytest.MonkeyPatch, meanwhile: Callable[[], None]) -> Saved | Doubt:
    """Save the clip to its file, with something happening while what was written is being checked."""
    opened = open_clip(str(path))

    def differences(*contents: Content) -> list[Loss]:
        meanwhile()
        return []

    monkeypatch.setattr(model.saving, "differences", differences)
    return save_clip(Content.of(opened.clip), str(path), "anim", Leave([], opened.fingerprint, whatever=False))


def test_what_another_program_writes_during_a_save_is_not_overwritten(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = CLIP.replace(b"0 1 flat", b"0 2 flat")
    saved = saved_while(path, monkeypatch, lambda: path.write_bytes(other) and None)
    assert saved == Doubt([], overwrites_another=True)
    assert path.read_bytes() == other
    assert list(path.parent.iterdir()) == [path]


def test_a_new_file_that_is_damaged_before_it_is_read_back_does_not_get_into_its_place(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = model.saving._sync

    def damage_and_sync(handle: int) -> None:
        os.truncate(handle, 10)
        real(handle)

    monkeypatch.setattr(model.saving, "_sync", damage_and_sync)
    with pytest.raises(SaveError, match="other bytes than were written"):
        saved_while(path, monkeypatch, lambda: None)
    assert path.read_bytes() == CLIP
    assert list(path.parent.iterdir()) == [path]


def test_a_new_file_that_is_damaged_while_it_is_checked_does_not_get_into_its_place(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def damage() -> None:
        temp = next(file for file in path.parent.iterdir() if file != path)
        start = monotonic()
        while not temp.stat().st_size:
            assert monotonic() - start < 10.0, "the new file was not written"
        os.truncate(temp, 10)

    # The check runs beside the writing and the reading back: which of the two sees the damage is left open.
    with pytest.raises(SaveError, match=r"other bytes than were written|changed by something else"):
        saved_while(path, monkeypatch, damage)
    assert path.read_bytes() == CLIP
    assert list(path.parent.iterdir()) == [path]


def test_a_new_file_that_is_damaged_once_it_has_been_read_back_does_not_get_into_its_place(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = os.close

    def damage_and_close(handle: int) -> None:
        os.truncate(handle, 10)
        monkeypatch.setattr(os, "close", real)
        real(handle)

    def from_now_on() -> None:
        monkeypatch.setattr(os, "close", damage_and_close)

    with pytest.raises(SaveError, match="changed by something else"):
        saved_while(path, monkeypatch, from_now_on)
    assert path.read_bytes() == CLIP
    assert list(path.parent.iterdir()) == [path]


def test_a_saved_file_is_known_as_it_is(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    saved = saved_while(path, monkeypatch, lambda: None)
    assert isinstance(saved, Saved)
    assert saved.fingerprint == fingerprint_of(str(path))
