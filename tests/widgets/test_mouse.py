"""Strokes: what a tool is told when buttons go down, move and come up."""

import pytest
from PySide6.QtCore import Qt

from widgets.strokes import Strokes
from widgets.tools.base import Point, Tool

LEFT, RIGHT, NONE = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton, Qt.MouseButton.NoButton


class Recorder(Tool):
    """A tool that writes down what it is told."""

    def __init__(self) -> None:
        self.told: list[str] = []
        self.at_once = False
        self.takes_double = False

    def press(self, point: Point) -> bool:
        self.told.append(f"press {point.x:g}")
        return self.at_once

    def drag(self, point: Point) -> None:
        self.told.append(f"drag {point.x:g}")

    def release(self, point: Point) -> None:
        self.told.append(f"release {point.x:g}")

    def click(self, point: Point) -> None:
        self.told.append(f"click {point.x:g}")

    def double_click(self, point: Point) -> bool:
        self.told.append(f"double {point.x:g}")
        return self.takes_double

    def hover(self, point: Point) -> None:
        self.told.append(f"hover {point.x:g}")

    def leave(self) -> None:
        self.told.append("leave")

    def cancel(self) -> None:
        self.told.append("cancel")


@pytest.fixture
def tool() -> Recorder:
    return Recorder()


@pytest.fixture
def strokes(tool: Recorder) -> Strokes:
    return Strokes(lambda point: tool)


def at(x: float, button: Qt.MouseButton = NONE) -> Point:
    return Point(x, 50.0, x / 100.0, 0.5, Qt.KeyboardModifier.NoModifier, button)


def test_a_press_and_a_release_at_one_spot_are_a_click(strokes: Strokes, tool: Recorder) -> None:
    strokes.press(at(10, LEFT))
    strokes.release(at(10, LEFT), NONE)
    assert tool.told == ["press 10", "click 10"]


def test_a_drag_begins_after_four_pixels(strokes: Strokes, tool: Recorder) -> None:
    strokes.press(at(10, LEFT))
    strokes.move(at(13.9), LEFT)
    assert tool.told == ["press 10"]
    strokes.move(at(14), LEFT)
    strokes.move(at(12), LEFT)
    strokes.release(at(12, LEFT), NONE)
    assert tool.told == ["press 10", "drag 14", "drag 12", "release 12"]


def test_a_tremble_of_three_pixels_is_still_a_click(strokes: Strokes, tool: Recorder) -> None:
    strokes.press(at(10, LEFT))
    strokes.move(at(13), LEFT)
    strokes.release(at(12, LEFT), NONE)
    assert tool.told == ["press 10", "click 12"]


def test_a_release_away_from_the_last_move_still_drags_there(strokes: Strokes, tool: Recorder) -> None:
    strokes.press(at(10, LEFT))
    strokes.release(at(40, LEFT), NONE)
    assert tool.told == ["press 10", "drag 40", "release 40"]


def test_a_tool_may_begin_at_the_press(strokes: Strokes, tool: Recorder) -> None:
    tool.at_once = True
    strokes.press(at(10, LEFT))
    strokes.release(at(10, LEFT), NONE)
    assert tool.told == ["press 10", "drag 10", "release 10"]


def test_the_right_button_cancels_a_drag_and_the_rest_of_it_does_nothing(strokes: Strokes, tool: Recorder) -> None:
    strokes.press(at(10, LEFT))
    strokes.move(at(30), LEFT)
    strokes.press(at(30, RIGHT), alone=False)
    strokes.move(at(50), LEFT | RIGHT)
    strokes.release(at(50, RIGHT), LEFT)
    strokes.move(at(60), LEFT)
    strokes.release(at(60, LEFT), NONE)
    assert tool.told == ["press 10", "drag 30", "cancel"]
    strokes.move(at(61), NONE)
    assert tool.told[-1] == "hover 61"


def test_another_button_in_a_drag_changes_nothing(strokes: Strokes, tool: Recorder) -> None:
    strokes.press(at(10, LEFT))
    strokes.move(at(30), LEFT)
    strokes.press(at(30, Qt.MouseButton.MiddleButton), alone=False)
    strokes.release(at(30, Qt.MouseButton.MiddleButton), LEFT)
    strokes.move(at(40), LEFT)
    strokes.release(at(40, LEFT), NONE)
    assert tool.told == ["press 10", "drag 30", "drag 40", "release 40"]


def test_a_release_nobody_told_us_about_cancels(strokes: Strokes, tool: Recorder) -> None:
    strokes.press(at(10, LEFT))
    strokes.move(at(30), LEFT)
    strokes.move(at(200), NONE)
    assert tool.told == ["press 10", "drag 30", "cancel", "hover 200"]


def test_after_a_cancel_the_next_press_works_even_if_its_release_was_lost(strokes: Strokes, tool: Recorder) -> None:
    strokes.press(at(10, LEFT))
    strokes.cancel()
    strokes.press(at(20, LEFT), alone=True)
    strokes.release(at(20, LEFT), NONE)
    assert tool.told == ["press 10", "cancel", "press 20", "click 20"]


def test_a_second_press_of_the_only_button_takes_the_unfinished_stroke_back(strokes: Strokes, tool: Recorder) -> None:
    strokes.press(at(10, LEFT))
    strokes.move(at(30), LEFT)
    strokes.press(at(20, LEFT))
    strokes.release(at(20, LEFT), NONE)
    assert tool.told == ["press 10", "drag 30", "cancel", "press 20", "click 20"]


def test_cancel_without_a_stroke_tells_nobody(strokes: Strokes, tool: Recorder) -> None:
    strokes.cancel()
    strokes.move(at(10), NONE)
    strokes.cancel()
    strokes.move(at(11), NONE)
    assert tool.told == ["hover 10", "hover 11"]


def test_a_double_click_that_the_tool_does_not_want_is_one_more_press(strokes: Strokes, tool: Recorder) -> None:
    strokes.press(at(10, LEFT), double=True)
    strokes.release(at(10, LEFT), NONE)
    assert tool.told == ["double 10", "press 10", "click 10"]


def test_a_double_click_that_the_tool_takes_can_be_dragged(strokes: Strokes, tool: Recorder) -> None:
    tool.takes_double = True
    strokes.press(at(10, LEFT), double=True)
    strokes.move(at(20), LEFT)
    strokes.release(at(20, LEFT), NONE)
    assert tool.told == ["double 10", "drag 20", "release 20"]


def test_a_tool_that_loses_the_pointer_to_another_is_told(tool: Recorder) -> None:
    other = Recorder()
    strokes = Strokes(lambda point: tool if point.x < 50 else other)
    strokes.move(at(10), NONE)
    strokes.move(at(60), NONE)
    assert tool.told == ["hover 10", "leave"]
    assert other.told == ["hover 60"]
