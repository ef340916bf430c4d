"""Content: what a file says of a clip, before channels are built from it and after they are read out."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.formats.side_by_side import side_by_side
from model.keyframe import KEY_DTYPE, Run, TangentRule
from model.labels import counted
from model.progress import Report, unheard

type Place = tuple[int, int]  # of a kind of loss among all that there are

_FIXED = TangentRule.FIXED
_KEYS: Final = 16384  # compared at once


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
        channels = [ChannelContent(c.name, c.run(), c.pre, c.post, c.unit, c.color, c.locked) for c in clip.channels]
        return cls(float(clip.start), float(clip.end), channels, float(clip.frame_rate), clip.title)

    def clip(self, report: Report = unheard) -> Clip:
        """A new clip with this content."""
        channels = []
        for number, c in enumerate(self.channels):
            report(number / len(self.channels))
            channels.append(Channel(c.name, c.run, pre=c.pre, post=c.post, unit=c.unit, color=c.color, locked=c.locked))
        return Clip(channels, start=self.start, end=self.end, frame_rate=self.frame_rate, title=self.title)

    def named(self, names: list[str], units: list[str]) -> "Content":
        """The same with other names and units, one a channel."""
        channels = [
            replace(channel, name=name, unit=unit)
            for channel, name, unit in zip(self.channels, names, units, strict=True)
        ]
        return replace(self, channels=channels)


class Loss(NamedTuple):
    """Something that a file does not hold of a clip: what, in a word or two, and a sentence that says of how much."""

    what: str
    sentence: str
    in_motion: bool  # other values at some time; else only what is met when editing

    def __str__(self) -> str:
        return self.sentence


def differences(wanted: Content, held: Content) -> list[Loss]:
    """What *held* has lost of *wanted*, one a kind of loss, those that change the motion first.

    Empty when they are the same bit for bit.
    """
    if wanted is held:
        return []
    if len(wanted.channels) != len(held.channels):
        sentence = f"there are {len(held.channels)} channels instead of {len(wanted.channels)}"
        return [Loss("all channels", sentence, in_motion=True)]
    return sorted(_differences(wanted, held), key=lambda loss: not loss.in_motion)


def _differences(wanted: Content, held: Content) -> Iterator[Loss]:
    pairs = list(zip(wanted.channels, held.channels, strict=True))
    yield from _key_differences([(a.name, a.run, b.run) for a, b in pairs])
    lost = [a.name for a, b in pairs if (a.pre, a.post) != (b.pre, b.post)]
    if lost:
        yield Loss("extrapolation", f"the extrapolation of {_these(lost)} changes", in_motion=True)
    if not (_same_number(wanted.start, held.start) and _same_number(wanted.end, held.end)):
        yield Loss("the range", f"the range becomes {held.start!r} to {held.end!r}", in_motion=True)
    if not _same_number(wanted.frame_rate, held.frame_rate):
        sentence = f"the frame rate becomes {held.frame_rate:g} instead of {wanted.frame_rate:g}"
        yield Loss("the frame rate", sentence, in_motion=False)
    if wanted.title != held.title:
        yield Loss("the title", f"the title {wanted.title!r} is lost", in_motion=False)
    for column, word in _WORDS.items():
        lost = [a.name for a, b in pairs if getattr(a, column) != getattr(b, column)]
        if len(lost) == 1:
            yield Loss(f"{word}s", f"the {word} of {lost[0]} is lost", in_motion=False)
        elif lost:
            yield Loss(f"{word}s", f"the {word}s of {_these(lost)} are lost", in_motion=False)


# Fields of a channel that say nothing of its motion, and what people call them.
_WORDS: Final = {"name": "name", "unit": "unit", "color": "color", "locked": "lock"}


def _key_differences(runs: list[tuple[str, Run, Run]]) -> Iterator[Loss]:
    """Sentences on keys; the rules are named since each degrades in its own way."""
    for name, a, b in runs:
        if len(a) != len(b):
            verb = "is" if abs(len(a) - len(b)) == 1 else "are"
            sentence = f"{counted(abs(len(a) - len(b)), 'key')} of {name} {verb} lost or added"
            yield Loss("some keys", sentence, in_motion=True)
    same = [(name, a, b) for name, a, b in runs if len(a) == len(b) and a is not b]
    if not same:
        return
    names = [name for name, _, _ in same]
    ends = np.cumsum([len(a) for _, a, _ in same])
    wanted, held = joined([a for _, a, _ in same]), joined([b for _, _, b in same])
    firsts = range(0, len(wanted), _KEYS)
    found = side_by_side(lambda first: _lost_among(wanted, held, first), firsts)
    for place, kind in sorted({(place, kind) for losses in found for place, kind in losses}):
        where = np.concatenate([losses[place, kind] for losses in found if (place, kind) in losses])
        channels = np.flatnonzero(np.diff(np.searchsorted(where, ends), prepend=0)).tolist()
        keys = f"{counted(len(where), 'key')} of {_these([names[i] for i in channels])}"
        yield Loss(kind.what, f"{keys} {kind.one if len(where) == 1 else kind.many}", kind.in_motion)


class _Kind(NamedTuple):
    """A way in which keys differ: what is lost, what one key does and what many do."""

    what: str
    one: str
    many: str
    in_motion: bool


def _lost_among(wanted: Run, held: Run, first: int) -> dict[tuple[Place, _Kind], NDArray[np.int64]]:
    """The numbers of those keys that have lost something, by what; of so few that they stay in a processor's cache."""
    kinds = _kinds_of_loss(wanted[first : first + _KEYS], held[first : first + _KEYS])
    return {(place, kind): np.flatnonzero(lost) + first for place, kind, lost in kinds if lost.any()}


def joined(runs: Sequence[Run]) -> Run:
    """One run after the other, as bytes since numpy copies keys field by field; a run alone is not copied."""
    if len(runs) == 1:
        return runs[0]
    return np.concatenate([np.zeros(0, np.uint8), *[np.ascontiguousarray(r).view(np.uint8) for r in runs]]).view(
        KEY_DTYPE
    )


def _kinds_of_loss(a: Run, b: Run) -> Iterator[tuple[Place, _Kind, NDArray[np.bool_]]]:
    """What may have become of a key, its place among all that may, and the keys of which it has."""
    moved = (_bits(a["time"]) != _bits(b["time"])) | (_bits(a["value"]) != _bits(b["value"]))
    yield (0, 0), _Kind("the place of keys", "is moved", "are moved", in_motion=True), moved
    for side_number, side in enumerate(("in", "out"), 1):
        rules, others = (np.ascontiguousarray(run[f"rule_{side}"]) for run in (a, b))
        changed = rules != others
        if changed.any():
            pairs = (rules << 4) + others
            for pair in np.flatnonzero(np.bincount(pairs[changed])).tolist():
                rule, other = divmod(pair, 16)
                yield (side_number, pair), _rule_lost(TangentRule(rule), TangentRule(other), side), pairs == pair
        slopes = _bits(a[f"slope_{side}"]) != _bits(b[f"slope_{side}"])
        slope = f"another slope on the {side} side"
        slopes &= ~changed & (rules == _FIXED)
        yield (side_number, 256), _Kind("slopes", f"gets {slope}", f"get {slope}", in_motion=True), slopes
    marks = {"broken": a["broken"] & ~b["broken"], "unified": b["broken"] & ~a["broken"]}
    for number, (mark, lost) in enumerate(marks.items()):
        kind = f"no longer marked as {mark}"
        yield (3, number), _Kind(f"{mark} marks", f"is {kind}", f"are {kind}", in_motion=False), lost


def _rule_lost(rule: TangentRule, other: TangentRule, side: str) -> _Kind:
    """A held span is another motion; the other rules end in the slope that they gave."""
    if rule is TangentRule.STEP:
        becomes = f"its value: step becomes {other.word}"
        return _Kind(
            "steps",
            f"no longer holds {becomes}",
            f"no longer hold {becomes.replace('its value', 'their values')}",
            in_motion=True,
        )
    kind = f"{other.word} instead of {rule.word} on the {side} side"
    return _Kind(f"{rule.word} tangents", f"becomes {kind}", f"become {kind}", in_motion=other is TangentRule.STEP)


def _bits(column: NDArray[np.float64]) -> NDArray[np.int64]:
    return column.view(np.int64)


def _same_number(a: float, b: float) -> bool:
    return repr(a) == repr(b)


def _these(names: list[str]) -> str:
    if len(names) > 3:
        return f"{len(names)} channels ({', '.join(names[:2])}, ...)"
    return ", ".join(names)
