"""What a drag of very many keys begins with, got ready before its first step, leaves its outcome alone."""

import pytest

from model import edits
from model.change import Shift, unshifted
from model.clip import Clip
from model.document import Document
from model.selection import Selection
from tests.model.editing import everything
from tests.model.test_shifting import Step, all_bytes, channel_of, is_what_the_splice_makes, moved, scaled, short_rows

__all__ = ["short_rows"]


@pytest.mark.usefixtures("short_rows")
@pytest.mark.parametrize(
    "step", [moved(0.5, -0.0, True), moved(0.0, 2.0, True), scaled(2.0, 0.0, -1.0, 1.0), scaled(2.0, 0.0, 1.5, 1.0)]
)
def test_the_first_step_of_a_drag_that_has_got_ready_is_what_the_splice_makes(step: Step) -> None:
    channel, twin = (channel_of(5, 60, 2, 1.0) for _ in range(2))
    document, chosen = Document(Clip([channel])), Selection.of_all([channel])
    gesture = document.begin("Drag")
    opening = all_bytes(channel)
    assert len(list(gesture.prepared(chosen))) > 8
    assert all_bytes(channel) == opening
    keys = channel.keys_of(chosen.ids(channel))
    assert channel.keys_of(chosen.ids(channel)) is keys
    gesture.preview(lambda clip: step(clip, chosen))
    assert [type(change) for change in gesture._put] == [Shift]
    is_what_the_splice_makes(gesture, channel, twin)
    shown = everything(document.clip)
    edit = gesture.commit()
    assert edit is not None
    assert everything(document.clip) == shown
    for sides, bytes_ in ((edit.inverse(), opening), (edit, None), (edit.inverse(), opening)):
        document.apply(sides)
        assert all_bytes(channel) == bytes_ if bytes_ is not None else everything(document.clip) == shown


def test_the_first_step_of_a_drag_of_some_keys_of_many_channels_is_what_splices_make() -> None:
    channels, twins = ([channel_of(seed, 60, 2, 1.0) for seed in range(5)] for _ in range(2))
    chosen = [Selection.of({each: each.run()["id"][::2] for each in some}) for some in (channels, twins)]
    gestures = [Document(Clip(some)).begin("Drag") for some in (channels, twins)]
    assert len(list(gestures[0].prepared(chosen[0]))) == 2 * len(channels)
    for d_time in (0.375, 40.0):
        gestures[0].preview(lambda clip, d=d_time: edits.move(clip, chosen[0], d, 1.0))
        gestures[1].preview(lambda clip, d=d_time: unshifted(edits.move(clip, chosen[1], d, 1.0)))
        assert list(map(all_bytes, channels)) == list(map(all_bytes, twins))
