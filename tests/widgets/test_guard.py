"""No exception of ours passes into Qt, and none gets lost."""

import sys

import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QPaintEvent
from PySide6.QtWidgets import QWidget

from widgets.guard import guarded, unguarded


class Careful(QWidget):
    @guarded(QSize(7, 9))
    def sizeHint(self) -> QSize:
        return QSize(1 // 0, 0)

    @guarded(QWidget.minimumSizeHint)
    def minimumSizeHint(self) -> QSize:
        raise ValueError("no size")

    def own_method(self) -> None:
        pass


class Careless(Careful):
    def paintEvent(self, event: QPaintEvent) -> None:
        pass


@pytest.fixture
def reports(monkeypatch):
    seen = []
    monkeypatch.setattr(sys, "excepthook", lambda kind, error, trace: seen.append((kind, trace is not None)))
    return seen


def test_qt_gets_the_default_and_the_exception_is_reported_once(qtbot, reports):
    widget = Careful()
    qtbot.addWidget(widget)
    assert widget.sizeHint() == QSize(7, 9)
    assert reports == [(ZeroDivisionError, True)]


def test_a_callable_default_is_qts_own_answer(qtbot, reports):
    widget = Careful()
    qtbot.addWidget(widget)
    assert widget.minimumSizeHint() == QWidget.minimumSizeHint(widget)
    assert [kind for kind, _ in reports] == [ValueError]


def test_unguarded_overrides_are_listed_by_name_and_others_are_not():
    assert unguarded(Careful) == []
    assert [name.rsplit(".", 2)[-2:] for name in unguarded(Careless)] == [["Careless", "paintEvent"]]


def test_the_wrapped_method_keeps_its_name():
    assert Careful.sizeHint.__name__ == "sizeHint"
