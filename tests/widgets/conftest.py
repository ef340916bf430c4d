"""What the tests of widgets share."""

import pytest
from pytestqt.qtbot import QtBot

from tests.widgets.desk import Desk


@pytest.fixture
def desk(qtbot: QtBot) -> Desk:
    """A shown view on two channels, with a hand on its mouse."""
    desk = Desk()
    qtbot.addWidget(desk.view)
    with qtbot.waitExposed(desk.view):
        desk.view.show()
    desk.view.setFocus()
    return desk
