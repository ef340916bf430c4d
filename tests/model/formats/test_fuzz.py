"""Damaged files: refused with a FormatError, or read as a sound clip; never anything else."""

import random
from pathlib import Path

import pytest

from model.formats import FORMATS, FormatError, read_bytes, sniff, write_bytes
from tests.model.formats.test_anim import PLAIN
from tests.model.formats.test_native import TEXT

WORDS = [
    *("{", "}", "channel", "keys", "0", "1", "-0.0", "1e999", "nan", "inf", "1_0", ".", "-", "e", "flat", "linear"),
    *("smooth", "step", "auto", "broken", "end", "range", "numchannels", "extrapolate", "cycle_offset", "title", '"'),
    *('"a"', '"\\u0000"', "\0", "\x0b", "\x1c", "\x85", "\u2028", "١", "#", "//", "4294967296", "-1", "0x1", "5e-324"),
]


def damaged(data: bytes, chance: random.Random) -> bytes:
    """*data* with one to four mistakes of the kinds that disks, editors and enemies make."""
    for _ in range(chance.randint(1, 4)):
        start = chance.randrange(len(data) + 1)
        end = min(len(data), start + chance.choice([0, 1, 1, 2, 5, 30]))
        match chance.randrange(6):
            case 0:
                data = data[:start] + bytes([chance.randrange(256)]) + data[start + 1 :]
            case 1:
                data = data[:start] + data[end:]
            case 2:
                data = data[:start] + f" {chance.choice(WORDS)} ".encode() + data[end:]
            case 3:
                data = data[:start] + chance.choice(WORDS).encode() + data[start:]
            case 4:
                data = data[:start] + data[start:end] * chance.randint(2, 5) + data[end:]
            case 5:
                other = chance.randrange(len(data) + 1)
                data = data[:start] + data[other : other + 40] + data[end:]
    return data


def survives(data: bytes) -> bool:
    """Whether *data* is read; then the clip is sound and comes back from what is written of it."""
    try:
        clip = read_bytes(data, "fuzz.anim")
    except FormatError as error:
        sentence = str(error)
        assert sentence.startswith("fuzz.anim:")
        assert sentence.isprintable()
        return False
    clip.check()
    format_name = sniff(data)
    again = write_bytes(clip, format_name)
    assert write_bytes(read_bytes(again, "x"), format_name) == again
    return True


def run_fuzz(data: bytes, seed: int, cases: int) -> None:
    chance = random.Random(seed)
    read = sum(survives(damaged(data, chance)) for _ in range(cases))
    assert 0 < read < cases


@pytest.mark.parametrize("data", [PLAIN.encode(), TEXT.encode()], ids=["anim", "hermite"])
@pytest.mark.parametrize("seed", range(4))
def test_a_damaged_text_is_refused_or_read(data: bytes, seed: int) -> None:
    run_fuzz(data, seed, 1500)


@pytest.mark.parametrize("name", ["sample.anim", "all_rules_extrap.anim", "test.skel", "wasp.skel"])
def test_a_damaged_real_file_is_refused_or_read(shared: Path, name: str) -> None:
    data = (shared / "samples" / "cse169" / name).read_bytes()
    chance = random.Random(name)
    for _ in range(1000 if name == "sample.anim" else 200):
        survives(damaged(data, chance))


@pytest.mark.parametrize("format_name", FORMATS)
def test_junk_behind_a_good_beginning_is_refused(format_name: str) -> None:
    chance = random.Random(7)
    beginning = {"anim": b"animation {", "hermite": b"hermite 1\n"}[format_name]
    for _ in range(1500):
        words = " ".join(chance.choice(WORDS) for _ in range(chance.randint(0, 25))).encode()
        assert not survives(beginning + b" " + words)


def test_bytes_of_no_kind_are_refused() -> None:
    chance = random.Random(8)
    for _ in range(2000):
        assert not survives(chance.randbytes(chance.randint(0, 60)))
