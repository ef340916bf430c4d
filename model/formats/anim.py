"""The course's .anim: animation { range, numchannels, channels }, read as found, written as its own tokenizer reads.

Source: UCSD CSE169, project 3 "Keyframe animation" (S. Rotenberg) and the files of its students.
"""

import re
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from model.extrapolation import Extrapolation
from model.formats.content import ChannelContent, Content, joined
from model.formats.error import MAX_CHANNELS, MAX_KEYS, TextError, meant, shown
from model.formats.keys import KeyWriter, Words, run_from_text
from model.formats.scanner import Scanner, Token
from model.keyframe import Run, TangentRule
from model.progress import Report, unheard

# Words of the course; the word "step" is ours and is only read: its tokenizer would take it for slope 0.
_WRITTEN: Final = {
    int(TangentRule.FLAT): "flat",
    int(TangentRule.LINEAR): "linear",
    int(TangentRule.SMOOTH): "smooth",
}
_WORDS_IN: Final[Words] = {word.encode(): rule for rule, word in _WRITTEN.items()}
_WORDS_OUT: Final[Words] = {**_WORDS_IN, b"step": int(TangentRule.STEP), b"stepped": int(TangentRule.STEP)}
_CHANNEL: Final = re.compile(rb"\bchannel\b")
_MODES: Final = {mode.word: mode for mode in Extrapolation}
_WORDS: Final = {mode: word for word, mode in _MODES.items()}
# What is left of each rule: the course knows neither a rule of no overshoot nor a held span.
_HELD: Final = np.arange(max(TangentRule) + 1, dtype=np.uint8)
_HELD[TangentRule.AUTO], _HELD[TangentRule.STEP] = TangentRule.FIXED, TangentRule.FLAT
_NOT_HELD: Final = TangentRule.AUTO, TangentRule.STEP


def read(data: bytes, report: Report = unheard) -> Content:
    """The content of a course .anim; channels are named ``channel 0``, ``channel 1`` ... . Raises TextError."""
    scanner = Scanner(data, report=report)
    scanner.expect(b"animation")
    scanner.expect(b"{", "'{' after 'animation'")
    span: tuple[float, float] | None = None
    announced: tuple[int, Token] | None = None
    channels: list[ChannelContent] = []
    while (token := scanner.next()).text != b"}":
        if token.text == b"range" and span is None:
            span = scanner.number("the start of the range"), scanner.number("the end of the range")
        elif token.text == b"numchannels" and announced is None:
            announced = scanner.count("the number of channels"), token
            if announced[0] > MAX_CHANNELS:
                raise TextError(token.start, f"{announced[0]} channels are announced; at most {MAX_CHANNELS} are read")
        elif token.text == b"channel":
            if len(channels) == (announced[0] if announced else MAX_CHANNELS):
                raise _other_number(announced, len(_CHANNEL.findall(data)), token)
            channels.append(_read_channel(scanner, f"channel {len(channels)}"))
        else:
            missing = "'range', 'numchannels', 'channel' or '}'"
            twice = " a second time" if token.text in (b"range", b"numchannels") else ""
            remedy = "" if twice else meant(token.text, ("range", "numchannels", "channel"))
            raise TextError(token.start, f"expected {missing}, found {shown(token.text)}{twice}", remedy)
    scanner.expect_end()
    if span is None:
        raise TextError(token.start, "the clip has no range", "add a line such as 'range 0.0 4.0' (seconds)")
    if announced is None:
        raise TextError(token.start, "the clip has no numchannels", f"add the line 'numchannels {len(channels)}'")
    if announced[0] != len(channels):
        raise _other_number(announced, len(channels), token)
    return Content(*span, channels)


def _other_number(announced: tuple[int, Token] | None, held: int, token: Token) -> TextError:
    if announced is None:
        return TextError(token.start, f"more than {MAX_CHANNELS} channels")
    problem = f"numchannels says {announced[0]}, but the file holds {held} channels"
    return TextError(announced[1].start, problem, "correct the number, or look for the channels that are missing")


def _read_channel(scanner: Scanner, name: str) -> ChannelContent:
    index = scanner.peek()
    if index.text != b"{":
        if not index.text.isdigit():
            raise TextError(index.start, f"expected '{{' or a channel number, found {shown(index.text)}")
        scanner.next()
    scanner.expect(b"{", "'{' of the channel")
    modes: tuple[Extrapolation, Extrapolation] | None = None
    run: Run | None = None
    while (token := scanner.next()).text != b"}":
        if token.text == b"extrapolate" and modes is None:
            pre = scanner.one_of(_MODES, "the extrapolation before the first key")
            post = scanner.one_of(_MODES, "the extrapolation after the last key")
            modes = _MODES[pre], _MODES[post]
        elif token.text == b"keys" and run is None:
            run = _read_keys(scanner)
        else:
            twice = " a second time" if token.text in (b"extrapolate", b"keys") else ""
            problem = f"expected 'extrapolate', 'keys' or '}}', found {shown(token.text)}{twice}"
            raise TextError(token.start, problem, "" if twice else meant(token.text, ("extrapolate", "keys")))
    if run is None:
        raise TextError(token.start, f"{name} has no keys block", "an empty channel is written 'keys 0 { }'")
    pre_mode, post_mode = modes or (Extrapolation.CONSTANT, Extrapolation.CONSTANT)
    return ChannelContent(name, run, pre_mode, post_mode)


def _read_keys(scanner: Scanner) -> Run:
    token = scanner.peek()
    announced = scanner.count("the number of keys")
    scanner.expect(b"{", "'{' of the keys")
    start = scanner.position
    # A key takes 8 bytes at least ("0 0 1 1" and a blank): a number beyond that is refused before anything is made.
    if announced > min(MAX_KEYS, (len(scanner.data) - start) // 8 + 1):
        raise TextError(token.start, f"{announced} keys are announced, more than the file can hold")
    run = run_from_text(scanner, start, scanner.end_of_block(), _WORDS_IN, _WORDS_OUT, flags=False)
    if len(run) != announced:
        raise TextError(
            token.start, f"{announced} keys are announced, but {len(run)} follow", "correct the number of keys"
        )
    run["broken"] = broken_of(run)
    return run


def broken_of(run: Run) -> NDArray[np.bool_]:
    """Whether the tangents of each key turn apart, which the format does not say: other rules, or other slopes."""
    rules_in, rules_out = (np.ascontiguousarray(run[rules]) for rules in ("rule_in", "rule_out"))
    broken: NDArray[np.bool_] = rules_in != rules_out
    both_fixed = np.flatnonzero(~broken & (rules_in == TangentRule.FIXED))
    if len(both_fixed):
        broken[both_fixed] = run["slope_in"][both_fixed] != run["slope_out"][both_fixed]
    return broken


def held(content: Content) -> Content:
    """What is left of *content* in this format."""
    runs = _held_runs([channel.run for channel in content.channels])
    channels = [
        ChannelContent(f"channel {i}", run, channel.pre, channel.post)
        for i, (channel, run) in enumerate(zip(content.channels, runs, strict=True))
    ]
    return Content(content.start, content.end, channels)


def _held_runs(runs: list[Run]) -> list[Run]:
    """Slopes of a rule that the course does not know become numbers, a held span becomes a flat tangent.

    The runs themselves when all of it is held.
    """
    keys = joined(runs)
    rules_in, rules_out = (np.ascontiguousarray(keys[rules]) for rules in ("rule_in", "rule_out"))
    lost = any(bool((rules == rule).any()) for rules in (rules_in, rules_out) for rule in _NOT_HELD)
    if not lost and np.array_equal(broken_of(keys), keys["broken"]):
        return runs
    keys = keys.copy() if len(runs) == 1 else keys
    if lost:
        keys["rule_in"], keys["rule_out"] = _HELD[rules_in], _HELD[rules_out]
    keys["broken"] = broken_of(keys)
    return [keys[first:last] for first, last in pairwise(np.cumsum([0, *map(len, runs)]).tolist())]


def write(content: Content, report: Report = unheard) -> bytes:
    """The text of *content*, which must be what ``held`` leaves."""
    head = f"animation {{\n  range {content.start!r} {content.end!r}\n  numchannels {len(content.channels)}\n"
    parts = [head.encode()]
    keys = KeyWriter(_WRITTEN, "      ", "\t", flags=False)
    texts = keys.texts([channel.run for channel in content.channels], report)
    for channel, text in zip(content.channels, texts, strict=True):
        parts += [
            f"  channel {{\n    extrapolate {_WORDS[channel.pre]} {_WORDS[channel.post]}\n".encode(),
            b"    keys %d {\n" % len(channel.run),
            *text,
            b"    }\n  }\n",
        ]
    parts.append(b"}\n")
    return b"".join(parts)
