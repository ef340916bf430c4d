"""Saving a file so that its path holds one whole version at every instant, the old one or the new one."""

import errno
import os
import socket
import stat
import sys
import zlib
from collections.abc import Callable
from enum import Enum
from pathlib import Path
from typing import Final, NamedTuple

from model.clip import Clip
from model.formats import FORMATS, FormatError, format_of_path, read_content, write_content
from model.formats.content import Content, differences
from model.formats.side_by_side import meanwhile
from model.progress import Report, part_of, unheard

type Verify = Callable[[bytes], None]
type Witness = Callable[[bytes], None]
type LastLook = Callable[[bytes, os.stat_result], None]

_SUFFIX: Final = ".hermite-tmp"
# Absent on some systems, where files behave so anyway (no inheritance, binary mode) or the protection does not exist.
_FLAGS: Final = sum(getattr(os, name, 0) for name in ("O_CLOEXEC", "O_NOFOLLOW", "O_BINARY", "O_NOINHERIT"))
_PIECE: Final = 1 << 20
_WRITABLE: Final = stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH


class Durability(Enum):
    """How sure it is that the new version survives a power cut."""

    CONFIRMED = "saved"
    UNCONFIRMED = "saved, but the disk did not confirm it"


class SaveResult(NamedTuple):
    """What became of a save that put the new version in place; notes are sentences that the user should see."""

    path: Path
    durability: Durability
    notes: tuple[str, ...] = ()


class SaveError(OSError):
    """The save failed: the file is as it was, no temporary file is left, and ``str()`` is one sentence."""

    def __init__(self, path: str, problem: str) -> None:
        super().__init__(problem)
        self.path = path
        self.problem = problem

    def __str__(self) -> str:
        return f"{self.path}: {self.problem}"


def save_clip(clip: Clip, path: str | os.PathLike[str], format_name: str | None = None) -> SaveResult:
    """Save *clip*; the format is that of the extension unless named.

    What the format cannot hold is left out (ask ``losses`` before). The file is read back and compared with the clip
    before it takes the place of the old one. Raises SaveError and FormatError, then the old file is untouched.
    """
    format_name = format_name or format_of_path(path)
    if format_name is None:
        known = ", ".join(row.extension for row in FORMATS.values())
        raise SaveError(os.fspath(path), f"the extension tells no format; one of {known} does")
    return save_content(FORMATS[format_name].held(Content.of(clip)), path, format_name)


def save_content(
    wanted: Content,
    path: str | os.PathLike[str],
    format_name: str,
    report: Report = unheard,
    last_look: LastLook | None = None,
    witness: Witness | None = None,
) -> SaveResult:
    """The same of what is left of a clip in the format, as its row says.

    A CancelledError from *report* leaves the old file untouched too.
    """
    name = os.fspath(path)
    data = write_content(wanted, format_name, part_of(report, 0.0, 0.4))

    def verify(written: bytes) -> None:
        lost = differences(wanted, read_content(written, name, beside=False, report=part_of(report, 0.5, 1.0)))
        if lost:
            raise SaveError(name, f"what was written is not the clip ({lost[0]})")

    return save_atomic(name, data, verify=verify, last_look=last_look, witness=witness)


def save_atomic(
    path: str | os.PathLike[str],
    data: bytes,
    *,
    verify: Verify | None = None,
    last_look: LastLook | None = None,
    witness: Witness | None = None,
) -> SaveResult:
    """Put *data* in the place of the file at *path*, or of the file that a link there leads to.

    *verify* gets *data* while the disk takes it, and raises if it is not right; what the disk gives back then must be
    the same bytes. *witness* gets them too, on the thread that brings them to the disk. *last_look* gets them and what
    the new file is, at the last moment at which the old one is still in its place. Raises SaveError (and whatever these
    three raise): then the old file is untouched. Mode, owner and attributes are kept as far as the system allows.
    """
    name = os.fspath(path)
    try:
        target = os.path.realpath(name)
        status = _status_of(name, target)
        notes = _replace(target, status, data, verify, last_look, witness)
    except (SaveError, FormatError):
        raise
    except (OSError, ValueError) as error:
        raise SaveError(name, _sentence(error)) from error
    durability = Durability.CONFIRMED
    try:
        _sync_folder(os.path.dirname(target))
    except OSError as error:
        durability = Durability.UNCONFIRMED
        notes.append(f"the disk did not confirm the save ({_sentence(error)}); a power cut now may undo it")
    return SaveResult(Path(name), durability, tuple(notes))


def _status_of(name: str, target: str) -> os.stat_result | None:
    try:
        status = os.stat(target)
    except FileNotFoundError:
        return None
    if stat.S_ISDIR(status.st_mode):
        raise SaveError(name, "this is a folder; give a file name")
    if not stat.S_ISREG(status.st_mode):
        raise SaveError(name, "this is not a regular file but a device or a pipe; give another name")
    # The folder's mode would let it be replaced all the same, and an administrator may write anything.
    if not status.st_mode & _WRITABLE or not os.access(target, os.W_OK):
        raise SaveError(name, "the file is read-only; make it writable, or save under another name")
    return status


def _replace(
    target: str,
    status: os.stat_result | None,
    data: bytes,
    verify: Verify | None,
    last_look: LastLook | None,
    witness: Witness | None,
) -> list[str]:
    """Write *data* beside *target*, check it and rename it; returns notes for the user."""
    notes: list[str] = []
    found: list[os.stat_result] = []

    def bring() -> None:
        _write_all(handle, data)
        notes.extend(_keep_attributes(handle, target, status))
        found.append(_taken(handle, data))
        if witness is not None:
            witness(data)

    temp = _temp_path(target)
    # A new file gets the mode that the user's umask asks for, from the system itself.
    handle = os.open(temp, os.O_RDWR | os.O_CREAT | os.O_EXCL | _FLAGS, 0o666 if status is None else 0o600)
    try:
        try:
            if verify is None:
                bring()
            else:
                with meanwhile(bring):
                    verify(data)
        finally:
            os.close(handle)
        (written,) = found
        if _version(os.stat(temp)) != _version(written) and not _still_holds(temp, data):
            raise OSError(errno.EIO, "the new file was changed by something else before it was in its place")
        if last_look is not None:
            last_look(data, written)
        os.replace(temp, target)
    except BaseException:
        _remove(temp)
        raise
    return notes


def _taken(handle: int, data: bytes) -> os.stat_result:
    """What the file is once the disk has taken it and has given back *data* byte for byte."""
    _sync(handle)  # a failed one is final: a second one may report success for pages that are lost
    if not _holds(handle, data):
        raise OSError(errno.EIO, "the disk gave back other bytes than were written")
    return os.fstat(handle)


def _still_holds(temp: str, data: bytes) -> bool:
    handle = os.open(temp, os.O_RDONLY | _FLAGS)
    try:
        return _holds(handle, data)
    finally:
        os.close(handle)


def _version(status: os.stat_result) -> tuple[int, int, int]:
    return status.st_ino, status.st_size, status.st_mtime_ns


def _write_all(handle: int, data: bytes) -> None:
    rest = memoryview(data)
    while rest:
        count = os.write(handle, rest)
        if count <= 0:
            raise OSError(errno.EIO, "the disk took nothing")
        rest = rest[count:]


def _holds(handle: int, data: bytes) -> bool:
    """Whether the file, read back from its start, is *data* byte for byte."""
    os.lseek(handle, 0, os.SEEK_SET)
    position = 0
    while piece := os.read(handle, _PIECE):
        if not data.startswith(piece, position):
            return False
        position += len(piece)
    return position == len(data)


def _sync(handle: int) -> None:
    if sys.platform == "darwin":
        import fcntl

        fcntl.fcntl(handle, fcntl.F_FULLFSYNC)  # fsync alone leaves the data in the drive's cache there
    else:
        os.fsync(handle)


def _sync_folder(folder: str) -> None:
    if sys.platform == "win32":
        return  # folders cannot be opened there; the rename itself is journalled
    handle = os.open(folder or ".", os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _keep_attributes(handle: int, target: str, status: os.stat_result | None) -> list[str]:
    """Give the new file what the old one had. Its mode must be kept, or the save fails; the rest is told if lost."""
    if status is None or sys.platform == "win32":
        return []
    notes = []
    if status.st_nlink > 1:
        notes.append(f"the file had {status.st_nlink} names (hard links); the others still hold the old version")
    own = os.fstat(handle)
    if (own.st_uid, own.st_gid) != (status.st_uid, status.st_gid):
        try:
            os.fchown(handle, status.st_uid, status.st_gid)
        except OSError:
            notes.append("the owner or group of the file could not be kept; it is yours now")
    notes += _keep_extended_attributes(handle, target)
    mode = stat.S_IMODE(status.st_mode)
    if stat.S_IMODE(os.fstat(handle).st_mode) != mode:
        os.fchmod(handle, mode)  # last: a change of owner clears bits of the mode
    return notes


def _keep_extended_attributes(handle: int, target: str) -> list[str]:
    if sys.platform != "linux":
        return []
    try:
        for attribute in os.listxattr(target):
            # The others (security.*, trusted.*) are the system's own: it gives them to new files by its own rules.
            if attribute.startswith(("user.", "system.posix_acl_")):
                os.setxattr(handle, attribute, os.getxattr(target, attribute))
    except OSError as error:
        if error.errno not in (errno.ENOTSUP, errno.ENOSYS):
            return ["extended attributes or access lists of the file could not be kept"]
    return []


def _temp_path(target: str) -> str:
    """A name nobody can foresee in the folder of *target*; short, since the target's may be as long as names can be."""
    return f"{_temp_prefix(target)}{os.getpid()}-{os.urandom(8).hex()}{_SUFFIX}"


def _temp_prefix(target: str) -> str:
    folder, base = os.path.split(target)
    # The host is in it since on a shared folder the process of a number may live on another machine.
    mark = zlib.crc32(os.fsencode(f"{socket.gethostname()}/{base}"))
    return os.path.join(folder, f".{mark:08x}-")


def sweep_temp(path: str | os.PathLike[str]) -> int:
    """Remove temporary files that dead processes left when they saved to *path*; returns how many."""
    target = os.path.realpath(os.fspath(path))
    prefix = os.path.basename(_temp_prefix(target))
    removed = 0
    try:
        names = os.listdir(os.path.dirname(target) or ".")
    except OSError:
        return 0
    for name in names:
        if name.startswith(prefix) and name.endswith(_SUFFIX):
            process = name.removeprefix(prefix).partition("-")[0]
            if process.isascii() and process.isdigit() and not _alive(int(process)):
                removed += _remove(os.path.join(os.path.dirname(target), name))
    return removed


def _alive(process: int) -> bool:
    if process == os.getpid() or sys.platform == "win32":
        return True  # a signal of 0 is no question there but ends the process
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        return True
    return True


def _remove(path: str) -> bool:
    try:
        os.unlink(path)
    except OSError:
        return False
    return True


def _sentence(error: OSError | ValueError) -> str:
    if isinstance(error, FileNotFoundError):
        return "the folder does not exist"
    return (isinstance(error, OSError) and error.strerror) or str(error)
