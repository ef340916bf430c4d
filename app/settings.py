"""Settings: what the program remembers from one run to the next, typed, in one ini file."""

from typing import Any, cast

from PySide6.QtCore import QByteArray, QSettings

RECENT_FILES_KEPT = 12
# Docks or toolbars added or renamed: add one, so that an old layout is dropped instead of half restored.
LAYOUT_VERSION = 1


class _Remembered[T: (bool, int, str, QByteArray)]:
    """One entry of the file. An ini file holds text only, so every read names the type it wants back."""

    def __init__(self, key: str, default: T) -> None:
        self.key = key
        self.default: T = default

    def __get__(self, settings: "Settings", owner: type) -> T:
        try:
            value: Any = settings.store.value(self.key, self.default, type(self.default))
        except (TypeError, ValueError):  # a hand-edited file: what cannot be read counts as absent
            return self.default
        return cast("T", value)

    def __set__(self, settings: "Settings", value: T) -> None:
        settings.store.setValue(self.key, value)


class Settings:
    """The remembered choices; reads of missing or broken entries give the default."""

    geometry = _Remembered("window/geometry", QByteArray())
    layout = _Remembered("window/layout", QByteArray())
    channels_width = _Remembered("window/channels_width", 0)
    inspector_width = _Remembered("window/inspector_width", 0)
    appearance = _Remembered("window/appearance", "system")
    last_folder = _Remembered("files/last_folder", "")
    snap = _Remembered("editing/snap", True)
    reorder = _Remembered("editing/reorder", True)
    loop = _Remembered("playing/loop", True)

    _recent = _Remembered("files/recent", "")

    def __init__(self, path: str | None = None) -> None:
        """Keep them in *path*, or in the user's own place when it is None."""
        ini = QSettings.Format.IniFormat
        self.store = QSettings(path, ini) if path else QSettings(ini, QSettings.Scope.UserScope, "Hermite", "hermite")

    @property
    def recent_files(self) -> list[str]:
        """Absolute paths, newest first; they may be gone by now."""
        return [path for path in self._recent.split("\n") if path]

    @recent_files.setter
    def recent_files(self, paths: list[str]) -> None:
        self._recent = "\n".join([path for path in paths if "\n" not in path][:RECENT_FILES_KEPT])

    def add_recent_file(self, path: str) -> None:
        """Put *path* in front."""
        self.recent_files = [path, *(p for p in self.recent_files if p != path)]

    def remove_recent_file(self, path: str) -> None:
        """Forget *path*."""
        self.recent_files = [p for p in self.recent_files if p != path]

    def sync(self) -> None:
        """Write what is still in memory."""
        self.store.sync()
