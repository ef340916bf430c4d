"""Keyframe: what people and tools hold; Run: neighbouring keys as columns of numbers."""

from enum import IntEnum
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from model.channel import Channel


class TangentRule(IntEnum):
    """Who sets the slope on one side of a key; the rule's word is what files hold."""

    # Numbers live in key columns and words in files: never renumber, only add.
    FLAT = 0
    LINEAR = 1
    SMOOTH = 2
    FIXED = 3
    STEP = 4
    AUTO = 5

    @property
    def word(self) -> str:
        """The rule's name in files, as in ``smooth``."""
        return self.name.lower()

    @classmethod
    def from_word(cls, word: str) -> "TangentRule":
        """The rule called *word*; ValueError if there is none."""
        for rule in cls:
            if rule.word == word:
                return rule
        raise ValueError(f"unknown tangent rule {word!r}; known: {', '.join(rule.word for rule in cls)}")


KEY_DTYPE = np.dtype(
    [
        ("time", "f8"),
        ("value", "f8"),
        ("slope_in", "f8"),
        ("slope_out", "f8"),
        ("rule_in", "u1"),
        ("rule_out", "u1"),
        ("broken", "?"),
        ("id", "i8"),
    ]
)

# Neighbouring keys of one channel, in time order: an array of KEY_DTYPE that nobody writes to.
type Run = NDArray[np.void]


def make_run(
    times: ArrayLike = (),
    values: ArrayLike = 0.0,
    slopes_in: ArrayLike = 0.0,
    slopes_out: ArrayLike = 0.0,
    rules_in: ArrayLike = TangentRule.SMOOTH,
    rules_out: ArrayLike = TangentRule.SMOOTH,
    broken: ArrayLike = False,
    ids: ArrayLike = 0,
) -> Run:
    """Keys from columns of shape (n,) or numbers that count for all; id 0 asks for a new id."""
    times = np.asarray(times, np.float64).reshape(-1)
    run = np.empty(len(times), KEY_DTYPE)
    columns: tuple[ArrayLike, ...] = (times, values, slopes_in, slopes_out, rules_in, rules_out, broken, ids)
    for field, column in zip(cast("tuple[str, ...]", KEY_DTYPE.names), columns, strict=True):
        run[field] = column
    return run


class KeyGoneError(LookupError):
    """The key with this id is not in its channel any more."""


class Keyframe:
    """A light handle on one key of a channel; it reads what the channel holds now.

    Every property raises KeyGoneError once the key has been deleted.
    """

    __slots__ = ("channel", "id")

    def __init__(self, channel: "Channel", key_id: int) -> None:
        self.channel = channel
        self.id = key_id

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Keyframe) and other.channel is self.channel and other.id == self.id

    def __hash__(self) -> int:
        return hash((id(self.channel), self.id))

    def __repr__(self) -> str:
        return f"Keyframe(id={self.id}, channel={self.channel.name!r})"

    def _field(self, name: str) -> Any:
        return self.channel.key_field(self.id, name)

    @property
    def time(self) -> float:
        """Seconds."""
        return float(self._field("time"))

    @property
    def value(self) -> float:
        """In the channel's unit."""
        return float(self._field("value"))

    @property
    def slope_in(self) -> float:
        """Slope of the tangent in, value per second."""
        return float(self._field("slope_in"))

    @property
    def slope_out(self) -> float:
        """Slope of the tangent out, value per second."""
        return float(self._field("slope_out"))

    tangent_in = slope_in
    tangent_out = slope_out

    @property
    def rule_in(self) -> TangentRule:
        """The rule that sets the tangent in."""
        return TangentRule(int(self._field("rule_in")))

    @property
    def rule_out(self) -> TangentRule:
        """The rule that sets the tangent out."""
        return TangentRule(int(self._field("rule_out")))

    @property
    def broken(self) -> bool:
        """Whether the tangents turn apart; unified ones turn together."""
        return bool(self._field("broken"))

    @property
    def previous(self) -> "Keyframe | None":
        """The neighbour before, None at the first key."""
        return self.channel.previous_of(self.id)

    @property
    def next(self) -> "Keyframe | None":
        """The neighbour after, None at the last key."""
        return self.channel.next_of(self.id)

    @property
    def coefficients(self) -> tuple[float, float, float, float]:
        """(a, b, c, d) of the span this key starts; a lone or last key has (0, 0, 0, value)."""
        return self.channel.coefficients_of(self.id)
