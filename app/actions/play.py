"""Actions of the Play menu: the playhead and the range that is played."""

from typing import TYPE_CHECKING

from app.actions.row import KEYS, SELECTED_KEYS, Action
from model.document import Setting

if TYPE_CHECKING:
    from app.main_window import MainWindow


def _set_range(window: "MainWindow", start: float, end: float) -> None:
    start, end = min(start, end), max(start, end)
    window.document.do(
        f"Set range to {start:.6g} … {end:.6g} s",
        lambda clip: [Setting(clip, "start", clip.start, start), Setting(clip, "end", clip.end, end)],
    )


def _range_to_extent(window: "MainWindow") -> None:
    extent = window.document.clip.extent()
    if extent is not None:
        _set_range(window, *extent)


def _range_to_selection(window: "MainWindow") -> None:
    selection = window.session.selection
    times = [channel.keys_of(selection.ids(channel))["time"] for channel in selection.channels]
    _set_range(window, min(float(t[0]) for t in times), max(float(t[-1]) for t in times))


PLAY_ACTIONS = (
    Action(
        id="play.toggle",
        menu="Play",
        label="&Play / Pause",
        function=lambda w: w.transport.toggle_play(),
        shortcuts=("Space",),
        icon="play",
        tip="Run the playhead through the range in real time",
        checked_when=lambda w: w.session.playing,
        in_mid_drag=True,
    ),
    Action(
        id="play.stop",
        menu="Play",
        label="&Stop",
        function=lambda w: w.transport.stop(),
        shortcuts=("Shift+Space",),
        icon="stop",
        tip="Stop and go back to where playing began; when stopped already, to the start of the range",
        in_mid_drag=True,
    ),
    Action(
        id="play.loop",
        menu="Play",
        label="&Loop",
        function=lambda w: w.transport.toggle_loop(),
        icon="loop",
        tip="Begin again at the end of the range",
        checked_when=lambda w: w.session.loop,
        in_mid_drag=True,
    ),
    Action(
        id="play.previous_frame",
        menu="Play",
        label="Previous Frame",
        function=lambda w: w.transport.step_frame(-1),
        shortcuts=("Left",),
        icon="previous-frame",
        tip="Move the playhead one frame back",
        begins_group=True,
    ),
    Action(
        id="play.next_frame",
        menu="Play",
        label="Next Frame",
        function=lambda w: w.transport.step_frame(+1),
        shortcuts=("Right",),
        icon="next-frame",
        tip="Move the playhead one frame on",
    ),
    Action(
        id="play.previous_key",
        menu="Play",
        label="Previous Key",
        function=lambda w: w.transport.step_key(-1),
        shortcuts=("Ctrl+Left",),
        icon="previous-key",
        tip="Move the playhead to the nearest earlier key of the shown channels",
        needs=(KEYS,),
    ),
    Action(
        id="play.next_key",
        menu="Play",
        label="Next Key",
        function=lambda w: w.transport.step_key(+1),
        shortcuts=("Ctrl+Right",),
        icon="next-key",
        tip="Move the playhead to the nearest later key of the shown channels",
        needs=(KEYS,),
    ),
    Action(
        id="play.start",
        menu="Play",
        label="To Start of Range",
        function=lambda w: w.transport.to_start(),
        shortcuts=("Ctrl+Home",),
        icon="first",
        tip="Move the playhead to the start of the range",
        begins_group=True,
    ),
    Action(
        id="play.end",
        menu="Play",
        label="To End of Range",
        function=lambda w: w.transport.to_end(),
        shortcuts=("Ctrl+End",),
        icon="last",
        tip="Move the playhead to the end of the range",
    ),
    Action(
        id="play.range_start_here",
        menu="Play",
        label="Range Starts at Playhead",
        function=lambda w: _set_range(w, w.session.playhead, w.document.clip.end),
        tip="Let the range begin where the playhead is",
        begins_group=True,
    ),
    Action(
        id="play.range_end_here",
        menu="Play",
        label="Range Ends at Playhead",
        function=lambda w: _set_range(w, w.document.clip.start, w.session.playhead),
        tip="Let the range end where the playhead is",
    ),
    Action(
        id="play.range_selection",
        menu="Play",
        label="Range from Selected Keys",
        function=_range_to_selection,
        tip="Let the range reach from the first to the last selected key",
        needs=(SELECTED_KEYS,),
    ),
    Action(
        id="play.range_all",
        menu="Play",
        label="Range from All Keys",
        function=_range_to_extent,
        tip="Let the range reach from the first to the last key of the clip",
        needs=(KEYS,),
    ),
)
