"""Large blocks of keys are read by column, piece by piece: the same keys, and the same mistakes at the same places."""

import re

import numpy as np
import pytest

from model.channel import Channel
from model.clip import Clip
from model.formats import FormatError, keys, read_bytes, write_bytes
from model.keyframe import Run, TangentRule, make_run

N = 20_000
CHANCE = np.random.default_rng(11)


def large_run() -> Run:
    """Keys of all kinds that a native file can hold, many of them broken."""
    rules_in = CHANCE.choice([0, 1, 2, 3, 5], N)
    rules_out = CHANCE.choice([0, 1, 2, 3, 4, 5], N)
    numbers = CHANCE.normal(size=(3, N)) * 10.0 ** CHANCE.integers(-9, 9, (3, N))
    return make_run(np.cumsum(CHANCE.uniform(0.001, 1, N)), *numbers, rules_in, rules_out, CHANCE.random(N) < 0.3)


RUN = large_run()
TEXT = write_bytes(Clip([Channel("c", RUN)]), "hermite")
START = TEXT.index(b"keys {") + 7
END = TEXT.index(b"}", START)
KEYS = TEXT[START:END]
MANY = b"".join(b"%d.0 0.5 flat flat\n" % i for i in range(-1000, 0))


def read_keys(text: bytes) -> Run:
    return read_bytes(TEXT[:START] + text + TEXT[END:], "x").channels[0].run()


LAYOUTS = {
    "as written": KEYS,
    "CRLF": KEYS.replace(b"\n", b"\r\n"),
    "all on one line": KEYS.replace(b"\n", b" "),
    "one word a line": b"\n".join(KEYS.split()),
    "two words a line": KEYS.replace(b" ", b"\n").replace(b"\n\n\n\n", b""),
    "far apart": KEYS.replace(b"\n", b"\n" + b" " * 200),
    "a desert of blanks": KEYS[: len(KEYS) // 2].rpartition(b"\n")[0]
    + b" \n" * 400_000
    + KEYS[len(KEYS[: len(KEYS) // 2].rpartition(b"\n")[0]) :],
}


@pytest.mark.parametrize("text", LAYOUTS.values(), ids=LAYOUTS.keys())
def test_many_keys_are_the_same_however_they_are_laid_out(text: bytes) -> None:
    again = read_keys(text)
    for field in ("time", "value", "rule_in", "rule_out", "broken"):
        assert again[field].tobytes() == RUN[field].tobytes(), field
    for side in ("in", "out"):
        fixed = RUN[f"rule_{side}"] == TangentRule.FIXED
        assert again[f"slope_{side}"][fixed].tobytes() == RUN[f"slope_{side}"][fixed].tobytes()


FEW = KEYS[:30_000].rpartition(b"\n")[0]


@pytest.mark.parametrize("text", [FEW, b"\n".join(FEW.split())], ids=["a key a line", "a word a line"])
def test_it_does_not_matter_where_a_piece_happens_to_end(text: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    expected = read_keys(text)
    monkeypatch.setattr(keys, "_SMALL", 100)
    for size in range(400, 700, 3):
        monkeypatch.setattr(keys, "_PIECE", size)
        assert read_keys(text).tobytes() == expected.tobytes()


MISTAKES = {
    # word of the key, what stands there instead, a part of the sentence
    "a time": (0, b"0x1", "expected the key's time (a number), found '0x1'"),
    "a value": (1, b"1_0", "expected the key's value (a number), found '1_0'"),
    "a value too large": (1, b"1e999", "'1e999' is too large"),
    "a tangent in": (2, b"smoth", "expected the tangent in"),
    "a tangent out": (3, b"broken", "'broken' belongs behind a key"),
    "a time that goes back": (0, b"-5.0", "-5.0 does not come after"),
}


@pytest.mark.parametrize("layout", [b"\n", b" "], ids=["a line a key", "all on one line"])
@pytest.mark.parametrize("number", [1, 5461, N - 1])
@pytest.mark.parametrize(("column", "word", "part"), MISTAKES.values(), ids=MISTAKES.keys())
def test_a_mistake_among_many_keys_is_found_where_it_is(
    layout: bytes, number: int, column: int, word: bytes, part: str
) -> None:
    lines = KEYS.split(b"\n")
    words = lines[number].split()
    lines[number] = b"    " + b" ".join([*words[:column], word, *words[column + 1 :]])
    text = layout.join(lines)
    with pytest.raises(FormatError) as caught:
        read_keys(text)
    assert part in str(caught.value)
    before = TEXT[:START] + layout.join(lines[:number]) + layout + b"    "
    before += b"".join(w + b" " for w in words[:column])
    place = (before.count(b"\n") + 1, len(before) - before.rfind(b"\n"))
    assert (caught.value.line, caught.value.column) == place


NO_NUMBERS = [
    b"1.2.",
    b"1.2.3",
    b"1..2",
    b"1..",
    b".",
    b"-.",
    b"-",
    b"+",
    b"1e",
    b".e1",
    b"1.e",
    b"e1",
    b"--1",
    b"1.-1",
]


@pytest.mark.parametrize("column", [0, 1, 2, 3])
@pytest.mark.parametrize("word", NO_NUMBERS, ids=bytes.decode)
def test_a_word_that_is_nearly_a_number_is_refused_among_many(word: bytes, column: int) -> None:
    words = [b"0.5", b"1.5", b"2.5", b"3.5"]
    words[column] = word
    with pytest.raises(FormatError, match=re.escape(f"found '{word.decode()}'")):
        read_keys(MANY + b" ".join(words) + b"\n")


@pytest.mark.parametrize(
    "word", [b"flat.", b".flat", b"flat.0", b"0.flat", b"smoothly", b"flatflatflat"], ids=bytes.decode
)
def test_a_word_that_is_nearly_a_rule_is_refused_among_many(word: bytes) -> None:
    with pytest.raises(FormatError, match=re.escape(f"found '{word.decode()}'")):
        read_keys(MANY + b"0.0 0.5 " + word + b" flat\n")


@pytest.mark.parametrize("blanks", [b"\n", b" " * 3000], ids=["a word a line", "far apart"])
def test_broken_twice_is_refused_wherever_a_piece_ends(blanks: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    text = b"0 1 flat flat broken broken\n1 1 flat flat\n".replace(b" ", blanks) + FEW.replace(b"broken", b"")
    monkeypatch.setattr(keys, "_SMALL", 10)
    for size in range(10, 40):
        monkeypatch.setattr(keys, "_PIECE", size)
        with pytest.raises(FormatError, match="'broken' belongs behind a key, once"):
            read_keys(text)


def test_many_short_channels_come_back_in_their_order() -> None:
    runs = [RUN[first : first + size] for first, size in zip(range(0, N, 20), np.arange(1000) % 20, strict=True)]
    clip = Clip([Channel(f"c{i}", run) for i, run in enumerate(runs)])
    for format_name in ("hermite", "anim"):
        again = read_bytes(write_bytes(clip, format_name), "x")
        assert [len(channel) for channel in again.channels] == list(map(len, runs))
        for channel, run in zip(again.channels, runs, strict=True):
            assert channel.run()["value"].tobytes() == run["value"].tobytes()
