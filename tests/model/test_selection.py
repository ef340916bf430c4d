"""Selection: sets of keys that are values."""

import pytest

from model.selection import Selection
from tests.model.editing import channel_of, select

A, B = channel_of([0.0] * 5, "a"), channel_of([0.0] * 5, "b")


def test_order_and_repetition_of_ids_do_not_matter() -> None:
    assert select(A, 3, 1, 3) == select(A, 1, 3)
    assert hash(select(A, 3, 1, 3)) == hash(select(A, 1, 3))
    assert select(A, 3, 1).ids(A).tolist() == [1, 3]
    assert Selection.of({A: [1], B: [2]}) == Selection.of({B: [2], A: [1]})


def test_a_channel_without_keys_is_not_in_it() -> None:
    assert Selection.of({A: [], B: [1]}).channels == (B,)
    assert not Selection.of({A: []})
    assert Selection.of({A: []}) == Selection.NONE
    assert Selection.NONE.count == 0
    assert Selection.NONE.ids(A).tolist() == []


def test_set_operations() -> None:
    one, two = Selection.of({A: [1, 2], B: [1]}), Selection.of({A: [2, 3]})
    assert one.union(two) == Selection.of({A: [1, 2, 3], B: [1]})
    assert one.minus(two) == Selection.of({A: [1], B: [1]})
    assert one.toggled(two) == Selection.of({A: [1, 3], B: [1]})
    assert one.toggled(one) == Selection.NONE
    assert one.with_only([B]) == Selection.of({B: [1]})
    assert (one | two, one - two, one ^ two) == (one.union(two), one.minus(two), one.toggled(two))


def test_membership() -> None:
    selection = select(A, 2, 4)
    assert selection.contains(A, 2)
    assert not selection.contains(A, 3)
    assert not selection.contains(A, 5)
    assert not selection.contains(B, 2)
    assert list(selection.keys()) == [(A, 2), (A, 4)]
    assert Selection.of_all([A]).ids(A).tolist() == [1, 2, 3, 4, 5]


def test_nobody_can_change_the_ids_of_another() -> None:
    selection = select(A, 1)
    with pytest.raises(ValueError, match="read-only"):
        selection.ids(A)[0] = 7


def test_pruning_drops_keys_and_channels_that_are_gone() -> None:
    assert Selection.of({A: [1, 9], B: [1]}).pruned([A]) == select(A, 1)
