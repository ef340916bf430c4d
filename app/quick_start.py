"""A quarter of the start saved: Qt for Python need not read the source of every module that is imported after it."""

import sys

import PySide6.QtCore  # noqa: F401  it brings the hook


def spare_sources() -> None:
    """Tell the import hook of Qt for Python that no module wants another spelling of Qt's names (`__feature__`).

    To find out, it reads the source of each module, which costs 0.2 s for pyqtgraph and us. Where a later Qt for
    Python has no such hook, nothing happens.
    """
    hook = sys.modules.get("shibokensupport.feature")
    if hook is not None and hasattr(hook, "_mod_uses_pyside"):
        vars(hook)["_mod_uses_pyside"] = wants_no_feature


def wants_no_feature(_module: object) -> bool:
    """The answer for every module of this program."""
    return False
