"""Numbers as people read them: short where they change, exact where they are edited, in the channel's shown unit."""

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

type Floats = NDArray[np.float64]

DEGREES: Final = 180.0 / math.pi


def shown(number: float, digits: int = 6) -> str:
    """The number in about *digits* significant digits, never in powers of ten where plain digits do."""
    text = f"{number:.{digits}g}"
    if "e" in text and 1e-5 <= abs(number) < 1e9:
        text = f"{number:.{max(digits - 1 - math.floor(math.log10(abs(number))), 0)}f}"
        text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text == "-0" else text


def steady(number: float) -> str:
    """The number in at most eight characters, three decimals where they fit: a column of them stands still."""
    size = abs(number)
    if size >= 1e6 or 0 < size < 5e-4:
        return f"{number:.1e}"
    text = f"{number:.{3 if size < 100 else 2 if size < 1000 else 1}f}"
    return "0.000" if text == "-0.000" else text


def frame_text(frame: float) -> str:
    """A frame, with two decimals only where it is not whole."""
    if abs(frame) >= 1e15:
        return f"{frame:.6g}"
    whole = round(frame)
    return str(whole) if abs(frame - whole) < 5e-4 else f"{frame:.2f}"


def exact(number: float) -> str:
    """The shortest text that is read back as this very number."""
    return repr(float(number)).removesuffix(".0")


def is_angle(unit: str) -> bool:
    """Whether values are stored in radians and shown in degrees."""
    return unit == "angle"


def factor_of(unit: str) -> float:
    """What a stored value is multiplied by to be shown."""
    return DEGREES if is_angle(unit) else 1.0


def suffix_of(unit: str) -> str:
    """What is written behind a shown value: a degree sign, or a space and the unit."""
    if is_angle(unit):
        return "°"
    return f" {unit}" if unit else ""


def stored_from_shown(wanted: Floats, shown_before: Floats, stored_before: Floats, factor: float) -> Floats:
    """Shown numbers in the unit of the file; a number that was not changed keeps its stored bits."""
    return np.where(wanted == shown_before, stored_before, wanted / factor)
