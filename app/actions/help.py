"""Actions of the Help menu."""

from typing import TYPE_CHECKING

from PySide6.QtGui import QKeySequence

from app.actions.row import Action

if TYPE_CHECKING:
    from app.main_window import MainWindow


def _show_shortcuts(window: "MainWindow") -> None:
    from app.help import ShortcutsDialog

    ShortcutsDialog(window).show()


def _show_mouse(window: "MainWindow") -> None:
    from app.help import MouseDialog

    MouseDialog(window).show()


def _show_about(window: "MainWindow") -> None:
    from app.about import AboutDialog

    AboutDialog(window).open()


HELP_ACTIONS = (
    Action(
        id="help.shortcuts",
        menu="Help",
        label="&Keyboard Shortcuts",
        function=_show_shortcuts,
        shortcuts=(QKeySequence.StandardKey.HelpContents,),
        icon="keyboard",
        tip="Every command with its keys, searchable",
        in_mid_drag=True,
    ),
    Action(
        id="help.mouse",
        menu="Help",
        label="&Mouse",
        function=_show_mouse,
        icon="help",
        tip="What the mouse does in the graph",
        in_mid_drag=True,
    ),
    Action(
        id="help.about",
        menu="Help",
        label="&About Hermite",
        function=_show_about,
        icon="info",
        tip="Version, license, and the versions of what it is built on",
        begins_group=True,
    ),
)
