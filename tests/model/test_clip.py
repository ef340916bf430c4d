"""A clip: channels by name, a range, a frame rate."""

import pytest

from model.channel import Channel
from model.clip import Clip
from model.keyframe import make_run


def test_channels_are_found_by_name() -> None:
    channel = Channel("root.tx")
    clip = Clip([channel, Channel("root.ty")])
    assert clip.channel("root.tx") is channel
    with pytest.raises(KeyError, match="head"):
        clip.channel("head.tx")


def test_a_new_name_is_one_that_no_channel_has() -> None:
    clip = Clip([Channel("a"), Channel("a2")])
    assert [clip.unique_name(base) for base in ("b", "a", "a2")] == ["b", "a3", "a22"]


def test_keys_and_extent_of_all_channels() -> None:
    clip = Clip([Channel("a", make_run([1.0, 4.0])), Channel("b"), Channel("c", make_run([-2.0]))])
    assert clip.key_count == 3
    assert clip.extent() == (-2.0, 4.0)
    assert Clip([Channel("b")]).extent() is None


def test_a_pose_names_every_channel() -> None:
    clip = Clip([Channel("a", make_run([0.0, 1.0], [0.0, 2.0])), Channel("b")])
    assert clip.pose(0.5) == {"a": 1.0, "b": 0.0}


def test_frames_and_times() -> None:
    clip = Clip(frame_rate=25.0)
    assert (clip.frame_of(2.0), clip.time_of(50.0)) == (50.0, 2.0)
    for rate in (24.0, 25.0, 29.97, 30.0, 60.0):
        clip.frame_rate = rate
        assert [round(clip.frame_of(clip.time_of(frame))) for frame in range(1000)] == list(range(1000))


def test_check_refuses_two_channels_of_one_name() -> None:
    Clip([Channel("a"), Channel("b")]).check()
    with pytest.raises(AssertionError, match="same name"):
        Clip([Channel("a"), Channel("a")]).check()


def test_frames_and_times_are_finite_however_far_away() -> None:
    clip = Clip(frame_rate=1e300)
    assert clip.frame_of(1e308) == 1.7976931348623157e308
    clip.frame_rate = 1e-300
    assert clip.time_of(-1e308) == -1.7976931348623157e308
