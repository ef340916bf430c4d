"""A window on a small clip, with nobody to ask: the answers to its questions are given beforehand."""

import gc
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QCoreApplication, QEvent
from PySide6.QtGui import QColor
from pytestqt.qtbot import QtBot

from app.main_window import MainWindow
from app.questions import Answer, Questions
from app.settings import Settings
from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.extrapolation import Extrapolation
from model.formats import write_bytes
from model.keyframe import make_run


class Answers(Questions):
    """Gives the answer that was laid ready for a question, else cancels; remembers what it was asked and told."""

    def __init__(self) -> None:
        self.asked: list[str] = []
        self.told: list[str] = []
        self.answers: dict[str, object] = {}
        self.changed = True  # as it was told when it was last asked to save changes

    def _answer[T](self, question: str, otherwise: T) -> T:
        self.asked.append(question)
        return self.answers.get(question, otherwise)  # type: ignore[return-value]

    def save_changes(self, name: str, lacking: object = (), *, changed: bool = True) -> Answer:
        self.changed = changed
        return self._answer("save_changes", Answer.CANCEL)

    def lossy_save(self, name: str, losses: object) -> Answer:
        return self._answer("lossy_save", Answer.CANCEL)

    def overwrite_changed(self, name: str) -> bool:
        return self._answer("overwrite_changed", False)

    def reload_changed(self, name: str, *, modified: bool) -> bool:
        return self._answer("reload_changed", False)

    def revert(self, name: str) -> bool:
        return self._answer("revert", False)

    def forget_missing(self, path: str) -> bool:
        return self._answer("forget_missing", False)

    def path_to_open(self, folder: str) -> tuple[str, str]:
        return self._answer("path_to_open", ("", ""))

    def skeleton_to_open(self, folder: str) -> str:
        return self._answer("skeleton_to_open", "")

    def path_to_save(self, suggested: str, format_name: str) -> tuple[str, str]:
        return self._answer("path_to_save", ("", ""))

    def text(self, title: str, label: str, text: str) -> str:
        return self._answer("text", "")

    def color(self, color: QColor) -> QColor:
        return self._answer("color", QColor())

    def tell_error(self, heading: str, text: str) -> None:
        self.told.append(f"{heading}: {text}")

    def tell_warning(self, heading: str, text: str) -> None:
        self.told.append(f"{heading}: {text}")


type MakeWindow = Callable[[Clip], MainWindow]


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    return Settings(str(tmp_path / "hermite.ini"))


@pytest.fixture
def make_window(qtbot: QtBot, settings: Settings) -> Iterator[MakeWindow]:
    """Makes windows that are closed, without a question, at the end of the test."""
    windows: list[MainWindow] = []

    def make(clip: Clip) -> MainWindow:
        window = MainWindow(Document(clip), settings)
        window.questions = Answers()
        window.resize(1200, 800)
        window.show()
        qtbot.waitExposed(window)
        QCoreApplication.processEvents()
        windows.append(window)
        return window

    yield make
    for window in windows:
        answers_of(window).answers["save_changes"] = Answer.DISCARD
        window.close()
        window.deleteLater()
    windows.clear()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    gc.collect()


@pytest.fixture
def window(make_window: MakeWindow) -> MainWindow:
    return make_window(small_clip())


@pytest.fixture
def path(tmp_path: Path) -> Path:
    file = tmp_path / "walk & run.hermite"
    file.write_bytes(write_bytes(small_clip(), "hermite"))
    return file


@pytest.fixture
def opened(window: MainWindow, path: Path) -> MainWindow:
    assert window.open_file(str(path))
    return window


def answers_of(window: MainWindow) -> Answers:
    assert isinstance(window.questions, Answers)
    return window.questions


def small_clip() -> Clip:
    """Three channels of four, two and no keys."""
    walk = make_run([0.0, 0.5, 1.0, 2.0], [0.0, 1.0, -1.0, 0.5])
    turn = make_run([0.0, 1.0], [0.0, 1.5])
    return Clip(
        [
            Channel("root.tx", walk, post=Extrapolation.CYCLE),
            Channel("root.rx", turn, unit="angle"),
            Channel("root.sx"),
        ],
        start=0.0,
        end=2.0,
    )
