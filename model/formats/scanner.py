"""Scanner: walks through the words of a text file and says exactly where one is wrong."""

import json
import math
import re
from collections.abc import Iterable
from typing import Final, NamedTuple

from model.formats.error import MAX_NAME_BYTES, MAX_TOKEN_BYTES, TextError, meant, shown
from model.formats.numerals import NUMBER
from model.progress import Report, unheard

_BLANKS: Final = re.compile(rb"[ \t\r\n]*")
# A brace ends a word, so that "channel 14{" reads as three words.
_WORD: Final = re.compile(rb"[{}]|[^ \t\r\n{}]+")
_TEXT: Final = re.compile(rb'"(?:[^"\\\n]|\\[^\n])*"')
_COUNT: Final = re.compile(rb"[0-9]{1,18}\Z")


class Token(NamedTuple):
    """A word and the offset of its first byte; the text is empty at the end of the file."""

    text: bytes
    start: int


class Scanner:
    """A place in *data* that only moves forward; every refusal is a TextError at the word it is about."""

    def __init__(self, data: bytes, *, report: Report = unheard) -> None:
        self.data = data
        self.position = 0
        self._report = report

    def passed(self, position: int) -> None:
        """Report that all before *position* is read."""
        self._report(position / len(self.data))

    def peek(self) -> Token:
        """The next word, not taken."""
        start = _BLANKS.match(self.data, self.position).end()  # type: ignore[union-attr]  # always matches
        word = _WORD.match(self.data, start, start + MAX_TOKEN_BYTES + 1)
        text = word.group() if word else b""
        token = Token(text, start)
        if not text.startswith(b'"'):
            check_length(token)
        return token

    def next(self) -> Token:
        """The next word."""
        token = self.peek()
        self.position = token.start + len(token.text)
        return token

    def expect(self, word: bytes, what: str = "") -> Token:
        """Take *word*; anything else is a TextError that says what was expected."""
        token = self.next()
        if token.text != word:
            raise TextError(
                token.start, f"expected {what or shown(word)}, found {shown(token.text)}", meant(token.text, [word])
            )
        return token

    def expect_end(self) -> None:
        """Only blanks may follow."""
        token = self.peek()
        if token.text:
            raise TextError(token.start, f"found {shown(token.text)} after the end of the clip", "delete what follows")

    def number(self, what: str) -> float:
        """A finite number by the strict grammar."""
        token = self.next()
        return number_from(token, what)

    def count(self, what: str) -> int:
        """A whole number from 0."""
        token = self.next()
        if not _COUNT.match(token.text):
            raise TextError(token.start, f"expected {what} (a whole number), found {shown(token.text)}")
        return int(token.text)

    def one_of(self, words: Iterable[str], what: str) -> str:
        """One of *words*."""
        token = self.next()
        known = list(words)
        text = token.text.decode("ascii", "replace")
        if text not in known:
            problem = f"expected {what} ({', '.join(known)}), found {shown(token.text)}"
            raise TextError(token.start, problem, meant(text, known))
        return text

    def end_of_block(self) -> int:
        """The offset of the brace that closes the block of keys begun; the scanner goes on behind it."""
        end = self.data.find(b"}", self.position)
        inner = self.data.find(b"{", self.position, len(self.data) if end < 0 else end)
        if inner >= 0:
            raise TextError(inner, "found '{' among the keys", "close the block before with '}'")
        if end < 0:
            raise TextError(
                len(self.data), "expected '}' after the keys, found the end of the file", "is the file whole?"
            )
        self.position = end + 1
        self.passed(end)
        return end

    def text(self, what: str) -> str:
        """A text in double quotes, with the escapes of JSON."""
        token = self.peek()
        # Six bytes spell one at most, as in \\u0041.
        match = _TEXT.match(self.data, token.start, token.start + 6 * MAX_NAME_BYTES + 2)
        if match is None:
            found = "a quote that does not end soon" if token.text.startswith(b'"') else shown(token.text)
            raise TextError(token.start, f"expected {what} in double quotes, found {found}")
        self.position = match.end()
        try:
            text = json.loads(match.group().decode("utf-8"))
        except ValueError as error:
            raise TextError(token.start, f"{what} is not a well-formed quoted text ({error})") from None
        return checked_text(str(text), what, token.start)


def check_length(token: Token) -> None:
    """Refuse a word that is longer than any number or word of a format."""
    if len(token.text) > MAX_TOKEN_BYTES:
        raise TextError(token.start, f"found a word longer than {MAX_TOKEN_BYTES} characters", "the file is damaged")


def checked_text(text: str, what: str, start: int = 0) -> str:
    """*text* when it is short enough for a file."""
    if len(text.encode("utf-8", "surrogatepass")) > MAX_NAME_BYTES:
        raise TextError(start, f"{what} is longer than {MAX_NAME_BYTES} bytes", "shorten it")
    return text


def number_from(token: Token, what: str) -> float:
    """The finite number that *token* spells; nan, inf, 1_000 and numbers too large for a double are Faults."""
    if not NUMBER.match(token.text):
        raise TextError(token.start, f"expected {what} (a number), found {shown(token.text)}")
    value = float(token.text)
    if not math.isfinite(value):
        raise TextError(token.start, f"{what} {shown(token.text)} is too large for a number")
    return value


def quoted(text: str) -> str:
    """*text* in double quotes as the scanner reads it back; half characters are escaped, all others stay readable."""
    return re.sub("[\ud800-\udfff]", lambda half: f"\\u{ord(half.group()):04x}", json.dumps(text, ensure_ascii=False))
