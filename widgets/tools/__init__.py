"""TOOLS: what the left button can be told to do in the plot, one row a tool."""

from collections.abc import Callable
from typing import NamedTuple

from widgets.graph import Graph
from widgets.tools.base import Tool
from widgets.tools.retime import RetimeTool
from widgets.tools.scale import ScaleTool
from widgets.tools.select import SelectTool


class ToolRow(NamedTuple):
    """One tool: *name* is what session.tool holds, *icon* a file of resources/icons, *factory* makes it for a view."""

    name: str
    label: str
    icon: str
    shortcut: str
    tip: str
    factory: Callable[[Graph], Tool]


TOOLS = {
    row.name: row
    for row in (
        ToolRow(
            "select", "Select and Move", "select", "W", "Select, move and turn; Ctrl+click inserts a key", SelectTool
        ),
        ToolRow("scale", "Scale", "scale", "R", "Scale the selected keys in time and value", ScaleTool),
        ToolRow("retime", "Retime", "retime", "T", "Stretch keys in time; the other end stays", RetimeTool),
    )
}
