"""A random walk through previews: each shows what its edit makes of the start, whatever the previews before it did."""

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule, run_state_machine_as_test

from model import edits, placing, rows, splicing
from model.channel import Channel
from model.clip import Clip
from model.document import Change, Document, Splice, added_keys
from model.extrapolation import Extrapolation
from model.keyframe import Run, TangentRule, make_run
from model.selection import Selection
from tests.model.editing import everything

EXAMPLES = 25
STEPS = 25

TIMES = st.one_of(st.integers(-12, 12).map(lambda n: n / 4), st.floats(-3.0, 3.0))
VALUES = st.floats(-5.0, 5.0)
MASKS = st.integers(1, 2**24 - 1)
PLACES = st.integers(0, 2**16)

# What to make of a clip; keys are named by rank, since the twin's new keys have other ids.
type Verb = Callable[[Clip], Iterable[Change]]


def chosen(clip: Clip, mask: int) -> Selection:
    """Keys of all channels by the bits of *mask*, over and over."""
    found = {}
    for channel in clip.channels:
        ids = channel.run()["id"]
        found[channel] = ids[[bool(mask >> (place % 24) & 1) for place in range(len(ids))]]
    return Selection.of(found)


def without_ids(run: Run) -> list[Any]:
    """The rows of *run* but for their ids."""
    return [row[:-1] for row in run.tolist()]


class Previews(RuleBasedStateMachine):
    """One gesture beside a copy of its start, on which every edit is made alone."""

    @initialize(
        count=st.sampled_from([0, 1, 3, 9, 30, 60]),
        few=st.booleans(),
        modes=st.tuples(*[st.sampled_from(list(Extrapolation))] * 2),
        rules=st.lists(st.sampled_from(list(TangentRule)), min_size=1, max_size=7),
    )
    def begin(self, count: int, few: bool, modes: tuple[Extrapolation, Extrapolation], rules: list[int]) -> None:
        placing.FEW = placing.FEW_EACH = 2 if few else 512
        splicing.FEW = 1 if few else 6
        rules_out = np.resize(rules, count)
        rules_in = np.where(rules_out == TangentRule.STEP, TangentRule.FLAT, rules_out)
        run = make_run(np.arange(count) / 4, np.sin(np.arange(count)), 0.3, -0.7, rules_in, rules_out)
        other = make_run(np.arange(5) / 2, [0.0, 2.0, 1.0, 1.0, -3.0])
        self.document = Document(Clip([Channel("a", run, pre=modes[0], post=modes[1]), Channel("b", other)], end=10.0))
        self.document.changed.connect(self.hear)
        self.open()

    def open(self) -> None:
        clip = self.document.clip
        self.start, self.twin = everything(clip), Clip([channel.copy() for channel in clip.channels], end=10.0)
        self.twin_start = [channel.copy() for channel in clip.channels]
        self.asked = Selection.of_all(clip.channels)
        self.gesture = self.document.begin("Drag")
        self.shown = self.curves()

    def hear(self, channel: Channel, t0: float, t1: float) -> None:
        self.told.append((channel, t0, t1))

    def curves(self) -> list[np.ndarray]:
        """What is seen of the channels: values and slopes at many times."""
        times = np.linspace(-8.0, 25.0, 661)
        return [
            np.stack([channel.evaluate(times), *(channel.slopes(times, side) for side in ("in", "out"))])
            for channel in self.document.clip.channels
        ]

    def preview(self, verb: Verb, *, selects_new: bool = False) -> None:
        """Show what *verb* makes of the start, and hold it against what it makes of a fresh copy of the start."""
        self.told: list[tuple[Channel, float, float]] = []
        clip = self.document.clip
        seen: list[bytes] = []

        def compute(given: Clip) -> Iterable[Change]:
            seen.append(everything(given))
            for channel in given.channels:
                channel.check()
                self.read(channel)
            return verb(given)

        self.gesture.preview(compute, selection=added_keys if selects_new else None)
        assert seen == [self.start], "the edit was not worked out from the start"
        self.twin.channels[:] = [channel.copy() for channel in self.twin_start]
        Document(self.twin).do("Alone", verb)
        for channel, alone in zip(clip.channels, self.twin.channels, strict=True):
            assert without_ids(channel.run()) == without_ids(alone.run())
            self.sound(channel)
        self.told_enough()

    def read(self, channel: Channel) -> None:
        """Assert that the same questions are answered by the keys of now, whatever they were answered by before."""
        run = channel.run()
        assert channel.keys_between(-1e9, 1e9).tobytes() == run.tobytes()
        ids = self.asked.ids(channel)
        if all(key_id in channel for key_id in ids):
            assert channel.keys_of(ids).tobytes() == run[np.isin(run["id"], ids)].tobytes()

    def sound(self, channel: Channel) -> None:
        """Assert that *channel* holds together, and looks like one made of its keys at once."""
        channel.check()
        self.read(channel)
        anew = Channel(channel.name, channel.run(), pre=channel.pre, post=channel.post)
        edges = np.linspace(-3.0, 18.0, 43)
        for ours, theirs in zip(channel.envelope(edges), anew.envelope(edges), strict=True):
            assert ours.tobytes() == theirs.tobytes(), "the extremes are not those of the keys"

    def told_enough(self) -> None:
        before, self.shown = self.shown, self.curves()
        times = np.linspace(-8.0, 25.0, 661)
        for channel, old, new in zip(self.document.clip.channels, before, self.shown, strict=True):
            differs = (old != new).any(axis=0)
            for told, t0, t1 in self.told:
                if told is channel:
                    differs &= (times < t0) | (times > t1)
            assert not differs.any(), f"{channel.name} is different at {times[differs][:3]}, and nobody was told"

    @rule(mask=MASKS, d_time=TIMES, d_value=VALUES, reorder=st.booleans())
    def move(self, mask: int, d_time: float, d_value: float, reorder: bool) -> None:
        self.preview(lambda clip: edits.move(clip, chosen(clip, mask), d_time, d_value, reorder=reorder))

    @rule(mask=MASKS, ways=st.lists(st.tuples(TIMES, VALUES), min_size=1, max_size=4))
    def drag(self, mask: int, ways: list[tuple[float, float]]) -> None:
        for d_time, d_value in ways:
            self.move(mask, d_time, d_value, True)

    @rule(place=PLACES, d_time=TIMES, d_value=VALUES)
    def move_one(self, place: int, d_time: float, d_value: float) -> None:
        def verb(clip: Clip) -> Iterable[Change]:
            ids = clip.channels[0].run()["id"]
            return edits.move(
                clip, Selection.of({clip.channels[0]: ids[place % len(ids) :][:1] if len(ids) else []}), d_time, d_value
            )

        self.preview(verb)

    @rule(d_time=TIMES, d_value=VALUES)
    def move_all(self, d_time: float, d_value: float) -> None:
        self.preview(lambda clip: edits.move(clip, Selection.of_all(clip.channels), d_time, d_value))

    @rule(mask=MASKS, center=TIMES, f_time=st.sampled_from([-1.0, 0.5, 1.0, 2.0]), f_value=st.sampled_from([-1.0, 2.0]))
    def scale(self, mask: int, center: float, f_time: float, f_value: float) -> None:
        self.preview(lambda clip: edits.scale(clip, chosen(clip, mask), center, 0.0, f_time, f_value))

    @rule(mask=MASKS)
    def delete(self, mask: int) -> None:
        self.preview(lambda clip: edits.delete(clip, chosen(clip, mask)))

    @rule(times=st.lists(st.floats(-3.0, 18.0), min_size=1, max_size=40))
    def insert(self, times: list[float]) -> None:
        def verb(clip: Clip) -> Iterable[Change]:
            return edits.paste(
                clip,
                "hermite-keys 1\n"
                + "".join(f"a\t{time!r}\t1.0\t0.0\t0.0\tsmooth\tsmooth\tunified\n" for time in sorted(set(times))),
                None,
            )

        self.preview(verb, selects_new=True)

    @rule(time=st.floats(-3.0, 18.0))
    def insert_on_the_curve(self, time: float) -> None:
        self.preview(lambda clip: edits.key_all(clip, clip.channels, time), selects_new=True)

    @rule(mask=MASKS, d_time=TIMES)
    def duplicate(self, mask: int, d_time: float) -> None:
        self.preview(lambda clip: edits.duplicate(clip, chosen(clip, mask), d_time), selects_new=True)

    @rule(mask=MASKS, tangent_rule=st.sampled_from(list(TangentRule)), mode=st.sampled_from(list(Extrapolation)))
    def set_rule_and_extrapolation(self, mask: int, tangent_rule: TangentRule, mode: Extrapolation) -> None:
        self.preview(
            lambda clip: [
                *edits.set_rule(clip, chosen(clip, mask), tangent_rule),
                *edits.set_extrapolation(clip, clip.channels, post=mode),
            ]
        )

    @rule(mask=MASKS, d_time=TIMES)
    def splice_the_same_channel_twice(self, mask: int, d_time: float) -> None:
        def verb(clip: Clip) -> Iterable[Change]:
            channel = clip.channels[1]
            moved = edits.move(clip, Selection.of({channel: channel.run()["id"][:1]}), d_time, 1.0)
            far = make_run([float(channel.run()["time"][-1]) + 40.0], [1.0])
            return [*moved, Splice(channel, far[:0], far)]

        self.preview(verb)

    @rule(mask=MASKS, d_time=TIMES)
    def fail(self, mask: int, d_time: float) -> None:
        shown = everything(self.document.clip)

        def fails(clip: Clip) -> Iterable[Change]:
            bad = make_run([0.125, 0.125])
            return [*edits.move(clip, chosen(clip, mask), d_time, 1.0), Splice(clip.channels[1], bad[:0], bad)]

        with pytest.raises(ValueError, match="key"):
            self.gesture.preview(fails)
        assert everything(self.document.clip) == shown
        for channel in self.document.clip.channels:
            self.sound(channel)

    @rule(keep=st.booleans())
    def end(self, keep: bool) -> None:
        self.told = []
        shown = everything(self.document.clip)
        if keep:
            edit = self.gesture.commit()
            assert everything(self.document.clip) == shown
            if edit is not None:
                self.document.apply(edit.inverse())
                assert everything(self.document.clip) == self.start
                self.document.apply(edit)
                assert everything(self.document.clip) == shown
        else:
            self.gesture.cancel()
            assert everything(self.document.clip) == self.start
            self.told_enough()
        for channel in self.document.clip.channels:
            self.sound(channel)
        self.open()


def test_every_preview_shows_what_its_edit_makes_of_the_start(monkeypatch: pytest.MonkeyPatch) -> None:
    # Short rows, so that few keys take the ways of many.
    for module, name, size in (
        (rows, "WIDEST", 8),
        (rows, "FILLED", 6),
        (rows, "MANY_ROWS", 2),
        (placing, "FEW", 2),
        (placing, "FEW_EACH", 2),
        (splicing, "FEW", 6),
    ):
        monkeypatch.setattr(module, name, size)
    run_state_machine_as_test(
        Previews,
        settings=settings(
            max_examples=EXAMPLES,
            stateful_step_count=STEPS,
            deadline=None,
            database=None,
            derandomize=True,
            print_blob=False,
            phases=[Phase.generate, Phase.shrink],
            suppress_health_check=list(HealthCheck),
        ),
    )
