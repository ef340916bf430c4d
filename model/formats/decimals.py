"""Numbers as text for a million keys at once: the digits of ``repr``, laid out in cells of fixed width.

Whole columns are worked on in exact integer and double-double arithmetic. Numbers outside the range where that is
exact, few in real clips, go through ``repr`` one by one.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

type Floats = NDArray[np.float64]
type Integers = NDArray[np.int64]
type Bools = NDArray[np.bool_]
type Cells = NDArray[np.uint32]

CELL: Final = 9  # quads of 4 bytes: what is before and the sign, 2 of whole part, point, 5 behind it; the rest is NUL
POWERS: Final = np.array([10.0**k for k in range(23)])  # 10**22 is the last that a double holds exactly
_WHOLE_POWERS: Final = 10 ** np.arange(19, dtype=np.int64)
_FEWEST: Final = 1e-4  # repr turns to exponents below
_MOST: Final = 1e8  # two quads of whole part
_EXPONENT: Final = np.int64(0x7FF0000000000000)
_DOUBT: Final = 1e-6  # what is left of the remainder's own rounding is a thousand million times less
_SPLITTER: Final = 134217729.0  # 2**27 + 1


def _tables() -> tuple[Cells, Cells, Cells, Cells]:
    """0 to 9999 as four bytes: with all zeros; without those in front, those behind, those behind the first digit."""
    digits = (np.arange(10_000)[:, None] // [1000, 100, 10, 1] % 10).astype(np.uint8)
    text = digits + np.uint8(ord("0"))
    in_front = np.maximum.accumulate(digits, axis=1) == 0
    behind = np.maximum.accumulate(digits[:, ::-1], axis=1)[:, ::-1] == 0
    leading, trailing, first = (np.where(mask, 0, text).astype(np.uint8) for mask in (in_front, behind, behind))
    leading[0, 3] = first[0, 0] = ord("0")
    plain, lead, trail, head = (table.view(np.uint32)[:, 0] for table in (text, leading, trailing, first))
    return plain, lead, trail, head


_PLAIN, _LEADING, _TRAILING, _FIRST = _tables()
_MINUS, _POINT = np.frombuffer(b"\0\0\0-.\0\0\0", np.uint32)


def product_error(a: Floats, b: Floats, product: Floats) -> Floats:
    """a * b - product, exactly, where *product* is the double nearest to a * b.

    Source: T. J. Dekker, "A floating-point technique for extending the available precision", 1971.
    """
    t = _SPLITTER * a
    a_high = t - (t - a)
    a_low = a - a_high
    t = _SPLITTER * b
    b_high = t - (t - b)
    b_low = b - b_high
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


def quotients(digits: Integers, places: Integers) -> tuple[Floats, Bools]:
    """The doubles nearest to digits / 10**places, and where that is certain: nearly everywhere.

    The remainder of the division is worked out exactly and added; only a result within a
    millionth of the middle between two doubles (or of the other middle that a power of two has) could round the wrong
    way.
    """
    high = digits.astype(np.float64)
    scale = POWERS[places]
    quotient = high / scale
    low = digits - high.astype(np.int64)
    if not low.any():
        return quotient, np.ones(len(digits), np.bool_)
    product = quotient * scale
    remainder = ((high - product) - product_error(quotient, scale, product)) + low.astype(np.float64)
    correction = remainder / scale
    result = quotient + correction
    rest = np.abs((quotient - result) + correction)
    # The distance to the next double: the power of two that the result begins with, of which a double holds 52 bits.
    gap = (result.view(np.int64) & _EXPONENT).view(np.float64) * 2.0**-52
    near = _DOUBT * gap
    certain = (np.abs(rest - 0.5 * gap) > near) & (np.abs(rest - 0.25 * gap) > near) | (digits == 0)
    return result, certain


def fill_cells(cells: Cells, numbers: Floats) -> None:
    """Write the ``repr`` of each number into its row of *cells*, shape (n, CELL).

    The cells hold zeros, or in the first byte what stands before the number.
    """
    sizes = np.abs(numbers)
    easy = (sizes >= _FEWEST) & (sizes < _MOST)
    sizes = np.where(easy, sizes, 1.0)
    exponents = np.floor(np.log10(sizes)).astype(np.int64)
    digits, good = _shortest_digits(sizes, exponents)
    good &= easy
    zero = numbers == 0  # common, and without a logarithm: laid out as 1.0 and then made 0.0
    good |= zero
    cells[:, 0] |= np.where(good & np.signbit(numbers), _MINUS, np.uint32(0))
    _fill_digits(cells, sizes.astype(np.int64), digits, 16 - exponents)
    cells[zero, 2] = _LEADING[0]
    if not good.all():
        others = np.flatnonzero(~good)
        texts = np.array([repr(number) for number in numbers[others].tolist()], f"S{4 * (CELL - 1)}")
        cells[others, 1:] = texts.view(np.uint32).reshape(-1, CELL - 1)


def _shortest_digits(sizes: Floats, exponents: Integers) -> tuple[Integers, Bools]:
    """17 digits as an integer: the shortest text of each number followed by zeros; and where they are certain.

    sizes * 10**k is exactly the sum of two doubles for k <= 22, so rounding it to 17 digits and to 16 is exact. A
    decimal of 15 or fewer digits, and one of 16 below 2**53, reads back by one division, which rounds only once.
    """
    scale = POWERS[16 - exponents]
    high = sizes * scale
    low = product_error(sizes, scale, high)
    nearest = np.rint(low)
    all17 = high.astype(np.int64) + nearest.astype(np.int64)
    in_range = (all17 >= 10**16) & (all17 < 10**17 - 50)
    all15 = (all17 + 50) // 100
    reads15 = all15.astype(np.float64) / POWERS[14 - exponents] == sizes
    if reads15.all():
        return all15 * 100, in_range
    tens = all17 // 10
    unit = all17 - 10 * tens
    rest = low - nearest
    all16 = tens + ((unit > 5) | ((unit == 5) & (rest > 0)))
    tie16 = (unit == 5) & (rest == 0)
    reads16 = all16.astype(np.float64) / POWERS[15 - exponents] == sizes
    certain = ~tie16 & (reads16 | (np.abs(rest) != 0.5))
    large = np.flatnonzero(all16 > 1 << 53)  # these a double cannot hold
    if len(large):
        read, sure = quotients(all16[large], 15 - exponents[large])
        reads16[large] = read == sizes[large]
        certain[large] &= sure
    digits = np.where(reads15, all15 * 100, np.where(reads16, all16 * 10, all17))
    return digits, in_range & (reads15 | certain)


def _fill_digits(cells: Cells, wholes: Integers, digits: Integers, places: Integers) -> None:
    """Lay out *digits*, of which *places* (9 to 20) stand behind the point, four at a time."""
    thousands = wholes // 10_000
    if thousands.any():
        cells[:, 1] = np.where(thousands > 0, _LEADING[thousands], 0)
        cells[:, 2] = np.where(thousands > 0, _PLAIN[wholes - 10_000 * thousands], _LEADING[wholes % 10_000])
    else:
        cells[:, 2] = _LEADING[wholes]
    cells[:, 3] = _POINT
    behind = np.where(wholes > 0, digits - wholes * _WHOLE_POWERS[np.minimum(places, 18)], digits)
    step = _WHOLE_POWERS[places - 4]
    first = behind // step
    rest = (behind - first * step) * _WHOLE_POWERS[20 - places]
    quads = [first]
    for power in (12, 8, 4, 0):
        quad = rest // 10**power
        rest = rest - quad * 10**power
        quads.append(quad)
    more = np.zeros(len(digits), np.bool_)  # whether a digit other than 0 stands further behind
    for column in (4, 3, 2, 1, 0):
        quad = quads[column]
        if not more.any() and not quad.any() and column:
            continue
        table = _TRAILING if column else _FIRST
        cells[:, 4 + column] = np.where(more, _PLAIN[quad], table[quad])
        more |= quad > 0
