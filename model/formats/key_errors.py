"""What is wrong with a block of keys, and where: only asked once it is known that something is."""

import re
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.formats.error import TextError, meant, place_of, shown
from model.formats.numerals import NUMBER
from model.formats.scanner import Token, check_length, number_from

_WORDS: Final = re.compile(rb"[^ \t\r\n]+")
_COLUMNS: Final = ("the key's time", "the key's value", "the tangent in", "the tangent out")


def first_error(
    data: bytes, start: int, cut: int, end: int, words_in: dict[bytes, int], words_out: dict[bytes, int], flag: bytes
) -> TextError:
    """The first wrong word in data[start:cut], where something is wrong; *flag* may stand behind a key, once.

    The keys begin at *start* and end at *end*.
    """
    column = 0
    after_key = False
    for match in _WORDS.finditer(data, start, cut):
        token = Token(match.group(), match.start())
        if flag and token.text == flag:
            if not after_key:
                return TextError(token.start, f"{shown(flag)} belongs behind a key, once")
            after_key = False
            continue
        try:
            check_length(token)
            if column < 2:
                number_from(token, _COLUMNS[column])
            else:
                _check_tangent(token, words_in if column == 2 else words_out, _COLUMNS[column])
        except TextError as error:
            return error
        column = (column + 1) % 4
        after_key = column == 0
    found = shown(data[end : end + 1])
    return TextError(end, f"expected {_COLUMNS[column]}, found {found}", "a key is time, value, two tangents")


def _check_tangent(token: Token, words: dict[bytes, int], what: str) -> None:
    if token.text in words:
        return
    if NUMBER.match(token.text):
        number_from(token, what)
        return
    known = ", ".join(word.decode() for word in words)
    remedy = meant(token.text, words)
    if token.text in (b"step", b"stepped"):
        remedy = "step is a rule for the tangent out only"
    raise TextError(token.start, f"expected {what} ({known}, or a number), found {shown(token.text)}", remedy)


def order_error(data: bytes, start: int, end: int, times: NDArray[np.float64], flag: bytes) -> TextError:
    """Where the first of *times* stands that does not come after the one before it."""
    at = int(np.flatnonzero(times[1:] <= times[:-1])[0]) + 1
    places = _starts_of_times(data, start, end, at, flag)
    line = place_of(data, places[0])[0]
    problem = f"the key's time {float(times[at])!r} does not come after {float(times[at - 1])!r} (line {line})"
    return TextError(places[1], problem, "keys are listed in strictly increasing time")


def _starts_of_times(data: bytes, start: int, end: int, at: int, flag: bytes) -> tuple[int, int]:
    """The offsets of the times of the keys number at - 1 and *at*."""
    number = 0
    before = start
    for match in _WORDS.finditer(data, start, end):
        if flag and match.group() == flag:
            continue
        if number == 4 * at:
            return before, match.start()
        if number == 4 * (at - 1):
            before = match.start()
        number += 1
    return before, end
