"""guarded: no exception may pass from an override of ours into Qt."""

import sys
from collections.abc import Callable
from functools import wraps
from inspect import isfunction
from typing import Any

# Classes of these packages are not ours to guard; what they override is their business.
FOREIGN_PACKAGES = frozenset({"PySide6", "Shiboken", "shiboken6", "pyqtgraph", "builtins"})
MARK = "__guarded__"


def guarded(default: object = None) -> "_Guard":
    """Wrap an override of a Qt virtual: an exception is reported once, and Qt gets *default* instead.

    A callable *default* is called with the object, so that ``guarded(QWidget.sizeHint)`` falls back on Qt's own answer.
    Qt is C++ and knows no Python exceptions: one that reaches it is lost, and may end the process.
    """
    return _Guard(default)


class _Guard:
    def __init__(self, default: object) -> None:
        self.default = default

    def __call__[**P, R](self, override: Callable[P, R]) -> Callable[P, R]:
        default: Any = self.default

        @wraps(override)
        def call(*args: P.args, **kwargs: P.kwargs) -> R:
            try:
                return override(*args, **kwargs)
            except Exception as error:
                sys.excepthook(type(error), error, error.__traceback__)
                return default(args[0]) if callable(default) else default  # type: ignore[no-any-return]  # of the kind that is guarded

        vars(call)[MARK] = True
        return call


def unguarded(cls: type) -> list[str]:
    """Names, as ``module.Class.method``, of the overrides of Qt methods in *cls* and its bases that lack the guard."""
    foreign = [base for base in cls.__mro__ if _package(base) in FOREIGN_PACKAGES]
    return [
        f"{base.__module__}.{base.__qualname__}.{name}"
        for base in cls.__mro__
        if base not in foreign
        for name, member in vars(base).items()
        if isfunction(member) and not name.startswith("__") and MARK not in vars(member)
        if any(name in vars(qt) for qt in foreign)
    ]


def _package(cls: type) -> str:
    return cls.__module__.partition(".")[0]
