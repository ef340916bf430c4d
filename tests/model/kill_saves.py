"""A program for test_saving_faults: kills a process that saves, again and again, and looks at what is on the disk.

The child saves version 1, 2, 3, ... and tells each number once it was told that it is saved.
"""

import os
import random
import signal
import struct
import sys
import time
from pathlib import Path

from model.saving import save_atomic, sweep_temp


def version(number: int) -> bytes:
    """A file that shows whether it is whole, and which one it is."""
    return b"version %08d\n" % number * 5000


def save_for_ever(path: Path, told: int) -> None:
    """Saves newer and newer versions; *told* is the pipe for the numbers of those confirmed."""
    number = 1
    while True:
        number += 1
        save_atomic(path, version(number))
        os.write(told, struct.pack("<Q", number))


def trial(path: Path, seconds: float) -> str:
    """What is wrong with the file after a save was killed, empty if nothing is; then temporary files are swept."""
    path.write_bytes(version(1))
    heard, told = os.pipe()
    child = os.fork()
    if child == 0:
        save_for_ever(path, told)
    os.close(told)
    time.sleep(seconds)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    with os.fdopen(heard, "rb") as pipe:
        numbers = pipe.read()
    confirmed = struct.unpack("<Q", numbers[-8:])[0] if numbers else 1
    lines = path.read_bytes().splitlines() if path.exists() else []
    sweep_temp(path)
    left = [entry.name for entry in path.parent.iterdir() if entry != path]
    if len(lines) != 5000 or len(set(lines)) != 1:
        return f"torn: {len(lines)} lines, {len(set(lines))} versions"
    if int(lines[0].split()[1]) < confirmed:
        return f"lost: {lines[0]!r}, but {confirmed} was confirmed"
    return f"left behind: {left}" if left else ""


if __name__ == "__main__":
    chance = random.Random(int(sys.argv[3]))
    for _ in range(int(sys.argv[2])):
        wrong = trial(Path(sys.argv[1]), chance.uniform(0.0005, 0.012))
        if wrong:
            sys.exit(wrong)
