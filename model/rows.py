"""Rows: the keys of a channel as an unrolled doubly linked list that numpy can read as flat columns.

Rows of `width` slots lie one after the other and hold up to that many neighbouring keys each. The spare slots
at the end of a row repeat its last key, so that every flat column is sorted where the times are, and bisection,
Horner and reductions run on it without masks. Row r is linked to rows r - 1 and r + 1 by lying between them;
a key is linked to its neighbours by its place in the row. A key is inserted, removed or replaced by moving
numbers inside one row; a full row shares its keys out to rows near it. Nothing outside the channel knows rows.

Keys are addressed by rank (0 = first) or by slot (place in the flat columns). Rows hold numbers and know nothing
of rules: whoever stores keys here works out slopes and coefficients afterwards (model/splicing.py).
"""

from bisect import bisect_right
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from model.blocks import Block, blocks_of
from model.hermite import Floats
from model.keyframe import KEY_DTYPE, KeyGoneError, Run
from model.likeness import Likeness
from model.rewinding import Grids, Start

type Slots = NDArray[np.int64]

TIME, VALUE, SLOPE_IN, SLOPE_OUT, A, B, C, D_TIME = range(8)
RULE_IN, RULE_OUT, BROKEN = range(3)
NUMBER_FIELDS = (("time", TIME), ("value", VALUE), ("slope_in", SLOPE_IN), ("slope_out", SLOPE_OUT))
MARK_FIELDS = (("rule_in", RULE_IN), ("rule_out", RULE_OUT), ("broken", BROKEN))

WIDEST = 512
FILLED = 384
# The share of its slots that a group of rows may fill when it is shared out; a fuller channel gets new rows.
CROWDED = 0.85
# Rows handled at a time, so that their numbers stay in the processor's cache from one column to the next.
AT_A_TIME = 32
# As many steps of a drag ask for, which ask for the same ones again and again.
MOST_KNOWN = 32
# Where all keys of at least so many rows are replaced in a gesture, others are written rather than these copied.
MANY_ROWS = 64


class Rows:
    """The rows of one channel; `size` keys."""

    def __init__(self) -> None:
        self.row_of = np.full(16, -1, np.int32)  # by id; -1: no such key
        self.minus_zero = False  # whether some key may have had the value -0.0
        self.start: Start | None = None  # in a gesture: what is overwritten is kept there first
        self._make(0)

    def _make(self, n: int) -> None:
        """Make new rows for n keys and forget the old ones."""
        if n <= FILLED:
            width, rows = min(WIDEST, max(8, 1 << (n + n // 3).bit_length())), 1
        else:
            width, rows = WIDEST, -(-n // FILLED)
        self.size = n
        numbers = np.zeros((8, rows, width)) if n == 0 else np.empty((8, rows, width))
        marks, ids = np.zeros((3, rows, width), np.uint8), np.zeros((rows, width), np.int32)
        self.take_over((numbers, marks, ids), np.zeros(rows + 1, np.int64), [0.0] * rows)

    @property
    def grids(self) -> Grids:
        """Numbers, marks and ids by row and place."""
        return self.number_grid, self.mark_grid, self.id_grid

    def take_over(self, grids: Grids, first: NDArray[np.int64], starts: list[float]) -> None:
        """Hold the keys of these grids from now on."""
        self.number_grid, self.mark_grid, self.id_grid = grids
        self.rows: int = self.id_grid.shape[0]
        self.width: int = self.id_grid.shape[1]
        self.many = self.rows >= MANY_ROWS
        self.numbers = self.number_grid.reshape(8, -1)
        self.bits = self.numbers.view(np.int64)
        self.marks = self.mark_grid.reshape(3, -1)
        self.ids = self.id_grid.reshape(-1)
        self.times = self.numbers[TIME]
        self.first = first  # rank of each row's first key, and at the end the number of keys
        self.forget_places()
        self.starts = starts  # time of each row's first key
        self.likeness: Likeness | None = None  # how these rows come from others, while that is so
        self.dirty = set(range(self.rows))  # rows whose coefficients were written since somebody cleared this set

    # --- places

    def forget_places(self) -> None:
        """`first` has changed, and so has what was found from it."""
        if self.start is not None:
            self.start.ranks_moved = True
        self.row_known = (0, -1, 0)  # the ranks that the row found last begins with and ends before, and that row
        self.blocks_known: dict[tuple[int, int], list[Block]] = {}

    def place(self, rank: int) -> tuple[int, int]:
        """(row, place in it) of the key of that rank; rank = size gives the place behind the last key."""
        begin, end, row = self.row_known
        if not begin <= rank < end:
            row = min(int(self.first.searchsorted(rank, "right")) - 1, self.rows - 1)
            begin, end = self.first[row : row + 2].tolist()
            self.row_known = begin, end, row
        return row, rank - begin

    def slot(self, rank: int) -> int:
        """The slot of the key of that rank."""
        row, place = self.place(rank)
        return row * self.width + place

    def slots(self, ranks: Slots) -> Slots:
        """The slots of the keys of these ranks."""
        rows = self.first.searchsorted(ranks, "right") - 1
        return np.asarray(rows * self.width + (ranks - self.first[rows]), np.int64)

    def real(self, slots: Slots) -> Slots:
        """The slots of the keys that these slots hold or repeat."""
        rows = slots // self.width
        last: Slots = rows * self.width + (self.first[rows + 1] - self.first[rows] - 1)
        return np.minimum(slots, last)

    def ranks(self, slots: Slots) -> Slots:
        """The ranks of the keys that these slots hold or repeat."""
        rows = slots // self.width
        found: Slots = self.first[rows] + slots - rows * self.width
        return np.minimum(found, self.first[rows + 1] - 1)

    def held(self, row: int) -> int:
        """How many keys *row* holds."""
        return int(self.first[row + 1]) - int(self.first[row])

    def rank_of(self, key_id: int) -> int:
        """The rank of the key with this id; KeyGoneError if there is none."""
        row = int(self.row_of[key_id]) if 0 < key_id < len(self.row_of) else -1
        if row < 0:
            raise KeyGoneError(f"there is no key with id {key_id}")
        return int(self.first[row]) + int((self.id_grid[row] == key_id).argmax())

    def ranks_of(self, ids: NDArray[np.int64]) -> Slots:
        """The ranks of the keys with these ids, sorted, each once; KeyGoneError if one is gone."""
        known = (ids > 0) & (ids < len(self.row_of))
        rows = np.where(known, self.row_of[np.where(known, ids, 0)], -1)
        if (rows < 0).any():
            raise KeyGoneError(f"there is no key with id {ids[int((rows < 0).argmax())]}")
        if len(ids) < 8:
            return np.array(sorted({self.rank_of(key_id) for key_id in ids.tolist()}), np.int64)
        if len(ids) == self.size and bool((ids[1:] > ids[:-1]).all()):
            return np.arange(self.size)
        wanted = np.zeros(len(self.row_of), np.bool_)
        wanted[ids] = True
        touched = np.flatnonzero(np.bincount(rows))
        place = np.arange(self.width)
        chosen = wanted[self.id_grid[touched]] & (place < (self.first[touched + 1] - self.first[touched])[:, None])
        in_row, at = np.nonzero(chosen)
        return np.asarray(self.first[touched[in_row]] + at, np.int64)

    def rank_at(self, time: float, *, after: bool = True) -> int:
        """How many keys lie at or before *time* (before it only, if not *after*)."""
        if self.size == 0:
            return 0
        row = max(bisect_right(self.starts, time) - 1, 0)
        times = self.number_grid[TIME, row, : self.held(row)]
        return int(self.first[row]) + int(times.searchsorted(time, "right" if after else "left"))

    def blocks(self, rank0: int, rank1: int) -> list[Block]:
        """The keys of these ranks as blocks of at most AT_A_TIME rows."""
        begin, end, row = self.row_known
        if begin <= rank0 < rank1 <= end:
            return [Block(rank0, row, 1, rank0 - begin, rank1 - rank0, end - begin)]
        known = self.blocks_known.get((rank0, rank1))
        if known is None:
            if len(self.blocks_known) >= MOST_KNOWN:
                self.blocks_known.clear()
            known = self.blocks_known[rank0, rank1] = blocks_of(self, rank0, rank1, AT_A_TIME)
        return known

    def cuts(self, rank0: int, rank1: int) -> list[int]:
        """*rank0*, *rank1* (later), and between them the first ranks of rows that are AT_A_TIME rows apart."""
        row0, row1 = self.place(rank0)[0], self.place(rank1 - 1)[0]
        return [rank0, *self.first[row0 + AT_A_TIME : row1 + 1 : AT_A_TIME].tolist(), rank1]

    # --- reading and storing

    def columns(self, rank0: int, rank1: int, *, stop: int = D_TIME + 1, into: Floats | None = None) -> Floats:
        """Copies of the first *stop* columns of the keys of these ranks: (stop, n), *into* where there is room."""
        found = np.empty((stop, rank1 - rank0)) if into is None else into
        for rank, row, rows, place, count, _ in self.blocks(rank0, rank1):
            part = found[:, rank - rank0 : rank - rank0 + rows * count].reshape(stop, rows, count)
            part[:] = self.number_grid[:stop, row : row + rows, place : place + count]
        return found

    def few(self, rank0: int, rank1: int) -> tuple[list[list[float]], list[list[int]]]:
        """The columns up to the slopes, and the rules in and out, of the keys of these ranks as Python numbers."""
        row, place = self.place(rank0)
        end = place + rank1 - rank0
        if end > self.held(row):
            return self.columns(rank0, rank1, stop=A).tolist(), self.rules(rank0, rank1).tolist()
        return self.number_grid[:A, row, place:end].tolist(), self.mark_grid[:BROKEN, row, place:end].tolist()

    def rules(self, rank0: int, rank1: int) -> NDArray[np.uint8]:
        """Copies of the rules in and out of the keys of these ranks: (2, n)."""
        found = np.empty((2, rank1 - rank0), np.uint8)
        for rank, row, rows, place, count, _ in self.blocks(rank0, rank1):
            part = found[:, rank - rank0 : rank - rank0 + rows * count].reshape(2, rows, count)
            part[:] = self.mark_grid[:BROKEN, row : row + rows, place : place + count]
        return found

    def run(self, rank0: int, rank1: int, into: Run | None = None) -> Run:
        """The keys of these ranks, *into* which records if given."""
        run = np.empty(rank1 - rank0, KEY_DTYPE) if into is None else into
        for _ in self.reading(rank0, rank1, run):
            pass
        return run

    def reading(self, rank0: int, rank1: int, run: Run) -> Iterator[None]:
        """Read the keys of these ranks into the records *run*, in as many steps as there are blocks."""
        for rank, row, rows, place, count, _ in self.blocks(rank0, rank1):
            part = run[rank - rank0 : rank - rank0 + rows * count].reshape(rows, count)
            at = np.s_[row : row + rows, place : place + count]
            for field, column in NUMBER_FIELDS:
                part[field] = self.number_grid[column][at]
            for field, column in MARK_FIELDS:
                part[field] = self.mark_grid[column][at]
            part["id"] = self.id_grid[at]
            yield

    def ids_between(self, rank0: int, rank1: int) -> NDArray[np.int64]:
        """The ids of the keys of these ranks."""
        found = np.empty(rank1 - rank0, np.int64)
        for rank, row, rows, place, count, _ in self.blocks(rank0, rank1):
            part = found[rank - rank0 : rank - rank0 + rows * count].reshape(rows, count)
            part[:] = self.id_grid[row : row + rows, place : place + count]
        return found

    def same_ids(self, rank0: int, ids: NDArray[np.int64]) -> bool:
        """Whether the keys from rank0 on have exactly these *ids*; rank0 + len(ids) must not pass the last key."""
        for rank, row, rows, place, count, _ in self.blocks(rank0, rank0 + len(ids)):
            part = ids[rank - rank0 : rank - rank0 + rows * count].reshape(rows, count)
            if not (self.id_grid[row : row + rows, place : place + count] == part).all():
                return False
        return True

    def _store(self, rank0: int, run: Run, *, ids_too: bool = True, slopes_too: bool = True) -> None:
        """Write *run* over the keys from rank0 on; coefficients are left as they are."""
        fields = NUMBER_FIELDS if slopes_too else NUMBER_FIELDS[:SLOPE_IN]
        for rank, row, rows, place, count, held in self.blocks(rank0, rank0 + len(run)):
            self.keep(row, row + rows, place, self.width if place + count == held else place + count, keys_move=ids_too)
            part = run[rank - rank0 : rank - rank0 + rows * count].reshape(rows, count)
            at = np.s_[row : row + rows, place : place + count]
            for field, column in fields:
                self.number_grid[column][at] = part[field]
            for field, column in MARK_FIELDS:
                self.mark_grid[column][at] = part[field]
            if ids_too:
                self.id_grid[at] = part["id"]
                self._remember(self.id_grid[at], row)
            if place + count == held < self.width:
                # The columns that follow from rules are worked out next, and repeated as they are written.
                written = (self.number_grid[:SLOPE_IN], self.mark_grid, self.id_grid[None])
                for grid in written if ids_too else written[:2]:
                    grid[:, row : row + rows, held:] = grid[:, row : row + rows, held - 1 : held]
            if place == 0:
                self.starts[row : row + rows] = self.number_grid[TIME, row : row + rows, 0].tolist()

    def keep(self, row0: int, row1: int, place0: int, place1: int, *, keys_move: bool, marks_too: bool = True) -> None:
        """These places of the rows row0 to row1 are about to be written: numbers, marks, or keys as well."""
        self.likeness = None
        if self.start is not None:
            self.start.keep(self, row0, row1, place0, place1, keys_move=keys_move, marks_too=marks_too)

    def _remember(self, ids: NDArray[np.int32], row: int) -> None:
        """Note that these keys, one line for each row, are in rows *row* and following."""
        highest = int(ids.max())
        if highest >= len(self.row_of):
            longer = np.full(max(highest + 1, len(self.row_of) * 5 // 4), -1, np.int32)
            longer[: len(self.row_of)] = self.row_of
            self.row_of = longer
        self.row_of[ids] = np.arange(row, row + len(ids), dtype=np.int32)[:, None]

    def _forget(self, rank0: int, rank1: int) -> None:
        """Note that the keys of these ranks are gone."""
        for _, row, rows, place, count, _ in self.blocks(rank0, rank1):
            self.row_of[self.id_grid[row : row + rows, place : place + count]] = -1

    def write(self, rank0: int, column0: int, numbers: Floats) -> None:
        """Write columns column0 and following of the keys from rank0 on; numbers: (columns, n)."""
        stop, n = column0 + len(numbers), numbers.shape[1]
        for rank, row, rows, place, count, held in self.blocks(rank0, rank0 + n):
            end = self.width if place + count == held else place + count
            self.keep(row, row + rows, place, end, keys_move=False, marks_too=False)
            grid = self.number_grid[column0:stop, row : row + rows]
            part = numbers[:, rank - rank0 : rank - rank0 + rows * count]
            grid[:, :, place : place + count] = part.reshape(len(numbers), rows, count)
            if place + count == held < self.width:
                grid[:, :, held:] = grid[:, :, held - 1 : held]
            self.dirty.update(range(row, row + rows))

    # --- replacing

    def replace(self, rank0: int, rank1: int, run: Run, *, same_ids: bool, slopes_too: bool = True) -> tuple[int, int]:
        """Put *run* in the place of the keys of ranks rank0 to rank1 (which may be none).

        *same_ids* says that both have the same ids in the same order, *slopes_too* that slopes count which *run* gives.
        Gives the ranks of all keys whose coefficients
        must be worked out anew because they are new or have moved.
        """
        gone, come = rank1 - rank0, len(run)
        if gone == come:
            if self.start is not None and come == self.size and self.many:
                self._write_elsewhere(self.start, keys_move=not same_ids)
            if not same_ids:
                self._forget(rank0, rank1)
            self._store(rank0, run, ids_too=not same_ids, slopes_too=slopes_too)
            return rank0, rank0 + come
        row, place = self.place(rank0)
        held = self.held(row)
        roomy = self.rows > 1 and 8 * (self.size + come - gone) < len(self.ids)
        if place + gone <= held and 0 < held + come - gone <= self.width and not roomy:
            self._forget(rank0, rank1)
            self.make_room(row, place, gone, come)
            self._store(rank0, run)
            return rank0, rank0 + come
        return self._share_out(rank0, rank1, run)

    def _write_elsewhere(self, start: Start, *, keys_move: bool) -> None:
        """Set all rows aside and take others of the same shape, all of whose numbers and marks are to be written."""
        start.set_aside(self, keys_move=keys_move)
        numbers, marks = start.spare_grids(self)
        self.take_over((numbers, marks, self.id_grid.copy()), self.first.copy(), self.starts.copy())

    def make_room(self, row: int, place: int, gone: int, come: int) -> None:
        """Move what follows in the row, so that *come* keys have room where *gone* were."""
        self.keep(row, row + 1, 0, self.width, keys_move=True)
        held = self.held(row)
        new_held = held + come - gone
        tail_stays = place + come < new_held
        for grid in (self.number_grid, self.mark_grid, self.id_grid[None]):
            line = grid[:, row]
            if tail_stays:
                line[:, place + come : new_held] = line[:, place + gone : held]
            # The slots that fall free repeat the last key; the spare ones do so already, if it stays the last.
            if new_held < held and (tail_stays or come == 0):
                line[:, new_held : held if tail_stays else self.width] = line[:, new_held - 1 : new_held]
        self.first[row + 1 :] += come - gone
        self.forget_places()
        self.size += come - gone
        if place == 0 and come == 0:
            self.starts[row] = float(self.number_grid[TIME, row, 0])

    def _share_out(self, rank0: int, rank1: int, run: Run) -> tuple[int, int]:
        """Replace, and fill as many rows around as it takes evenly; make new rows if they are too full or too empty."""
        new_size = self.size - (rank1 - rank0) + len(run)
        row0 = self.place(rank0)[0]
        row1 = self.place(rank1 - 1)[0] + 1 if rank1 > rank0 else row0 + 1
        row0, row1, step = max(0, row0 - 1), min(self.rows, row1 + 1), 2
        if 8 * new_size < len(self.ids):
            row0, row1 = 0, self.rows
        while True:
            held = int(self.first[row1] - self.first[row0]) - (rank1 - rank0) + len(run)
            if (row1 - row0) * self.width // 8 <= held <= CROWDED * (row1 - row0) * self.width:
                break
            if row1 - row0 == self.rows:
                row0, row1 = 0, 0
                break
            row0, row1, step = max(0, row0 - step), min(self.rows, row1 + step), 2 * step
        everything = row0 == row1
        base, stop = (0, self.size) if everything else (int(self.first[row0]), int(self.first[row1]))
        shared = run
        if base < rank0 or rank1 < stop:
            # Joining records by numpy's own means compares their fields one by one, each time.
            shared = np.empty(stop - base - (rank1 - rank0) + len(run), KEY_DTYPE)
            head = rank0 - base
            shared[:head], shared[head + len(run) :] = self.run(base, rank0), self.run(rank1, stop)
            shared[head : head + len(run)] = run
        self._forget(rank0, rank1)
        if everything:
            if self.start is not None:
                self.start.set_aside(self, keys_move=True)
            self._make(new_size)
            row1 = self.rows
        self.size = new_size
        self.forget_places()
        self.first[row1 + 1 :] += base + len(shared) - stop
        each, more = divmod(len(shared), row1 - row0)
        self.first[row0 + 1 : row1 + 1] = base + np.cumsum(np.repeat([each + 1, each], [more, row1 - row0 - more]))
        self._store(base, shared)
        return base, base + len(shared)
