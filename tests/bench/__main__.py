"""python -m tests.bench [PART ...] [--write]: one table of speeds, each beside a peer or a floor from the same run."""

import argparse
import os
import platform
import sys
from datetime import date
from importlib import import_module
from importlib.metadata import version
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ["QT_NO_GUI_THREADPOOL"] = "1"  # before Qt paints; as main.py does

from tests.bench.table import Line, as_markdown, as_text

PARTS = ("evaluating", "editing", "files", "picture", "sharp", "window", "starting")
PAGE = Path(__file__).resolve().parents[2] / "docs" / "performance.md"
PACKAGES = ("numpy", "scipy", "usd-core", "pyqtgraph", "PySide6-Essentials")
HEAD = """# Performance

Written by `make bench ARGS=--write`. Where there is a peer or a floor, the figure stands beside it, from the same run
and in turn with it; durations are medians, or 99th percentiles where the line says so. A step of a drag, pan or zoom
lasts from the event to the end of all the painting that it asks for, in a view of 1600 x 900. At ratio 2 and by X
events it is measured in processes of their own; by X events on Xvfb with openbox, from the arrival of the event to the
end of its paint, 8 ms apart. Load and save are what the window does: a save is written, forced onto the disk, read back
and compared before it takes the place of the old file; a write leaves out reading it back. Starts are whole processes,
with kept bytecode, and the times of window and picture are what they tell themselves.
"""
# What stands from here on in the page is written by hand, and stays when the table is written anew.
BY_HAND = "## What is lost, and why"


def machine() -> str:
    """The date, the processor and the versions of what was measured."""
    processor = platform.processor() or platform.machine()
    cpu_info = Path("/proc/cpuinfo")
    if cpu_info.exists():
        names = [
            line.partition(":")[2].strip()
            for line in cpu_info.read_text().splitlines()
            if line.startswith("model name")
        ]
        processor = f"{len(names)} x {names[0]}" if names else processor
    versions = ", ".join(f"{name} {version(name)}" for name in PACKAGES)
    screen = os.environ["QT_QPA_PLATFORM"]
    system = f"{platform.system()}, Python {platform.python_version()}"
    return f"{date.today()}, {processor}, {system}, {versions}, Qt on {screen}"


def by_hand() -> str:
    """The part of the page that this program does not write."""
    _, found, text = PAGE.read_text(encoding="utf-8").partition(BY_HAND) if PAGE.exists() else ("", "", "")
    return f"\n{found}{text}" if found else ""


def main() -> int:
    """Run the parts and print the table."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench", description=__doc__)
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"of {', '.join(PARTS)}; all by default")
    parser.add_argument("--write", action="store_true", help=f"write the table to docs/{PAGE.name} too")
    options = parser.parse_args()
    unknown = set(options.parts) - set(PARTS)
    if unknown:
        parser.error(f"no such part: {', '.join(sorted(unknown))}")
    if {"picture", "sharp"} & set(options.parts or PARTS):
        from PySide6.QtWidgets import QApplication

        application = QApplication.instance() or QApplication([])
        assert application is not None
    lines: list[Line] = []
    words: list[str] = []
    for part in options.parts or PARTS:
        print(f"... {part}", file=sys.stderr, flush=True)
        module = import_module(f"tests.bench.{part}")
        if part == "window":
            found = module.on_a_screen()
            words += [found] if isinstance(found, str) else []
            lines += [] if isinstance(found, str) else found
            continue
        lines += module.run()
        if part == "editing":
            words += module.memory()
    print(machine(), as_text(lines), *words, sep="\n")
    if options.write:
        PAGE.parent.mkdir(exist_ok=True)
        page = [HEAD, machine() + ".\n", as_markdown(lines), "", *(f"- {word}" for word in words)]
        PAGE.write_text("\n".join(page) + "\n" + by_hand(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
