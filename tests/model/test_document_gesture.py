"""Gesture: previews from the start, one edit or nothing, covered keys that come back."""

from collections.abc import Callable

import pytest

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.clipboard import text_from_keys
from model.document import Change, Splice, added_keys
from model.keyframe import TangentRule, make_run
from model.selection import Selection
from tests.model.editing import Record, channel_of, document_of, everything, ids, select, times


def test_many_previews_and_a_cancel_are_as_if_nothing_had_been() -> None:
    channel = channel_of([0.1, 0.2, 0.3, 0.4, 0.5])
    document = document_of(channel)
    document.session.selection = select(channel, 2)
    record = Record(document)
    before = everything(document.clip)
    gesture = document.begin("Move")
    for i in range(60):
        gesture.preview(lambda clip, i=i: edits.move(clip, select(channel, 2, 3), 0.1 * i, -0.3 * i))  # type: ignore[misc]
        channel.check()
    gesture.cancel()
    assert everything(document.clip) == before
    assert document.session.selection == select(channel, 2)
    assert not record.edits
    assert document.gesture is None


def test_many_previews_and_a_commit_are_one_edit_from_start_to_end() -> None:
    channel = channel_of([0.1, 0.2, 0.3, 0.4, 0.5])
    document = document_of(channel)
    record = Record(document)
    before = everything(document.clip)
    gesture = document.begin("Move")
    for i in range(60):
        gesture.preview(lambda clip, i=i: edits.move(clip, select(channel, 2), 0.05 * i, 0.3), label=f"Move by {i}")  # type: ignore[misc]
    edit = gesture.commit()
    assert record.edits == [edit]
    assert edit is not None
    assert edit.label == "Move by 59"
    assert times(channel) == [0.0, 2.0, 3.0, 1.0 + 0.05 * 59, 4.0]
    document.apply(edit.inverse())
    assert everything(document.clip) == before


def test_every_preview_starts_from_the_clip_as_it_was() -> None:
    channel = channel_of([0.0, 1.0, 2.0])
    document = document_of(channel)
    start = everything(document.clip)
    seen = []

    def compute(clip: Clip) -> list[Change]:
        seen.append(everything(clip))
        return edits.move(clip, select(channel, 2), 5.0, 1.0)

    with document.begin("Move") as gesture:
        for _ in range(3):
            gesture.preview(compute)
    assert seen == [start] * 3


def test_a_preview_that_fails_leaves_the_one_before_in_place() -> None:
    channel = channel_of([0.0, 1.0, 2.0])
    document = document_of(channel)
    record = Record(document)
    gesture = document.begin("Move")
    gesture.preview(lambda clip: edits.move(clip, select(channel, 2), 0.25, 0.0))
    shown = everything(document.clip)
    record.taken()

    def fails(clip: Clip) -> list[Change]:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        gesture.preview(fails)
    with pytest.raises(ValueError, match="d_value is nan"):
        gesture.preview(lambda clip: edits.move(clip, select(channel, 2), 0.5, float("nan")))
    with pytest.raises(ZeroDivisionError):
        gesture.preview(lambda clip: edits.delete(clip, select(channel, 1)), selection=lambda changes: fails(None))  # type: ignore[arg-type, return-value]
    assert everything(document.clip) == shown
    assert not record.taken()
    edit = gesture.commit()
    assert edit is not None
    assert everything(document.clip) == shown


def test_keys_with_others_between_them_are_no_run_however_often_they_are_asked_for() -> None:
    channel = channel_of([0.0, 1.0, 2.0, 3.0])
    document = document_of(channel)
    apart = select(channel, 1, 3).ids(channel)
    gesture = document.begin("Move")
    gesture.preview(lambda clip: edits.move(clip, select(channel, 2), 0.25, 0.0))
    shown = everything(document.clip)
    for _ in range(2):
        with pytest.raises(ValueError, match="not what the channel holds"):
            gesture.preview(lambda clip: [Splice(channel, channel.keys_of(apart), channel.keys_of(apart))])
        assert everything(document.clip) == shown
    gesture.cancel()
    channel.check()


def test_a_key_that_is_landed_on_dims_and_comes_back_when_the_drag_moves_on() -> None:
    channel = channel_of([0.0, 1.0, 2.0, 3.0])
    document = document_of(channel)
    gesture = document.begin("Move")
    gesture.preview(lambda clip: edits.move(clip, select(channel, 2), 1.0, 0.0))
    assert ids(channel) == [1, 2, 4]
    assert gesture.covered[channel]["id"].tolist() == [3]
    gesture.preview(lambda clip: edits.move(clip, select(channel, 2), 1.5, 0.0))
    assert ids(channel) == [1, 3, 2, 4]
    assert gesture.covered == {}
    assert not gesture.hides_keys
    gesture.preview(lambda clip: edits.move(clip, select(channel, 2), 2.0, 0.0))
    assert ids(channel) == [1, 3, 2]
    assert gesture.covered[channel]["id"].tolist() == [4]
    gesture.commit()


def test_a_new_key_that_lands_on_another_covers_it_though_there_are_as_many_as_before() -> None:
    channel = channel_of([0.0, 1.0, 2.0, 3.0])
    document = document_of(channel)
    gesture = document.begin("Paste")
    landed = make_run([1.0], 5.0)
    gesture.preview(lambda clip: [Splice(channel, channel.keys_between(1.0, 1.0), landed)])
    assert gesture.keys_fewer == 0
    assert gesture.covered[channel]["id"].tolist() == [2]
    gesture.cancel()


def test_undo_brings_a_covered_key_back_with_its_rules_and_slopes() -> None:
    channel = channel_of([0.0, 1.0, 2.0, 3.0])
    document = document_of(channel)
    document.do("Turn", lambda clip: edits.set_slope(clip, channel, 3, "in", 7.0))
    document.do("Step", lambda clip: edits.set_rule(clip, select(channel, 3), TangentRule.STEP))
    before = everything(document.clip)
    edit = document.do("Move", lambda clip: edits.move(clip, select(channel, 1), 2.0, 0.0))
    assert edit is not None
    assert ids(channel) == [2, 1, 4]
    document.apply(edit.inverse())
    assert everything(document.clip) == before
    assert channel.key(3).slope_in == 7.0


def test_a_selected_key_that_a_preview_hides_is_not_selected_meanwhile() -> None:
    channel = channel_of([0.0, 1.0, 2.0])
    document = document_of(channel)
    document.session.selection = select(channel, 1, 2)
    gesture = document.begin("Delete")
    gesture.preview(lambda clip: edits.delete(clip, select(channel, 2)))
    assert document.session.selection == select(channel, 1)
    gesture.preview(lambda clip: edits.delete(clip, select(channel, 3)))
    assert document.session.selection == select(channel, 1, 2)
    gesture.cancel()


def test_a_new_key_has_the_same_id_in_every_preview() -> None:
    channel = channel_of([0.0, 1.0, 2.0])
    document = document_of(channel)
    gesture = document.begin("Duplicate")
    seen = set()
    for d_time in (0.25, 0.5, 1.5, 7.0):
        gesture.preview(
            lambda clip, d=d_time: edits.duplicate(clip, select(channel, 1, 2), d),  # type: ignore[misc]
            selection=added_keys,
        )
        seen.add(tuple(document.session.selection.ids(channel).tolist()))
    assert len(seen) == 1
    gesture.preview(lambda clip: edits.duplicate(clip, select(channel, 1, 2, 3), 0.25), selection=added_keys)
    assert set(seen.pop()) < set(document.session.selection.ids(channel).tolist())
    gesture.commit()
    channel.check()


def test_leaving_a_with_block_by_an_exception_cancels() -> None:
    channel = channel_of([0.0, 1.0])
    document = document_of(channel)
    before = everything(document.clip)

    def move_and_fail() -> None:
        with document.begin("Move") as gesture:
            gesture.preview(lambda clip: edits.move(clip, select(channel, 1), 0.5, 0.0))
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        move_and_fail()
    assert everything(document.clip) == before
    assert document.gesture is None


def test_a_gesture_that_is_over_takes_no_preview() -> None:
    channel = channel_of([0.0, 1.0])
    document = document_of(channel)
    gesture = document.begin("Move")
    gesture.preview(lambda clip: edits.move(clip, select(channel, 1), 0.5, 0.0))
    gesture.commit()
    gesture.cancel()
    assert times(channel) == [0.5, 1.0]
    with pytest.raises(RuntimeError, match="'Move' is over"):
        gesture.preview(lambda clip: [])
    with pytest.raises(RuntimeError, match="'Move' is over"):
        gesture.commit()


def test_a_gesture_tells_when_it_begins_goes_on_and_ends() -> None:
    document = document_of(channel_of([0.0]))
    told = []
    document.gesture_changed.connect(lambda: told.append(document.gesture is not None))
    gesture = document.begin("Move")
    gesture.preview(lambda clip: [])
    gesture.commit()
    assert told == [True, True, False]


def test_cancel_gives_back_the_selection_of_the_start() -> None:
    channel = channel_of([0.0, 1.0])
    document = document_of(channel)
    document.session.selection = select(channel, 1)
    gesture = document.begin("Insert")
    gesture.preview(lambda clip: edits.insert(clip, channel, 0.5), selection=added_keys)
    assert document.session.selection != select(channel, 1)
    gesture.cancel()
    assert document.session.selection == select(channel, 1)


def test_what_is_not_selected_is_not_touched() -> None:
    channel, other = channel_of([0.0, 1.0, 0.5]), channel_of([0.0, 1.0, 0.5], "root.ty")
    document = document_of(channel, other)
    revision, bytes_before = other.revision, other.run().tobytes()
    with document.begin("Move") as gesture:
        gesture.preview(lambda clip: edits.move(clip, select(channel, 1, 2), 0.4, 2.0))
        gesture.preview(lambda clip: edits.scale(clip, Selection.of_all([channel]), 0.0, 0.0, -2.0, 3.0))
    assert other.revision == revision
    assert other.run().tobytes() == bytes_before


@pytest.mark.parametrize(
    ("compute", "replaced"),
    [
        (lambda channel, clip: edits.move(clip, select(channel, 2), 1.0, 0.0), 1),
        (lambda channel, clip: edits.nudge(clip, select(channel, 2), clip.frame_rate * 2.0), 1),
        (lambda channel, clip: edits.scale(clip, select(channel, 2, 3), 1.0, 0.0, 2.0, 1.0), 1),
        (lambda channel, clip: edits.set_columns(clip, select(channel, 1, 2), "time", lambda c, k: [2.0, 4.0]), 2),
        (lambda channel, clip: edits.duplicate(clip, select(channel, 1, 2), 3.0), 2),
        (lambda channel, clip: edits.paste(clip, copied(channel, 2, 5), 0.5, replace=True), 3),
        (lambda channel, clip: edits.paste(clip, copied(channel, 2), 0.5), 0),
        (lambda channel, clip: edits.move(clip, select(channel, 2), 1.5, 0.0), 0),
        (lambda channel, clip: edits.set_columns(clip, select(channel, 1), "value", lambda c, k: 7.0), 0),
        (lambda channel, clip: edits.delete(clip, select(channel, 2, 3)), 0),
    ],
    ids=["move", "nudge", "scale", "typed times", "duplicate", "paste replacing", "paste", "pass", "value", "delete"],
)
def test_an_edit_says_how_many_keys_it_replaced(
    compute: Callable[[Channel, Clip], list[Change]], replaced: int
) -> None:
    channel = channel_of([0.0, 1.0, 2.0, 3.0, 4.0])
    document = document_of(channel)
    edit = document.do("Change it", lambda clip: compute(channel, clip), selection=added_keys)
    assert edit is not None
    words = {0: "Change it", 1: "Change it, replacing 1 key"}
    assert edit.label == words.get(replaced, f"Change it, replacing {replaced} keys")
    assert edit.replaced == replaced


def copied(channel: Channel, *key_ids: int) -> str:
    """The text that copying these keys puts on the clipboard."""
    return text_from_keys(select(channel, *key_ids))
