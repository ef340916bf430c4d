"""Lines: cubics as chains of points within a quarter of a pixel, and chains cut into dashes."""

from collections.abc import Sequence
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


class Line(NamedTuple):
    """A chain of points in pixels, and which span each begins a piece of; steps of a curve are upright pieces."""

    x: Floats
    y: Floats
    span: NDArray[np.intp]


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
    scale = -window.px_per_value
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        # In pixels from here on: where a span begins and how wide it is, then its cubic.
        table = np.stack(
            (
                window.x_from_time(spans.time0),
                (spans.time1 - spans.time0) * window.px_per_second,
                window.y_from_value(spans.d),
                spans.c * scale,
                spans.b * scale,
                spans.a * scale,
            )
        )
        if table[1].max() > window.width:
            table = _seen_part(table, window)
        n = _pieces(table, sideways)
        # A span ends where the next one begins, but for steps: there the line goes on upright.
        joined = np.abs(table[2:, :-1].sum(axis=0) - table[2, 1:]) < 0.01
        borders = np.cumsum(lengths)[:-1]
        joined[borders[(borders > 0) & (borders < len(n))] - 1] = False
        points = n + 1
        points[:-1] -= joined
        ends = np.cumsum(points)
        starts = ends - points
        which = np.repeat(np.arange(len(n)), points)
        u = (np.arange(ends[-1]) - starts[which]) / n[which]
        _set_extrema(u, table, n, starts)
        x0, wide, d, c, b, a = table[:, which]
        x, y = x0 + u * wide, d + u * (c + u * (b + u * a))
    near = y.min() >= -FAR and y.max() <= FAR and x.min() >= -FAR and x.max() <= FAR
    cuts = np.concatenate(([0], ends))[borders]
    lines = map(Line, *(np.split(column, cuts) for column in (x, y, which))) if len(many) > 1 else (Line(x, y, which),)
    return list(lines) if near else [kept_near(*line) for line in lines]


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


def _pieces(table: Floats, sideways: float) -> NDArray[np.intp]:
    """Into how many straight pieces each span is cut."""
    _, wide, _, _, b, a = table
    # A chord of a parabola leaves it by an eighth of the second derivative times its length squared; two points
    # moved onto extrema may stretch the piece between them to twice its length.
    bend = np.maximum(np.abs(b), np.abs(b + 3 * a))
    pieces = np.sqrt(bend * (1 / TOLERANCE))
    # However steep it is, a cubic leaves a piece that only rises or falls sideways, by 0.39 of its width at most.
    pieces = np.minimum(pieces, wide * (0.8 / sideways))
    if not pieces.max() <= MOST_PIECES:
        pieces = np.nan_to_num(pieces, nan=MOST_PIECES, posinf=MOST_PIECES)
    counts: NDArray[np.intp] = np.ceil(np.clip(pieces, 1, MOST_PIECES)).astype(np.intp)
    return counts


def _set_extrema(u: Floats, table: Floats, n: NDArray[np.intp], starts: NDArray[np.intp]) -> None:
    """Move the nearest inner point of each span onto each extremum; a span of one piece has none worth a point."""
    bent = np.flatnonzero(n > 1)
    if not len(bent):
        return
    a, b, c = 3 * table[5, bent], table[4, bent], table[3, bent]
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    q = -(b + np.copysign(root, b))
    for r in (q / a, c / q):
        hit = np.flatnonzero((r > 0) & (r < 1))
        if len(hit):
            pieces, place = n[bent[hit]], r[hit]
            at = np.clip(np.rint(place * pieces), 1, pieces - 1).astype(np.intp)
            u[starts[bent[hit]] + at] = place


def kept_near(x: Floats, y: Floats, span: NDArray[np.intp]) -> Line:
    """The chain cut where it leaves the pixels that Qt can paint; the slopes of what stays are kept."""
    y = np.clip(np.nan_to_num(y, nan=0.0), -HUGE, HUGE)
    for limit in (FAR, -FAR):
        at = np.flatnonzero((y[:-1] - limit) * (y[1:] - limit) < 0)
        if len(at):
            part = (limit - y[at]) / (y[at + 1] - y[at])
            x = np.insert(x, at + 1, x[at] + part * (x[at + 1] - x[at]))
            y = np.insert(y, at + 1, limit)
            span = np.insert(span, at + 1, span[at])
    return Line(np.clip(x, -FAR, FAR), np.clip(y, -FAR, FAR), span)


def dashes(line: Line, pattern: tuple[float, ...], top: float, bottom: float) -> Floats:
    """The drawn pieces (n, 4) of x0, y0, x1, y1 of a chain under a dash pattern (drawn, gap, ... in pixels).

    Each span begins the pattern anew, so that an edit moves no dash beside it. Only what lies between *top* and
    *bottom* is cut: a chain may be very long where nobody sees it.
    """
    x0, y0, x1, y1 = line.x[:-1], line.y[:-1], line.x[1:], line.y[1:]
    length = np.hypot(x1 - x0, y1 - y0)
    end = np.cumsum(length)
    first = np.searchsorted(line.span, line.span[:-1])
    start = end - length - np.concatenate(([0.0], end))[first]
    seen = np.flatnonzero((length > 0) & (np.maximum(y0, y1) >= top) & (np.minimum(y0, y1) <= bottom))
    x0, y0, start, length = x0[seen], y0[seen], start[seen], length[seen]
    across, down = (x1[seen] - x0) / length, (y1[seen] - y0) / length
    with np.errstate(divide="ignore", invalid="ignore"):
        edges = np.sort(np.stack(((top - y0) / down, (bottom - y0) / down)), axis=0)
    near = np.where(down, np.clip(edges[0], 0.0, length), 0.0)
    far = np.where(down, np.clip(edges[1], 0.0, length), length)
    return _cut(pattern, x0 - across * start, y0 - down * start, across, down, start + near, start + far)[0]


def straight_dashes(rays: Floats, dash: float, gap: float, anchor: float) -> list[Floats]:
    """As `dashes`, of each of the straight *rays* (n, 5): through x, y, falling by a slope, from column to column.

    The pattern is counted from x = *anchor*: a key that is set on the line moves no dash.
    """
    x, y, slope, low, high = rays.T
    stretch = np.hypot(1.0, slope)
    begin = low - (low - anchor) % ((dash + gap) / stretch)
    near, far = (low - begin) * stretch, (high - begin) * stretch
    pieces, ray = _cut((dash, gap), begin, y + (begin - x) * slope, 1 / stretch, slope / stretch, near, far)
    return np.split(pieces, np.searchsorted(ray, np.arange(1, len(rays))))


def _cut(
    pattern: tuple[float, ...], x: Floats, y: Floats, across: Floats, down: Floats, near: Floats, far: Floats
) -> tuple[Floats, NDArray[np.intp]]:
    """The drawn parts between distances *near* and *far* of the rays from x, y, and which ray each is of."""
    period = float(sum(pattern))
    turn = np.floor(near / period)
    count = np.maximum(np.floor(far / period) - turn + 1, 0).astype(np.intp)
    ray = np.repeat(np.arange(len(x)), count)
    begin = (turn[ray] + np.arange(len(ray)) - np.repeat(np.cumsum(count) - count, count)) * period
    pieces, owners = [], []
    offset = 0.0
    for drawn, gap in zip(pattern[::2], pattern[1::2], strict=True):
        s0 = np.maximum(begin + offset, near[ray])
        s1 = np.minimum(begin + offset + drawn, far[ray])
        some = np.flatnonzero(s0 < s1)
        of, s0, s1 = ray[some], s0[some], s1[some]
        ends = (x[of] + across[of] * s0, y[of] + down[of] * s0, x[of] + across[of] * s1, y[of] + down[of] * s1)
        pieces.append(np.stack(ends, axis=1))
        owners.append(of)
        offset += drawn + gap
    return np.concatenate(pieces), np.concatenate(owners)
