"""What must always hold of the keys of a channel: their list, and all that follows from their rules."""

import numpy as np

from model import hermite
from model.keyframe import TangentRule
from model.rows import D_TIME, SLOPE_IN, SLOPE_OUT, TIME, A, C, Rows
from model.splicing import IN_RULES, OUT_RULES
from model.tangents import slopes_of


def check(rows: Rows, next_id: int) -> None:
    """Assert that all numbers are finite, and that slopes and coefficients are those that follow from the rules."""
    _check_rows(rows)
    numbers = rows.columns(0, rows.size)
    assert np.isfinite(numbers[: SLOPE_OUT + 1]).all(), "a number is not finite"
    assert (numbers[D_TIME] > 0.0).all()
    rules_in, rules_out = rows.rules(0, rows.size)
    assert IN_RULES[rules_in].all(), "no such rule in"
    assert OUT_RULES[rules_out].all(), "no such rule out"
    assert rows.size == 0 or int(rows.ids.max()) < next_id, "an id will be handed out twice"
    t, v, slope_in, slope_out = numbers[: SLOPE_OUT + 1]
    again = np.array(slopes_of(t, v, slope_in, slope_out, rules_in, rules_out))
    assert again.tobytes() == numbers[SLOPE_IN : SLOPE_OUT + 1].tobytes(), "a slope is not what its rule says"
    if rows.size:
        with np.errstate(all="ignore"):
            d_time = np.append(np.diff(t), 1.0)
            spans = hermite.coefficients(d_time[:-1], v[:-1], v[1:], slope_out[:-1], slope_in[1:])
        expected = np.zeros((3, rows.size))
        expected[:, :-1] = spans
        expected[:, rules_out == TangentRule.STEP] = 0.0
        assert d_time.tobytes() == numbers[D_TIME].tobytes(), "a span does not know its length"
        assert expected.tobytes() == numbers[A : C + 1].tobytes(), "coefficients are not those of the slopes"


def _check_rows(rows: Rows) -> None:
    """Assert order, counts, links of keys to rows both ways, unique ids, and what the spare slots repeat."""
    assert rows.first[0] == 0
    assert rows.first[-1] == rows.size
    assert len(rows.first) == rows.rows + 1 == len(rows.starts) + 1
    held = np.diff(rows.first)
    assert rows.size == 0 or (held.min() > 0 and held.max() <= rows.width)
    slots = rows.slots(np.arange(rows.size))
    assert (np.diff(rows.times[slots]) > 0.0).all(), "times are not in order"
    ids = rows.ids[slots]
    assert len(np.unique(ids)) == rows.size, "two keys have one id"
    assert (ids > 0).all()
    assert np.array_equal(rows.row_of[ids], slots // rows.width), "a key does not know its row"
    assert int((rows.row_of >= 0).sum()) == rows.size, "a deleted key still has a row"
    if rows.size:
        real = rows.real(np.arange(len(rows.ids)))
        for columns in (rows.numbers, rows.marks, rows.ids[None]):
            same = columns.tobytes() == columns[:, real].tobytes()
            assert same, "a spare slot does not repeat its row's last key"
        assert rows.starts == rows.number_grid[TIME, :, 0].tolist()
