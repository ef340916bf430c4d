"""About: what this is, which version, under which license, built on what."""

import platform
from importlib.metadata import PackageNotFoundError, version

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialog, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app import __version__
from app.dialogs import close_buttons
from widgets.theme import Theme

BUILT_ON = ("PySide6-Essentials", "pyqtgraph", "numpy", "simpleeval")


def versions() -> list[tuple[str, str]]:
    """(name, version) of Hermite, Python and what it is built on."""
    found = [("Hermite", __version__), ("Python", platform.python_version())]
    for name in BUILT_ON:
        try:
            found.append((name, version(name)))
        except PackageNotFoundError:
            found.append((name, "of unknown version"))
    return found


class AboutDialog(QDialog):
    """The picture, one sentence, the versions, the license."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("About Hermite")
        picture = QLabel()
        picture.setPixmap(Theme.current().icon("hermite").pixmap(72, 72))
        picture.setAlignment(Qt.AlignmentFlag.AlignTop)
        rest = "\n".join(f"{name} {number}" for name, number in versions()[1:])
        text = QLabel(
            f"Hermite {__version__}\n\nA desktop editor for animation channels.\n\n{rest}\n\n"
            "Apache License, Version 2.0.\nQt for Python is used under the LGPL, version 3."
        )
        text.setTextFormat(Qt.TextFormat.PlainText)
        text.setTextInteractionFlags(
            Qt.TextInteractionFlag.TextSelectableByMouse | Qt.TextInteractionFlag.TextSelectableByKeyboard
        )
        text.setAccessibleName("About Hermite")
        row = QHBoxLayout()
        row.setSpacing(18)
        row.addWidget(picture)
        row.addWidget(text, 1)
        column = QVBoxLayout(self)
        column.addLayout(row)
        column.addWidget(close_buttons(self))
