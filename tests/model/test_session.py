"""Session and snapping: setters that tell only what is new; frames and keys that times snap to."""

from math import inf, nan

import pytest

from model.channel import Channel
from model.clip import Clip
from model.keyframe import make_run
from model.selection import Selection
from model.session import Session
from model.snapping import snapped_to_keys, snapped_to_values
from tests.model.editing import channel_of, select


def test_a_setter_tells_only_what_is_new() -> None:
    session, channel, other = Session(), channel_of([0.0, 1.0]), channel_of([0.0])
    told: list[str] = []
    session.selection_changed.connect(lambda: told.append("selection"))
    session.active_changed.connect(lambda: told.append("active"))
    session.playhead_changed.connect(lambda: told.append("playhead"))
    session.visibility_changed.connect(lambda: told.append("visibility"))
    session.option_changed.connect(told.append)
    for _ in range(2):
        session.selection = select(channel, 1)
        session.active = channel
        session.playhead = 1.0
        session.hidden = {other}
        session.solo = [channel]
        session.folded = {"root"}
        session.playing = True
        session.loop = False
        session.snap = False
        session.reorder = False
        session.tool = "scale"
    options = ["folded", "playing", "loop", "snap", "reorder", "tool"]
    assert told == ["selection", "active", "playhead", "visibility", "visibility", *options]


def test_hidden_and_solo_decide_what_is_shown_and_the_lock_what_can_be_edited() -> None:
    session = Session()
    a, b, c = (channel_of([0.0], name) for name in "abc")
    c.locked = True
    clip = Clip([a, b, c])
    assert session.shown_channels(clip) == [a, b, c]
    assert [session.editable(channel) for channel in clip.channels] == [True, True, False]
    session.hidden = {b}
    assert session.shown_channels(clip) == [a, c]
    session.solo = {b, c}
    assert session.shown_channels(clip) == [c]
    session.hidden = ()
    assert session.shown_channels(clip) == [b, c]


def test_keys_that_are_no_longer_shown_are_no_longer_selected() -> None:
    session = Session()
    a, b, c = (channel_of([0.0, 1.0], name) for name in "abc")
    everything = Selection.of_all([a, b, c])
    counts: list[int] = []
    session.selection_changed.connect(lambda: counts.append(session.selection.count))
    session.selection = everything
    session.hidden = {a}
    session.solo = {b}
    session.hidden = session.solo = ()
    assert session.selection == Selection.of_all([b])
    session.solo = {c}
    session.selection = everything
    assert session.selection == Selection.of_all([c])
    assert counts == [6, 4, 2, 0, 2]


@pytest.mark.parametrize("time", [nan, inf, -inf])
def test_the_playhead_is_at_a_finite_time(time: float) -> None:
    session = Session()
    with pytest.raises(ValueError, match="playhead cannot be at"):
        session.playhead = time
    assert session.playhead == 0.0


def test_times_snap_to_whole_frames() -> None:
    clip = Clip(frame_rate=24.0)
    session = Session()
    assert session.snap_time(clip, 0.52) == 12 / 24
    assert session.snap_time(clip, -0.09) == -2 / 24
    assert session.snap_time(clip, 1e300) == 1e300
    assert session.snap_time(clip, nan) != session.snap_time(clip, nan)


def test_a_key_that_was_meant_to_be_on_the_frame_gives_its_own_time() -> None:
    meant = 0.1 + 0.2
    channel, far = Channel("x", make_run([meant], 0.0)), Channel("y", make_run([0.3 + 1e-4], 0.0))
    clip = Clip([far, channel], frame_rate=10.0)
    session = Session()
    assert session.snap_time(clip, 0.31) == meant
    session.hidden = {channel}
    assert session.snap_time(clip, 0.31) == 3 / 10
    session.active = channel
    assert session.snap_time(clip, 0.31) == meant


def test_times_snap_to_keys_and_values_to_curves_nearby() -> None:
    channels = [channel_of([0.0, 4.0], "a"), channel_of([1.0, 1.0], "b", step=0.9)]
    assert snapped_to_keys(channels, 0.93, 0.1) == 0.9
    assert snapped_to_keys(channels, 0.96, 0.1) == 1.0
    assert snapped_to_keys(channels, 0.5, 0.1) == 0.5
    assert snapped_to_values(channels, 0.5, 1.2, 0.3) == 1.0
    assert snapped_to_values(channels, 0.5, 1.4, 0.3) == 1.4


def test_settling_tells_each_thing_once_when_all_is_in_place() -> None:
    session, gone, stays = Session(), channel_of([0.0], "gone"), channel_of([0.0], "stays")
    session.selection, session.active = select(gone, 1), gone
    session.hidden, session.solo = frozenset({gone}), frozenset({gone, stays})
    seen: list[tuple[object, ...]] = []
    for event in (session.selection_changed, session.active_changed, session.visibility_changed):
        event.connect(lambda: seen.append((session.selection, session.active, session.hidden, session.solo)))
    session.settle([stays], Selection.of({gone: [1], stays: [1]}), gone)
    assert seen == [(select(stays, 1), None, frozenset(), {stays})] * 3
