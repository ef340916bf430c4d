"""Runs of keys made from columns."""

import numpy as np
import pytest

from model.keyframe import KEY_DTYPE, TangentRule, make_run


def test_columns_and_numbers_for_all_make_a_run() -> None:
    run = make_run([1, 2, 3], 5.0, [0, 1, 2], 7.0, TangentRule.FLAT, [0, 1, 4], [True, False, True], [4, 5, 6])
    assert run.dtype == KEY_DTYPE
    assert run.tolist() == [
        (1.0, 5.0, 0.0, 7.0, 0, 0, True, 4),
        (2.0, 5.0, 1.0, 7.0, 0, 1, False, 5),
        (3.0, 5.0, 2.0, 7.0, 0, 4, True, 6),
    ]


def test_keys_are_smooth_unified_and_without_id_unless_told() -> None:
    assert make_run([1.5]).tolist() == [(1.5, 0.0, 0.0, 0.0, 2, 2, False, 0)]
    assert len(make_run()) == 0


def test_columns_of_different_lengths_make_no_run() -> None:
    with pytest.raises(ValueError, match="broadcast"):
        make_run([1, 2, 3], [1, 2])


def test_a_run_keeps_every_bit() -> None:
    numbers = np.array([-0.0, 5e-324, 0.1, 1.7976931348623157e308])
    run = make_run(numbers, numbers, numbers, numbers)
    for field in ("time", "value", "slope_in", "slope_out"):
        assert run[field].tobytes() == numbers.tobytes()
