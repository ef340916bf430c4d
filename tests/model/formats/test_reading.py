"""Files as they lie on a disk: told apart by content, refused in one sentence, read within their budget."""

import os
import zipfile
from pathlib import Path

import numpy as np
import pytest

from model import formats
from model.channel import Channel
from model.clip import Clip
from model.formats import FORMATS, FormatError, format_of_path, native, read_bytes, read_clip, sniff, write_bytes
from model.formats.foreign import FOREIGN_KINDS
from model.keyframe import make_run

FOREIGN = {
    "a Maya .anim file": b"animVersion 1.1;\nmayaVersion 2024;\nanim translateX nurbsCircle1 0 0 0;\n",
    "a Maya ATOM file": b"atomVersion 1.0;\nmayaVersion 2024;\n",
    "a Unity animation (YAML)": b"%YAML 1.1\n%TAG !u! tag:unity3d.com,2011:\n--- !u!74 &7400000\nAnimationClip:\n",
    "a Maya ASCII scene": b"//Maya ASCII 2024 scene\nrequires maya;\n",
    "a Maya binary scene": b"FOR4\0\0\0\x10Maya",
    "a USD text file": b'#usda 1.0\n(\n    defaultPrim = "a"\n)\n',
    "a binary USD file": b"PXR-USDC\0\x08\0\0",
    "a zip archive (Studio Library or usdz)": b"PK\x03\x04\x14\0\0\0",
    "a BVH motion capture file": b"HIERARCHY\nROOT Hips\n{\n",
    "a binary glTF file": b"glTF\x02\0\0\0",
    "a glTF file": b'{\n  "asset": {"version": "2.0"}\n}',
    "a Nuke curve": b"{curve x1 0.5 x20 1.5}",
    "After Effects keyframe data": b"Adobe After Effects 8.0 Keyframe Data\n",
    "a Blender file": b"BLENDER-v405RENDH",
    "an FBX file": b"Kaydara FBX Binary  \0\x1a\0",
    "a skeleton (.skel)": b"balljoint root {\n}\n",
    "a JSON file": b'["keys", 1]',
    "an XML or HTML file": b"<!DOCTYPE html><html>",
    "a table of numbers (.chan or CSV)": b"1 0.5 0.25 90\n2 0.6 0.25 91\n",
    "a CSV table": b"time,root.tx\n0,1\n",
    "a UTF-16 text": "animation {".encode("utf-16"),
}


def refusal(path: Path) -> str:
    with pytest.raises(FormatError) as caught:
        read_clip(path)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_every_foreign_kind_has_its_example() -> None:
    assert list(FOREIGN) == [kind.name for kind in FOREIGN_KINDS]


@pytest.mark.parametrize(("kind", "data"), FOREIGN.items(), ids=FOREIGN.keys())
def test_a_file_of_another_program_is_called_by_its_name(tmp_path: Path, kind: str, data: bytes) -> None:
    path = tmp_path / "walk.anim"
    path.write_bytes(data)
    sentence = refusal(path)
    assert sentence.startswith(f"{path}: this is {kind}, not a clip; ")
    assert sniff(data) == kind


SAMPLES = [
    ("maya_anim/nonweighted_all_words.anim", "a Maya .anim file"),
    ("unity/unity_minimal.anim", "a Unity animation (YAML)"),
    ("usd/openusd_220_splines.usda", "a USD text file"),
    ("bvh/walk01.bvh", "a BVH motion capture file"),
    ("gltf/Animation_Node_00/Animation_Node_00.gltf", "a glTF file"),
    ("nuke/nuke_curves.txt", "a Nuke curve"),
    ("chan/jumping_jacks_root_nuke7.chan", "a table of numbers (.chan or CSV)"),
    ("cse169/wasp.skel", "a skeleton (.skel)"),
]


@pytest.mark.parametrize(("name", "kind"), SAMPLES)
def test_a_real_file_of_another_program_is_called_by_its_name(shared: Path, name: str, kind: str) -> None:
    assert f"this is {kind}" in refusal(shared / "samples" / name)


@pytest.mark.parametrize("format_name", FORMATS)
def test_a_clip_is_known_by_what_is_in_it_whatever_it_is_called(tmp_path: Path, format_name: str) -> None:
    path = tmp_path / "clip.png"
    path.write_bytes(b"\n\n" + write_bytes(Clip([Channel("channel 0")], end=2), format_name))
    assert read_clip(path).end == 2
    assert sniff(path.read_bytes()) == format_name


@pytest.mark.parametrize("format_name", FORMATS)
def test_the_extension_asks_for_a_format(format_name: str) -> None:
    row = FORMATS[format_name]
    assert format_of_path(f"a.b{row.extension.upper()}") == format_name
    assert format_of_path("a.txt") is None


def test_whatever_is_no_clip_is_refused_in_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "empty").write_bytes(b"")
    (tmp_path / "blank").write_bytes(b"\xef\xbb\xbf \r\n\t")
    (tmp_path / "binary").write_bytes(bytes(range(256)))
    (tmp_path / "words").write_bytes(b"some words")
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    (tmp_path / "library").mkdir()
    (tmp_path / "library" / "animation.ma").write_bytes(b"")
    with zipfile.ZipFile(tmp_path / "zip", "w") as archive:
        archive.writestr("animation.ma", "")
    assert "the file is empty" in refusal(tmp_path / "empty")
    assert "nothing but blanks" in refusal(tmp_path / "blank")
    assert "a binary file" in refusal(tmp_path / "binary")
    assert ":1:1: expected 'animation {' or 'hermite 1', found 'some'" in refusal(tmp_path / "words")
    assert "a device or a pipe" in refusal(tmp_path / "pipe")
    assert "Too many levels" in refusal(tmp_path / "loop")
    assert "this is a folder" in refusal(tmp_path)
    assert "Studio Library folder" in refusal(tmp_path / "library")
    assert "zip archive" in refusal(tmp_path / "zip")
    assert "No such file" in refusal(tmp_path / "nowhere")
    assert "this is no path" in refusal(Path("a\0b"))


MISTYPED = {
    b"extrapolate constant constant": (b"extrapolate constant constnat", "did you mean 'constant'?"),
    b"channel {": (b"chanel {", "did you mean 'channel'?"),
    b"keys 2 {": (b"kyes 2 {", "did you mean 'keys'?"),
    b"smooth\tsmooth": (b"Smooth\tsmooth", "did you mean 'smooth'?"),
    b"numchannels": (b"num_channels", "did you mean 'numchannels'?"),
}


@pytest.mark.parametrize(("right", "wrong"), MISTYPED.items())
def test_a_mistyped_word_is_answered_with_the_nearest_that_is_known(right: bytes, wrong: tuple[bytes, str]) -> None:
    text = write_bytes(Clip([Channel("channel 0", make_run([0.0, 1.0], [0.0, 1.0]))]), "anim")
    mistyped = text.replace(right, wrong[0], 1)
    assert mistyped != text
    with pytest.raises(FormatError) as caught:
        read_bytes(mistyped, "walk.anim")
    assert caught.value.remedy == wrong[1]


def test_a_file_beyond_the_budget_is_refused_before_it_is_read(tmp_path: Path) -> None:
    path = tmp_path / "huge.anim"
    with open(path, "wb") as file:
        file.write(b"animation {")
        file.truncate((256 << 20) + 1)
    assert "larger than 256 MiB" in refusal(path)


@pytest.mark.parametrize("piece", [1, 7, 1 << 18])
def test_a_file_of_too_many_lines_is_refused_and_none_with_one_less(
    piece: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    data = b"hermite 1\nrange 0 1\n\n\n\nrate 30\nend\n"
    monkeypatch.setattr(formats, "_PIECE", piece)
    monkeypatch.setattr(formats, "MAX_LINES", data.count(b"\n"))
    assert read_bytes(data, "x").end == 1
    monkeypatch.setattr(formats, "MAX_LINES", data.count(b"\n") - 1)
    with pytest.raises(FormatError, match="the file has more than 6 lines"):
        read_bytes(data, "x")


def test_a_file_of_too_many_channels_is_refused_before_they_are_read(monkeypatch: pytest.MonkeyPatch) -> None:
    clip = Clip([Channel(name, make_run([0, 1], 0)) for name in ("a", "b", "c")])
    data = write_bytes(clip, "hermite")
    monkeypatch.setattr(native, "MAX_CHANNELS", 3)
    assert len(read_bytes(data, "x").channels) == 3
    monkeypatch.setattr(native, "MAX_CHANNELS", 2)
    with pytest.raises(FormatError, match="more than 2 channels") as caught:
        read_bytes(data, "x")
    assert caught.value.line == 1


HEAD = b"animation { range 0 1 numchannels 1 channel { extrapolate constant constant keys 1 {"
BOMBS = {
    "100 MB of line breaks": b"\n" * 100_000_000,
    "100 MB of line breaks in a clip": b"animation {" + b"\n" * 100_000_000,
    "100 MB of blanks among the keys": HEAD + b" " * 100_000_000,
    "100 MB of digits": HEAD + b"1" * 100_000_000,
    "100 MB without a blank": b"hermite 1 " + b"x" * 100_000_000,
    "a million braces": b"animation " + b"{" * 1_000_000,
    "a million channels": b"animation { range 0 1 numchannels 1000000 " + b"channel { keys 0 { } } " * 1_000_000,
    "a name without an end": b'hermite 1 title "' + b"\\n" * 20_000_000,
    "a time that goes back at the end": HEAD.replace(b"keys 1", b"keys 600000")
    + b"".join(b"%d 0 flat flat\n" % i for i in range(500_000))
    + b"0 0 flat flat } } }",
    "a million channels that were not announced": b"animation { range 0 1 numchannels 1 "
    + b"channel { keys 0 { } } " * 1_000_000,
    "a wrong word at the end of one line": HEAD.replace(b"keys 1", b"keys 500000")
    + b"0 0 flat flat " * 500_000
    + b"x } } }",
    "a wrong word at the end": HEAD.replace(b"keys 1", b"keys 500000") + b"0 0 flat flat\n" * 500_000 + b"x } } }",
}


@pytest.mark.timeout(30)  # about a second on a quiet machine; quadratic work would take hours
@pytest.mark.parametrize("data", BOMBS.values(), ids=BOMBS.keys())
def test_a_hostile_file_is_refused_soon(data: bytes) -> None:
    with pytest.raises(FormatError) as caught:
        read_bytes(data, "x")
    assert len(str(caught.value)) < 300


@pytest.mark.timeout(60)
@pytest.mark.parametrize("format_name", FORMATS)
def test_a_million_keys_come_back(format_name: str) -> None:
    n = 1_000_000
    values = np.random.default_rng(3).normal(size=n)
    clip = Clip([Channel("channel 0", make_run(np.arange(n) / 30, values))], end=n / 30)
    again = read_bytes(write_bytes(clip, format_name), "x")
    assert again.channels[0].run()["value"].tobytes() == values.tobytes()
