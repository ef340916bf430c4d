"""numpy and pyqtgraph in half the time: without what they do at import that nobody here needs."""

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
# pyqtgraph imports all it has to offer: plots, pictures, colour maps, trees, other processes. We need its view.
UNUSED_ROOMS = ("pyqtgraph.graphicsItems", "pyqtgraph.widgets")
USED = "pyqtgraph.widgets.GraphicsView"
UNUSED = frozenset(
    [
        "pyqtgraph.colormap",
        "pyqtgraph.imageview",
        "pyqtgraph.Qt.OpenGLHelpers",
        # Words of help for what numpy has written in C.
        "numpy._core._add_newdocs",
        "numpy._core._add_newdocs_scalars",
    ]
)
# Parts of Qt that pyqtgraph does without where they are missing.
REFUSED = frozenset(["PySide6.QtOpenGLWidgets", "PySide6.QtTest"])


def is_unused(name: str) -> bool:
    """Whether the module of this name is left out at first."""
    return name in UNUSED or (name.rpartition(".")[0] in UNUSED_ROOMS and name != USED)


def import_pyqtgraph() -> None:
    """Import numpy and pyqtgraph without the parts of them that no view needs, see UNUSED and Mirror.

    Where a later pyqtgraph is put together in another way, both are imported as everybody does.
    """
    if "pyqtgraph" in sys.modules or not _copies_are_empty():
        return
    try:
        with _mirrored(), left_out() as names:
            import pyqtgraph
    except ImportError:
        for name in [name for name in sys.modules if name.partition(".")[0] == "pyqtgraph"]:
            del sys.modules[name]
        import pyqtgraph
    else:
        pyqtgraph.setConfigOption("exitCleanup", False)  # it would tell ViewBox, which is left out
        own = vars(pyqtgraph)
        for leaf in {name.rpartition(".")[2] for name in names} & own.keys():
            if own[leaf] is None:
                del own[leaf]
        own["__getattr__"] = _late


def _copies_are_empty() -> bool:
    spec = find_spec("pyqtgraph")
    folders = spec.submodule_search_locations if spec is not None else None
    if not folders:
        return False
    sources = [Path(folders[0], "Qt", name, "__init__.py") for name in MIRRORED]
    return all(source.is_file() and source.stat().st_size == 0 for source in sources)


def _late(name: str) -> object:
    """What was left out of pyqtgraph and is asked for after all, as by its own dialogs."""
    for room in ("pyqtgraph", *UNUSED_ROOMS):
        if is_unused(f"{room}.{name}") and find_spec(f"{room}.{name}") is not None:
            return getattr(import_module(f"{room}.{name}"), name)
    raise AttributeError(f"module 'pyqtgraph' has no attribute {name!r}")


@contextmanager
def left_out() -> Iterator[list[str]]:
    """While it lasts, modules that are not used are empty; later they can be imported as ever. Lists their names."""
    finder = Nothing()
    sys.meta_path.insert(0, finder)
    try:
        yield finder.found
    finally:
        sys.meta_path.remove(finder)
        for name in finder.found:
            del sys.modules[name]
            parent, _, leaf = name.rpartition(".")
            vars(sys.modules[parent]).pop(leaf, None)


class Nothing(Loader):
    """Finds and loads modules that are not used, with nothing in them but what is asked for by name."""

    def __init__(self) -> None:
        self.found: list[str] = []

    def find_spec(self, name: str, path: object, target: object = None) -> ModuleSpec | None:
        """Only for modules that are not used, else None."""
        if name in REFUSED:
            raise ModuleNotFoundError(name)
        return ModuleSpec(name, self) if is_unused(name) else None

    def exec_module(self, module: ModuleType) -> None:
        """Give the module nothing, and to those who ask for its class by name None."""
        self.found.append(module.__name__)
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
