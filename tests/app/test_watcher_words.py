"""What the line of words says of keys that were inserted, and of those that were not."""

import pytest

from model.channel import Channel
from model.clip import Clip
from model.extrapolation import Extrapolation
from model.keyframe import make_run
from model.selection import Selection
from tests.app.conftest import MakeWindow


@pytest.mark.parametrize(
    ("mode", "time", "longer"),
    [(Extrapolation.CYCLE, 0.0, True), (Extrapolation.CYCLE, 1.5, False), (Extrapolation.CONSTANT, 0.0, False)],
)
def test_a_key_outside_makes_what_is_repeated_longer_and_that_is_said(
    make_window: MakeWindow, mode: Extrapolation, time: float, longer: bool
) -> None:
    channel = Channel("a", make_run([1.0, 2.0, 3.0], [0.0, 1.0, 0.5]), pre=mode)
    window = make_window(Clip([channel], end=4.0))
    window.session.active, window.session.playhead = channel, time
    window.actions_by_id["key.at_playhead"].run()
    assert len(channel) == 4
    assert ("has become longer" in window.status.message.text()) == longer


def test_only_channels_that_get_a_key_are_counted(make_window: MakeWindow) -> None:
    channels = [Channel(name, make_run([0.0, time], [0.0, 1.0])) for name, time in (("a", 1.0), ("b", 2.0), ("c", 1.0))]
    window = make_window(Clip(channels, end=4.0))
    window.session.playhead = 1.0
    window.actions_by_id["key.at_playhead"].run()
    assert window.undo_stack.undoText() == "Key b at 1 s"


def test_a_key_that_is_there_already_leaves_the_selection_alone(make_window: MakeWindow) -> None:
    channel = Channel("a", make_run([0.0, 1.0], [0.0, 1.0]))
    window = make_window(Clip([channel], end=4.0))
    chosen = window.session.selection = Selection.of({channel: [2]})
    window.session.active, window.session.playhead = channel, 0.0
    window.actions_by_id["curve.insert_key"].run()
    assert window.session.selection == chosen
