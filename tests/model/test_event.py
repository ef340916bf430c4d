"""Events: who is called, in what order, and what keeps whom alive."""

import gc
import weakref

import pytest

from model.event import Event


class Listener:
    def __init__(self) -> None:
        self.heard: list[int] = []

    def hear(self, number: int) -> None:
        self.heard.append(number)


def test_listeners_are_called_in_the_order_of_connection() -> None:
    event: Event[int] = Event()
    calls: list[str] = []
    event.connect(lambda number: calls.append(f"first {number}"))
    event.connect(lambda number: calls.append(f"second {number}"))
    event.emit(7)
    assert calls == ["first 7", "second 7"]


def test_listening_does_not_keep_an_object_alive() -> None:
    event: Event[int] = Event()
    listener = Listener()
    reference = weakref.ref(listener)
    event.connect(listener.hear)
    event.emit(1)
    assert listener.heard == [1]
    del listener
    gc.collect()
    assert reference() is None
    event.emit(2)


def test_functions_are_kept() -> None:
    event: Event[int] = Event()
    heard: list[int] = []

    def connect() -> None:
        event.connect(lambda number: heard.append(number))

    connect()
    gc.collect()
    event.emit(3)
    assert heard == [3]


def test_who_disconnects_is_not_called_again() -> None:
    event: Event[int] = Event()
    one, other = Listener(), Listener()
    event.connect(one.hear)
    event.connect(other.hear)
    event.connect(other.heard.append)
    event.disconnect(one.hear)
    event.disconnect(one.hear)
    event.emit(1)
    assert (one.heard, other.heard) == ([], [1, 1])


def test_a_listener_that_fails_does_not_silence_the_others() -> None:
    event: Event[int] = Event()
    listener = Listener()

    def fail(number: int) -> None:
        raise ValueError(f"failed at {number}")

    event.connect(fail)
    event.connect(listener.hear)
    event.connect(lambda number: 1 / 0)
    with pytest.raises(ValueError, match="failed at 5"):
        event.emit(5)
    assert listener.heard == [5]


def test_listeners_may_come_and_go_while_an_event_is_told() -> None:
    event: Event[int] = Event()
    listener = Listener()

    def change(number: int) -> None:
        event.disconnect(change)
        event.connect(listener.hear)

    event.connect(change)
    event.emit(1)
    event.emit(2)
    assert listener.heard == [2]
