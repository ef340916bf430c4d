"""Naming the channels of the clip that is open by the joints of a skeleton."""

from typing import TYPE_CHECKING

from app.clip_file import display_name, read_regular
from model.document import Setting
from model.formats.error import TextError
from model.formats.skel import channel_names, channel_units, joint_names

if TYPE_CHECKING:
    from app.main_window import MainWindow


def name_channels(window: "MainWindow", skeleton: str) -> bool:
    """Name the channels by the joints of the .skel at that path, as one step; False, and said, if they differ."""
    clip = window.document.clip
    try:
        data = read_regular(skeleton)
        joints = joint_names(data)
    except TextError as fault:
        return _refused(window, skeleton, str(fault.in_file(skeleton, data)))
    except OSError as error:
        return _refused(window, skeleton, f"{skeleton}: {error.strerror or error}")
    names, units = channel_names(joints), channel_units(3 + 3 * len(joints))
    if len(names) != len(clip.channels):
        problem = f"it has {len(joints)} joints, that is {len(names)} channels; the clip has {len(clip.channels)}"
        return _refused(window, skeleton, problem)
    window.document.do(
        f"Name channels by {display_name(skeleton)}",
        lambda clip: [
            Setting(channel, field, getattr(channel, field), value)
            for channel, name, unit in zip(clip.channels, names, units, strict=True)
            for field, value in (("name", name), ("unit", unit))
        ],
    )
    return True


def _refused(window: "MainWindow", skeleton: str, problem: str) -> bool:
    window.questions.tell_error(f"{display_name(skeleton)} does not name these channels", problem)
    return False
