"""Labels: what Undo says."""

from math import pi

from model.channel import Channel
from model.labels import label_of
from model.selection import Selection
from tests.model.editing import channel_of, document_of, select


def test_a_label_says_how_many_keys_of_what_and_how_far() -> None:
    tx, ty = channel_of([0.0] * 20), channel_of([0.0] * 20, "root.ty")
    assert label_of("Move", select(tx, *range(1, 15)), 0.1) == "Move 14 keys of root.tx by +0.10 s"
    assert label_of("Delete", select(tx, 1, 2).union(select(ty, 1))) == "Delete 3 keys of 2 channels"
    rx = channel_of([0.0] * 5, "head.rx")
    assert label_of("Smooth tangents on", select(rx, 1, 2, 3, 4, 5)) == "Smooth tangents on 5 keys of head.rx"
    assert document_of(tx).label_of("Move", select(tx, 1), -0.5, 2.0) == "Move 1 key of root.tx by -0.50 s and +2.00"


def test_a_label_speaks_in_the_unit_of_the_channels() -> None:
    angle, length = channel_of([0.0], "head.rx", unit="angle"), channel_of([0.0], "root.tx", unit="m")
    assert label_of("Move", select(angle, 1), 0.0, pi / 2) == "Move 1 key of head.rx by +90.00°"
    assert label_of("Move", select(length, 1), 0.0, 1e-6) == "Move 1 key of root.tx by +1e-06 m"
    both = select(angle, 1).union(select(length, 1))
    assert label_of("Move", both, 0.0, 0.25) == "Move 2 keys of 2 channels by +0.25"


def test_long_names_are_cut_in_the_middle() -> None:
    channel = Channel("a" * 500 + ".tx")
    assert len(label_of("Move", Selection.of({channel: [1]}))) < 70
    assert label_of("Move", Selection.of({channel: [1]})).endswith("a.tx")
