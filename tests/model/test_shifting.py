"""All keys moved or scaled at once: the short way and the splice give the same bytes."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import model.short_ways
from model import edits, placing, rows
from model.change import Change, Setting, Shift, Splice, unshifted
from model.channel import Channel, Reach
from model.clip import Clip
from model.document import Document
from model.extrapolation import Extrapolation
from model.gesture import Gesture
from model.keyframe import TangentRule, make_run
from model.selection import Selection
from tests.model.editing import everything

RULES = list(TangentRule)
NUMBERS = st.one_of(
    st.sampled_from([0.0, -0.0, 0.1, -1.0, 5e-324, 1e-308, 1e17, -1e300, 1.7e308]), st.floats(-1e3, 1e3)
)

FACTORS = st.one_of(
    st.sampled_from([1.0, 1.0, -1.0, 0.0, -0.0, 1e-6, -1e-7, 3e-320, 1e300, -1e250, 0.5]), st.floats(-3.0, 3.0)
)

EDGES = np.linspace(-5.0, 80.0, 40)


@pytest.fixture
def short_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, size in (("WIDEST", 8), ("FILLED", 6), ("AT_A_TIME", 2), ("MANY_ROWS", 2)):
        monkeypatch.setattr(rows, name, size)
    monkeypatch.setattr(placing, "FEW", 2)
    monkeypatch.setattr(placing, "FEW_EACH", 2)


def channel_of(seed: int, n: int, kinds: int, scale: float, *, even: bool = False) -> Channel:
    """Keys by one or more rules, uneven rows, values on both sides of 0 and at both zeros."""
    chance = np.random.default_rng(seed)
    rules_out = chance.choice(chance.permutation(RULES)[:kinds], n)
    rules_in = np.where(rules_out == TangentRule.STEP, TangentRule.AUTO, rules_out)
    values = chance.normal(size=n).clip(-2.0, 2.0) * scale * chance.choice([0.0, -0.0, 1.0, 1.0], n)
    times = (np.full(n, 0.25) if even else chance.uniform(0.01, 1.0, n)).cumsum() - 2.0
    slopes = chance.normal(size=(2, n)).clip(-2.0, 2.0) * scale
    modes = chance.choice(list(Extrapolation), 2)
    channel = Channel("x", make_run(times, values, *slopes, rules_in, rules_out), pre=modes[0], post=modes[1])
    for _ in range(int(chance.integers(0, 4))):
        run = channel.run()
        at = int(chance.integers(0, len(run) - 3))
        channel.splice(run[at : at + 3], run[at + 1 : at + 2])
    return channel


def all_bytes(channel: Channel) -> tuple[Any, ...]:
    channel.check()
    rows = channel._rows
    slots = rows.slots(np.arange(rows.size))
    return rows.numbers[:, slots].tobytes(), channel.run().tobytes(), channel.pre, channel.post


def is_what_the_splice_makes(gesture: Gesture, channel: Channel, alone: Channel) -> Reach:
    """Assert that *channel* looks as *alone*, its like before the preview, does after its splice."""
    (splice,) = gesture.changes
    assert isinstance(splice, Splice)
    reach = alone.splice(alone.run(), splice.after)
    assert all_bytes(channel) == all_bytes(alone)
    assert channel._rows.minus_zero >= alone._rows.minus_zero
    for edges in (EDGES, np.linspace(-100.0, 30.0, 40)):
        for ours, theirs in zip(channel.envelope(edges), alone.envelope(edges), strict=True):
            assert ours.tobytes() == theirs.tobytes()
        assert channel.evaluate(edges).tobytes() == alone.evaluate(edges).tobytes()
        assert [channel.value(time) for time in edges.tolist()] == alone.evaluate(edges).tolist()
    return reach


type Step = Callable[[Clip, Selection], list[Change]]


def moved(d_time: float, d_value: float, reorder: bool) -> Step:
    return lambda clip, chosen: edits.move(clip, chosen, d_time, d_value, reorder=reorder)


def scaled(time: float, value: float, f_time: float, f_value: float) -> Step:
    return lambda clip, chosen: edits.scale(clip, chosen, time, value, f_time, f_value)


@pytest.mark.usefixtures("short_rows")
@settings(max_examples=300, deadline=None)
@given(
    st.integers(0, 10**6),
    st.integers(13, 80),
    st.integers(1, 3),
    st.sampled_from([1.0, 1e-310, 1e305, 8e307]),
    st.lists(
        st.one_of(
            st.builds(moved, NUMBERS, NUMBERS, st.booleans()),
            st.builds(moved, st.just(0.0), NUMBERS, st.booleans()),
            st.builds(moved, NUMBERS, st.just(-0.0), st.booleans()),
            st.builds(scaled, NUMBERS, NUMBERS, FACTORS, FACTORS),
        ),
        min_size=1,
        max_size=6,
    ),
)
def test_every_step_of_a_drag_of_all_keys_is_what_the_splice_makes(
    seed: int, n: int, kinds: int, scale: float, steps: list[Step]
) -> None:
    channel, twin = (channel_of(seed, n, kinds, scale) for _ in range(2))
    document, start = Document(Clip([channel])), everything(Clip([channel]))
    chosen = Selection.of_all([channel])
    told: list[tuple[float, float]] = []
    document.changed.connect(lambda _, t0, t1: told.append((t0, t1)))
    one = Selection.of({channel: chosen.ids(channel)[:: n // 2]})
    gesture = document.begin("Drag")
    if seed % 2:
        assert list(gesture.prepared(chosen))
    for place, step in enumerate(steps):
        if place % 3 == 0:
            # Marks are written over the keys that a step before has left behind.
            flat = (edits.set_rule(clip, one, TangentRule.FLAT) for clip in [document.clip])
            gesture.preview(lambda clip, f=flat: [*edits.move(clip, chosen, 0.0, 1.0), *next(f)])
        told.clear()
        gesture.preview(lambda clip, s=step: s(clip, chosen))
        reach = is_what_the_splice_makes(gesture, channel, channel_of(seed, n, kinds, scale))
        assert told[0][0] <= reach.t0 <= reach.t1 <= told[0][1]
    shown = everything(Clip([channel]))
    edit = gesture.commit()
    assert everything(Clip([channel])) == shown
    if edit is not None:
        for sides, bytes_ in ((edit.inverse(), start), (edit, shown), (edit.inverse(), start)):
            document.apply(sides)
            assert everything(Clip([channel])) == bytes_
    assert everything(Clip([channel])) == start == everything(Clip([twin]))
    assert all_bytes(channel) == all_bytes(twin)


def little(low: float, high: float) -> st.SearchStrategy[float]:
    return st.one_of(st.just(low / 2.0 + high / 2.0), st.floats(low, high))


@pytest.mark.usefixtures("short_rows")
@settings(max_examples=300, deadline=None)
@given(
    st.integers(0, 10**6),
    st.integers(20, 80),
    st.integers(1, 3),
    st.sampled_from([1.0, 1.0, 1e-310, 8e307]),
    st.lists(
        st.one_of(
            st.builds(moved, st.just(0.0), NUMBERS, st.just(True)),
            st.builds(moved, little(-0.02, 0.02), NUMBERS, st.just(True)),
            st.builds(scaled, little(0.0, 5.0), NUMBERS, little(0.999, 1.001), FACTORS),
            st.builds(scaled, NUMBERS, NUMBERS, FACTORS, FACTORS),
        ),
        min_size=1,
        max_size=5,
    ),
    st.booleans(),
)
def test_every_step_of_a_drag_of_most_keys_is_what_splices_make(
    seed: int, n: int, kinds: int, scale: float, steps: list[Step], keep: bool
) -> None:
    channel, twin = channels = [channel_of(seed, n, kinds, scale) for _ in range(2)]
    start, ids = all_bytes(channel), channel.run()["id"]
    picked = np.random.default_rng(seed).choice(ids, max(13, len(ids) - 1 - seed % (len(ids) // 2)), replace=False)
    chosen = [Selection.of({each: picked}) for each in channels]
    documents = [Document(Clip([each])) for each in channels]
    gestures = [document.begin("Drag") for document in documents]
    if seed % 2:
        assert list(gestures[0].prepared(chosen[0]))
    kept, model.short_ways.MOST_RESORTED = model.short_ways.MOST_RESORTED, 0
    try:
        for step in steps:
            gestures[0].preview(lambda clip, s=step: s(clip, chosen[0]))
            gestures[1].preview(lambda clip, s=step: unshifted(s(clip, chosen[1])))
            assert all_bytes(channel) == all_bytes(twin)
            assert gestures[0].hides_keys == gestures[1].hides_keys
            assert gestures[0].keys_fewer == gestures[1].keys_fewer
    finally:
        model.short_ways.MOST_RESORTED = kept
    if keep:
        made = [gesture.commit() for gesture in gestures]
        assert (made[0] is None) == (made[1] is None)
        shown = all_bytes(channel)
        assert shown == all_bytes(twin)
        if made[0] is not None:
            for edit, state in ((made[0].inverse(), start), (made[0], shown), (made[0].inverse(), start)):
                documents[0].apply(edit)
                assert all_bytes(channel) == state
    else:
        gestures[0].cancel()
    assert all_bytes(channel) == start


@pytest.mark.usefixtures("short_rows")
def test_most_keys_take_the_short_way_unless_they_pass_others(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(model.short_ways, "MOST_RESORTED", 0)
    channel = Channel("x", make_run(np.arange(60.0), np.sin(np.arange(60.0))))
    document, chosen = Document(Clip([channel])), Selection.of({channel: np.delete(np.arange(1, 61), [7, 30])})
    opening = all_bytes(channel)
    with document.begin("Drag") as gesture:
        for step, short in (
            (moved(0.0, 2.0, True), True),
            (moved(0.5, 2.0, True), True),
            (moved(1.5, 2.0, True), False),
            (scaled(30.0, 1.0, 1.01, 2.0), True),
            (scaled(30.0, 1.0, -1.0, 2.0), False),
        ):
            gesture.preview(lambda clip, s=step: s(clip, chosen))
            assert all(isinstance(change, Shift if short else Splice) for change in gesture._put)
        gesture.preview(lambda clip: edits.move(clip, chosen, 0.25, 2.0))
        (splice,) = gesture.changes
        assert isinstance(splice, Splice)
        assert splice.after.tobytes() == channel.run().tobytes()
        shown = all_bytes(channel)
        wrong = Setting(document.clip, "title", "", "\n")
        with pytest.raises(ValueError, match="title"):
            gesture.preview(lambda clip: [*edits.move(clip, chosen, 0.0, 1.0), wrong])
        assert all_bytes(channel) == shown
    assert gesture.edit is not None
    document.apply(gesture.edit.inverse())
    assert all_bytes(channel) == opening


@pytest.mark.parametrize("kinds", [1, 3])
@pytest.mark.parametrize("n", [25_000, 30_000])
def test_a_drag_of_very_many_keys_ends_where_it_began_if_it_is_cancelled(n: int, kinds: int) -> None:
    channel, twin = (channel_of(n + kinds, n, kinds, 1.0) for _ in range(2))
    document, chosen = Document(Clip([channel])), Selection.of_all([channel])
    opening = all_bytes(channel)
    gesture = document.begin("Drag")
    for step in (
        scaled(2.0, 0.5, 1.5, -3.0),
        scaled(2.0, 0.5, -0.75, 1.0),
        moved(0.1, -2.0, True),
        scaled(-0.0, -0.0, -1.0, 0.0),
        scaled(0.0, 0.1, 1.0, 0.3),
    ):
        gesture.preview(lambda clip, s=step: s(clip, chosen))
        assert [type(change) for change in gesture._put] == [Shift]
        is_what_the_splice_makes(gesture, channel, twin.copy())
    gesture.cancel()
    assert all_bytes(channel) == opening


@pytest.mark.usefixtures("short_rows")
def test_keys_mirrored_and_mirrored_back_in_one_drag_are_an_edit_of_nothing() -> None:
    channel = channel_of(7, 60, 3, 1.0)
    document, chosen = Document(Clip([channel])), Selection.of_all([channel])
    opening = all_bytes(channel)
    with document.begin("Drag") as gesture:
        gesture.preview(lambda clip: edits.scale(clip, chosen, 0.0, 0.0, -1.0, 1.0))
        assert not gesture.hides_keys
        assert channel.run()["id"].tolist() == chosen.ids(channel)[np.argsort(times_of(channel, chosen))].tolist()
        gesture.preview(lambda clip: edits.move(clip, chosen, 0.0, 0.0))
    assert gesture.edit is None
    assert all_bytes(channel) == opening


def times_of(channel: Channel, chosen: Selection) -> list[float]:
    return [channel.key(key_id).time for key_id in chosen.ids(channel).tolist()]


@pytest.mark.usefixtures("short_rows")
@pytest.mark.parametrize(
    ("move", "short"), [((0.5, -3.0), True), ((0.0, 0.0), True), ((1e17, 0.0), False), ((0.0, 1.7e308), False)]
)
@pytest.mark.parametrize("rules", [(TangentRule.SMOOTH,), (TangentRule.SMOOTH, TangentRule.AUTO)])
def test_only_what_is_unusual_is_left_to_a_splice(
    move: tuple[float, float], short: bool, rules: tuple[TangentRule, ...]
) -> None:
    columns = np.resize(rules, 50)
    channel = Channel("x", make_run(np.arange(50), np.arange(50) % 7 * 1e305, 0.0, 0.0, columns, columns))
    document, chosen = Document(Clip([channel])), Selection.of_all([channel])
    with document.begin("Drag") as gesture:
        gesture.preview(lambda clip: edits.move(clip, chosen, *move))
        assert [isinstance(change, Shift) for change in gesture._put] == [short]


@pytest.mark.usefixtures("short_rows")
@pytest.mark.parametrize("meet", range(1, 49))
def test_where_rounding_brings_two_keys_together_a_splice_parts_them(meet: int) -> None:
    times = np.arange(50.0)
    times[meet] = times[meet - 1] + 1e-9
    columns = np.resize([TangentRule.SMOOTH, TangentRule.AUTO], 50)
    channel = Channel("x", make_run(times, np.arange(50) % 7, 0.0, 0.0, columns, columns))
    document, chosen = Document(Clip([channel])), Selection.of_all([channel])
    with document.begin("Drag") as gesture:
        gesture.preview(lambda clip: edits.move(clip, chosen, 1e9, 0.0))
        assert [isinstance(change, Splice) for change in gesture._put] == [True]
        channel.check()


@pytest.mark.usefixtures("short_rows")
def test_slopes_too_steep_for_a_double_are_those_of_the_rule() -> None:
    channel = Channel("x", make_run(np.arange(50) * 1e-309, np.resize([1.0, 1.0, -1.0, -1.0], 50)))
    document, chosen = Document(Clip([channel])), Selection.of_all([channel])
    with document.begin("Drag") as gesture:
        gesture.preview(lambda clip: edits.move(clip, chosen, 0.0, 1.0))
        channel.check()
        assert np.isfinite(channel.run()["slope_in"]).all()


@pytest.mark.usefixtures("short_rows")
@settings(max_examples=200, deadline=None)
@given(
    st.integers(0, 10**6),
    st.integers(30, 120),
    st.integers(1, 3),
    st.sampled_from([1.0, 1.0, 1e-310, 8e307]),
    st.booleans(),
    st.lists(
        st.tuples(st.one_of(NUMBERS, st.integers(-40, 40).map(lambda i: i / 4)), NUMBERS, st.booleans(), st.booleans()),
        min_size=1,
        max_size=5,
    ),
)
def test_every_step_of_a_drag_of_some_keys_is_what_splices_make(
    seed: int, n: int, kinds: int, scale: float, even: bool, steps: list[tuple[float, float, bool, bool]]
) -> None:
    channel, twin = channels = [channel_of(seed, n, kinds, scale, even=even) for _ in range(2)]
    start = all_bytes(channel)
    picked = np.random.default_rng(seed).choice(channel.run()["id"], 13 + seed % (n // 3), replace=False)
    chosen = [[Selection.of({each: ids}) for each in channels] for ids in (picked, picked[1:])]
    documents = [Document(Clip([each])) for each in channels]
    gestures = [document.begin("Drag") for document in documents]
    far = make_run([1e9])
    for d_time, d_value, fewer, one_more in steps:
        for gesture, each, keys, expanded in zip(gestures, channels, chosen[fewer], (list, unshifted), strict=True):
            new = [Splice(each, far[:0], far)] if one_more and abs(d_time) < 1e3 else []
            moved = partial(edits.move, selection=keys, d_time=d_time, d_value=d_value)
            gesture.preview(lambda clip, m=moved, e=expanded, s=new: [*e(m(clip)), *s])
        assert all_bytes(channel) == all_bytes(twin)
        assert gestures[0].hides_keys == gestures[1].hides_keys
        assert gestures[0].keys_fewer == gestures[1].keys_fewer
        covered = [[run.tobytes() for run in gesture.covered.values()] for gesture in gestures]
        assert covered[0] == covered[1]
        assert documents[0].session.selection.ids(channel).tolist() == documents[1].session.selection.ids(twin).tolist()
    made = [gesture.commit() for gesture in gestures]
    assert (made[0] is None) == (made[1] is None)
    assert all_bytes(channel) == all_bytes(twin)
    if made[0] is not None:
        shown = all_bytes(channel)
        documents[0].apply(made[0].inverse())
        assert all_bytes(channel) == start
        documents[0].apply(made[0])
        assert all_bytes(channel) == shown


def test_keys_that_pass_others_take_the_short_way_and_those_that_land_on_others_do_not() -> None:
    channel = Channel("x", make_run(np.arange(100.0), np.sin(np.arange(100.0))))
    document, chosen = Document(Clip([channel])), Selection.of({channel: np.arange(10, 90, 4)})
    with document.begin("Drag") as gesture:
        for d_time, shifts in ((0.5, 1), (7.5, 1), (0.0, 1), (1.0, 0), (-40.25, 1)):
            gesture.preview(lambda clip, t=d_time: edits.move(clip, chosen, t, 1.0))
            start = channel._rows.start
            assert start is not None
            assert (start._whole is not None) == shifts, d_time
            assert gesture.keys_fewer == (0 if shifts else 20)
            channel.check()


def test_keys_that_only_rounding_keeps_apart_from_others_land_on_them() -> None:
    times = np.arange(200) * 0.1
    apart = np.flatnonzero(times[:-3] + 0.3 != times[3:])
    channel = Channel("x", make_run(times, np.sin(times)))
    document, chosen = Document(Clip([channel])), Selection.of({channel: apart[np.diff(apart, append=0) != 3] + 1})
    with document.begin("Drag") as gesture:
        gesture.preview(lambda clip: edits.move(clip, chosen, 0.3, 1.0))
        assert chosen.count > 20
        assert gesture.keys_fewer > 20
