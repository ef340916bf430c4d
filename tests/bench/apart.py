"""A part of the table that needs an environment or a screen of its own: run in another process, its lines read back."""

import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path

from tests.bench.table import Line

ROOT = Path(__file__).resolve().parents[2]
NONE: Mapping[str, str] = {}
NOT_RUN = 77  # what tools/screen.sh ends with where it has no screen to offer


def lines_of(module: str, environment: Mapping[str, str] = NONE, before: Sequence[str] = ()) -> list[Line] | str:
    """What `run` of a module of this package returns in a process with these variables, behind the words *before*.

    A sentence instead if it could not be run here.
    """
    command = [*before, sys.executable, "-m", "tests.bench.apart", module]
    ended = subprocess.run(command, cwd=ROOT, env={**os.environ, **environment}, capture_output=True, text=True)
    if ended.returncode == NOT_RUN:
        return ended.stderr.strip()
    if ended.returncode:
        raise RuntimeError(f"{' '.join(command)} ended with {ended.returncode}: {ended.stderr[-2000:]}")
    return [Line(*fields) for fields in json.loads(ended.stdout.splitlines()[-1])]


if __name__ == "__main__":
    from PySide6.QtWidgets import QApplication

    application = QApplication([])
    print(json.dumps(import_module(f"tests.bench.{sys.argv[1]}").run()))
