"""What lies under the pointer after any edits, undo, selection and change of view is what a new view finds there."""

import numpy as np
import pytest

from model import edits
from model.channel import Channel
from model.clip import Clip
from model.document import Document, Edit
from model.extrapolation import Extrapolation
from model.gesture import Compute
from model.keyframe import TangentRule, make_run
from model.selection import Selection
from tests.model.drawn import random_run
from tests.widgets.fake_graph import FakeGraph
from widgets import hit_strips
from widgets.hit_test import hit, hit_all

STEPS = 50
MODES, RULES = list(Extrapolation), list(TangentRule)


def scattered(count: int, keys: int) -> list[Channel]:
    """Channels over 16 seconds, some with keys at the same places as others, some that end within the view."""
    chance = np.random.default_rng(count)
    channels = []
    for i in range(count):
        run = random_run(i, keys)
        run["time"] *= chance.choice([10.0, 16.0]) / run["time"][-1]
        run["value"] = 4.0 + run["value"]
        if i % 5 == 1:
            run["value"][::3] = 4.0
        if i % 3 == 1:
            run["time"] = np.linspace(0.0, 16.0, keys)
        channels.append(Channel(f"c{i}", run, pre=MODES[i % 5], post=MODES[i % 4]))
    return channels


class Hand:
    """Random changes of a document, of what is selected and shown, and of the view."""

    def __init__(self, seed: int, channels: list[Channel]) -> None:
        self.chance = np.random.default_rng(seed)
        self.graph = FakeGraph(Document(Clip(channels)))
        self.document = self.graph.document
        self.edits: list[Edit] = []

    def act(self) -> None:
        acts = [self.edit] * 6 + [self.undo, self.select, self.hide, self.look]
        acts[self.chance.integers(len(acts))]()

    def channel(self) -> Channel:
        channels = self.document.clip.channels
        return channels[self.chance.integers(min(len(channels), 12))]

    def chosen(self, channel: Channel) -> Selection:
        """Some neighbouring keys that are in view, if any are."""
        ids = channel.ids_between(*self.graph.range[:2])
        first = int(self.chance.integers(max(len(ids), 1)))
        return Selection.of({channel: ids[first : first + int(self.chance.integers(1, 6))]})

    def edit(self) -> None:
        channel = self.channel()
        chosen, mode = self.chosen(channel), MODES[self.chance.integers(len(MODES))]
        d_time, d_value, time = self.chance.normal() / 4, self.chance.normal(), self.chance.uniform(0.0, 16.0)
        rule = RULES[self.chance.integers(len(RULES))]
        computes: list[Compute] = [
            lambda clip: edits.move(clip, chosen, 0.0, d_value),
            lambda clip: edits.move(clip, chosen, d_time, d_value),
            lambda clip: edits.delete(clip, chosen),
            lambda clip: edits.insert(clip, channel, time),
            lambda clip: edits.set_rule(clip, chosen, rule, "out"),
            lambda clip: edits.set_extrapolation(clip, [channel], mode, mode),
        ]
        edit = self.document.do("Edit", computes[self.chance.integers(len(computes))])
        self.edits += [edit] if edit else []

    def undo(self) -> None:
        if self.edits:
            self.document.apply(self.edits.pop().inverse())

    def select(self) -> None:
        self.document.session.selection = self.chosen(self.channel()) | self.chosen(self.channel())

    def hide(self) -> None:
        self.document.session.hidden = {self.channel()} if self.chance.random() < 0.5 else ()

    def look(self) -> None:
        self.graph.pan_pixels(float(self.chance.integers(-60, 60)), float(self.chance.integers(-60, 60)))

    def spot(self) -> tuple[float, float]:
        """A pixel, mostly near a key or a curve."""
        channel, graph = self.channel(), self.graph
        time, away = float(self.chance.uniform(*graph.range[:2])), self.chance.normal(size=2) * 5.0
        key = channel.nearest_key(time)
        if key is not None and self.chance.random() < 0.5:
            time = key.time
        return graph.x_from_time(time) + away[0], graph.y_from_value(channel.value(time)) + away[1]


def compare(hand: Hand, what: str) -> int:
    """Compare some hits with those of a new view; how many there were."""
    new, count = FakeGraph(hand.document, hand.graph.range), 0
    for _ in range(6):
        x, y = hand.spot()
        assert hit(hand.graph, x, y, 1) == hit(new, x, y, 1), f"{what} at {x}, {y}"
        if hand.chance.random() < 0.5:  # where a key is met first, nobody has asked for curves yet
            found = hit_all(hand.graph, x, y)
            assert found == hit_all(new, x, y), f"{what} at {x}, {y}"
            count += len(found)
    return count


@pytest.mark.parametrize(
    ("count", "keys"), [(1, 5), (2, 40), (12, 30), (40, 60), (3, 9_000), (12, 3_000)], ids=lambda n: str(n)
)
@pytest.mark.parametrize("dense", [False, True])
def test_hits_after_any_change_are_those_of_a_new_view(
    monkeypatch: pytest.MonkeyPatch, count: int, keys: int, dense: bool
) -> None:
    if dense:  # so that few keys take the ways of many
        monkeypatch.setattr(hit_strips, "MANY_KEYS", -1)
        monkeypatch.setattr(hit_strips, "MOST_KEYS", keys // 20)
    hand = Hand(keys + count, scattered(count, keys))
    hits = 0
    for step in range(STEPS):
        hand.act()
        hits += compare(hand, f"step {step}")
    assert hits > STEPS // 3


@pytest.mark.parametrize("way", ["asked", "merged"])
def test_a_channel_full_of_keys_is_met_as_if_all_of_it_were_read(monkeypatch: pytest.MonkeyPatch, way: str) -> None:
    monkeypatch.setattr(hit_strips, "MANY_KEYS", 100)
    monkeypatch.setattr(hit_strips, "MOST_LOOSE", 8 if way == "asked" else -1)
    chance = np.random.default_rng(6)
    times = np.linspace(0.0, 16.0, 2_000) + chance.uniform(0.0, 0.004, 2_000)
    channels = [Channel(f"c{i}", make_run(times, 3.0 + i + chance.normal(size=2_000) / 16)) for i in range(3)]
    times, values = (np.concatenate([channel.run()[column] for channel in channels]) for column in ("time", "value"))
    graph = FakeGraph(Document(Clip(channels)))
    hand, kinds = Hand(4, channels), set()
    for _ in range(150):
        x, y = hand.spot()
        away = np.hypot(graph.x_from_time(times) - x, graph.y_from_value(values) - y)
        found = hit_all(graph, x, y)
        kinds |= {one.kind for one in found}
        keys = [one.distance for one in found if one.kind == "key"]
        assert keys == pytest.approx(np.sort(away[away <= 8.0]).tolist()[:32])
        for channel in channels:
            xs = x + np.linspace(-8.0, 8.0, 4_001)
            ys = graph.y_from_value(channel.evaluate(graph.time_from_x(xs)))
            nearest = float(np.hypot(xs - x, ys - y).min())
            met = [one.distance for one in found if one.kind == "curve" and one.channel is channel]
            if nearest < 7.5:
                assert met, nearest
                assert met[0] <= nearest + 1.5
    assert kinds == {"key", "curve"}


def test_keys_at_the_same_place_are_stepped_through_in_the_same_order_after_an_edit() -> None:
    channels = [Channel(f"c{i}", make_run([2.0, 4.0], 2.0)) for i in range(40)]
    graph = FakeGraph(Document(Clip(channels)))
    before = [found.channel for found in hit_all(graph, 250, 730)]
    for channel in channels[3:7]:
        graph.document.do(
            "Move", lambda clip, channel=channel: edits.move(clip, Selection.of_key(channel, 2), 0.0, 1.0)
        )
        assert [found.channel for found in hit_all(graph, 250, 730)] == before


@pytest.mark.parametrize("chosen", [[17], [1, 17], list(range(1, 101))])
def test_the_nearest_selected_key_is_met_among_thousands_nearer_than_it(chosen: list[int]) -> None:
    channels = [Channel(f"c{i}", make_run(np.linspace(1.99, 2.01, 5_001), 2.0 + i / 50)) for i in range(12)]
    graph = FakeGraph(Document(Clip(channels)))
    graph.document.session.selection = Selection.of(dict.fromkeys(channels[:9], chosen))
    for channel in channels[:9]:
        found = [one for one in hit_all(graph, 250.0, graph.y_from_value(2.0)) if one.kind == "key"]
        assert (found[0].channel, found[0].id in chosen) == (channels[0], True)
        assert len(found) <= 2 * hit_strips.MAX_NEAR + 2  # some are exactly as near as others
        run = channel.run_of([17])
        channel.splice(run, run)  # it has changed, and is asked itself from now on
