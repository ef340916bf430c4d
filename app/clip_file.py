"""A clip's file as found on disk: read, recognised later, told from another version. No Qt: it may run in a worker."""

import errno
import os
import stat
from pathlib import Path
from typing import NamedTuple

from model.clip import Clip
from model.formats import FORMATS, Loss, clip_from, losses, losses_of, read_file, sniff
from model.formats.content import Content
from model.formats.error import MAX_FILE_BYTES
from model.progress import Report, part_of, unheard
from model.saving import SaveResult, save_content, sweep_temp

_PIECE = 1 << 20
NO_DIGEST = 0  # of a file that changed while it was read: unlike any other


class Fingerprint(NamedTuple):
    """What tells one version of a file from another; an unequal digest decides, the rest only says when to look.

    The digest is Python's own hash of the bytes: 64 bits, good within this process, and nothing to load at the start.
    """

    device: int
    inode: int
    mtime_ns: int
    ctime_ns: int  # no program can set it back
    size: int
    digest: int


class Opened(NamedTuple):
    """A clip, where it came from, what the file was at that moment, and what it cannot hold of the clip anyway."""

    clip: Clip
    path: str
    format_name: str
    fingerprint: Fingerprint | None
    losses: list[Loss]


class Saved(NamedTuple):
    """A clip is in its file: how surely, without what, and what the file is now."""

    result: SaveResult
    losses: list[Loss]
    fingerprint: Fingerprint | None


class Doubt(NamedTuple):
    """A clip was not written since somebody must be asked first: what would be lost of it, or of another's work."""

    losses: list[Loss]
    overwrites_another: bool


class Leave(NamedTuple):
    """What a save may do without asking: lose just this, and replace this version of the file, or whatever is there."""

    losses: list[Loss]
    version: Fingerprint | None
    whatever: bool


def open_clip(path: str, skeleton: str | None = None, report: Report = unheard) -> Opened:
    """Read the clip at *path*. Raises FormatError, what *report* raises, and nothing else."""
    path = os.path.abspath(path)
    before = _status(path)
    data = read_file(path)
    after = _status(path)
    clip = clip_from(data, path, skeleton=skeleton, report=part_of(report, 0.0, 0.85))
    fingerprint = None
    if after is not None and before == after:
        fingerprint = Fingerprint(*after, digest_of(data))
    elif after is not None:  # written while it was read: it counts as changed
        fingerprint = Fingerprint(*after[:4], -1, NO_DIGEST)
    format_name = sniff(data)
    lost = losses(clip, format_name, path)
    for number, channel in enumerate(clip.channels):
        report(0.9 + 0.1 * number / len(clip.channels))
        channel.extrema()  # kept by the channel, for the first picture
    sweep_temp(path)
    return Opened(clip, path, format_name, fingerprint, lost)


def save_clip(content: Content, path: str, format_name: str, leave: Leave, report: Report = unheard) -> Saved | Doubt:
    """Write *content* to *path*, unless that does more than *leave* allows.

    Raises SaveError, FormatError and what *report* raises; then, and in doubt, the file is as it was.
    """
    held = FORMATS[format_name].held(content)
    lost = losses_of(content, format_name, path, held)
    if lost and lost != leave.losses:
        return Doubt(lost, overwrites_another=False)
    if not leave.whatever and os.path.exists(path) and changed_since(path, leave.version):
        return Doubt(lost, overwrites_another=True)
    digests: list[int] = []
    found: list[Fingerprint] = []

    def witness(data: bytes) -> None:
        digests.append(digest_of(data))

    def last_look(data: bytes, status: os.stat_result) -> None:
        if not leave.whatever and os.path.exists(path) and changed_since(path, leave.version):
            raise _OverwritesError
        found.append(Fingerprint(*_told(status), digests[0]))

    try:
        result = save_content(held, path, format_name, part_of(report, 0.05, 1.0), last_look, witness)
    except _OverwritesError:
        return Doubt(lost, overwrites_another=True)
    return Saved(result, lost, _in_its_place(found[0], path))


def _in_its_place(new: Fingerprint, path: str) -> Fingerprint:
    """What the new file is now: to be put in its place counts as a change of it."""
    status = _status(path)
    if status is None:
        return new
    moved = new._replace(ctime_ns=status[3])
    return moved if moved[:5] == status else new


class _OverwritesError(Exception):
    """Another program has written the file while it was being saved."""


def fingerprint_of(path: str) -> Fingerprint | None:
    """What the file at *path* is now; None if there is none."""
    status = _status(path)
    if status is None:
        return None
    try:
        return Fingerprint(*status, digest_of(read_regular(path)))
    except OSError:
        return None


def digest_of(data: bytes) -> int:
    """A number that tells these bytes from others; piece by piece, so that no other thread waits for long."""
    view = memoryview(data)
    return hash(tuple([hash(view[first : first + _PIECE]) for first in range(0, len(data), _PIECE)]))


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
    return version_since(path, known)[0]


def version_since(path: str, known: Fingerprint | None) -> tuple[bool, Fingerprint | None]:
    """The same, and what the file is now if that had to be found out."""
    status = _status(path)
    if status is None or (known is not None and status == known[:5]):
        return False, known
    now = fingerprint_of(path)
    return known is None or now is None or now.digest != known.digest, now


def display_name(path: str) -> str:
    """How messages and the title call the file."""
    return Path(path).name


def _status(path: str) -> tuple[int, int, int, int, int] | None:
    try:
        return _told(os.stat(path))
    except (OSError, ValueError):
        return None


def _told(status: os.stat_result) -> tuple[int, int, int, int, int]:
    return status.st_dev, status.st_ino, status.st_mtime_ns, status.st_ctime_ns, status.st_size
