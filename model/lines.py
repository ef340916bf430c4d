"""Lines: cubics as chains of points within a quarter of a pixel, and chains cut into dashes."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.channel import Spans
from model.sampling import FAR, Window

type Floats = NDArray[np.float64]

# No line may leave the true cubic by more pixels than this.
TOLERANCE = 0.25
# Beyond this the arithmetic of crossings overflows, and every line is upright anyway.
HUGE = 1e30
MOST_PIECES = 4096
# A line that falls by so many pixels in one is upright, and what is far beside it says nothing of its height.
STEEP = 1e6


class Line(NamedTuple):
    """A chain of points in pixels, and how many of them each span has; steps of a curve are upright pieces."""

    x: Floats
    y: Floats
    counts: NDArray[np.intp]


def line_through(spans: Spans, window: Window, sideways: float = TOLERANCE) -> Line:
    """The spans as one chain of points within a quarter of a pixel of the true cubics, keys and extrema exact.

    Where it is steep it may be *sideways* pixels off instead. Its points depend on each span and on the window alone,
    so that a part drawn again meets the rest pixel by pixel.
    """
    return lines_through((spans,), window, sideways)[0]


def lines_through(many: Sequence[Spans], window: Window, sideways: float = TOLERANCE) -> list[Line]:
    """A chain as of `line_through` for each of *many*, worked out together: half the work of a chain is fixed."""
    lengths = [len(spans.time0) for spans in many]
    if not any(lengths):
        return [Line(np.empty(0), np.empty(0), np.empty(0, np.intp)) for _ in many]
    spans = many[0] if len(many) == 1 else Spans(*map(np.concatenate, zip(*many, strict=True)))
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        table = _in_pixels(spans, window)
        n, turning = _pieces(table, sideways)
        borders = np.cumsum(lengths)[:-1] if len(many) > 1 else None
        open_ends = _open_ends(table, borders)
        points = n + open_ends
        ends = points.cumsum()
        starts = ends - points
        x, y = np.empty((2, int(ends[-1])))
        x[starts], y[starts] = table[0], table[2]
        (some,) = open_ends.nonzero()
        x[ends[some] - 1], y[ends[some] - 1] = _at(table.take(some, axis=1), 1.0)
        inside, which, u = _inner(table, n, turning, starts)
        x[inside], y[inside] = _at(table.take(which, axis=1), u)
    near = bool(y.min() >= -FAR and y.max() <= FAR and x.min() >= -FAR and x.max() <= FAR)
    if borders is None:
        lines = [Line(x, y, points)]
    else:
        cuts = [(0, 0), *zip(borders.tolist(), np.append(0, ends)[borders].tolist(), strict=True), (len(n), len(x))]
        lines = [Line(x[i:j], y[i:j], points[k:m]) for (k, i), (m, j) in pairwise(cuts)]
    return lines if near else [kept_near(*line) for line in lines]


def _in_pixels(spans: Spans, window: Window) -> Floats:
    """(6, n): where a span begins and how wide it is, then its cubic d, c, b, a, all in pixels."""
    per_second, scale = window.px_per_second, -window.px_per_value
    table = np.empty((6, len(spans.time0)))
    x0, wide, d, c, b, a = table
    np.subtract(spans.time0, window.t0, out=x0)
    x0 *= per_second
    x0 += window.left
    np.subtract(spans.time1, spans.time0, out=wide)
    wide *= per_second
    np.subtract(spans.d, window.v1, out=d)
    d *= scale
    d += window.top
    np.multiply(spans.c, scale, out=c)
    np.multiply(spans.b, scale, out=b)
    np.multiply(spans.a, scale, out=a)
    return _seen_part(table, window) if wide.max() > window.width else table


def _open_ends(table: Floats, borders: NDArray[np.intp] | None) -> NDArray[np.bool_]:
    """Whether a span ends where no next one begins: at the end of a chain, and at steps, where it goes on upright."""
    found = np.ones(table.shape[1], np.bool_)
    _, _, d, c, b, a = table
    end = d[:-1] + c[:-1]
    end += b[:-1]
    end += a[:-1]
    end -= d[1:]
    np.abs(end, out=end)
    np.less(end, 0.01, out=found[:-1])
    np.logical_not(found[:-1], out=found[:-1])
    if borders is not None:
        found[borders[borders > 0] - 1] = True
    return found


def _seen_part(table: Floats, window: Window) -> Floats:
    """Spans wider than the window cut down to what is seen of them: pieces that nobody sees would take them all."""
    x0, wide, d, c, b, a = table
    margin = 64.0 * window.unit
    cut = wide > window.width
    u0 = np.where(cut, np.clip((window.left - margin - x0) / wide, 0.0, 1.0), 0.0)
    u1 = np.where(cut, np.clip((window.right + margin - x0) / wide, 0.0, 1.0), 1.0)
    part = u1 - u0
    return np.stack(
        (
            x0 + u0 * wide,
            part * wide,
            d + u0 * (c + u0 * (b + u0 * a)),
            part * (c + u0 * (2 * b + u0 * (3 * a))),
            part * part * (b + u0 * (3 * a)),
            part * part * part * a,
        )
    )


def _pieces(table: Floats, sideways: float) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Into how many straight pieces each span is cut, and whether it may turn between its ends."""
    wide, c, b, a = table[1], table[3], table[4], table[5]
    cubic = 3 * a
    bend = cubic + b
    rise = c + b
    rise += bend
    rise *= c
    cubic *= c
    # The slope is 0 between the ends if it changes sides, or twice if it bends back and reaches 0 between: for that it
    # must first come nearer to 0, so that the third derivative has the slope's sign.
    turning = ~(rise > 0.0)
    twice = ~turning
    twice &= (cubic > 0.0) & ((b < 0.0) != (bend < 0.0)) & ~(b * b < cubic)
    turning |= twice
    # A chord leaves a cubic by an eighth of the second derivative times its length squared.
    np.abs(bend, out=bend)
    np.maximum(bend, np.abs(b), out=bend)
    bend *= 1 / (4 * TOLERANCE)
    pieces = np.sqrt(bend, out=bend)
    # However steep it is, a cubic leaves a piece that only rises or falls sideways, by 0.39 of its width at most.
    most = wide * (0.4 / sideways)
    # Two points moved onto extrema may stretch the piece between them to twice its length.
    turning &= pieces > 1.0
    stretch = turning + 1.0
    pieces *= stretch
    most *= stretch
    stretch -= 1.0
    stretch *= 2.0
    stretch += twice
    np.maximum(most, stretch, out=most)
    np.minimum(pieces, most, out=pieces)
    if not pieces.max() <= MOST_PIECES:
        pieces = np.minimum(np.nan_to_num(pieces, nan=MOST_PIECES, posinf=MOST_PIECES), MOST_PIECES)
    np.ceil(pieces, out=pieces)
    np.maximum(pieces, 1.0, out=pieces)
    return pieces.astype(np.intp), turning


def _at(table: Floats, u: Floats | float) -> tuple[Floats, Floats]:
    """The points of spans at *u* from 0 to 1."""
    x0, x, d, c, b, y = table
    for factor in (b, c, d):
        y *= u
        y += factor
    x *= u
    x += x0
    return x, y


def _inner(
    table: Floats, n: NDArray[np.intp], turning: NDArray[np.bool_], starts: NDArray[np.intp]
) -> tuple[NDArray[np.intp], NDArray[np.intp], Floats]:
    """The points between the pieces of each span: their places in the chain, their spans and where in these."""
    (some,) = (n > 1).nonzero()
    n = n.take(some)
    inner = n - 1
    first = inner.cumsum()
    first -= inner
    which = some.repeat(inner)
    place = np.arange(1, len(which) + 1)
    place -= first.repeat(inner)
    u: Floats = place / n.repeat(inner)
    place += starts.take(which)
    (bent,) = turning.take(some).nonzero()
    if len(bent):
        _set_extrema(u, table[3:].take(some.take(bent), axis=1), n.take(bent), first.take(bent))
    return place, which, u


def _set_extrema(u: Floats, cba: Floats, n: NDArray[np.intp], first: NDArray[np.intp]) -> None:
    """Move the nearest inner point of each of some spans onto each extremum; their points begin at *first*."""
    c, b, a = cba
    a *= 3
    root = b * b
    root -= a * c
    np.maximum(root, 0.0, out=root)
    np.sqrt(root, out=root)
    q = np.copysign(root, b, out=root)
    q += b
    np.negative(q, out=q)
    places = np.empty((2, len(n)))
    np.divide(q, a, out=places[0])
    np.divide(c, q, out=places[1])
    inside = places > 0.0
    inside &= places < 1.0
    (both,) = (inside[0] & inside[1]).nonzero()
    pairs = places.take(both, axis=1), n.take(both) - 1, first.take(both)
    (some,) = inside.reshape(-1).nonzero()
    place = places.reshape(-1).take(some)
    n, first = n.take(some, mode="wrap"), first.take(some, mode="wrap")
    at = np.rint(place * n).astype(np.intp)
    n -= 1
    np.minimum(at, n, out=at)
    np.maximum(at, 1, out=at)
    at += first
    at -= 1
    u[at] = place
    if len(both):
        _part(u, *pairs)


def _part(u: Floats, places: Floats, most: NDArray[np.intp], first: NDArray[np.intp]) -> None:
    """Give both extrema (2, n) of each of some spans a point of their own, of the points 1 to *most* inside it."""
    ordered = np.empty_like(places)
    np.minimum(places[0], places[1], out=ordered[0])
    np.maximum(places[0], places[1], out=ordered[1])
    at = np.rint(ordered * (most + 1)).astype(np.intp)
    np.minimum(at, most, out=at)
    np.maximum(at, 1, out=at)
    earlier, later = at
    same = earlier == later
    room = later < most
    later += same & room
    earlier -= same & ~room & (earlier > 1)
    at += first - 1
    u[at] = ordered


def kept_near(x: Floats, y: Floats, counts: NDArray[np.intp]) -> Line:
    """The chain cut where it leaves the pixels that Qt can paint; the slopes of what stays are kept."""
    span = np.arange(len(counts)).repeat(counts)
    y = np.clip(np.nan_to_num(y, nan=0.0), -HUGE, HUGE)
    for limit in (FAR, -FAR):
        at = np.flatnonzero((y[:-1] - limit) * (y[1:] - limit) < 0)
        if len(at):
            part = (limit - y[at]) / (y[at + 1] - y[at])
            x = np.insert(x, at + 1, x[at] + part * (x[at + 1] - x[at]))
            y = np.insert(y, at + 1, limit)
            span = np.insert(span, at + 1, span[at])
    return Line(np.clip(x, -FAR, FAR), np.clip(y, -FAR, FAR), np.bincount(span, minlength=len(counts)))


def dashes(line: Line, pattern: tuple[float, ...], top: float, bottom: float) -> Floats:
    """The drawn pieces (n, 4) of x0, y0, x1, y1 of a chain under a dash pattern (drawn, gap, ... in pixels).

    Each span begins the pattern anew, so that an edit moves no dash beside it. Only what lies between *top* and
    *bottom* is cut: a chain may be very long where nobody sees it.
    """
    if not len(line.x):
        return np.empty((0, 4))
    x0, y0, x1, y1 = line.x[:-1], line.y[:-1], line.x[1:], line.y[1:]
    across, down = x1 - x0, y1 - y0
    length = np.hypot(across, down)
    end = length.cumsum()
    ends = np.empty(len(length) + 1)
    ends[0], ends[1:] = 0.0, end
    start = end - length
    firsts = line.counts.cumsum() - line.counts
    start -= ends.take(firsts.repeat(line.counts)[:-1])
    inside = bool(line.y.min() >= top and line.y.max() <= bottom)
    seen = length > 0
    if not inside:
        seen &= (np.maximum(y0, y1) >= top) & (np.minimum(y0, y1) <= bottom)
    if not seen.all():
        x0, y0, across, down = x0[seen], y0[seen], across[seen], down[seen]
        start, length = start[seen], length[seen]
    across /= length
    down /= length
    near, far = start, start + length
    if not inside:
        with np.errstate(divide="ignore", invalid="ignore"):
            edges = np.sort(np.stack(((top - y0) / down, (bottom - y0) / down)), axis=0)
        near = start + np.where(down, np.clip(edges[0], 0.0, length), 0.0)
        far = start + np.where(down, np.clip(edges[1], 0.0, length), length)
    return _cut(pattern, x0 - across * start, y0 - down * start, across, down, near, far)[0]


def straight_dashes(rays: Floats, dash: float, gap: float, anchor: float, left: float) -> list[Floats]:
    """As `dashes`, of each of the straight *rays* (n, 5): through x, y, falling by a slope, from column to column.

    The pattern is counted from x = *anchor*: a key that is set on the line moves no dash. It is worked out from
    x = *left* on, so that a dash has the same numbers, bit by bit, wherever a ray begins.
    """
    x, y, slope, low, high = rays.T
    stretch = np.hypot(1.0, slope)
    start = np.where(np.abs(slope) < STEEP, left, low)
    begin = start - (start - anchor) % ((dash + gap) / stretch)
    near, far = (low - begin) * stretch, (high - begin) * stretch
    pieces, ray = _cut((dash, gap), begin, y + (begin - x) * slope, 1 / stretch, slope / stretch, near, far)
    cuts = [*ray.searchsorted(np.arange(len(rays))).tolist(), len(pieces)]
    return [pieces[i:j] for i, j in pairwise(cuts)]


def _cut(
    pattern: tuple[float, ...], x: Floats, y: Floats, across: Floats, down: Floats, near: Floats, far: Floats
) -> tuple[Floats, NDArray[np.intp]]:
    """The drawn parts between distances *near* and *far* of the rays from x, y, and which ray each is of."""
    bounds = np.array((0.0, *pattern)).cumsum()
    period = float(bounds[-1])
    turn = np.floor(near / period)
    counts = np.floor(far / period)
    counts -= turn
    counts += 1
    count = np.maximum(counts, 0, out=counts).astype(np.intp)
    ray = np.arange(len(x)).repeat(count)
    # The first turn of each ray, less its number among all turns, which is added again at once.
    turn -= count.cumsum() - count
    begin = np.arange(float(len(ray)))
    begin += turn.take(ray)
    begin *= period
    s0 = np.maximum(np.add.outer(begin, bounds[:-1:2]), near.take(ray)[:, None])
    s1 = np.minimum(np.add.outer(begin, bounds[1::2]), far.take(ray)[:, None])
    of, part = (s0 < s1).nonzero()
    s0, s1, of = s0[of, part], s1[of, part], ray.take(of)
    pieces = np.empty((len(of), 4))
    x, y, across, down = x.take(of), y.take(of), across.take(of), down.take(of)
    for column, start, slope, s in ((0, x, across, s0), (1, y, down, s0), (2, x, across, s1), (3, y, down, s1)):
        np.add(start, slope * s, out=pieces[:, column])
    return pieces, of
