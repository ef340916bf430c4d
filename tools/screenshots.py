"""Takes the pictures of the README from the real window: python -m tools.screenshots

No screen is needed. Whatever the user of this machine has set in the editor stays out of the pictures.
"""

import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ.setdefault("QT_NO_GUI_THREADPOOL", "1")

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QImage
from PySide6.QtTest import QTest

from app.clip_file import open_clip
from app.main_window import MainWindow, make_application
from app.settings import Settings
from model.selection import Selection
from tools.make_samples import SAMPLES
from widgets.theme import Theme

IMAGES = Path(__file__).resolve().parent.parent / "docs" / "images"
SIZE = (1400, 820)


def select_keys(window: MainWindow, name: str, first: int, last: int) -> None:
    """Select some keys of a channel, counted from 0, and make it the active one."""
    channel = window.document.clip.channel(name)
    ids = [key.id for key in channel][first : last + 1]
    window.activate(channel)
    window.session.selection = Selection.of({channel: ids})


def a_ball(window: MainWindow) -> None:
    """One bounce of the ball pulled up with the mouse, and a handle of it in the hand."""
    view, channel = window.view, window.document.clip.channel("ball.ty")
    select_keys(window, "ball.ty", 2, 2)
    window.session.playhead = 2.2
    QTest.qWait(300)
    key = list(channel)[2]
    start = QPoint(round(view.x_from_time(key.time)), round(view.y_from_value(key.value)))
    drag(window, start, QPoint(26, -52))
    QTest.mouseRelease(view.viewport(), Qt.MouseButton.LeftButton, pos=start + QPoint(26, -52))
    handle = view.handle_points(channel, key.id)[1]
    assert handle is not None
    drag(window, QPoint(round(handle[0]), round(handle[1])), QPoint(10, 34))


def drag(window: MainWindow, start: QPoint, way: QPoint) -> None:
    """Press at *start* and go *way* with the left button held."""
    viewport = window.view.viewport()
    QTest.mouseMove(viewport, start)
    QTest.mousePress(viewport, Qt.MouseButton.LeftButton, pos=start)
    for part in range(1, 11):
        QTest.mouseMove(viewport, start + way * part / 10)
        QTest.qWait(5)


def rules_side_by_side(window: MainWindow) -> None:
    """The middle of the smooth curve selected, seen from a little further off."""
    select_keys(window, "rule.smooth", 1, 3)
    window.session.playhead = 2.25
    t0, t1, v0, v1 = window.view.view_range
    window.view.set_view(type(window.view.view_range)(t0 - 1.0, t1 + 1.0, v0, v1))


class Picture(NamedTuple):
    """One row a picture: its file, what is opened, how the window looks, what is done before it is taken."""

    file: str
    sample: str
    appearance: str
    prepare: Callable[[MainWindow], None]


PICTURES = (
    Picture("ball-dark.png", "bounce.hermite", "dark", a_ball),
    Picture("rules-light.png", "rules.hermite", "light", rules_side_by_side),
)


def take(picture: Picture, folder: Path) -> Path:
    """Open the window as *picture* says and save what it shows in *folder*."""
    app = make_application()
    with tempfile.TemporaryDirectory() as settings:
        Theme.current().apply(app, picture.appearance)
        window = MainWindow(settings=Settings(str(Path(settings) / "settings.ini")), frame_only=True)
        window.resize(*SIZE)
        window.assemble(opened=open_clip(str(SAMPLES / picture.sample)))
        window.show()
        picture.prepare(window)
        QTest.qWait(300)
        image = window.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)
        window.cancel_gesture()
        window.undo_stack.setClean()
        window.close()
        window.deleteLater()
        QTest.qWait(0)
    target = folder / picture.file
    if not image.save(str(target), "PNG", 0):  # type: ignore[call-overload]  # quality 0 is the smallest file
        raise OSError(f"{target} could not be written")
    return target


def main(folder: Path = IMAGES) -> int:
    """Takes all pictures."""
    folder.mkdir(parents=True, exist_ok=True)
    for picture in PICTURES:
        target = take(picture, folder)
        print(f"{target}: {target.stat().st_size:,} bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
