"""The channel as a list: its keys, its handles, and what it refuses."""

import numpy as np
import pytest

from model.channel import Channel
from model.extrapolation import Extrapolation
from model.keyframe import KEY_DTYPE, Keyframe, KeyGoneError, Run, TangentRule, make_run
from tests.model.drawn import bits, random_run


def three_keys() -> Channel:
    return Channel("root.tx", make_run([0.0, 1.0, 3.0], [5.0, 7.0, 6.0]))


def test_a_channel_is_a_list_linked_both_ways() -> None:
    channel = three_keys()
    first, middle, last = channel
    assert (channel.first, channel.last) == (first, last)
    assert (first.previous, first.next, middle.previous, middle.next, last.next) == (None, middle, first, last, None)
    assert [key.time for key in channel] == [0.0, 1.0, 3.0]
    assert len(channel) == 3


def test_links_agree_with_the_order_over_many_rows() -> None:
    channel = Channel("long", random_run(1, 2000))
    forward, key = [], channel.first
    while key:
        forward.append(key.id)
        key = key.next
    backward, key = [], channel.last
    while key:
        backward.append(key.id)
        key = key.previous
    assert forward == backward[::-1] == channel.run()["id"].tolist()


def test_a_name_has_a_group_and_a_leaf() -> None:
    assert (Channel("a.b.rx").group, Channel("a.b.rx").leaf) == ("a.b", "rx")
    assert (Channel("rx").group, Channel("rx").leaf) == ("", "rx")


def test_a_handle_reads_what_the_channel_holds() -> None:
    run = make_run([1.0], [2.0], [3.0], [4.0], TangentRule.FIXED, TangentRule.FIXED, True)
    key = Channel("x", run).first
    assert key is not None
    assert (key.time, key.value, key.slope_in, key.slope_out, key.tangent_in, key.tangent_out) == (1, 2, 3, 4, 3, 4)
    assert (key.rule_in, key.rule_out, key.broken) == (TangentRule.FIXED, TangentRule.FIXED, True)
    assert key.coefficients == (0.0, 0.0, 0.0, 2.0)
    assert key == Keyframe(key.channel, key.id)
    assert len({key, Keyframe(key.channel, key.id)}) == 1


def test_coefficients_are_those_of_the_span_that_the_key_starts() -> None:
    run = make_run([0.0, 2.0], [1.0, 4.0], [0.0, 3.0], [0.5, 0.0], TangentRule.FIXED, TangentRule.FIXED)
    first, last = Channel("x", run)
    # 2p0 - 2p1 + dt(m0 + m1), -3p0 + 3p1 - dt(2m0 + m1), dt m0, p0
    assert first.coefficients == (1.0, 1.0, 1.0, 1.0)
    assert last.coefficients == (0.0, 0.0, 0.0, 4.0)


def test_a_step_has_no_coefficients_but_its_value() -> None:
    run = make_run([0.0, 2.0], [1.0, 4.0], 9.0, 9.0, TangentRule.FIXED, TangentRule.STEP)
    first = Channel("x", run).first
    assert first is not None
    assert first.coefficients == (0.0, 0.0, 0.0, 1.0)


def test_a_deleted_key_says_so() -> None:
    channel = three_keys()
    key = channel.key(2)
    channel.splice(channel.run_of([2]), make_run())
    assert 2 not in channel
    assert 1 in channel
    for ask in (lambda: key.time, lambda: key.next, lambda: key.coefficients, lambda: channel.key(2)):
        with pytest.raises(KeyGoneError, match="2"):
            ask()
    for ids in ([2], [1, 2], [0], [-1], [10**9]):
        with pytest.raises(KeyGoneError):
            channel.run_of(ids)
        with pytest.raises(KeyGoneError):
            channel.keys_of(ids)


def test_ids_are_never_used_again() -> None:
    channel = three_keys()
    gone = channel.run_of([3])
    channel.splice(gone, make_run())
    new = channel.splice(channel.run()[:0], make_run([9.0])).run
    assert new["id"].tolist() == [4]
    back = channel.splice(channel.run()[:0], gone).run
    assert back["id"].tolist() == [3]


def test_runs_are_read_only_and_of_the_key_dtype() -> None:
    channel = three_keys()
    for run in (channel.run(), channel.run_of([1]), channel.keys_of([1, 3]), channel.keys_between(0, 1)):
        assert run.dtype == KEY_DTYPE
        with pytest.raises(ValueError, match="read-only"):
            run["value"] = 0.0


@pytest.mark.parametrize("n", [3, 2000])
def test_runs_and_keys_of_ids(n: int) -> None:
    channel = Channel("x", random_run(2, n))
    everything = channel.run()
    ids = everything["id"]
    assert channel.run_of(ids[[2, 1]])["id"].tolist() == ids[1:3].tolist()
    assert channel.keys_of(ids[[2, 0]].tolist())["id"].tolist() == ids[[0, 2]].tolist()
    assert channel.keys_of(ids[::2]).tobytes() == everything[::2].tobytes()
    assert channel.run_of(ids).tobytes() == everything.tobytes()
    assert len(channel.run_of([])) == len(channel.keys_of([])) == 0


@pytest.mark.parametrize("n", [100, 2000, 9000])
def test_few_keys_among_many_are_read_as_they_are_and_missed_when_gone(n: int) -> None:
    channel = Channel("x", random_run(4, n))
    for gone in (0, 383, n // 2):  # so that rows have spare slots
        some = channel.run()[gone : gone + 7]
        channel.splice(some, some[:0])
    run, random = channel.run(), np.random.default_rng(n)
    last_of_rows = np.flatnonzero(np.diff(run["id"]) > 1)
    for count in (8, n // 5):
        places = np.union1d(random.choice(len(run), count, replace=False), last_of_rows[:3])
        wanted = random.permutation(run["id"][places])
        assert channel.keys_of(wanted).tobytes() == run[places].tobytes()
        for stranger in (0, -3, 1, 10 * n):
            with pytest.raises(KeyGoneError):
                channel.keys_of(np.append(wanted, stranger))


@pytest.mark.parametrize("n", [1, 5, 500, 5_000])
def test_the_extent_of_keys_is_that_of_those_that_are_there(n: int) -> None:
    channel = Channel("x", make_run(np.arange(n) * 0.5, np.sin(np.arange(n) * 7.0)))
    ids = channel.run()["id"]
    strangers = np.array([0, -3, 10**9])
    for chosen in (ids, ids[::-1], ids[n // 3 :: 2], ids[-1:]):
        run = channel.keys_of(chosen)
        expected = run["time"][0], run["time"][-1], run["value"].min(), run["value"].max()
        assert channel.extent_of(chosen) == channel.extent_of(np.append(strangers, chosen)) == expected
    assert channel.extent_of(strangers) is channel.extent_of(ids[:0]) is None
    if n > 1:
        channel.splice(channel.run_of(ids[:1]), make_run())
        assert channel.extent_of(ids) == channel.extent_of(ids[1:])
        assert channel.extent_of(ids[:1]) is None


@pytest.mark.parametrize("n", [1, 2, 3, 2000])
def test_keys_around_one_are_its_neighbours_and_it(n: int) -> None:
    channel = Channel("c", make_run(np.arange(n), 0.0))
    for rank in {0, n // 2, n - 1}:
        run, place = channel.keys_around(rank + 1)
        wanted = range(max(rank, 1), min(rank + 2, n) + 1)
        assert run["id"].tolist() == list(wanted)
        assert run["id"][place] == rank + 1


@pytest.mark.parametrize("n", [0, 1, 5, 2000])
def test_keys_between_two_times(n: int) -> None:
    channel = Channel("x", random_run(3, n))
    run = channel.run()
    times = run["time"].tolist()
    probes = [-1.0, *times[: n // 3 + 1], *times[-1:], (times[-1] if n else 0.0) + 1.0]
    for t0 in probes[:5]:
        for t1 in probes[-5:]:
            here = (run["time"] >= t0) & (run["time"] <= t1)
            assert channel.keys_between(t0, t1).tobytes() == run[here].tobytes()
            assert channel.count_between(t0, t1) == here.sum()
            first, last = np.searchsorted(run["time"], t0), np.searchsorted(run["time"], t1, "right")
            around = channel.keys_between(t0, t1, around=2)
            assert around["id"].tolist() == run["id"][max(first - 2, 0) : max(first, last) + 2].tolist()


def test_neighbours_of_a_time() -> None:
    channel = three_keys()
    assert [[key and key.id for key in channel.neighbours(t)] for t in (-1.0, 0.0, 0.5, 1.0, 3.0, 4.0)] == [
        [None, 1],
        [1, 2],
        [1, 2],
        [2, 3],
        [3, None],
        [3, None],
    ]
    assert [key and key.id for key in map(channel.key_at, (0.0, 0.5, 3.0, 9.0))] == [1, None, 3, None]
    assert [key and key.id for key in map(channel.nearest_key, (-9.0, 0.4, 0.5, 2.1, 9.0))] == [1, 1, 1, 3, 3]
    assert Channel("none").nearest_key(0.0) is None
    assert Channel("none").neighbours(0.0) == (None, None)


@pytest.mark.parametrize("field", ["time", "value", "slope_in", "slope_out"])
@pytest.mark.parametrize("number", [np.nan, np.inf, -np.inf])
def test_numbers_that_are_not_finite_are_refused_by_name(field: str, number: float) -> None:
    channel = three_keys()
    run = make_run([4.0, 5.0, 6.0])
    run[field][1] = number
    refused(channel, channel.run()[:0], run, rf"key 1: {field}|key 1: time nan")


def refused(channel: Channel, before: Run, after: Run, match: str) -> None:
    everything, revision = channel.run().tobytes(), channel.revision
    with pytest.raises(ValueError, match=match):
        channel.splice(before, after)
    channel.check()
    assert channel.run().tobytes() == everything
    assert channel.revision == revision


def test_keys_out_of_order_are_refused_by_name() -> None:
    channel = three_keys()
    none = channel.run()[:0]
    refused(channel, none, make_run([4.0, 4.0]), "key 1: time 4.0 is not after 4.0")
    refused(channel, none, make_run([5.0, 6.0, 4.5]), "key 2: time 4.5 is not after 6.0")
    refused(channel, none, make_run([0.5, 1.0]), "key 1: time 1.0 is not before 1.0")
    refused(channel, none, make_run([1.0]), "key 0: time 1.0 is not after 1.0")
    refused(channel, channel.run_of([2]), make_run([0.0]), "key 0: time 0.0 is not after 0.0")
    refused(channel, channel.run_of([2]), make_run([3.5]), "key 0: time 3.5 is not before 3.0")


def test_unknown_rules_are_refused_by_name() -> None:
    channel = three_keys()
    none = channel.run()[:0]
    refused(channel, none, make_run([9.0], rules_in=TangentRule.STEP), "key 0: rule_in is 4")
    refused(channel, none, make_run([8.0, 9.0], rules_out=[0, 77]), "key 1: rule_out is 77")


def test_what_is_not_there_cannot_be_replaced() -> None:
    channel = three_keys()
    run = channel.run()
    refused(channel, run[[0, 2]], make_run([1.5]), "not what the channel holds")
    refused(channel, run[::-1], make_run([1.5]), "not what the channel holds")
    refused(channel, make_run([1.0], ids=99), make_run([1.5]), "no key with id 99")
    channel.splice(run[1:2], make_run())
    refused(channel, run[1:2], make_run([1.5]), "no key with id 2")


def test_ids_that_cannot_be_are_refused() -> None:
    channel = three_keys()
    none = channel.run()[:0]
    refused(channel, none, make_run([8.0, 9.0], ids=[7, 7]), "two keys of the run have the same")
    refused(channel, none, make_run([9.0], ids=2), "id 2 belongs to a key outside the run")
    refused(channel, none, make_run([9.0], ids=-5), "key 0: id -5")
    refused(channel, none, make_run([9.0], ids=10**12), "key 0: id 1000000000000")


def test_ids_that_cannot_be_are_refused_among_many_keys_too() -> None:
    channel = Channel("x", random_run(1, 1500))
    run = channel.run()
    after = run[:1200].copy()
    after["id"][7] = after["id"][8]
    refused(channel, run[:1200], after, "two keys of the run have the same")
    after["id"][7] = run["id"][1300]
    refused(channel, run[:1200], after, "belongs to a key outside the run")
    after["id"] = run["id"][:1200][::-1]
    assert channel.splice(run[:1200], after).run["id"].tolist() == after["id"].tolist()
    channel.check()


def test_minus_zero_is_kept_bit_for_bit() -> None:
    channel = Channel("x", make_run([-0.0, 1.0], [-0.0, -0.0], -0.0, -0.0, TangentRule.FIXED, TangentRule.FIXED))
    run = channel.run()
    for field in ("time", "value", "slope_in", "slope_out"):
        assert np.signbit(run[field][0]), field
    assert bits(channel.evaluate([0.0, 1.0])) == bits([-0.0, -0.0])
    assert bits(channel.value(1.0)) == bits(-0.0)
    assert bits(channel.value(0.0)) == bits(-0.0)


def test_a_copy_is_equal_and_independent() -> None:
    channel = Channel("x", random_run(4, 1000), pre=Extrapolation.CYCLE, unit="angle", color="#ff0000", locked=True)
    channel.splice(channel.run()[5:9], make_run())
    twin = channel.copy()
    assert (twin.name, twin.pre, twin.post, twin.unit, twin.color, twin.locked) == (
        "x",
        Extrapolation.CYCLE,
        Extrapolation.CONSTANT,
        "angle",
        "#ff0000",
        True,
    )
    assert twin.run().tobytes() == channel.run().tobytes()
    before = channel.run().tobytes()
    new = twin.splice(twin.run()[:2], make_run([-5.0])).run
    assert int(new["id"][0]) not in channel
    twin.check()
    assert channel.run().tobytes() == before


def test_a_copy_uses_no_id_again_that_the_channel_has_used() -> None:
    channel = three_keys()
    channel.splice(channel.run_of([3]), make_run())
    assert channel.copy().splice(make_run(), make_run([9.0])).run["id"].tolist() == [4]


def test_the_revision_grows_with_each_change() -> None:
    channel = three_keys()
    revisions = [channel.revision]
    channel.splice(channel.run_of([1]), make_run())
    revisions.append(channel.revision)
    channel.set_extrapolation(Extrapolation.CYCLE, Extrapolation.BOUNCE)
    revisions.append(channel.revision)
    assert revisions == sorted(set(revisions))
    assert (channel.pre, channel.post) == (Extrapolation.CYCLE, Extrapolation.BOUNCE)


def test_check_finds_damage() -> None:
    for damage in ("time", "slope", "coefficient", "id", "row", "spare"):
        channel = Channel("x", random_run(5, 20))
        rows = channel._rows
        if damage == "time":
            rows.numbers[0, 3] = -1.0
        elif damage == "slope":
            rows.numbers[2, 3] += 1e-12
        elif damage == "coefficient":
            rows.numbers[5, 3] = np.nextafter(rows.numbers[5, 3], np.inf)
        elif damage == "id":
            rows.ids[3] = rows.ids[4]
        elif damage == "row":
            rows.row_of[int(rows.ids[3])] = 7
        else:
            rows.numbers[1, -1] += 1.0
        with pytest.raises(AssertionError):
            channel.check()


def test_ids_between_two_times_are_those_of_the_keys_there() -> None:
    channel = Channel("x", make_run(np.arange(3000) / 24.0, 0.0))
    for t0, t1 in ((-np.inf, np.inf), (10.0, 90.0), (10.0, 10.0), (10.01, 10.02), (200.0, 300.0), (20.0, 10.0)):
        assert channel.ids_between(t0, t1).tolist() == channel.keys_between(t0, t1)["id"].tolist()
