"""Block: keys in rows that hold equally many, so that numpy sees them as one rectangle."""

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from model.rows import Rows


class Block(NamedTuple):
    """Keys in the same places of neighbouring rows that hold equally many."""

    rank: int  # of its first key
    row: int
    rows: int
    place: int  # of its first key in the row; 0 if there is more than one row
    width: int  # keys of each row that belong to the block
    held: int  # keys that each of the rows holds


def blocks_of(rows: "Rows", rank0: int, rank1: int, most: int) -> list[Block]:
    """The keys of these ranks as blocks of at most so many rows."""
    if rank0 >= rank1:
        return []
    row, place = rows.place(rank0)
    held = rows.held(row)
    if place + rank1 - rank0 <= held:
        return [Block(rank0, row, 1, place, rank1 - rank0, held)]
    blocks: list[Block] = []
    if place:
        blocks.append(Block(rank0, row, 1, place, held - place, held))
        rank0, row = rank0 + held - place, row + 1
    last, end = rows.place(rank1 - 1)
    whole = last + 1 if end + 1 == rows.held(last) else last
    firsts = rows.first[row : whole + 1].tolist()
    begin, held = 0, firsts[1] - firsts[0] if whole > row else 0
    for at in range(1, len(firsts)):
        if at + 1 == len(firsts) or firsts[at + 1] - firsts[at] != held or at - begin == most:
            blocks.append(Block(firsts[begin], row + begin, at - begin, 0, held, held))
            begin, held = at, firsts[min(at + 1, len(firsts) - 1)] - firsts[at]
    if whole == last:
        blocks.append(Block(firsts[-1], last, 1, 0, end + 1, rows.held(last)))
    return blocks
