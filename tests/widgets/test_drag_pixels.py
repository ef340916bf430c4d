"""A key dragged through a curve, sparse or dense: each step leaves the pixels of a full repaint."""

from typing import Final

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule, make_run
from model.sampling import Window, columns
from model.selection import Selection
from tests.widgets.screens import Screen, view_of
from widgets.layers import drawings

RATIOS: Final = (1.0, 1.5, 2.0)


def clip_of(seed: int, keys: int) -> Clip:
    """One channel of so many keys over ten seconds, by all rules, among two others."""
    rng = np.random.default_rng(seed)
    rules_out = rng.choice(list(TangentRule), keys)
    rules_in = np.where(rules_out == TangentRule.STEP, TangentRule.AUTO, rules_out)
    times = np.sort(rng.uniform(0.0, 10.0, keys))
    slopes = rng.normal(size=(2, keys))
    modes = [Extrapolation(int(mode)) for mode in rng.integers(0, 2, 2)]
    dragged = Channel("a", make_run(times, rng.normal(size=keys), *slopes, rules_in, rules_out), pre=modes[0])
    dragged.set_extrapolation(*modes)
    others = [
        Channel(name, make_run(np.linspace(0.0, 10.0, n), rng.normal(size=n))) for name, n in (("b", 7), ("c", 900))
    ]
    return Clip([dragged, *others], end=10.0)


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("keys", [12, 150, 4_000, 30_000])
@pytest.mark.parametrize("seed", [1, 2])
def test_each_step_of_a_drag_leaves_the_pixels_of_a_full_repaint(
    qtbot: QtBot, seed: int, keys: int, ratio: float
) -> None:
    view = view_of(clip_of(seed, keys))
    qtbot.addWidget(view)
    screen, rng = Screen(view, ratio), np.random.default_rng(seed)
    document, (channel, *_) = view.document, view.document.clip.channels
    document.session.active = channel if seed % 2 else None
    ids = channel.run()["id"]
    for stroke in range(6):
        place = (0, keys - 1, *rng.integers(0, keys, 4).tolist())[stroke]
        one, some = (Selection.of({channel: np.sort(chosen)}) for chosen in (ids[place : place + 1], ids[place::7][:5]))
        many = Selection.of({each: each.run()["id"][::2] for each in document.clip.channels[::-1]})
        document.session.selection = (some, one, one, many)[stroke % 4]
        with document.begin("Move") as gesture:
            at = np.zeros(2)
            for step in range(9):
                at = at * 0.5 + rng.normal(size=2) * (0.05, 0.3) if step % 3 else rng.normal(size=2) * (3.0, 1.0)
                chosen = (some if stroke % 4 < 3 else many) if step == 4 else one
                if step == 5:  # changes as far as the view reaches, and so does going back from there
                    chosen = Selection.of({channel: ids[:1]})
                gesture.preview(lambda clip, c=chosen, d=at: edits.move(clip, c, float(d[0]), float(d[1])))
                if rng.random() < 0.8:
                    shown = screen.shown()
                    if rng.random() < 0.3 or step > 6:
                        wrong = int((shown != screen.painted_anew()).sum())
                        assert wrong == 0, f"{wrong} pixels are stale after step {step} of stroke {stroke}"
            if stroke % 2:
                gesture.cancel()


def test_most_of_a_dense_curve_is_at_hand_from_step_to_step(qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> None:
    view = view_of(clip_of(3, 30_000))
    qtbot.addWidget(view)
    screen, document, channel = Screen(view, 1.0), view.document, view.document.clip.channels[0]
    chosen = Selection.of({channel: channel.run()["id"][15_000:15_001]})
    document.session.active, document.session.selection = channel, chosen
    screen.refresh()
    asked: list[int] = []

    def counted(channel: Channel, window: Window, first: int, last: int, *, inside: bool) -> tuple[np.ndarray, ...]:
        asked.append(last - first)
        return columns(channel, window, first, last, inside=inside)

    with document.begin("Move") as gesture:
        for step in range(6):
            if step == 2:
                monkeypatch.setattr(drawings, "columns", counted)
            gesture.preview(lambda clip, d=step: edits.move(clip, chosen, 1.0 + 0.01 * d, 0.1))
            screen.refresh()
        steps = asked.copy()
        gesture.cancel()
    assert 0 < max(steps) < 30


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("keys", [700, 1_300, 3_000])
def test_a_key_of_each_of_many_curves_is_dragged_without_a_stale_pixel(qtbot: QtBot, keys: int, ratio: float) -> None:
    rng = np.random.default_rng(keys)
    times = np.sort(rng.uniform(0.0, 10.0, (30, keys)), axis=1)
    clip = Clip([Channel(f"c{i}", make_run(times[i], rng.normal(size=keys))) for i in range(30)], end=10.0)
    view = view_of(clip)
    qtbot.addWidget(view)
    screen, document = Screen(view, ratio), view.document
    chosen = Selection.of({each: each.run()["id"][keys // 2 : keys // 2 + 1] for each in clip.channels})
    document.session.selection = chosen
    with document.begin("Move") as gesture:
        for d_time in (0.05, 1.3, 1.35, -2.0):
            gesture.preview(lambda clip, d=d_time: edits.move(clip, chosen, d, 0.5 * d))
            screen.refresh()
        assert (screen.shown() == screen.painted_anew()).all()
        gesture.cancel()
    assert (screen.shown() == screen.painted_anew()).all()
