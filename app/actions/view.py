"""Actions of the View menu: what part of the graph is seen, panels and appearance."""

from functools import partial
from typing import TYPE_CHECKING

from app.actions.row import KEYS, Action, Need

if TYPE_CHECKING:
    from app.main_window import MainWindow

APPEARANCES = {"system": "Like the &System", "dark": "&Dark", "light": "&Light"}
ZOOM_STEP = 1.25
PAN_STEP = 0.1  # of the graph's width or height


def _zoom(factor: float, window: "MainWindow") -> None:
    window.view.zoom(factor, factor, window.view.plot_rect.center())


def _pan(across: float, up: float, window: "MainWindow") -> None:
    rect = window.view.plot_rect
    window.view.pan_pixels(across * rect.width(), up * rect.height())


def _center_playhead(window: "MainWindow") -> None:
    view = window.view
    seen = view.view_range
    d_time = window.session.playhead - (seen.t0 + seen.t1) / 2
    view.set_view(seen._replace(t0=seen.t0 + d_time, t1=seen.t1 + d_time))


def _toggle_full_screen(window: "MainWindow") -> None:
    if window.isFullScreen():
        window.showNormal()
    else:
        window.showFullScreen()


def _set_appearance(wanted: str, window: "MainWindow") -> None:
    window.set_appearance(wanted)


def _toggle_dock(name: str, window: "MainWindow") -> None:
    dock = window.docks[name]
    dock.setVisible(not dock.isVisible())


VIEW_ACTIONS = (
    Action(
        id="view.frame_selection",
        menu="View",
        label="&Frame Selection",
        function=lambda w: w.view.frame_selection(w.in_hand.channels),
        shortcuts=("F",),
        icon="frame-selection",
        tip="Fit the selected keys into the graph; with none selected the chosen channels, else every shown curve",
        needs=(KEYS,),
        in_mid_drag=True,
    ),
    Action(
        id="view.frame_all",
        menu="View",
        label="Frame &All",
        function=lambda w: w.view.frame_all(),
        shortcuts=("A", "Home"),
        icon="frame-all",
        tip="Fit every shown curve into the graph",
        in_mid_drag=True,
    ),
    Action(
        id="view.center_playhead",
        menu="View",
        label="&Center Playhead",
        function=_center_playhead,
        shortcuts=("Shift+A",),
        tip="Move the view so that the playhead is in its middle",
        in_mid_drag=True,
    ),
    Action(
        id="view.back",
        menu="View",
        label="&Back",
        function=lambda w: w.view.view_back(),
        shortcuts=("Alt+Left",),
        icon="view-back",
        tip="Go back to where the view was before",
        needs=(Need(lambda w: w.view.can_go_back, "the view has not been moved"),),
        begins_group=True,
        in_mid_drag=True,
    ),
    Action(
        id="view.forward",
        menu="View",
        label="F&orward",
        function=lambda w: w.view.view_forward(),
        shortcuts=("Alt+Right",),
        icon="view-forward",
        tip="Undo going back",
        needs=(Need(lambda w: w.view.can_go_forward, "the view has not gone back"),),
        in_mid_drag=True,
    ),
    *(
        Action(
            id=f"view.{name}",
            menu="View/Zoom and Pan",
            label=label,
            function=function,
            shortcuts=(shortcut,),
            tip=tip,
            in_mid_drag=True,
        )
        for name, label, function, shortcut, tip in (
            ("zoom_in", "Zoom &In", partial(_zoom, ZOOM_STEP), "Ctrl++", "See less, larger"),
            ("zoom_out", "Zoom &Out", partial(_zoom, 1 / ZOOM_STEP), "Ctrl+-", "See more, smaller"),
            ("pan_left", "See Earlier", partial(_pan, PAN_STEP, 0.0), "Ctrl+Shift+Left", "Move the view back in time"),
            ("pan_right", "See Later", partial(_pan, -PAN_STEP, 0.0), "Ctrl+Shift+Right", "Move the view on in time"),
            ("pan_up", "See Higher", partial(_pan, 0.0, PAN_STEP), "Ctrl+Shift+Up", "Move the view to higher values"),
            (
                "pan_down",
                "See Lower",
                partial(_pan, 0.0, -PAN_STEP),
                "Ctrl+Shift+Down",
                "Move the view to lower values",
            ),
        )
    ),
    *(
        Action(
            id=f"view.panel.{name}",
            menu="View/Panels",
            label=label,
            function=partial(_toggle_dock, name),
            tip=f"Show or hide the {what}",
            checked_when=partial(lambda name, w: not w.docks[name].isHidden(), name),
        )
        for name, label, what in (
            ("channels", "&Channels", "tree of channels"),
            ("inspector", "&Inspector", "numbers of the selected keys and their channel"),
            ("history", "Undo &History", "list of steps that can be taken back"),
        )
    ),
    Action(
        id="view.reset_layout",
        menu="View/Panels",
        label="&Reset Layout",
        function=lambda w: w.reset_layout(),
        tip="Put panels and toolbar back where they were at first",
        begins_group=True,
    ),
    *(
        Action(
            id=f"view.appearance.{name}",
            menu="View/Appearance",
            label=label,
            function=partial(_set_appearance, name),
            tip="Follow the desktop's dark or light setting" if name == "system" else f"Always {name}",
            checked_when=partial(lambda name, w: w.settings.appearance == name, name),
        )
        for name, label in APPEARANCES.items()
    ),
    Action(
        id="view.full_screen",
        menu="View",
        label="F&ull Screen",
        function=_toggle_full_screen,
        shortcuts=("F11",),
        tip="Use the whole screen",
        checked_when=lambda w: w.isFullScreen(),
        begins_group=True,
    ),
)
