"""The course's .skel: the joints whose rotations the channels of a course .anim are, in depth-first order."""

from pathlib import Path
from typing import Final

from model.formats.error import TextError, shown
from model.formats.scanner import Scanner

_MAX_BYTES: Final = 4 << 20
_MAX_JOINTS: Final = 10_000
_MAX_FILES: Final = 50
ANGLE: Final = "angle"


def joint_names(data: bytes) -> list[str]:
    """The joints of a .skel in the order of the file. Raises TextError."""
    scanner = Scanner(data.removeprefix(b"\xef\xbb\xbf"))
    names: list[str] = []
    depth = 0
    while (token := scanner.next()).text:
        if token.text == b"balljoint":
            name = scanner.next()
            if name.text in (b"", b"{", b"}"):
                raise TextError(name.start, f"expected the joint's name, found {shown(name.text)}")
            scanner.expect(b"{", "'{' of the joint")
            names.append(name.text.decode("utf-8", "replace"))
            depth += 1
            if len(names) > _MAX_JOINTS:
                raise TextError(token.start, f"more than {_MAX_JOINTS} joints")
        elif token.text == b"{" or (token.text == b"}" and depth == 0) or depth == 0:
            raise TextError(token.start, f"expected 'balljoint', found {shown(token.text)}", "is this a .skel file?")
        elif token.text == b"}":
            depth -= 1
    if depth or not names:
        missing = "'}'" if depth else "'balljoint'"
        raise TextError(token.start, f"expected {missing}, found the end of the file")
    return names


def channel_names(joints: list[str]) -> list[str]:
    """Three translations of the root, then three rotations a joint: 3 + 3 x joints names, each once."""
    names = [f"{joints[0]}.t{axis}" for axis in "xyz"]
    seen: dict[str, int] = {}
    for joint in joints:
        seen[joint] = seen.get(joint, 0) + 1
        unique = joint
        while seen[joint] > 1 and unique in seen:
            unique = f"{joint}_{seen[joint]}"
            seen[joint] += unique in seen
        seen.setdefault(unique, 1)
        names += [f"{unique}.r{axis}" for axis in "xyz"]
    return names


def channel_units(count: int) -> list[str]:
    """Units of *count* channels in that order: the rotations are angles."""
    return [""] * min(3, count) + [ANGLE] * max(0, count - 3)


def joints_beside(path: Path, channel_count: int) -> list[str] | None:
    """The joints of the .skel that belongs to the clip at *path*: of the same stem, else the only one that fits.

    None when there is none; a .skel that cannot be read or has another number of joints does not count.
    """
    try:
        candidates = sorted(p for p in path.parent.iterdir() if p.suffix.lower() == ".skel")
    except OSError:
        return None
    own = [p for p in candidates if p.stem == path.stem]
    for group in (own, candidates[:_MAX_FILES]):
        fitting = [joints for p in group if (joints := _joints_in(p)) and 3 + 3 * len(joints) == channel_count]
        if len(fitting) == 1:
            return fitting[0]
    return None


def _joints_in(path: Path) -> list[str] | None:
    try:
        if not path.is_file() or path.stat().st_size > _MAX_BYTES:
            return None
        return joint_names(path.read_bytes())
    except (OSError, TextError):
        return None
