"""What a format cannot hold is said before it is lost, and only that."""

import numpy as np
import pytest
from hypothesis import given

from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.formats import FORMATS, content, losses, read_bytes, write_bytes
from model.formats.content import ChannelContent, Content, differences
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
    "a name": (Clip([Channel("hips")]), ["the name of hips is lost"]),
    "a unit": (clip_with(unit="m"), ["the unit of channel 0 is lost"]),
    "a color": (clip_with(color="#ff0000"), ["the color of channel 0 is lost"]),
    "a lock": (clip_with(locked=True), ["the lock of channel 0 is lost"]),
    "a title": (Clip(title="Walk"), ["the title 'Walk' is lost"]),
    "a frame rate": (Clip(frame_rate=24), ["the frame rate becomes 30 instead of 24"]),
    "held spans": (
        keys(TangentRule.STEP, "out", True),
        ["3 keys of channel 0 no longer hold their values: step becomes flat"],
    ),
    "the rule auto": (
        keys(TangentRule.AUTO, "in", True),
        ["3 keys of channel 0 become fixed instead of auto on the in side"],
    ),
    "broken tangents": (
        keys(TangentRule.SMOOTH, "in", True),
        ["3 keys of channel 0 are no longer marked as broken"],
    ),
    "unified tangents": (
        keys(TangentRule.FLAT, "in", False),
        ["3 keys of channel 0 are no longer marked as unified"],
    ),
    "many names": (
        Clip([Channel(name) for name in "abcdef"]),
        ["the names of 6 channels (a, b, ...) are lost"],
    ),
}


@pytest.mark.parametrize(("clip", "expected"), LOST.values(), ids=LOST.keys())
def test_each_loss_is_one_sentence(clip: Clip, expected: list[str]) -> None:
    assert [str(loss) for loss in losses(clip, "anim")] == expected
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
    assert [str(loss) for loss in differences(Content.of(clip), Content.of(other))] == [
        "1 key of channel 0 is lost or added",
        "the extrapolation of channel 0 changes",
        "the range becomes -0.0 to 2.0",
    ]
    assert [str(loss) for loss in differences(Content.of(clip), Content.of(Clip()))] == [
        "there are 0 channels instead of 1"
    ]


def test_many_keys_lose_the_same_however_they_are_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(4)
    slopes = random.normal(size=(2, 60))
    rules = [random.choice(TangentRule, 60) for _ in "io"]
    run = make_run(range(60), slopes[0], *slopes, *rules, broken=random.random(60) < 0.5)
    other = run.copy()
    other["rule_in"][::2], other["slope_out"][::3], other["value"][::11] = TangentRule.FLAT, 1, 0
    runs = [(keys[:20], keys[20:23], keys[23:]) for keys in (run, other)]
    a, b = (Content(0, 1, [ChannelContent(f"c{i}", r) for i, r in enumerate(three)]) for three in runs)
    whole = differences(a, b)
    assert len(whole) > 6
    for size in (1, 2, 7, 59):
        monkeypatch.setattr(content, "_KEYS", size)
        assert differences(a, b) == whole


@pytest.mark.parametrize("field", ["time", "value"])
def test_a_zero_that_lost_its_sign_is_a_difference(field: str) -> None:
    run = make_run([0.0, 1], [0.0, 1])
    other = run.copy()
    other[field][0] = -0.0
    contents = [Content.of(Clip([Channel("c", keys)])) for keys in (run, other)]
    assert [str(loss) for loss in differences(*contents)] == ["1 key of c is moved"]


def test_what_changes_the_motion_comes_before_what_changes_only_the_editing() -> None:
    run = make_run([0, 1, 2], [0, 3, 1], rules_in=TangentRule.AUTO, rules_out=TangentRule.STEP, broken=True)
    lost = losses(Clip([Channel("lamp", run, locked=True)], end=2, frame_rate=24), "anim")
    assert [(loss.what, loss.in_motion) for loss in lost] == [
        ("steps", True),
        ("auto tangents", False),
        ("the frame rate", False),
        ("names", False),
        ("locks", False),
    ]
