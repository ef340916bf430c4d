"""What is done to channels as a whole: shown, locked, coloured, renamed."""

from collections.abc import Iterable, Mapping, Sequence

from model.channel import Channel
from model.document import Document, Setting
from model.selection import Selection
from model.session import Session


def named(channels: Sequence[Channel]) -> str:
    """How a label speaks of the channels."""
    return channels[0].name if len(channels) == 1 else f"{len(channels)} channels"


def set_shown(session: Session, channels: Iterable[Channel], shown: bool) -> None:
    """Take the channels out of the hidden ones, or add them."""
    hidden = set(session.hidden)
    session.hidden = hidden - set(channels) if shown else hidden | set(channels)


def set_solo(session: Session, channels: Iterable[Channel], solo: bool) -> None:
    """Add the channels to those that alone are shown, or take them out."""
    marked = set(session.solo)
    session.solo = marked | set(channels) if solo else marked - set(channels)


def show_only(document: Document, channels: Iterable[Channel]) -> None:
    """Hide all other channels."""
    document.session.solo = set()
    document.session.hidden = set(document.clip.channels) - set(channels)


def reveal_all(session: Session) -> None:
    """Show every channel."""
    session.solo = set()
    session.hidden = set()


def settings(channels: Iterable[Channel], field: str, value: object) -> list[Setting]:
    """The changes that give one field of all the channels this value."""
    return [Setting(c, field, getattr(c, field), value) for c in channels if getattr(c, field) != value]


def lock_label(channels: Sequence[Channel], locked: bool) -> str:
    """How undo names it."""
    return f"{'Lock' if locked else 'Unlock'} {named(channels)}"


def set_locked(document: Document, channels: Sequence[Channel], locked: bool) -> None:
    """Lock, which takes the keys out of the selection, or unlock; can be undone."""
    selection = document.session.selection
    document.do(
        lock_label(channels, locked),
        lambda clip: settings(channels, "locked", locked),
        selection=lambda _changes: unlocked(selection),
    )


def unlocked(selection: Selection) -> Selection:
    """The keys among these that can be changed."""
    return selection.with_only(channel for channel in selection.channels if not channel.locked)


def set_color(document: Document, channels: Sequence[Channel], color: str | None) -> None:
    """Give the channels a colour ("#rrggbb"), or the theme's; can be undone."""
    document.do(f"Color {named(channels)}", lambda clip: settings(channels, "color", color))


def rename(document: Document, names: Mapping[Channel, str]) -> str:
    """Give channels new names; can be undone. What is wrong with the names, or ""."""
    names = {channel: name for channel, name in names.items() if name != channel.name}
    if not names:
        return ""
    for name in names.values():
        if problem := _problem_of(name):
            return problem
    others = {channel.name for channel in document.clip.channels if channel not in names}
    taken = next((name for name in names.values() if name in others), None)
    if taken is not None or len(set(names.values())) < len(names):
        return f"There already is a channel {taken or next(iter(names.values()))}"
    first, name = next(iter(names.items()))
    label = f"Rename {first.name} to {name}" if len(names) == 1 else f"Rename {len(names)} channels"
    document.do(label, lambda clip: [Setting(c, "name", c.name, new) for c, new in names.items()])
    return ""


def _problem_of(name: str) -> str:
    if not name.strip(".").strip() or name.endswith("."):
        return "A channel needs a name"
    if not name.isprintable() or len(name.encode()) > 1024:
        return "A name holds printable characters only, at most 1024 bytes of them"
    return ""
