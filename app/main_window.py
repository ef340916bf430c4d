"""MainWindow: the frame that shows at once, and the workbench that is put into it; run_window: the program."""

import sys
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QSize, QTimer, Signal
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QApplication, QDockWidget, QLineEdit, QMainWindow, QMenu

from app.settings import Settings
from widgets.guard import guarded
from widgets.theme import Theme

if TYPE_CHECKING:
    from app.actions.row import Need
    from app.clip_file import Opened
    from app.crash_bar import CrashBar
    from app.files import Files
    from app.in_hand import InHand
    from app.jobs import Jobs
    from app.menus import WindowAction
    from app.questions import Questions
    from app.status_row import StatusRow
    from app.undo import UndoStack
    from model.channel import Channel
    from model.clip import Clip
    from model.document import Document
    from model.session import Session
    from widgets.channel_tree import ChannelTree
    from widgets.curve_view import CurveView
    from widgets.key_inspector import KeyInspector
    from widgets.soon import Soon
    from widgets.transport import Transport
    from widgets.value_field import ValueField

FIRST_SIZE = (1400, 860)
# About what the window system draws around a window.
FRAME = QSize(16, 48)


class MainWindow(QMainWindow):
    """One document in one window. What it consists of is put together by app/workbench.py."""

    document: "Document"
    session: "Session"
    undo_stack: "UndoStack"
    jobs: "Jobs"
    files: "Files"
    questions: "Questions"
    view: "CurveView"
    tree: "ChannelTree"
    inspector: "KeyInspector"
    transport: "Transport"
    status: "StatusRow"
    crash_bar: "CrashBar"
    docks: dict[str, QDockWidget]
    actions_by_id: dict[str, "WindowAction"]
    menus: dict[str, QMenu]
    in_hand: "InHand"
    tips: "Soon"
    disk_look: "Soon"

    assembled = Signal()

    def __init__(
        self, document: "Document | None" = None, settings: Settings | None = None, *, frame_only: bool = False
    ) -> None:
        """With *frame_only* nothing but an empty window is made, in a few milliseconds; assemble() does the rest."""
        super().__init__()
        self.settings = settings or Settings()
        self.ready = False
        self.setWindowTitle("Hermite")
        self.setWindowIcon(Theme.current().icon("hermite"))
        self.setAcceptDrops(True)
        self.setDockOptions(
            QMainWindow.DockOption.AnimatedDocks
            | QMainWindow.DockOption.AllowNestedDocks
            | QMainWindow.DockOption.AllowTabbedDocks
        )
        if not self.restoreGeometry(self.settings.geometry):
            self.resize(QSize(*FIRST_SIZE).boundedTo(self.screen().availableGeometry().size() - FRAME))
        if not frame_only:
            self.assemble(document)

    def assemble(self, document: "Document | None" = None, opened: "Opened | None" = None) -> None:
        """Fill the frame. *opened* is the clip just read, if any."""
        from app.workbench import assemble

        assemble(self, document, opened)
        self.ready = True
        self.assembled.emit()

    # --- files

    def open_file(self, path: str, skeleton: str | None = None) -> bool:
        """Open the clip at *path*; False when that was refused, and nothing has changed."""
        return self.files.open(path, skeleton)

    def save(self) -> bool:
        """Write the clip to its file; False when it was not written."""
        return self.files.save()

    def save_as(self, format_name: str | None = None) -> bool:
        """Write the clip to a file that the user chooses; False when it was not written."""
        return self.files.save_as(format_name)

    # --- what actions and panels ask of the window

    def say(self, text: str) -> None:
        """Show a message in the status line for a while."""
        self.status.say(text)

    def refresh_actions(self) -> None:
        """Let every action show whether it can run now."""
        if self.document.working:
            return
        self.look_at_hand()
        known: dict[Need, bool] = {}
        for action in self.actions_by_id.values():
            action.refresh(known)
        self.tips.ask()

    def refresh_tips(self) -> None:
        """Let every action say why it cannot run now."""
        for action in self.actions_by_id.values():
            action.refresh_tip()

    def look_at_hand(self) -> None:
        """Look up what the next command is about."""
        from app.in_hand import InHand

        self.in_hand = InHand.of(self.tree.chosen(), self.session.selection)

    def refresh_title(self) -> None:
        """Name the file in the title, with a mark when the clip differs from it."""
        self.setWindowTitle(f"{self.files.name}[*] — Hermite")
        self.setWindowFilePath(self.files.path)
        self.setWindowModified(self.files.modified)
        for name in ("file.save", "file.revert"):
            self.actions_by_id[name].refresh({})

    def finish_entry(self) -> None:
        """Keep what is being typed into the panels, wherever the keyboard is now."""
        for field in self._fields_in_entry():
            field.finish()
        for line in self._names_in_entry():
            line.editingFinished.emit()

    def take_back_entry(self) -> bool:
        """Take back what is being typed into a number field; False when nothing is."""
        fields = self._fields_in_entry()
        for field in fields:
            field.take_back()
        return bool(fields)

    @property
    def in_entry(self) -> bool:
        """Whether something is being typed into the panels that is neither kept nor taken back yet."""
        return bool(self._fields_in_entry() or self._names_in_entry())

    def _names_in_entry(self) -> "list[QLineEdit]":
        from widgets.value_field import ValueField

        lines = self.inspector.findChildren(QLineEdit)
        return [line for line in lines if line.isModified() and not isinstance(line, ValueField)]

    def _fields_in_entry(self) -> "list[ValueField]":
        from widgets.value_field import ValueField

        panels = (self.inspector, self.transport)
        return [field for panel in panels for field in panel.findChildren(ValueField) if field.editing]

    def cancel_gesture(self) -> None:
        """End what is being dragged or previewed as if it had not begun."""
        self.view.router.cancel()
        if self.document.gesture is not None:
            self.document.gesture.cancel()

    def show_clip(self, clip: "Clip") -> None:
        """Make *clip* the one that is edited, with the playhead at its start; the history begins anew."""
        self.session.playing = False
        self.document.replace(clip)
        self.session.playhead = clip.start
        self.session.active = clip.channels[0] if clip.channels else None
        self.view.frame_clip()

    def activate(self, channel: "Channel") -> None:
        """Make *channel* the active one and show it if it was hidden."""
        self.session.hidden = self.session.hidden - {channel}
        if not self.session.shown(channel):
            self.session.solo = frozenset()
        self.session.active = channel

    def focus_graph(self, *_: object) -> None:
        """Let the keyboard be the graph's."""
        self.view.setFocus()

    def focus_filter(self) -> None:
        """Go to the field that filters the channels."""
        self.docks["channels"].show()
        self.tree.focus_filter()

    def set_appearance(self, wanted: str) -> None:
        """Dark, light, or as the desktop says; remembered."""
        self.settings.appearance = wanted
        app = QApplication.instance()
        if isinstance(app, QApplication):
            Theme.current().apply(app, wanted)

    def reset_layout(self) -> None:
        """Put panels and toolbar where they were at first."""
        from app.workbench import first_layout

        first_layout(self)

    # --- what Qt asks of the window

    @guarded()
    def closeEvent(self, event: QCloseEvent) -> None:
        if not self.ready:
            event.accept()
            return
        if not self.document.working:
            self.session.playing = False
        if not self.files.may_close():
            event.ignore()
            return
        from app.workbench import keep_state

        keep_state(self)
        event.accept()

    @guarded()
    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if self.ready and dropped_files(event):
            event.acceptProposedAction()

    @guarded()
    def dropEvent(self, event: QDropEvent) -> None:
        paths = dropped_files(event)
        if not paths:
            return
        event.acceptProposedAction()
        skeletons = [path for path in paths if path.lower().endswith(".skel")]
        clips = [path for path in paths if path not in skeletons]
        if clips:
            # Not from within the event: the program that the file is dragged from waits for this to return.
            QTimer.singleShot(0, self, partial(self.files.open, clips[0], skeletons[0] if skeletons else None))
        else:
            QTimer.singleShot(0, self, partial(self.files.name_channels, skeletons[0]))

    @guarded()
    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.ActivationChange and self.ready and self.isActiveWindow():
            self.disk_look.ask()


def dropped_files(event: QDropEvent) -> list[str]:
    """Paths of the local files that are dropped."""
    return [url.toLocalFile() for url in event.mimeData().urls() if url.isLocalFile()]


def make_application() -> QApplication:
    """The QApplication, named so that settings, the task bar and the desktop know it; there is one a process."""
    app = QApplication.instance()
    if not isinstance(app, QApplication):
        app = QApplication(sys.argv[:1])
    app.setOrganizationName("Hermite")
    app.setApplicationName("hermite")
    app.setApplicationDisplayName("Hermite")
    app.setDesktopFileName("hermite")
    return app


def run_window(
    path: str | None,
    skel: str | None,
    *,
    first_picture: Callable[[MainWindow], None] | None = None,
    first_frame: Callable[[], None] | None = None,
) -> int:
    """Open the window on the clip at *path*, or on a sample, and run until it is closed; the exit code.

    *first_picture* is called once, after the graph has been painted with the clip in it; with it a file that cannot
    be read ends the program with code 2 instead of a dialog. *first_frame* is called before that, when the empty
    window has been painted.
    """
    from app.start import start

    return start(path, skel, first_picture, first_frame)
