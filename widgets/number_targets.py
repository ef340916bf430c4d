"""What number fields are about beside keys: the playhead, and the numbers of the clip."""

import numpy as np
from numpy.typing import NDArray

from model.clip import Clip
from model.document import Document, Gesture, Setting
from model.expressions import Formula
from widgets.numbers import frame_text, shown

type Floats = NDArray[np.float64]


class GestureHolder:
    """A gesture that opens with the first preview of a field and ends with commit or cancel."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self._gesture: Gesture | None = None

    def gesture(self, label: str) -> Gesture:
        """The gesture of this field, open; ValueError while another one is going on."""
        if self._gesture is None or not self._gesture.open:
            self.require_rest()
            self._gesture = self.document.begin(label)
        return self._gesture

    def require_rest(self) -> None:
        """ValueError while a gesture of somebody else is going on."""
        if self.document.gesture is not None:
            raise ValueError("finish the drag first, or press Esc to cancel it")

    def commit(self) -> None:
        """Keep what is shown as one undo step."""
        gesture, self._gesture = self._gesture, None
        if gesture is not None and gesture.open:
            gesture.commit()

    def cancel(self) -> None:
        """Take back what is shown."""
        gesture, self._gesture = self._gesture, None
        if gesture is not None:
            gesture.cancel()


class SettingTarget(GestureHolder):
    """One number of the clip: start, end (seconds) or frame_rate."""

    def __init__(self, document: Document, field: str) -> None:
        super().__init__(document)
        self._field = field

    def numbers(self) -> Floats:
        return np.array([getattr(self.document.clip, self._field)])

    def text(self, number: float) -> str:
        return shown(number)

    def step(self) -> float:
        return 1.0 if self._field == "frame_rate" else 1.0 / self.document.clip.frame_rate

    def preview(self, formula: Formula) -> str:
        def changes(clip: Clip) -> list[Setting]:
            before = float(getattr(clip, self._field))
            after = float(formula(np.array([before]))[0])
            return [Setting(clip, self._field, before, after)]

        name = self._field.replace("_", " ")
        self.gesture(f"Set the {name} of the clip").preview(changes)
        return ""


class PlayheadTarget:
    """Where the playhead is; no part of the clip, so nothing to undo."""

    def __init__(self, document: Document, *, in_frames: bool) -> None:
        self._document = document
        self._in_frames = in_frames
        self._came_from: float | None = None

    def numbers(self) -> Floats:
        time = self._document.session.playhead
        return np.array([self._document.clip.frame_of(time) if self._in_frames else time])

    def text(self, number: float) -> str:
        return frame_text(number) if self._in_frames else f"{number:.3f}"

    def step(self) -> float:
        return 1.0 if self._in_frames else 1.0 / self._document.clip.frame_rate

    def preview(self, formula: Formula) -> str:
        session, clip = self._document.session, self._document.clip
        if self._came_from is None:
            self._came_from = session.playhead
        start = clip.frame_of(self._came_from) if self._in_frames else self._came_from
        number = float(formula(np.array([start]))[0])
        session.playhead = clip.time_of(number) if self._in_frames else number
        return ""

    def commit(self) -> None:
        self._came_from = None

    def cancel(self) -> None:
        if self._came_from is not None:
            self._document.session.playhead = self._came_from
        self._came_from = None
