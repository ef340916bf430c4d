"""pyqtgraph in a third of the time: without what it does at import that nobody here needs."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from importlib.abc import Loader
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

# The parts of Qt of which pyqtgraph keeps copies under its own name.
MIRRORED = ("QtCore", "QtGui", "QtWidgets")
# Modules that pyqtgraph imports only to offer what is in them: pictures, colour maps, trees, other processes.
ITEMS = """
    ArrowItem BoxplotItem ColorBarItem CurvePoint DateAxisItem ErrorBarItem FillBetweenItem GradientEditorItem
    GradientLegend GraphItem GraphicsLayout GridItem HistogramLUTItem ImageItem IsocurveItem LinearRegionItem
    PColorMeshItem ROI ScaleBar TargetItem UIGraphicsItem VTickGroup
"""
WIDGETS = """
    BusyCursor CheckTable ColorButton ColorMapMenu ColorMapWidget ComboBox DataFilterWidget DataTreeWidget
    DiffTreeWidget FeedbackButton GradientWidget GraphicsLayoutWidget GroupBox HistogramLUTWidget JoystickButton
    LayoutWidget PathButton ProgressDialog RawImageWidget RemoteGraphicsView ScatterPlotWidget SpinBox
    TableWidget TreeWidget ValueLabel VerticalLabel
"""
UNUSED = frozenset(
    [
        *(f"pyqtgraph.graphicsItems.{name}" for name in ITEMS.split()),
        *(f"pyqtgraph.widgets.{name}" for name in WIDGETS.split()),
        "pyqtgraph.colormap",
        "pyqtgraph.imageview",
    ]
)


def import_pyqtgraph() -> None:
    """Import pyqtgraph in a third of the time: without the parts of it that no plot needs, see UNUSED and Mirror.

    Where a later pyqtgraph is put together in another way, it is imported as everybody does.
    """
    if "pyqtgraph" in sys.modules or not _copies_are_empty():
        return
    try:
        with _mirrored(), _left_out():
            import pyqtgraph
        vars(pyqtgraph)["__getattr__"] = _late
    except ImportError:
        for name in [name for name in sys.modules if name.partition(".")[0] == "pyqtgraph"]:
            del sys.modules[name]
        import pyqtgraph


def _copies_are_empty() -> bool:
    spec = find_spec("pyqtgraph")
    folders = spec.submodule_search_locations if spec is not None else None
    if not folders:
        return False
    sources = [Path(folders[0], "Qt", name, "__init__.py") for name in MIRRORED]
    return all(source.is_file() and source.stat().st_size == 0 for source in sources)


def _late(name: str) -> object:
    """What was left out of pyqtgraph and is asked for after all, as by its own dialogs."""
    for module in UNUSED:
        if module.endswith(f".{name}"):
            return getattr(import_module(module), name)
    raise AttributeError(f"module 'pyqtgraph' has no attribute {name!r}")


@contextmanager
def _left_out() -> Iterator[None]:
    """While it lasts, the UNUSED modules of pyqtgraph are empty; afterwards they can be imported as ever."""
    finder = Nothing()
    sys.meta_path.insert(0, finder)
    try:
        yield
    finally:
        sys.meta_path.remove(finder)
        for name in UNUSED:
            if sys.modules.pop(name, None) is not None:
                parent, _, leaf = name.rpartition(".")
                vars(sys.modules[parent]).pop(leaf, None)


class Nothing(Loader):
    """Finds and loads the UNUSED modules, with nothing in them but what is asked for by name."""

    def find_spec(self, name: str, path: object, target: object = None) -> ModuleSpec | None:
        """Only for UNUSED modules, else None."""
        return ModuleSpec(name, self) if name in UNUSED else None

    def exec_module(self, module: ModuleType) -> None:
        """Give the module nothing, and to those who ask for its class by name None."""
        vars(module).update(__all__=(), **dict.fromkeys([module.__name__.rpartition(".")[2]]))


@contextmanager
def _mirrored() -> Iterator[None]:
    """While it lasts, Qt's modules list no names to copy, and those of pyqtgraph ask Qt's for what they lack."""
    originals = [import_module(f"PySide6.{name}") for name in MIRRORED]
    listings = [vars(original).get("__dir__") for original in originals]
    for name, original in zip(MIRRORED, originals, strict=True):
        sys.modules[f"pyqtgraph.Qt.{name}"] = Mirror(f"pyqtgraph.Qt.{name}", original)
        vars(original)["__dir__"] = tuple
    try:
        yield
    finally:
        for original, listing in zip(originals, listings, strict=True):
            if listing is None:
                del vars(original)["__dir__"]
            else:
                vars(original)["__dir__"] = listing


class Mirror(ModuleType):
    """A module that has what was set on it, and beyond that everything that *original* has, when it is asked for.

    pyqtgraph copies all of Qt's 1,500 names, and Qt for Python builds a class when its name is first looked at.
    """

    def __init__(self, name: str, original: ModuleType) -> None:
        super().__init__(name, original.__doc__)
        self.__path__: list[str] = []
        self._original = original

    def __getattr__(self, name: str) -> object:
        value = getattr(self._original, name)
        setattr(self, name, value)
        return value

    def __dir__(self) -> list[str]:
        return sorted({*vars(self), *dir(self._original)})
