"""Formulas typed into number fields: ``0.5``, ``3/4``, ``+=0.1``, ``v*0.5 + sin(t)``, worked out on floats alone.

The text comes from a keyboard or a clipboard, so nothing of it is ever run as Python: it is parsed, every node is
looked up in the tables below, and the rest is refused. Length, size and depth are bounded; floats overflow at once
where integers would grow.
"""

import ast
import math
import re
import warnings
from collections.abc import Callable, Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

type Floats = NDArray[np.float64]
type Names = Mapping[str, Floats | float]
type Node = Callable[[Names], Floats | float]

MOST_CHARACTERS: Final = 256
MOST_NODES: Final = 64
DEEPEST: Final = 32

# x (op)= y; "=" sets the number as a bare formula does.
ASSIGNMENTS: Final[dict[str, Callable[[Floats, Floats], Floats]]] = {
    "+=": np.add,
    "-=": np.subtract,
    "*=": np.multiply,
    "/=": np.divide,
    "=": lambda x, y: y,
}
BINARY: Final[dict[type[ast.operator], Callable[..., Floats]]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.divide,
    ast.FloorDiv: np.floor_divide,
    ast.Mod: np.mod,
    ast.Pow: np.float_power,
}
UNARY: Final[dict[type[ast.unaryop], Callable[..., Floats]]] = {ast.UAdd: np.positive, ast.USub: np.negative}


def _smoothstep(u: Floats) -> Floats:
    u = np.clip(u, 0.0, 1.0)
    return u * u * (3.0 - 2.0 * u)


# name: (function, how many arguments)
FUNCTIONS: Final[dict[str, tuple[Callable[..., Floats], int]]] = {
    "abs": (np.abs, 1),
    "sign": (np.sign, 1),
    "sqrt": (np.sqrt, 1),
    "exp": (np.exp, 1),
    "log": (np.log, 1),
    "log10": (np.log10, 1),
    "sin": (np.sin, 1),
    "cos": (np.cos, 1),
    "tan": (np.tan, 1),
    "asin": (np.arcsin, 1),
    "acos": (np.arccos, 1),
    "atan": (np.arctan, 1),
    "atan2": (np.arctan2, 2),
    "rad": (np.radians, 1),
    "deg": (np.degrees, 1),
    "floor": (np.floor, 1),
    "ceil": (np.ceil, 1),
    "round": (np.round, 1),
    "min": (np.minimum, 2),
    "max": (np.maximum, 2),
    "clamp": (lambda x, low, high: np.minimum(np.maximum(x, low), high), 3),
    "lerp": (lambda a, b, u: a + (b - a) * u, 3),
    "smoothstep": (_smoothstep, 1),
}
CONSTANTS: Final = {"pi": math.pi, "tau": math.tau, "e": math.e}
# What people paste or are used to.
SPELLINGS: Final = str.maketrans({"−": "-", "×": "*", "÷": "/", "·": "*", "π": "pi", "°": "", "\u00a0": " "})
GROUPED: Final = re.compile(r"(?<![\d.])[1-9]\d{0,2},\d{3}(?!\d)")


class ExpressionError(ValueError):
    """The text is not a formula; str() tells the user what is wrong with it."""


class Formula:
    """A formula that can be applied to many numbers at once; ExpressionError if the text is none."""

    def __init__(self, text: str) -> None:
        self.text = text
        assignment, body = _split(text)
        self._assign = ASSIGNMENTS[assignment]
        self._value = _compiled(body)

    def __call__(self, numbers: Floats, times: Floats | None = None, values: Floats | None = None) -> Floats:
        """New numbers, shape (n,), for the numbers of n keys in time order; ExpressionError unless all are finite.

        Names: x the number itself, t and v the key's time and value, i and n its index and the count, u from 0 at the
        first time to 1 at the last, and first, last, min, max of the numbers.
        """
        names = _names(numbers, times, values)
        with np.errstate(all="ignore"):
            result = self._assign(numbers, np.asarray(self._value(names), np.float64))
        result = np.broadcast_to(np.asarray(result, np.float64), numbers.shape)
        if not np.isfinite(result).all():
            raise ExpressionError("gives no finite number here (a division by zero, a root of a negative?)")
        return result.copy()


def _names(numbers: Floats, times: Floats | None, values: Floats | None) -> dict[str, Floats | float]:
    count = len(numbers)
    names: dict[str, Floats | float] = {"x": numbers, "i": np.arange(count, dtype=np.float64), "n": float(count)}
    if count:
        names |= {"first": numbers[0], "last": numbers[-1], "min": numbers.min(), "max": numbers.max()}
    if times is not None:
        span = times[-1] - times[0] if count > 1 else 1.0
        names |= {"t": times, "u": (times - times[0]) / span if count else times}
    if values is not None:
        names["v"] = values
    return names | CONSTANTS


def _split(text: str) -> tuple[str, str]:
    """(assignment, formula) of what was typed."""
    if len(text) > MOST_CHARACTERS:
        raise ExpressionError(f"longer than {MOST_CHARACTERS} characters")
    text = _with_decimal_points(text.translate(SPELLINGS).strip().replace("^", "**"))
    if not text:
        raise ExpressionError("expected a number or a formula")
    if not text.isascii() or not text.isprintable():
        raise ExpressionError("holds a character that no formula has")
    for assignment in ASSIGNMENTS:
        if text.startswith(assignment):
            return assignment, text[len(assignment) :].strip()
    return "=", text


def _with_decimal_points(text: str) -> str:
    """The text with 0,5 written 0.5; outside brackets a comma can mean nothing else, unless it groups thousands."""
    if "," not in text:
        return text
    depth = 0
    letters = list(text)
    for place, letter in enumerate(letters):
        depth += (letter == "(") - (letter == ")")
        if letter == "," and depth == 0:
            found = GROUPED.search(text)
            if found or "." in text:
                raise ExpressionError(f"the comma in {found[0] if found else text} may mean two things; write a point")
            letters[place] = "."
    return "".join(letters)


def _compiled(body: str) -> Node:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            root = ast.parse(body, mode="eval").body
    except (SyntaxError, SyntaxWarning, ValueError, RecursionError, MemoryError):
        raise ExpressionError("not a number or a formula") from None
    if sum(1 for _ in ast.walk(root)) > MOST_NODES:
        raise ExpressionError("too long a formula")
    return _node(root, 0)


def _node(node: ast.expr, depth: int) -> Node:
    if depth > DEEPEST:
        raise ExpressionError("too deep a formula")
    match node:
        case ast.Constant(value=bool()):
            pass
        case ast.Constant(value=int() | float() as number):
            return _number(number)
        case ast.Name(id=name):
            return lambda names: _named(names, name)
        case ast.UnaryOp(op=op, operand=operand) if type(op) in UNARY:
            unary, inner = UNARY[type(op)], _node(operand, depth + 1)
            return lambda names: unary(inner(names))
        case ast.BinOp(op=operator, left=left, right=right) if type(operator) in BINARY:
            binary, a, b = BINARY[type(operator)], _node(left, depth + 1), _node(right, depth + 1)
            return lambda names: binary(a(names), b(names))
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
            return _call(name, [_node(argument, depth + 1) for argument in arguments])
    raise ExpressionError("only numbers, names, + - * / % ** and functions are known here")


def _number(number: float) -> Node:
    try:
        value = float(number)
    except OverflowError:
        value = math.inf
    if not math.isfinite(value):
        raise ExpressionError("too large a number")
    return lambda names: value


def _named(names: Names, name: str) -> Floats | float:
    try:
        return names[name]
    except KeyError:
        raise ExpressionError(f"unknown name “{name}”; known here: {', '.join(sorted(names))}") from None


def _call(name: str, arguments: list[Node]) -> Node:
    if name not in FUNCTIONS:
        raise ExpressionError(f"unknown function “{name}”; known: {', '.join(FUNCTIONS)}")
    function, count = FUNCTIONS[name]
    if len(arguments) != count:
        raise ExpressionError(f"{name}() takes {count} number{'s' * (count > 1)}, not {len(arguments)}")
    return lambda names: function(*(argument(names) for argument in arguments))
