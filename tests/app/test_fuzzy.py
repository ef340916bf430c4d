"""What the command palette finds first."""

import pytest

from app.fuzzy import fitness


def test_nothing_typed_fits_everything_and_wrong_letters_nothing() -> None:
    assert fitness("", "Save As") > 0
    assert fitness("q", "Save As") == 0
    assert fitness("save q", "Save As") == 0


@pytest.mark.parametrize(
    ("query", "better", "worse"),
    [
        ("save", "Save As", "Unsaved"),
        ("sm", "Smooth", "Select Menu"),
        ("copy", "Copy", "Copy of Everything"),
        ("sa", "Save", "Select All"),
        ("play", "Play / Stop", "Display"),
        ("key", "Next Key", "Keyboard"),
        ("extrap", "Extrapolations", "Next Frame Play"),
    ],
)
def test_beginnings_of_words_and_short_names_come_first(query: str, better: str, worse: str) -> None:
    assert fitness(query, better) > fitness(query, worse) >= 0


def test_words_may_come_in_any_order() -> None:
    assert fitness("all select", "Select All") > 0


def test_words_beside_the_text_are_found_in_one_piece_and_count_less() -> None:
    assert fitness("play", "Next Frame") == 0
    assert fitness("play", "Display") > fitness("play", "Next Frame", "Play") > 0
    assert fitness("extrap", "Next Frame", "Play") == 0
