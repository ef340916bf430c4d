"""Shifting: all keys of a channel changed alike, from those of a gesture's start straight into rows of the same shape.

Columns are read once, and what follows from them is worked out while they are in the processor's cache. Whatever is
unusual is left to a splice, which gives the same numbers.
"""

from collections.abc import Iterator
from math import inf, isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.blocks import Block
from model.hermite import Floats
from model.keyframe import Run, TangentRule
from model.likeness import Extent, Likeness
from model.mapping import Mapping, mirrored
from model.rewinding import NO_COLUMNS, Start
from model.rows import (
    D_TIME,
    MARK_FIELDS,
    NUMBER_FIELDS,
    RULE_IN,
    RULE_OUT,
    SLOPE_IN,
    SLOPE_OUT,
    TIME,
    VALUE,
    A,
    B,
    C,
    Rows,
)
from model.tangents import Marks, slope_between, slopes_of


def shift(rows: Rows, start: Start, keys: Run, chosen: Run, mapping: Mapping, slack: float) -> bool:
    """Change the *chosen* ones of *keys*, which are all those of the start of a gesture.

    False, and nothing has changed, if splices must do it, as where two keys come within *slack* seconds.
    """
    shifting = start.shifting = start.shifting or Shifting(rows, keys)
    others = shifting.others(chosen)
    if others is not None and mapping.mirrored:
        return False
    twins, same = start.twin_grids(rows), _same_columns(mapping)
    kept, start.spare_columns = start.spare_columns & same, NO_COLUMNS
    if not shifting.fill(rows, _Task(twins[0], mapping, slack, others, kept)):
        start.give_back(twins)
        return False
    start.spare_columns = same
    start.set_aside(rows, keys_move=mapping.mirrored)
    if mapping.mirrored:
        start.write_keys()
        twins[1][:], twins[2][:] = shifting.mirrored_keys(rows)
        rows.row_of[twins[2]] = np.arange(rows.rows, dtype=np.int32)[:, None]
    rows.minus_zero |= mapping.makes_minus_zero
    origin = rows.number_grid
    rows.take_over(twins, rows.first.copy(), twins[0][TIME, :, 0].tolist())
    rows.likeness = Likeness.of(origin, shifting.extent, mapping) if others is None else None
    return True


def prepared(rows: Rows, start: Start, keys: Run) -> Iterator[None]:
    """In steps, before the first change of *keys*, all those of the start: have at hand what each begins with.

    The memory too: to touch fresh one for the first time takes longer than to fill it.
    """
    start.shifting = Shifting(rows, keys)
    yield
    yield from start.shifting.reading(rows)
    twins = start.twin_grids(rows)
    yield
    for column, numbers in zip(twins[0], rows.number_grid, strict=True):
        column[:] = numbers
        yield
    start.give_back(twins)
    start.spare_columns = frozenset(range(len(twins[0])))
    yield from start.making_room(len(keys))


def _same_columns(mapping: Mapping) -> frozenset[int]:
    """The columns that stay as they are."""
    if mapping.mirrored:
        return NO_COLUMNS
    times = (TIME, D_TIME) if mapping.time.still else ()
    return frozenset((*times, VALUE) if mapping.value.still else times)


class _Task(NamedTuple):
    """What is to be done with all pieces."""

    numbers: Floats  # the grid to fill
    mapping: Mapping
    slack: float  # the seconds that two keys must be apart, and more
    others: NDArray[np.bool_] | None  # the keys that stay as they are, in columns as those of a side; None: none
    kept: frozenset[int]  # the columns that are filled already


class _Piece(NamedTuple):
    """Rows that hold equally many keys."""

    block: Block
    last: int  # how far behind the key before the last key of the channel lies
    smooth: bool  # whether all slopes that count are smooth ones


class _Side:
    """All keys in one order, in columns that repeat the first and the last key twice."""

    def __init__(self, run: Run) -> None:
        self.run = run
        self.numbers = np.empty((len(NUMBER_FIELDS), len(run) + 4))
        self.rules = np.empty((2, len(run) + 4), np.uint8)
        self.pieces: list[_Piece] = []

    def reading(self, rows: Rows) -> Iterator[None]:
        """Read the keys, column by column."""
        places, run = slice(2, -2), self.run
        for field, column in NUMBER_FIELDS:
            self.numbers[column, places] = run[field]
            yield
        self.rules[RULE_IN, places], self.rules[RULE_OUT, places] = run["rule_in"], run["rule_out"]
        for columns in (self.numbers, self.rules):
            columns[:, :2], columns[:, -2:] = columns[:, 2:3], columns[:, -3:-2]
        self.pieces = [self._piece(block) for block in rows.blocks(0, rows.size)]

    def _piece(self, block: Block) -> _Piece:
        begin, end = block.rank, block.rank + block.rows * block.held
        smooth = bool((self.rules[:, begin + 2 : end + 3] == TangentRule.SMOOTH).all())
        return _Piece(block, len(self.run) - block.rank, smooth)


class Shifting:
    """What is known of the keys of a start that are changed again and again, and memory to do it in."""

    def __init__(self, rows: Rows, keys: Run) -> None:
        self.keys = keys
        self._sides: dict[bool, _Side] = {}
        self._mirrored_keys: tuple[Marks, NDArray[np.int32]] | None = None
        most = max(block.rows * block.held for block in rows.blocks(0, rows.size))
        self._room = np.empty((6, most + 3))
        self.extent = Extent.of(keys)
        self._others: tuple[Run, NDArray[np.bool_]] | None = None

    def others(self, chosen: Run) -> NDArray[np.bool_] | None:
        """The keys that are not among those *chosen*, in columns as those of a side; None if there are none."""
        if len(chosen) == len(self.keys):
            return None
        if self._others is None or self._others[0] is not chosen:
            ids, changed = self.keys["id"], chosen["id"]
            flags = np.ones(int(max(ids.max(), changed.max())) + 1, np.bool_)
            flags[changed] = False
            others = np.pad(flags[ids], 2, constant_values=True)
            if np.count_nonzero(others) != len(ids) - len(changed) + 4:
                raise ValueError("the keys to change are not in the channel")
            self._others = chosen, others
        return self._others[1]

    def _side(self, rows: Rows, turned: bool) -> _Side:
        """The keys in the order that they were in, or the other way round."""
        if turned not in self._sides:
            side = self._sides[turned] = _Side(mirrored(self.keys) if turned else self.keys)
            for _ in side.reading(rows):
                pass
        return self._sides[turned]

    def reading(self, rows: Rows) -> Iterator[None]:
        """Read the keys in the order that they were in."""
        side = _Side(self.keys)
        yield from side.reading(rows)
        self._sides[False] = side

    def fill(self, rows: Rows, task: _Task) -> bool:
        """Fill a grid like that of *rows* with the keys as they become; False if splices must do it."""
        side = self._side(rows, task.mapping.mirrored)
        with np.errstate(all="ignore"):
            ends = side.numbers[TIME, [0, -1]]
            times = np.append(ends, task.mapping.time.to(ends))
            if not isfinite(times.max() - times.min()):
                return False
            return all(_fill_piece(task, piece, side, self._room) for piece in side.pieces)

    def mirrored_keys(self, rows: Rows) -> tuple[Marks, NDArray[np.int32]]:
        """Grids like those of *rows* of the marks and ids of the keys in reverse order."""
        if self._mirrored_keys is None:
            run = self._side(rows, True).run
            marks, ids = self._mirrored_keys = np.empty_like(rows.mark_grid), np.empty_like(rows.id_grid)
            for rank, row, count, _, _, held in rows.blocks(0, rows.size):
                here = run[rank : rank + count * held].reshape(count, held)
                for field, column in MARK_FIELDS:
                    marks[column, row : row + count, :held] = here[field]
                ids[row : row + count, :held] = here["id"]
                for grid in (marks, ids[None]):
                    grid[:, row : row + count, held:] = grid[:, row : row + count, held - 1 : held]
        return self._mirrored_keys


def _fill_piece(task: _Task, piece: _Piece, side: _Side, room: Floats) -> bool:
    numbers, mapping, slack, others, kept = task
    (rank, row, count, _, _, held), last, smooth = piece
    n, shape = count * held, (count, held)
    grid = numbers[:, row : row + count, :held]
    # The key before, those of the piece, and two keys after for the last span and the slope at its end.
    t, v = room[: VALUE + 1, : n + 3]
    here = slice(rank + 1, rank + n + 4)
    mapping.time.to(side.numbers[TIME, here], out=t)
    mapping.value.to(side.numbers[VALUE, here], out=v)
    if others is not None:
        np.copyto(room[: VALUE + 1, : n + 3], side.numbers[: VALUE + 1, here], where=others[here])
    if rank == 0:
        t[0] = -inf
    t[last + 1 :] = inf
    d_time, d_value, spare, slopes = room[2:, : n + 1]
    np.subtract(t[2 : n + 2], t[1 : n + 1], out=d_time[:n])
    if last == n:
        d_time[n - 1] = 1.0
    # The keys after count too: slopes come from them before their own piece is looked at.
    if not isfinite(v.sum()) or not d_time[:n].min() > slack or (last > n and not t[n + 2] - t[n + 1] > slack):
        return False
    if smooth:
        if not _smooth(t, v, rank, last, d_value, spare, slopes):
            return False
        slope_in = slope_out = slopes
    else:
        found = _by_rule(side, t, v, rank, last, mapping.slope, others)
        if found is None:
            return False
        slope_in, slope_out = found
    columns = {TIME: t[1:], VALUE: v[1:], SLOPE_IN: slope_in, SLOPE_OUT: slope_out, D_TIME: d_time}
    for column, part in columns.items():
        if column not in kept:
            lines, part_lines = numbers[column, row : row + count], part[:n].reshape(shape)
            lines[:, :held], lines[:, held:] = part_lines, part_lines[:, -1:]
    _fill_coefficients(grid, d_time, v, slope_in, slope_out, d_value, spare, shape)
    if not smooth:
        steps = side.rules[RULE_OUT, rank + 2 : rank + n + 2].reshape(shape) == TangentRule.STEP
        if steps.any():
            grid[A : C + 1, steps] = 0.0
    if last == n:
        grid[A : C + 1, -1, -1] = 0.0
    for lines in numbers[A : C + 1, row : row + count]:
        lines[:, held:] = lines[:, held - 1 : held]
    return True


def _smooth(t: Floats, v: Floats, rank: int, last: int, d_value: Floats, d_time: Floats, slopes: Floats) -> bool:
    """Fill *slopes* of smooth keys and the key after them; False if one is too steep for the short way."""
    np.subtract(v[2:], v[:-2], out=d_value)
    np.subtract(t[2:], t[:-2], out=d_time)
    np.divide(d_value, d_time, out=slopes)
    for end, place in ((rank == 0, 1), (last < len(slopes) + 1, last)):
        if end:
            other = 2 if place == 1 else place - 1
            pair = sorted((place, other))
            slopes[place - 1] = slope_between(*(float(x) for i in pair for x in (t[i], v[i])))
    return isfinite(slopes.sum())


def _by_rule(
    side: _Side, t: Floats, v: Floats, rank: int, last: int, factor: float, others: NDArray[np.bool_] | None
) -> tuple[Floats, Floats] | None:
    """(slopes in, slopes out) of keys by whatever rules, and of the key after them; None if one is unusually large."""
    begin, end = int(rank == 0), min(last + 1, len(t))
    here = slice(rank + 1 + begin, rank + 1 + end)
    given, rules = side.numbers[SLOPE_IN : SLOPE_OUT + 1, here], side.rules[:, here]
    if factor != 1.0:
        fixed = rules == TangentRule.FIXED
        if others is not None:
            fixed &= ~others[here]
        if fixed.any():
            given = np.where(fixed, given * factor, given)
            if not isfinite(given.sum()):
                return None
    slope_in, slope_out = slopes_of(t[begin:end], v[begin:end], *given, *rules)
    # Behind the last key anything will do.
    return np.append(slope_in[1 - begin :], 0.0), np.append(slope_out[1 - begin :], 0.0)


def _fill_coefficients(
    grid: Floats,
    d_time: Floats,
    v: Floats,
    slope_in: Floats,
    slope_out: Floats,
    d_value: Floats,
    spare: Floats,
    shape: tuple[int, int],
) -> None:
    """The same sums as hermite.coefficients, in the memory there is."""
    n = shape[0] * shape[1]
    d_time, d_value, spare, slope0, slope1 = d_time[:n], d_value[:n], spare[:n], slope_out[:n], slope_in[1 : n + 1]
    np.multiply(d_time.reshape(shape), slope0.reshape(shape), out=grid[C])
    np.subtract(v[2 : n + 2], v[1 : n + 1], out=d_value)
    twice = v[:n]
    np.add(slope0, slope1, out=spare)
    spare *= d_time
    np.multiply(d_value, 2.0, out=twice)
    np.subtract(spare.reshape(shape), twice.reshape(shape), out=grid[A])
    np.multiply(slope0, 2.0, out=spare)
    spare += slope1
    spare *= d_time
    d_value *= 3.0
    np.subtract(d_value.reshape(shape), spare.reshape(shape), out=grid[B])
