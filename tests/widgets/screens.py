"""A screen made of an image: keeps what was painted and lets Qt paint only what it asked to be painted anew."""

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QObject
from PySide6.QtGui import QImage, QPaintEvent, QRegion
from PySide6.QtWidgets import QApplication

from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.extrapolation import Extrapolation
from model.keyframe import TangentRule, make_run
from widgets.curve_view import CurveView

type Pixels = NDArray[np.uint32]


class Screen(QObject):
    """What a screen with this device pixel ratio shows of a view; strips that were not asked for stay as they were."""

    def __init__(self, view: CurveView, ratio: float = 1.0) -> None:
        super().__init__()
        self.view = view
        self.image = blank(view, ratio)
        # What the view asks its screen for; an image alone would be painted with the ratio of the real screen.
        view.viewport().devicePixelRatioF = lambda: ratio  # type: ignore[method-assign]
        self._asked = QRegion(view.viewport().rect())
        self._rendering = False
        view.viewport().installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if not isinstance(event, QPaintEvent) or self._rendering:
            return False
        self._asked += event.region()
        return True

    def refresh(self) -> QRegion:
        """Paint what was asked for since the last time, and say what that was."""
        QApplication.processEvents()
        region, self._asked = self._asked, QRegion()
        if not region.isEmpty():
            self._rendering = True
            self.view.viewport().render(self.image, region.boundingRect().topLeft(), region)
            self._rendering = False
        return region

    def shown(self) -> Pixels:
        """The pixels once all that was asked for is painted and every slow picture is finished."""
        self.refresh()
        self.view.canvas.settle()
        self.refresh()
        return pixels_of(self.image)

    def painted_anew(self) -> Pixels:
        """The pixels of a full repaint that remembers nothing."""
        self.view.canvas.forget()
        image = blank(self.view, self.image.devicePixelRatio())
        self._rendering = True
        self.view.viewport().render(image)
        self.view.canvas.settle()
        self.view.viewport().render(image)
        self._rendering = False
        return pixels_of(image)


def blank(view: CurveView, ratio: float) -> QImage:
    size = view.viewport().size() * ratio
    image = QImage(size, QImage.Format.Format_RGB32)
    image.setDevicePixelRatio(ratio)
    image.fill(0)
    return image


def pixels_of(image: QImage) -> Pixels:
    return np.frombuffer(image.constBits(), np.uint32).reshape(image.height(), image.bytesPerLine() // 4).copy()


def sample_clip(seed: int = 0, channels: int = 5, keys: int = 9) -> Clip:
    """Channels of every rule, every extrapolation, a lock and a lone key."""
    rng = np.random.default_rng(seed)
    made = []
    for i in range(channels):
        n = 1 if i == channels - 1 else keys
        times = np.sort(rng.choice(60, n, replace=False)) / 20.0
        rules = rng.choice(list(TangentRule), n)
        into = np.where(rules == TangentRule.STEP, TangentRule.AUTO, rules)
        run = make_run(
            times, rng.normal(size=n), rng.normal(size=n), rng.normal(size=n), into, rules, rng.random(n) < 0.4
        )
        modes = [Extrapolation(int(rng.integers(5))) for _ in range(2)]
        made.append(Channel(f"part{i}.{'xyzwv'[i % 5]}", run, pre=modes[0], post=modes[1], locked=i == 1))
    return Clip(made, start=0.25, end=2.75, frame_rate=24.0)


def view_of(clip: Clip, size: tuple[int, int] = (640, 400)) -> CurveView:
    """A shown view of a document of its own."""
    view = CurveView(Document(clip))
    view.resize(*size)
    view.show()
    QApplication.processEvents()
    return view
