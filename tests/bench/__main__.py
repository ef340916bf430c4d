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

PARTS = ("evaluating", "editing", "files", "picture", "starting")
PAGE = Path(__file__).resolve().parents[2] / "docs" / "performance.md"
PACKAGES = ("numpy", "scipy", "usd-core", "pyqtgraph", "PySide6-Essentials")
HEAD = """# Performance

Written by `make bench ARGS=--write`. Every figure stands beside a peer or a floor that was measured in the same run,
in turn with it; durations are medians, or 99th percentiles where the line says so.
"""


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


def main() -> int:
    """Run the parts and print the table."""
    parser = argparse.ArgumentParser(prog="python -m tests.bench", description=__doc__)
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"of {', '.join(PARTS)}; all by default")
    parser.add_argument("--write", action="store_true", help=f"write the table to docs/{PAGE.name} too")
    options = parser.parse_args()
    unknown = set(options.parts) - set(PARTS)
    if unknown:
        parser.error(f"no such part: {', '.join(sorted(unknown))}")
    if {"picture", "starting"} & set(options.parts or PARTS):
        from PySide6.QtWidgets import QApplication

        application = QApplication.instance() or QApplication([])
        assert application is not None
    lines: list[Line] = []
    words: list[str] = []
    for part in options.parts or PARTS:
        print(f"... {part}", file=sys.stderr, flush=True)
        module = import_module(f"tests.bench.{part}")
        lines += module.run()
        if part == "editing":
            words += module.memory()
    print(machine(), as_text(lines), *words, sep="\n")
    if options.write:
        PAGE.parent.mkdir(exist_ok=True)
        page = [HEAD, machine() + ".\n", as_markdown(lines), "", *(f"- {word}" for word in words)]
        PAGE.write_text("\n".join(page) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
