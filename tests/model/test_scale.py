"""What a million keys rest on: the cost of one edit, and memory, do not grow with the channel."""

import gc
import sys
import time
import tracemalloc
from collections.abc import Callable

import numpy as np
import pytest

from model.channel import Channel
from model.keyframe import TangentRule, make_run

MANY = 200_000


def channel_of(n: int) -> Channel:
    chance = np.random.default_rng(n)
    return Channel("x", make_run(np.cumsum(chance.uniform(0.5, 1.5, n)) / 60.0, chance.normal(size=n).cumsum()))


def move_one(channel: Channel) -> None:
    key = channel.nearest_key(0.5)
    assert key
    before = channel.run_of([key.id])
    after = before.copy()
    after["value"] += 1.0
    channel.splice(before, after)


def change_a_rule(channel: Channel) -> None:
    key = channel.nearest_key(0.5)
    assert key
    before = channel.run_of([key.id])
    after = before.copy()
    after["rule_out"] = TangentRule.LINEAR if before["rule_out"][0] else TangentRule.FLAT
    channel.splice(before, after)


def insert_and_delete(channel: Channel) -> None:
    before, after = channel.neighbours(0.05)
    assert before
    assert after
    new = make_run([0.5 * (before.time + after.time)], 1.0)
    channel.splice(channel.splice(new[:0], new).run, new[:0])


@pytest.mark.parametrize("edit", [move_one, change_a_rule, insert_and_delete])
def test_an_edit_costs_as_much_in_a_long_channel_as_in_a_short_one(edit: Callable[[Channel], None]) -> None:
    short, long = channel_of(10), channel_of(MANY)
    quickest = {10: np.inf, MANY: np.inf}
    for _ in range(60):
        for channel in (short, long):
            start = time.perf_counter()
            for _ in range(5):
                edit(channel)
            n = len(channel)
            quickest[n] = min(quickest[n], time.perf_counter() - start)
    assert quickest[MANY] <= 3.0 * quickest[10], quickest


def test_a_key_takes_no_more_than_160_bytes_with_all_that_is_kept_for_speed() -> None:
    run = make_run(np.arange(MANY) / 30.0, np.sin(np.arange(MANY)))
    gc.collect()
    tracemalloc.start()
    channel = Channel("x", run)
    times = np.linspace(0.0, run["time"][-1], MANY)
    channel.evaluate(times)
    channel.envelope(times[::100])
    for time_ in times[::50].tolist():
        channel.value(time_)
    del times
    gc.collect()
    held, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert held / MANY <= 160.0
    assert sys.getsizeof(channel) < 1000


def test_keys_may_be_inserted_at_one_place_for_ever() -> None:
    channel = Channel("x", make_run([0.0, 1.0], [0.0, 1.0]))
    none = channel.run()[:0]
    for i in range(1, 3000):
        channel.splice(none, make_run([1.0 - 2.0**-40 * (4000 - i)], i))
    channel.check()
    assert (np.diff(channel.run()["value"][1:-1]) == 1.0).all()
    assert channel._rows.rows < 40


def test_keys_may_be_deleted_until_none_is_left() -> None:
    channel = channel_of(5000)
    chance = np.random.default_rng(0)
    ids = channel.run()["id"].tolist()
    chance.shuffle(ids)
    for i, key_id in enumerate(ids):
        run = channel.run_of([key_id])
        channel.splice(run, run[:0])
        if i % 500 == 0:
            channel.check()
            # What room deleted keys leave is given back.
            assert len(channel._rows.ids) <= 8 * max(len(channel), 64)
    channel.check()
    assert len(channel) == 0
    assert channel.value(1.0) == 0.0


def test_an_append_is_cheap_and_keeps_the_rows_full() -> None:
    channel = Channel("x")
    none = make_run()
    for i in range(4000):
        channel.splice(none, make_run([float(i)], i))
    channel.check()
    assert len(channel) == 4000
    assert len(channel._rows.ids) <= 3 * 4000
