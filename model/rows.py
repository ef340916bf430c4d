"""Rows: the keys of a channel as an unrolled doubly linked list that numpy can read as flat columns.

Rows of `width` slots lie one after the other and hold up to that many neighbouring keys each. The spare slots
at the end of a row repeat its last key, so that every flat column is sorted where the times are, and bisection,
Horner and reductions run on it without masks. Row r is linked to rows r - 1 and r + 1 by lying between them;
a key is linked to its neighbours by its place in the row. A key is inserted, removed or replaced by moving
numbers inside one row; a full row shares its keys out to rows near it. Nothing outside the channel knows rows.
"""

from bisect import bisect_right
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.hermite import Floats
from model.keyframe import KeyGoneError

TIME, VALUE, SLOPE_IN, SLOPE_OUT, A, B, C, D_TIME = range(8)
RULE_IN, RULE_OUT, BROKEN = range(3)

WIDEST = 512
FILLED = 384
# The share of its slots that a group of rows may fill after sharing out; a whole channel beyond it gets new rows.
CROWDED = 0.85


class Keys(NamedTuple):
    """Neighbouring keys as columns: numbers (8, n), marks (3, n), ids (n,)."""

    numbers: Floats
    marks: NDArray[np.uint8]
    ids: NDArray[np.int32]

    def __getitem__(self, part: slice) -> "Keys":  # type: ignore[override]
        return Keys(self.numbers[:, part], self.marks[:, part], self.ids[part])

    @property
    def count(self) -> int:
        """How many keys."""
        return len(self.ids)

    @classmethod
    def empty(cls, n: int) -> "Keys":
        """Room for n keys."""
        return cls(np.empty((8, n)), np.empty((3, n), np.uint8), np.empty(n, np.int32))

    @classmethod
    def joined(cls, *parts: "Keys") -> "Keys":
        """One after the other."""
        return cls(
            np.concatenate([part.numbers for part in parts], axis=1),
            np.concatenate([part.marks for part in parts], axis=1),
            np.concatenate([part.ids for part in parts]),
        )


class Rows:
    """The rows of one channel; keys are addressed by rank (0 = first) or by slot in the flat columns."""

    def __init__(self, keys: Keys) -> None:
        self.row_of = np.full(16, -1, np.int32)  # by id; -1: no such key
        self._lay_out(keys)

    def _lay_out(self, keys: Keys) -> None:
        """Make new rows for all *keys*."""
        n = keys.count
        self.size = n
        if n <= FILLED:
            self.width = min(WIDEST, max(8, 1 << (n + n // 3).bit_length()))
            rows = 1
        else:
            self.width = WIDEST
            rows = -(-n // FILLED)
        slots = rows * self.width
        self.numbers = np.empty((8, slots))
        self.marks = np.empty((3, slots), np.uint8)
        self.ids = np.empty(slots, np.int32)
        self.times = self.numbers[TIME]
        self.first = np.zeros(rows + 1, np.int64)  # rank of each row's first key, and the number of keys
        self.starts = [0.0] * rows
        self.dirty: set[int] | None = None  # rows changed since the extremes were known; None: all
        self.row_of[:] = -1
        if n:
            self._share_out(0, rows, keys)
        else:
            self.numbers[:], self.marks[:], self.ids[:] = 0.0, 0, 0

    def _share_out(self, row0: int, row1: int, keys: Keys) -> None:
        """Fill rows row0 to row1 evenly with *keys*, at least one each; their ranks begin at first[row0]."""
        rows = row1 - row0
        each, more = divmod(keys.count, rows)
        at = 0
        for begin, end, count in ((0, more, each + 1), (more, rows, each)):
            if begin == end:
                continue
            taken = keys[at : at + (end - begin) * count]
            at += taken.count
            begin, end = begin + row0, end + row0
            part = slice(begin * self.width, end * self.width)
            for columns, new in (
                (self.numbers, taken.numbers),
                (self.marks, taken.marks),
                (self.ids[None], taken.ids[None]),
            ):
                grid = columns[:, part].reshape(len(columns), end - begin, self.width)
                grid[:, :, :count] = new.reshape(len(columns), end - begin, count)
                grid[:, :, count:] = grid[:, :, count - 1 : count]
            self.row_of = _grown(self.row_of, int(taken.ids.max()))
            self.row_of[taken.ids] = np.repeat(np.arange(begin, end, dtype=np.int32), count)
            self.first[begin + 1 : end + 1] = self.first[begin] + count * np.arange(1, end - begin + 1)
            self.starts[begin:end] = self.times[part].reshape(end - begin, self.width)[:, 0].tolist()
        if self.dirty is not None:
            self.dirty.update(range(row0, row1))

    # --- places

    @property
    def rows(self) -> int:
        """How many rows."""
        return len(self.starts)

    def count(self, row: int) -> int:
        """How many keys *row* holds."""
        return int(self.first[row + 1]) - int(self.first[row])

    def place(self, rank: int) -> tuple[int, int]:
        """(row, place in it) of the key of that rank; rank = size gives the place behind the last key."""
        row = min(int(self.first.searchsorted(rank, "right")) - 1, self.rows - 1)
        return row, rank - int(self.first[row])

    def slot(self, rank: int) -> int:
        """The slot of the key of that rank."""
        row, place = self.place(rank)
        return row * self.width + place

    def slots(self, rank0: int, rank1: int) -> NDArray[np.int64]:
        """The slots of the keys of these ranks."""
        ranks = np.arange(rank0, rank1)
        rows = self.first.searchsorted(ranks, "right") - 1
        return rows * self.width + (ranks - self.first[rows])

    def real(self, slots: NDArray[np.int64]) -> NDArray[np.int64]:
        """The slots of the keys that these slots hold or repeat."""
        rows = slots // self.width
        return np.minimum(slots, rows * self.width + (self.first[rows + 1] - self.first[rows] - 1))

    def ranks(self, slots: NDArray[np.int64]) -> NDArray[np.int64]:
        """The ranks of the keys that these slots hold or repeat."""
        slots = self.real(slots)
        rows = slots // self.width
        return self.first[rows] + slots - rows * self.width

    def rank_of(self, key_id: int) -> int:
        """The rank of the key with this id; KeyGoneError if there is none."""
        row = int(self.row_of[key_id]) if 0 < key_id < len(self.row_of) else -1
        if row < 0:
            raise KeyGoneError(f"no key with id {key_id}")
        begin = row * self.width
        return int(self.first[row]) + int((self.ids[begin : begin + self.width] == key_id).argmax())

    def rank_at(self, time: float, *, after: bool = True) -> int:
        """How many keys lie at or before *time* (before it only, if not *after*)."""
        if self.size == 0:
            return 0
        row = max(bisect_right(self.starts, time) - 1, 0)
        begin, count = row * self.width, self.count(row)
        side = "right" if after else "left"
        return int(self.first[row]) + int(self.times[begin : begin + count].searchsorted(time, side))  # type: ignore[call-overload]

    # --- reading and replacing

    def _blocks(self, rank0: int, rank1: int) -> Iterator[tuple[int, int, int, int]]:
        """(rank, rows, first slot, keys a row) of groups of rows of equal count that hold these ranks."""
        if rank0 >= rank1:
            return
        row0, place0 = self.place(rank0)
        row1, place1 = self.place(rank1 - 1)
        if row0 == row1:
            yield rank0, 1, row0 * self.width + place0, rank1 - rank0
            return
        yield rank0, 1, row0 * self.width + place0, self.count(row0) - place0
        counts = np.diff(self.first[row0 + 1 : row1 + 1])
        cuts = [0, *(np.flatnonzero(np.diff(counts)) + 1).tolist(), len(counts)] if len(counts) else []
        for begin, end in zip(cuts, cuts[1:], strict=False):
            row = row0 + 1 + begin
            yield int(self.first[row]), end - begin, row * self.width, int(counts[begin])
        yield int(self.first[row1]), 1, row1 * self.width, place1 + 1

    def gathered(self, rank0: int, rank1: int) -> Keys:
        """Copies of the keys of these ranks."""
        keys = Keys.empty(rank1 - rank0)
        for rank, rows, slot, count in self._blocks(rank0, rank1):
            at = slice(rank - rank0, rank - rank0 + rows * count)
            for columns, out in (
                (self.numbers, keys.numbers),
                (self.marks, keys.marks),
                (self.ids[None], keys.ids[None]),
            ):
                out[:, at] = self._grid(columns, slot, rows, count).reshape(len(out), -1)
        return keys

    def _grid(self, columns: NDArray[np.generic], slot: int, rows: int, count: int) -> NDArray[np.generic]:
        """A view of *rows* rows of *count* keys each, beginning at *slot*: (columns, rows, count)."""
        if rows == 1:
            return columns[:, None, slot : slot + count]
        return columns[:, slot : slot + rows * self.width].reshape(len(columns), rows, self.width)[:, :, :count]

    def replace(self, rank0: int, rank1: int, keys: Keys) -> None:
        """Put *keys* in the place of those of ranks rank0 to rank1 (which may be none)."""
        row0, place = self.place(rank0)
        row1 = self.place(rank1 - 1)[0] if rank1 > rank0 else row0
        count = self.count(row0)
        new_count = count - (rank1 - rank0) + keys.count
        if row0 == row1 and 0 < new_count <= self.width:
            self._replace_in_row(row0, place, rank1 - rank0, keys)
        elif self.size - (rank1 - rank0) + keys.count == 0:
            self._lay_out(Keys.empty(0))
        else:
            self._replace_in_rows(rank0, rank1, keys, row0, row1)

    def _replace_in_row(self, row: int, place: int, gone: int, keys: Keys) -> None:
        begin, count, come = row * self.width, self.count(row), keys.count
        new_count = count - gone + come
        self.row_of[self.ids[begin + place : begin + place + gone]] = -1
        row_slots = slice(begin, begin + self.width)
        for columns, new in ((self.numbers, keys.numbers), (self.marks, keys.marks), (self.ids[None], keys.ids[None])):
            line = columns[:, row_slots]
            if gone != come:
                line[:, place + come : new_count] = line[:, place + gone : count]
            line[:, place : place + come] = new
            line[:, new_count:] = line[:, new_count - 1 : new_count]
        if come:
            self.row_of = _grown(self.row_of, int(keys.ids.max()))
            self.row_of[keys.ids] = row
        if gone != come:
            self.first[row + 1 :] += come - gone
            self.size += come - gone
        if place == 0:
            self.starts[row] = float(self.times[begin])
        if self.dirty is not None:
            self.dirty.add(row)

    def _replace_in_rows(self, rank0: int, rank1: int, keys: Keys, row0: int, row1: int) -> None:
        """Share out anew as many rows around as it takes; all of them if they are too full or too empty."""
        new_size = self.size - (rank1 - rank0) + keys.count
        begin, end, step = row0, row1 + 1, 1
        while True:
            rows = end - begin
            held = int(self.first[end] - self.first[begin]) - (rank1 - rank0) + keys.count
            if rows <= held <= CROWDED * rows * self.width:
                break
            if rows == self.rows:
                head, tail = self.gathered(0, rank0), self.gathered(rank1, self.size)
                self._lay_out(Keys.joined(head, keys, tail))
                return
            begin, end, step = max(0, begin - step), min(self.rows, end + step), 2 * step
        base, stop = int(self.first[begin]), int(self.first[end])
        head, tail = self.gathered(base, rank0), self.gathered(rank1, stop)
        for _, rows, slot, count in self._blocks(rank0, rank1):
            self.row_of[self._grid(self.ids[None], slot, rows, count).reshape(-1)] = -1
        self._share_out(begin, end, Keys.joined(head, keys, tail))
        self.first[end + 1 :] += new_size - self.size
        self.size = new_size

    def check(self) -> None:
        """Assert order, counts, links of keys to rows both ways, unique ids and padding."""
        assert self.first[0] == 0
        assert self.first[-1] == self.size
        assert len(self.first) == self.rows + 1
        counts = np.diff(self.first)
        assert self.size == 0 or (counts.min() > 0 and counts.max() <= self.width)
        slots = self.slots(0, self.size)
        assert (np.diff(self.times[slots]) > 0.0).all(), "times are not in order"
        ids = self.ids[slots]
        assert len(np.unique(ids)) == self.size
        assert (ids > 0).all()
        assert np.array_equal(self.row_of[ids], slots // self.width), "a key does not know its row"
        assert int((self.row_of >= 0).sum()) == self.size, "a deleted key still has a row"
        if self.size:
            real = self.real(np.arange(len(self.ids)))
            for columns in (self.numbers, self.marks, self.ids[None]):
                assert columns.tobytes() == columns[:, real].tobytes(), (
                    "a spare slot does not repeat its row's last key"
                )
            assert self.starts == self.times[:: self.width].tolist()


def _grown(row_of: NDArray[np.int32], key_id: int) -> NDArray[np.int32]:
    """The map with room for *key_id*."""
    if key_id < len(row_of):
        return row_of
    longer = np.full(max(key_id + 1, len(row_of) * 3 // 2), -1, np.int32)
    longer[: len(row_of)] = row_of
    return longer
