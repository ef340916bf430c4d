"""The quick imports leave Qt, numpy and pyqtgraph as they are for everybody else."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
START = "from app.quick_start import import_pyqtgraph, is_unused; import PySide6.QtWidgets as own, sys; "


def printed(code: str) -> str:
    """What a new Python prints, or what it fails with."""
    done = subprocess.run([sys.executable, "-c", START + code], cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stdout.strip() or done.stderr


def test_qt_lists_all_its_names_after_the_quick_import() -> None:
    names = printed("names = dir(own); import_pyqtgraph(); print(dir(own) == names, len(names) > 200)")
    assert names == "True True"


def test_pyqtgraph_has_every_class_of_qt_under_its_own_name() -> None:
    told = printed(
        "import_pyqtgraph(); import pyqtgraph as pg; "
        "print(all(getattr(pg.QtWidgets, name) is getattr(own, name) for name in dir(own) if name[0] == 'Q'))"
    )
    assert told == "True"


def test_what_was_left_out_of_pyqtgraph_can_be_had_later() -> None:
    told = printed(
        "import_pyqtgraph(); import pyqtgraph as pg; left = [name for name in sys.modules if is_unused(name)]; "
        "import pyqtgraph.widgets.SpinBox, pyqtgraph.exporters, PySide6.QtTest; "
        "print(left, *(getattr(pg, name).__name__ for name in "
        "('ROI', 'SpinBox', 'PlotWidget', 'ViewBox', 'SRTTransform', 'GroupBox')))"
    )
    assert told == "[] ROI SpinBox PlotWidget ViewBox SRTTransform GroupBox"
    assert printed("import_pyqtgraph(); import pyqtgraph as pg; print(pg.QAPP)") == "None"
    assert "has no attribute 'Nonsense'" in printed("import_pyqtgraph(); import pyqtgraph as pg; pg.Nonsense")


def test_a_pyqtgraph_that_needs_what_is_left_out_is_imported_whole() -> None:
    told = printed(
        "import app.quick_start as quick; quick.Nothing.exec_module = lambda self, module: None; import_pyqtgraph(); "
        "import pyqtgraph as pg; "
        "print(pg.AxisItem.__name__, pg.PlotWidget.__name__, pg.ROI.__name__)"
    )
    assert told == "AxisItem PlotWidget ROI"


def test_the_graph_comes_without_the_parts_of_pyqtgraph_that_no_view_needs() -> None:
    told = printed(
        "import_pyqtgraph(); import widgets.curve_view; "
        "print([name for name in sys.modules if is_unused(name) or 'parametertree' in name or 'QtTest' in name])"
    )
    assert told == "[]"


def test_numpy_comes_without_its_words_of_help_which_can_be_had_later() -> None:
    told = printed(
        "import_pyqtgraph(); import numpy; none = numpy.ndarray.sum.__doc__; "
        "import numpy._core._add_newdocs; print(none, 'axis' in numpy.ndarray.sum.__doc__)"
    )
    assert told == "None True"
