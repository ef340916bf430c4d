"""Blocks of keys as text, both ways: one key a line, time, value, tangent in, tangent out."""

import re
from collections.abc import Sequence
from itertools import compress, pairwise, repeat
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.formats.content import joined
from model.formats.error import MAX_KEYS, MAX_TOKEN_BYTES, TextError, shown
from model.formats.key_errors import first_error, order_error
from model.formats.numerals import Columns, columns_of
from model.formats.scanner import Scanner
from model.formats.side_by_side import side_by_side
from model.formats.spelling import Octets, octet, spelled
from model.keyframe import KEY_DTYPE, Run, TangentRule
from model.progress import Report, unheard

_FIXED: Final = int(TangentRule.FIXED)
BROKEN: Final = b"broken"
_FIELDS: Final = ("time", "value", "rule_in", "slope_in", "rule_out", "slope_out", "broken")  # in the order of Columns
type Words = dict[bytes, int]

_FLAG: Final = re.compile(rb"[ \t\r\n]*(" + BROKEN + rb")(?=[ \t\r\n]|\Z)")

_PIECE: Final = 1 << 20  # bytes read at once
_SMALL: Final = 1 << 13  # bytes below which one word after the other is quicker than whole columns
_LINES: Final = 16384  # written at once


def run_from_text(scanner: Scanner, start: int, end: int, words_in: Words, words_out: Words, *, flags: bool) -> Run:
    """The keys written in the scanner's data[start:end].

    A tangent is a word of *words_in* / *words_out* or a number, the slope of a fixed tangent (value per second).
    With *flags* the word ``broken`` may follow a key. The slopes of all other rules are left 0. Raises TextError at the
    first word that is wrong; times must strictly increase.
    """
    data, flag = scanner.data, BROKEN if flags else b""
    pieces, position = _plain_pieces(scanner, start, end, words_in, words_out, flag)
    count = sum(map(len, pieces))
    while position < end:
        scanner.passed(position)
        late_flag = _FLAG.match(data, position, min(end, position + _PIECE)) if flags and pieces else None
        if late_flag is not None:  # of a key at the end of the piece before
            if pieces[-1]["broken"][-1]:
                raise TextError(late_flag.start(1), f"{shown(flag)} belongs behind a key, once")
            pieces[-1]["broken"][-1] = True
            position = late_flag.end()
        piece, position = _piece(data, position, end, words_in, words_out, flag)
        if len(piece.times):
            pieces.append(_run_of(piece))
        count += len(piece.times)
        if count > MAX_KEYS:
            raise TextError(start, f"more than {MAX_KEYS} keys in one channel")
    run = joined(pieces)
    times = run["time"]
    if count > 1 and not bool((times[1:] > times[:-1]).all()):
        raise order_error(data, start, end, times, flag)
    return run


def _plain_pieces(
    scanner: Scanner, start: int, end: int, words_in: Words, words_out: Words, flag: bytes
) -> tuple[list[Run], int]:
    """The first keys of a long block, as far as a key ends where each piece is cut; and where the next ones begin."""
    data = scanner.data
    cuts = [start]
    while (
        end - cuts[-1] > _PIECE and (cut := data.find(b"\n", cuts[-1] + _PIECE, min(end, cuts[-1] + 2 * _PIECE))) >= 0
    ):
        cuts.append(cut)
    counts: list[int] = []  # of the keys of each piece read so far; -1 where it is not plain

    def read(span: tuple[int, int]) -> Run | None:
        if -1 in counts or sum(counts) > MAX_KEYS:
            return None
        columns = columns_of(memoryview(data)[slice(*span)], words_in, words_out, _FIXED, flag)
        counts.append(-1 if columns is None else len(columns.times))
        return None if columns is None else _run_of(columns)

    def report(share: float) -> None:
        scanner.passed(start + round(share * (cuts[-1] - start)))

    pieces: list[Run] = []
    for piece in side_by_side(read, list(pairwise(cuts)), report):
        if piece is None:
            break
        pieces.append(piece)
    return pieces, cuts[len(pieces)]


def _run_of(columns: Columns) -> Run:
    run = np.zeros(len(columns.times), KEY_DTYPE)
    for field, column in zip(_FIELDS, columns, strict=True):
        run[field] = column
    return run


def _piece(data: bytes, start: int, end: int, words_in: Words, words_out: Words, flag: bytes) -> tuple[Columns, int]:
    """The first keys of data[start:end], and where the next ones begin.

    Text as editors write it, a line a key, is read as whole columns; any other one word after the other.
    """
    cut = end if end - start <= _PIECE else data.find(b"\n", start + _PIECE, end)
    cut = end if cut < 0 else cut
    if _SMALL < cut - start <= 4 * _PIECE:  # a longer line would take more memory than files may
        piece = columns_of(memoryview(data)[start:cut], words_in, words_out, _FIXED, flag)
        if piece is not None:
            return piece, cut
    if cut - start > _SMALL:
        cut = _end_of_keys(data, start, end, flag)
    piece = _columns_word_by_word(data[start:cut], words_in, words_out, flag)
    if piece is None:
        raise first_error(data, start, cut, end, words_in, words_out, flag)
    return piece, cut


def _end_of_keys(data: bytes, start: int, end: int, flag: bytes) -> int:
    """Where, not far behind *start*, a key ends, however the keys are laid out; its flag may still follow."""
    size = _PIECE
    while end - start > size:
        words = data[start : start + size].split()
        # The last word may be cut off; before it, what is begun of a key is left for later.
        left, columns = 1, len(words) - 1 - words[:-1].count(flag)
        while columns % 4 and left < len(words):
            left += 1
            columns -= words[-left] != flag
        if left < len(words):
            return start + len(data[start : start + size].rsplit(None, left)[0])
        size *= 2
    return end


def _columns_word_by_word(text: bytes, words_in: Words, words_out: Words, flag: bytes) -> Columns | None:
    """The keys in *text*, however they are laid out; None if a word is wrong."""
    words = text.split()
    broken = np.zeros(len(words) // 4, np.bool_)
    if flag and flag in words:
        is_flag = np.fromiter(map(flag.__eq__, words), np.bool_, len(words))
        before = np.flatnonzero(is_flag) - np.arange(np.count_nonzero(is_flag))
        if (before % 4).any() or (before == 0).any() or (np.diff(before) == 0).any():
            return None
        words = list(compress(words, ~is_flag))
        broken = np.zeros(len(words) // 4, np.bool_)
        broken[before // 4 - 1] = True
    # float() takes 1_000 as well, and split() cuts at two characters that are no blanks here.
    odd = b"_" in text or b"\x0b" in text or b"\x0c" in text or max(map(len, words), default=0) > MAX_TOKEN_BYTES
    if len(words) % 4 or odd:
        return None
    try:
        times = np.array(list(map(float, words[0::4])), np.float64)
        values = np.array(list(map(float, words[1::4])), np.float64)
        rules_in, slopes_in = _tangents(words[2::4], words_in)
        rules_out, slopes_out = _tangents(words[3::4], words_out)
    except ValueError:
        return None
    # A text may spell a number that is too large for a double.
    finite = all(bool(np.isfinite(column).all()) for column in (times, values, slopes_in, slopes_out))
    return Columns(times, values, rules_in, slopes_in, rules_out, slopes_out, broken) if finite else None


def _tangents(tokens: list[bytes], words: Words) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    rules = np.frombuffer(bytes(map(words.get, tokens, repeat(_FIXED))), np.uint8)
    slopes = np.zeros(len(tokens))
    fixed = np.flatnonzero(rules == _FIXED)
    slopes[fixed] = [float(tokens[i]) for i in fixed.tolist()]
    return rules, slopes


class KeyWriter:
    """Writes keys one a line, each line ended; a fixed tangent is its slope, the other rules are their words.

    With *flags* a broken key has the word ``broken`` behind it.
    """

    def __init__(self, words: dict[int, str], indent: str, separator: str, *, flags: bool) -> None:
        self.flags = flags
        self._indent, self._separator = indent.encode(), separator.encode()
        texts = [f"{separator}{words[rule]}" if rule in words else "" for rule in range(max(TangentRule) + 1)]
        self._words = np.array([octet(text.encode()) for text in texts])
        self._last_words = np.array([octet(f"{text}\n".encode()) for text in texts])
        self._ends = np.array([octet(b"\n"), octet(f"{separator}{BROKEN.decode()}\n".encode())])

    def texts(self, runs: Sequence[Run], report: Report = unheard) -> list[list[bytes]]:
        """The lines of each run, in pieces; all runs are worked on together, since there may be many short ones."""
        keys = joined(runs)
        firsts = range(0, len(keys), _LINES)
        pieces = side_by_side(lambda first: self._lines(keys[first : first + _LINES]), firsts, report)
        if len(runs) == 1:
            return [pieces]
        text = b"".join(pieces)
        ends = np.flatnonzero(np.frombuffer(text, np.uint8) == ord("\n")) + 1
        cuts = np.concatenate([[0], ends])[np.cumsum([0, *map(len, runs)])].tolist()
        return [[text[first:last]] for first, last in pairwise(cuts)]

    def _lines(self, run: Run) -> bytes:
        """Octets side by side; where one is not full there are NULs, which are taken out."""
        broken = run["broken"] if self.flags else np.zeros(len(run), np.bool_)
        # The end of the line has room in the octet of a word, but not in that of a number or behind a flag.
        apart = bool(broken.any() or (run["rule_out"] == _FIXED).any())
        columns = [
            *spelled(np.ascontiguousarray(run["time"]), self._indent),
            *spelled(np.ascontiguousarray(run["value"]), self._separator),
            *self._tangents(self._words, run["rule_in"], run["slope_in"]),
            *self._tangents(self._words if apart else self._last_words, run["rule_out"], run["slope_out"]),
            *([self._ends[broken.view(np.uint8)]] if apart else []),
        ]
        return np.array(columns, np.dtype("<u8")).T.tobytes().translate(None, b"\0")

    def _tangents(self, words: Octets, rules: NDArray[np.uint8], slopes: NDArray[np.float64]) -> list[Octets]:
        columns = [words.take(rules, mode="clip")]
        fixed = np.flatnonzero(rules == _FIXED)
        if len(fixed):
            numbers = spelled(slopes[fixed], self._separator)
            columns += [np.zeros(len(rules), np.uint64) for _ in numbers[1:]]
            for column, number in zip(columns, numbers, strict=True):
                column[fixed] = number
        return columns
