"""Which range shows all of a clip, one channel, or the selected keys."""

from collections.abc import Iterable
from math import inf
from typing import Final

from model.channel import Channel
from model.clip import Clip
from model.document import Document
from widgets.view_range import ViewRange, fitted

MARGINS: Final = (0.04, 0.10)
# Around a lone selected key its neighbours are shown too, so that something of the curve is seen.
ALONE: Final = 1
# A clip's range is shown with its keys up to so many times their extent.
WIDEST_RANGE: Final = 5.0


def all_fitted(document: Document) -> ViewRange:
    """The shown channels from the first key to the last, lowest to highest; the clip's range if there is no key."""
    clip = document.clip
    return _fitted_channels(clip, document.session.shown_channels(clip) or clip.channels)


def clip_fitted(document: Document) -> ViewRange:
    """All shown keys and the clip's range too, so that both its ends can be taken; for a clip that is opened.

    A range so wide that the keys would be lost in it is left out.
    """
    shown, clip = all_fitted(document), document.clip
    keys = clip.extent()
    if keys is None or not clip.end - clip.start <= WIDEST_RANGE * (keys[1] - keys[0]):
        return shown
    t0, t1 = min(keys[0], clip.start), max(keys[1], clip.end)
    return fitted(t0, t1, 0.0, 1.0, MARGINS)._replace(v0=shown.v0, v1=shown.v1)


def active_fitted(document: Document) -> ViewRange | None:
    """All keys of the active channel, lowest to highest; None if it is not shown or has no key."""
    active = document.session.active
    return None if active is None else channels_fitted(document, [active])


def channels_fitted(document: Document, channels: Iterable[Channel]) -> ViewRange | None:
    """All keys of *channels*, lowest to highest; None if none of them is shown and has a key."""
    seen = [channel for channel in channels if len(channel) and document.session.shown(channel)]
    return _fitted_channels(document.clip, seen) if seen else None


def _fitted_channels(clip: Clip, channels: Iterable[Channel]) -> ViewRange:
    t0, t1, v0, v1 = inf, -inf, inf, -inf
    for channel in channels:
        ends = channel.ends()
        if ends is None:
            continue
        low, high = channel.extrema()
        t0, t1, v0, v1 = min(t0, ends.time0), max(t1, ends.time1), min(v0, low), max(v1, high)
    if t0 > t1:
        start, end = (clip.start, clip.end) if clip.end > clip.start else (0.0, 1.0)
        return fitted(start, end, 0.0, 1.0, MARGINS)
    if t0 == t1 and clip.start <= t0 <= clip.end and clip.end > clip.start:
        t0, t1 = clip.start, clip.end
    return fitted(t0, t1, v0, v1, MARGINS)


def fitted_between(document: Document, t0: float, t1: float) -> ViewRange:
    """Exactly these times, with the shown curves from their lowest to their highest value there."""
    low, high = inf, -inf
    for channel in document.session.shown_channels(document.clip):
        if len(channel):
            lowest, highest = channel.extrema(t0, t1)
            low, high = min(low, lowest), max(high, highest)
    values = fitted(0.0, 1.0, *((low, high) if low <= high else (0.0, 1.0)), MARGINS)
    return values._replace(t0=t0, t1=t1).limited()


def selection_fitted(document: Document) -> ViewRange | None:
    """The selected keys and the curves between them; None if nothing is selected."""
    selection = document.session.selection
    t0, t1, v0, v1 = inf, -inf, inf, -inf
    for channel in selection.channels:
        run = channel.run_of(selection.ids(channel))
        if len(run) == 1:
            run = channel.keys_between(float(run["time"][0]), float(run["time"][0]), around=ALONE)
        start, end = float(run["time"][0]), float(run["time"][-1])
        low, high = channel.extrema(start, end)
        t0, t1, v0, v1 = min(t0, start), max(t1, end), min(v0, low), max(v1, high)
    if t0 > t1:
        return None
    return fitted(t0, t1, v0, v1, (0.1, 0.15))
