"""Edits of the model alone: their cost must not grow with the channel; memory a key and an undo step."""

import tracemalloc
from collections.abc import Callable

import numpy as np

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.document import Document, Gesture
from model.keyframe import TangentRule
from model.selection import Selection
from tests.bench.evaluating import a_channel
from tests.bench.table import Line, timed

MANY = 1_000_000


def _middle(channel: Channel) -> int:
    run = channel.run()
    return int(run["id"][len(run) // 2])


def _work(channel: Channel) -> dict[str, Callable[[], object]]:
    """One insertion, deletion, change of rule and step of a drag, each taken back at once."""
    document = Document(Clip([channel]))
    key = channel.key(_middle(channel))
    selection = Selection.of({channel: [key.id]})
    time = key.time + 0.01

    def there_and_back(compute: Callable[[Clip], object]) -> Callable[[], None]:
        def work() -> None:
            edit = document.do("Bench", compute)  # type: ignore[arg-type]
            assert edit is not None
            document.apply(edit.inverse())

        return work

    rules = (TangentRule.FLAT, TangentRule.SMOOTH)
    return {
        "insert a key and take it back": there_and_back(lambda clip: edits.insert(clip, channel, time)),
        "delete a key and take it back": there_and_back(lambda clip: edits.delete(clip, selection)),
        "change a rule and take it back": there_and_back(lambda clip: edits.set_rule(clip, selection, rules[0])),
    }


def local_edits() -> list[Line]:
    """The same edits in a channel of ten keys and in one of a million."""
    small, large = _work(a_channel(10)), _work(a_channel(MANY))
    lines = []
    for name in small:
        taken = timed({"small": small[name], "large": large[name]}, rounds=150)
        lines.append(Line(f"{name}, 1,000,000 keys", taken["large"].median, "10 keys", taken["small"].median, 3.0))
    return lines


def _steps(gesture: Gesture, selection: Selection, reach: float) -> Callable[[], None]:
    """Steps of a drag that goes on, each from the gesture's start, to and fro by up to *reach* seconds."""
    amounts = iter(np.linspace(0.0, 3.0, 100_000).tolist())

    def step() -> None:
        d_value = next(amounts)
        d_time = reach * float(np.sin(1000.0 * d_value))
        gesture.preview(lambda clip: edits.move(clip, selection, d_time, d_value))

    return step


def _stretches(gesture: Gesture, selection: Selection, wide: float, high: float) -> Callable[[], None]:
    """Steps of a scale that goes on, each from the start, to and fro by up to *wide* in time and *high* in value."""
    amounts = iter(np.linspace(0.0, 3.0, 100_000).tolist())

    def step() -> None:
        factor = float(np.sin(1000.0 * next(amounts)))
        gesture.preview(lambda clip: edits.scale(clip, selection, 3.0, 0.5, 1.0 + wide * factor, 1.0 + high * factor))

    return step


def stretches() -> list[Line]:
    """One step of a drag that scales or retimes all keys, without the painting."""
    channel = a_channel(MANY)
    every = Selection.of_all([channel])
    lines = []
    for work, wide, high in (("scale", 0.2, 0.3), ("retime", 0.2, 0.0)):
        with Document(Clip([channel])).begin("Bench") as gesture:
            taken = timed({"ours": _stretches(gesture, every, wide, high)}, rounds=15)
            gesture.preview(lambda clip: [])
        lines.append(Line(f"a {work} step of all 1,000,000 keys, model", taken["ours"].median, most=70e-3))
    return lines


def drags() -> list[Line]:
    """One step of a drag, without the painting."""
    channels = [a_channel(1_000, seed, f"c{seed}") for seed in range(20)]
    some = Selection.of({channel: channel.run()["id"][::20] for channel in channels})
    one = a_channel(MANY)
    every = Selection.of({one: one.run()["id"]})
    lines = []
    key = Selection.of({one: [_middle(one)]})
    for work, clip, selection, reach, rounds, most in (
        ("a drag step of one key among 1,000,000, model", Clip([one]), key, 0.02, 300, 0.35e-3),
        ("a drag step of one key past ten neighbours, model", Clip([one]), key, 1.0, 300, 0.35e-3),
        ("a drag step of 1,000 keys over 20 channels, model", Clip(channels), some, 0.02, 60, 8e-3),
        ("a drag step of all 1,000,000 keys, model", Clip([one]), every, 1.0, 15, 60e-3),
    ):
        columns = np.zeros((2, selection.count))

        def add(columns: np.ndarray = columns) -> None:
            columns[0] += 0.003
            columns[1] += 0.01

        with Document(clip).begin("Bench") as gesture:
            taken = timed({"ours": _steps(gesture, selection, reach), "floor": add}, rounds=rounds)
            gesture.preview(lambda clip: [])
        lines.append(Line(work, taken["ours"].median, "numpy adding to two columns", taken["floor"].median, None, most))
    return lines


def memory() -> list[str]:
    """Bytes a key, and of the undo of a drag of one key among a million; in words, since they are no times."""
    tracemalloc.start()
    try:
        before = tracemalloc.get_traced_memory()[0]
        channel = a_channel(MANY)
        channel.envelope(np.linspace(0.0, 1e5, 1_600))
        held = tracemalloc.get_traced_memory()[0] - before
        document = Document(Clip([channel]))
        selection = Selection.of({channel: [_middle(channel)]})
        before = tracemalloc.get_traced_memory()[0]
        edit = document.do("Bench", lambda clip: edits.move(clip, selection, 0.0, 1.0))
        kept = tracemalloc.get_traced_memory()[0] - before
    finally:
        tracemalloc.stop()
    assert edit is not None
    each = held / MANY
    return [
        f"memory: {each:.0f} bytes a key, everything included (to reach: 160) {'yes' if each <= 160 else 'NO'}",
        f"memory: {kept / 1024:.1f} KiB for the undo of one key's drag in 1,000,000 (to reach: 64 KiB) "
        f"{'yes' if kept <= 65536 else 'NO'}",
    ]


def run() -> list[Line]:
    """All figures of editing."""
    return [*local_edits(), *drags(), *stretches()]
