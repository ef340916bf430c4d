"""Work on two threads: everything in its order, one error, nobody left behind."""

import threading
import time

import pytest

from model.formats.side_by_side import side_by_side
from model.progress import CancelledError


def the_other_threads() -> list[threading.Thread]:
    return [thread for thread in threading.enumerate() if thread.name == "side by side"]


@pytest.mark.parametrize("count", [0, 1, 2, 3, 100])
def test_results_stand_in_the_order_of_the_items(count: int) -> None:
    def work(number: int) -> int:
        time.sleep(0.001 * (number % 3))
        return number * number

    assert side_by_side(work, range(count)) == [number * number for number in range(count)]
    assert the_other_threads() == []


def test_both_threads_work() -> None:
    met = threading.Barrier(2)
    threads = side_by_side(lambda _: (met.wait(10), threading.get_ident())[1], range(2))
    assert len(set(threads)) == 2


@pytest.mark.parametrize("wrong", range(4))
def test_an_error_on_either_thread_is_raised_once_and_ends_the_work(wrong: int) -> None:
    begun = []

    def work(number: int) -> int:
        begun.append(number)
        time.sleep(0.002)
        if number == wrong:
            raise ValueError(f"number {number} is wrong")
        return number

    with pytest.raises(ValueError, match=f"number {wrong} is wrong"):
        side_by_side(work, range(1000))
    assert the_other_threads() == []
    assert len(begun) < 50


def test_a_report_that_stops_the_work_stops_both_threads() -> None:
    begun = []

    def work(number: int) -> int:
        begun.append(number)
        time.sleep(0.002)
        return number

    def report(_share: float) -> None:
        raise CancelledError

    with pytest.raises(CancelledError):
        side_by_side(work, range(1000), report)
    assert the_other_threads() == []
    assert len(begun) < 50


def test_the_share_done_is_told_on_the_thread_that_waits() -> None:
    told = []
    side_by_side(lambda _: time.sleep(0.001), range(50), lambda share: told.append((share, threading.get_ident())))
    shares = [share for share, _ in told]
    assert shares == sorted(shares)
    assert 0 < shares[0] <= shares[-1] <= 1
    assert {thread for _, thread in told} == {threading.get_ident()}
