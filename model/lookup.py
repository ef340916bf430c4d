"""Finding the keys that many times follow: by bisection, by merging, or by a table of buckets of equal length."""

from math import inf
from struct import Struct, calcsize

import numpy as np
from numpy.typing import NDArray

from model.hermite import Floats
from model.rows import VALUE, A, B, C, Rows, Slots

# Times worked on together; their columns stay in the processor's cache.
AT_A_TIME = 8192
# A table is worth its making for at least this many times, and at least one for so many slots.
TABLE_TIMES = 4096
SLOTS_A_TIME = 4
DOUBLE = calcsize("d")


class Table:
    """For each of many buckets of time, the last key of the buckets before; stale once the keys change."""

    def __init__(self, rows: Rows) -> None:
        times = rows.times
        buckets = max(16, 2 * len(times))
        self.start = float(times[0])
        length = float(times[-1]) - self.start
        self.per_second = buckets / length if length else inf
        self.usable = 0.0 < self.per_second < inf
        if not self.usable:
            return
        with np.errstate(all="ignore"):
            counts = np.zeros(buckets + 2, np.int32)
            for at in range(0, len(times), AT_A_TIME):
                part = self._buckets(times[at : at + AT_A_TIME])
                first = int(part[0])
                found = np.bincount(part - first)
                counts[first : first + len(found)] += found.astype(np.int32)
        np.cumsum(counts, out=counts)
        # A bucket's own keys come after those of the buckets before it: move on by one bucket.
        self.last = np.empty_like(counts)
        self.last[0], self.last[1:] = 0, counts[:-1] - 1
        np.maximum(self.last, 0, out=self.last)

    def _buckets(self, times: Floats) -> NDArray[np.int64]:
        return ((times - self.start) * self.per_second).astype(np.int64)

    def slots(self, all_times: Floats, times: Floats) -> Slots:
        """The slot of the last key at or before each of *times*, which lie among *all_times* of the rows."""
        found: Slots = self.last.take(self._buckets(times), mode="clip").astype(np.int64)
        # Buckets grow with time however they are rounded, so the key is this one or one of the next few.
        found += all_times.take(found + 1, mode="clip") <= times
        found += all_times.take(found + 1, mode="clip") <= times
        behind = all_times.take(found + 1, mode="clip") <= times
        if behind.any():
            found[behind] = all_times.searchsorted(times[behind], "right") - 1
        return found


def span_struct(slots: int) -> Struct:
    """Reads (time0, time1, d, a, b, c) of one span, from its slot on, out of columns of so many slots.

    The columns lie one after the other. Skipping what is between two numbers costs nothing, so that this is as quick
    as reading records that would have to be laid out first.
    """
    parts, read = ["2d"], 2 * DOUBLE
    for column in (VALUE, A, B, C):
        start = column * slots * DOUBLE
        parts.append(f"{start - read}xd")
        read = start + DOUBLE
    return Struct("".join(parts))


def merged_slots(all_times: Floats, times: Floats) -> tuple[int, Slots]:
    """(s, counts): counts[i] of the sorted *times* follow the key of slot s + i; the keys are searched among them."""
    first = max(int(all_times.searchsorted(times[0], "right")) - 1, 0)
    stop = int(all_times.searchsorted(times[-1], "right"))
    cuts = times.searchsorted(all_times[first:stop], "left")
    cuts[0] = 0
    return first, np.diff(cuts, append=len(times))
