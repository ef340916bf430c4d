"""ACTIONS: everything the program can be told to do, in the order of the menus."""

from app.actions.channel import CHANNEL_ACTIONS
from app.actions.curve import CURVE_ACTIONS
from app.actions.edit import EDIT_ACTIONS
from app.actions.file import FILE_ACTIONS
from app.actions.help import HELP_ACTIONS
from app.actions.key import KEY_ACTIONS
from app.actions.play import PLAY_ACTIONS
from app.actions.row import Action
from app.actions.tangent import TANGENT_ACTIONS
from app.actions.view import VIEW_ACTIONS

ACTIONS: tuple[Action, ...] = (
    *FILE_ACTIONS,
    *EDIT_ACTIONS,
    *VIEW_ACTIONS,
    *KEY_ACTIONS,
    *TANGENT_ACTIONS,
    *CHANNEL_ACTIONS,
    *CURVE_ACTIONS,
    *PLAY_ACTIONS,
    *HELP_ACTIONS,
)
