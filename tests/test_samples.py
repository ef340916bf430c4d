"""The shipped samples: what is in the folder is what the script makes, and each opens as its author meant it."""

from pathlib import Path

import pytest

from model.extrapolation import Extrapolation
from model.formats import read_clip
from model.keyframe import TangentRule
from tools.make_samples import BODY, SAMPLES, joints_from, samples


def test_the_folder_holds_what_the_script_makes() -> None:
    assert {path.name: path.read_bytes() for path in SAMPLES.iterdir()} == samples()


@pytest.mark.parametrize(
    "path", [path for path in SAMPLES.iterdir() if path.suffix != ".skel"], ids=lambda path: path.name
)
def test_a_sample_opens_sound_and_with_something_to_see(path: Path) -> None:
    clip = read_clip(path)
    clip.check()
    extent = clip.extent()
    assert extent
    assert clip.start <= extent[0]
    assert extent[1] <= clip.end
    assert all(channel.extrema()[1] > channel.extrema()[0] for channel in clip.channels if len(channel) > 1)


def test_the_first_sample_shows_every_rule_and_every_extrapolation() -> None:
    channels = read_clip(SAMPLES / "bounce.hermite").channels
    assert 6 <= len(channels) <= 12
    assert {key.rule_out for channel in channels for key in channel} == set(TangentRule)
    assert {mode for channel in channels for mode in (channel.pre, channel.post)} == set(Extrapolation)


def test_the_ball_never_falls_through_the_ground() -> None:
    assert read_clip(SAMPLES / "bounce.hermite").channel("ball.ty").extrema()[0] == 0.0


def test_the_walk_is_named_by_its_skeleton_and_has_no_corner_at_the_seam() -> None:
    clip = read_clip(SAMPLES / "walk.anim")
    assert [channel.name for channel in clip.channels[3::3]] == [f"{joint}.rx" for joint in joints_from()]
    assert len(joints_from()) == len(BODY)
    for channel in clip.channels:
        if channel.post is Extrapolation.CYCLE and channel.first and channel.last:
            assert channel.slope(channel.last.time, side="in") == pytest.approx(channel.slope(channel.first.time))
