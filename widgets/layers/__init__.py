"""LAYERS: what one picture of the curves is made of, from the ground up; each file here draws one thing."""

from collections.abc import Callable, Sequence
from enum import Enum, auto
from typing import Final, NamedTuple

from PySide6.QtGui import QPainter

from widgets.layers import curves, extrapolation, grid, handles, keys, labels, overlays, playhead, selected_keys
from widgets.stage import Stage
from widgets.traces import Trace

type Draw = Callable[[QPainter, Stage, Sequence[Trace], float, float], None]


class Plane(Enum):
    """Where a layer's pixels are kept."""

    GROUND = auto()  # in the backdrop, at once
    RESTING = auto()  # in the backdrop, trace by trace: these may be many
    LIVE = auto()  # painted at every step


class Layer(NamedTuple):
    """One row: *draw* paints the given traces from x0 to x1 in screen pixels."""

    name: str
    plane: Plane
    draw: Draw
    # Of a resting layer: how many traces are drawn between two looks at the clock; together they are quicker.
    together: int = 10


LAYERS: Final = (
    Layer("ground", Plane.GROUND, grid.draw_ground),
    Layer("grid", Plane.GROUND, grid.draw_grid),
    Layer("resting extrapolation", Plane.RESTING, extrapolation.draw_extrapolation, together=50),
    Layer("resting curves", Plane.RESTING, curves.draw_curves),
    Layer("resting keys", Plane.RESTING, keys.draw_keys),
    Layer("live extrapolation", Plane.LIVE, extrapolation.draw_extrapolation),
    Layer("live curves", Plane.LIVE, curves.draw_curves),
    Layer("hovered curve", Plane.LIVE, overlays.draw_hovered_curve),
    Layer("live keys", Plane.LIVE, keys.draw_keys),
    Layer("covered keys", Plane.LIVE, keys.draw_covered_keys),
    Layer("names", Plane.LIVE, labels.draw_labels),
    Layer("handles", Plane.LIVE, handles.draw_handles),
    Layer("selected keys", Plane.LIVE, selected_keys.draw_selected_keys),
    Layer("hover", Plane.LIVE, overlays.draw_hover),
    Layer("insert preview", Plane.LIVE, overlays.draw_insert_preview),
    Layer("hint", Plane.LIVE, labels.draw_hint),
    Layer("box", Plane.LIVE, overlays.draw_box),
    Layer("frame", Plane.LIVE, overlays.draw_frame),
    Layer("playhead", Plane.LIVE, playhead.draw_playhead),
)
