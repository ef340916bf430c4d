"""The course's .anim: read as people have it, written as the course's own programs read it."""

import csv
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given

from model.channel import Channel
from model.clip import Clip
from model.formats import FormatError, losses, read_bytes, read_clip, write_bytes
from model.keyframe import TangentRule, make_run
from tests.model.formats.clips import clips, course_clips, facts
from tests.model.formats.course_reader import CourseChannel, CourseClip, read_course

FILES = ["sample.anim", "wasp_walk.anim", "all_rules_extrap.anim"]

PLAIN = """animation {
  range 0.0 2.0
  numchannels 2
  channel {
    extrapolate constant linear
    keys 3 {
      0.0 0.1 smooth smooth
      0.5 -0.3 flat flat
      1.1 0.4 13.7 -0.22
    }
  }
  channel {
    extrapolate cycle bounce
    keys 0 {
    }
  }
}
"""


def course_view(clip: Clip) -> CourseClip:
    """What a program of the course should have in memory after it loaded *clip*."""
    expected = CourseClip((clip.start, clip.end))
    for channel in clip.channels:
        rows = []
        for key in channel:
            tangents = [
                slope if rule is TangentRule.FIXED else rule.word
                for rule, slope in ((key.rule_in, key.slope_in), (key.rule_out, key.slope_out))
            ]
            rows.append((key.time, key.value, *tangents))
        expected.channels.append(CourseChannel((channel.pre.word, channel.post.word), rows))
    return expected


LAYOUTS = {
    "an index": PLAIN.replace("channel {", "channel 0 {"),
    "an index that touches the brace": PLAIN.replace("channel {", "channel 14{"),
    "a brace that touches the word": PLAIN.replace("channel {", "channel{"),
    "tabs": PLAIN.replace("  ", "\t").replace(" ", "\t\t"),
    "CRLF": PLAIN.replace("\n", "\r\n"),
    "a byte order mark": "\ufeff" + PLAIN,
    "no line break at the end": PLAIN.rstrip("\n"),
    "empty lines before and between": "\n \n" + PLAIN.replace("\n", "\n\n"),
    "all on one line": PLAIN.replace("\n", " "),
    "one word a line": PLAIN.replace(" ", "\n"),
    "the clauses in another order": PLAIN.replace("  range 0.0 2.0\n", "").replace("\n}\n", "\n range 0.0 2.0\n}\n"),
    "numbers as C prints them": PLAIN.replace("0.1 ", "0.100000 ")
    .replace("13.7", "1.37e+01")
    .replace("-0.22", "-22E-2"),
    "numbers without a digit before or behind the point": PLAIN.replace("0.0 0.1", "0. .1").replace("-0.3", "-.3"),
    "a plus": PLAIN.replace("0.4", "+0.4"),
}


@pytest.mark.parametrize("text", LAYOUTS.values(), ids=LAYOUTS.keys())
def test_however_the_text_is_laid_out_the_clip_is_the_same(text: str) -> None:
    assert facts(read_bytes(text.encode(), "x")) == facts(read_bytes(PLAIN.encode(), "x"))


def test_a_number_for_a_tangent_is_the_slope_of_a_fixed_one() -> None:
    last = read_bytes(PLAIN.encode(), "x").channels[0].last
    assert last is not None
    assert (last.rule_in, last.rule_out) == (TangentRule.FIXED, TangentRule.FIXED)
    assert (last.slope_in, last.slope_out) == (13.7, -0.22)


@pytest.mark.parametrize("word", ["step", "stepped"])
def test_step_is_read_as_a_rule_of_the_tangent_out(word: str) -> None:
    clip = read_bytes(PLAIN.replace("flat flat", f"flat {word}").encode(), "x")
    assert clip.channels[0].value(0.5 + 1e-9) == clip.channels[0].value(1.09) == -0.3


@pytest.mark.parametrize(
    ("tangents", "broken"),
    [("flat flat", False), ("2.5 2.5", False), ("2.5 2.6", True), ("flat linear", True), ("smooth 1.0", True)],
)
def test_tangents_that_differ_turn_apart_and_others_turn_together(tangents: str, broken: bool) -> None:
    clip = read_bytes(PLAIN.replace("flat flat", tangents).encode(), "x")
    assert list(clip.channels[0])[1].broken is broken


@pytest.mark.parametrize("name", FILES)
def test_a_real_file_comes_back_as_it_was(shared: Path, name: str) -> None:
    path = shared / "samples" / "cse169" / name
    clip = read_clip(path)
    again = write_bytes(clip, "anim")
    assert read_course(again) == course_view(clip)
    assert write_bytes(read_bytes(again, name), "anim") == again
    assert read_course(again) == read_course(path.read_bytes())


@pytest.mark.parametrize("name", FILES)
def test_a_real_file_is_held_by_both_formats_without_loss(shared: Path, name: str) -> None:
    path = shared / "samples" / "cse169" / name
    clip = read_clip(path)
    assert losses(clip, "anim", path) == []
    assert losses(clip, "hermite") == []
    assert facts(read_bytes(write_bytes(clip, "hermite"), name)) == facts(clip)


def test_values_agree_with_an_independent_evaluator(shared: Path) -> None:
    folder = shared / "samples" / "cse169"
    clip = read_clip(folder / "all_rules_extrap.anim")
    with open(folder / "all_rules_extrap.expected.csv", encoding="utf-8", newline="") as file:
        rows = [(int(row["channel"]), float(row["time"]), float(row["value"])) for row in csv.DictReader(file)]
    assert len(rows) > 3000
    for index, channel in enumerate(clip.channels):
        times, values = np.array([(time, value) for which, time, value in rows if which == index]).T
        np.testing.assert_allclose(channel.evaluate(times), values, rtol=1e-9, atol=1e-9)


@given(course_clips())
def test_what_is_read_is_what_was_written(clip: Clip) -> None:
    data = write_bytes(clip, "anim")
    assert losses(clip, "anim") == []
    assert facts(read_bytes(data, "x")) == facts(clip)
    assert write_bytes(read_bytes(data, "x"), "anim") == data


@given(clips())
def test_programs_of_the_course_read_what_is_written(clip: Clip) -> None:
    data = write_bytes(clip, "anim")
    assert read_course(data) == course_view(read_bytes(data, "x"))


def test_a_rule_the_course_has_no_word_for_becomes_its_slope() -> None:
    run = make_run([0, 1, 3], [0, 1, 1.5], rules_in=TangentRule.AUTO, rules_out=TangentRule.AUTO)
    clip = Clip([Channel("channel 0", run)], end=3)
    again = read_bytes(write_bytes(clip, "anim"), "x")
    times = np.linspace(-1, 4, 101)
    np.testing.assert_array_equal(again.channels[0].evaluate(times), clip.channels[0].evaluate(times))
    assert [key.rule_in for key in again.channels[0]] == [TangentRule.FIXED] * 3


def test_one_key_stands_on_a_line_of_its_own() -> None:
    lines = write_bytes(read_bytes(PLAIN.encode(), "x"), "anim").decode().splitlines()
    assert lines[:6] == [
        "animation {",
        "  range 0.0 2.0",
        "  numchannels 2",
        "  channel {",
        "    extrapolate constant linear",
        "    keys 3 {",
    ]
    assert lines[6:9] == [
        "      0.0\t0.1\tsmooth\tsmooth",
        "      0.5\t-0.3\tflat\tflat",
        "      1.1\t0.4\t13.7\t-0.22",
    ]
    assert {line.strip() for line in lines[9:11]} == {"}"}


WRONG = {
    # what to change, where the mistake is then said to be, and a part of the sentence
    "too few keys": (("keys 3", "keys 4"), (6, 10), "4 keys are announced, but 3 follow"),
    "too many keys": (("keys 3", "keys 2"), (6, 10), "2 keys are announced, but 3 follow"),
    "more keys than bytes": (("keys 3", "keys 4000000"), (6, 10), "more than the file can hold"),
    "another number of channels": (("numchannels 2", "numchannels 3"), (3, 3), "says 3, but the file holds 2"),
    "a brace too few": (("    }\n  }\n}", "    }\n  }"), (17, 1), "the end of the file"),
    "keys that do not end": (("    }\n", ""), (11, 3), "found 'channel'"),
    "a channel that does not end": (("    }\n  }\n", ""), (10, 11), "found '{' among the keys"),
    "a word that is no tangent": (("smooth smooth", "smooth smoth"), (7, 22), "smooth, step, stepped, or a number"),
    "step for a tangent in": (("flat flat", "step flat"), (8, 16), "step is a rule for the tangent out only"),
    "a time that is not after": (("0.5 -0.3", "0.0 -0.3"), (8, 7), "0.0 does not come after 0.0 (line 7)"),
    "times out of order": (("1.1 0.4", "0.25 0.4"), (9, 7), "0.25 does not come after 0.5 (line 8)"),
    "nan": (("-0.3", "nan"), (8, 11), "expected the key's value (a number), found 'nan'"),
    "inf": (("0.5", "-inf"), (8, 7), "expected the key's time (a number), found '-inf'"),
    "a number too large": (("-0.3", "1e999"), (8, 11), "'1e999' is too large for a number"),
    "a slope too large": (("13.7", "1e999"), (9, 15), "'1e999' is too large for a number"),
    "an underscore": (("0.1", "1_000"), (7, 11), "found '1_000'"),
    "digits of other scripts": (("0.1", "١٢"), (7, 11), "found '١٢'"),
    "hexadecimal": (("0.1", "0x1p3"), (7, 11), "found '0x1p3'"),
    "two points": (("0.1", "0.1.2"), (7, 11), "found '0.1.2'"),
    "a point alone": (("0.1", "."), (7, 11), "found '.'"),
    "a point behind a number with one": (("0.1", "0.1."), (7, 11), "found '0.1.'"),
    "a point behind a word": (("smooth smooth", "smooth smooth."), (7, 22), "found 'smooth.'"),
    "a NUL": (("0.1", "0.1\0"), (7, 11), "found '0.1\\x00'"),
    "a form feed": (("0.1 ", "0.1\f"), (7, 11), "found '0.1\\x0csmooth'"),
    "an endless word": (("0.1", "1" * 70), (7, 11), "longer than 64 characters"),
    "a key cut short": (("13.7 -0.22", "13.7"), (10, 5), "expected the tangent out, found '}'"),
    "an unknown clause": (("extrapolate constant", "extrapolation constant"), (5, 5), "found 'extrapolation'"),
    "an unknown extrapolation": (("constant linear", "constant loop"), (5, 26), "found 'loop'"),
    "a clause twice": (("  numchannels 2\n", "  numchannels 2\n  numchannels 2\n"), (4, 3), "a second time"),
    "no range": (("  range 0.0 2.0\n", ""), (16, 1), "no range"),
    "a channel without keys": (("    keys 0 {\n    }\n", ""), (14, 3), "has no keys block"),
    "text behind the end": (("\n}\n", "\n}\nanimation {"), (18, 1), "'animation' after the end"),
    "braces in braces": (("0.5 -0.3", "{ 0.5 -0.3 }"), (8, 7), "found '{' among the keys"),
}


@pytest.mark.parametrize(("change", "place", "part"), WRONG.values(), ids=WRONG.keys())
def test_a_mistake_is_told_with_its_line_and_column(change: tuple[str, str], place: tuple[int, int], part: str) -> None:
    old, new = change
    assert old in PLAIN
    with pytest.raises(FormatError) as caught:
        read_bytes(PLAIN.replace(old, new, 1).encode(), "walk.anim")
    assert str(caught.value).startswith(f"walk.anim:{place[0]}:{place[1]}: ")
    assert part in str(caught.value)
    assert "\n" not in str(caught.value)


def test_lines_and_columns_count_characters_not_bytes() -> None:
    with pytest.raises(FormatError) as caught:
        read_bytes("\ufeffanimation {\r\n\tränge 0 1".encode(), "x")
    assert (caught.value.line, caught.value.column) == (2, 2)
