"""What the window consists of, and who listens to whom."""

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import QComboBox, QDockWidget, QLineEdit, QToolBar, QVBoxLayout, QWidget

from app.clip_file import Opened
from app.context_menu import ContextMenu
from app.corner import FindCommandButton
from app.crash_bar import CrashBar
from app.crash_reports import log_path
from app.file_menus import RecentMenu, SamplesMenu
from app.files import Files
from app.jobs import Jobs
from app.long_edits import LongEdits
from app.menus import make_actions, make_menus, make_toolbar, shortcut_text
from app.progress_row import ProgressRow
from app.questions import Questions
from app.settings import LAYOUT_VERSION
from app.shortcut_guard import ShortcutGuard
from app.status_row import StatusRow
from app.undo import UndoStack, UndoSteps
from app.watcher import Watcher
from model.clip import Clip
from model.document import Document
from widgets.channel_tree import ChannelTree
from widgets.curve_view import CurveView
from widgets.key_inspector import KeyInspector
from widgets.soon import Soon
from widgets.theme import Theme
from widgets.transport import Transport
from widgets.value_field import ValueField

if TYPE_CHECKING:
    from app.main_window import MainWindow

# Buttons of the transport and the actions that do the same.
TRANSPORT_ACTIONS = {
    "to_start": "play.start",
    "previous_key": "play.previous_key",
    "previous_frame": "play.previous_frame",
    "play": "play.toggle",
    "next_frame": "play.next_frame",
    "next_key": "play.next_key",
    "to_end": "play.end",
    "stop": "play.stop",
    "loop": "play.loop",
}
CHANNELS_WIDTH, INSPECTOR_WIDTH = 270, 270
LEAST_HEIGHT = 420


def assemble(window: "MainWindow", document: Document | None, opened: Opened | None) -> None:
    """Make everything inside the frame; the clip is *opened*, else the document's own."""
    if document is None:
        document = Document(opened.clip if opened else Clip())
    elif opened is not None:
        document.replace(opened.clip)
    window.document, window.session = document, document.session
    if window.session.active is None and document.clip.channels:
        window.session.active = document.clip.channels[0]
    if opened is not None:
        window.session.playhead = document.clip.start
    for name in ("snap", "reorder", "loop"):
        setattr(window.session, name, getattr(window.settings, name))
    window.questions = Questions(window)
    window.undo_stack = UndoStack(document, window)
    window.jobs = Jobs(window)
    window.files = Files(window)
    window.disk_look = Soon(window, window.files.look_at_disk)
    _make_parts(window)
    window.look_at_hand()
    window.actions_by_id = make_actions(window)
    window.tips = Soon(window, window.refresh_tips)
    window.transport.show_shortcuts(
        {button: shortcut_text(window.actions_by_id[name].row) for button, name in TRANSPORT_ACTIONS.items()}
    )
    window.menus = make_menus(window, {"file.name_channels": RecentMenu(window), "help.about": SamplesMenu(window)})
    make_toolbar(window)
    window.menuBar().setCornerWidget(FindCommandButton(window))
    ContextMenu(window)
    ShortcutGuard(window)
    watcher = Watcher(window)
    if opened is not None:
        window.files.adopt(opened)
    _restore_layout(window)
    watcher.refresh()
    window.refresh_title()
    window.view.frame_clip()
    _hand_keyboard_back(window)
    window.view.setFocus()
    QTimer.singleShot(0, window, partial(_settle, window))


def _hand_keyboard_back(window: "MainWindow") -> None:
    """After an entry or a choice in a panel the keys are the graph's again, so that a shortcut never types."""
    for panel in (window.inspector, window.transport):
        for field in panel.findChildren(ValueField):
            field.done.connect(window.focus_graph)
        for combo in panel.findChildren(QComboBox):
            combo.activated.connect(window.focus_graph)
        for line in panel.findChildren(QLineEdit):
            line.returnPressed.connect(window.focus_graph)
    window.tree.left.connect(window.focus_graph)


def _make_parts(window: "MainWindow") -> None:
    document, theme = window.document, Theme.current()
    window.view = CurveView(document, theme)
    window.view.setAcceptDrops(False)  # so that the window gets what is dropped on the graph
    window.view.viewport().setAcceptDrops(False)
    window.tree = ChannelTree(document, theme)
    window.inspector = KeyInspector(document, theme)
    window.transport = Transport(document, theme)
    window.crash_bar = CrashBar(str(log_path()))
    progress = ProgressRow(window.jobs, window)
    window.status = StatusRow(window.transport, progress, window.width())
    document.long_work = LongEdits(window, progress)
    window.destroyed.connect(partial(setattr, document, "long_work", None))
    middle = QWidget()
    column = QVBoxLayout(middle)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(0)
    column.addWidget(window.crash_bar)
    column.addWidget(window.view, 1)
    window.setCentralWidget(middle)
    history = UndoSteps(window.undo_stack)
    left, right = Qt.DockWidgetArea.LeftDockWidgetArea, Qt.DockWidgetArea.RightDockWidgetArea
    window.docks = {
        "channels": _dock(window, "channels", "Channels", window.tree, left),
        "inspector": _dock(window, "inspector", "Inspector", window.inspector, right),
        "history": _dock(window, "history", "Undo History", history, right),
    }
    window.docks["history"].hide()
    _place_panels(window)
    bar = window.statusBar()
    bar.setSizeGripEnabled(False)
    window.setMinimumSize(window.transport.minimumSizeHint().width() + 12, LEAST_HEIGHT)
    bar.addPermanentWidget(window.status, 1)


def _dock(window: "MainWindow", name: str, title: str, widget: QWidget, area: Qt.DockWidgetArea) -> QDockWidget:
    dock = QDockWidget(title, window)
    dock.setObjectName(f"dock_{name}")
    dock.setWidget(widget)
    window.addDockWidget(area, dock)
    return dock


def first_layout(window: "MainWindow") -> None:
    """Put panels and toolbar where they are before the user moves anything, in their first widths."""
    window.settings.channels_width = window.settings.inspector_width = 0
    _place_panels(window)
    for bar in window.findChildren(QToolBar):
        window.addToolBar(Qt.ToolBarArea.TopToolBarArea, bar)
        bar.show()
    _give_widths(window)


def _place_panels(window: "MainWindow") -> None:
    left, right = Qt.DockWidgetArea.LeftDockWidgetArea, Qt.DockWidgetArea.RightDockWidgetArea
    for name, area in (("channels", left), ("inspector", right), ("history", right)):
        dock = window.docks[name]
        dock.setFloating(False)
        window.addDockWidget(area, dock)
        dock.setVisible(name != "history")


def _restore_layout(window: "MainWindow") -> None:
    """Put panels and toolbar where they were; their widths are kept apart, for a state holds shares of a layout."""
    if window.restoreState(window.settings.layout, LAYOUT_VERSION):
        _give_widths(window)


def _settle(window: "MainWindow") -> None:
    """What only holds once the parts are on the screen: a frame that was shown empty gives the panels all its room,
    and what is not shown yet loses the focus to the first field that is.
    """
    _give_widths(window)
    window.focus_graph()


def _give_widths(window: "MainWindow") -> None:
    """Make the panels as wide as they were left."""
    settings = window.settings
    panels = [window.docks["channels"], window.docks["inspector"]]
    widths = [settings.channels_width or CHANNELS_WIDTH, settings.inspector_width or INSPECTOR_WIDTH]
    widths[0] = max(widths[0], window.tree.minimumSizeHint().width())
    window.resizeDocks(panels, widths, Qt.Orientation.Horizontal)


def keep_state(window: "MainWindow") -> None:
    """Remember what the next start needs."""
    settings = window.settings
    settings.geometry = window.saveGeometry()
    settings.layout = window.saveState(LAYOUT_VERSION)
    for name in ("channels", "inspector"):
        dock = window.docks[name]
        if dock.isVisible() and not dock.isFloating():
            setattr(settings, f"{name}_width", dock.width())
    for name in ("snap", "reorder", "loop"):
        setattr(settings, name, getattr(window.session, name))
    settings.sync()
