"""A monkey at the mouse: whatever it does, no error comes up, the channels stay sound, and undo leads back."""

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication

from tests.widgets.desk import Desk
from tests.widgets.hand import ALT, CTRL, LEFT, MIDDLE, PLAIN, RIGHT, SHIFT

STEPS = 400
MODIFIERS = (PLAIN, PLAIN, PLAIN, SHIFT, CTRL, ALT, SHIFT | CTRL, SHIFT | ALT)
KEYS = (Qt.Key.Key_Escape, Qt.Key.Key_Shift, Qt.Key.Key_Control, Qt.Key.Key_Delete, Qt.Key.Key_Alt)


class Monkey:
    """Does one thing after another at random, most of them near something that can be taken."""

    def __init__(self, desk: Desk, seed: int) -> None:
        self.desk = desk
        self.hand = desk.hand
        self.rng = np.random.default_rng(seed)

    def spot(self) -> tuple[float, float]:
        """A pixel: often near a key or on a curve, sometimes anywhere, even outside."""
        channel = self.desk.clip.channels[int(self.rng.integers(2))]
        dx, dy = self.rng.normal(0.0, 5.0, 2)
        match int(self.rng.integers(5)):
            case 0 | 1 if len(channel):
                key = channel.run()[int(self.rng.integers(len(channel)))]
                x, y = self.hand.spot_of(float(key["time"]), float(key["value"]))
                return x + dx, y + dy
            case 2:
                time = float(self.rng.uniform(*self.desk.view.view_range[:2]))
                x, y = self.hand.spot_of(time, channel.value(time))
                return x + dx, y + dy
            case _:
                return float(self.rng.uniform(-60, 960)), float(self.rng.uniform(-60, 760))

    def act(self) -> None:
        """One thing."""
        rng, hand, session = self.rng, self.hand, self.desk.session
        modifiers = MODIFIERS[int(rng.integers(len(MODIFIERS)))]
        button = (LEFT, LEFT, LEFT, MIDDLE, RIGHT)[int(rng.integers(5))]
        what = int(rng.integers(20))
        if hand.held and what < 14:
            hand.move(self.spot(), modifiers) if what < 11 else hand.release(self.spot(), first(hand.held), modifiers)
        elif what < 6:
            hand.press(self.spot(), button, modifiers)
        elif what < 9:
            hand.click(self.spot(), button, modifiers)
        elif what < 10 and not hand.held:
            hand.double_click(self.spot(), modifiers)
        elif what < 12:
            hand.move(self.spot(), modifiers)
        elif what < 14:
            hand.wheel(self.spot(), int(rng.integers(-240, 240)), modifiers)
        elif what < 16:
            hand.key(KEYS[int(rng.integers(len(KEYS)))])
        elif what < 17:
            session.tool = ("select", "scale", "retime")[int(rng.integers(3))]
        elif what < 18:
            session.snap = bool(rng.integers(2))
            session.reorder = bool(rng.integers(2))
        elif what < 19:
            self.desk.view.frame_all()
        else:
            QApplication.processEvents()


def first(held: Qt.MouseButton) -> Qt.MouseButton:
    return next(button for button in (LEFT, MIDDLE, RIGHT) if held & button)


@pytest.mark.parametrize("seed", range(6))
def test_whatever_the_mouse_does_the_channels_stay_sound_and_undo_leads_back(desk: Desk, seed: int) -> None:
    before = desk.keys()
    edges = (desk.clip.start, desk.clip.end)
    monkey = Monkey(desk, seed)
    for _ in range(STEPS):
        monkey.act()
        desk.clip.check()
        assert (desk.document.gesture is not None) <= desk.view.router.busy
    desk.view.router.cancel()
    assert desk.document.gesture is None
    assert desk.edits
    for edit in reversed(desk.edits):
        desk.document.apply(edit.inverse())
        desk.clip.check()
    assert desk.keys() == before
    assert (desk.clip.start, desk.clip.end) == edges
