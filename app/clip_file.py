"""A clip's file as found on disk: read, recognised later, told from another version. No Qt: it may run in a worker."""

import errno
import os
import stat
from pathlib import Path
from typing import NamedTuple

from model.clip import Clip
from model.formats import read_clip, sniff
from model.formats.error import MAX_FILE_BYTES

NO_DIGEST = 0  # of a file that changed while it was read: unlike any other


class Fingerprint(NamedTuple):
    """What tells one version of a file from another; an unequal digest decides, the rest only says when to look.

    The digest is Python's own hash of the bytes: 64 bits, good within this process, and nothing to load at the start.
    """

    device: int
    inode: int
    mtime_ns: int
    size: int
    digest: int


class Opened(NamedTuple):
    """A clip, where it came from, and what the file was at that moment."""

    clip: Clip
    path: str
    format_name: str
    fingerprint: Fingerprint | None


def open_clip(path: str, skeleton: str | None = None) -> Opened:
    """Read the clip at *path*. Raises FormatError and nothing else."""
    path = os.path.abspath(path)
    before = _status(path)
    clip = read_clip(path, skeleton=skeleton)
    after = fingerprint_of(path)
    if after is not None and before != after[:4]:
        after = after._replace(size=-1, digest=NO_DIGEST)  # written while it was read: it counts as changed
    with open(path, "rb") as file:
        format_name = sniff(file.read(1 << 16))
    return Opened(clip, path, format_name, after)


def fingerprint_of(path: str) -> Fingerprint | None:
    """What the file at *path* is now; None if there is none."""
    status = _status(path)
    if status is None:
        return None
    try:
        return Fingerprint(*status, hash(read_regular(path)))
    except OSError:
        return None


def read_regular(path: str) -> bytes:
    """The bytes of the file at *path*; OSError if it is a device or a pipe, which may never end, or too large."""
    status = os.stat(path)
    if not stat.S_ISREG(status.st_mode):
        raise OSError(errno.EINVAL, "this is not a regular file")
    if status.st_size > MAX_FILE_BYTES:
        raise OSError(errno.EFBIG, f"the file is larger than {MAX_FILE_BYTES >> 20} MiB")
    with open(path, "rb") as file:
        return file.read(MAX_FILE_BYTES + 1)


def changed_since(path: str, known: Fingerprint | None) -> bool:
    """Whether the file at *path* holds something else than when *known* was taken; a touched file does not count."""
    status = _status(path)
    if known is None or status is None:
        return status is not None
    if status == known[:4]:
        return False
    now = fingerprint_of(path)
    return now is None or now.digest != known.digest


def display_name(path: str) -> str:
    """How messages and the title call the file."""
    return Path(path).name


def _status(path: str) -> tuple[int, int, int, int] | None:
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return None
    return status.st_dev, status.st_ino, status.st_mtime_ns, status.st_size
