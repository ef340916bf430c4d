"""What the number fields of the key inspector are about: one number of each of the selected keys."""

from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model import edits
from model.change import Change
from model.channel import Channel
from model.clip import Clip
from model.document import Document, Gesture
from model.expressions import Formula
from model.hermite import LARGEST
from model.keyframe import Run
from model.selection import Selection
from widgets.number_targets import GestureHolder
from widgets.numbers import factor_of, is_angle, shown, stored_from_shown

type Floats = NDArray[np.float64]

LONGEST_FORMULA: Final = 24
# More keys than this would hold up the typing: they are changed when Enter is pressed.
MOST_SHOWN: Final = 150_000
NO_NUMBERS: Final = np.empty(0)


class SelectedKeys:
    """The selected keys of every channel, gathered once for all who ask while nothing changes."""

    def __init__(self, document: Document) -> None:
        self._document = document

    def runs(self) -> list[tuple[Channel, Run]]:
        """The selected keys by channel, in time order."""
        return self._document.selected.of(self._document.session.selection)

    def column(self, field: str) -> NDArray[np.generic]:
        """One field of all selected keys as stored."""
        columns = [run[field] for _, run in self.runs()]
        return np.concatenate(columns) if columns else NO_NUMBERS

    def numbers(self, field: str) -> Floats:
        """Times, values or slopes of all selected keys as shown."""
        columns = [_as_shown(run[field], _factor(channel, field)) for channel, run in self.runs()]
        return np.concatenate(columns) if columns else NO_NUMBERS

    def unit(self) -> str:
        """The unit that all channels with selected keys share; "" where they differ."""
        units = {channel.unit for channel, _ in self.runs()}
        return units.pop() if len(units) == 1 else ""


class KeyTarget(GestureHolder):
    """One field ("time", "value", "slope_in", "slope_out") of the selected keys, each typed change a gesture."""

    def __init__(self, document: Document, keys: SelectedKeys, field: str) -> None:
        super().__init__(document)
        self._keys = keys
        self._field = field
        self._selection = Selection.NONE
        self._waiting: tuple[str, Callable[[Clip], list[Change]]] | None = None

    def numbers(self) -> Floats:
        return self._keys.numbers(self._field)

    def text(self, number: float) -> str:
        return shown(number)

    def step(self) -> float:
        if self._field == "time":
            return 1.0 / self.document.clip.frame_rate
        return 1.0 if is_angle(self._keys.unit()) else 0.1

    def gesture(self, label: str) -> Gesture:
        if self._gesture is None:
            self._selection = self.document.session.selection
        return super().gesture(label)

    def preview(self, formula: Formula) -> str:
        selection = self._selection if self._gesture is not None else self.document.session.selection
        if all(channel.locked for channel in selection.channels):
            raise ValueError("the channel is locked" if len(selection.channels) == 1 else "all channels are locked")

        def changes(clip: Clip) -> list[Change]:
            return edits.set_columns(clip, selection, self._field, lambda c, keys: self._numbers(formula, c, keys))

        words = f"Set the {self._field.replace('_', ' ')} of"
        label = f"{self.document.label_of(words, selection)} ({_short(formula.text.strip())})"
        if selection.count > MOST_SHOWN:
            self.require_rest()
            self._selection, self._waiting = selection, (label, changes)
            return f"Enter: {label}"
        self.gesture(label).preview(changes, label=label)
        return ""

    def commit(self) -> None:
        waiting, self._waiting = self._waiting, None
        if waiting is None:
            super().commit()
            return
        self.require_rest()
        self.document.do(*waiting, keys=self._selection.count)

    def cancel(self) -> None:
        self._waiting = None
        super().cancel()

    def _numbers(self, formula: Formula, channel: Channel, keys: Run) -> Floats:
        factor = _factor(channel, self._field)
        stored = keys[self._field]
        before = _as_shown(stored, factor)
        wanted = formula(before, keys["time"], _as_shown(keys["value"], factor_of(channel.unit)))
        return stored_from_shown(wanted, before, stored, factor)


def _short(text: str) -> str:
    return text if len(text) <= LONGEST_FORMULA else f"{text[: LONGEST_FORMULA - 1]}…"


def _as_shown(stored: Floats, factor: float) -> Floats:
    """Numbers in the unit of the eye; what no double can hold there is the largest that there is."""
    if factor == 1.0:
        return stored
    with np.errstate(over="ignore"):
        shown: Floats = np.clip(stored * factor, -LARGEST, LARGEST)
    return shown


def _factor(channel: Channel, field: str) -> float:
    return 1.0 if field == "time" else factor_of(channel.unit)
