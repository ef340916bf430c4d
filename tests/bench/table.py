"""The table that the benchmarks fill: a figure of ours, the figure it is held against, and the bound."""

import gc
import math
from collections.abc import Callable, Mapping
from time import perf_counter
from typing import NamedTuple

import numpy as np


class Line(NamedTuple):
    """One figure; times in seconds. The bound is on ours / peer, on ours itself, or both; None: only told."""

    work: str
    ours: float
    peer: str = ""
    other: float = math.nan
    most_ratio: float | None = None
    most: float | None = None
    note: str = ""

    @property
    def ratio(self) -> float:
        """Ours in units of the peer's."""
        return self.ours / self.other

    @property
    def reached(self) -> bool | None:
        """Whether every bound holds; None where there is none."""
        if self.most_ratio is None and self.most is None:
            return None
        below_ratio = self.most_ratio is None or self.ratio <= self.most_ratio
        return below_ratio and (self.most is None or self.ours <= self.most)


class Times(NamedTuple):
    """How long a piece of work took in its rounds: seconds."""

    median: float
    p99: float
    least: float


def timed(work: Mapping[str, Callable[[], object]], rounds: int, inner: int = 1) -> dict[str, Times]:
    """Time pieces of work in turn, round by round, so that a machine that drifts drifts for all of them."""
    taken: dict[str, list[float]] = {name: [] for name in work}
    for function in work.values():
        function()
    gc.collect()
    gc.disable()
    try:
        for _ in range(rounds):
            for name, function in work.items():
                start = perf_counter()
                for _ in range(inner):
                    function()
                taken[name].append((perf_counter() - start) / inner)
    finally:
        gc.enable()
    return {name: summed_up(seconds) for name, seconds in taken.items()}


def summed_up(seconds: list[float]) -> Times:
    """Median, 99th percentile and least of some durations."""
    return Times(float(np.median(seconds)), float(np.percentile(seconds, 99)), min(seconds))


def duration(seconds: float) -> str:
    """A duration with three digits and its unit."""
    if math.isnan(seconds):
        return ""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def bound(line: Line) -> str:
    """The bound in words."""
    parts = []
    if line.most_ratio is not None:
        parts.append(f"<= {line.most_ratio:g} of it")
    if line.most is not None:
        parts.append(f"<= {duration(line.most)}")
    return ", ".join(parts)


def rows_of(lines: list[Line]) -> list[tuple[str, ...]]:
    """The cells of the table, its head first."""
    rows = [("work", "ours", "held against", "theirs", "ratio", "to reach", "")]
    for line in lines:
        ratio = "" if math.isnan(line.other) else f"{line.ratio:.2f}"
        verdict = {True: "yes", False: "NO", None: ""}[line.reached]
        work = f"{line.work} ({line.note})" if line.note else line.work
        rows.append((work, duration(line.ours), line.peer, duration(line.other), ratio, bound(line), verdict))
    return rows


def as_text(lines: list[Line]) -> str:
    """The table for a terminal."""
    rows = rows_of(lines)
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
    )


def as_markdown(lines: list[Line]) -> str:
    """The table for a page."""
    head, *body = rows_of(lines)
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, tuple("---" for _ in head), *body])
