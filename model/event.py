"""Event: tells its listeners that something happened."""

import weakref
from collections.abc import Callable
from inspect import ismethod


class Event[*Args]:
    """A list of listeners called in the order in which they were connected.

    Bound methods are held weakly, so that listening does not keep a widget alive; functions are held strongly.
    """

    __slots__ = ("_slots",)

    def __init__(self) -> None:
        self._slots: list[Callable[[], Callable[..., object] | None]] = []

    def connect(self, slot: Callable[[*Args], object]) -> None:
        """Call *slot* at every emit from now on."""
        if ismethod(slot):
            self._slots.append(weakref.WeakMethod(slot))
        else:
            self._slots.append(lambda: slot)

    def disconnect(self, slot: Callable[[*Args], object]) -> None:
        """Stop calling *slot*; nothing happens if it was not connected."""
        self._slots = [reference for reference in self._slots if reference() not in (None, slot)]

    def emit(self, *args: *Args) -> None:
        """Call every listener; the first exception is raised after all of them ran."""
        failure: Exception | None = None
        for reference in tuple(self._slots):
            slot = reference()
            if slot is None:
                self._slots.remove(reference)
                continue
            try:
                slot(*args)
            except Exception as error:
                failure = failure or error
        if failure is not None:
            raise failure
