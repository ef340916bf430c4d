"""Saving: at every instant the path holds one whole version, and what is said about it is true."""

import errno
import os
import stat
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from model import saving
from model.channel import Channel
from model.clip import Clip
from model.formats import read_clip
from model.keyframe import TangentRule, make_run
from model.saving import Durability, SaveError, save_atomic, save_clip

OLD = b"the old version\n" * 100
NEW = b"the new version, longer\n" * 100


@pytest.fixture
def target(tmp_path: Path) -> Path:
    path = tmp_path / "walk.anim"
    path.write_bytes(OLD)
    return path


def others(path: Path) -> list[str]:
    """What lies beside *path* and should not."""
    return [entry.name for entry in path.parent.iterdir() if entry.name != path.name]


def test_the_new_bytes_take_the_place_of_the_old(target: Path) -> None:
    result = save_atomic(target, NEW)
    assert target.read_bytes() == NEW
    assert result == (target, Durability.CONFIRMED, ())
    assert others(target) == []


def test_a_new_file_has_the_mode_that_the_umask_asks_for(tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        save_atomic(tmp_path / "new.anim", NEW)
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "new.anim").stat().st_mode) == 0o640


@pytest.mark.parametrize("mode", [0o600, 0o644, 0o664, 0o240])
def test_the_mode_is_kept(target: Path, mode: int) -> None:
    target.chmod(mode)
    save_atomic(target, NEW)
    assert stat.S_IMODE(target.stat().st_mode) == mode


def test_nobody_else_can_read_a_private_file_while_it_is_written(target: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target.chmod(0o600)
    modes = []
    real = os.write

    def write(handle: int, data: bytes) -> int:
        modes.append(stat.S_IMODE(os.fstat(handle).st_mode))
        return real(handle, data)

    monkeypatch.setattr(os, "write", write)
    save_atomic(target, NEW)
    assert modes == [0o600]


@pytest.mark.skipif(not hasattr(os, "setxattr"), reason="no extended attributes on this system")
def test_attributes_are_kept(target: Path) -> None:
    try:
        os.setxattr(target, "user.note", b"from Ada")
    except OSError:
        pytest.skip("no extended attributes on this file system")
    save_atomic(target, NEW)
    assert os.getxattr(target, "user.note") == b"from Ada"


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root may give files away")
def test_the_owner_is_kept(target: Path) -> None:
    os.chown(target, 12345, 12346)
    assert save_atomic(target, NEW).notes == ()
    assert (target.stat().st_uid, target.stat().st_gid) == (12345, 12346)


def test_an_owner_that_cannot_be_kept_is_told(target: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if os.geteuid() == 0:
        os.chown(target, 12345, 12346)
    else:
        pytest.skip("only root may give files away")

    def refuse(*_arguments: object) -> None:
        raise PermissionError(errno.EPERM, "Operation not permitted")

    monkeypatch.setattr(os, "fchown", refuse)
    assert save_atomic(target, NEW).notes == ("the owner or group of the file could not be kept; it is yours now",)
    assert target.read_bytes() == NEW


@pytest.mark.parametrize("link", ["absolute", "relative", "dangling", "twice"])
def test_a_link_stays_and_its_file_gets_the_new_bytes(tmp_path: Path, link: str) -> None:
    (tmp_path / "real").mkdir()
    file = tmp_path / "real" / "walk.anim"
    if link != "dangling":
        file.write_bytes(OLD)
    path = tmp_path / "link.anim"
    path.symlink_to(Path("real/walk.anim") if link == "relative" else file)
    if link == "twice":
        path = tmp_path / "second.anim"
        path.symlink_to("link.anim")
    save_atomic(path, NEW)
    assert path.is_symlink()
    assert file.read_bytes() == NEW
    assert others(file) == []


def test_other_names_of_the_file_are_told_to_hold_the_old_version(target: Path) -> None:
    os.link(target, target.with_name("other"))
    result = save_atomic(target, NEW)
    assert result.notes == ("the file had 2 names (hard links); the others still hold the old version",)
    assert target.with_name("other").read_bytes() == OLD


@pytest.mark.parametrize("plant", [Path.symlink_to, Path.hardlink_to])
def test_a_planted_temporary_name_is_never_followed(
    target: Path, monkeypatch: pytest.MonkeyPatch, plant: Callable[[Path, Path], None]
) -> None:
    victim = target.with_name("victim")
    victim.write_bytes(OLD)
    planted = target.with_name("planted")
    plant(planted, victim)
    monkeypatch.setattr(saving, "_temp_path", lambda _target: str(planted))
    with pytest.raises(SaveError):
        save_atomic(target, NEW)
    assert victim.read_bytes() == target.read_bytes() == OLD


def test_what_is_no_place_for_a_file_is_refused_in_one_sentence(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to("loop")
    cases = {
        tmp_path: "this is a folder",
        tmp_path / "pipe": "a device or a pipe",
        tmp_path / "loop": "Too many levels",
        tmp_path / "nowhere" / "a.anim": "the folder does not exist",
        tmp_path / ("n" * 300): "too long",
        Path("a\0b"): "null",
    }
    for path, part in cases.items():
        with pytest.raises(SaveError, match=part) as caught:
            save_atomic(path, NEW)
        assert "\n" not in str(caught.value)
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["loop", "pipe"]


@pytest.mark.skipif(sys.platform != "linux", reason="names are bytes on Linux only")
def test_a_name_that_is_no_text_is_saved_and_read(tmp_path: Path) -> None:
    path = tmp_path / os.fsdecode(b"w\xffalk.anim")
    save_clip(FULL, path)
    save_clip(Clip(end=3), path)
    assert read_clip(path).end == 3
    assert others(path) == []


def test_a_name_as_long_as_names_can_be_is_saved(tmp_path: Path) -> None:
    path = tmp_path / ("n" * 255)
    save_atomic(path, NEW)
    assert path.read_bytes() == NEW


# --- clips


RUN = make_run([0, 1, 2], [0.1, 0.2, -0.0], rules_in=TangentRule.SMOOTH, rules_out=TangentRule.STEP, broken=True)
FULL = Clip([Channel("root.tx", RUN, unit="m")], end=2, title="Walk")


@pytest.mark.parametrize("clip", [FULL, Clip()], ids=["full", "empty"])
def test_the_extension_tells_the_format_of_a_saved_clip(tmp_path: Path, clip: Clip) -> None:
    for extension, beginning in (
        (".hermite", b"hermite 1\n"),
        (".anim", b"animation {\n"),
        (".ANIM", b"animation {\n"),
    ):
        path = tmp_path / f"walk{extension}"
        assert save_clip(clip, path).durability is Durability.CONFIRMED
        assert path.read_bytes().startswith(beginning)
    assert read_clip(tmp_path / "walk.hermite").title == clip.title
    save_clip(clip, tmp_path / "walk.txt", "hermite")
    assert (tmp_path / "walk.txt").read_bytes() == (tmp_path / "walk.hermite").read_bytes()
    with pytest.raises(SaveError, match=r"one of \.hermite, \.anim does"):
        save_clip(clip, tmp_path / "walk.xyz")


@pytest.mark.parametrize("format_name", ["hermite", "anim"])
def test_a_writer_that_errs_never_reaches_the_file(
    target: Path, monkeypatch: pytest.MonkeyPatch, format_name: str
) -> None:
    real = saving.write_content
    monkeypatch.setattr(saving, "write_content", lambda *arguments: real(*arguments).replace(b"0.2", b"0.3"))
    with pytest.raises(SaveError, match="what was written is not the clip"):
        save_clip(FULL, target, format_name)
    assert target.read_bytes() == OLD
    assert others(target) == []


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such modes")
@pytest.mark.parametrize("through_a_link", [False, True])
def test_a_read_only_file_is_not_replaced(target: Path, through_a_link: bool) -> None:
    before = target.read_bytes()
    target.chmod(0o444)
    path = target
    if through_a_link:
        path = target.with_name("link.anim")
        path.symlink_to(target)
    with pytest.raises(SaveError, match="the file is read-only; "):
        save_atomic(path, NEW)
    assert target.read_bytes() == before
