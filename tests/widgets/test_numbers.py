"""Numbers read well where they are shown, and exactly where they are edited."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from widgets.numbers import exact, factor_of, frame_text, shown, steady, suffix_of


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (0.0, "0"),
        (-0.0, "0"),
        (1.0, "1"),
        (1 / 3, "0.333333"),
        (-1234.5678, "-1234.57"),
        (0.00012345678, "0.000123457"),
        (0.000012, "0.000012"),
        (12345678.9, "12345700"),
        (1e-7, "1e-07"),
        (1e300, "1e+300"),
    ],
)
def test_a_number_at_rest_has_six_digits_and_no_needless_exponent(number, text):
    shown_text = shown(number)
    assert shown_text == text or float(shown_text) == pytest.approx(number, rel=1e-5)
    assert ("e" in shown_text) == ("e" in text)


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (0.0, "0.000"),
        (-0.0, "0.000"),
        (1.5, "1.500"),
        (-99.9, "-99.900"),
        (286.4789, "286.48"),
        (-1e-5, "-1.0e-05"),
        (12345.678, "12345.7"),
    ],
)
def test_a_number_that_changes_keeps_its_width(number, text):
    assert steady(number) == text


@given(st.floats(-1e307, 1e307))
def test_a_changing_number_never_takes_more_than_nine_characters(number):
    assert len(steady(number)) <= 9


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_what_is_edited_is_read_back_bit_for_bit(number):
    assert float(exact(number)) == number


@pytest.mark.parametrize(("frame", "text"), [(24.0, "24"), (9.99999, "10"), (12.5, "12.50"), (-3.0, "-3")])
def test_frames_have_decimals_only_where_they_are_not_whole(frame, text):
    assert frame_text(frame) == text


def test_a_frame_too_far_to_count_is_still_shown():
    assert frame_text(1.7976931348623157e308) == "1.79769e+308"
    assert frame_text(-4e15) == "-4e+15"


def test_angles_are_degrees_and_other_units_stand_behind_the_number():
    assert factor_of("angle") * math.pi == 180.0
    assert (factor_of("m"), suffix_of("m"), suffix_of("angle"), suffix_of("")) == (1.0, " m", "°", "")
