"""The ways to change keys of a channel alike that are shorter than splices; each gives the bits that splices give.

They begin at the start of a gesture, and are for one key that is only moved, for most of very many keys, or for many of
not very many that are only moved; where two keys come near to each other, splices must tell which one stays.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

from model import shifting, splicing
from model.extrapolation import Extrapolation
from model.hopping import hop
from model.keyframe import Run
from model.mapping import Mapping
from model.resorting import MOST_RESORTED, Resorting
from model.rewinding import Start
from model.rows import Rows

# Where a smaller share of very many keys changes, splices are quicker.
MOST = 0.6

# All keys of a channel, some of which are given.
type AllKeys = Callable[[Run], Run]


class Shifted(NamedTuple):
    """What was changed from t0 to t1; whether the keys are in the order they were; they and those among them.

    *before* is how these were, *after* how they are given; of very many it is all keys, and *after* is left out. A
    single key comes alone, with the times (*near*) of what depends on it where it is now.
    """

    t0: float
    t1: float
    same_order: bool
    before: Run
    after: Run | None
    near: tuple[float, float] | None = None


def shifted(
    rows: Rows,
    start: Start,
    before: Run,
    mapping: Mapping,
    slack: float,
    all_keys: AllKeys,
    pre: Extrapolation,
    post: Extrapolation,
) -> Shifted | None:
    """Change the keys *before*; None, and nothing has changed, where two come within *slack* s or splices are due."""
    move = mapping.move
    if len(before) == 1 and move is not None:
        hopped = hop(rows, before, move[0].amount, move[1].amount, slack, pre, post)
        return None if hopped is None else Shifted(hopped.t0, hopped.t1, not hopped.passed, before, None, hopped.near)
    after = None
    if _are_most(rows, before):
        rank0, rank1, same_order, chosen = 0, rows.size, not mapping.mirrored, before
        before = all_keys(chosen)
        old = splicing.outer(rows, 0, rows.size)
        if not shifting.shift(rows, start, before, chosen, mapping, slack):
            return None
    elif rows.size <= MOST_RESORTED and move is not None:
        if start.resorting is None or start.resorting.keys is not before:
            start.resorting = Resorting(rows, before)
        resorting = start.resorting
        resorted = resorting.moved(*move, slack)
        if resorted is None:
            return None
        rank0, rank1, order = resorted
        old = splicing.outer(rows, rank0, rank1)
        resorting.store(rows, start, order)
        before, same_order = resorting.run[rank0:rank1], order is None
        after = resorting.given(resorted)
    else:
        return None
    old_times = float(before["time"][0]), float(before["time"][-1])
    t0, t1 = splicing.reach(rows, rank0, rank1, old, old_times, pre, post)
    return Shifted(t0, t1, same_order, before, after)


def _are_most(rows: Rows, keys: Run) -> bool:
    """Whether *keys* are so many of very many that all are written anew."""
    return rows.many and len(keys) >= (MOST if rows.size > MOST_RESORTED else 1.0) * rows.size


def prepared(rows: Rows, start: Start, keys: Run, all_keys: AllKeys) -> Iterator[None]:
    """In steps, before the first change of these keys: what each begins with, where that takes as long as a change."""
    if _are_most(rows, keys):
        yield from shifting.prepared(rows, start, all_keys(keys))
    elif len(keys) > 1 and rows.size <= MOST_RESORTED:
        start.resorting = Resorting(rows, keys)
        yield
