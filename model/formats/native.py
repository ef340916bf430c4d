"""The native text format, which loses nothing: a version line, then a clause or key a line, in a fixed order.

    file    = "hermite" VERSION  { "title" TEXT | "range" NUMBER NUMBER | "rate" NUMBER | channel }  "end"
    channel = "channel" TEXT "{" { "unit" TEXT | "color" TEXT | "locked" | "extrapolate" MODE MODE | keys } "}"
    keys    = "keys" "{" { TIME VALUE TANGENT TANGENT ["broken"] } "}"

A TANGENT (in, then out) is a rule's word or a number, the slope of a fixed one. TEXT is quoted as in JSON. Range, rate,
extrapolate and keys must be there, every clause at most once; seconds, frames per second, units per second.
There are no comments: what a file says is in the clip or is refused, so that opening and saving never drops a word.
"""

import re
from typing import Final

from model.extrapolation import Extrapolation
from model.formats.content import ChannelContent, Content
from model.formats.error import MAX_CHANNELS, MAX_KEYS, TextError, meant, shown
from model.formats.keys import KeyWriter, Words, run_from_text
from model.formats.scanner import Scanner, Token, checked_text, quoted
from model.keyframe import Run, TangentRule
from model.progress import Report, unheard

VERSION: Final = 1
_WRITTEN: Final = {int(rule): rule.word for rule in TangentRule if rule is not TangentRule.FIXED}
_WORDS_OUT: Final[Words] = {word.encode(): rule for rule, word in _WRITTEN.items()}
_WORDS_IN: Final[Words] = {word: rule for word, rule in _WORDS_OUT.items() if rule != TangentRule.STEP}
_MODES: Final = {mode.word: mode for mode in Extrapolation}
_WORDS: Final = {mode: word for word, mode in _MODES.items()}
_COLOR: Final = re.compile(r"#[0-9a-fA-F]{6}\Z")


def read(data: bytes, report: Report = unheard) -> Content:
    """The content of a native file. Raises TextError."""
    scanner = Scanner(data, report=report)
    scanner.expect(b"hermite")
    _check_version(scanner)
    # Every channel has a brace; the second count takes longer, since it stops at every line.
    if data.count(b"{") > MAX_CHANNELS and data.count(b"\nchannel") > MAX_CHANNELS:
        raise TextError(0, f"more than {MAX_CHANNELS} channels")
    title: str | None = None
    span: tuple[float, float] | None = None
    rate: float | None = None
    channels: dict[str, ChannelContent] = {}
    while (token := scanner.next()).text != b"end":
        if token.text == b"title" and title is None:
            title = scanner.text("the title")
        elif token.text == b"range" and span is None:
            span = scanner.number("the start of the range"), scanner.number("the end of the range")
        elif token.text == b"rate" and rate is None:
            rate = scanner.number("the frames per second")
            if rate <= 0:
                raise TextError(token.start, f"the frame rate is {rate:g}", "it must be above 0")
        elif token.text == b"channel":
            if len(channels) == MAX_CHANNELS:
                raise TextError(token.start, f"more than {MAX_CHANNELS} channels")
            channel = _read_channel(scanner)
            if channel.name in channels:
                raise TextError(token.start, f"a second channel is named {shown(channel.name)}", "rename one of them")
            channels[channel.name] = channel
        else:
            raise _unexpected(token, ("title", "range", "rate", "channel", "end"))
    scanner.expect_end()
    if span is None:
        raise TextError(token.start, "the clip has no range", "add a line such as 'range 0.0 4.0' (seconds)")
    if rate is None:
        raise TextError(token.start, "the clip has no frame rate", "add a line such as 'rate 30.0'")
    return Content(*span, list(channels.values()), rate, title or "")


def _check_version(scanner: Scanner) -> None:
    token = scanner.peek()
    version = scanner.count("the version number of the format")
    if version > VERSION:
        problem = f"the file has format version {version}, this program reads version {VERSION}"
        raise TextError(token.start, problem, "open it with a newer Hermite")
    if version < 1:
        raise TextError(token.start, f"there is no format version {version}")


def _unexpected(token: Token, words: tuple[str, ...]) -> TextError:
    known = ", ".join(words)
    if token.text.startswith(b"#"):
        return TextError(token.start, "found a comment, which this format has not", "put remarks into the title")
    if token.text.decode("ascii", "replace") in words:
        return TextError(token.start, f"found {shown(token.text)} a second time", "delete one of them")
    remedy = meant(token.text, words) if token.text else "the file is cut off; take an older copy"
    return TextError(token.start, f"expected one of {known}, found {shown(token.text)}", remedy)


def _read_channel(scanner: Scanner) -> ChannelContent:
    name = scanner.text("the channel's name")
    scanner.expect(b"{", "'{' of the channel")
    unit: str | None = None
    color: str | None = None
    locked = False
    modes: tuple[Extrapolation, Extrapolation] | None = None
    run: Run | None = None
    while (token := scanner.next()).text != b"}":
        if token.text == b"unit" and unit is None:
            unit = scanner.text("the unit")
        elif token.text == b"color" and color is None:
            color = _checked_color(scanner.text("the color"), token.start)
        elif token.text == b"locked" and not locked:
            locked = True
        elif token.text == b"extrapolate" and modes is None:
            pre = scanner.one_of(_MODES, "the extrapolation before the first key")
            post = scanner.one_of(_MODES, "the extrapolation after the last key")
            modes = _MODES[pre], _MODES[post]
        elif token.text == b"keys" and run is None:
            run = _read_keys(scanner)
        else:
            raise _unexpected(token, ("unit", "color", "locked", "extrapolate", "keys", "}"))
    if modes is None or run is None:
        missing = "'extrapolate'" if modes is None else "'keys'"
        raise TextError(token.start, f"expected {missing} in the channel {shown(name)}, found its end")
    return ChannelContent(name, run, *modes, unit or "", color, locked)


def _read_keys(scanner: Scanner) -> Run:
    token = scanner.expect(b"{", "'{' of the keys")
    start = scanner.position
    run = run_from_text(scanner, start, scanner.end_of_block(), _WORDS_IN, _WORDS_OUT, flags=True)
    if len(run) > MAX_KEYS:
        raise TextError(token.start, f"{len(run)} keys in one channel; at most {MAX_KEYS} are read")
    return run


def _checked_color(color: str, start: int = 0) -> str:
    if not _COLOR.match(color):
        raise TextError(start, f"the color {shown(color)} is not of the kind '#12ab9f'")
    return color


def held(content: Content) -> Content:
    """What is left of *content* in this format: everything."""
    return content


def write(content: Content, report: Report = unheard) -> bytes:
    """The text of *content*, the same bytes for the same content. Raises TextError when a text is too long."""
    keys = KeyWriter(_WRITTEN, "    ", " ", flags=True)
    head = [f"hermite {VERSION}\n"]
    if content.title:
        head.append(f"title {quoted(checked_text(content.title, 'the title'))}\n")
    head.append(f"range {content.start!r} {content.end!r}\nrate {content.frame_rate!r}\n")
    parts = ["".join(head).encode()]
    texts = keys.texts([channel.run for channel in content.channels], report)
    for channel, text in zip(content.channels, texts, strict=True):
        parts += [_channel_head(channel).encode(), *text, b"  }\n}\n"]
    parts.append(b"\nend\n")
    return b"".join(parts)


def _channel_head(channel: ChannelContent) -> str:
    lines = [f"\nchannel {quoted(checked_text(channel.name, 'a channel name'))} {{"]
    if channel.unit:
        lines.append(f"  unit {quoted(checked_text(channel.unit, 'a unit'))}")
    if channel.color is not None:
        lines.append(f"  color {quoted(_checked_color(channel.color))}")
    if channel.locked:
        lines.append("  locked")
    return "\n".join([*lines, f"  extrapolate {_WORDS[channel.pre]} {_WORDS[channel.post]}", "  keys {", ""])
