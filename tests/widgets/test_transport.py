"""The playhead runs by the wall clock, loops or stops, and steps by frames and keys; its numbers can be typed."""

import math
import time

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QSignalSpy, QTest
from PySide6.QtWidgets import QAbstractButton, QLineEdit

from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.keyframe import make_run
from model.selection import Selection
from widgets.guard import unguarded
from widgets.playback import Playback
from widgets.theme import Theme
from widgets.transport import BUTTONS, Transport

Key = Qt.Key


class Clock:
    """A clock that stands until it is moved."""

    now = 100.0

    def __call__(self):
        return self.now


@pytest.fixture
def document():
    a = Channel("a", make_run([0, 1, 2], [0, 1, 2]))
    b = Channel("b", make_run([0.5, 1.5], [0, 1]))
    return Document(Clip([a, b], start=0.0, end=2.0, frame_rate=10.0))


@pytest.fixture
def session(document):
    return document.session


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def playback(qapp, document, clock):
    return Playback(document, clock=clock)


@pytest.fixture
def transport(qtbot, document):
    widget = Transport(document, Theme("dark"))
    qtbot.addWidget(widget)
    widget.show()
    widget.activateWindow()
    qtbot.waitUntil(widget.isActiveWindow)
    return widget


def run(playback, clock, *seconds):
    for step in seconds:
        clock.now += step
        playback.tick()


def test_the_playhead_is_where_the_clock_says_however_rarely_it_is_asked(playback, session, clock):
    session.snap = False
    playback.toggle_play()
    run(playback, clock, 0.01, 0.7, 0.002)
    assert session.playhead == pytest.approx(0.712, abs=1e-12)
    playback.toggle_play()
    assert not session.playing
    assert session.playhead == pytest.approx(0.712, abs=1e-12)


def test_a_loop_goes_round_without_losing_time(playback, session, clock):
    playback.toggle_play()
    run(playback, clock, 1.9, 0.35, 4.0)
    assert session.playhead == pytest.approx((1.9 + 0.35 + 4.0) % 2.0)
    assert session.playing


def test_a_loop_switched_off_plays_on_to_the_end(playback, session, clock):
    playback.toggle_play()
    run(playback, clock, 2.5)
    session.loop = False
    run(playback, clock, 0.25)
    assert (session.playhead, session.playing) == (0.75, True)


def test_without_the_loop_it_stops_at_the_end(playback, session, clock):
    session.loop = False
    playback.toggle_play()
    run(playback, clock, 2.5)
    assert (session.playhead, session.playing) == (2.0, False)


@pytest.mark.parametrize("place", [2.0, 5.0, -3.0])
def test_playing_from_outside_the_range_begins_at_its_start(playback, session, clock, place):
    session.playhead = place
    playback.toggle_play()
    run(playback, clock, 0.1)
    assert session.playhead == pytest.approx(0.1)


def test_a_playhead_that_is_dragged_while_playing_goes_on_from_there(playback, session, clock):
    playback.toggle_play()
    run(playback, clock, 0.3)
    session.playhead = 1.0
    run(playback, clock, 0.25, 0.25)
    assert session.playhead == pytest.approx(1.25)


def test_stop_goes_back_to_where_playing_began_and_then_to_the_start(playback, session, clock):
    session.playhead = 0.8
    playback.toggle_play()
    run(playback, clock, 0.5)
    playback.stop()
    assert (session.playhead, session.playing) == (0.8, False)
    playback.stop()
    assert session.playhead == 0.0


def test_pause_and_play_again_go_on(playback, session, clock):
    playback.toggle_play()
    run(playback, clock, 0.5)
    playback.toggle_play()
    clock.now += 60
    playback.toggle_play()
    run(playback, clock, 0.25)
    assert session.playhead == pytest.approx(0.75)


def test_a_pause_comes_to_rest_on_the_nearest_frame_while_snapping_is_on(playback, session, clock, document):
    def paused_after(seconds):
        session.playhead = 0.0
        playback.toggle_play()
        run(playback, clock, seconds)
        session.playing = False
        return session.playhead

    assert paused_after(0.514) == 0.5
    document.clip.end = 0.97
    assert paused_after(0.96) == 0.97, "the frame at 1.0 s lies outside of what is played"
    session.loop = False
    assert paused_after(1.2) == 0.97, "the end is the end, whole frame or not"
    session.snap = False
    assert paused_after(0.514) == pytest.approx(0.514)


def test_a_step_while_playing_goes_to_the_frame_beside(playback, session, clock):
    playback.toggle_play()
    run(playback, clock, 0.16)
    playback.step_frame(1)
    assert (session.playhead, session.playing) == (0.2, False)


def test_the_clips_range_is_played_and_without_one_the_times_of_the_keys(playback, document):
    assert playback.range() == (0.0, 2.0)
    document.clip.start = document.clip.end = 0.0
    assert playback.range() == (0.0, 2.0)
    document.clip.channels.clear()
    spy = QSignalSpy(playback.status)
    playback.toggle_play()
    assert not document.session.playing
    assert spy.count() == 1


def test_another_clip_stops_playing(playback, document):
    playback.toggle_play()
    document.replace(Clip())
    assert not document.session.playing


def test_the_real_clock_moves_the_playhead_in_real_time(transport, session, qtbot):
    start = time.perf_counter()
    QTest.mouseClick(transport.buttons["play"], Qt.MouseButton.LeftButton)
    qtbot.wait(200)
    elapsed = time.perf_counter() - start
    assert session.playhead == pytest.approx(elapsed, abs=0.05)
    transport.stop()
    qtbot.wait(30)
    assert session.playhead == 0.0


@pytest.mark.parametrize(
    ("start", "frames", "end"),
    [
        (0.0, 1, 0.1),
        (0.3, -1, 0.2),
        (0.34, 1, 0.4),
        (0.34, -1, 0.3),
        (0.3, 10, 1.3),
        (-0.05, 1, 0.0),
        (0.1 * 3, 1, 0.4),
        (0.1 * 3, -1, 0.2),
    ],
)
def test_steps_end_on_whole_frames(playback, session, start, frames, end):
    session.playhead = start
    playback.step_frame(frames)
    assert session.playhead == pytest.approx(end, abs=1e-15)


def test_steps_by_key_visit_every_key_of_the_shown_channels(playback, session):
    visited = []
    for _ in range(4):
        playback.step_key(1)
        visited.append(session.playhead)
    assert visited == [0.5, 1.0, 1.5, 2.0]
    playback.step_key(1)
    assert session.playhead == 2.0
    playback.step_key(-1)
    assert session.playhead == 1.5
    session.playhead = 1.2
    playback.step_key(-1)
    assert session.playhead == 1.0


def test_steps_by_key_keep_to_the_selected_or_the_active_channel(playback, session, document):
    a, b = document.clip.channels
    session.active = b
    playback.step_key(1)
    playback.step_key(1)
    assert session.playhead == 1.5
    session.selection = Selection.of({a: a.run()["id"][:1]})
    playback.step_key(1)
    assert session.playhead == 2.0
    session.selection = Selection.NONE
    session.active = None
    session.hidden = {b}
    playback.step_key(-1)
    assert session.playhead == 1.0


def test_frame_and_time_are_shown_and_typed(transport, session, qtbot):
    session.playhead = 1.25
    qtbot.waitUntil(lambda: transport.fields["time"].text() == "1.250")
    assert transport.fields["frame"].text() == "12.50"
    field = transport.fields["frame"]
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, "7")
    assert session.playhead == 0.7
    QTest.keyClick(field, Key.Key_Return)
    field.selectAll()
    QTest.keyClicks(field, "+=3")
    assert session.playhead == 1.0
    QTest.keyClick(field, Key.Key_Escape)
    assert session.playhead == 0.7


def test_the_playhead_is_not_rounded_by_looking_at_it(transport, session):
    session.playhead = math.pi / 3
    for field in (transport.fields["time"], transport.fields["frame"]):
        field.setFocus()
        QTest.keyClick(field, Key.Key_Return)
    transport.buttons["play"].setFocus()
    assert session.playhead == math.pi / 3


@pytest.mark.parametrize(
    ("name", "text", "setting", "expected"),
    [("frame_rate", "24", "frame_rate", 24.0), ("end", "*=2", "end", 4.0), ("start", "1/2", "start", 0.5)],
)
def test_range_and_rate_are_settings_that_can_be_undone(transport, document, name, text, setting, expected):
    seen = []
    document.committed.connect(seen.append)
    before = getattr(document.clip, setting)
    field = transport.fields[name]
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, text)
    QTest.keyClick(field, Key.Key_Return)
    assert getattr(document.clip, setting) == expected
    assert len(seen) == 1
    document.apply(seen[0].inverse())
    assert getattr(document.clip, setting) == before


@pytest.mark.parametrize(("name", "text"), [("frame_rate", "0"), ("frame_rate", "-5"), ("end", "-1"), ("time", "1/0")])
def test_numbers_that_cannot_be_are_refused_in_the_field(transport, document, name, text):
    field = transport.fields[name]
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, text)
    assert field.editing
    transport.buttons["play"].setFocus()
    clip = document.clip
    assert (clip.frame_rate, clip.start, clip.end, document.session.playhead) == (10.0, 0.0, 2.0, 0.0)
    assert not field.editing
    assert document.gesture is None


def test_a_refused_number_leaves_the_graph_to_the_user(transport, document):
    field = transport.fields["start"]
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, "5")  # behind the end
    assert field.editing
    assert document.gesture is None
    QTest.keyClicks(field, "0")
    QTest.keyClick(field, Key.Key_Backspace)
    QTest.keyClick(field, Key.Key_Escape)
    assert document.gesture is None
    assert document.clip.start == 0.0


def test_the_buttons_do_what_they_say(transport, session):
    def press(name):
        QTest.mouseClick(transport.buttons[name], Qt.MouseButton.LeftButton)

    for name, place in (("next_frame", 0.1), ("next_key", 0.5), ("to_end", 2.0), ("previous_key", 1.5)):
        press(name)
        assert session.playhead == pytest.approx(place), name
    press("previous_frame")
    assert session.playhead == pytest.approx(1.4)
    press("to_start")
    assert session.playhead == 0.0
    press("loop")
    assert not session.loop
    assert not transport.buttons["loop"].isChecked()
    session.loop = True
    assert transport.buttons["loop"].isChecked()


def test_the_play_button_says_pause_while_playing(transport, session):
    session.playing = True
    assert transport.buttons["play"].accessibleName() == "Pause"
    session.playing = False
    assert transport.buttons["play"].accessibleName() == "Play"


def test_shortcuts_are_named_in_the_tooltips(transport):
    transport.show_shortcuts({"play": "Space", "next_frame": "Right"})
    assert transport.buttons["play"].toolTip() == "Play or pause  (Space)"
    assert set(transport.buttons) == {row.name for row in BUTTONS} | {"loop"}


def test_where_there_is_little_room_the_range_stands_below_the_playhead(transport, qtbot):
    time, start = transport.fields["time"], transport.fields["start"]
    transport.setMinimumSize(1, 1)  # as in a window, where its own hint counts and not that of its layout
    transport.resize(1200, transport.height())
    qtbot.waitUntil(lambda: time.y() == start.y())
    assert transport.minimumSizeHint().width() < 700
    transport.resize(700, transport.height())
    qtbot.waitUntil(lambda: start.y() > time.y())
    assert all(field.geometry().right() < 700 for field in transport.fields.values())
    transport.resize(1200, transport.height())
    qtbot.waitUntil(lambda: time.y() == start.y())


def test_every_part_has_a_name_for_a_screen_reader_and_is_reached_by_tab(transport):
    parts = [part for kind in (QAbstractButton, QLineEdit) for part in transport.findChildren(kind)]
    assert len(parts) == 14
    for part in parts:
        assert part.accessibleName()
        assert part.focusPolicy() & Qt.FocusPolicy.TabFocus


def test_every_override_is_guarded():
    assert unguarded(Transport) == unguarded(Playback) == []
