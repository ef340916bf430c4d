"""Beyond the keys: each mode on each side, joins, turns, and no length at all."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.channel import Channel
from model.extrapolation import EXTRAPOLATIONS, Extrapolation
from model.keyframe import TangentRule, make_run
from tests.model.drawn import bits, channels

C, L, CY, CO, B = Extrapolation


def channel_of(mode: Extrapolation) -> Channel:
    """0, 4, 1 at 0, 1, 3; slopes 2 into the first key and -1 out of the last."""
    slopes = [2.0, 0.0, 0.0], [0.0, 0.0, -1.0]
    run = make_run([0.0, 1.0, 3.0], [0.0, 4.0, 1.0], *slopes, TangentRule.FIXED, TangentRule.FIXED)
    return Channel("x", run, pre=mode, post=mode)


def test_every_mode_has_a_row_and_a_word() -> None:
    assert list(EXTRAPOLATIONS) == list(Extrapolation)
    for mode, row in EXTRAPOLATIONS.items():
        assert row.label
        assert row.tip
        assert Extrapolation.from_word(mode.word) is mode
    assert len({row.label for row in EXTRAPOLATIONS.values()}) == len(Extrapolation)


def test_numbers_of_modes_never_change() -> None:
    assert [(mode.word, int(mode)) for mode in Extrapolation] == [
        ("constant", 0),
        ("linear", 1),
        ("cycle", 2),
        ("cycle_offset", 3),
        ("bounce", 4),
    ]
    for word in ("", "Cycle", "cyclic"):
        with pytest.raises(ValueError, match="known: constant, linear"):
            Extrapolation.from_word(word)


TIMES = [-6.0, -5.0, -3.0, -2.0, 4.0, 6.0, 7.0, 9.0]
VALUES = {
    C: [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0],
    L: [-12.0, -10.0, -6.0, -4.0, 0.0, -2.0, -3.0, -5.0],
    CY: [0.0, 4.0, 0.0, 4.0, 4.0, 0.0, 4.0, 0.0],
    CO: [-2.0, 2.0, -1.0, 3.0, 5.0, 2.0, 6.0, 3.0],
    B: [0.0, 4.0, 1.0, 2.5, 2.5, 0.0, 4.0, 1.0],
}


@pytest.mark.parametrize("mode", Extrapolation)
def test_values_beyond_the_keys(mode: Extrapolation) -> None:
    channel = channel_of(mode)
    assert channel.evaluate(TIMES).tolist() == pytest.approx(VALUES[mode], abs=1e-12)


@pytest.mark.parametrize("mode", Extrapolation)
def test_the_end_keys_have_their_own_values(mode: Extrapolation) -> None:
    assert channel_of(mode).evaluate([0.0, 3.0]).tolist() == [0.0, 1.0]


def test_the_sides_are_independent() -> None:
    for pre in Extrapolation:
        for post in Extrapolation:
            channel = channel_of(pre)
            channel.set_extrapolation(pre, post)
            assert channel.evaluate(TIMES[:4]).tolist() == channel_of(pre).evaluate(TIMES[:4]).tolist()
            assert channel.evaluate(TIMES[4:]).tolist() == channel_of(post).evaluate(TIMES[4:]).tolist()


@pytest.mark.parametrize("mode", Extrapolation)
def test_one_key_goes_on_with_its_value_or_along_its_slopes(mode: Extrapolation) -> None:
    smooth = Channel("x", make_run([2.0], [5.0]), pre=mode, post=mode)
    assert smooth.evaluate([-9.0, 2.0, 9.0]).tolist() == [5.0, 5.0, 5.0]
    run = make_run([2.0], [5.0], 1.0, -2.0, TangentRule.FIXED, TangentRule.FIXED)
    fixed = Channel("x", run, pre=mode, post=mode)
    expected = [3.0, 5.0, 1.0] if mode is L else [5.0, 5.0, 5.0]
    assert fixed.evaluate([0.0, 2.0, 4.0]).tolist() == expected


def test_a_last_key_that_steps_holds() -> None:
    run = make_run([0.0, 1.0], [0.0, 1.0], 3.0, 3.0, TangentRule.FIXED, TangentRule.STEP)
    assert Channel("x", run, post=L).value(9.0) == 1.0


def test_linear_goes_on_with_the_outward_slopes() -> None:
    run = make_run([0.0, 1.0], [0.0, 1.0], [2.0, 9.0], [9.0, 4.0], TangentRule.FIXED, TangentRule.FIXED)
    channel = Channel("x", run, pre=L, post=L)
    assert channel.evaluate([-1.0, 2.0]).tolist() == [-2.0, 5.0]


def test_the_exact_image_of_a_key_has_its_value_in_mirrored_copies() -> None:
    run = make_run([0.0, 1.0, 3.0], [5.0, 7.0, 2.0], 0, 0, TangentRule.FLAT, TangentRule.STEP)
    channel = Channel("x", run, pre=B, post=B)
    # Mirrored copies run from 6 down to 3 and from 0 down to -3.
    for time in (5.0, -1.0):
        assert [channel.value(time + step) for step in (-1e-9, 0.0, 1e-9)] == [7.0, 7.0, 5.0]


def test_time_just_before_a_join_is_still_in_the_copy_before() -> None:
    run = make_run([0.06, 1.0, 8.67], [1.0, 2.0, 50.0], 0, 0, TangentRule.FLAT, TangentRule.STEP)
    for mode in (CY, CO):
        channel = Channel("x", run, pre=mode, post=mode)
        shift = -49.0 if mode is CO else 0.0
        assert channel.value(np.nextafter(0.06, -1.0)) == 2.0 + shift
        assert channel.evaluate([np.nextafter(0.06, -1.0)]).tolist() == [2.0 + shift]


@given(channels(least=2), st.integers(-5, 5), st.floats(0.0, 1.0))
def test_copies_repeat_the_keys(channel: Channel, copy: int, share: float) -> None:
    run = channel.run()
    first, last = float(run["time"][0]), float(run["time"][-1])
    length = last - first
    # A place that is kept exactly through the addition of whole lengths, and on no key.
    place = first + round(share * length * 1024) / 1024
    if place in run["time"]:
        place += 2.0**-12
    if not first < place < last:
        return
    offset = copy * (float(run["value"][-1]) - float(run["value"][0]))
    mirrored = first + last - place
    for mode, expected in ((CY, channel.value(place)), (CO, channel.value(place) + offset)):
        channel.set_extrapolation(mode, mode)
        assert channel.value(place + copy * length) == pytest.approx(expected, rel=1e-12, abs=1e-9)
    channel.set_extrapolation(B, B)
    expected = channel.value(mirrored if copy % 2 else place)
    assert channel.value(place + copy * length) == pytest.approx(expected, rel=1e-12, abs=1e-9)


@pytest.mark.parametrize("mode", Extrapolation)
def test_far_away_is_finite_and_the_same_one_by_one(mode: Extrapolation) -> None:
    times = [s * x for x in (1e3, 1e9, 1e15, 1e17, 1e100, 1.7976931348623157e308) for s in (-1.0, 1.0)]
    for run in (
        make_run([0.0, 1.0, 3.0], [0.0, 4.0, 1.0]),
        make_run([0.0, 5e-324], [1e308, -1e308]),
        make_run([-1.7e308, 1.7e308], [1e308, -1e308]),
        make_run([1e-9, 2e-9], [1e300, -1e300]),
    ):
        channel = Channel("x", run, pre=mode, post=mode)
        values = channel.evaluate(times)
        assert np.isfinite(values).all()
        assert bits(values) == bits([channel.value(time) for time in times])


@given(channels(least=1))
def test_constant_channels_stay_where_they_are(channel: Channel) -> None:
    run = channel.run().copy()
    run["value"], run["slope_in"], run["slope_out"] = 3.25, 0.0, 0.0
    flat = Channel("x", run, pre=channel.pre, post=channel.post)
    assert set(flat.evaluate(np.linspace(-2000.0, 2000.0, 333)).tolist()) == {3.25}
