"""A reader of course .anim files that shares nothing with ours: the tokenizer of the course, function by function.

It has the limits of the original: a float begins with a digit or a minus, a token ends at a blank only, and a word is
searched for as a substring of what follows.
"""

from dataclasses import dataclass, field


@dataclass
class CourseChannel:
    """What the course's programs keep of a channel."""

    extrapolation: tuple[str, str]
    keys: list[tuple[float, float, str | float, str | float]] = field(default_factory=list)


@dataclass
class CourseClip:
    """What the course's programs keep of a file."""

    span: tuple[float, float]
    channels: list[CourseChannel] = field(default_factory=list)


class Tokenizer:
    """FindToken, GetToken, GetInt and GetFloat of the course."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0

    def _peek(self) -> str:
        return self.text[self.at : self.at + 1]

    def _skip(self) -> None:
        while self._peek() and self._peek() in " \t\r\n":
            self.at += 1

    def find(self, word: str) -> None:
        """Goes behind the next place where *word* stands, whatever is around it."""
        found = self.text.find(word, self.at)
        assert found >= 0, f"FindToken({word!r}) reached the end"
        self.at = found + len(word)

    def token(self) -> str:
        """Everything up to the next blank."""
        self._skip()
        start = self.at
        while self._peek() and self._peek() not in " \t\r\n":
            self.at += 1
        return self.text[start : self.at]

    def _digits(self) -> None:
        assert self._peek() in tuple("0123456789"), f"no digit at {self.text[self.at : self.at + 10]!r}"
        while self._peek() and self._peek() in "0123456789":
            self.at += 1

    def integer(self) -> int:
        """Digits."""
        self._skip()
        start = self.at
        self._digits()
        return int(self.text[start : self.at])

    def number(self) -> float:
        """[-]I[.[I]][(e|E)[+|-]I] and then a blank."""
        self._skip()
        start = self.at
        if self._peek() == "-":
            self.at += 1
        self._digits()
        if self._peek() == ".":
            self.at += 1
            if self._peek() and self._peek() in "0123456789":
                self._digits()
        if self._peek() and self._peek() in "eE":
            self.at += 1
            if self._peek() and self._peek() in "+-":
                self.at += 1
            self._digits()
        assert self._peek() in (" ", "\t", "\r", "\n"), f"GetFloat stopped inside {self.text[start : self.at + 5]!r}"
        return float(self.text[start : self.at])


def tangent(word: str) -> str | float:
    """A rule, or the slope of a fixed tangent as atof would read it; a word nobody knows is an error here."""
    return word if word in ("flat", "linear", "smooth") else Tokenizer(word + " ").number()


def read_course(data: bytes) -> CourseClip:
    """The clip as a program of the course loads it."""
    t = Tokenizer(data.decode("ascii"))
    t.find("animation")
    t.find("{")
    t.find("range")
    clip = CourseClip((t.number(), t.number()))
    t.find("numchannels")
    for _ in range(t.integer()):
        t.find("channel")
        t.find("{")
        t.find("extrapolate")
        channel = CourseChannel((t.token(), t.token()))
        t.find("keys")
        count = t.integer()
        t.find("{")
        for _ in range(count):
            channel.keys.append((t.number(), t.number(), tangent(t.token()), tangent(t.token())))
        assert t.token() == "}", "the keys do not end where they should"
        assert t.token() == "}", "the channel does not end where it should"
        clip.channels.append(channel)
    assert t.token() == "}", "the clip does not end where it should"
    assert t.token() == ""
    return clip
