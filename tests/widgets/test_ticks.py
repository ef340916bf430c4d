"""Numbers on the rulers: round, apart from each other, never cut, as many as have room, at every zoom."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtGui import QFont, QFontMetricsF
from PySide6.QtWidgets import QApplication

from model.sampling import Window
from widgets.ticks import (
    VALUE_WIDTH,
    degree_step,
    frame_ticks,
    time_ticks,
    value_ticks,
)
from widgets.view_range import ViewRange

CENTERS = st.one_of(st.floats(-1e12, 1e12), st.sampled_from([0.0, 1.0, -1e9]))
SPANS = st.floats(-12, 12).map(lambda power: 10.0**power)


def width(text: str) -> float:
    return 6.5 * len(text)


def limited(center: float, span: float) -> tuple[float, float]:
    view = ViewRange(center - span / 2, center + span / 2, 0, 1).limited()
    return view.t0, view.t1


@given(CENTERS, SPANS)
def test_numbers_of_time_never_touch(center: float, span: float) -> None:
    low, high = limited(center, span)
    ticks = time_ticks(low, high, 1540, 14, width)
    assert len(ticks.major) == len(ticks.labels) <= 60
    assert len(ticks.minor) <= 2000
    x = (ticks.major - low) / (high - low) * 1540
    for left, right, a, b in zip(x, x[1:], ticks.labels, ticks.labels[1:], strict=False):
        assert right - left >= width(a) / 2 + width(b) / 2 + 10
    assert len(set(ticks.labels)) == len(ticks.labels)


@given(CENTERS, SPANS, st.booleans())
def test_numbers_of_value_fit_their_ruler_and_tell_lines_apart(center: float, span: float, degrees: bool) -> None:
    low, high = limited(center, span)
    room = VALUE_WIDTH - 12
    ticks = value_ticks(low, high, 860, 44, lambda text: width(text) <= room, degrees=degrees)
    assert 1 <= len(ticks.major) <= 30
    assert len(ticks.minor) <= 2000
    assert len(set(ticks.labels)) == len(ticks.labels)
    assert all(width(label) <= room + 7 for label in ticks.labels)
    assert (np.diff(ticks.major) > 0).all()


def test_a_long_number_is_split_into_an_offset_and_a_rest() -> None:
    ticks = value_ticks(1e6, 1e6 + 1e-3, 860, 44, lambda text: width(text) <= 48, degrees=False)
    assert ticks.offset == "+ 1000000.0000"
    assert ticks.labels[1] == "0.0001"


def test_degrees_are_told_in_parts_of_a_turn() -> None:
    assert [degree_step(least) for least in (0.3, 7, 11, 20, 40, 50, 100, 300)] == [0.5, 10, 15, 30, 45, 90, 180, 360]


def test_frames_are_numbered_where_they_have_room() -> None:
    assert frame_ticks(0.0, 1.0, 24.0, 1540, 44).tolist() == list(range(25))
    assert frame_ticks(0.0, 10.0, 24.0, 1540, 44)[:3].tolist() == [0, 10, 20]


@given(st.floats(-1e6, 1e6), st.floats(-1, 9), st.sampled_from([24.0, 29.97, 30.0, 60.0]))
def test_frames_are_numbered_at_every_zoom_that_shows_two_of_them(center: float, power: float, rate: float) -> None:
    low, high = limited(center, 10.0**power)
    frames = frame_ticks(low, high, rate, 1540, 90)
    assert len(frames) >= min(2, int((high - low) * rate))
    assert (np.diff(frames) * 1540 / (high - low) / rate >= 89.9).all()


def test_minus_is_a_minus_and_zero_has_none() -> None:
    ticks = value_ticks(-1.0, 1.0, 860, 44, lambda _: True, degrees=False)
    assert "−0.4" in ticks.labels
    assert "0.0" in ticks.labels
    assert not any("-" in label for label in ticks.labels)


@pytest.mark.parametrize("ratio", [1.0, 2.0])
def test_angles_stored_in_radians_are_ticked_in_degrees(qapp: QApplication, ratio: float) -> None:
    from widgets.ticks import ticks_of

    window = Window(60 * ratio, 40 * ratio, 1540 * ratio, 860 * ratio, 0, 1, -3.2, 3.2, ratio)
    font = QFont()
    font.setPixelSize(int(11 * ratio))
    ticks = ticks_of(window, QFontMetricsF(font).horizontalAdvance, degrees=True)[1]
    assert "90°" in ticks.labels
    assert ticks.major[ticks.labels.index("90°")] == pytest.approx(np.pi / 2)


@pytest.mark.parametrize("rate", [5e-324, 1e-310, 1e-306, 1e306])
def test_a_rate_that_numbers_no_frame_in_view_is_no_error(rate):
    assert len(frame_ticks(0.0, 1.0, rate, 800.0, 40.0)) <= 1
