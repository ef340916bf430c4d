"""Verbs that change what a channel or the clip is told: extrapolation, name, unit, colour, lock, range."""

from collections.abc import Iterable
from typing import Any

from model.change import Change, Setting
from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation


def set_setting(clip: Clip, targets: Iterable[Channel | Clip], field: str, value: Any) -> list[Change]:
    """Set *field* of all *targets*; the document makes sure of the value."""
    return [Setting(target, field, getattr(target, field, None), value) for target in targets]


def set_extrapolation(
    clip: Clip, channels: Iterable[Channel], pre: Extrapolation | None = None, post: Extrapolation | None = None
) -> list[Change]:
    """Choose how *channels* go on before and after their keys; None leaves a side, locked channels stay."""
    return [
        Setting(channel, field, getattr(channel, field), Extrapolation(mode))
        for channel in channels
        if not channel.locked
        for field, mode in (("pre", pre), ("post", post))
        if mode is not None
    ]
