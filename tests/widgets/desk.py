"""A document in a curve view of known size and range, ready for a hand."""

from model.channel import Channel
from model.clip import Clip
from model.document import Document, Edit
from model.keyframe import make_run
from model.selection import Selection
from tests.widgets.hand import Hand
from widgets.curve_view import CurveView
from widgets.theme import Theme
from widgets.view_range import ViewRange

TIMES = [0.0, 1.0, 2.0, 3.0, 4.0]


class Desk:
    """One view on two channels, ten frames a second: "low" around value 0, "high" around value 10."""

    def __init__(self) -> None:
        self.low = Channel("low", make_run(TIMES, [0.0, 2.0, -2.0, 2.0, 0.0]))
        self.high = Channel("high", make_run(TIMES, [10.0, 12.0, 8.0, 12.0, 10.0]))
        self.clip = Clip([self.low, self.high], start=0.0, end=4.0, frame_rate=10.0)
        self.document = Document(self.clip)
        self.session = self.document.session
        self.session.snap = False
        self.edits: list[Edit] = []
        self.document.committed.connect(lambda edit: self.edits.append(edit))
        self.hints: list[str] = []
        self.view = CurveView(self.document, Theme("dark"))
        self.view.router.hint_changed.connect(self.hints.append)
        self.view.resize(900, 700)
        self.view.set_view(ViewRange(-1.0, 5.0, -5.0, 15.0))
        self.hand = Hand(self.view)

    def spot(self, channel: Channel, key_id: int) -> tuple[float, float]:
        """The viewport pixel of a key."""
        key = channel.key(key_id)
        return self.hand.spot_of(key.time, key.value)

    def select(self, channel: Channel, *ids: int) -> None:
        self.session.selection = Selection.of({channel: list(ids)})

    def selected(self, channel: Channel) -> list[int]:
        return [int(key_id) for key_id in self.session.selection.ids(channel)]

    def way(self, dx: float, dy: float) -> tuple[float, float]:
        """(d_time, d_value) of a way in pixels."""
        view = self.view
        return (
            view.time_from_x(100.0 + dx) - view.time_from_x(100.0),
            view.value_from_y(100.0 + dy) - view.value_from_y(100.0),
        )

    def keys(self) -> tuple[bytes, bytes]:
        """The bits of all keys: equal before and after means that nothing has happened."""
        return self.low.run().tobytes(), self.high.run().tobytes()


def beside(spot: tuple[float, float], dx: float = 0.0, dy: float = 0.0) -> tuple[float, float]:
    """A spot so many pixels away."""
    return spot[0] + dx, spot[1] + dy
