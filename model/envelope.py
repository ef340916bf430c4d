"""The exact range of a curve in each column of a picture."""

import numpy as np

from model import evaluation, hermite
from model.extrapolation import Ends, Extrapolation
from model.hermite import Floats
from model.rows import D_TIME, TIME, VALUE, A, B, C, Rows


def envelope(rows: Rows, ends: Ends, edges: Floats, pre: Extrapolation, post: Extrapolation) -> tuple[Floats, Floats]:
    """(lowest, highest) of the curve in each [edges[j], edges[j + 1]]."""
    values = evaluation.evaluated(rows, ends, edges, pre, post, None)
    low, high = np.minimum(values[:-1], values[1:]), np.maximum(values[:-1], values[1:])
    n = rows.numbers[:, rows.slots(np.arange(rows.size))]
    u0, u1 = hermite.extremum_places(n[A], n[B], n[C])
    times, heights = [n[TIME]], [n[VALUE]]
    for u in (u0, u1):
        there = np.flatnonzero(~np.isnan(u))
        times.append((n[TIME] + u * n[D_TIME])[there])
        heights.append(hermite.value(u, n[A], n[B], n[C], n[VALUE])[there])
    held = np.flatnonzero((n[A] == 0.0) & (n[B] == 0.0) & (n[C] == 0.0))[:-1]
    times.append(np.nextafter(n[TIME][held + 1], -np.inf))
    heights.append(n[VALUE][held])
    time, height = np.concatenate(times), np.concatenate(heights)
    column = edges.searchsorted(time, "right") - 1
    for side in (column, edges.searchsorted(time, "left") - 1):
        seen = (side >= 0) & (side < len(low))
        np.minimum.at(low, side[seen], height[seen])
        np.maximum.at(high, side[seen], height[seen])
    return low, high
