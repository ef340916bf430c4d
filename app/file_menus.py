"""The two menus that are made anew each time they open: recent files and samples."""

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu

if TYPE_CHECKING:
    from app.main_window import MainWindow

SAMPLES_FOLDER = Path(__file__).resolve().parent.parent / "resources" / "samples"


def samples() -> list[Path]:
    """The clips that come with the program."""
    return sorted(path for path in SAMPLES_FOLDER.glob("*") if path.suffix in (".hermite", ".anim"))


class FileMenu(QMenu):
    """A menu of files; choosing one opens it."""

    def __init__(self, title: str, tip: str, window: "MainWindow") -> None:
        super().__init__(title, window)
        self._window = window
        self.setToolTipsVisible(True)
        self.menuAction().setStatusTip(tip)
        self.menuAction().setToolTip(tip)
        self.aboutToShow.connect(self.fill)

    def fill(self) -> None:
        """Make the entries for the files there are now."""
        raise NotImplementedError

    def add_file(self, path: str, label: str) -> None:
        """An entry that opens *path*; a & in its name is shown."""
        action = QAction(label.replace("&", "&&"), self)
        action.setData(path)
        action.setToolTip(path)
        action.setStatusTip(path)
        action.triggered.connect(self._open)
        self.addAction(action)

    def _open(self) -> None:
        action = self.sender()
        if isinstance(action, QAction):
            self._window.files.open_recent(action.data())


class RecentMenu(FileMenu):
    """Files opened or saved lately; whether one is still there is looked up when it is chosen."""

    def __init__(self, window: "MainWindow") -> None:
        super().__init__("Open &Recent", "Open a file that was open lately", window)
        self.clear_list = QAction("&Clear List", self)
        self.clear_list.triggered.connect(self._clear_list)

    def fill(self) -> None:
        self.clear()
        paths = self._window.settings.recent_files
        names = [Path(path).name for path in paths]
        for path, name in zip(paths, names, strict=True):
            self.add_file(path, name if names.count(name) == 1 else f"{name} — {Path(path).parent}")
        if not paths:
            self.addAction("No file was open yet").setEnabled(False)
        self.addSeparator()
        self.addAction(self.clear_list)
        self.clear_list.setEnabled(bool(paths))

    def _clear_list(self) -> None:
        self._window.settings.recent_files = []


class SamplesMenu(FileMenu):
    """Clips to try things on."""

    def __init__(self, window: "MainWindow") -> None:
        super().__init__("Open &Sample", "Open one of the clips that come with Hermite", window)

    def fill(self) -> None:
        self.clear()
        for path in samples():
            self.add_file(str(path), path.stem.replace("_", " ").capitalize())

    def _open(self) -> None:
        action = self.sender()
        if isinstance(action, QAction):
            self._window.files.open(action.data())
