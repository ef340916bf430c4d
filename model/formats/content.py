"""Content: what a file says of a clip, before channels are built from it and after they are read out."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.keyframe import Run, TangentRule

_FIXED = TangentRule.FIXED


@dataclass(frozen=True, slots=True)
class ChannelContent:
    """One channel as a file holds it; slopes count only on sides whose rule is fixed."""

    name: str
    run: Run
    pre: Extrapolation = Extrapolation.CONSTANT
    post: Extrapolation = Extrapolation.CONSTANT
    unit: str = ""
    color: str | None = None
    locked: bool = False


@dataclass(frozen=True, slots=True)
class Content:
    """One clip as a file holds it: range in seconds, frames per second."""

    start: float
    end: float
    channels: list[ChannelContent] = field(default_factory=list)
    frame_rate: float = 30.0
    title: str = ""

    @classmethod
    def of(cls, clip: Clip) -> "Content":
        """What *clip* holds now."""
        channels = [
            ChannelContent(c.name, c.run(), Extrapolation(c.pre), Extrapolation(c.post), c.unit, c.color, c.locked)
            for c in clip.channels
        ]
        return cls(float(clip.start), float(clip.end), channels, float(clip.frame_rate), clip.title)

    def clip(self) -> Clip:
        """A new clip with this content."""
        channels = [
            Channel(c.name, c.run, pre=c.pre, post=c.post, unit=c.unit, color=c.color, locked=c.locked)
            for c in self.channels
        ]
        return Clip(channels, start=self.start, end=self.end, frame_rate=self.frame_rate, title=self.title)

    def named(self, names: list[str], units: list[str]) -> "Content":
        """The same with other names and units, one a channel."""
        channels = [
            replace(channel, name=name, unit=unit)
            for channel, name, unit in zip(self.channels, names, units, strict=True)
        ]
        return replace(self, channels=channels)


def differences(wanted: Content, held: Content) -> list[str]:
    """What *held* has lost of *wanted*, one sentence a kind of loss; empty when they are the same bit for bit."""
    if len(wanted.channels) != len(held.channels):
        return [f"{len(wanted.channels)} channels become {len(held.channels)}"]
    return list(_differences(wanted, held))


def _differences(wanted: Content, held: Content) -> Iterator[str]:
    if wanted.title != held.title:
        yield f"the title {wanted.title!r} is lost"
    if not _same_number(wanted.frame_rate, held.frame_rate):
        yield f"the frame rate becomes {held.frame_rate:g} instead of {wanted.frame_rate:g}"
    if not (_same_number(wanted.start, held.start) and _same_number(wanted.end, held.end)):
        yield f"the range becomes {held.start!r} to {held.end!r}"
    pairs = list(zip(wanted.channels, held.channels, strict=True))
    for what, fields in _CHANNEL_LOSSES.items():
        lost = [a.name for a, b in pairs if any(getattr(a, f) != getattr(b, f) for f in fields)]
        if lost:
            yield f"{what} of {_these(lost)}"
    yield from _key_differences([(a.name, a.run, b.run) for a, b in pairs])


_CHANNEL_LOSSES = {
    "the name is lost": ("name",),
    "the unit is lost": ("unit",),
    "the colour is lost": ("color",),
    "the lock is lost": ("locked",),
    "the extrapolation changes": ("pre", "post"),
}


def _key_differences(runs: list[tuple[str, Run, Run]]) -> Iterator[str]:
    """Sentences on keys; the rules are named since each degrades in its own way."""
    for name, a, b in runs:
        if len(a) != len(b):
            yield f"{_keys(abs(len(a) - len(b)))} lost or added, in {name}"
    same = [(name, a, b) for name, a, b in runs if len(a) == len(b) and a is not b]
    if not same:
        return
    names = [name for name, _, _ in same]
    ends = np.cumsum([len(a) for _, a, _ in same])
    wanted, held = np.concatenate([a for _, a, _ in same]), np.concatenate([b for _, _, b in same])
    for kind, lost in _kinds_of_loss(wanted, held):
        where = np.flatnonzero(lost)
        if len(where):
            channels = np.unique(np.searchsorted(ends, where, side="right")).tolist()
            yield f"{_keys(len(where))} {kind}, in {_these([names[i] for i in channels])}"


def _kinds_of_loss(a: Run, b: Run) -> Iterator[tuple[str, NDArray[np.bool_]]]:
    """What may have become of a key, and the keys of which it has."""
    yield "moved", (_bits(a["time"]) != _bits(b["time"])) | (_bits(a["value"]) != _bits(b["value"]))
    for side in ("in", "out"):
        rules, others = a[f"rule_{side}"], b[f"rule_{side}"]
        changed = rules != others
        pairs = zip(rules[changed].tolist(), others[changed].tolist(), strict=True)
        for rule, other in sorted(set(pairs)):
            kind = f"no longer {TangentRule(rule).word} but {TangentRule(other).word} on the {side} side"
            yield kind, (rules == rule) & (others == other)
        slopes = _bits(a[f"slope_{side}"]) != _bits(b[f"slope_{side}"])
        yield "with another slope", slopes & ~changed & (rules == _FIXED)
    yield "no longer marked as broken", a["broken"] & ~b["broken"]
    yield "no longer marked as unified", b["broken"] & ~a["broken"]


def _keys(number: int) -> str:
    return "1 key is" if number == 1 else f"{number} keys are"


def _bits(column: NDArray[np.float64]) -> NDArray[np.int64]:
    return np.ascontiguousarray(column).view(np.int64)


def _same_number(a: float, b: float) -> bool:
    return repr(a) == repr(b)


def _these(names: list[str]) -> str:
    if len(names) > 3:
        return f"{len(names)} channels ({', '.join(names[:2])}, ...)"
    return ", ".join(names)
