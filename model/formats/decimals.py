"""Decimals and doubles, a million at once: the digits that a double reads back from, and the double they spell.

A double is m * 2**-s, and 10**p is 5**p * 2**p. So what a guess is wrong by, m * 5**p - digits * 2**(s - p), is a small
integer; it comes out exactly in integers of 64 bits, although its two terms overflow there.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

type Floats = NDArray[np.float64]
type Integers = NDArray[np.int64]
type Bools = NDArray[np.bool_]

POWERS: Final = np.array([10.0**k for k in range(23)])  # 10**22 is the last that a double holds exactly
_FIVES: Final = 5 ** np.arange(23, dtype=np.int64)
_MANTISSA: Final = np.int64((1 << 52) - 1)
_HIDDEN: Final = np.int64(1 << 52)
_SCALE: Final = np.int64(1023 + 52)
_ONE: Final = np.int64(1)
_SMALLEST: Final = np.int64(10**16)  # integer of 17 digits
_NUMBER: Final = np.uint64(9 * 10**16)  # of them


def floor_divide(numbers: Integers, divisor: int) -> Integers:
    """numbers // divisor of numbers from 0: without a sign it is done by a multiplication."""
    quotient: Integers = (numbers.view(np.uint64) // np.uint64(divisor)).view(np.int64)
    return quotient


def quotients(digits: Integers, places: Integers) -> tuple[Floats, Bools]:
    """The doubles nearest to digits / 10**places, and where that is certain: nearly everywhere below 2**52.

    *digits* are 0 to 10**18, *places* 0 to 22; the result for any other is some number.
    """
    result = digits.astype(np.float64) / POWERS.take(places, mode="clip")
    if not len(digits) or int(digits.max()) <= 1 << 53:
        return result, np.ones(len(digits), np.bool_)  # exact by exact: rounded once
    bits = result.view(np.int64)
    mantissas = bits & _MANTISSA | _HIDDEN
    shifts = _SCALE - places - (bits >> 52)
    halves = _FIVES.take(places, mode="clip")
    wrong = (digits << shifts) - mantissas * halves
    halves >>= _ONE
    nonzero = digits != 0
    # A half is never met exactly, since a power of five is odd.
    bits += (wrong > halves) & nonzero
    bits -= (wrong < -halves) & nonzero
    # Below a power of two doubles lie twice as dense.
    return result, (mantissas != _HIDDEN) & (shifts >= 0) | ~nonzero


def shortest_digits(sizes: Floats, places: Integers) -> tuple[Integers, Bools]:
    """17 digits as an integer: ``repr`` of each number, times 10**places; and where that is certain, nearly everywhere.

    *sizes* are 1e-4 to 1e8, *places* such that there are 17 digits.
    """
    bits = sizes.view(np.int64)
    mantissas = bits & _MANTISSA | _HIDDEN
    shifts = _SCALE - places - (bits >> 52)
    halves = _FIVES[places]
    nearest = (sizes * POWERS[places]).astype(np.int64)
    rest = mantissas * halves - (nearest << shifts)
    halves >>= _ONE  # half of the way to the next double
    half = _ONE << (shifts - _ONE)
    correction = (rest + half) >> shifts
    nearest += correction
    rest -= correction << shifts
    # Of 15 digits at most one decimal is so near, of 16 there may be three, and repr takes the nearest.
    # Below a power of two doubles lie twice as dense, but in this range all powers of two have less than 15 digits.
    to15 = floor_divide(nearest + 50, 100) * 100 - nearest
    reads15 = np.abs((to15 << shifts) - rest) <= halves
    certain = np.ones(len(sizes), np.bool_)
    if reads15.all():
        digits = nearest + to15
    else:
        unit = nearest - floor_divide(nearest, 10) * 10
        to16 = 10 * ((2 * unit + (rest > 0)) > 10) - unit
        reads16 = np.abs((to16 << shifts) - rest) <= halves
        tie = reads16 & (unit == 5) & (rest == 0) | ~reads16 & (rest == -half)
        certain = reads15 | ~tie
        digits = nearest + to15 * reads15 + to16 * (reads16 & ~reads15)
    return digits, certain & ((digits - _SMALLEST).view(np.uint64) < _NUMBER)
