"""A skeleton beside a course .anim names its channels."""

from pathlib import Path

import numpy as np
import pytest

from model.channel import Channel
from model.clip import Clip
from model.formats import FormatError, losses, read_clip, write_bytes

SKELETON = b"""balljoint root {
  offset 0 0 0
  boxmin -0.1 -0.1 -0.1
  balljoint arm_l { pose 0 0 1 balljoint hand_l { } }
  balljoint arm_r {
    rotxlimit -2 0
  }
}
"""
NAMES = [
    *("root.tx", "root.ty", "root.tz", "root.rx", "root.ry", "root.rz", "arm_l.rx", "arm_l.ry", "arm_l.rz"),
    *("hand_l.rx", "hand_l.ry", "hand_l.rz", "arm_r.rx", "arm_r.ry", "arm_r.rz"),
]


def write_clip(path: Path, count: int = 15) -> Path:
    path.write_bytes(write_bytes(Clip([Channel(f"channel {i}") for i in range(count)], end=1), "anim"))
    return path


def names(path: Path, skeleton: Path | None = None) -> list[str]:
    return [channel.name for channel in read_clip(path, skeleton=skeleton).channels]


def test_joints_name_channels_in_depth_first_order(tmp_path: Path) -> None:
    path = write_clip(tmp_path / "walk.anim")
    (tmp_path / "walk.skel").write_bytes(SKELETON)
    assert names(path) == NAMES
    assert [channel.unit for channel in read_clip(path).channels] == [""] * 3 + ["angle"] * 12
    assert [channel.group for channel in read_clip(path).channels][8:10] == ["arm_l", "hand_l"]


def test_the_skeleton_of_the_same_name_comes_first_then_the_only_one_that_fits(tmp_path: Path) -> None:
    path = write_clip(tmp_path / "walk.anim")
    (tmp_path / "small.skel").write_bytes(b"balljoint one { }")
    assert names(path)[0] == "channel 0"
    (tmp_path / "fits.skel").write_bytes(SKELETON.replace(b"root", b"hips"))
    assert names(path)[0] == "hips.tx"
    (tmp_path / "also_fits.skel").write_bytes(SKELETON)
    assert names(path)[0] == "channel 0"
    (tmp_path / "walk.skel").write_bytes(SKELETON)
    assert names(path)[0] == "root.tx"


def test_a_skeleton_that_does_not_fit_or_is_none_is_passed_over(tmp_path: Path) -> None:
    path = write_clip(tmp_path / "walk.anim", 6)
    (tmp_path / "walk.skel").write_bytes(SKELETON)
    (tmp_path / "damaged.skel").write_bytes(b"balljoint {")
    (tmp_path / "folder.skel").mkdir()
    assert names(path)[0] == "channel 0"
    (tmp_path / "one.skel").write_bytes(b"balljoint one { }")
    assert names(path)[:4] == ["one.tx", "one.ty", "one.tz", "one.rx"]


def test_a_skeleton_that_was_asked_for_must_fit(tmp_path: Path) -> None:
    path = write_clip(tmp_path / "walk.anim")
    skeleton = tmp_path / "other.skel"
    skeleton.write_bytes(SKELETON)
    (tmp_path / "walk.skel").write_bytes(SKELETON.replace(b"root", b"hips"))
    assert names(path, skeleton)[0] == "root.tx"
    skeleton.write_bytes(b"balljoint one { }")
    with pytest.raises(FormatError, match=r"1 joints, that is 6 channels; .* has 15"):
        names(path, skeleton)
    skeleton.write_bytes(b"balljoint one {\n bone")
    with pytest.raises(FormatError, match=r"other\.skel:2:6: expected '}', found the end of the file"):
        names(path, skeleton)


def test_joints_of_one_name_name_different_channels(tmp_path: Path) -> None:
    path = write_clip(tmp_path / "walk.anim", 15)
    text = b"balljoint a { balljoint a { } balljoint a_2 { } balljoint a { } }"
    (tmp_path / "walk.skel").write_bytes(text)
    found = names(path)
    assert len(set(found)) == 15
    assert found[:4] == ["a.tx", "a.ty", "a.tz", "a.rx"]


def test_a_deep_skeleton_is_read_without_end_of_stack(tmp_path: Path) -> None:
    path = write_clip(tmp_path / "walk.anim", 3 + 3 * 1000)
    (tmp_path / "walk.skel").write_bytes(b"balljoint j { " * 1000 + b"}" * 1000)
    assert names(path)[0] == "j.tx"


def test_names_that_the_skeleton_gives_back_are_no_loss(tmp_path: Path) -> None:
    path = write_clip(tmp_path / "walk.anim")
    (tmp_path / "walk.skel").write_bytes(SKELETON)
    clip = read_clip(path)
    assert losses(clip, "anim", path) == []
    assert losses(clip, "anim", tmp_path / "walk.anim") == []
    (tmp_path / "elsewhere").mkdir()
    lost = losses(clip, "anim", tmp_path / "elsewhere" / "walk.anim")
    assert [loss.what for loss in lost] == ["names", "units"]
    clip.channels[0].name = "renamed"
    assert [str(loss) for loss in losses(clip, "anim", path)] == ["the name of renamed is lost"]


def test_the_wasp_has_names_for_all_its_channels(shared: Path) -> None:
    folder = shared / "samples" / "cse169"
    clip = read_clip(folder / "wasp_walk.anim")
    assert len(clip.channels) == 72
    assert [channel.name for channel in clip.channels[:7]] == [*NAMES[:6], "head.rx"]
    assert np.isclose(clip.channel("head.rx").value(0.5), clip.channels[6].value(0.5))
    with pytest.raises(FormatError, match="6 joints"):
        read_clip(
            shared / "samples" / "cse169" / "wasp_walk.anim", skeleton=shared / "samples" / "cse169" / "test.skel"
        )
