"""Shifting: all keys of a channel moved alike, from the rows of a gesture's start straight into rows of the same shape.

Columns are read once, and what follows from them is worked out while they are in the processor's cache. Whatever is
unusual is left to a splice, which gives the same numbers.
"""

from math import inf, isfinite
from typing import NamedTuple

import numpy as np

from model.blocks import Block
from model.hermite import Floats
from model.keyframe import TangentRule
from model.rewinding import Start
from model.rows import D_TIME, RULE_OUT, SLOPE_IN, SLOPE_OUT, TIME, VALUE, A, B, C, Rows
from model.tangents import slope_between, slopes_of


def shift(rows: Rows, start: Start, d_time: float, d_value: float) -> bool:
    """Move all keys of the start of a gesture; False, and nothing has changed, if that is left to a splice."""
    if start.shifting is None:
        start.shifting = Shifting(rows)
    twins = start.twin_grids(rows)
    if not start.shifting.fill(rows, twins[0], d_time, d_value):
        start.give_back(twins)
        return False
    start.set_aside(rows, keys_move=False)
    rows.take_over(twins, rows.first.copy(), twins[0][TIME, :, 0].tolist())
    return True


class _Piece(NamedTuple):
    """Rows that hold equally many keys, and what lies around them."""

    block: Block
    around: Floats  # (time, value) of the key before and of the two keys after: (2, 3)
    last: int  # how far behind the key before the last key of the channel lies
    smooth: bool  # whether all slopes that count are smooth ones


class Shifting:
    """What is known of the rows of a start that are shifted again and again, and memory to do it in."""

    def __init__(self, rows: Rows) -> None:
        blocks = rows.blocks(0, rows.size)
        self._pieces = [_piece(rows, block) for block in blocks]
        self._room = np.empty((6, max(block.rows * block.held for block in blocks) + 3))

    def fill(self, rows: Rows, numbers: Floats, d_time: float, d_value: float) -> bool:
        """Fill *numbers*, a grid like that of *rows*, with the keys moved by both; False if a splice must do it."""
        first, last = float(rows.times[0]) + d_time, float(rows.times[-1]) + d_time
        if not isfinite(last - first):
            return False
        # Adding -0.0 leaves every number as it is, 0.0 would turn -0.0 into 0.0.
        moves = np.array([[d_time or -0.0], [d_value or -0.0]])
        with np.errstate(all="ignore"):
            return all(_fill_piece(rows, numbers, piece, moves, self._room) for piece in self._pieces)


def _piece(rows: Rows, block: Block) -> _Piece:
    end = block.rank + block.rows * block.held
    around = rows.slots(np.clip([block.rank - 1, end, end + 1], 0, rows.size - 1))
    smooth = bool((rows.rules(block.rank, min(end + 1, rows.size)) == TangentRule.SMOOTH).all())
    return _Piece(block, rows.numbers[: VALUE + 1].take(around, axis=1), rows.size - block.rank, smooth)


def _fill_piece(rows: Rows, numbers: Floats, piece: _Piece, moves: Floats, room: Floats) -> bool:
    (rank, row, count, _, _, held), around, last, smooth = piece
    n, shape, here = count * held, (count, held), np.s_[row : row + count, :held]
    grid = numbers[:, *here]
    # The key before, those of the piece, and two keys after for the last span and the slope at its end.
    t, v = keys = room[: VALUE + 1, : n + 3]
    np.add(rows.number_grid[: VALUE + 1, *here], moves[:, :, None], out=keys[:, 1 : n + 1].reshape(2, *shape))
    keys[:, 0 :: n + 1], keys[:, n + 2] = (around + moves)[:, :2], (around + moves)[:, 2]
    if rank == 0:
        t[0] = -inf
    t[last + 1 :] = inf
    d_time, d_value, spare, slopes = room[2:, : n + 1]
    np.subtract(t[2 : n + 2], t[1 : n + 1], out=d_time[:n])
    if last == n:
        d_time[n - 1] = 1.0
    if not isfinite(v.sum()) or not d_time[:n].min() > 0.0:
        return False
    if smooth:
        if not _smooth(t, v, rank, last, d_value, spare, slopes):
            return False
        slope_in = slope_out = slopes
    else:
        slope_in, slope_out = _by_rule(rows, t, v, rank, last)
    grid[: VALUE + 1] = keys[:, 1 : n + 1].reshape(2, *shape)
    grid[SLOPE_IN], grid[SLOPE_OUT] = slope_in[:n].reshape(shape), slope_out[:n].reshape(shape)
    grid[D_TIME] = d_time[:n].reshape(shape)
    _fill_coefficients(grid, d_time, v, slope_in, slope_out, d_value, spare, shape)
    if not smooth:
        grid[A : C + 1, rows.mark_grid[RULE_OUT, *here] == TangentRule.STEP] = 0.0
    if last == n:
        grid[A : C + 1, -1, -1] = 0.0
    if held < rows.width:
        numbers[:, row : row + count, held:] = grid[:, :, -1:]
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


def _by_rule(rows: Rows, t: Floats, v: Floats, rank: int, last: int) -> tuple[Floats, Floats]:
    """(slopes in, slopes out) of keys by whatever rules, and of the key after them."""
    begin, end = int(rank == 0), min(last + 1, len(t))
    left = rank - 1
    _, _, given_in, given_out = rows.columns(left + begin, left + end, stop=SLOPE_OUT + 1)
    rules_in, rules_out = rows.rules(left + begin, left + end)
    slope_in, slope_out = slopes_of(t[begin:end], v[begin:end], given_in, given_out, rules_in, rules_out)
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
