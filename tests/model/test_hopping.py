"""One key moved among others: its short way gives the bytes of splices, and tells how little of the curve changes."""

from collections.abc import Callable
from math import inf, isfinite

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from model import edits
from model.change import Change, Shift, Splice, unshifted
from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.extrapolation import Extrapolation
from model.keyframe import make_run
from model.selection import Selection
from tests.model.editing import everything, select
from tests.model.test_shifting import NUMBERS, all_bytes, channel_of, short_rows

__all__ = ["short_rows"]

STEPS = st.lists(
    st.tuples(st.one_of(NUMBERS, st.integers(-60, 60).map(lambda i: i / 4), st.floats(-1.0, 1.0)), NUMBERS),
    min_size=1,
    max_size=6,
)


type Compute = Callable[[Clip], list[Change]]


def moved(channel: Channel, key_id: int, d_time: float, d_value: float) -> Compute:
    """The move of one key."""
    return lambda clip: edits.move(clip, select(channel, key_id), d_time, d_value)


def sampled(channel: Channel) -> tuple[np.ndarray, np.ndarray]:
    """Times all over the channel, keys and places beside them included, and the values there."""
    keys = channel.run()["time"]
    keys = keys[np.abs(keys) < 1e6]
    times = np.unique(np.concatenate([np.linspace(-80.0, 120.0, 4001), keys, np.nextafter(keys, -inf)]))
    return times, channel.evaluate(times)


@pytest.mark.usefixtures("short_rows")
@settings(max_examples=300, deadline=None)
@given(
    st.integers(0, 10**6),
    st.integers(12, 70),
    st.integers(1, 3),
    st.sampled_from([1.0, 1.0, 1.0, 1e-310, 8e307]),
    st.booleans(),
    STEPS,
    st.booleans(),
)
def test_every_step_of_a_drag_of_one_key_is_what_splices_make(
    seed: int, n: int, kinds: int, scale: float, even: bool, steps: list[tuple[float, float]], keep: bool
) -> None:
    channel, twin = channels = [channel_of(seed, n, kinds, scale, even=even) for _ in range(2)]
    opening, run = all_bytes(channel), channel.run()
    key_id = int(run["id"][seed % len(run)])
    documents = [Document(Clip([each])) for each in channels]
    gestures = [document.begin("Drag") for document in documents]
    told: list[tuple[float, float]] = []
    documents[0].changed.connect(lambda _, t0, t1: told.append((t0, t1)))
    for d_time, d_value in steps:
        times, before = sampled(channel)
        told.clear()
        gestures[0].preview(moved(channel, key_id, d_time, d_value))
        compute = moved(twin, key_id, d_time, d_value)
        gestures[1].preview(lambda clip, c=compute: unshifted(c(clip)))
        assert all_bytes(channel) == all_bytes(twin)
        assert gestures[0].hides_keys == gestures[1].hides_keys
        assert gestures[0].covered.keys() == ({channel} if gestures[1].covered else set())
        ((t0, t1),) = told
        outside = (times < t0) | (times > t1)
        assert channel.evaluate(times[outside]).tobytes() == before[outside].tobytes()
    shown, twin_shown = everything(documents[0].clip), everything(documents[1].clip)
    assert shown == twin_shown
    if keep:
        made = [gesture.commit() for gesture in gestures]
        assert (made[0] is None) == (made[1] is None)
        assert everything(documents[0].clip) == shown
        if made[0] is not None and made[1] is not None:
            assert made[0].label == made[1].label
            for edit in (made[0].inverse(), made[0], made[0].inverse()):
                documents[0].apply(edit)
                channel.check()
    else:
        gestures[0].cancel()
    assert all_bytes(channel) == opening


def told_of(channel: Channel, moves: list[tuple[float, float]], key_id: int) -> list[tuple[float, float]]:
    """From when to when each of these previews of one drag has changed the curve."""
    document = Document(Clip([channel]))
    told: list[tuple[float, float]] = []
    document.changed.connect(lambda _, t0, t1: told.append((t0, t1)))
    with document.begin("Drag") as gesture:
        for d_time, d_value in moves:
            gesture.preview(moved(channel, key_id, d_time, d_value))
        gesture.cancel()
    return told[: len(moves)]


def test_a_key_far_from_home_changes_the_curve_only_where_it_was_and_where_it_is() -> None:
    channel = Channel("x", make_run(np.arange(5000.0), np.sin(np.arange(5000.0))))
    first, second, third = told_of(channel, [(1000.5, 1.0), (1010.5, 1.0), (1010.5, 2.0)], 2001)
    assert first[0] <= 1999.0 < 3002.0 <= first[1]
    assert 2995.0 < second[0] < second[1] < 3015.0
    assert 3005.0 < third[0] < third[1] < 3015.0


@pytest.mark.parametrize("post", [Extrapolation.LINEAR, Extrapolation.CYCLE, Extrapolation.CONSTANT])
def test_where_the_curve_goes_on_differently_behind_the_keys_that_is_told(post: Extrapolation) -> None:
    channel = Channel("x", make_run(np.arange(50.0), np.sin(np.arange(50.0))), post=post)
    for key_id, moves in ((50, [(0.0, 1.0), (0.0, 2.0)]), (20, [(100.0, 1.0), (200.0, 2.0)])):
        assert all(t1 == inf for _, t1 in told_of(channel, moves, key_id))
    still = told_of(channel, [(0.0, 1.0), (0.0, 2.0)], 20)
    assert all(isfinite(t1) == (post != Extrapolation.CYCLE) for _, t1 in still)


def test_it_is_the_short_way_unless_the_key_lands_on_another() -> None:
    channel = Channel("x", make_run(np.arange(2000.0), np.sin(np.arange(2000.0))))
    document = Document(Clip([channel]))
    with document.begin("Drag") as gesture:
        for d_time, short in ((0.25, True), (1.0, False), (0.0, True), (1500.5, True), (-900.0, False)):
            gesture.preview(moved(channel, 1001, d_time, 1.0))
            assert [isinstance(change, Shift) for change in gesture._put] == [short] * len(gesture._put)
            assert all(isinstance(change, Splice) for change in gesture.changes)
            assert len(channel) == 2000 - (not short)
        gesture.preview(lambda clip: edits.move(clip, select(channel, 1001), 500.5, 1.0))
    assert gesture.edit is not None
    assert gesture.edit.key_count == 1
    document.apply(gesture.edit.inverse())
    assert channel.run()["time"].tolist() == list(range(2000))
    document.apply(gesture.edit)
    assert channel.key(1001).time == 1500.5


def test_a_preview_that_cannot_be_made_leaves_the_one_before_in_place() -> None:
    channel = Channel("x", make_run(np.arange(2000.0), 0.0))
    document = Document(Clip([channel]))
    chosen = Selection.of({channel: [1001]})
    with document.begin("Drag") as gesture:
        gesture.preview(lambda clip: edits.move(clip, chosen, 900.5, 1.0))
        shown = all_bytes(channel)
        bad = make_run([5.0])
        with pytest.raises(ValueError, match="time"):
            gesture.preview(lambda clip: [*edits.move(clip, chosen, 3.5, 1.0), Splice(channel, bad[:0], bad)])
        assert all_bytes(channel) == shown
        gesture.cancel()
    channel.check()
