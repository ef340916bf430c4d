"""Hermite: opens the window on a clip, or runs a command without one."""

import sys
from time import perf_counter

STARTED = perf_counter()

if sys.version_info < (3, 12):  # said here, in words every Python 3 can read, before anything newer is imported
    sys.stderr.write(
        "Hermite needs Python 3.12 or newer, this is %d.%d (%s): start with make run, or with uv run main.py\n"
        % (sys.version_info[0], sys.version_info[1], sys.executable)
    )
    sys.exit(2)

import argparse
import gc
import os
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

# Installed, this file is hermite_editor/__main__.py and the rooms lie beside it, under the same names as in a checkout.
sys.path.insert(0, str(Path(__file__).resolve().parent))

from app import __version__

DESCRIPTION = """\
Opens the editor on a clip. With the name of a command first, runs it without a window:
  hermite info FILE          what is in a clip          hermite evaluate FILE ...   its values as CSV
  hermite convert IN OUT     to another format          hermite render FILE -o PNG  its picture
Each tells more with --help. A file that is called like a command opens as ./info.
"""


class OneSentence(argparse.ArgumentParser):
    """A parser whose refusal is one sentence instead of a page."""

    def error(self, message: str) -> NoReturn:
        """End with it."""
        self.exit(2, f"hermite: {message} (see hermite --help)\n")


def parser() -> argparse.ArgumentParser:
    """The options of the window."""
    result = OneSentence(prog="hermite", description=DESCRIPTION, formatter_class=argparse.RawDescriptionHelpFormatter)
    result.add_argument("file", nargs="?", metavar="FILE", help="the clip to open, a sample if left out")
    result.add_argument("--skel", metavar="FILE", help="a skeleton whose joints name the channels of a course .anim")
    result.add_argument("--check", action="store_true", help="open, draw one picture, tell versions and times, close")
    result.add_argument("--version", action="version", version=f"hermite {__version__}")
    return result


def command_of(words: Sequence[str]) -> bool:
    """Whether these words call a command; a path (with a dot, a slash or a dash in front) is never looked up."""
    if not words or not words[0].isalpha():
        return False
    from app.commands import COMMANDS

    return words[0] in COMMANDS


def main(argv: Sequence[str] | None = None) -> int:
    """Runs the program: 0 when all went well, 2 after one sentence on stderr when it could not or was stopped."""
    try:
        return run(sys.argv[1:] if argv is None else list(argv))
    except KeyboardInterrupt:  # while there is nobody yet who would close a window or take back what was begun
        print("stopped", file=sys.stderr)
        return 2


def run(words: list[str]) -> int:
    """The same with these words of the command line."""
    # Qt's threads for drawing cost an empty plot 17 to 45 ms a picture instead of 2; read once, when Qt is loaded.
    os.environ.setdefault("QT_NO_GUI_THREADPOOL", "1")
    if command_of(words):
        from app.commands import run as run_command

        return run_command(words)
    if words and words[0].isalpha() and not os.path.exists(words[0]):
        from app.commands import COMMANDS

        print(f"There is no file and no command {words[0]!r}; the commands are {', '.join(COMMANDS)}.", file=sys.stderr)
        return 2
    options = parser().parse_args(words)

    from app.preflight import window_problem

    problem = window_problem()
    if problem:
        print(problem, file=sys.stderr)
        return 2
    gc.disable()  # what is loaded now stays; app.start turns it on again
    from app.quick_qt import import_qt

    import_qt()
    if options.check:
        from app.check import run_check

        return run_check(options.file, options.skel, STARTED)
    from app.main_window import run_window

    return run_window(options.file, options.skel)


if __name__ == "__main__":
    sys.exit(main())
