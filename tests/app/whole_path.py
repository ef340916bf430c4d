"""Runs the real program on a file and works in it with the X server's own mouse and keyboard; prints what it did.

python -m tests.app.whole_path FILE. It needs a display, a window manager and xdotool.
"""

import json
import subprocess
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from app.main_window import MainWindow

ROOT = Path(__file__).resolve().parents[2]
CHANNEL = 1  # the height of the root in a course .anim


def hand(*words: object) -> None:
    """Let xdotool do something, and give the program time to take it in."""
    from PySide6.QtTest import QTest

    subprocess.run(["xdotool", *map(str, words)], check=True, timeout=20)
    QTest.qWait(80)


def until(condition: Callable[[], bool], what: str) -> None:
    """Wait for *condition*; AssertionError if it does not come true."""
    from PySide6.QtTest import QTest

    for _ in range(250):
        if condition():
            return
        QTest.qWait(40)
    raise AssertionError(f"waited in vain for {what}")


def drive(window: "MainWindow") -> dict[str, object]:
    """One visit: choose a channel, drag a key, turn a tangent, drag another key and take that back, save."""
    from PySide6.QtCore import QPoint

    view, document = window.view, window.document
    channel = document.clip.channels[CHANNEL]

    def click_at(point: QPoint) -> None:
        hand("mousemove", point.x(), point.y(), "click", 1)

    def on_graph(x: float, y: float) -> QPoint:
        return view.viewport().mapToGlobal(QPoint(round(x), round(y)))

    def of_key(index: int) -> QPoint:
        run = channel.run()
        return on_graph(view.x_from_time(float(run["time"][index])), view.y_from_value(float(run["value"][index])))

    def drag(start: QPoint, dx: int, dy: int) -> None:
        hand("mousemove", start.x(), start.y(), "mousedown", 1)
        for part in range(1, 9):
            hand("mousemove", start.x() + dx * part // 8, start.y() + dy * part // 8)
        hand("mouseup", 1)

    until(window.isActiveWindow, "the window manager to give the window the focus")
    tree = window.tree.view
    row = tree.visualRect(tree.rows.index_of(channel))
    click_at(tree.viewport().mapToGlobal(row.center()))
    until(lambda: document.session.active is channel, "the channel to be active")
    hand("key", "shift+h")
    until(lambda: len(document.session.shown_channels(document.clip)) == 1, "the other channels to be hidden")
    seen = view.view_range
    hand("key", "a")
    until(lambda: view.view_range != seen, "the view to show all of it")

    scale = (view.time_from_x(101.0) - view.time_from_x(100.0), view.value_from_y(100.0) - view.value_from_y(101.0))
    drag(of_key(2), 60, 70)
    until(lambda: window.undo_stack.count() == 1, "the drag of a key")

    click_at(of_key(5))
    until(lambda: document.session.selection.count == 1, "the click on a key")
    key = channel.key(int(channel.run()["id"][5]))
    handle = view.handle_points(channel, key.id)[1]
    assert handle is not None, "the selected key shows no handle"
    spot = on_graph(*handle)
    drag(spot, 0, -40)
    until(lambda: window.undo_stack.count() == 2, "the drag of a tangent")
    dropped = view.viewport().mapFromGlobal(spot + QPoint(0, -40))
    rise = view.value_from_y(float(dropped.y())) - key.value
    slope = rise / (view.time_from_x(float(dropped.x())) - key.time)

    drag(of_key(7), 0, 90)
    until(lambda: window.undo_stack.count() == 3, "the drag of another key")
    hand("key", "ctrl+z")
    until(lambda: window.undo_stack.index() == 2, "undo")
    assert window.isWindowModified()
    hand("key", "ctrl+s")
    until(lambda: not window.isWindowModified(), "the file to be saved")
    return {"scale": scale, "slope": slope, "labels": [window.undo_stack.text(i) for i in range(3)]}


def main(path: str) -> int:
    """Run the program, drive it, close it by its own shortcut; the program's exit code."""
    sys.path.insert(0, str(ROOT))
    from app.main_window import MainWindow, run_window

    outcome: dict[str, object] = {}

    def first_picture(window: MainWindow) -> None:
        try:
            outcome.update(drive(window))
        except Exception:
            outcome["failure"] = traceback.format_exc()
            window.undo_stack.setClean()
        hand("key", "ctrl+q")

    code = run_window(path, None, first_picture=first_picture)
    print(json.dumps(outcome))
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
