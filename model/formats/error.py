"""FormatError: where a file stops making sense, what was found there, and what to do about it."""

from collections.abc import Iterable
from typing import Final

MAX_FILE_BYTES: Final = 256 << 20
MAX_LINES: Final = 20_000_000
MAX_TOKEN_BYTES: Final = 64
MAX_NAME_BYTES: Final = 1024
MAX_CHANNELS: Final = 100_000
MAX_KEYS: Final = 5_000_000
_SHOWN_BYTES: Final = 32


class FormatError(ValueError):
    """A file that cannot be read, or a clip that a format cannot take; ``str()`` is one sentence for the user.

    *line* and *column* count from 1; both are 0 when the file as a whole is meant.
    """

    def __init__(self, path: str, line: int, column: int, problem: str, remedy: str = "") -> None:
        self.path = path
        self.line = line
        self.column = column
        self.problem = problem
        self.remedy = remedy
        place = f"{path}:{line}:{column}" if line else path
        super().__init__(f"{place}: {problem}; {remedy}" if remedy else f"{place}: {problem}")

    @property
    def advice(self) -> str:
        """The sentence for a dialog, in a paragraph of its own what to do where the file's fault suggests nothing."""
        if self.remedy:
            return str(self)
        here = "Mend that place in a text editor" if self.line else "Choose another file"
        return f"{self}\n\n{here}, or open an older copy."

    def __reduce__(self) -> tuple[type["FormatError"], tuple[str, int, int, str, str]]:
        return FormatError, (self.path, self.line, self.column, self.problem, self.remedy)


class TextError(Exception):
    """A problem at a byte of the text being read (-1: the text as a whole), which becomes a FormatError."""

    def __init__(self, offset: int, problem: str, remedy: str = "") -> None:
        super().__init__(problem)
        self.offset = offset
        self.problem = problem
        self.remedy = remedy

    def in_file(self, path: str, data: bytes) -> FormatError:
        """The FormatError for this fault in *data*, the bytes of *path*."""
        line, column = place_of(data, self.offset) if self.offset >= 0 else (0, 0)
        return FormatError(path, line, column, self.problem, self.remedy)


def place_of(data: bytes, offset: int) -> tuple[int, int]:
    """(line, column) of a byte, both from 1; columns count characters."""
    start = data.rfind(b"\n", 0, offset) + 1
    return data.count(b"\n", 0, offset) + 1, len(data[start:offset].decode("utf-8", "replace")) + 1


def meant(token: bytes | str, words: Iterable[bytes | str]) -> str:
    """The remedy for a word that is nearly one of *words*; empty when it is like none of them."""
    import difflib  # only when something is wrong

    texts = [_text(word) for word in words]
    close = difflib.get_close_matches(_text(token).lower(), texts, 1, 0.6)
    return f"did you mean '{close[0]}'?" if close else ""


def _text(word: bytes | str) -> str:
    return word if isinstance(word, str) else word.decode("utf-8", "replace")


def shown(token: bytes | str) -> str:
    """*token* as a message shows it: quoted, cut short, nothing unprintable."""
    if isinstance(token, str):
        token = token.encode("utf-8", "replace")
    elif not token:
        return "the end of the file"
    text = token[:_SHOWN_BYTES].decode("utf-8", "replace")
    text = "".join(c if c.isprintable() else f"\\x{ord(c):02x}" for c in text)
    return f"'{text}...'" if len(token) > _SHOWN_BYTES else f"'{text}'"
