"""A drag by real X events in a window on a virtual screen: from the arrival of the event to the end of its paint."""

import sys
from collections.abc import Callable
from ctypes import CDLL, c_char_p, c_int, c_uint, c_ulong, c_void_p
from time import perf_counter, sleep

from PySide6.QtCore import QEvent, QObject, QPointF
from PySide6.QtWidgets import QApplication, QStackedWidget, QWidget

from tests.bench.apart import ROOT, lines_of
from tests.bench.picture import CLIPS, SIZE, Shown, beside_empty, settle, shown, wander
from tests.bench.table import Line, Times, summed_up

STEPS = 400
APART = 8e-3  # seconds from one event to the next, as from a mouse that tells its place 125 times a second
LONGEST_WAIT = 2.0


class XPointer:
    """The pointer of the X screen, moved as a mouse would: by the extension XTEST."""

    def __init__(self) -> None:
        self._x11, self._test = CDLL("libX11.so.6"), CDLL("libXtst.so.6")
        self._x11.XOpenDisplay.restype, self._x11.XOpenDisplay.argtypes = c_void_p, [c_char_p]
        self._x11.XFlush.argtypes = [c_void_p]
        self._test.XTestFakeMotionEvent.argtypes = [c_void_p, c_int, c_int, c_int, c_ulong]
        self._test.XTestFakeButtonEvent.argtypes = [c_void_p, c_uint, c_int, c_ulong]
        self._display = self._x11.XOpenDisplay(None)
        if not self._display:
            raise RuntimeError("there is no X screen")

    def move(self, x: int, y: int) -> None:
        """To a pixel of the screen."""
        self._test.XTestFakeMotionEvent(self._display, -1, x, y, 0)
        self._x11.XFlush(self._display)

    def hold(self, down: bool) -> None:
        """Press or let go the left button."""
        self._test.XTestFakeButtonEvent(self._display, 1, int(down), 0)
        self._x11.XFlush(self._display)


class Watch(QObject):
    """When the last move of the mouse reached a widget, and whether it has been painted since."""

    def __init__(self, widget: QWidget) -> None:
        super().__init__(widget)
        self.moved = 0.0
        self.painted = False
        widget.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.MouseMove and not self.moved:
            self.moved = perf_counter()
        elif event.type() == QEvent.Type.Paint and self.moved:
            self.painted = True
        return False


def wait_until(done: Callable[[], object], what: str) -> None:
    """Let Qt work until something is so."""
    start = perf_counter()
    while not done():
        QApplication.processEvents()
        if perf_counter() - start > LONGEST_WAIT:
            raise RuntimeError(f"{what} within {LONGEST_WAIT:g} s")


def drag_times(scene: Shown, pointer: XPointer) -> Times:
    """Durations from the arrival of a move at the view to the end of its paint, the sending to the screen included."""
    view, viewport = scene.view, scene.view.viewport()
    key = scene.channel.key(scene.key_id)
    at = QPointF(float(view.x_from_time(key.time)), float(view.y_from_value(key.value)))

    def go(place: QPointF) -> None:
        spot = viewport.mapToGlobal(place).toPoint()
        pointer.move(spot.x(), spot.y())

    watch, places, taken = Watch(viewport), wander(at), []
    go(at + QPointF(40, 40))
    go(at)
    wait_until(lambda: watch.moved, "no event came")
    settle(view)
    pointer.hold(True)
    go(next(places))
    wait_until(lambda: view.document.gesture is not None, "no drag began")
    for i in range(STEPS + 10):
        start = perf_counter()
        settle(view)
        watch.moved, watch.painted = 0.0, False
        go(next(places))
        wait_until(lambda: watch.painted, "nothing was painted")  # it ends with the turn of the loop that painted
        if i >= 10:
            taken.append(perf_counter() - watch.moved)
        sleep(max(APART - (perf_counter() - start), 0.0))
    view.router.cancel()
    pointer.hold(False)
    settle(view)
    return summed_up(taken)


def run() -> list[Line]:
    """The figures, on the X screen that this process has."""
    stack = QStackedWidget()
    stack.resize(*SIZE)
    stack.show()
    stack.activateWindow()
    wait_until(lambda: stack.isActiveWindow(), "the window was not shown")
    pointer = XPointer()
    lines = []
    for name, make in CLIPS.items():
        clip = make()
        for where, keys_in_view in (("all in view", None), ("30 keys in view", 30)):
            times, empty = beside_empty(stack, lambda c=clip, n=keys_in_view: drag_times(shown(stack, c, n), pointer))
            work = f"a drag step of one key by X events, {name}, {where}"
            lines.append(Line(work, times.median, "empty repaint, PlotWidget with axes", empty, 1.5, 2e-3))
            lines.append(Line(f"{work}, 99 %", times.p99, most=6e-3))
    stack.close()
    return lines


def on_a_screen() -> list[Line] | str:
    """The figures, on a virtual screen with a window manager made for them; a sentence where there is none."""
    if sys.platform != "linux":
        return "by X events: not measured, since this is no Linux"
    found = lines_of("window", before=[str(ROOT / "tools" / "screen.sh")])
    return "by X events: not measured, since that needs Xvfb and openbox" if isinstance(found, str) else found
