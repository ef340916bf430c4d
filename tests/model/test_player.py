"""Playing in sequence gives the values of each channel, bit for bit, whatever happens meanwhile."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.keyframe import make_run
from model.player import AHEAD, Player
from tests.model.drawn import bits, channels, random_run
from tests.museum import museum


def values(clip: Clip, time: float) -> list[float]:
    return [channel.value(time) for channel in clip.channels]


@given(st.lists(channels(), max_size=6), st.lists(st.floats(-300, 300), max_size=12))
def test_a_pose_is_the_value_of_every_channel(drawn: list[Channel], times: list[float]) -> None:
    clip = Clip(drawn)
    player = Player(clip)
    for time in times + sorted(times):
        assert bits(player.pose(time)) == bits(values(clip, time))


def test_the_museum_plays_forwards_and_backwards() -> None:
    clip = Clip(museum().values())
    player = Player(clip)
    for time in [*np.arange(-4.0, 9.0, 0.11).tolist(), *np.arange(9.0, -4.0, -0.37).tolist(), 1e9, -1e300, 0.0]:
        assert bits(player.pose(time)) == bits(values(clip, time)), time


def test_long_channels_play_past_what_a_cursor_holds_and_past_rows() -> None:
    clip = Clip([Channel(str(seed), random_run(seed, 20 * AHEAD)) for seed in range(3)])
    player = Player(clip)
    end = max(float(channel.run()["time"][-1]) for channel in clip.channels)
    for time in np.linspace(0.0, end, 3000).tolist():
        assert bits(player.pose(time)) == bits(values(clip, time))


def test_a_player_notices_edits_of_any_kind() -> None:
    clip = Clip([Channel("a", random_run(1, 30)), Channel("b", random_run(2, 30))])
    player = Player(clip)
    a, b = clip.channels
    for change in (
        lambda: a.splice(a.run()[3:6], a.run()[:0]),
        lambda: a.set_extrapolation(Extrapolation.CYCLE, Extrapolation.LINEAR),
        lambda: a.splice(a.run(), a.run()[:0]),
        lambda: a.splice(a.run(), make_run([0.2, 0.4], [1.0, 2.0])),
        lambda: clip.channels.append(Channel("c", random_run(3, 9))),
        lambda: clip.channels.remove(b),
        lambda: clip.channels.reverse(),
        lambda: clip.channels.clear(),
    ):
        change()
        for time in (0.3, -5.0, 99.0):
            assert bits(player.pose(time)) == bits(values(clip, time))


def test_players_of_one_clip_do_not_disturb_each_other() -> None:
    clip = Clip([Channel("a", random_run(1, 300))])
    one, other = Player(clip), Player(clip)
    for time in np.linspace(0.0, 50.0, 100).tolist():
        assert bits(one.pose(time)) == bits(values(clip, time))
        assert bits(other.pose(50.0 - time)) == bits(values(clip, 50.0 - time))


def test_no_time_gives_no_pose() -> None:
    assert np.isnan(Player(Clip([Channel("a"), Channel("b", random_run(1, 5))])).pose(np.nan)).all()


@pytest.mark.parametrize("mode", Extrapolation)
def test_playing_on_beyond_the_keys(mode: Extrapolation) -> None:
    channel = Channel("a", make_run([0.0, 0.7, 1.3], [0.0, 2.0, -0.5]), pre=mode, post=mode)
    clip = Clip([channel])
    player = Player(clip)
    for time in np.linspace(-9.0, 9.0, 500).tolist():
        assert bits(player.pose(time)) == bits(values(clip, time))
