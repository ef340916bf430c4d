"""Document: owns the clip, is the only one to change it, and tells what changed."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Final, Protocol

from model.change import (
    Change,
    Edit,
    Membership,
    Setting,
    Shift,
    Splice,
    check_whole,
    put,
    shifted,
    unshifted,
    validated,
)
from model.channel import Channel
from model.clip import Clip
from model.event import Event
from model.gesture import Compute, Gesture, Selecting, added_keys
from model.labels import label_of
from model.progress import CancelledError, Report, unheard
from model.selected import SelectedRuns
from model.selection import Selection
from model.session import Session
from model.touched import Touched

__all__ = ["Change", "Document", "Edit", "Gesture", "LongWork", "Membership", "Setting", "Splice", "added_keys"]

# A change of so many keys takes long enough to be left to `Document.long_work`: about 10 ms.
MANY_KEYS: Final = 30_000
# What there is to do for a channel, however few of its keys change, takes as long as so many keys more.
LIKE_KEYS: Final = 100


class LongWork(Protocol):
    """Gives the result of *work*, or raises its error, after doing it on another thread while the caller waits.

    *work* may raise CancelledError where it reports.
    """

    def __call__[T](self, text: str, work: Callable[[Report], T]) -> T: ...


class Document:
    """A clip that is being edited. Widgets read `clip`, listen, and change it through gestures only.

    Times in `changed` are the interval of the curve that is different now, -inf and inf where an extrapolation is.
    """

    def __init__(self, clip: Clip | None = None, session: Session | None = None) -> None:
        self.changed = Event[Channel, float, float]()
        self.setting_changed = Event[Channel | Clip, str]()
        self.membership_changed = Event[()]()
        self.clip_replaced = Event[()]()
        self.committed = Event[Edit]()
        self.gesture_changed = Event[()]()
        self.clip = Clip() if clip is None else clip
        self.session = Session() if session is None else session
        self.selected = SelectedRuns()
        self.gesture: Gesture | None = None
        self.long_work: LongWork | None = None
        self._working = False
        self._at_work = False

    @property
    def working(self) -> bool:
        """Whether another thread is changing the clip: until it is told nobody may read keys or begin a change."""
        return self._working

    def begin(self, label: str) -> Gesture:
        """Open a gesture; RuntimeError if one is open, since two cannot both be worked out from their start."""
        self._require_rest()
        self.gesture = Gesture(self, label)
        self.gesture_changed.emit()
        return self.gesture

    def do(self, label: str, compute: Compute, *, selection: Selecting = None, keys: int = 0) -> Edit | None:
        """Make the changes that *compute* gives as one undo step; None if nothing is different then.

        If *keys*, about as many as it changes, are many, `long_work` runs *compute* and makes the changes; None also
        if that was cancelled.
        """
        selected = self.session.selection
        try:
            with self.begin(label) as gesture:
                channels = len(self.session.selection.channels) if keys else 0
                if self.long_work is None or keys + LIKE_KEYS * channels < MANY_KEYS:
                    gesture.preview(compute, selection=selection)
                else:
                    gesture.tell(self._at_length(label, partial(gesture.make, compute, selection)))
        except CancelledError:
            return None
        if gesture.edit is None:
            self.session.selection = selected
        return gesture.edit

    def apply(self, edit: Edit) -> None:
        """Make the changes of an edit that was recorded, and select what was selected after it: undo and redo.

        CancelledError, and nothing has changed, if that was cancelled.
        """
        self._require_rest()
        touched = Touched()

        def work(report: Report) -> None:
            self._put_all(edit.changes, touched, report=report)

        def work_at_length(report: Report) -> None:
            work(report)
            self._measure(touched, edit.selection_after)

        if self.long_work is None or edit.key_count + LIKE_KEYS * len(edit.changes) < MANY_KEYS:
            work(unheard)
        else:
            self._at_length(edit.label, work_at_length)
        active = edit.active_after if edit.active_after is not None else self.session.active
        self._tell(touched, edit.selection_after, active)

    def replace(self, clip: Clip) -> None:
        """Edit another clip from now on; an open gesture is cancelled, and the session forgets the old channels."""
        self._require_told()
        if self.gesture is not None:
            self.gesture.cancel()
        self.clip = clip
        self.session.settle(clip.channels, Selection.NONE, None)
        self.clip_replaced.emit()

    def at_length[T](self, text: str, work: Callable[[Report], T], *, many: bool) -> T:
        """What *work*, which changes nothing, gives; if it is about *many* keys, `long_work` does it.

        CancelledError if that was cancelled.
        """
        self._require_rest()
        return work(unheard) if self.long_work is None or not many else self._at_length(text, work)

    def label_of(self, verb: str, selection: Selection, d_time: float = 0.0, d_value: float = 0.0) -> str:
        """As "Move 14 keys of root.tx by +0.10 s"."""
        return label_of(verb, selection, d_time, d_value)

    def _require_rest(self) -> None:
        if self.gesture is not None:
            raise RuntimeError(f"{self.gesture.label!r} is still going on")
        self._require_told()

    def _require_told(self) -> None:
        if self._working:
            raise RuntimeError("the clip is being changed by another thread")

    def _at_length[T](self, text: str, work: Callable[[Report], T]) -> T:
        """Have *work*, which tells nobody, done by `long_work`."""
        assert self.long_work is not None
        self._working = True
        try:
            return self.long_work(text, work)
        finally:
            self._working = False

    def _measure(self, touched: Touched, selection: Selection) -> None:
        """Work out what everybody asks as soon as they are told; it is kept until it changes."""
        for channel in touched.intervals:
            channel.extrema()
        self.selected.of(selection)

    def _put_all(
        self,
        changes: Sequence[Change],
        touched: Touched,
        *,
        new: bool = False,
        read_back: bool = True,
        report: Report = unheard,
    ) -> list[Change]:
        """Make all *changes* and return them as stored (see `put`); after an error nothing has changed.

        Those that are *new*, and not the way back or forth, must also leave the clip as a clip has to be.
        """
        if self._at_work:
            raise RuntimeError("the document is being changed already")
        self._at_work = True
        stored: list[Change] = []
        try:
            for place, change in enumerate(changes):
                report(place / len(changes))
                parts: Sequence[Change] = [change]
                if isinstance(change, Shift):
                    done = shifted(change, touched)
                    parts = change.splices() if done is None else []
                    stored += [] if done is None else [done]
                for part in parts:
                    stored.append(put(self.clip, validated(part) if new else part, touched, read_back=read_back))
            report(1.0)
            if new and (touched.membership or touched.settings):
                check_whole(self.clip, touched)
        except BaseException:
            for change in reversed(unshifted(stored)):
                put(self.clip, change.inverse(), touched)
            raise
        finally:
            self._at_work = False
        return stored

    def _tell(self, touched: Touched, selection: Selection, active: Channel | None) -> None:
        """Tell everyone, after all is in its new state: listeners may read whatever they like."""
        failure: Exception | None = None
        tellings: list[Callable[[], None]] = []
        session = self.session
        if touched.membership or selection is not session.selection or active is not session.active:
            tellings.append(partial(session.settle, self.clip.channels, selection, active))
        if touched.membership:
            tellings.append(self.membership_changed.emit)
        tellings += [partial(self.setting_changed.emit, *setting) for setting in touched.settings]
        tellings += [partial(self.changed.emit, channel, t0, t1) for channel, (t0, t1) in touched.intervals.items()]
        for telling in tellings:
            try:
                telling()
            except Exception as error:
                failure = failure or error
        if failure is not None:
            raise failure
