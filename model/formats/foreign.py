"""Files of other programs, told by how they begin, so that the message can name them instead of a strange word."""

import re
from typing import Final, NamedTuple

_OPEN: Final = "Hermite opens course .anim and .hermite files"


class Kind(NamedTuple):
    """A kind of file: how messages call it, how its bytes begin, and what its owner can do."""

    name: str
    begins: re.Pattern[bytes]
    remedy: str = _OPEN


def _begins(pattern: bytes) -> re.Pattern[bytes]:
    return re.compile(pattern, re.DOTALL)


# In this order: the first that matches is it. Blanks and a byte order mark are gone before.
FOREIGN_KINDS: Final = (
    Kind("a Maya .anim file", _begins(rb"(?:(?://|#)[^\n]*\n\s*)*animVersion\b")),
    Kind("a Maya ATOM file", _begins(rb"(?:(?://|#)[^\n]*\n\s*)*atomVersion\b")),
    Kind("a Unity animation (YAML)", _begins(rb"%YAML|--- !u!|%TAG")),
    Kind("a Maya ASCII scene", _begins(rb"//Maya ASCII")),
    Kind("a Maya binary scene", _begins(rb"FOR[48].{4,12}Maya")),
    Kind("a USD text file", _begins(rb"#usda|#sdf")),
    Kind("a binary USD file", _begins(rb"PXR-USDC")),
    Kind("a zip archive (Studio Library or usdz)", _begins(rb"PK\x03\x04"), "unpack it and open what is inside"),
    Kind("a BVH motion capture file", _begins(rb"(?i:HIERARCHY)\b")),
    Kind("a binary glTF file", _begins(rb"glTF")),
    Kind("a glTF file", _begins(rb'\{.{0,4096}?"(?:asset|accessors|animations|scenes|nodes)"\s*:')),
    Kind("a Nuke curve", _begins(rb"\{\s*curve\b|\{\{\s*curve\b")),
    Kind("After Effects keyframe data", _begins(rb"Adobe After Effects")),
    Kind("a Blender file", _begins(rb"BLENDER")),
    Kind("an FBX file", _begins(rb"Kaydara FBX|; FBX")),
    Kind("a skeleton (.skel)", _begins(rb"balljoint\b"), "open the .anim beside it, which takes its names from here"),
    Kind("a JSON file", _begins(rb"[\[{]\s*[\"\[{\]}]")),
    Kind("an XML or HTML file", _begins(rb"<")),
    Kind("a table of numbers (.chan or CSV)", _begins(rb"(?:#[^\n]*\n\s*)*[-+.0-9][-+.0-9eE, \t;]*(?:\r?\n|\Z)")),
    Kind("a CSV table", _begins(rb"(?:time|frame)\s*[,;\t]")),
    Kind("a UTF-16 text", _begins(rb"\xff\xfe|\xfe\xff"), "save it as UTF-8"),
)


def foreign_kind(data: bytes) -> Kind | None:
    """The kind of file that begins like *data*, None if it is none of those known."""
    head = data[: 1 << 16].removeprefix(b"\xef\xbb\xbf").lstrip(b" \t\r\n")[:8192]
    return next((kind for kind in FOREIGN_KINDS if kind.begins.match(head)), None)
