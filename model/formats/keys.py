"""Blocks of keys as text, both ways: one key a line, time, value, tangent in, tangent out."""

from itertools import compress, repeat
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.formats.decimals import CELL, Cells, fill_cells
from model.formats.error import MAX_KEYS, TextError
from model.formats.key_errors import first_error, order_error
from model.formats.numerals import Columns, columns_of
from model.keyframe import KEY_DTYPE, Run, TangentRule

_FIXED: Final = int(TangentRule.FIXED)
BROKEN: Final = b"broken"
_FIELDS: Final = ("time", "value", "rule_in", "slope_in", "rule_out", "slope_out", "broken")  # in the order of Columns
type Words = dict[bytes, int]

_PIECE: Final = 1 << 18  # bytes read at once
_LINES: Final = 4096  # written at once


def run_from_text(data: bytes, start: int, end: int, words_in: Words, words_out: Words, *, flags: bool) -> Run:
    """The keys written in data[start:end].

    A tangent is a word of *words_in* / *words_out* or a number, the slope of a fixed tangent (value per second).
    With *flags* the word ``broken`` may follow a key. The slopes of all other rules are left 0. Raises TextError at the
    first word that is wrong; times must strictly increase.
    """
    pieces = _quick_pieces(data, start, end, words_in, words_out, flags=flags)
    if pieces is None:
        pieces = [_slow_piece(data, start, end, words_in, words_out, flags=flags)]
    run = _joined(pieces)
    if len(run) > MAX_KEYS:
        raise TextError(start, f"{len(run)} keys in one channel; at most {MAX_KEYS} are read")
    times = run["time"]
    if len(times) > 1 and not bool((times[1:] > times[:-1]).all()):
        raise order_error(data, start, end, times, BROKEN if flags else b"")
    return run


def _joined(pieces: list[Columns]) -> Run:
    run = np.zeros(sum(len(piece.times) for piece in pieces), KEY_DTYPE)
    first = 0
    for piece in pieces:
        part = run[first : first + len(piece.times)]
        for field, column in zip(_FIELDS, piece, strict=True):
            part[field] = column
        first += len(part)
    return run


def _quick_pieces(
    data: bytes, start: int, end: int, words_in: Words, words_out: Words, *, flags: bool
) -> list[Columns] | None:
    """The keys, piece by piece, each cut at the end of a line; None if they are not written one a line, plainly."""
    pieces: list[Columns] = []
    position = start
    while position < end or not pieces:
        cut = end if end - position <= _PIECE else data.find(b"\n", position + _PIECE, end)
        cut = end if cut < 0 else cut
        piece = columns_of(data[position:cut], words_in, words_out, _FIXED, BROKEN if flags else b"")
        if piece is None or not (np.isfinite(piece.times).all() and np.isfinite(piece.values).all()):
            return None
        if not (np.isfinite(piece.slopes_in).all() and np.isfinite(piece.slopes_out).all()):
            return None
        pieces.append(piece)
        position = cut
    return pieces


def _slow_piece(data: bytes, start: int, end: int, words_in: Words, words_out: Words, *, flags: bool) -> Columns:
    """The same one word after the other: takes keys however they are laid out, and names what is wrong."""
    tokens = data[start:end].split()
    flag = BROKEN if flags else b""
    error = first_error(data, start, end, words_in, words_out, flag)
    if error is not None:
        raise error
    broken = np.zeros(len(tokens) // 4, np.bool_)
    if flag in tokens:
        is_flag = np.fromiter(map(flag.__eq__, tokens), np.bool_, len(tokens))
        tokens = list(compress(tokens, ~is_flag))
        broken = np.zeros(len(tokens) // 4, np.bool_)
        broken[(np.flatnonzero(is_flag) - np.arange(np.count_nonzero(is_flag))) // 4 - 1] = True
    n = len(tokens) // 4
    times = np.fromiter(map(float, tokens[0::4]), np.float64, n)
    values = np.fromiter(map(float, tokens[1::4]), np.float64, n)
    return Columns(times, values, *_tangents(tokens[2::4], words_in), *_tangents(tokens[3::4], words_out), broken)


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
        self._indent = _quads(indent, (len(indent) + 3) // 4)
        self._separator = _quads(separator, 1)[0]
        self._words = np.array([_quads(words.get(rule, ""), 2) for rule in range(max(TangentRule) + 1)])
        self._ends = _quads("\n", 2), _quads(f"{separator}{BROKEN.decode()}\n", 2)

    def text(self, run: Run) -> bytes:
        """The lines of *run*."""
        return b"".join(self._lines(run[i : i + _LINES]) for i in range(0, len(run), _LINES))

    def _lines(self, run: Run) -> bytes:
        """Cells of four bytes each, side by side; where a cell is not full there are NULs, which are taken out."""
        n = len(run)
        tangents = [(run[f"rule_{side}"], run[f"slope_{side}"]) for side in ("in", "out")]
        widths = [CELL if (rules == _FIXED).any() else 3 for rules, _ in tangents]
        broken = run["broken"] if self.flags else np.zeros(n, np.bool_)
        widths = [len(self._indent), CELL, CELL, *widths, 2 if broken.any() else 1]
        line = np.zeros((n, sum(widths)), np.uint32)
        indent, times, values, tangents_in, tangents_out, end = np.split(line, np.cumsum(widths)[:-1], axis=1)
        indent[:] = self._indent
        fill_cells(times, np.ascontiguousarray(run["time"]))
        values[:, 0] = tangents_in[:, 0] = tangents_out[:, 0] = self._separator
        fill_cells(values, np.ascontiguousarray(run["value"]))
        for cells, (rules, slopes) in zip((tangents_in, tangents_out), tangents, strict=True):
            self._fill_tangents(cells, rules, slopes)
        end[:, 0] = np.where(broken, self._ends[1][0], self._ends[0][0])
        if end.shape[1] == 2:
            end[:, 1] = np.where(broken, self._ends[1][1], self._ends[0][1])
        return line.tobytes().translate(None, b"\0")

    def _fill_tangents(self, cells: Cells, rules: NDArray[np.uint8], slopes: NDArray[np.float64]) -> None:
        cells[:, 1] = self._words[:, 0][rules]
        cells[:, 2] = self._words[:, 1][rules]
        fixed = np.flatnonzero(rules == _FIXED)
        if len(fixed):
            numbers = np.zeros((len(fixed), CELL), np.uint32)
            numbers[:, 0] = self._separator
            fill_cells(numbers, slopes[fixed])
            cells[fixed] = numbers


def _quads(text: str, count: int) -> Cells:
    return np.frombuffer(text.encode("ascii").ljust(4 * count, b"\0"), np.uint32)
