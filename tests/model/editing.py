"""What the tests of editing share: small clips, all bytes of a clip, a document that keeps a record of what it told."""

from typing import Any

import numpy as np

from model.channel import Channel
from model.clip import Clip
from model.document import Document, Edit
from model.keyframe import make_run
from model.selection import Selection


def channel_of(values: list[float], name: str = "root.tx", step: float = 1.0, **settings: Any) -> Channel:
    """A channel with smooth keys at 0, step, 2 step..., whose ids are 1, 2, 3..."""
    return Channel(name, make_run(np.arange(len(values)) * step, values), **settings)


def document_of(*channels: Channel) -> Document:
    """A document on a clip of *channels*."""
    return Document(Clip(channels))


def everything(clip: Clip) -> bytes:
    """All that a clip holds, ids included, bit for bit."""
    parts = [repr((clip.start, clip.end, clip.frame_rate, clip.title)).encode()]
    for c in clip.channels:
        parts.append(repr((c.name, c.unit, c.color, c.locked, int(c.pre), int(c.post))).encode())
        parts.append(c.run().tobytes())
    return b"\n".join(parts)


def select(channel: Channel, *ids: int) -> Selection:
    """The keys *ids* of *channel*."""
    return Selection.of({channel: list(ids)})


def times(channel: Channel) -> list[float]:
    """The times of all keys."""
    return [float(time) for time in channel.run()["time"]]


def values(channel: Channel) -> list[float]:
    """The values of all keys."""
    return [float(value) for value in channel.run()["value"]]


def ids(channel: Channel) -> list[int]:
    """The ids of all keys."""
    return [int(key_id) for key_id in channel.run()["id"]]


class Record:
    """What a document told, in order."""

    def __init__(self, document: Document) -> None:
        self.events: list[tuple[Any, ...]] = []
        self.edits: list[Edit] = []
        document.changed.connect(lambda c, t0, t1: self.events.append(("changed", c.name, t0, t1)))
        document.setting_changed.connect(lambda target, field: self.events.append(("setting", field)))
        document.membership_changed.connect(lambda: self.events.append(("membership",)))
        document.clip_replaced.connect(lambda: self.events.append(("replaced",)))
        document.committed.connect(self.edits.append)
        document.session.selection_changed.connect(lambda: self.events.append(("selection",)))

    def taken(self) -> list[tuple[Any, ...]]:
        """What was told since the last call."""
        events, self.events = self.events, []
        return events
