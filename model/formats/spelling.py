"""Numbers as text for a million keys at once: the digits of ``repr``, laid out in octets, eight bytes a column.

Numbers outside the range where that is exact, few in real clips, go through ``repr`` one by one.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.formats.decimals import Floats, Integers, floor_divide, shortest_digits

type Octets = NDArray[np.uint64]
type Quads = NDArray[np.uint32]

MOST_BEFORE: Final = 6  # bytes that may stand before a number
_FEWEST: Final = 1e-4  # repr turns to exponents below
_MOST: Final = 1e8
_PLACES: Final = 16  # behind the point in two octets
_WHOLE_POWERS: Final = np.array([10**k if k <= _PLACES else 0 for k in range(21)], np.int64)
_PADS: Final = np.array([10 ** min(20 - k, 18) for k in range(21)], np.int64)
_TEN_THOUSAND: Final = np.uint32(10_000)


def octet(text: bytes, at: int = 0) -> np.uint64:
    """Up to eight bytes as one number, the first at the byte *at*."""
    return np.uint64(int.from_bytes((b"\0" * at + text).ljust(8, b"\0"), "little"))


def _tables() -> tuple[Octets, Octets, Octets, Octets]:
    """0 to 9999 as four bytes: with all zeros; without those in front, those behind, those behind the first digit."""
    digits = (np.arange(10_000)[:, None] // [1000, 100, 10, 1] % 10).astype(np.uint8)
    text = digits + np.uint8(ord("0"))
    in_front = np.maximum.accumulate(digits, axis=1) == 0
    behind = np.maximum.accumulate(digits[:, ::-1], axis=1)[:, ::-1] == 0
    leading, trailing, first = (np.where(mask, 0, text).astype(np.uint8) for mask in (in_front, behind, behind))
    leading[0, 3] = first[0, 0] = ord("0")
    plain, lead, trail, head = (
        table.view(np.dtype("<u4"))[:, 0].astype(np.uint64) for table in (text, leading, trailing, first)
    )
    return plain, lead, trail, head


def _shifted(table: Octets, count: int) -> Octets:
    return table << np.uint64(8 * count)


_PLAIN, _LEADING, _TRAILING, _FIRST = _tables()
# Of 20,000 rows the second half is for quads with other digits than 0 behind them (of the whole part: before them).
_FRONT_0: Final = np.concatenate([_FIRST, _PLAIN])
_BACK: Final = np.concatenate([_TRAILING, _PLAIN])
_BACK_4: Final = _shifted(_BACK, 4)
_WHOLE_2: Final = _shifted(_LEADING, 2) | octet(b".", 6)
_WHOLE_3: Final = _shifted(np.concatenate([_LEADING, _PLAIN]), 3) | octet(b".", 7)
_THOUSANDS: Final = np.where(np.arange(10_000) > 0, _LEADING, np.uint64(0))
# The last three digits of four go to the front of an octet, the first one to the end of the one before.
_MILLIONS: Final = np.where(np.arange(10_000) < 1000, _THOUSANDS >> np.uint64(8), _PLAIN >> np.uint64(8))
_TOP: Final = np.where(np.arange(10_000) < 1000, np.uint64(0), _shifted(_PLAIN & np.uint64(0xFF), 7))


def spelled(numbers: Floats, before: bytes) -> list[Octets]:
    """The ``repr`` of each number, *before* in front of it, as columns of octets; NUL stands where there is nothing."""
    sizes = np.abs(numbers)
    zero = numbers == 0  # common, and without a logarithm: laid out as 1.0 and then made 0.0
    easy = (sizes >= _FEWEST) & (sizes < _MOST)
    hard = not easy.all()
    if hard:
        sizes[~easy] = 1.0
    places = _PLACES - np.floor(np.log10(sizes)).astype(np.int64)
    digits, good = shortest_digits(sizes, places)
    wholes = sizes.astype(np.int64)
    behind = digits - wholes * _WHOLE_POWERS[places]
    if hard:
        wholes[zero] = 0
        good &= easy | zero
    columns = _fronts(wholes, numbers.view(np.uint64) >> np.uint64(63), before) + _backs(behind, places)
    if not good.all():
        _spell_one_by_one(columns, numbers, np.flatnonzero(~good), before)
    return columns


def _fronts(wholes: Integers, minus: Octets, before: bytes) -> list[Octets]:
    """What is before the number, its sign, the whole part and the point."""
    whole = wholes.astype(np.uint32)
    if len(before) == 1 and int(whole.max(initial=0)) < _TEN_THOUSAND:
        return [_WHOLE_2[wholes] | minus * octet(b"-", 1) | octet(before)]
    first = minus * octet(b"-", MOST_BEFORE) | octet(before)
    thousands = whole // _TEN_THOUSAND
    if not thousands.any():
        return [first, _WHOLE_3[wholes]]
    whole -= thousands * _TEN_THOUSAND
    whole += (thousands != 0) * _TEN_THOUSAND
    if int(thousands.max()) >= 1000:
        first |= _TOP.take(thousands, mode="clip")
    return [first, _WHOLE_3.take(whole, mode="clip") | _MILLIONS.take(thousands, mode="clip")]


def _backs(behind: Integers, places: Integers) -> list[Octets]:
    """The digits behind the point, of which *places* (9 to 20) are given: 16, and the others where there are any."""
    pads = _PADS[places]
    high = floor_divide(behind, 10_000)
    low = (behind - high * 10_000) * pads
    carried = floor_divide(low, 10_000)
    last = (low - carried * 10_000).astype(np.uint32)
    sixteen = high * pads + carried
    upper = floor_divide(sixteen, 10**8)
    lower = (sixteen - upper * 10**8).astype(np.uint32)
    quads = [*_halves(upper.astype(np.uint32)), *_halves(lower)]
    more = last != 0
    lasts = [_TRAILING.take(last, mode="clip")] if more.any() else []
    columns = []
    for table, quad in ((_BACK_4, quads[3]), (_BACK, quads[2]), (_BACK_4, quads[1]), (_FRONT_0, quads[0])):
        columns.append(table.take(quad + more * _TEN_THOUSAND, mode="clip"))
        more |= quad != 0
    return [columns[3] | columns[2], columns[1] | columns[0], *lasts]


def _halves(eights: Quads) -> tuple[Quads, Quads]:
    high = eights // _TEN_THOUSAND
    return high, eights - high * _TEN_THOUSAND


def _spell_one_by_one(columns: list[Octets], numbers: Floats, others: Integers, before: bytes) -> None:
    texts = [before + repr(number).encode() for number in numbers[others].tolist()]
    while 8 * len(columns) < max(map(len, texts)):
        columns.append(np.zeros(len(numbers), np.uint64))
    cells = np.array(texts, f"S{8 * len(columns)}").view("<u8").reshape(-1, len(columns))
    for column, cell in zip(columns, cells.T, strict=True):
        column[others] = cell
