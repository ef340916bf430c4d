"""Which times and values a view may show, and the way back."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from widgets.view_range import FARTHEST, ViewHistory, ViewRange, fitted

ANY = st.floats(allow_nan=False, allow_infinity=False)


@given(ANY, ANY, ANY, ANY)
def test_every_view_can_be_drawn(t0: float, t1: float, v0: float, v1: float) -> None:
    view = ViewRange(t0, t1, v0, v1).limited()
    for low, high in (view[:2], view[2:]):
        assert -FARTHEST <= low < high <= FARTHEST
        assert high - low >= 0.99 * max(1e-12, 1e-9 * abs(low / 2 + high / 2))
    assert view.limited() == view


@pytest.mark.parametrize("wrong", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_refused(wrong: float) -> None:
    with pytest.raises(ValueError, match="finite"):
        ViewRange(0.0, wrong, 0.0, 1.0).limited()


def test_zooming_keeps_what_is_under_the_pointer() -> None:
    view = ViewRange(0.0, 10.0, -1.0, 1.0).zoomed(2.0, 4.0, 2.5, 0.5)
    assert view == ViewRange(1.25, 6.25, 0.125, 0.625)


@given(ANY, ANY)
def test_a_level_curve_is_shown_in_the_middle(value: float, time: float) -> None:
    view = fitted(time, time, value, value, (0.05, 0.1))
    assert view.t0 < view.t1
    assert view.v0 < view.v1
    if abs(value) <= FARTHEST / 2 and abs(time) <= FARTHEST / 2:
        assert view.v0 < value < view.v1
        assert view.t0 < time < view.t1


def test_back_and_forward_walk_the_same_way() -> None:
    first, second, third = (ViewRange(0, n, 0, 1) for n in (1, 2, 3))
    history = ViewHistory()
    history.leave(first)
    history.leave(second)
    assert history.back(third) == second
    assert history.back(second) == first
    assert history.back(first) is None
    assert history.forward(first) == second
    assert history.forward(second) == third
    assert history.forward(third) is None


def test_a_new_view_forgets_what_was_ahead() -> None:
    history = ViewHistory()
    history.leave(ViewRange(0, 1, 0, 1))
    history.back(ViewRange(0, 2, 0, 1))
    history.leave(ViewRange(0, 1, 0, 1))
    assert history.forward(ViewRange(0, 3, 0, 1)) is None
