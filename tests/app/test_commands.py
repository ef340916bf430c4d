"""The commands without a window, as they are typed."""

import csv
import io
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import main
from app.commands import COMMANDS, run
from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.formats import read_clip, write_bytes
from model.keyframe import TangentRule, make_run

ROOT = Path(__file__).resolve().parents[2]

type Output = tuple[int, str, str]
type Hermite = Callable[..., Output]


@pytest.fixture
def hermite(capfdbinary: pytest.CaptureFixture[bytes], monkeypatch: pytest.MonkeyPatch) -> Hermite:
    """Runs a command here: its code, what it printed, and what it said on stderr."""

    def call(*words: object) -> Output:
        code = run([str(word) for word in words])
        out, error = capfdbinary.readouterr()
        return code, out.decode(), error.decode()

    return call


@pytest.fixture
def walk(tmp_path: Path) -> Path:
    """A clip with names that a table and a terminal have to be careful with."""
    tx = Channel("root.tx", make_run([0, 1, 2], [0, 1, 0.5]), post=Extrapolation.CYCLE, unit="m", locked=True)
    rx = Channel('odd, "name"', make_run([0.5], [0.1 + 0.2], rules_out=TangentRule.STEP, broken=True), unit="angle")
    path = tmp_path / "walk.hermite"
    path.write_bytes(write_bytes(Clip([tx, rx, Channel("\x1b[31mred")], start=0, end=2, frame_rate=24), "hermite"))
    return path


def table(text: str) -> list[list[str]]:
    return list(csv.reader(io.StringIO(text)))


def test_values_are_printed_at_given_times(hermite: Hermite, walk: Path) -> None:
    code, out, error = hermite("evaluate", walk, "--times", "-1e-3", "0.5", "-2", ".25", "1E1")
    assert (code, error) == (0, "")
    rows = table(out)
    assert rows[0] == ["time", "root.tx", 'odd, "name"', "\x1b[31mred"]
    times = [-1e-3, 0.5, -2, 0.25, 10]
    expected = [channel.evaluate(np.array(times)).tolist() for channel in read_clip(walk).channels]
    assert [list(map(float, row)) for row in rows[1:]] == [list(row) for row in zip(times, *expected, strict=True)]
    assert rows[2][2] == "0.30000000000000004"


def test_values_are_printed_at_a_rate_and_the_last_time_is_among_them(hermite: Hermite, walk: Path) -> None:
    code, out, _ = hermite("evaluate", walk, "--from", "0", "--to", "0.3", "--rate", "10", "--channel", "root.tx")
    assert code == 0
    assert [row[0] for row in table(out)] == ["time", "0.0", "0.1", "0.2", "0.3"]
    _, out, _ = hermite("evaluate", walk, "--from", "0.1", "--to", "0.3", "--rate", "10")
    assert [row[0] for row in table(out)] == ["time", "0.1", "0.2", "0.3"]
    _, out, _ = hermite("evaluate", walk, "--from", "1", "--to", "1", "--rate", "10")
    assert [row[0] for row in table(out)] == ["time", "1.0"]


def test_without_times_the_range_is_printed_frame_by_frame(hermite: Hermite, walk: Path) -> None:
    _, out, _ = hermite("evaluate", walk)
    rows = table(out)
    assert len(rows) == 1 + 2 * 24 + 1
    assert [rows[1][0], rows[-1][0]] == ["0.0", "2.0"]


def test_channels_are_printed_in_the_order_asked_for(hermite: Hermite, walk: Path) -> None:
    _, out, _ = hermite("evaluate", walk, "--times", "1", "--channel", 'odd, "name"', "root.tx")
    assert table(out) == [["time", 'odd, "name"', "root.tx"], ["1.0", "0.30000000000000004", "1.0"]]


def test_more_samples_than_are_worked_out_at_once_are_one_table(hermite: Hermite, walk: Path) -> None:
    _, out, _ = hermite("evaluate", walk, "--from", "0", "--to", "2", "--rate", "5000", "--channel", "root.tx")
    rows = np.array(table(out)[1:], np.float64)
    assert len(rows) == 10_001
    np.testing.assert_array_equal(rows[:, 1], read_clip(walk).channels[0].evaluate(rows[:, 0]))


def test_info_tells_what_is_in_a_clip(hermite: Hermite, walk: Path) -> None:
    code, out, error = hermite("info", walk)
    assert (code, error) == (0, "")
    lines = out.splitlines()
    assert lines[0] == f"{walk}: Hermite clip, 3 channels, 4 keys"
    assert lines[1] == "range 0.0 to 2.0 s, 24.0 frames per second"
    assert lines[2] == "keys from 0.0 to 2.0 s"
    assert [line.split() for line in lines[4:6]] == [
        ["channel", "keys", "first", "last", "lowest", "highest", "before", "after", "unit", "rules", "(sides)"],
        ["root.tx", "3", "0", "2", "0", "1.0109", "constant", "cycle", "m", "smooth", "6,", "locked"],
    ]
    assert lines[6].split()[-7:] == ["rad", "smooth", "1,", "step", "1,", "broken", "1"]
    assert lines[7].startswith("\\x1b[31mred  ")
    assert len({line.index("constant") for line in lines[5:8]}) == 1


def test_convert_goes_there_and_back_without_loss(hermite: Hermite, walk: Path, tmp_path: Path) -> None:
    course = tmp_path / "course.anim"
    code, out, error = hermite("convert", walk, course)
    assert (code, out) == (2, "")
    assert error.startswith(f"{course}: not written, since ")
    for part in ("the frame rate", "the name", "the unit", "the lock", "step", "--lossy"):
        assert part in error
    assert not course.exists()
    assert hermite("convert", walk, course, "--lossy")[0] == 0
    assert hermite("convert", course, tmp_path / "again.hermite")[0] == 0
    assert hermite("convert", tmp_path / "again.hermite", tmp_path / "again.anim") == (0, "", "")
    assert (tmp_path / "again.anim").read_bytes() == course.read_bytes()
    assert hermite("convert", walk, tmp_path / "copy", "--to", "hermite")[0] == 0
    assert (tmp_path / "copy").read_bytes() == walk.read_bytes()


def test_convert_replaces_a_file_only_when_told_to(hermite: Hermite, walk: Path, tmp_path: Path) -> None:
    out = tmp_path / "mine.hermite"
    out.write_text("mine")
    code, _, error = hermite("convert", walk, out)
    assert (code, error) == (2, f"{out}: not written, since there is a file of that name (--force replaces it)\n")
    assert out.read_text() == "mine"
    assert hermite("convert", walk, out, "--force") == (0, "", "")
    assert out.read_bytes() == walk.read_bytes()


def test_convert_that_is_interrupted_leaves_what_was_there(
    hermite: Hermite, walk: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def press_control_c(_handle: int) -> None:
        raise KeyboardInterrupt

    out = tmp_path / "mine.hermite"
    out.write_text("mine")
    monkeypatch.setattr(os, "fsync", press_control_c)
    before = sorted(tmp_path.iterdir())
    assert hermite("convert", walk, out, "--force") == (2, "", "stopped\n")
    assert sorted(tmp_path.iterdir()) == before
    assert out.read_text() == "mine"


def test_a_skeleton_names_the_channels(hermite: Hermite, tmp_path: Path) -> None:
    clip = tmp_path / "walk.anim"
    clip.write_bytes(write_bytes(Clip([Channel(f"channel {i}") for i in range(6)], end=1), "anim"))
    skeleton = tmp_path / "elsewhere"
    skeleton.write_bytes(b"balljoint hip { }")
    _, out, _ = hermite("evaluate", clip, "--times", "0", "--skel", skeleton)
    assert table(out)[0] == ["time", "hip.tx", "hip.ty", "hip.tz", "hip.rx", "hip.ry", "hip.rz"]


REFUSED = {
    "no such file": (["info", "nowhere.anim"], "nowhere.anim: cannot be read (No such file or directory)"),
    "a folder": (["info", "."], ".: this is a folder; choose a file"),
    "an unknown channel": (
        ["evaluate", "{walk}", "--channel", "rot.tx"],
        "no channel 'rot.tx'; did you mean root.tx?",
    ),
    "a very unknown channel": (
        ["evaluate", "{walk}", "--channel", "zzz"],
        "no channel 'zzz'; hermite info lists them",
    ),
    "from behind to": (
        ["evaluate", "{walk}", "--from", "2", "--to", "1"],
        "the first time 2.0 lies after the last, 1.0",
    ),
    "a rate of 0": (["evaluate", "{walk}", "--rate", "0"], "'0' is not above 0"),
    "too many samples": (
        ["evaluate", "{walk}", "--from", "0", "--rate", "1e9"],
        "that is 2e+09 samples; at most 10,",
    ),
    "nan": (["evaluate", "{walk}", "--times", "nan"], "'nan' is not a number"),
    "infinity": (["evaluate", "{walk}", "--times", "1e999"], "'1e999' is not a number"),
    "an underscore": (["evaluate", "{walk}", "--times", "1_0"], "'1_0' is not a number"),
    "times and a rate": (["evaluate", "{walk}", "--times", "1", "--rate", "2"], "either --times or --from"),
    "a mistyped option": (["evaluate", "{walk}", "--form", "0"], "there is no option --form (did you mean --from?)"),
    "a second file": (["info", "{walk}", "{walk}"], "is one word too many"),
    "options before the clip": (["evaluate", "--times", "0", "{walk}"], "the clip stands in front of the options"),
    "commas": (["evaluate", "{walk}", "--times", "0,1"], "numbers are parted by spaces"),
    "a folder and no format": (["convert", "{walk}", "."], ".: this is a folder; give a file name"),
    "an unknown option": (
        ["evaluate", "{walk}", "--fps", "2"],
        "there is no option --fps (see hermite evaluate --help)",
    ),
    "no file": (["info"], "the following arguments are required: FILE"),
    "no extension": (
        ["convert", "{walk}", "out"],
        "tells no format (.hermite, .anim do); give --to",
    ),
    "an unknown format": (["convert", "{walk}", "out", "--to", "fbx"], "invalid choice: 'fbx'"),
    "a folder to write to": (["convert", "{walk}", ".", "--to", "hermite"], ".: this is a folder; give a file name"),
    "no folder to write to": (["convert", "{walk}", "no/where.hermite"], "no/where.hermite: the folder does not exist"),
    "no size": (["render", "{walk}", "-o", "a.png", "--size", "9x9"], "'9x9' is not a size such as 1600x900"),
    "nothing to draw": (["render", "{walk}", "-o", "a.png", "--from", "1", "--to", "1"], "does not lie before"),
}


@pytest.mark.parametrize(("words", "part"), REFUSED.values(), ids=REFUSED.keys())
def test_what_cannot_be_done_is_said_in_one_sentence(
    hermite: Hermite, walk: Path, monkeypatch: pytest.MonkeyPatch, words: list[str], part: str
) -> None:
    monkeypatch.chdir(walk.parent)
    code, out, error = hermite(*(word.format(walk=walk) for word in words))
    assert (code, out) == (2, "")
    assert part in error
    assert error.count("\n") == 1


def hermite_process(*words: object, **options: object) -> subprocess.CompletedProcess[bytes]:
    command = [sys.executable, str(ROOT / "main.py"), *map(str, words)]
    return subprocess.run(command, capture_output=True, check=False, **options)  # type: ignore[call-overload,no-any-return]


def test_help_lists_the_commands() -> None:
    done = hermite_process("evaluate", "--help")
    assert done.returncode == 0
    assert b"--times" in done.stdout
    with pytest.raises(SystemExit) as caught:
        run(["--help"])
    assert caught.value.code == 0
    assert list(COMMANDS) == ["evaluate", "info", "convert", "render"]


def printed_into(output: int, *words: object) -> tuple[int, bytes]:
    """The code, and what is said on stderr, of a command whose output goes to *output*."""
    buffered = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    command = [sys.executable, str(ROOT / "main.py"), *map(str, words)]
    done = subprocess.run(command, stdout=output, stderr=subprocess.PIPE, check=False, env=buffered)
    return done.returncode, done.stderr


@pytest.mark.parametrize(
    "words", [["info", "{walk}"], ["evaluate", "{walk}", "--rate", "100000"]], ids=["short", "long"]
)
def test_a_reader_that_is_not_there_is_one_sentence(walk: Path, words: list[str]) -> None:
    read_end, write_end = os.pipe()
    os.close(read_end)
    said = printed_into(write_end, *(word.format(walk=walk) for word in words))
    os.close(write_end)
    assert said == (2, b"nobody reads the output any more\n")


def test_a_reader_that_goes_away_is_one_sentence(walk: Path) -> None:
    command = [sys.executable, str(ROOT / "main.py"), "evaluate", str(walk), "--rate", "1000000"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.readline()
        process.stdout.close()
        assert process.stderr.read() == b"nobody reads the output any more\n"
    assert process.returncode == 2


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no device that is always full")
def test_a_full_disk_behind_the_output_is_one_sentence(walk: Path) -> None:
    full = os.open("/dev/full", os.O_WRONLY)
    said = printed_into(full, "evaluate", walk)
    os.close(full)
    assert said == (2, b"No space left on device\n")


def test_names_are_printed_as_utf_8_whatever_the_terminal_says(tmp_path: Path) -> None:
    path = tmp_path / "clip.hermite"
    path.write_bytes(write_bytes(Clip([Channel("hüfte.é😀")]), "hermite"))
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "LC_ALL": "C"}
    done = hermite_process("evaluate", path, "--times", "0", env=environment)
    assert done.stdout.decode("utf-8").startswith("time,hüfte.é😀\n")
    assert hermite_process("info", path, env=environment).returncode == 0


COMMAND_LINES = {
    "evaluate": ["evaluate", "{walk}", "--times", "1"],
    "info": ["info", "{walk}"],
    "convert": ["convert", "{walk}", "{walk}.hermite"],
}


@pytest.mark.parametrize("words", COMMAND_LINES.values(), ids=COMMAND_LINES.keys())
def test_no_command_but_render_loads_qt(walk: Path, words: list[str]) -> None:
    words = [word.format(walk=walk) for word in words]
    code = (
        f"import sys; sys.argv[1:] = {words!r}; sys.path.insert(0, {str(ROOT)!r}); import main; code = main.main()\n"
        "print([n for n in sys.modules if n.startswith(('PySide6', 'shiboken6', 'pyqtgraph'))], file=sys.stderr)\n"
        "sys.exit(code)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (0, b"[]\n")


def test_render_loads_of_pyqtgraph_only_its_view(walk: Path, tmp_path: Path) -> None:
    words = ["render", str(walk), "-o", str(tmp_path / "walk.png")]
    code = (
        f"import sys; sys.argv[1:] = {words!r}; import main; code = main.main()\n"
        "print([n for n in sys.modules if n.startswith('pyqtgraph.graphicsItems.')], file=sys.stderr)\n"
        "sys.exit(code)"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, check=False)
    assert (done.returncode, done.stderr) == (0, b"[]\n")


@pytest.mark.parametrize("name", ["walk.hermite", "other.anim", "clip-without-extension"])
def test_a_picture_is_not_written_over_a_clip(hermite: Hermite, walk: Path, tmp_path: Path, name: str) -> None:
    target = tmp_path / name
    if not target.exists():
        target.write_bytes(walk.read_bytes())
    before = target.read_bytes()
    code, out, error = hermite("render", walk, "-o", target)
    assert (code, out) == (2, "")
    assert error.startswith(f"{target}: not written, since it is a clip")
    assert target.read_bytes() == before


def test_a_closed_output_is_told_in_one_sentence() -> None:
    done = subprocess.run(
        ["sh", "-c", '"$0" main.py info resources/samples/bounce.hermite >&-', sys.executable],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert done.stderr == "there is nowhere to print to: the output is closed\n"


def test_a_picture_of_another_kind_than_png_is_not_written_under_its_name(
    hermite: Hermite, walk: Path, tmp_path: Path
) -> None:
    picture = tmp_path / "curves.jpg"
    code, _, told = hermite("render", walk, "-o", picture)
    assert (code, picture.exists()) == (2, False)
    assert ".png" in told


def test_control_c_while_the_program_is_still_loading_is_no_crash(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def press_control_c(_words: object) -> bool:
        raise KeyboardInterrupt

    monkeypatch.setattr(main, "command_of", press_control_c)
    assert main.main(["info", "x.anim"]) == 2
    assert capsys.readouterr().err == "stopped\n"
