"""What a format cannot hold is said before it is lost, and only that."""

import pytest
from hypothesis import given

from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.formats import FORMATS, losses, read_bytes, write_bytes
from model.formats.content import Content, differences
from model.keyframe import TangentRule, make_run
from tests.model.formats.clips import clips, facts


def clip_with(**channel: object) -> Clip:
    run = make_run([0, 1, 2], [0, 3, 1])
    return Clip([Channel("channel 0", run, **channel)], end=2)  # type: ignore[arg-type]


def keys(rule: TangentRule, side: str, broken: bool) -> Clip:
    run = make_run([0, 1, 2], [0, 3, 1], **{f"rules_{side}": rule}, broken=broken)
    return Clip([Channel("channel 0", run)], end=2)


LOST = {
    "nothing": (clip_with(), []),
    "a name": (Clip([Channel("hips")]), ["the name is lost of hips"]),
    "a unit": (clip_with(unit="m"), ["the unit is lost of channel 0"]),
    "a colour": (clip_with(color="#ff0000"), ["the colour is lost of channel 0"]),
    "a lock": (clip_with(locked=True), ["the lock is lost of channel 0"]),
    "a title": (Clip(title="Walk"), ["the title 'Walk' is lost"]),
    "a frame rate": (Clip(frame_rate=24), ["the frame rate becomes 30 instead of 24"]),
    "held spans": (
        keys(TangentRule.STEP, "out", True),
        ["3 keys are no longer step but flat on the out side, in channel 0"],
    ),
    "the rule auto": (
        keys(TangentRule.AUTO, "in", True),
        ["3 keys are no longer auto but fixed on the in side, in channel 0"],
    ),
    "broken tangents": (
        keys(TangentRule.SMOOTH, "in", True),
        ["3 keys are no longer marked as broken, in channel 0"],
    ),
    "unified tangents": (
        keys(TangentRule.FLAT, "in", False),
        ["3 keys are no longer marked as unified, in channel 0"],
    ),
    "many names": (
        Clip([Channel(name) for name in "abcdef"]),
        ["the name is lost of 6 channels (a, b, ...)"],
    ),
}


@pytest.mark.parametrize(("clip", "expected"), LOST.values(), ids=LOST.keys())
def test_each_loss_is_one_sentence(clip: Clip, expected: list[str]) -> None:
    assert losses(clip, "anim") == expected
    assert losses(clip, "hermite") == []


@pytest.mark.parametrize("format_name", FORMATS)
@given(clip=clips())
def test_nothing_is_lost_that_is_not_said_and_nothing_said_that_is_kept(format_name: str, clip: Clip) -> None:
    again = read_bytes(write_bytes(clip, format_name), "x")
    assert (losses(clip, format_name) == []) == (facts(again) == facts(clip))
    assert differences(Content.of(clip), Content.of(again)) == losses(clip, format_name)


@pytest.mark.parametrize("format_name", FORMATS)
@given(clip=clips())
def test_what_was_lost_once_is_not_lost_again(format_name: str, clip: Clip) -> None:
    assert losses(read_bytes(write_bytes(clip, format_name), "x"), format_name) == []


def test_a_clip_of_other_keys_or_channels_is_different() -> None:
    clip = clip_with(post=Extrapolation.CYCLE)
    other = Clip([Channel("channel 0", make_run([0, 1], [0, 3]), post=Extrapolation.LINEAR)], start=-0.0, end=2)
    assert differences(Content.of(clip), Content.of(other)) == [
        "the range becomes -0.0 to 2.0",
        "the extrapolation changes of channel 0",
        "1 key is lost or added, in channel 0",
    ]
    assert differences(Content.of(clip), Content.of(Clip())) == ["1 channels become 0"]


@pytest.mark.parametrize("field", ["time", "value"])
def test_a_zero_that_lost_its_sign_is_a_difference(field: str) -> None:
    run = make_run([0.0, 1], [0.0, 1])
    other = run.copy()
    other[field][0] = -0.0
    contents = [Content.of(Clip([Channel("c", keys)])) for keys in (run, other)]
    assert differences(*contents) == ["1 key is moved, in c"]
