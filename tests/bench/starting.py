"""From the start of the process to the frame and to the first picture, against bare windows with and without a plot."""

import os
import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from time import perf_counter, time

import numpy as np

from tests.bench.table import Line, timed

ROOT = Path(__file__).resolve().parents[2]
STARTS = 9
BARE = """
import sys, time
from PySide6.QtWidgets import QApplication, QMainWindow
app = QApplication([])
window = QMainWindow()
window.resize(1400, 860)
{plot}
window.show()
app.processEvents()
print(time.time() - float(sys.argv[1]))
"""
PLOT = "import pyqtgraph as pg; plot = pg.PlotWidget(); plot.plot([0, 1, 2], [0, 1, 0]); window.setCentralWidget(plot)"
SAMPLE = str(ROOT / "resources" / "samples" / "bounce.hermite")
PICTURE, FRAME = re.compile(r"first picture (\d+\.\d+) s"), re.compile(r"frame (\d+\.\d+) s")


def _environment() -> Mapping[str, str]:
    """This one, but with kept bytecode: without it every start compiles what it imports."""
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return {**kept, "QT_NO_GUI_THREADPOOL": "1"}


def _run(*arguments: str) -> str:
    command = [sys.executable, *arguments]
    ended = subprocess.run(command, cwd=ROOT, env=_environment(), check=True, capture_output=True, text=True)
    return ended.stdout


class Starts:
    """What windows that were started in turn said of when they were seen, and how long they took in all: seconds."""

    def __init__(self) -> None:
        self.seconds: dict[str, list[float]] = {}

    def _note(self, name: str, seconds: float) -> None:
        self.seconds.setdefault(name, []).append(seconds)

    def ours(self) -> None:
        """The program with a sample, up to its first picture."""
        start = perf_counter()
        said = _run("main.py", "--check", SAMPLE)
        self._note("ours in all", perf_counter() - start)
        for name, pattern in (("picture", PICTURE), ("frame", FRAME)):
            found = pattern.search(said)
            if found is None:
                raise RuntimeError(f"hermite --check does not tell the time of the {name}: {said}")
            self._note(name, float(found[1]))

    def bare(self, name: str, plot: str) -> None:
        """A window, with or without a plot."""
        start = perf_counter()
        self._note(name, float(_run("-c", BARE.format(plot=plot), str(time()))))
        self._note(f"{name} in all", perf_counter() - start)

    def median(self, name: str) -> float:
        """Of all rounds but the first, which fills the caches."""
        return float(np.median(self.seconds[name][1:]))


def run() -> list[Line]:
    """All figures of the start."""
    starts = Starts()
    for _ in range(STARTS + 1):
        starts.ours()
        starts.bare("plot", PLOT)
        starts.bare("window", "")
    commands = timed(
        {
            "info": lambda: _run("main.py", "info", SAMPLE),
            "evaluate": lambda: _run("main.py", "evaluate", SAMPLE, "--times", "0.5"),
        },
        rounds=7,
    )
    of = starts.median
    return [
        Line("start to the first window", of("frame"), "PySide6 window", of("window"), most=0.25),
        Line("start to the first picture", of("picture"), "PySide6 + pyqtgraph window", of("plot"), 1.15, 0.7),
        Line("start, first picture, end", of("ours in all"), "PySide6 + pyqtgraph window", of("plot in all")),
        Line("hermite info, a small file", commands["info"].median, most=0.35),
        Line("hermite evaluate, a small file", commands["evaluate"].median, most=0.35),
    ]
