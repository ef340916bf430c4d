"""Player: plays a clip in sequence with cursors of its own, so that many players can share one clip."""

import numpy as np

from model.clip import Clip
from model.hermite import Floats


class Player:
    """Gives the pose of a clip at one time after the other; it notices edits by itself."""

    def __init__(self, clip: Clip) -> None:
        self.clip = clip

    def pose(self, time: float) -> Floats:
        """The values of all channels at *time*, in the order of clip.channels."""
        return np.array([channel.value(time) for channel in self.clip.channels])
