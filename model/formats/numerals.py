"""Text of keys as numbers, a million at once: words are found, told apart and valued as columns of bytes.

This is the quick way for text as editors write it. Anything else makes ``columns_of`` give up, and the caller goes the
slow way, which takes one word after the other and knows what to say about a wrong one.
"""

import re
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.formats.decimals import POWERS, Bools, Floats, Integers, quotients
from model.formats.error import MAX_TOKEN_BYTES

type Octets = NDArray[np.uint64]

NUMBER: Final = re.compile(rb"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?\Z")
_PAD: Final = 32  # bytes before and behind a piece, so that eight may be taken anywhere
_DOT: Final = ord(".")
_MINUS: Final = ord("-")
_INTEGER_POWERS: Final = 10 ** np.arange(19, dtype=np.int64)
_MOST_PLACES: Final = len(POWERS) - 1


def _octet(text: bytes) -> int:
    return int.from_bytes(text.ljust(8, b"\0"), "little")


_ZEROS: Final = np.uint64(_octet(b"00000000"))
# The first k, and the last k, of eight bytes.
_FIRST: Final = np.array([(1 << 8 * k) - 1 for k in range(9)], np.uint64)
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

    def finite(self) -> bool:
        """Whether all numbers are finite: a text may spell one that is too large for a double."""
        return all(
            bool(np.isfinite(column).all()) for column in (self.times, self.values, self.slopes_in, self.slopes_out)
        )


class _Words:
    """The words of a piece of text, cut at blanks and at points, so that a number is one or two of them."""

    def __init__(self, text: bytes) -> None:
        padded = b"".join((b" " * _PAD, text, b" " * _PAD))
        self.padded = padded
        self.bytes = np.frombuffer(padded, np.uint8)
        self.octets: Octets = np.ndarray((len(padded) - 7,), np.dtype("<u8"), padded, strides=(1,))
        apart = self.bytes == _DOT
        for blank in b" \t\n\r":
            apart |= self.bytes == blank
        edges = np.flatnonzero(apart[1:] != apart[:-1]) + 1
        self.starts: Integers = edges[0::2]
        self.ends: Integers = edges[1::2]
        after_point = self.bytes[self.starts - 1] == _DOT
        # continues[k]: word k is what stands behind the point of word k - 1; one more at the end for the last word.
        self.continues = np.zeros(len(self.starts) + 1, np.bool_)
        self.continues[1:-1] = after_point[1:] & (self.starts[1:] - self.ends[:-1] == 1)
        before_point = self.bytes[self.ends] == _DOT
        self.odd = bool(
            np.count_nonzero(self.bytes == _DOT) != np.count_nonzero(before_point)  # .5 or a point alone
            or (before_point & self.continues[:-1]).any()  # 1.2.3
            or (self.ends - self.starts > MAX_TOKEN_BYTES).any()
        )

    def first_eight(self, words: Integers) -> Octets:
        """The bytes of each word as one number, 0 for words longer than eight or with a point behind."""
        starts = self.starts[words]
        lengths = self.ends[words] - starts
        octets = self.octets[starts] & _FIRST[np.minimum(lengths, 8)]
        return np.where((lengths <= 8) & (self.bytes[self.ends[words]] != _DOT), octets, np.uint64(0))

    def numbers(self, words: Integers) -> Floats | None:
        """The numbers that begin with these words; None if one of them is no number."""
        starts, ends = self.starts[words], self.ends[words]
        minus = self.bytes[starts] == _MINUS
        lengths = ends - starts - minus
        whole, plain = self._digits(ends, lengths)
        values = whole.astype(np.int64)
        has_places = self.continues[words + 1]
        places = np.zeros(len(words), np.int64)
        if has_places.any():
            behind = np.minimum(words + 1, len(self.starts) - 1)
            places = np.where(has_places, self.ends[behind] - self.starts[behind], 0)
            values, fits = self._with_places(values, lengths, self.ends[behind], places)
            plain &= fits
        result, certain = quotients(values, np.minimum(places, _MOST_PLACES))
        result = np.where(minus, -result, result)
        for i in np.flatnonzero(~(plain & certain)).tolist():
            number = self._number(int(words[i]))
            if number is None:
                return None
            result[i] = number
        return result

    def _with_places(
        self, wholes: Integers, lengths: Integers, ends: Integers, places: Integers
    ) -> tuple[Integers, Bools]:
        """The digits before and behind the point as one integer, and where that is all there is and fits."""
        last, plain = self._digits(ends, np.minimum(places, 8), fewest=0)
        values = last.astype(np.int64)
        if (places > 8).any():
            middle, digits = self._digits(ends - 8, np.minimum(np.maximum(places - 8, 0), 8), fewest=0)
            values += middle.astype(np.int64) * 10**8
            plain &= digits
        if (places > 16).any():
            first, digits = self._digits(ends - 16, np.minimum(np.maximum(places - 16, 0), 8), fewest=0)
            plain &= digits & (first < 100)
            values += np.minimum(first, np.uint64(99)).astype(np.int64) * 10**16
        plain &= (places <= _MOST_PLACES) & ((wholes == 0) | (lengths + places <= 18))
        return values + wholes * _INTEGER_POWERS[np.minimum(places, 18 - np.minimum(lengths, 8))], plain

    def _digits(self, ends: Integers, lengths: Integers, *, fewest: int = 1) -> tuple[Octets, Bools]:
        """The integers that *lengths* digits before *ends* spell, and where they are *fewest* to 8 and all digits."""
        octets = (self.octets[ends - 8] ^ _ZEROS) & _LAST[np.minimum(np.maximum(lengths, 0), 8)]
        spread = octets + np.uint64(0x7676767676767676) | octets  # a byte above 9 sets its highest bit
        plain = (spread & np.uint64(0x8080808080808080) == 0) & (lengths >= fewest) & (lengths <= 8)
        # Pairs of digits, then of pairs, then of quads are added up in place, eight digits by three multiplications.
        octets = octets * np.uint64(2561) >> np.uint64(8) & np.uint64(0x00FF00FF00FF00FF)
        octets = octets * np.uint64(6553601) >> np.uint64(16) & np.uint64(0x0000FFFF0000FFFF)
        octets = octets * np.uint64(42949672960001) >> np.uint64(32)
        return octets, plain

    def _number(self, word: int) -> float | None:
        end = int(self.ends[word + self.continues[word + 1]])
        text = self.padded[int(self.starts[word]) : end + (self.padded[end] == _DOT)]
        return float(text) if NUMBER.match(text) else None


def columns_of(
    text: bytes, words_in: dict[bytes, int], words_out: dict[bytes, int], fixed: int, flag: bytes
) -> Columns | None:
    """The keys in *text*, which begins and ends between two keys; None if it is not as plain as it must be here.

    *flag* is a word that may follow a key, empty if none may.
    """
    words = _Words(text)
    whole = np.flatnonzero(~words.continues[:-1])
    broken: Bools | None = None
    if flag and flag in text:
        is_flag = words.first_eight(whole) == _octet(flag)
        before = np.flatnonzero(is_flag) - np.arange(np.count_nonzero(is_flag))
        whole = whole[~is_flag]
        if (before % 4).any() or (before == 0).any() or (np.diff(before) == 0).any():
            return None
        broken = np.zeros(len(whole) // 4, np.bool_)
        broken[before // 4 - 1] = True
    if words.odd or len(whole) % 4:
        return None
    columns = whole.reshape(-1, 4)
    if broken is None:
        broken = np.zeros(len(columns), np.bool_)
    times = words.numbers(columns[:, 0])
    values = words.numbers(columns[:, 1])
    tangents_in = _tangents(words, columns[:, 2], words_in, fixed)
    tangents_out = _tangents(words, columns[:, 3], words_out, fixed)
    if times is None or values is None or tangents_in is None or tangents_out is None:
        return None
    found = Columns(times, values, *tangents_in, *tangents_out, broken)
    return found if found.finite() else None


def _tangents(
    words: _Words, column: Integers, known: dict[bytes, int], fixed: int
) -> tuple[NDArray[np.uint8], Floats] | None:
    octets = words.first_eight(column)
    rules = np.full(len(column), fixed, np.uint8)
    for word, rule in known.items():
        rules[octets == _octet(word)] = rule
    slopes = np.zeros(len(column))
    numbers = np.flatnonzero(rules == fixed)
    if len(numbers):
        found = words.numbers(column[numbers])
        if found is None:
            return None
        slopes[numbers] = found
    return rules, slopes
