"""Files of clips: FORMATS, told apart by content; reading, writing, and what a format cannot hold."""

import os
import re
import stat
from collections.abc import Callable
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from model.clip import Clip
from model.formats import anim, native, skel
from model.formats.content import Content, Loss, differences
from model.formats.error import MAX_FILE_BYTES, MAX_LINES, MAX_TOKEN_BYTES, FormatError, TextError, shown
from model.formats.foreign import foreign_kind
from model.progress import Report, part_of, unheard

__all__ = [
    "FORMATS",
    "Format",
    "FormatError",
    "Loss",
    "clip_from",
    "format_of_path",
    "losses",
    "losses_of",
    "read_bytes",
    "read_clip",
    "read_content",
    "read_file",
    "sniff",
    "write_bytes",
    "write_content",
]

type Skeleton = str | os.PathLike[str] | None


class Format(NamedTuple):
    """One row a format: what people call it, how it is told, read and written, and what is left of a clip in it.

    Only what is left can be written.
    """

    label: str
    extension: str
    begins: re.Pattern[bytes]
    read: Callable[[bytes, Report], Content]
    write: Callable[[Content, Report], bytes]
    held: Callable[[Content], Content]


FORMATS: Final[dict[str, Format]] = {
    # The first row is what a new clip is saved in.
    "hermite": Format(
        "Hermite clip", ".hermite", re.compile(rb"hermite\b(?=[ \t]+[0-9])"), native.read, native.write, native.held
    ),
    "anim": Format("Course animation", ".anim", re.compile(rb"animation(?![^\s{])"), anim.read, anim.write, anim.held),
}
_PROBE: Final = 1 << 16
_PIECE: Final = 1 << 18  # bytes counted at once
_MARK: Final = b"\xef\xbb\xbf"
_TEXT_BYTES: Final = bytes(c for c in range(256) if c >= 32 and c != 127) + b"\t\r\n"


def sniff(data: bytes) -> str:
    """The name of the format of *data* in FORMATS, or what other kind of file it is; empty if nobody knows."""
    head = data[:_PROBE].removeprefix(_MARK).lstrip(b" \t\r\n")
    for name, row in FORMATS.items():
        if row.begins.match(head):
            return name
    kind = foreign_kind(data)
    return kind.name if kind else ""


def format_of_path(path: str | os.PathLike[str]) -> str | None:
    """The format that the extension of *path* asks for when a clip is written there."""
    extension = Path(path).suffix.lower()
    return next((name for name, row in FORMATS.items() if row.extension == extension), None)


def read_clip(path: str | os.PathLike[str], *, skeleton: Skeleton = None) -> Clip:
    """The clip in the file at *path*.

    A .skel beside it, or *skeleton*, names the channels of a course .anim. Raises FormatError and nothing else.
    """
    name = os.fspath(path)
    return clip_from(read_file(name), name, skeleton=skeleton)


def clip_from(data: bytes, name: str, *, skeleton: Skeleton = None, report: Report = unheard) -> Clip:
    """The clip in *data*, the bytes of the file at the path *name*; else as read_clip."""
    content = read_content(data, name, skeleton=skeleton, report=part_of(report, 0.0, 0.7))
    return _clip_of(content, name, part_of(report, 0.7, 1.0))


def read_bytes(data: bytes, name: str) -> Clip:
    """The clip in *data*, called *name* in messages. Raises FormatError."""
    return _clip_of(read_content(data, name, beside=False), name, unheard)


def read_content(
    data: bytes, name: str, *, skeleton: Skeleton = None, beside: bool = True, report: Report = unheard
) -> Content:
    """What *data* says, before any channel is built.

    With *beside* the folder of the path *name* is searched for a .skel. Raises FormatError.
    """
    format_name = sniff(data)
    text = data.removeprefix(_MARK)
    try:
        _check_text(text, format_name)
        content = FORMATS[format_name].read(text, report)
    except TextError as fault:
        raise fault.in_file(name, text) from None
    if format_name == "anim":
        return _named_by_skeleton(content, name, skeleton, beside=beside)
    return content


def write_bytes(clip: Clip, format_name: str) -> bytes:
    """*clip* as a file of this format; what the format cannot hold is left out. Raises FormatError."""
    return write_content(FORMATS[format_name].held(Content.of(clip)), format_name)


def write_content(held: Content, format_name: str, report: Report = unheard) -> bytes:
    """A file of this format with what is left in it of a clip, as the row of the format says. Raises FormatError."""
    try:
        return FORMATS[format_name].write(held, report)
    except TextError as fault:
        raise FormatError(held.title or "the clip", 0, 0, fault.problem, fault.remedy) from None


def losses(clip: Clip, format_name: str, path: str | os.PathLike[str] | None = None) -> list[Loss]:
    """What would be lost if *clip* were saved in this format, one a kind; empty when nothing is.

    Names that a .skel beside *path* gives back are no loss.
    """
    return losses_of(Content.of(clip), format_name, path)


def losses_of(
    content: Content, format_name: str, path: str | os.PathLike[str] | None = None, held: Content | None = None
) -> list[Loss]:
    """The same of what a clip held; *held* is what is left of it in the format, if that has been worked out."""
    held = held or FORMATS[format_name].held(content)
    if path is not None and format_name == "anim":
        held = _named_by_skeleton(held, os.fspath(path), None, beside=True)
    return differences(content, held)


def _clip_of(content: Content, name: str, report: Report) -> Clip:
    try:
        return content.clip(report)
    except ValueError as error:
        raise FormatError(name, 0, 0, str(error)) from error


def _named_by_skeleton(content: Content, name: str, skeleton: Skeleton, *, beside: bool) -> Content:
    count = len(content.channels)
    if skeleton is not None:
        skeleton_name = os.fspath(skeleton)
        data = read_file(skeleton_name)
        try:
            joints: list[str] | None = skel.joint_names(data)
        except TextError as fault:
            raise fault.in_file(skeleton_name, data) from None
        if joints is not None and 3 + 3 * len(joints) != count:
            problem = (
                f"the skeleton has {len(joints)} joints, that is {3 + 3 * len(joints)} channels; {name} has {count}"
            )
            raise FormatError(skeleton_name, 0, 0, problem, "take the .skel of this clip")
    else:
        joints = skel.joints_beside(Path(name), count) if beside and count > 3 else None
    if joints is None:
        return content
    return content.named(skel.channel_names(joints), skel.channel_units(count))


def _check_text(data: bytes, format_name: str) -> None:
    """Refuse at once what no format reads: nothing at all, other kinds of file, control characters, endless lines."""
    if not data[:_PROBE].strip(b" \t\r\n") and not data.strip(b" \t\r\n"):
        raise TextError(
            -1, "the file is empty" if not data else "the file holds nothing but blanks", "take an older copy"
        )
    if format_name not in FORMATS:
        kind = foreign_kind(data)
        if kind is not None:
            raise TextError(-1, f"this is {kind.name}, not a clip", kind.remedy)
        if data[:_PROBE].translate(None, _TEXT_BYTES):
            raise TextError(-1, "this is a binary file, not a clip", "Hermite opens course .anim and .hermite files")
        start = len(data) - len(data.lstrip(b" \t\r\n"))
        found = shown(
            re.split(rb"[\s{}]", data[start : start + MAX_TOKEN_BYTES], maxsplit=1)[0] or data[start : start + 1]
        )
        raise TextError(start, f"expected 'animation {{' or 'hermite 1', found {found}", "is this an animation clip?")
    if len(data) > MAX_LINES and _count_of_lines(data) > MAX_LINES:
        raise TextError(-1, f"the file has more than {MAX_LINES:,} lines")


def _count_of_lines(data: bytes) -> int:
    """How often a line ends; as numbers, since bytes.count stops at each of them."""
    bytes_of_it = np.frombuffer(data, np.uint8)
    pieces = range(0, len(data), _PIECE)
    return sum(int(np.count_nonzero(bytes_of_it[first : first + _PIECE] == ord("\n"))) for first in pieces)


def read_file(name: str) -> bytes:
    """The bytes of a regular file of a bearable size. Raises FormatError with one sentence for whatever is wrong."""
    try:
        status = os.stat(name)
        if stat.S_ISDIR(status.st_mode):
            library = any(os.path.exists(os.path.join(name, part)) for part in ("animation.ma", "pose.json"))
            problem = "this is a Studio Library folder" if library else "this is a folder"
            raise FormatError(name, 0, 0, problem, "choose a file")
        if not stat.S_ISREG(status.st_mode):
            raise FormatError(name, 0, 0, "this is not a regular file but a device or a pipe", "choose a file")
        if status.st_size <= MAX_FILE_BYTES:
            with open(name, "rb") as file:
                data = file.read(MAX_FILE_BYTES + 1)
            if len(data) <= MAX_FILE_BYTES:
                return data
    except FormatError:
        raise
    except OSError as error:
        raise FormatError(name, 0, 0, f"cannot be read ({error.strerror or error})") from error
    except ValueError as error:
        raise FormatError(name, 0, 0, f"this is no path ({error})") from error
    raise FormatError(name, 0, 0, f"the file is larger than {MAX_FILE_BYTES >> 20} MiB", "is this an animation clip?")
