"""The native format: loses nothing, and says where a text is wrong."""

import pytest
from hypothesis import given

from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.formats import FormatError, losses, read_bytes, write_bytes
from model.keyframe import TangentRule, make_run
from tests.model.formats.clips import clips, facts

TEXT = """hermite 1
title "A walk"
range 0.0 2.5
rate 24.0

channel "root.tx" {
  unit "m"
  color "#ff8000"
  locked
  extrapolate constant cycle_offset
  keys {
    -0.5 -0.0 smooth step
    1e-07 0.30000000000000004 13.7 -0.22 broken
    2.5 1.0 auto linear
  }
}

channel "quote \\" and brace }" {
  extrapolate linear bounce
  keys {
  }
}

end
"""


@given(clips())
def test_what_is_read_is_what_was_written_bit_for_bit(clip: Clip) -> None:
    data = write_bytes(clip, "hermite")
    assert losses(clip, "hermite") == []
    assert facts(read_bytes(data, "x")) == facts(clip)
    assert write_bytes(read_bytes(data, "x"), "hermite") == data


def test_the_text_is_this_text() -> None:
    run = make_run(
        [-0.5, 1e-7, 2.5],
        [-0.0, 0.1 + 0.2, 1],
        [0, 13.7, 0],
        [0, -0.22, 0],
        [TangentRule.SMOOTH, TangentRule.FIXED, TangentRule.AUTO],
        [TangentRule.STEP, TangentRule.FIXED, TangentRule.LINEAR],
        [False, True, False],
    )
    full = Channel("root.tx", run, post=Extrapolation.CYCLE_OFFSET, unit="m", color="#ff8000", locked=True)
    empty = Channel('quote " and brace }', pre=Extrapolation.LINEAR, post=Extrapolation.BOUNCE)
    clip = Clip([full, empty], end=2.5, frame_rate=24, title="A walk")
    assert write_bytes(clip, "hermite").decode() == TEXT
    assert facts(read_bytes(TEXT.encode(), "x")) == facts(clip)


@pytest.mark.parametrize(
    "text",
    [
        TEXT.replace("\n", "\r\n"),
        "\ufeff" + TEXT,
        TEXT.rstrip(),
        "\n\n" + TEXT,
        TEXT.replace("  ", "\t \t"),
    ],
    ids=["CRLF", "a byte order mark", "no line break at the end", "empty lines before", "more blanks"],
)
def test_how_an_editor_left_the_blanks_does_not_matter(text: str) -> None:
    assert facts(read_bytes(text.encode(), "x")) == facts(read_bytes(TEXT.encode(), "x"))


def test_changing_one_key_changes_one_line() -> None:
    clip = read_bytes(TEXT.encode(), "x")
    channel = clip.channels[0]
    run = channel.run()
    changed = run.copy()
    changed["value"][2] = 0.75
    channel.splice(run, changed)
    before, after = TEXT.splitlines(), write_bytes(clip, "hermite").decode().splitlines()
    assert [(a, b) for a, b in zip(before, after, strict=True) if a != b] == [
        ("    2.5 1.0 auto linear", "    2.5 0.75 auto linear")
    ]


@pytest.mark.parametrize("name", ["\ud800 half a character", "line\u2028break", "\x85\x1c", "tab\t", "\\", "é😀", "ا"])
def test_any_name_comes_back(name: str) -> None:
    clip = Clip([Channel(name)], title=name)
    again = read_bytes(write_bytes(clip, "hermite"), "x")
    assert (again.channels[0].name, again.title) == (name, name)


def test_a_name_too_long_for_any_file_is_refused_when_it_is_written() -> None:
    with pytest.raises(FormatError, match="a channel name is longer than 1024 bytes"):
        write_bytes(Clip([Channel("n" * 1025)]), "hermite")
    assert read_bytes(write_bytes(Clip([Channel("n" * 1024)]), "hermite"), "x").channels[0].name == "n" * 1024


WRONG = {
    "a newer version": (("hermite 1", "hermite 2"), (1, 9), "open it with a newer Hermite"),
    "version 0": (("hermite 1", "hermite 0"), (1, 9), "no format version 0"),
    "an unknown clause": (('title "A walk"', 'author "Ada"'), (2, 1), "found 'author'"),
    "an unknown clause of a channel": (("  locked", "  hidden"), (9, 3), "found 'hidden'"),
    "a remark": (("rate 24.0", "# 24 frames\nrate 24.0"), (4, 1), "found a comment"),
    "a clause twice": (("rate 24.0", "rate 24.0\nrate 25.0"), (5, 1), "'rate' a second time"),
    "a lock twice": (("  locked", "  locked\n  locked"), (10, 3), "'locked' a second time"),
    "no rate": (("rate 24.0\n", ""), (23, 1), "no frame rate"),
    "no range": (("range 0.0 2.5\n", ""), (23, 1), "no range"),
    "a rate of 0": (("rate 24.0", "rate 0"), (4, 1), "must be above 0"),
    "a text without quotes": (('unit "m"', "unit m"), (7, 8), "in double quotes, found 'm'"),
    "a quote never closed": (('"A walk"', '"A walk'), (2, 7), "a quote that does not end soon"),
    "a bad escape": (('"A walk"', '"A \\walk"'), (2, 7), "not a well-formed quoted text"),
    "a colour of another kind": (("#ff8000", "red"), (8, 3), "is not of the kind '#12ab9f'"),
    "a name twice": (('"quote \\" and brace }"', '"root.tx"'), (18, 1), "a second channel is named"),
    "no extrapolation": (("  extrapolate linear bounce\n", ""), (21, 1), "expected 'extrapolate'"),
    "a mistake behind letters of two bytes": (('"root.tx" {', '"hüfte" ['), (6, 17), "'{' of the channel"),
    "broken in front": (("    -0.5", "    broken -0.5"), (12, 5), "belongs behind a key"),
    "broken twice": (("-0.22 broken", "-0.22 broken broken"), (13, 49), "belongs behind a key"),
    "broken within": (("13.7 -0.22", "13.7 broken -0.22"), (13, 36), "belongs behind a key"),
    "stepped": (("smooth step", "smooth stepped"), (12, 22), "found 'stepped'"),
    "step for a tangent in": (("smooth step", "step smooth"), (12, 15), "tangent out only"),
    "cut off among the keys": ((TEXT[TEXT.index("    2.5 1.0") :], ""), (14, 1), "is the file whole?"),
    "cut off behind a channel": ((TEXT[TEXT.index('\nchannel "quote') :], ""), (17, 1), "take an older copy"),
    "text behind the end": (("end\n", "end\nend\n"), (25, 1), "'end' after the end"),
}


@pytest.mark.parametrize(("change", "place", "part"), WRONG.values(), ids=WRONG.keys())
def test_a_mistake_is_told_with_its_line_and_column(change: tuple[str, str], place: tuple[int, int], part: str) -> None:
    old, new = change
    assert old in TEXT
    with pytest.raises(FormatError) as caught:
        read_bytes(TEXT.replace(old, new, 1).encode(), "walk.hermite")
    assert str(caught.value).startswith(f"walk.hermite:{place[0]}:{place[1]}: ")
    assert part in str(caught.value)


@pytest.mark.parametrize("size", range(0, len(TEXT) - 1, 7))
def test_a_file_cut_off_anywhere_is_refused(size: int) -> None:
    with pytest.raises(FormatError):
        read_bytes(TEXT.encode()[:size], "x")
