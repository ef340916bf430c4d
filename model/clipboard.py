"""Clipboard: keys as plain text that another window, a mail or a spreadsheet can hold."""

from math import isfinite
from typing import NamedTuple

import numpy as np

from model.channel import Channel
from model.keyframe import Run, TangentRule, make_run
from model.progress import Report, unheard
from model.selection import Selection

HEADER = "hermite-keys 1"
MOST_KEYS = 200_000
MOST_CHARACTERS = 64 * 1024 * 1024
LONGEST_LINE = 8192
# Lines between two looks at whether anybody still wants them.
AT_A_TIME = 4096
_FIELDS = "channel, time, value, slope in, slope out, rule in, rule out, unified or broken"
_NUMBER_CHARACTERS = frozenset("0123456789+-.eE")
_WORDS = [rule.word for rule in TangentRule]
_RULES = {rule.word: int(rule) for rule in TangentRule}
_ESCAPES = {"\\": "\\\\", "\t": "\\t", "\n": "\\n", "\r": "\\r"}


class CopiedKeys(NamedTuple):
    """Keys on the clipboard: a run without ids for each channel name, in the order of the copied channels."""

    runs: dict[str, Run]

    @property
    def key_count(self) -> int:
        """How many keys."""
        return sum(len(run) for run in self.runs.values())

    @property
    def start(self) -> float:
        """The time of the first key."""
        return min(float(run["time"][0]) for run in self.runs.values())


def text_from_keys(selection: Selection, report: Report = unheard) -> str:
    """The selected keys as text, one a line, fields parted by tabs; ValueError if they are more than MOST_KEYS."""
    if selection.count > MOST_KEYS:
        raise ValueError(f"{selection.count:,} keys are too many for the clipboard, which takes {MOST_KEYS:,}")
    lines = [HEADER]
    for channel in selection.channels:
        name, keys = _escaped(channel.name), channel.keys_of(selection.ids(channel))
        # Piece by piece: no other thread goes on while records become Python numbers.
        for first in range(0, len(keys), AT_A_TIME):
            report(len(lines) / selection.count)
            lines += [_line_from_row(name, *row) for row in keys[first : first + AT_A_TIME].tolist()]
    return "\n".join(lines) + "\n"


def _line_from_row(
    name: str,
    time: float,
    value: float,
    slope_in: float,
    slope_out: float,
    rule_in: int,
    rule_out: int,
    broken: bool,
    _id: int,
) -> str:
    side = "broken" if broken else "unified"
    return f"{name}\t{time!r}\t{value!r}\t{slope_in!r}\t{slope_out!r}\t{_WORDS[rule_in]}\t{_WORDS[rule_out]}\t{side}"


def keys_from_text(text: str, report: Report = unheard) -> CopiedKeys:
    """The keys in *text*; ValueError, with the line, if it is no text of ours, damaged, or of too many keys."""
    if not text.startswith(HEADER):
        raise ValueError("the clipboard holds no keys")
    if len(text) > MOST_CHARACTERS or text.count("\n") > MOST_KEYS + 1:
        raise ValueError(f"the clipboard holds too much: at most {MOST_KEYS:,} keys can be pasted")
    lines = text.replace("\r\n", "\n").split("\n")
    if lines[0].rstrip() != HEADER:
        raise ValueError("the clipboard holds keys of another version of Hermite")
    rows: dict[str, list[tuple[float | int | bool, ...]]] = {}
    for number, line in enumerate(lines[1:], start=2):
        if number % AT_A_TIME == 0:
            report(number / len(lines))
        if not line or line.isspace():
            continue
        try:
            name, row = _row_from_line(line)
        except ValueError as error:
            raise ValueError(f"line {number} of the clipboard: {error}") from None
        rows.setdefault(name, []).append(row)
    if not rows:
        raise ValueError("the clipboard holds no keys")
    return CopiedKeys({name: _run_from_rows(name, keys) for name, keys in rows.items()})


def _row_from_line(line: str) -> tuple[str, tuple[float | int | bool, ...]]:
    fields = line.split("\t") if len(line) <= LONGEST_LINE else []
    if len(fields) != 8:
        raise ValueError(f"expected {_FIELDS}, parted by tabs")
    rule_in, rule_out = _rule(fields[5]), _rule(fields[6])
    if rule_in == TangentRule.STEP:
        raise ValueError("step is a rule of the side out")
    if fields[7] not in ("unified", "broken"):
        raise ValueError(f"expected unified or broken, found {fields[7][:20]!r}")
    numbers = (_number(field) for field in fields[1:5])
    name = _unescaped(fields[0]) if "\\" in fields[0] else fields[0]
    return name, (*numbers, rule_in, rule_out, fields[7] == "broken")


def _rule(word: str) -> int:
    rule = _RULES.get(word)
    return int(TangentRule.from_word(word)) if rule is None else rule


def _number(field: str) -> float:
    if not field or not _NUMBER_CHARACTERS.issuperset(field):
        raise ValueError(f"{field[:20]!r} is not a number")
    number = float(field)
    if not isfinite(number):
        raise ValueError(f"{field[:20]} is too large")
    return number


def _run_from_rows(name: str, rows: list[tuple[float | int | bool, ...]]) -> Run:
    run = make_run(*(np.array(column) for column in zip(*rows, strict=True)))
    run = run[run["time"].argsort(kind="stable")]
    same = np.flatnonzero(run["time"][1:] == run["time"][:-1])
    if len(same):
        raise ValueError(f"the clipboard holds two keys of {name} at {float(run['time'][same[0]])!r} s")
    return run


def _escaped(name: str) -> str:
    return "".join(_ESCAPES.get(character, character) for character in name)


def _unescaped(text: str) -> str:
    parts, characters = [], iter(text)
    for character in characters:
        if character == "\\":
            character = {"t": "\t", "n": "\n", "r": "\r", "\\": "\\"}.get(next(characters, ""), "")
        parts.append(character)
    return "".join(parts)


def onto_channels(copied: CopiedKeys, channels: list[Channel], active: Channel | None) -> dict[Channel, Run]:
    """Which channel gets which keys: by name; if no name is known, one by one from the active channel on.

    Keys of a name that is not known go to the active channel if they are the only such and it gets no others.
    """
    by_name = {channel.name: channel for channel in channels}
    found = {by_name[name]: run for name, run in copied.runs.items() if name in by_name}
    rest = [run for name, run in copied.runs.items() if name not in by_name]
    if found:
        if len(rest) == 1 and active is not None and active not in found:
            found[active] = rest[0]
        return found
    first = channels.index(active) if active in channels else 0
    return dict(zip(channels[first:], rest, strict=False))
