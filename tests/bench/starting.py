"""From the start of the process to the first picture, against a bare window with a pyqtgraph plot."""

import os
import subprocess
import sys
from pathlib import Path

from tests.bench.table import Line, timed

ROOT = Path(__file__).resolve().parents[2]
BARE = """
import sys
from PySide6.QtWidgets import QApplication, QMainWindow
app = QApplication([])
window = QMainWindow()
window.resize(1400, 860)
{plot}
window.show()
app.processEvents()
"""
PLOT = "import pyqtgraph as pg; plot = pg.PlotWidget(); plot.plot([0, 1, 2], [0, 1, 0]); window.setCentralWidget(plot)"


def _run(*arguments: str) -> None:
    environment = {**os.environ, "QT_NO_GUI_THREADPOOL": "1"}
    subprocess.run([sys.executable, *arguments], cwd=ROOT, env=environment, check=True, capture_output=True)


def run() -> list[Line]:
    """All figures of the start; whole processes, so their ends are in both sides."""
    sample = str(ROOT / "resources" / "samples" / "bounce.hermite")
    taken = timed(
        {
            "ours": lambda: _run("main.py", "--check", sample),
            "bare": lambda: _run("-c", BARE.format(plot=PLOT)),
            "info": lambda: _run("main.py", "info", sample),
            "evaluate": lambda: _run("main.py", "evaluate", sample, "--times", "0.5"),
        },
        rounds=7,
    )
    return [
        Line("start, first picture, end", taken["ours"].median, "PySide6 + pyqtgraph window", taken["bare"].median),
        Line("hermite info, a small file", taken["info"].median, most=0.35),
        Line("hermite evaluate, a small file", taken["evaluate"].median, most=0.35),
    ]
