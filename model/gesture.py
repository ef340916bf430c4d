"""Gesture: a change under way, shown as it would be, until it is kept or taken back."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from types import TracebackType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from model.change import Change, Edit, Shift, Splice, differing, replacing, unshifted
from model.channel import Channel
from model.clip import Clip
from model.keyframe import Run
from model.labels import counted
from model.progress import Report, part_of, unheard
from model.selection import NO_IDS, Ids, Selection, ids_without
from model.touched import Touched

if TYPE_CHECKING:
    from model.document import Document

type Compute = Callable[[Clip], Iterable[Change]]
# What is to be selected after a preview: these keys, or those that follow from the changes as stored.
type Selecting = Selection | Callable[[Sequence[Change]], Selection] | None


def added_keys(changes: Sequence[Change]) -> Selection:
    """The keys that *changes* add: what a paste or an insertion selects."""
    gone, come = _ids_by_channel(changes)
    return Selection.of(
        {channel: ids_without(ids, gone[channel]) if channel in gone else ids for channel, ids in come.items()}
    )


def _ids_by_channel(changes: Sequence[Change]) -> tuple[dict[Channel, Ids], dict[Channel, Ids]]:
    """(ids taken out, ids put in) by channel, without the splices that only change keys in place."""
    gone: dict[Channel, Ids] = {}
    come: dict[Channel, Ids] = {}
    for change in changes:
        if not isinstance(change, Splice):
            continue
        before, after = change.before["id"], change.after["id"]
        if len(before) == len(after) and (before == after).all():
            continue
        for ids, part in ((gone, before), (come, after)):
            if len(part):
                known = ids.get(change.channel)
                ids[change.channel] = part if known is None else np.concatenate([known, part])
    return gone, come


def replaced_keys(changes: Sequence[Change]) -> int:
    """How many keys gave way to others that came in or moved over them; keys that were only deleted do not count."""
    gone, come = _ids_by_channel(changes)
    replacing = {
        change.channel
        for change in changes
        if isinstance(change, Splice) and change.channel in gone and not _only_deletes(change)
    }
    return sum(len(ids_without(gone[channel], come.get(channel, NO_IDS))) for channel in replacing)


def _only_deletes(splice: Splice) -> bool:
    """Whether every key after *splice* was there before it, at the same time."""
    before, after = splice.before, splice.after
    stayed = before[np.isin(before["id"], after["id"])]
    return all(np.array_equal(stayed[field], after[field]) for field in ("id", "time"))


class News(NamedTuple):
    """What a preview has brought about and is still to be told, and what is selected then."""

    touched: Touched
    selection: Selection


class Gesture:
    """One change by the user from its begin to commit or cancel; every preview is worked out from the start."""

    def __init__(self, document: "Document", label: str) -> None:
        self._label: str | Callable[[], str] = label
        self.edit: Edit | None = None
        self._document = document
        self._selection = document.session.selection
        self._active = document.session.active
        self._put: list[Change] = []
        self._touched = Touched()  # by the present preview
        self._kept: tuple[list[Change], int] | None = None  # what `commit` will find, if that is known
        self._held: dict[Channel, None] = {}  # the channels that a preview has spliced
        self._fresh: dict[Channel, Ids] = {}

    def __enter__(self) -> "Gesture":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, tb: TracebackType | None) -> None:
        if kind is not None:
            self.cancel()
        elif self.open:
            self.commit()

    @property
    def open(self) -> bool:
        """Whether it can still be previewed, committed and cancelled."""
        return self._document.gesture is self

    @property
    def changes(self) -> tuple[Change, ...]:
        """The changes of the present preview, with the ids of new keys; slopes by rule are as they were given."""
        return tuple(unshifted(self._put))

    @property
    def covered(self) -> dict[Channel, Run]:
        """The keys of the start that the present preview hides; they come back when it moves on."""
        if not self.hides_keys:
            return {}
        gone, come = _ids_by_channel(self._put)
        covered = {}
        for channel, ids in gone.items():
            hidden = ids_without(ids, come[channel]) if channel in come else ids
            parts = [
                splice.before[np.isin(splice.before["id"], hidden)]
                for splice in self._put
                if isinstance(splice, Splice) and splice.channel is channel
            ]
            if any(len(part) for part in parts):
                covered[channel] = np.concatenate(parts)
        return covered

    @property
    def hides_keys(self) -> bool:
        """Whether a key of the start may be missing now: not where all that were taken out were put in again."""
        return self._touched.keys_came_or_went and bool(self._fresh or self.keys_fewer)

    @property
    def keys_fewer(self) -> int:
        """How many keys the present preview takes away, less those that it brings."""
        return sum(len(change.before) - len(change.after) for change in self._put if isinstance(change, Splice))

    @property
    def label(self) -> str:
        """What its undo step is called if it ends now."""
        if callable(self._label):
            self._label = self._label()
        return self._label

    def preview(
        self, compute: Compute, *, selection: Selecting = None, label: str | Callable[[], str] | None = None
    ) -> None:
        """Show the clip as *compute* changes it from the gesture's start, instead of the preview before.

        An exception of *compute*, or a change that cannot be made, leaves the preview before in place.
        *selection* is what is selected then (default: what was at the start), without keys that are gone. *label*
        may be a function that is called when the label is read, since hardly one preview's is.
        """
        self._document._require_told()
        news = self._put_in(compute, selection)
        if label is not None:
            self._label = label
        self.tell(news)

    def prepared(self, selection: Selection) -> Iterator[None]:
        """In short steps, as long as it is open: have at hand what previews that change the *selection* begin with."""
        for channel in selection.channels:
            if not channel.locked and self.open:
                self._hold(channel)
                yield from channel.prepared(selection.ids(channel))

    def make(self, compute: Compute, selection: Selecting, report: Report) -> News:
        """Preview and work out what `commit` keeps, telling nobody yet: what of an edit may be done on any thread.

        As if nothing had been after an exception of *report*.
        """
        news = self._put_in(compute, selection, part_of(report, 0.0, 0.8))
        try:
            report(0.8)
            self._kept = self._worked_out()
            report(0.9)
            self._document._measure(*news)
            report(1.0)
        except BaseException:
            self._rewind()
            self._touched = Touched()
            raise
        return news

    def tell(self, news: News) -> None:
        """Tell everyone what a preview has brought about."""
        self._document._tell(news.touched, news.selection, self._active_now())
        self._document.gesture_changed.emit()

    def _put_in(self, compute: Compute, selection: Selecting, report: Report = unheard) -> News:
        """Put what *compute* gives in the place of the preview before."""
        document = self._require_open()
        before, told_before = self._put, self._touched
        touched = Touched()
        self._rewind()
        try:
            changes = list(compute(document.clip))
            self._put = self._stored(changes, touched, part_of(report, 0.4, 1.0))
            chosen = selection(self._put) if callable(selection) else selection
        except BaseException:
            self._rewind()
            self._put, self._touched = document._put_all(before, Touched(), read_back=False), told_before
            raise
        self._touched = touched
        news = touched.instead_of(told_before)
        return News(news, self._without_gone(self._selection if chosen is None else chosen))

    def commit(self) -> Edit | None:
        """Keep the present preview as one edit; None, and nothing is told, if nothing differs from the start.

        The label also says how many keys were landed on and are gone.
        """
        document = self._require_open()
        document._require_told()
        changes, replaced = self._kept or self._worked_out()
        self._release()
        session = document.session
        document.gesture = None
        if changes:
            if replaced:
                self._label = f"{self.label}, replacing {counted(replaced, 'key')}"
            sides = self._selection, session.selection, self._active, session.active
            self.edit = Edit(self.label, tuple(changes), *sides, replaced=replaced)
        document.gesture_changed.emit()
        if self.edit is not None:
            document.committed.emit(self.edit)
        return self.edit

    def _worked_out(self) -> tuple[list[Change], int]:
        """What differs from the start, and how many keys gave way to others."""
        changes = differing([stored for change in self._put for stored in self._read_back(change)])
        return changes, replaced_keys(changes)

    def cancel(self) -> None:
        """As if nothing had been; a gesture that is over stays as it ended."""
        document = self._document
        if not self.open:
            return
        document._require_told()
        self._rewind()
        self._release()
        document.gesture = None
        document._tell(self._touched, self._selection, self._active)
        document.gesture_changed.emit()

    def _require_open(self) -> "Document":
        if not self.open:
            raise RuntimeError(f"{self.label!r} is over")
        return self._document

    def _rewind(self) -> None:
        """Take back what the present preview put in."""
        for channel in self._held:
            channel.rewind()
        settings = [change.inverse() for change in reversed(self._put) if not isinstance(change, Splice | Shift)]
        self._document._put_all(settings, Touched())
        self._put, self._kept = [], None

    def _hold(self, channel: Channel) -> None:
        """Let *channel* keep what splices overwrite."""
        if channel not in self._held:
            self._held[channel] = None
            channel.hold()

    def _release(self) -> None:
        for channel in self._held:
            channel.release()

    def _stored(self, changes: list[Change], touched: Touched, report: Report) -> list[Change]:
        """Put *changes* in; a new key has the same id in every preview, so that a drag can go on holding it."""
        for change in changes:
            if isinstance(change, Splice | Shift):
                self._hold(change.channel)
        changes = _clear(changes)
        asking = [i for i, change in enumerate(changes) if isinstance(change, Splice) and _asks_for_ids(change.after)]
        used: dict[Channel, int] = {}
        for i in asking:
            splice = changes[i]
            assert isinstance(splice, Splice)
            changes[i] = self._with_known_ids(splice, used)
        stored = self._document._put_all(changes, touched, new=True, read_back=False, report=report)
        for i in asking:
            wanted, got = changes[i], stored[i]
            assert isinstance(wanted, Splice)
            assert isinstance(got, Splice)
            new = got.after["id"][wanted.after["id"] == 0]
            if len(new):
                known = self._fresh.get(got.channel)
                self._fresh[got.channel] = new if known is None else np.concatenate([known, new])
        return stored

    def _read_back(self, change: Change) -> Sequence[Change]:
        """*change* with the slopes that the channel has made of it, unless another change has parted its keys."""
        if not isinstance(change, Splice | Shift):
            return [change]
        channel, before = change.channel, change.before
        if isinstance(change, Shift) and change.within is not None:
            before = change.within
        if before.base is not None:  # a part of a larger run, which the history need not hold
            before = before.copy()
        try:  # what is shifted as a whole has the same keys on both sides
            if isinstance(change, Splice):
                return [Splice(channel, before, channel.stored(change.after))]
            after = channel.stored(before[:: -1 if change.mapping.mirrored else 1])
            return replacing(channel, before, after, change.passed)
        except ValueError:
            return unshifted([change])

    def _with_known_ids(self, splice: Splice, used: dict[Channel, int]) -> Splice:
        known = self._fresh.get(splice.channel)
        if known is None:
            return splice
        after = splice.after.copy()
        at = used.get(splice.channel, 0)
        places = np.flatnonzero(after["id"] == 0)[: len(known) - at]
        after["id"][places] = known[at : at + len(places)]
        used[splice.channel] = at + len(places)
        return splice._replace(after=after)

    def _without_gone(self, selection: Selection) -> Selection:
        if not self.hides_keys:
            return selection
        gone, come = _ids_by_channel(self._put)
        hidden = {
            channel: ids_without(ids, come[channel]) if channel in come else ids
            for channel, ids in gone.items()
            if len(selection.ids(channel))
        }
        return selection.minus(Selection.of(hidden)) if hidden else selection

    def _active_now(self) -> Channel | None:
        """The active channel, which the user may have changed meanwhile; the one of the start if it is gone."""
        return self._document.session.active or self._active


def _clear(changes: list[Change]) -> list[Change]:
    """*changes*, with splices for all shifts if a channel is changed twice or a key is new; none is made yet."""
    if not any(isinstance(change, Shift) for change in changes):
        return changes
    channels = [change.channel for change in changes if isinstance(change, Splice | Shift)]
    new = any(isinstance(change, Splice) and _asks_for_ids(change.after) for change in changes)
    return list(unshifted(changes)) if new or len(set(channels)) < len(channels) else changes


def _asks_for_ids(run: Run) -> bool:
    return bool(len(run)) and not bool(run["id"].all())
