"""The whole path on the real program: open, drag a key and a tangent, undo, save; the file says exactly that."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.app.whole_path import CHANNEL, ROOT

SAMPLES = ROOT / "resources" / "samples"
FRAME_RATE = 30.0

type Key = list[float | str]
type Channel = tuple[str, str, list[Key]]


def channels_of(path: Path) -> list[Channel]:
    """The course's format read by nothing of ours: words and numbers between blanks."""
    words = iter(path.read_text(encoding="ascii").split())

    def expect(*wanted: str) -> None:
        for word in wanted:
            assert next(words) == word

    def number_or_word(text: str) -> float | str:
        try:
            return float(text)
        except ValueError:
            return text

    expect("animation", "{", "range")
    next(words), next(words)
    expect("numchannels")
    channels: list[Channel] = []
    for _ in range(int(next(words))):
        expect("channel", "{", "extrapolate")
        before, after = next(words), next(words)
        expect("keys")
        count = int(next(words))
        expect("{")
        channels.append((before, after, [[number_or_word(next(words)) for _ in range(4)] for _ in range(count)]))
        expect("}", "}")
    expect("}")
    assert list(words) == []
    return channels


@pytest.mark.window
@pytest.mark.skipif(shutil.which("xdotool") is None, reason="needs xdotool to move the X server's mouse")
def test_open_drag_a_key_and_a_tangent_undo_one_save_and_read_the_file(tmp_path: Path) -> None:
    path = tmp_path / "walk.anim"
    for name in ("walk.anim", "walk.skel"):
        shutil.copy(SAMPLES / name, tmp_path)
    before = channels_of(path)

    program = [sys.executable, "-m", "tests.app.whole_path", str(path)]
    result = subprocess.run(program, cwd=ROOT, capture_output=True, text=True, timeout=150, check=False)
    assert result.returncode == 0, result.stderr
    outcome = json.loads(result.stdout.splitlines()[-1])
    assert "failure" not in outcome, outcome["failure"]
    assert "Traceback" not in result.stderr

    after = channels_of(path)
    changed = [number for number, pair in enumerate(zip(before, after, strict=True)) if pair[0] != pair[1]]
    assert changed == [CHANNEL]
    (pre, post, old), (new_pre, new_post, new) = before[CHANNEL], after[CHANNEL]
    assert (pre, post) == (new_pre, new_post)
    assert [i for i, pair in enumerate(zip(old, new, strict=True)) if pair[0] != pair[1]] == [2, 5]

    seconds, values = outcome["scale"]
    time, value, *rules = new[2]
    assert float(time) * FRAME_RATE == pytest.approx(round(float(time) * FRAME_RATE), abs=1e-9)  # on a whole frame
    assert abs(float(time) - (float(old[2][0]) + 60 * seconds)) <= 0.5 / FRAME_RATE + 1e-9
    assert value == pytest.approx(float(old[2][1]) - 70 * values)
    assert rules == old[2][2:]

    assert new[5][:2] == old[5][:2]
    slope_in, slope_out = map(float, new[5][2:])
    assert slope_in == slope_out  # unified tangents turn together
    assert slope_out == pytest.approx(outcome["slope"], rel=0.05)
    assert [label.split()[0] for label in outcome["labels"]] == ["Move", "Turn", "Move"]
