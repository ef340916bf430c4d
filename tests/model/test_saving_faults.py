"""Saving while the system fails or the process dies: the old version or the new one, whole, and no litter."""

import errno
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from model import saving
from model.saving import Durability, SaveError, save_atomic, sweep_temp

OLD = b"the old version\n" * 100
NEW = b"the new version, longer\n" * 100
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def target(tmp_path: Path) -> Path:
    path = tmp_path / "walk.anim"
    path.write_bytes(OLD)
    return path


def others(path: Path) -> list[str]:
    """What lies beside *path* and should not."""
    return [entry.name for entry in path.parent.iterdir() if entry.name != path.name]


CALLS = ["stat", "open", "write", "fchmod", "fchown", "setxattr", "listxattr", "fsync", "lseek", "read", "close"]
CALLS += ["fstat", "replace"]


class Faults:
    """Lets the call number *at* of the module os fail with an error number; 0 lets none fail and counts."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, at: int, number: int) -> None:
        self.at, self.number, self.count = at, number, 0
        self.failed = ""
        for name in CALLS:
            if hasattr(os, name):
                monkeypatch.setattr(os, name, self.wrapped(name, getattr(os, name)))

    def wrapped(self, name: str, real: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **options: Any) -> Any:
            self.count += 1
            if self.count == self.at:
                self.failed = name
                if name == "close":
                    real(*arguments, **options)
                raise OSError(self.number, os.strerror(self.number))
            return real(*arguments, **options)

        return call


def count_calls(target: Path) -> int:
    with pytest.MonkeyPatch.context() as monkeypatch:
        counter = Faults(monkeypatch, 0, 0)
        save_atomic(target, NEW)
    target.write_bytes(OLD)
    return counter.count


def outcome_of_save(target: Path) -> tuple[str, str]:
    try:
        return save_atomic(target, NEW).durability.name, ""
    except SaveError as error:
        return "FAILED", str(error)


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EIO, errno.EACCES, errno.EDQUOT, errno.EROFS])
def test_whatever_fails_the_file_is_whole_and_nothing_is_left_behind(target: Path, number: int) -> None:
    target.chmod(0o640)
    calls = count_calls(target)
    assert calls >= 12
    outcomes = set()
    for at in range(1, calls + 1):
        with pytest.MonkeyPatch.context() as monkeypatch:
            faults = Faults(monkeypatch, at, number)
            outcome, sentence = outcome_of_save(target)
        assert outcome != "FAILED" or os.strerror(number) in sentence
        assert faults.failed
        assert target.read_bytes() == (OLD if outcome == "FAILED" else NEW), faults.failed
        assert others(target) == [], faults.failed
        outcomes.add(outcome)
        target.write_bytes(OLD)
    assert outcomes == {"FAILED", "UNCONFIRMED", "CONFIRMED"}  # the last where only an attribute was lost


def test_a_folder_that_cannot_be_synced_is_a_third_outcome(target: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_folder: str) -> None:
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(saving, "_sync_folder", refuse)
    result = save_atomic(target, NEW)
    assert result.durability is Durability.UNCONFIRMED
    assert result.notes == ("the disk did not confirm the save (Input/output error); a power cut now may undo it",)
    assert target.read_bytes() == NEW


def test_a_disk_that_takes_a_few_bytes_at_once_gets_them_all(target: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real = os.write
    monkeypatch.setattr(os, "write", lambda handle, data: real(handle, data[:7]))
    save_atomic(target, NEW)
    assert target.read_bytes() == NEW


@pytest.mark.parametrize("room", range(0, len(NEW), 240))
def test_a_disk_that_is_full_keeps_the_old_version(target: Path, monkeypatch: pytest.MonkeyPatch, room: int) -> None:
    real = os.write
    left = [room]

    def write(handle: int, data: memoryview) -> int:
        if not left[0]:
            raise OSError(errno.ENOSPC, "No space left on device")
        count = real(handle, data[: left[0]])
        left[0] -= count
        return count

    monkeypatch.setattr(os, "write", write)
    with pytest.raises(SaveError, match="No space left"):
        save_atomic(target, NEW)
    assert target.read_bytes() == OLD
    assert others(target) == []


def test_a_file_changed_after_it_was_read_back_never_takes_the_place_of_the_old(
    target: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real, read_back = saving._taken, threading.Event()

    def taken(handle: int, data: bytes) -> os.stat_result:
        status = real(handle, data)
        read_back.set()
        return status

    def verify(data: bytes) -> None:
        assert read_back.wait(10)
        (name,) = others(target)
        temp = target.with_name(name)
        temp.write_bytes(data.swapcase())
        os.utime(temp, ns=(1, 1))  # another time than before, however coarse the system's clock is

    monkeypatch.setattr(saving, "_taken", taken)
    with pytest.raises(SaveError, match="changed by something else"):
        save_atomic(target, NEW, verify=verify)
    assert target.read_bytes() == OLD
    assert others(target) == []


@pytest.mark.parametrize("verify", [None, lambda _data: None])
def test_bytes_that_the_disk_changed_never_take_the_place_of_the_old(
    target: Path, monkeypatch: pytest.MonkeyPatch, verify: saving.Verify | None
) -> None:
    real = os.read
    monkeypatch.setattr(os, "read", lambda handle, size: real(handle, size).replace(b"new", b"nEw"))
    with pytest.raises(SaveError, match="other bytes than were written"):
        save_atomic(target, NEW, verify=verify)
    assert target.read_bytes() == OLD
    assert others(target) == []


@pytest.mark.parametrize("error", [SaveError("x", "not the clip"), KeyboardInterrupt(), MemoryError()])
def test_a_check_that_fails_keeps_the_old_version(target: Path, error: BaseException) -> None:
    def verify(data: bytes) -> None:
        assert data == NEW
        raise error

    with pytest.raises(type(error)):
        save_atomic(target, NEW, verify=verify)
    assert target.read_bytes() == OLD
    assert others(target) == []


@pytest.mark.parametrize("check", ["quick", "slow", "failing"])
def test_a_disk_that_fails_while_the_bytes_are_checked_keeps_the_old_version(
    target: Path, monkeypatch: pytest.MonkeyPatch, check: str
) -> None:
    checked = threading.Event()

    def fail(_handle: int) -> None:
        assert check == "slow" or checked.wait(10)
        raise OSError(errno.EIO, "Input/output error")

    def verify(_data: bytes) -> None:
        if check == "slow":
            time.sleep(0.05)
        checked.set()
        if check == "failing":
            raise SaveError("x", "not the clip")

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(SaveError, match="not the clip" if check == "failing" else "Input/output error"):
        save_atomic(target, NEW, verify=verify)
    assert target.read_bytes() == OLD
    assert others(target) == []
    assert not [thread for thread in threading.enumerate() if thread.name == "side by side"]


def test_the_new_file_is_read_back_when_the_disk_has_it_and_it_has_been_checked(
    target: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    events = []

    def noted(name: str) -> Callable[..., Any]:
        real = getattr(os, name)

        def call(*arguments: Any) -> Any:
            result = real(*arguments)
            events.append(name)
            return result

        return call

    for name in ("fsync", "read", "replace"):
        monkeypatch.setattr(os, name, noted(name))
    steps = (lambda data: events.append("checked")), (lambda data: events.append("witnessed"))
    save_atomic(target, NEW, verify=steps[0], witness=steps[1])
    assert "checked" in events[:5]  # on its own thread, sooner or later
    events.remove("checked")
    assert events == ["fsync", "read", "read", "witnessed", "replace", "fsync"]


def test_a_killed_save_leaves_a_whole_version_no_older_than_what_was_confirmed(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "tests.model.kill_saves", str(tmp_path / "walk.anim"), "100", "1"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def kill_in_the_middle(path: Path, at: str) -> None:
    """A child that kills itself just before the call *at* of a save."""
    pid = os.fork()
    if pid == 0:
        setattr(os, at, lambda *_arguments: os.kill(os.getpid(), signal.SIGKILL))
        save_atomic(path, NEW)
        os._exit(1)
    assert os.waitpid(pid, 0)[1] == signal.SIGKILL


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize("at", ["write", "fsync", "read", "replace"])
def test_what_a_dead_process_left_is_swept_and_nothing_else(target: Path, at: str) -> None:
    for name in (".hidden", "walk.anim~", ".12345678-1-00.hermite-tmp", "x.hermite-tmp"):
        target.with_name(name).write_bytes(b"of somebody else")
    kept = sorted(others(target))
    own = Path(saving._temp_path(str(target)))
    own.write_bytes(b"of a process that lives")
    kill_in_the_middle(target, at)
    assert target.read_bytes() == OLD
    assert len(others(target)) == len(kept) + 2
    assert sweep_temp(target) == 1
    assert sorted(others(target)) == sorted([*kept, own.name])
