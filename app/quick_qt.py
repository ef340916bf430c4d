"""Qt for Python in half the time: without the two things it does at import that nobody here needs."""

import builtins
import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from types import CodeType
from typing import Any

KNOWN = "6.12"
# Modules inside Qt for Python that put the signatures of functions into words, for errors, help and stubs. It keeps no
# bytecode of them: compiled anew at every start, they are a fifth of the time to the first frame.
WORDING = frozenset(
    f"shibokensupport/signature/{name}.py"
    for name in ("mapping", "parser", "layout", "errorhandler", "lib/tool", "lib/enum_sig", "lib/pyi_generator")
)
# What stands in for one of them until something in it is asked for; a function that Qt for Python picks out of the
# names of mapping, without asking, is there from the start.
STAND_IN = """
def __getattr__(name):
    import sys
    del globals()["__getattr__"], globals()["update_mapping"]
    exec(compile({source!r}, {file!r}, "exec"), globals())
    return getattr(sys.modules[__name__], name)

def update_mapping():
    return __getattr__("update_mapping")()
"""


def import_qt() -> None:
    """Import Qt for Python; a version that is not KNOWN to be put together like this as everybody imports it."""
    with _wording_put_off():
        import PySide6.QtCore  # noqa: F401
    _import_plainly()


def _is_known() -> bool:
    spec = find_spec("shiboken6")
    folders = spec.submodule_search_locations if spec is not None else None
    if not folders:
        return False
    config = Path(folders[0], "_config.py")
    return config.is_file() and f'soversion = "{KNOWN}"' in config.read_text(encoding="utf-8")


@contextmanager
def _wording_put_off() -> Iterator[None]:
    """While it lasts, a module of WORDING is compiled to its stand-in."""
    # One of them reads that, and must do so in time; Qt for Python itself sets it to True for its children.
    if os.environ.get("PYSIDE6_OPTION_PYTHON_ENUM", "True") != "True" or not _is_known():
        yield
        return
    original, left = builtins.compile, set(WORDING)

    def compile_(source: Any, file: Any, *more: Any, **options: Any) -> CodeType:
        if file in left:
            left.discard(file)
            source = STAND_IN.format(source=source, file=file)
        code: CodeType = original(source, file, *more, **options)
        return code

    vars(builtins)["compile"] = compile_
    try:
        yield
    finally:
        vars(builtins)["compile"] = original


def _import_plainly() -> None:
    """Take off the import hook of Qt for Python, which asks for each module whether it wants another spelling of Qt's
    names (`__feature__`).

    To find out, it reads the source of each, which costs 0.2 s for pyqtgraph and us.
    """
    original = vars(builtins).get("__orig_import__")
    if original is not None:
        vars(builtins)["__import__"] = original
