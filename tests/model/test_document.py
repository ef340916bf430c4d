"""Document: only whole, valid edits; exact undo; told once, after all is done."""

from math import inf, nan

import pytest

from model import edits
from model.change import CHANNEL_SETTINGS, CLIP_SETTINGS
from model.channel import Channel
from model.clip import Clip
from model.document import Document, Membership, Setting, Splice, added_keys
from model.extrapolation import Extrapolation
from model.keyframe import make_run
from model.selection import Selection
from tests.model.editing import Record, channel_of, document_of, everything, ids, select, times


def test_undo_and_redo_give_back_every_bit_and_the_ids() -> None:
    channel = channel_of([0.1, 0.7, -0.3, 0.2])
    document = document_of(channel)
    before = everything(document.clip)
    edit = document.do("Delete", lambda clip: edits.delete(clip, select(channel, 2, 3)))
    assert edit is not None
    after = everything(document.clip)
    document.apply(edit.inverse())
    assert everything(document.clip) == before
    document.apply(edit)
    assert everything(document.clip) == after
    document.apply(edit.inverse().inverse().inverse())
    assert everything(document.clip) == before


def test_a_redone_insertion_has_the_id_it_had() -> None:
    channel = channel_of([0.0, 1.0])
    document = document_of(channel)
    edit = document.do("Insert", lambda clip: edits.insert(clip, channel, 0.5))
    assert edit is not None
    inserted = ids(channel)[1]
    document.apply(edit.inverse())
    document.do("Insert another", lambda clip: edits.insert(clip, channel, 0.25))
    assert inserted not in ids(channel)
    document.clip.channel("root.tx")
    document.do("Away", lambda clip: edits.delete(clip, select(channel, ids(channel)[1])))
    document.apply(edit)
    assert ids(channel)[1] == inserted


def test_an_error_in_the_middle_of_an_edit_changes_nothing_and_records_nothing() -> None:
    channel = channel_of([0.0, 1.0, 0.0])
    other = channel_of([5.0, 6.0], "root.ty")
    document = document_of(channel, other)
    record = Record(document)
    before = everything(document.clip)

    def failing(clip: Clip) -> list[Splice | Setting | Membership]:
        run = other.run()
        wrong = run.copy()
        wrong["value"][1] = nan
        return [
            *edits.delete(clip, select(channel, 2)),
            Setting(channel, "locked", False, True),
            Membership((channel, other), (other, channel)),
            Setting(clip, "end", 0.0, 5.0),
            Splice(other, run, wrong),
        ]

    with pytest.raises(ValueError, match="key 1: value is nan"):
        document.do("Fails", failing)
    assert everything(document.clip) == before
    assert not record.edits
    assert not record.taken()
    assert document.gesture is None


@pytest.mark.parametrize("fails_at", range(4))
def test_a_compute_that_raises_changes_nothing(fails_at: int) -> None:
    channel = channel_of([0.0, 1.0, 0.0])
    document = document_of(channel)
    before = everything(document.clip)

    def compute(clip: Clip):  # type: ignore[no-untyped-def]
        for i, change in enumerate([*edits.insert(clip, channel, 0.5), *edits.insert(clip, channel, 1.5)] * 2):
            if i == fails_at:
                raise ZeroDivisionError
            yield change

    with pytest.raises((ZeroDivisionError, ValueError)):
        document.do("Fails", compute)
    assert everything(document.clip) == before


def test_a_change_in_place_is_told_as_the_interval_its_rules_reach() -> None:
    channel = channel_of([0.0, 1.0, 2.0, 0.0, 1.0, 5.0, 1.0, 0.0, 3.0])
    document = document_of(channel)
    record = Record(document)
    document.do("Raise", lambda clip: edits.move(clip, select(channel, 5), 0.0, 1.0))
    assert record.taken() == [("changed", "root.tx", 2.0, 6.0)]


def test_the_way_back_is_told_as_widely_as_the_way_there() -> None:
    channel = channel_of([0.0, 1.0, 2.0, 0.0, 1.0])
    document = document_of(channel)
    record = Record(document)
    gesture = document.begin("Move")
    gesture.preview(lambda clip: edits.move(clip, select(channel, 5), 10.0, 0.0))
    record.taken()
    gesture.preview(lambda clip: edits.move(clip, select(channel, 1), -0.5, 0.0))
    _, _, t0, t1 = record.taken()[0]
    assert t0 <= -0.5
    assert t1 >= 14.0


def test_listeners_find_the_clip_and_the_selection_as_they_will_stay() -> None:
    channel = channel_of([0.0, 1.0, 2.0])
    document = document_of(channel)
    document.session.selection = select(channel, 2)
    seen = []
    document.changed.connect(lambda c, t0, t1: seen.append((len(channel), document.session.selection.count)))
    document.do("Delete", lambda clip: edits.delete(clip, select(channel, 2)))
    assert seen == [(2, 0)]


def test_undo_selects_what_was_selected_before_and_redo_what_was_after() -> None:
    channel = channel_of([0.0, 1.0, 2.0])
    document = document_of(channel)
    document.session.selection = select(channel, 1, 2)
    edit = document.do("Insert", lambda clip: edits.insert(clip, channel, 0.5), selection=added_keys)
    assert edit is not None
    after = document.session.selection
    assert after.count == 1
    assert not after.contains(channel, 1)
    document.session.selection = Selection.NONE
    document.apply(edit.inverse())
    assert document.session.selection == select(channel, 1, 2)
    document.apply(edit)
    assert document.session.selection == after


def test_undo_moves_neither_the_playhead_nor_what_is_shown() -> None:
    channel = channel_of([0.0, 1.0, 2.0])
    document = document_of(channel)
    edit = document.do("Delete", lambda clip: edits.delete(clip, select(channel, 2)))
    assert edit is not None
    document.session.playhead = 1.5
    document.session.hidden = {channel}
    document.apply(edit.inverse())
    assert document.session.playhead == 1.5
    assert document.session.hidden == {channel}


def test_undoing_a_deletion_selects_the_keys_again() -> None:
    channel = channel_of([0.0, 1.0, 2.0])
    document = document_of(channel)
    document.session.selection = select(channel, 2)
    edit = document.do("Delete", lambda clip: edits.delete(clip, document.session.selection))
    assert edit is not None
    assert document.session.selection == Selection.NONE
    document.apply(edit.inverse())
    assert document.session.selection == select(channel, 2)


def test_undo_selects_only_keys_that_are_shown() -> None:
    channel, other = channel_of([0.0, 1.0]), channel_of([0.0, 1.0], "root.ty")
    document = document_of(channel, other)
    document.session.selection = both = select(channel, 2).union(select(other, 2))
    edit = document.do("Delete", lambda clip: edits.delete(clip, both))
    assert edit is not None
    document.session.solo = {other}
    document.apply(edit.inverse())
    assert len(channel) == 2
    assert document.session.selection == select(other, 2)


def test_undo_brings_back_the_active_channel() -> None:
    channel, other = channel_of([0.0]), channel_of([0.0], "root.ty")
    document = document_of(channel, other)
    document.session.active = other
    edit = document.do("Remove", lambda clip: [Membership((channel, other), (channel,))])
    assert edit is not None
    assert document.session.active is None
    document.apply(edit.inverse())
    assert document.session.active is other


def test_removing_a_channel_takes_it_out_of_the_session() -> None:
    channel, other, unseen = (channel_of([0.0, 1.0], name) for name in ("root.tx", "root.ty", "root.tz"))
    document = document_of(channel, other, unseen)
    session = document.session
    session.selection = select(channel, 1).union(select(other, 1))
    session.hidden = {unseen}
    edit = document.do("Remove", lambda clip: [Membership((channel, other, unseen), (other,))])
    assert edit is not None
    assert session.selection == select(other, 1)
    assert session.hidden == set()
    document.apply(edit.inverse())
    assert session.selection.contains(channel, 1)
    assert document.clip.channels == [channel, other, unseen]


def test_replacing_the_clip_forgets_the_old_channels_and_cancels_what_goes_on() -> None:
    channel = channel_of([0.0, 1.0])
    document = document_of(channel)
    document.session.selection, document.session.active = select(channel, 1), channel
    gesture = document.begin("Move")
    gesture.preview(lambda clip: edits.move(clip, select(channel, 1), 0.5, 0.0))
    record = Record(document)
    new = Clip([channel_of([1.0])])
    document.replace(new)
    assert document.clip is new
    assert times(channel) == [0.0, 1.0]
    assert document.session.selection == Selection.NONE
    assert document.session.active is None
    assert ("replaced",) in record.taken()
    assert not gesture.open


def test_only_one_gesture_at_a_time_and_no_undo_in_one() -> None:
    channel = channel_of([0.0, 1.0])
    document = document_of(channel)
    edit = document.do("Raise", lambda clip: edits.move(clip, select(channel, 1), 0.0, 1.0))
    assert edit is not None
    with document.begin("Drag"):
        with pytest.raises(RuntimeError, match="'Drag' is still going on"):
            document.begin("Another")
        with pytest.raises(RuntimeError, match="'Drag' is still going on"):
            document.apply(edit.inverse())


def test_a_listener_cannot_change_the_document_in_the_middle_of_a_change() -> None:
    channel = channel_of([0.0, 1.0])
    document = document_of(channel)

    def compute(clip: Clip) -> list[Splice]:
        with pytest.raises(RuntimeError, match="still going on"):
            document.do("Inner", lambda clip: [])
        return []

    document.do("Outer", compute)


def test_an_edit_that_changes_nothing_is_no_edit() -> None:
    channel = channel_of([0.0, 1.0])
    document = document_of(channel)
    record = Record(document)
    assert document.do("Nothing", lambda clip: []) is None
    assert document.do("Nothing", lambda clip: edits.move(clip, select(channel, 1), 0.0, 0.0)) is None
    assert document.do("Nothing", lambda clip: [Setting(channel, "unit", "", "")]) is None
    assert document.do("Nothing", lambda clip: [Membership((channel,), (channel,))]) is None
    assert document.do("Nothing", lambda clip: [Splice(channel, channel.run(), channel.run())]) is None
    away, back = channel.keys_of([1]), channel.run()[:0]
    assert document.do("Out and in", lambda clip: [Splice(channel, away, back), Splice(channel, back, away)]) is None
    assert not record.edits


def test_every_setting_can_be_set_and_undone() -> None:
    new = {"name": "head.rx", "unit": "angle", "color": "#AA0011", "locked": True, "pre": 2, "post": 3}
    new |= {"start": -1.0, "end": 9.0, "frame_rate": 24.0, "title": "Walk"}
    assert set(new) == set(CHANNEL_SETTINGS) | set(CLIP_SETTINGS)
    channel = channel_of([0.0, 1.0])
    document = document_of(channel)
    for field, value in new.items():
        target = channel if field in CHANNEL_SETTINGS else document.clip
        before = everything(document.clip)
        record = Record(document)
        edit = document.do("Set", lambda clip, t=target, f=field, v=value: edits.set_setting(clip, [t], f, v))  # type: ignore[misc]
        assert edit is not None
        assert ("setting", field) in record.taken()
        assert getattr(target, field) == (value.lower() if field == "color" else value)
        document.apply(edit.inverse())
        assert everything(document.clip) == before
        document.apply(edit)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("name", ""),
        ("name", "  "),
        ("name", "root.ty"),
        ("name", "a\nb"),
        ("name", "x" * 2000),
        ("name", None),
        ("unit", "\t"),
        ("color", "red"),
        ("color", "#12345"),
        ("color", "#12345g"),
        ("locked", 2),
        ("pre", 17),
        ("ids", 1),
        ("start", nan),
        ("start", 2.0),
        ("end", -1.0),
        ("end", inf),
        ("frame_rate", 0.0),
        ("frame_rate", inf),
        ("title", 3),
        ("channels", []),
    ],
)
def test_a_setting_that_makes_no_sense_is_refused(field: str, value: object) -> None:
    channel = channel_of([0.0, 1.0])
    document = document_of(channel, channel_of([0.0], "root.ty"))
    document.clip.end = 1.0
    before = everything(document.clip)
    target = document.clip if field in CLIP_SETTINGS or field == "channels" else channel
    with pytest.raises(ValueError, match=r"\w"):
        document.do("Set", lambda clip: edits.set_setting(clip, [target], field, value))
    assert everything(document.clip) == before


def test_two_names_can_be_exchanged_in_one_edit() -> None:
    channel, other = channel_of([0.0], "a"), channel_of([0.0], "b")
    document = document_of(channel, other)
    document.do("Swap", lambda clip: [Setting(channel, "name", "a", "b"), Setting(other, "name", "b", "a")])
    assert [c.name for c in document.clip.channels] == ["b", "a"]


def test_what_a_file_holds_against_the_rules_can_be_mended_and_the_mending_undone() -> None:
    channel = Channel("", make_run([0.0], 1.0), color="Red")
    document = Document(Clip([channel], start=5.0, end=1.0))
    for target, field, value in ((channel, "name", "x"), (channel, "color", None), (document.clip, "end", 6.0)):
        before = everything(document.clip)
        gesture = document.begin("Mend")
        gesture.preview(lambda clip, t=target, f=field, v=value: edits.set_setting(clip, [t], f, v))  # type: ignore[misc]
        gesture.cancel()
        assert everything(document.clip) == before
        edit = document.do("Mend", lambda clip, t=target, f=field, v=value: edits.set_setting(clip, [t], f, v))  # type: ignore[misc]
        assert edit is not None
        document.apply(edit.inverse())
        assert everything(document.clip) == before
        document.apply(edit)


def test_a_channel_cannot_be_added_twice_nor_under_a_name_that_is_taken() -> None:
    channel = channel_of([0.0])
    document = document_of(channel)
    with pytest.raises(ValueError, match="twice"):
        document.do("Add", lambda clip: [Membership((channel,), (channel, channel))])
    with pytest.raises(ValueError, match=r"already is a channel 'root\.tx'"):
        document.do("Add", lambda clip: [Membership((channel,), (channel, channel_of([])))])
    with pytest.raises(ValueError, match="not those"):
        document.do("Add", lambda clip: [Membership((), (channel,))])
    assert document.clip.channels == [channel]


def test_a_change_of_extrapolation_is_told_on_its_side_only() -> None:
    channel = channel_of([0.0, 1.0, 3.0])
    document = document_of(channel)
    record = Record(document)
    document.do("Cycle", lambda clip: edits.set_extrapolation(clip, [channel], post=Extrapolation.CYCLE))
    assert record.taken() == [("setting", "post"), ("changed", "root.tx", 2.0, inf)]
    document.do("Line", lambda clip: edits.set_extrapolation(clip, [channel], pre=Extrapolation.LINEAR))
    assert record.taken() == [("setting", "pre"), ("changed", "root.tx", -inf, 0.0)]
    assert (channel.pre, channel.post) == (Extrapolation.LINEAR, Extrapolation.CYCLE)


def test_a_listener_that_fails_does_not_keep_the_others_from_hearing() -> None:
    channel, other = channel_of([0.0]), channel_of([0.0], "root.ty")
    document = document_of(channel, other)
    heard = []

    def fails(*_: object) -> None:
        raise ZeroDivisionError

    document.changed.connect(fails)
    document.changed.connect(lambda c, t0, t1: heard.append(c.name))
    gesture = document.begin("Raise")
    both = select(channel, 1).union(select(other, 1))
    with pytest.raises(ZeroDivisionError):
        gesture.preview(lambda clip: edits.move(clip, both, 0.0, 1.0))
    assert heard == ["root.tx", "root.ty"]
