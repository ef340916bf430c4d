"""Edits: verbs over a selection. Each reads the clip and returns the changes to make; only the document makes them.

Locked channels are left out, and a selected key that is gone raises KeyGoneError.
"""

from model.edits.keys import delete, insert, insert_key, key_all
from model.edits.moving import move, nudge, scale, set_columns, set_field
from model.edits.pasting import duplicate, paste
from model.edits.settings import set_extrapolation, set_setting
from model.edits.tangents import break_tangents, set_rule, set_slope, unify_tangents

__all__ = [
    "break_tangents",
    "delete",
    "duplicate",
    "insert",
    "insert_key",
    "key_all",
    "move",
    "nudge",
    "paste",
    "scale",
    "set_columns",
    "set_extrapolation",
    "set_field",
    "set_rule",
    "set_setting",
    "set_slope",
    "unify_tangents",
]
