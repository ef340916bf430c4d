"""Few spans worked out give exactly the ranges that all of them do."""

from functools import partial

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from model import edits, extremes, rows, suspects
from model.channel import Channel
from model.clip import Clip
from model.document import Compute, Document
from model.hermite import Floats
from model.keyframe import TangentRule, make_run
from model.likeness import Likeness
from model.rows import VALUE, B, C
from model.selection import Selection

VALUES = [
    lambda chance, n: chance.normal(size=n).cumsum(),
    lambda chance, n: chance.normal(size=n) * 1e-3 + 1e6,
    lambda chance, n: np.sin(np.arange(n) / 9.0),
    lambda chance, n: chance.choice([0.0, -0.0, 1.0], n),
    lambda chance, n: chance.normal(size=n) * 1e-310,
    lambda chance, n: chance.choice([1e308, -1.6e308, 3.0, 5e-324], n),
    lambda chance, n: np.zeros(n),
    lambda chance, n: chance.choice([1e300, 1.0, 0.0], n, p=[0.05, 0.5, 0.45]),
]


@pytest.fixture
def short_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    for module, name, size in (
        (rows, "WIDEST", 16),
        (rows, "FILLED", 11),
        (extremes, "AT_A_TIME", 3),
        (extremes, "BLOCK", 8),
        (extremes, "FINE", 2),
        (extremes, "DIRECT", 0),
        (rows, "MANY_ROWS", 2),
        (suspects, "FEWEST", 0),
    ):
        monkeypatch.setattr(module, name, size)


def channel_of(seed: int, kind: int, n: int) -> Channel:
    """Keys by mixed rules, some with slopes of any size, in rows of different numbers of keys."""
    chance = np.random.default_rng(seed)
    rules_out = chance.choice(chance.permutation(list(TangentRule))[: chance.integers(1, 7)], n)
    rules_in = np.where(rules_out == TangentRule.STEP, TangentRule.AUTO, rules_out)
    slopes = chance.normal(size=(2, n)) * 10.0 ** chance.choice([-13, -11, -9, -6, 0, 2, 20], (2, n))
    times = np.cumsum(chance.choice([1e-3, 0.1, 1.0], n))
    channel = Channel("x", make_run(times, VALUES[kind](chance, n), *slopes, rules_in, rules_out))
    for _ in range(int(chance.integers(0, 6))):
        run = channel.run()
        at = int(chance.integers(0, len(run) - 6))
        channel.splice(run[at : at + 6], run[at + 1 : at + int(chance.integers(1, 6))])
    return channel


def ranges(channel: Channel, edges: Floats, each: int) -> tuple[bytes, bytes]:
    """The ranges of all columns when spans are worked out all at once up to so many."""
    extremes.EACH, kept = each, extremes.EACH
    try:
        channel._extremes = None
        low, high = channel.envelope(edges)
        return (low + 0.0).tobytes(), (high + 0.0).tobytes()  # of zeros either may come first
    finally:
        extremes.EACH = kept


@pytest.mark.usefixtures("short_rows")
@settings(max_examples=300, deadline=None)
@given(st.integers(0, 10**6), st.integers(0, len(VALUES) - 1), st.integers(40, 150), st.sampled_from([3, 9, 30, 200]))
def test_few_spans_are_enough(seed: int, kind: int, n: int, columns: int) -> None:
    channel = channel_of(seed, kind, n)
    run = channel.run()
    for edges in (
        np.linspace(run["time"][0], run["time"][-1], columns),
        np.sort(np.random.default_rng(seed).choice(run["time"], columns)),
    ):
        assert ranges(channel, edges, 0) == ranges(channel, edges, 1 << 18)


@pytest.mark.usefixtures("short_rows")
@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.integers(0, len(VALUES) - 1), st.data())
def test_what_is_known_of_blocks_is_forgotten_with_their_keys(seed: int, kind: int, data: st.DataObject) -> None:
    channel = channel_of(seed, kind, 100)
    extremes.EACH, kept = 0, extremes.EACH
    try:
        for _ in range(5):
            run = channel.run()
            edges = np.linspace(run["time"][0], run["time"][-1], data.draw(st.integers(2, 40)))
            for ours, theirs in zip(channel.envelope(edges), channel.copy().envelope(edges), strict=True):
                assert (ours == theirs).all()
            at, count = data.draw(st.integers(0, len(run) - 9)), data.draw(st.integers(1, 8))
            after = run[at : at + count].copy()
            after["value"] += data.draw(st.floats(-10.0, 10.0))
            channel.splice(run[at : at + count], after)
    finally:
        extremes.EACH = kept


def assert_fresh(channel: Channel, columns: int) -> None:
    """The ranges, with what was kept, are those of a channel that keeps nothing yet."""
    run = channel.run()
    edges = np.linspace(run["time"][0], run["time"][-1], columns)
    for ours, theirs in zip(channel.envelope(edges), channel.copy().envelope(edges), strict=True):
        assert (ours == theirs).all()


def step_of(chance: np.random.Generator, selection: Selection) -> Compute:
    """A move or a scale, by little or by so much that rounding begins to tell."""
    far = 10.0 ** chance.choice([-2, 0, 1, 4, 8, 11])
    time, value = (chance.normal(size=2) * chance.choice([0.0, 1.0, far], 2)).tolist()
    f_time, f_value = (chance.choice([1.0, 0.3, 3.0, 1e-4, 1e5, far], 2) * [1.0, chance.choice([1.0, -1.0])]).tolist()
    if chance.integers(2):
        return partial(edits.move, selection=selection, d_time=time, d_value=value)
    numbers = {"center_time": time, "center_value": value, "f_time": f_time, "f_value": f_value}
    return partial(edits.scale, selection=selection, **numbers)


def how_far_off(channel: Channel, likeness: Likeness) -> Floats:
    """How far control points are from where the mapping brings those that lie among the keys, seen from their keys."""
    before, after = likeness.origin.reshape(8, -1), channel._rows.numbers
    points = []
    for numbers in (before, after):
        first = numbers[C] / 3.0
        points.append(np.stack([first, first + (numbers[B] + numbers[C]) / 3.0]))
    values = points[0] + before[VALUE]
    among = ((values >= likeness.extent.low) & (values <= likeness.extent.high)).all(axis=0)
    return np.abs(points[1] - likeness.value.factor * points[0])[:, among]


@pytest.mark.usefixtures("short_rows")
@settings(max_examples=400, deadline=None)
@given(st.integers(0, 10**6), st.integers(0, len(VALUES) - 1))
@example(157, 2)
def test_no_suspect_of_what_a_drag_makes_is_missing(seed: int, kind: int) -> None:
    channel, chance = channel_of(seed, kind, 120), np.random.default_rng(seed)
    document, chosen = Document(Clip([channel])), Selection.of_all([channel])
    with document.begin("Drag") as gesture:
        for _ in range(6):
            gesture.preview(step_of(chance, chosen))
            rows = channel._rows
            every, room = np.arange(rows.rows), np.empty((3, len(rows.ids)))
            if rows.likeness is None:
                continue
            with np.errstate(all="ignore"):
                made = suspects.Known.of(rows, rows.likeness.origin, rows.likeness.extent, 8, [every], room).made(
                    rows.likeness
                )
                if made is None:
                    continue
                low, high = suspects.key_ranges(rows, rows.number_grid, every, 8)
                looked_for = suspects.suspects(rows, rows.number_grid, every, suspects.safe(low, high), room)
                assert not (how_far_off(channel, rows.likeness) > rows.likeness.off / 10.0).any()
            assert (made[0] == low).all()
            assert (made[1] == high).all()
            assert set(looked_for.tolist()) <= set(made[2].tolist())


@pytest.mark.usefixtures("short_rows")
def test_what_is_known_of_a_start_serves_the_steps_of_its_own_drag_only(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extremes, "EACH", 0)
    channel = Channel("x", make_run(np.arange(200) * 0.1, np.sin(np.arange(200) / 9.0) * np.arange(200)))
    document, chosen = Document(Clip([channel])), Selection.of_all([channel])
    known = []
    for slope in (0.0, 900.0):
        edge = channel.run()[100:102].copy()
        edge["rule_in"] = edge["rule_out"] = TangentRule.FIXED
        edge["slope_out"] = slope
        channel.splice(channel.run()[100:102], edge)
        with document.begin("Drag") as gesture:
            for step in (1.0, 2.0):
                gesture.preview(partial(edits.move, selection=chosen, d_time=0.0, d_value=step))
                assert_fresh(channel, 7)
                assert channel._extremes is not None
                known.append(channel._extremes._made_of)
            gesture.cancel()
        assert channel._rows.likeness is None
    assert known[0] is known[1] is not None
    assert known[2] is known[3] is not known[0]


@pytest.mark.usefixtures("short_rows")
@settings(max_examples=150, deadline=None)
@given(st.integers(0, 10**6), st.integers(0, 3), st.sampled_from([0, 1 << 18]), st.sampled_from([0, 2, 4]), st.data())
def test_what_is_kept_follows_gestures(seed: int, kind: int, each: int, few: int, data: st.DataObject) -> None:
    channel, chance = channel_of(seed, kind, 120), np.random.default_rng(seed)
    document, kept = Document(Clip([channel])), (extremes.EACH, extremes.FEW)
    extremes.EACH, extremes.FEW = each, few
    columns = st.sampled_from([2, 3, 6, 20, 70, 300])
    try:
        for _ in range(data.draw(st.integers(1, 3))):
            assert_fresh(channel, data.draw(columns))
            ids = np.sort(chance.choice(channel.run()["id"], data.draw(st.sampled_from([1, 3, len(channel)])), False))
            selection = Selection.of({channel: ids})
            gesture = document.begin("Move")
            for _ in range(data.draw(st.integers(1, 4))):
                gesture.preview(step_of(chance, selection))
                if data.draw(st.booleans()):
                    assert_fresh(channel, data.draw(columns))
            edit = None
            if data.draw(st.booleans()):
                edit = gesture.commit()
            else:
                gesture.cancel()
            assert_fresh(channel, data.draw(columns))
            if edit is not None:
                document.apply(edit.inverse())
                assert_fresh(channel, data.draw(columns))
    finally:
        extremes.EACH, extremes.FEW = kept
