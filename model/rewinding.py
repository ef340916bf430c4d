"""Start: the rows of a channel as they were before a gesture, so that each preview begins there without a splice."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.hermite import Floats
from model.keyframe import KEY_DTYPE, Run

if TYPE_CHECKING:
    from model.resorting import Resorting
    from model.rows import Rows
    from model.shifting import Shifting

type Grids = tuple[Floats, NDArray[np.uint8], NDArray[np.int32]]


NO_COLUMNS: frozenset[int] = frozenset()
# So much of fresh memory is touched in some milliseconds.
BYTES_A_STEP = 4 << 20
# Each preview asks for the selected keys and for those around them.
MOST_RUNS = 3


# Keys by their ids, or by the first rank and the one behind the last.
type Question = NDArray[np.int64] | tuple[int, int]


class Part(NamedTuple):
    """Copies of neighbouring rows, from row0 up to before row1."""

    row0: int
    row1: int
    numbers: Floats
    marks: NDArray[np.uint8]
    ids: NDArray[np.int32]


class Whole(NamedTuple):
    """All rows, set aside as they are: others have taken their place."""

    grids: Grids
    first: NDArray[np.int64]
    starts: list[float]


class Start:
    """What has been overwritten since it was made, row by row as it was then, coefficients included.

    Rows say what they are about to write; nothing is worked out anew on the way back.
    """

    def __init__(self, rows: "Rows") -> None:
        self._runs: list[tuple[Question, Run]] = []  # keys of the start, and how they were asked for
        self._first, self._size = rows.first.copy(), rows.size
        self._part_of = [-1] * rows.rows  # by row: which part holds it; -1: none
        self._parts: list[Part] = []
        # The parts whose rows differ from the start now, in which places of each row.
        self._written: dict[int, tuple[int, int]] = {}
        self._whole: Whole | None = None
        self._spare: Grids | None = None
        self._spare_keys = False  # whether marks and ids of the spare grids are those of the start
        # Which columns of the spare numbers are those of the start, by those who fill them.
        self.spare_columns = NO_COLUMNS
        self._keys_moved = False
        self._room: Run | None = None
        # What is worked out once of those rows, for keys that are moved again and again.
        self.shifting: Shifting | None = None
        self.resorting: Resorting | None = None
        self.ranks_moved = False  # whether rows hold other numbers of keys now

    @property
    def left(self) -> bool:
        """Whether the rows may differ from the start now."""
        return bool(self._written) or self._whole is not None

    def run_of(self, question: Question) -> Run | None:
        """The keys of the start that were asked for like this: by the very same ids, or by equal ranks."""
        for known, run in self._runs:
            if known is question or (isinstance(known, tuple) and isinstance(question, tuple) and known == question):
                return run
        return None

    def remember(self, question: Question, run: Run) -> None:
        """Have *run* at hand when it is asked for again; ids must be read-only."""
        self._runs = [*self._runs[1 - MOST_RUNS :], (question, run)]

    def holds(self, run: Run) -> bool:
        """Whether *run* is known to be keys of the start."""
        return any(known is run for _, known in self._runs)

    def keep(
        self, rows: "Rows", row0: int, row1: int, place0: int, place1: int, *, keys_move: bool, marks_too: bool
    ) -> None:
        """Make sure of places of the rows row0 to row1 (later), which will hold other numbers, marks or even keys."""
        self._keys_moved |= keys_move
        self._spare_keys &= not marks_too
        self.spare_columns = NO_COLUMNS
        if self._whole is not None:
            return
        at = row0
        while at < row1:
            part = self._part_of[at]
            if part < 0:
                end = at + 1
                while end < row1 and self._part_of[end] < 0:
                    end += 1
                part = self._copied(rows, at, end)
            begin, end = self._written.get(part, (place0, place1))
            self._written[part] = min(begin, place0), max(end, place1)
            at = self._parts[part].row1

    def _copied(self, rows: "Rows", row0: int, row1: int) -> int:
        part = len(self._parts)
        numbers, marks = rows.number_grid[:, row0:row1].copy(), rows.mark_grid[:, row0:row1].copy()
        self._parts.append(Part(row0, row1, numbers, marks, rows.id_grid[row0:row1].copy()))
        self._part_of[row0:row1] = [part] * (row1 - row0)
        return part

    def set_aside(self, rows: "Rows", *, keys_move: bool) -> None:
        """Other rows are about to take the place of these."""
        self._keys_moved |= keys_move
        if self._whole is None:
            self._whole = Whole(rows.grids, rows.first, rows.starts)

    def spare_grids(self, rows: "Rows") -> tuple[Floats, NDArray[np.uint8]]:
        """Grids of the shape of those of *rows* to be filled: those that the last preview left behind."""
        spare, self._spare = self._spare, None
        self.spare_columns = NO_COLUMNS
        if spare is not None and spare[0].shape == rows.number_grid.shape:
            return spare[0], spare[1]
        return np.empty_like(rows.number_grid), np.empty_like(rows.mark_grid)

    def twin_grids(self, rows: "Rows") -> Grids:
        """Grids with the marks and ids of *rows*, which must be as at the start, and numbers that are to be filled."""
        twins, self._spare = self._spare, None
        if twins is None or twins[0].shape != rows.number_grid.shape:
            twins = np.empty_like(rows.number_grid), rows.mark_grid.copy(), rows.id_grid.copy()
            self.spare_columns = NO_COLUMNS
        elif not self._spare_keys:
            twins[1][:], twins[2][:] = rows.mark_grid, rows.id_grid
        self._spare_keys = True
        return twins

    def making_room(self, count: int) -> Iterator[None]:
        """In steps: have memory at hand for so many keys, as the history will hold."""
        room = np.empty(count, KEY_DTYPE)
        every = room.view(np.uint8)
        for at in range(0, len(every), BYTES_A_STEP):
            every[at : at + BYTES_A_STEP] = 0
            yield
        self._room = room

    def room_for(self, count: int) -> Run | None:
        """Memory for so many keys, to be kept; None if there is none at hand."""
        if self._room is None or len(self._room) != count:
            return None
        room, self._room = self._room, None
        return room

    def write_keys(self) -> None:
        """Marks and ids of twin grids are about to be written."""
        self._spare_keys = False

    def give_back(self, twins: Grids) -> None:
        """Have twin grids again that have not been used."""
        self._spare = twins

    def restore(self, rows: "Rows") -> None:
        """Make *rows* what they were."""
        whole, keys_moved = self._whole, self._keys_moved
        stretches = [(self._parts[part], *places) for part, places in self._written.items()]
        if whole is not None:
            if keys_moved:
                rows.row_of[rows.id_grid] = -1
            self._spare = rows.grids
            rows.take_over(whole.grids, whole.first, whole.starts)
        elif keys_moved:
            for part, begin, end in stretches:
                rows.row_of[rows.id_grid[part.row0 : part.row1, begin:end]] = -1
        for part, begin, end in stretches:
            self._put_back(rows, part, begin, end, keys_moved=keys_moved)
        if keys_moved and whole is not None:
            rows.row_of[rows.id_grid] = np.arange(rows.rows, dtype=np.int32)[:, None]
        rows.row_of[0] = -1  # rows without keys hold id 0
        if self.ranks_moved:
            rows.first[:], rows.size = self._first, self._size
            rows.forget_places()
        self._written.clear()
        self._whole = None
        self._keys_moved = self.ranks_moved = False

    def _put_back(self, rows: "Rows", part: Part, begin: int, end: int, *, keys_moved: bool) -> None:
        here = np.s_[part.row0 : part.row1, begin:end]
        rows.number_grid[:, *here], rows.mark_grid[:, *here] = part.numbers[..., begin:end], part.marks[..., begin:end]
        if keys_moved:
            ids = part.ids[:, begin:end]
            rows.id_grid[here] = ids
            rows.row_of[ids] = np.arange(part.row0, part.row1, dtype=np.int32)[:, None]
        if begin == 0:
            rows.starts[part.row0 : part.row1] = part.numbers[0, :, 0].tolist()
        rows.dirty.update(range(part.row0, part.row1))
