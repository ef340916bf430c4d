"""What a channel means, worked out in rational numbers from the definitions alone: the judge of our evaluation.

Nothing here is shared with the model. `python -m tests.exact` writes tests/baselines/museum.json anew.
"""

import json
import sys
from bisect import bisect_right
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from math import floor, isfinite
from pathlib import Path
from typing import NamedTuple

BASELINES = Path(__file__).parent / "baselines" / "museum.json"
LARGEST = Fraction(sys.float_info.max)


class ExactKey(NamedTuple):
    """One key; its slopes count where the rule is fixed."""

    time: Fraction
    value: Fraction
    slope_in: Fraction
    slope_out: Fraction
    rule_in: str
    rule_out: str


def clamped(number: Fraction) -> Fraction:
    """The nearest number that a double can hold."""
    return max(-LARGEST, min(LARGEST, number))


def rounded(number: Fraction) -> float:
    """As a double; too large ones become the largest."""
    return float(clamped(number))


class ExactChannel:
    """A channel in rational numbers."""

    def __init__(self, keys: Sequence[ExactKey], pre: str, post: str) -> None:
        self.keys, self.pre, self.post = list(keys), pre, post
        self.times = [key.time for key in keys]
        self.slopes = [(self._slope(i, key.rule_in, 0), self._slope(i, key.rule_out, 1)) for i, key in enumerate(keys)]

    def _chord(self, i: int, j: int) -> Fraction:
        return clamped((self.keys[j].value - self.keys[i].value) / (self.keys[j].time - self.keys[i].time))

    def _slope(self, i: int, rule: str, side: int) -> Fraction:
        last = len(self.keys) - 1
        if rule == "fixed":
            return (self.keys[i].slope_in, self.keys[i].slope_out)[side]
        if rule in ("flat", "step") or last == 0:
            return Fraction(0)
        before = self._chord(i - 1, i) if i > 0 else self._chord(0, 1)
        after = self._chord(i, i + 1) if i < last else self._chord(last - 1, last)
        if rule == "linear":
            return after if side else before
        around = self._chord(max(i - 1, 0), min(i + 1, last))
        if rule == "smooth":
            return around
        assert rule == "auto", rule
        if before * after <= 0:
            return Fraction(0)
        limit = 3 * min(abs(before), abs(after))
        return max(-limit, min(limit, around))

    def inside(self, time: Fraction) -> Fraction:
        """The value at *time* among the keys."""
        i = bisect_right(self.times, time) - 1
        key = self.keys[i]
        if time == key.time or key.rule_out == "step":
            return key.value
        following = self.keys[i + 1]
        d_time = following.time - key.time
        u = (time - key.time) / d_time
        m0, m1 = d_time * self.slopes[i][1], d_time * self.slopes[i + 1][0]
        p0, p1 = key.value, following.value
        h00, h10 = (1 + 2 * u) * (1 - u) ** 2, u * (1 - u) ** 2
        h01, h11 = u * u * (3 - 2 * u), u * u * (u - 1)
        return h00 * p0 + h10 * m0 + h01 * p1 + h11 * m1

    def folded(self, time: Fraction) -> tuple[Fraction, Fraction]:
        """(time among the keys, what to add to the value there); not for straight extrapolation."""
        first, last = self.keys[0], self.keys[-1]
        mode = self.pre if time < first.time else self.post
        if first.time <= time <= last.time or mode == "constant" or first is last:
            return max(first.time, min(last.time, time)), Fraction(0)
        period = last.time - first.time
        k = floor((time - first.time) / period)
        tau = time - k * period
        if mode == "bounce" and k % 2:
            tau = first.time + last.time - tau
        return tau, k * (last.value - first.value) if mode == "cycle_offset" else Fraction(0)

    def value(self, time: float) -> Fraction:
        """The exact value at *time*."""
        if not self.keys:
            return Fraction(0)
        exact, first, last = Fraction(time), self.keys[0], self.keys[-1]
        if exact < first.time and self.pre == "linear":
            return first.value + self.slopes[0][0] * (exact - first.time)
        if exact > last.time and self.post == "linear":
            return last.value + self.slopes[-1][1] * (exact - last.time)
        tau, shift = self.folded(exact)
        return self.inside(tau) + shift

    def clear_of_jumps(self, time: float) -> bool:
        """Whether rounding the way to *time* cannot carry it over a key: it is on one exactly, or well away."""
        if not self.keys:
            return True
        first, last = self.times[0], self.times[-1]
        exact = Fraction(time)
        if first <= exact <= last:
            return True
        tau, _ = self.folded(exact)
        near = max(abs(exact - first), last - first, abs(first), abs(last)) / 10**12
        # On a join or a key's image the way there is exact only if every number on it is.
        since = exact - first
        exact_way = all(Fraction(float(x)) == x for x in (since, tau, last - first, tau - first, last - tau))
        return all(abs(tau - t) > near or (tau == t and exact_way) for t in self.times)


def exact_channel(channel: object) -> ExactChannel:
    """The same channel in rational numbers, read key by key through its handles."""
    keys = [
        ExactKey(
            Fraction(key.time),
            Fraction(key.value),
            Fraction(key.slope_in),
            Fraction(key.slope_out),
            key.rule_in.word,
            key.rule_out.word,
        )
        for key in channel  # type: ignore[attr-defined]
    ]
    return ExactChannel(keys, channel.pre.word, channel.post.word)  # type: ignore[attr-defined]


def scale_of(channel: ExactChannel) -> float:
    """The size of the numbers that values of the channel are sums of: the unit of its rounding errors."""
    sizes = [abs(key.value) for key in channel.keys]
    for i in range(len(channel.keys) - 1):
        d_time = channel.times[i + 1] - channel.times[i]
        if channel.keys[i].rule_out != "step":
            sizes += [abs(d_time * channel.slopes[i][1]), abs(d_time * channel.slopes[i + 1][0])]
    return rounded(max(sizes, default=Fraction(0)))


def sample_times(channel: ExactChannel) -> list[float]:
    """Times that show the channel: every key, inside every span (of long channels: of some), and beyond both ends."""
    keys = [float(t) for t in channel.times]
    step = max(1, len(keys) // 12)
    times = {*keys[::step], *keys[-1:]}
    for t0, t1 in list(pairwise(keys))[::step]:
        times |= {t0 + (t1 - t0) * share for share in (0.01, 0.37, 0.5, 0.93)}
    if keys:
        period = (keys[-1] - keys[0]) or 1.0
        for share in (0.001, 0.21, 0.5, 0.77, 1.0, 1.43, 2.0, 2.9, 3.0, 17.31):
            times |= {keys[0] - share * period, keys[-1] + share * period}
    return sorted(time for time in times if isfinite(time) and channel.clear_of_jumps(time))


def museum_samples() -> dict[str, list[list[str]]]:
    """Times and exact values of every channel of the museum, as shortest decimal numbers."""
    from tests.museum import museum

    found = {}
    for name, channel in museum().items():
        exact = exact_channel(channel)
        found[name] = [[repr(time), repr(rounded(exact.value(time)))] for time in sample_times(exact)]
    return found


if __name__ == "__main__":
    lines = [
        f"{json.dumps(name)}: [\n" + ",\n".join(json.dumps(pair) for pair in pairs) + "\n]"
        for name, pairs in museum_samples().items()
    ]
    BASELINES.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
