"""Text of keys as numbers, a million at once: words are found, told apart and valued as columns of bytes.

This is the quick way for text as editors write it. Anything else makes ``columns_of`` give up, and the caller goes the
slow way, which takes one word after the other and knows what to say about a wrong one.
"""

import re
from itertools import pairwise
from math import isfinite
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.formats.decimals import POWERS, Bools, Floats, Integers, quotients
from model.formats.error import MAX_TOKEN_BYTES

type Octets = NDArray[np.uint64]

NUMBER: Final = re.compile(rb"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?\Z")
_PAD: Final = 32  # bytes before and behind a piece, so that those before a word may be taken anywhere
_DOT: Final = ord(".")
_MINUS: Final = ord("-")
_INTEGER_POWERS: Final = 10 ** np.arange(19, dtype=np.int64)
_MOST_PLACES: Final = len(POWERS) - 1
_MOST_DIGITS: Final = 18  # in an integer of 64 bits


def _octet(text: bytes) -> np.uint64:
    """Up to eight bytes as the last ones of an octet."""
    return np.uint64(int.from_bytes(text.rjust(8, b"\0"), "little"))


_ZEROS: Final = _octet(b"00000000")
# The last k of eight bytes.
_LAST: Final = np.array([(1 << 64) - (1 << 8 * (8 - k)) for k in range(9)], np.uint64)


class Columns(NamedTuple):
    """Keys as columns of shape (n,); a rule is the number of its word, or *fixed* where a slope stands instead."""

    times: Floats
    values: Floats
    rules_in: NDArray[np.uint8]
    slopes_in: Floats
    rules_out: NDArray[np.uint8]
    slopes_out: Floats
    broken: Bools


class _Words:
    """The words of a piece of text, cut at blanks and at points, so that a number is one or two of them."""

    def __init__(self, text: memoryview) -> None:
        padded = b"".join((b" " * _PAD, text, b" " * (_PAD + -len(text) % 8)))
        self.padded = padded
        self.bytes = np.frombuffer(padded, np.uint8)
        self.octets = np.frombuffer(padded, np.dtype("<u8"))
        # One more in front, so that an edge is numbered like the byte behind it.
        apart = np.ones(len(padded) + 1, np.bool_)
        here = apart[1:]
        np.equal(self.bytes, _DOT, out=here)
        points = np.count_nonzero(here)
        here |= self.bytes == ord(" ")
        here |= self.bytes - np.uint8(ord("\t")) <= ord("\r") - ord("\t")
        edges = np.flatnonzero(here != apart[:-1])
        self.starts: Integers = edges[0::2]
        self.ends: Integers = edges[1::2]
        self.before_point: Bools = self.bytes[self.ends] == _DOT
        # Whether the word behind is what stands behind the point of this one.
        self.goes_on = self.before_point.copy()
        self.goes_on[:-1] &= self.starts[1:] - self.ends[:-1] == 1
        self.goes_on[-1:] = False
        self.odd = bool(
            points != np.count_nonzero(self.before_point)  # .5 or a point alone
            or (self.before_point[1:] & self.goes_on[:-1]).any()  # 1.2.3
            or b"\v" in padded  # between the blanks, but none
            or b"\f" in padded
        )

    def heads(self) -> Integers:
        """The words that do not go on with a number."""
        goes_on: Bools = np.concatenate([[False], self.goes_on])
        return np.flatnonzero(~goes_on[:-1])

    def octets_before(self, ends: Integers, count: int) -> list[Octets]:
        """The eight bytes before each of *ends*, the eight before those, and so on."""
        places = ends >> 3
        # Octets are read where they lie in the text's own rows of eight: two of them hold what is between.
        shifts = (ends.view(np.uint64) & np.uint64(7)) << np.uint64(3)
        others = np.uint64(64) - shifts
        octets = [self.octets[places - k] for k in range(count + 1)]
        return [behind << others | before >> shifts for behind, before in pairwise(octets)]

    def octets_of(self, words: Integers) -> Octets:
        """The bytes of each word, NUL before them; 0 for words longer than eight or with a point behind."""
        ends = self.ends[words]
        lengths = ends - self.starts[words]
        octets = self.octets_before(ends, 1)[0] & _LAST.take(lengths, mode="clip")
        return octets * ((lengths <= 8) & ~self.before_point[words])

    def numbers(self, words: Integers) -> Floats | None:
        """The numbers that begin with these words; None if one of them is no number."""
        starts, points, goes_on = self.starts[words], self.ends[words], self.goes_on[words]
        minus = self.bytes[starts] == _MINUS
        lengths = points - starts - minus
        values, spoilt = _digits(self.octets_before(points, 1)[0], lengths)
        plain = (lengths >= 1) & (lengths <= 8)
        places = np.zeros(len(words), np.int64)
        if goes_on.any():
            ends = self.ends[words + goes_on]
            places = ends - points - goes_on
            values, plain = self._with_places(values, lengths, ends, places, plain, spoilt)
        plain &= spoilt & np.uint64(0x8080808080808080) == 0
        result, certain = quotients(values, places)
        result.view(np.uint64)[:] |= minus.astype(np.uint64) << np.uint64(63)
        for i in np.flatnonzero(~(plain & certain)).tolist():
            number = self._number(int(words[i]))
            if number is None:
                return None
            result[i] = number
        return result

    def _with_places(
        self, wholes: Integers, lengths: Integers, ends: Integers, places: Integers, plain: Bools, spoilt: Octets
    ) -> tuple[Integers, Bools]:
        """The digits before and behind the point as one integer, and where that is all there is and fits."""
        last, middle = self.octets_before(ends, 2)
        values, odd = _digits(last, places)
        spoilt |= odd
        more, odd = _digits(middle, places - 8)
        spoilt |= odd
        values += more * 10**8
        many = np.flatnonzero(places > 16)
        if len(many):
            first, odd = _digits(self.octets_before(ends[many] - 16, 1)[0], places[many] - 16)
            spoilt[many] |= odd
            plain[many] &= first < 100
            values[many] += first * 10**16
        plain &= places <= _MOST_PLACES
        plain &= (lengths + places <= _MOST_DIGITS) | (wholes == 0)
        return values + wholes * _INTEGER_POWERS.take(places, mode="clip"), plain

    def _number(self, word: int) -> float | None:
        start, end = int(self.starts[word]), int(self.ends[word + self.goes_on[word]])
        if end - start > MAX_TOKEN_BYTES:
            return None
        text = self.padded[start : end + (self.padded[end] == _DOT)]
        if not NUMBER.match(text):
            return None
        number = float(text)
        return number if isfinite(number) else None  # a text may spell one that is too large for a double


def _digits(octets: Octets, lengths: Integers) -> tuple[Integers, Octets]:
    """The integers that the last *lengths* bytes spell; a high bit is set in the other octet where one is no digit."""
    octets = (octets ^ _ZEROS) & _LAST.take(lengths, mode="clip")
    spoilt = octets + np.uint64(0x7676767676767676) | octets  # a byte above 9 sets its highest bit
    # Pairs of digits, then of pairs, then of quads are added up in place, eight digits by three multiplications.
    octets = octets * np.uint64(2561) >> np.uint64(8) & np.uint64(0x00FF00FF00FF00FF)
    octets = octets * np.uint64(6553601) >> np.uint64(16) & np.uint64(0x0000FFFF0000FFFF)
    octets = octets * np.uint64(42949672960001) >> np.uint64(32)
    return octets.view(np.int64), spoilt


def columns_of(
    text: memoryview, words_in: dict[bytes, int], words_out: dict[bytes, int], fixed: int, flag: bytes
) -> Columns | None:
    """The keys in *text*, which begins and ends between two keys; None if it is not as plain as it must be here.

    *flag* is a word that may follow a key, empty if none may.
    """
    words = _Words(text)
    if words.odd:
        return None
    heads = words.heads()
    before: Integers | None = None
    if flag and flag in words.padded:
        perhaps = np.flatnonzero(words.bytes[words.starts[heads]] == flag[0])
        flags = perhaps[words.octets_of(heads[perhaps]) == _octet(flag)]
        before = flags - np.arange(len(flags))
        if (before % 4).any() or (before == 0).any() or (np.diff(before) == 0).any():
            return None
        heads = np.delete(heads, flags)
    if len(heads) % 4:
        return None
    columns = np.ascontiguousarray(heads.reshape(-1, 4).T)
    broken = np.zeros(columns.shape[1], np.bool_)
    if before is not None:
        broken[before // 4 - 1] = True
    times = words.numbers(columns[0])
    values = words.numbers(columns[1])
    tangents_in = _tangents(words, columns[2], words_in, fixed)
    tangents_out = _tangents(words, columns[3], words_out, fixed)
    if times is None or values is None or tangents_in is None or tangents_out is None:
        return None
    return Columns(times, values, *tangents_in, *tangents_out, broken)


def _tangents(
    words: _Words, column: Integers, known: dict[bytes, int], fixed: int
) -> tuple[NDArray[np.uint8], Floats] | None:
    octets = words.octets_of(column)
    rules = np.full(len(column), fixed, np.uint8)
    for word, rule in known.items():
        met = octets == _octet(word)
        if met.any():
            rules += met.view(np.uint8) * np.uint8((rule - fixed) % 256)  # at most one word is met
    slopes = np.zeros(len(column))
    numbers = np.flatnonzero(rules == fixed)
    if len(numbers):
        found = words.numbers(column[numbers])
        if found is None:
            return None
        slopes[numbers] = found
    return rules, slopes
