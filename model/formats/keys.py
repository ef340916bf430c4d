"""Blocks of keys as text, both ways: one key a line, time, value, tangent in, tangent out."""

import re
from itertools import compress, repeat
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.formats.error import TextError, place_of, shown
from model.formats.scanner import NUMBER, Token, number_from
from model.keyframe import Run, TangentRule, make_run

_FIXED: Final = int(TangentRule.FIXED)
BROKEN: Final = b"broken"
type Words = dict[bytes, int]

_WORDS: Final = re.compile(rb"[^ \t\r\n]+")
_COLUMNS: Final = ("the key's time", "the key's value", "the tangent in", "the tangent out")


def run_from_text(data: bytes, start: int, end: int, words_in: Words, words_out: Words, *, flags: bool) -> Run:
    """The keys written in data[start:end].

    A tangent is a word of *words_in* / *words_out* or a number, the slope of a fixed tangent (value per second).
    With *flags* the word ``broken`` may follow a key. The slopes of all other rules are left 0. Raises TextError at the
    first word that is wrong; times must strictly increase.
    """
    tokens = data[start:end].split()
    broken: NDArray[np.bool_] | bool = False
    if flags and BROKEN in tokens:
        tokens, broken = _without_flags(data, start, end, tokens)
    if len(tokens) % 4:
        raise _first_fault(data, start, end, words_in, words_out, flags=flags)
    n = len(tokens) // 4
    try:
        times = np.fromiter(map(float, tokens[0::4]), np.float64, n)
        values = np.fromiter(map(float, tokens[1::4]), np.float64, n)
        rules_in, slopes_in = _tangents(tokens[2::4], words_in)
        rules_out, slopes_out = _tangents(tokens[3::4], words_out)
    except ValueError:
        raise _first_fault(data, start, end, words_in, words_out, flags=flags) from None
    finite = all(bool(np.isfinite(column).all()) for column in (times, values, slopes_in, slopes_out))
    # float() takes 1_000, nan and inf as well; the first is caught by its underscore, which no word here has.
    if not finite or data.find(b"_", start, end) >= 0:
        raise _first_fault(data, start, end, words_in, words_out, flags=flags)
    if n > 1 and not bool((times[1:] > times[:-1]).all()):
        raise _order_fault(data, start, end, times, flags=flags)
    return make_run(times, values, slopes_in, slopes_out, rules_in, rules_out, broken)


def _tangents(tokens: list[bytes], words: Words) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    rules = np.frombuffer(bytes(map(words.get, tokens, repeat(_FIXED))), np.uint8)
    slopes = np.zeros(len(tokens))
    fixed = np.flatnonzero(rules == _FIXED)
    slopes[fixed] = [float(tokens[i]) for i in fixed.tolist()]
    return rules, slopes


def _without_flags(data: bytes, start: int, end: int, tokens: list[bytes]) -> tuple[list[bytes], NDArray[np.bool_]]:
    """The tokens of the keys alone, and which keys had the flag after them."""
    is_flag = np.fromiter(map(BROKEN.__eq__, tokens), np.bool_, len(tokens))
    before = np.flatnonzero(is_flag) - np.arange(np.count_nonzero(is_flag))
    rest = list(compress(tokens, ~is_flag))
    flagged = np.zeros(len(rest) // 4, np.bool_)
    misplaced = (before % 4 != 0) | (before == 0) | (before > 4 * len(flagged))
    misplaced[1:] |= before[1:] == before[:-1]
    if misplaced.any():
        index = int(np.flatnonzero(is_flag)[misplaced][0])
        raise TextError(_offset_of_word(data, start, end, index), "'broken' belongs at the end of a key's line, once")
    flagged[before // 4 - 1] = True
    return rest, flagged


def _offset_of_word(data: bytes, start: int, end: int, index: int) -> int:
    """The offset of the word number *index* of data[start:end]; counts piece by piece, there may be millions."""
    position = start
    while end - position > 1 << 17:
        cut = max(data.rfind(mark, position, position + (1 << 16)) for mark in (b" ", b"\t", b"\n"))
        if cut <= position:
            break
        words = len(data[position:cut].split())
        if words > index:
            break
        index -= words
        position = cut
    for number, match in enumerate(_WORDS.finditer(data, position, end)):
        if number == index:
            return match.start()
    return end


def _first_fault(data: bytes, start: int, end: int, words_in: Words, words_out: Words, *, flags: bool) -> TextError:
    """The first thing wrong with the words of a block that the quick way has refused."""
    column = 4
    for match in _WORDS.finditer(data, start, end):
        token = Token(match.group(), match.start())
        if flags and token.text == BROKEN and column == 4:
            continue
        column %= 4
        try:
            if column < 2:
                number_from(token, _COLUMNS[column])
            else:
                _check_tangent(token, words_in if column == 2 else words_out, _COLUMNS[column])
        except TextError as fault:
            return fault
        column += 1
    found = shown(data[end : end + 1])
    return TextError(
        end, f"expected {_COLUMNS[column % 4]}, found {found}", "a key is time, value, tangent in, tangent out"
    )


def _check_tangent(token: Token, words: Words, what: str) -> None:
    if token.text in words:
        return
    if NUMBER.match(token.text):
        number_from(token, what)
        return
    known = ", ".join(word.decode() for word in words)
    remedy = "step is a rule for the tangent out only" if token.text in (b"step", b"stepped") else ""
    raise TextError(token.start, f"expected {what} ({known}, or a number), found {shown(token.text)}", remedy)


def _order_fault(data: bytes, start: int, end: int, times: NDArray[np.float64], *, flags: bool) -> TextError:
    at = int(np.flatnonzero(times[1:] <= times[:-1])[0]) + 1
    words = _WORDS.finditer(data, start, end)
    starts = [match.start() for match in words if not (flags and match.group() == BROKEN)][: 4 * at + 1 : 4]
    line = place_of(data, starts[at - 1])[0]
    first, second = float(times[at - 1]), float(times[at])
    problem = f"the key's time {second!r} does not come after {first!r} (line {line})"
    return TextError(starts[at], problem, "keys are listed in strictly increasing time")


def text_from_run(run: Run, words: dict[int, str], indent: str, separator: str, *, flags: bool) -> str:
    """One line a key, each ending with a line break; a fixed tangent is its slope, other rules are their word.

    With *flags* a broken key has the word ``broken`` after it.
    """
    columns = [
        list(map(repr, run["time"].tolist())),
        list(map(repr, run["value"].tolist())),
        _tangent_texts(run["rule_in"], run["slope_in"], words),
        _tangent_texts(run["rule_out"], run["slope_out"], words),
    ]
    lines = list(map(separator.join, zip(*columns, strict=True)))
    for i in np.flatnonzero(run["broken"] & flags).tolist():
        lines[i] += separator + BROKEN.decode()
    return "".join(f"{indent}{line}\n" for line in lines)


def _tangent_texts(rules: NDArray[np.uint8], slopes: NDArray[np.float64], words: dict[int, str]) -> list[str]:
    texts = list(map(words.get, rules.tolist(), repeat("")))
    for i in np.flatnonzero(rules == _FIXED).tolist():
        texts[i] = repr(float(slopes[i]))
    return texts
