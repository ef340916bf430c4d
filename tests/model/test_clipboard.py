"""Copy, paste, duplicate: text that carries everything a key is, to where it belongs; bad text is refused."""

import time as clock
from math import pi

import numpy as np
import pytest

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.clipboard import HEADER, MOST_KEYS, keys_from_text, text_from_keys
from model.document import added_keys
from model.keyframe import TangentRule, make_run
from model.selection import Selection
from tests.model.editing import channel_of, document_of, everything, ids, select, times, values

LINE = "root.tx\t0.5\t1.0\t0.0\t0.0\tsmooth\tsmooth\tunified"


def text_of(*lines: str) -> str:
    return "\n".join([HEADER, *lines]) + "\n"


def test_keys_come_back_bit_for_bit_with_their_rules_and_slopes() -> None:
    run = make_run(
        [-1e-300, 0.1, 1 / 3, 1e9],
        [pi, -0.0, 5e-324, 1.7e308],
        [0.1, 0.2, 0.3, 0.4],
        [1e-9, -2.0, 0.7, 0.0],
        [TangentRule.FIXED, TangentRule.SMOOTH, TangentRule.AUTO, TangentRule.LINEAR],
        [TangentRule.STEP, TangentRule.FIXED, TangentRule.FLAT, TangentRule.LINEAR],
        [True, False, True, False],
    )
    source, target = Channel("a\tb\\c\nd", run), Channel("a\tb\\c\nd")
    text = text_from_keys(Selection.of_all([source]))
    document = document_of(target)
    document.do("Paste", lambda clip: edits.paste(clip, text, None))
    for field in ("time", "value", "slope_in", "slope_out", "rule_in", "rule_out", "broken"):
        assert target.run()[field].tobytes() == source.run()[field].tobytes(), field


def test_pasted_keys_begin_at_the_playhead_and_are_selected() -> None:
    channel = channel_of([0.0, 1.0, 2.0, 3.0])
    text = text_from_keys(select(channel, 2, 3))
    document = document_of(channel)
    document.do("Paste", lambda clip: edits.paste(clip, text, 2.5), selection=added_keys)
    assert times(channel) == [0.0, 1.0, 2.0, 2.5, 3.0, 3.5]
    assert values(channel) == [0.0, 1.0, 2.0, 1.0, 3.0, 2.0]
    assert document.session.selection.count == 2
    assert [channel.key(i).time for i in document.session.selection.ids(channel).tolist()] == [2.5, 3.5]


def test_pasted_keys_replace_those_at_their_times_or_all_in_between() -> None:
    channel = channel_of([0.0, 1.0, 2.0, 3.0, 4.0])
    text = text_from_keys(select(channel, 1, 3))
    document = document_of(channel)
    edit = document.do("Paste", lambda clip: edits.paste(clip, text, 2.0))
    assert edit is not None
    assert values(channel) == [0.0, 1.0, 0.0, 3.0, 2.0]
    document.apply(edit.inverse())
    document.do("Paste", lambda clip: edits.paste(clip, text, 2.0, replace=True))
    assert values(channel) == [0.0, 1.0, 0.0, 2.0]


def test_keys_go_to_the_channels_of_their_names_whatever_is_active() -> None:
    source = [channel_of([1.0], "root.tx"), channel_of([2.0], "root.ty")]
    text = text_from_keys(Selection.of_all(source))
    target = [Channel("head.rx"), Channel("root.ty"), Channel("root.tx")]
    document = document_of(*target)
    document.do("Paste", lambda clip: edits.paste(clip, text, 0.0, active=target[0]))
    assert [values(channel) for channel in target] == [[], [2.0], [1.0]]


def test_keys_of_unknown_names_go_in_order_from_the_active_channel_on() -> None:
    source = [channel_of([1.0], "a"), channel_of([2.0], "b")]
    text = text_from_keys(Selection.of_all(source))
    target = [Channel("x"), Channel("y"), Channel("z")]
    document_of(*target).do("Paste", lambda clip: edits.paste(clip, text, 0.0, active=target[1]))
    assert [values(channel) for channel in target] == [[], [1.0], [2.0]]


def test_keys_of_one_channel_can_be_sent_to_the_active_one() -> None:
    source, other = channel_of([1.0, 2.0]), Channel("root.ty")
    text = text_from_keys(Selection.of_all([source]))
    document_of(source, other).do("Paste", lambda clip: edits.paste(clip, text, 0.0, active=other, onto_active=True))
    assert values(other) == [1.0, 2.0]


def test_locked_channels_are_not_pasted_to() -> None:
    locked = channel_of([1.0, 2.0], locked=True)
    text = text_from_keys(Selection.of_all([locked]))
    with pytest.raises(ValueError, match="no unlocked channel to paste to"):
        edits.paste(Clip([locked]), text, 5.0)
    with pytest.raises(ValueError, match="no unlocked channel to paste to"):
        edits.paste(Clip(), text, 5.0)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "holds no keys"),
        ("hello", "holds no keys"),
        (HEADER, "holds no keys"),
        ("hermite-keys 17\n" + LINE, "another version"),
        (text_of("root.tx\t0.5"), "line 2 .*expected channel, time"),
        (text_of("", LINE.replace("0.5", "nan")), "line 3 .*'nan' is not a number"),
        (text_of(LINE.replace("0.5", "inf")), "'inf' is not a number"),
        (text_of(LINE.replace("0.5", "1e999")), "1e999 is too large"),
        (text_of(LINE.replace("0.5", "1_0")), "'1_0' is not a number"),
        (text_of(LINE.replace("0.5", "")), "'' is not a number"),
        (text_of(LINE.replace("0.5", "١٢")), "is not a number"),
        (text_of(LINE.replace("0.5", "1-2")), "could not convert|not a number"),
        (text_of(LINE.replace("smooth\tsmooth", "step\tsmooth")), "step is a rule of the side out"),
        (text_of(LINE.replace("smooth", "wobbly")), "unknown tangent rule 'wobbly'"),
        (text_of(LINE.replace("unified", "maybe")), "expected unified or broken"),
        (text_of(LINE, LINE), "two keys of root.tx at 0.5 s"),
        (text_of("x" * 100_000), "expected channel, time"),
        (text_of(*[LINE] * (MOST_KEYS + 1)), "at most 200,000 keys"),
        (HEADER + "\n" * 1_000_000, "at most 200,000 keys"),
        (HEADER + "\x00" * 100_000_000, "at most 200,000 keys"),
    ],
)
def test_bad_text_is_refused_in_one_sentence_and_soon(text: str, message: str) -> None:
    begin = clock.process_time()
    with pytest.raises(ValueError, match=message) as refusal:
        keys_from_text(text)
    assert clock.process_time() - begin < 1.0
    assert len(str(refusal.value)) < 250
    assert "\n" not in str(refusal.value)


def test_text_from_other_systems_is_read() -> None:
    copied = keys_from_text(text_of(LINE).replace("\n", "\r\n"))
    assert copied.key_count == 1
    assert copied.start == 0.5


def test_keys_in_any_order_are_sorted() -> None:
    copied = keys_from_text(text_of(LINE, LINE.replace("0.5", "-1")))
    assert copied.runs["root.tx"]["time"].tolist() == [-1.0, 0.5]


def test_more_keys_than_the_clipboard_takes_are_not_copied() -> None:
    channel = Channel("x", make_run(np.arange(MOST_KEYS + 1.0), 0.0))
    with pytest.raises(ValueError, match="200,001 keys are too many"):
        text_from_keys(Selection.of_all([channel]))


def test_duplicates_are_new_keys_that_replace_what_they_land_on() -> None:
    channel = channel_of([0.0, 1.0, 2.0, 3.0])
    document = document_of(channel)
    before = everything(document.clip)
    edit = document.do("Duplicate", lambda clip: edits.duplicate(clip, select(channel, 1, 2), 1.5, 1.0))
    assert edit is not None
    assert times(channel) == [0.0, 1.0, 1.5, 2.0, 2.5, 3.0]
    document.do("Duplicate", lambda clip: edits.duplicate(clip, select(channel, 1, 2), 1.0))
    assert values(channel) == [0.0, 0.0, 1.0, 1.0, 2.0, 3.0]
    assert not {2, 3} & set(ids(channel))
    assert edits.duplicate(document.clip, select(channel, 1), 0.0) == []
    document.apply(document.do("x", lambda clip: edits.delete(clip, select(channel, 1))).inverse())  # type: ignore[union-attr]
    assert before != everything(document.clip)


def test_as_many_keys_as_the_clipboard_takes_are_read_soon() -> None:
    channel = Channel("x", make_run(np.arange(float(MOST_KEYS)), 0.1))
    text = text_from_keys(Selection.of_all([channel]))
    begin = clock.process_time()
    assert keys_from_text(text).key_count == MOST_KEYS
    assert clock.process_time() - begin < 3.0
