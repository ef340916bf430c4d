"""Work in many pieces done by two threads: numpy lets go of Python's lock in each of its long operations."""

import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from model.progress import Report, unheard


def side_by_side[Item, Result](
    work: Callable[[Item], Result], items: Sequence[Item], report: Report = unheard
) -> list[Result]:
    """What *work* makes of each of *items*, in their order; *work* is called on this thread and on another one.

    *report* is called on this thread, after each of its items. The first error, of *work* or of *report*, ends the work
    on both threads and is raised here, once; when this returns or raises, the other thread is gone.
    """
    results: dict[int, Result] = {}
    errors: list[BaseException] = []
    numbers = iter(range(len(items)))  # each thread takes the next one; a step of it is not cut in two

    def do(tell: Report) -> None:
        try:
            for number in numbers:
                if errors:
                    return
                results[number] = work(items[number])
                tell(len(results) / len(items))
        except BaseException as error:
            errors.append(error)

    helper = threading.Thread(target=do, args=(unheard,), name="side by side", daemon=True) if len(items) > 1 else None
    try:
        if helper is not None:
            helper.start()
        do(report)
    except BaseException as error:  # between the two lines above, as when Ctrl+C is pressed
        errors.append(error)
    finally:
        if helper is not None and helper.ident is not None:
            helper.join()
    if errors:
        raise errors[0]
    return [results[number] for number in range(len(items))]


@contextmanager
def meanwhile(work: Callable[[], None]) -> Iterator[None]:
    """Do *work* on another thread while this one does what stands in the block.

    It is over when the block is left, and its error is raised then, unless the block has raised one of its own.
    """
    errors: list[BaseException] = []

    def do() -> None:
        try:
            work()
        except BaseException as error:
            errors.append(error)

    helper = threading.Thread(target=do, name="side by side", daemon=True)
    try:
        helper.start()
    except RuntimeError:  # there can be no more threads
        do()
    try:
        yield
    finally:
        if helper.ident is not None:
            helper.join()
    if errors:
        raise errors[0]
