"""Words that change in a drag are painted, and nothing is laid out for them."""

import pytest
from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QApplication, QHBoxLayout, QLabel, QWidget

from widgets.guard import unguarded
from widgets.quiet_label import QuietLabel


class Layouts(QObject):
    """Counts how often a widget is to be laid out."""

    def __init__(self, watched: QWidget) -> None:
        super().__init__(watched)
        self.count = 0
        watched.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        self.count += event.type() == QEvent.Type.LayoutRequest
        return False


@pytest.fixture
def row(qtbot):
    widget = QWidget()
    qtbot.addWidget(widget)
    QHBoxLayout(widget)
    widget.resize(600, 40)
    widget.show()
    return widget


@pytest.mark.parametrize("yields", [True, False])
def test_a_text_of_about_the_same_width_has_nothing_laid_out(row, yields):
    label = QuietLabel("t = 1.25 s", yields=yields)
    row.layout().addWidget(label)
    QApplication.processEvents()
    layouts = Layouts(row)
    before = label.grab().toImage()
    label.setText("t = 1.31 s")
    QApplication.processEvents()
    assert layouts.count == 0
    assert label.grab().toImage() != before
    assert (label.text(), label.accessibleDescription()) == ("t = 1.31 s", "t = 1.31 s")


def test_a_longer_text_gets_its_room(row):
    label = QuietLabel("t")
    row.layout().addWidget(label)
    row.layout().addWidget(QLabel(), 1)
    QApplication.processEvents()
    label.setText("as many words as do not fit where one letter was")
    QApplication.processEvents()
    assert label.width() >= label.fontMetrics().horizontalAdvance(label.text())
    assert label.toolTip() == ""


def test_a_larger_font_gets_more_room(row):
    label = QuietLabel("words that are read")
    row.layout().addWidget(label)
    before = label.sizeHint().width()
    font = label.font()
    font.setPointSize(3 * font.pointSize())
    label.setFont(font)
    assert label.sizeHint().width() > 2 * before


def test_what_does_not_fit_is_in_the_tooltip(row):
    label = QuietLabel("more words than this narrow window has room for, whatever the font is " * 3)
    row.layout().addWidget(label)
    label.grab()
    assert label.toolTip() == label.text()


def test_every_override_is_guarded():
    assert unguarded(QuietLabel) == []
