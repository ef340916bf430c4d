"""Report: how work that may take long says how far it has come, and hears that nobody wants it any more."""

from collections.abc import Callable

# Called with the share done, from 0 to 1, some fifty times a second; raises CancelledError to stop the work.
type Report = Callable[[float], None]


class CancelledError(Exception):
    """Somebody stopped the work; whoever does it cleans up and lets this pass."""


def unheard(_share: float) -> None:
    """The Report of work that nobody waits for."""


def part_of(report: Report, begin: float, end: float) -> Report:
    """The Report of a part of the work, which goes on from the share *begin* to the share *end*."""
    return lambda share: report(begin + (end - begin) * share)
