"""A random walk through all edits, undo and redo: every state is sound, and every step back is exact."""

import re
from collections.abc import Callable, Iterable
from typing import Any, ClassVar

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule, run_state_machine_as_test

from model import edits, placing
from model.channel import Channel
from model.clip import Clip
from model.clipboard import text_from_keys
from model.document import Change, Document, Edit, Membership, Splice, added_keys
from model.extrapolation import Extrapolation
from model.formats import write_bytes
from model.keyframe import TangentRule, make_run
from model.selection import Selection
from tests.model.editing import everything

# Each example is some 50 edits, all of which are undone and redone at its end: steps like any other. How many there
# are in all shifts a little with the sources, whose numbers hypothesis tries too.
EXAMPLES = 200
STEPS = 20_000

TIMES = st.one_of(
    st.sampled_from([0.0, -0.0, 0.5, 1.0, 2.0, 1 / 3, 1e-9, 5e-324, 1e9, -1e9]),
    st.integers(-8, 8).map(lambda n: n / 4),
    st.floats(-1e6, 1e6, allow_nan=False),
)
VALUES = st.one_of(
    st.sampled_from([0.0, -0.0, 1.0, -1.0, 1e300, -1e300, 5e-324]),
    st.floats(-1e3, 1e3),
    st.floats(allow_nan=False, allow_infinity=False),
)
FACTORS = st.sampled_from([-2.0, -1.0, -0.5, 0.0, 1e-3, 0.5, 1.0, 1.5, 1e3])
# A number whose bits say, key by key, whether a key is selected.
MASKS = st.integers(1, 2**24 - 1)
PLACES = st.integers(0, 2**16)
RULES = st.sampled_from(list(TangentRule))
MODES = st.sampled_from(list(Extrapolation))
SIDES = st.sampled_from(["in", "out"])

type Compute = Callable[[Clip], Iterable[Change]]


class Walk(RuleBasedStateMachine):
    """A document beside the bytes of all its states."""

    steps: ClassVar[int] = 0

    def __init__(self) -> None:
        super().__init__()
        self.few = placing.FEW, placing.FEW_EACH

    @initialize(count=st.integers(0, 9), long=st.sampled_from([0, 0, 0, 0, 1000]), few=st.booleans())
    def open(self, count: int, long: int, few: bool) -> None:
        if few:  # so that small channels take the ways of large ones
            placing.FEW = placing.FEW_EACH = 1
        a = Channel("root.tx", make_run(np.arange(count) / 4, np.sin(np.arange(count))))
        b = Channel("root.ty", make_run(np.arange(5) / 2, [0.0, 2.0, 1.0, 1.0, -3.0]), post=Extrapolation.CYCLE)
        c = Channel("head.rx", make_run(np.arange(long) / 8, np.cos(np.arange(long))), unit="angle")
        self.document = Document(Clip([a, b, c], end=10.0))
        self.states = [everything(self.document.clip)]
        self.opening = write_bytes(self.document.clip, "hermite")
        self.history: list[Edit] = []
        self.position = 0
        self.revisions: dict[Channel, int] = {}
        self.fresh_names = 0
        self.document.committed.connect(self.remember)

    def remember(self, edit: Edit) -> None:
        del self.history[self.position :], self.states[self.position + 1 :]
        self.history.append(edit)
        self.states.append(everything(self.document.clip))
        self.position += 1

    def chosen(self, mask: int) -> Selection:
        """Keys of all channels by the bits of *mask*, over and over."""
        ids = {}
        for shift, channel in enumerate(self.document.clip.channels):
            column = channel.run()["id"]
            bits = np.array([mask >> ((place + 7 * shift) % 24) & 1 for place in range(len(column))], np.bool_)
            ids[channel] = column[bits]
        return Selection.of(ids)

    def channel(self, place: int) -> Channel | None:
        channels = self.document.clip.channels
        return channels[place % len(channels)] if channels else None

    def do(self, compute: Compute, selection: Any = None) -> Edit | None:
        """One edit that must leave locked channels alone."""
        locked = {channel: channel.run().tobytes() for channel in self.document.clip.channels if channel.locked}
        edit = self.document.do("Edit", compute, selection=selection)
        for channel, run in locked.items():
            assert channel.run().tobytes() == run, "a locked channel was changed"
        return edit

    def refused(self, why: str, compute: Compute, selection: Any = None) -> bool:
        """Whether the edit was refused, which it may only be for the reason *why*."""
        try:
            self.do(compute, selection)
        except ValueError as refusal:
            if re.search(why, str(refusal)) is None:
                raise
            return True
        return False

    # --- edits

    @rule(mask=MASKS)
    def select(self, mask: int) -> None:
        self.document.session.selection = self.chosen(mask)

    @rule(mask=MASKS, d_time=TIMES, d_value=VALUES, reorder=st.booleans())
    def move(self, mask: int, d_time: float, d_value: float, reorder: bool) -> None:
        selection = self.chosen(mask)
        before = {channel: channel.run() for channel in selection.channels}
        self.do(lambda clip: edits.move(clip, selection, d_time, d_value, reorder=reorder))
        for channel, run in before.items():
            gone = run[~np.isin(run["id"], channel.run()["id"])]
            moved = channel.keys_of(selection.ids(channel))  # none of them is gone
            assert not len(gone) or (reorder and d_time != 0.0), "a key was covered by keys that did not go past it"
            for time in gone["time"]:
                apart = np.abs(moved["time"] - time).min()
                assert apart <= 4.0 * np.spacing(np.abs([*moved["time"], *run["time"]]).max()), (
                    "not landed on, and gone"
                )
            if not reorder:
                assert channel.run()["id"].tolist() == run["id"].tolist()

    @rule(mask=MASKS, ways=st.lists(st.tuples(TIMES, VALUES), max_size=4), keep=st.booleans())
    def drag(self, mask: int, ways: list[tuple[float, float]], keep: bool) -> None:
        selection = self.chosen(mask)
        before = everything(self.document.clip)
        gesture = self.document.begin("Drag")
        for d_time, d_value in ways:
            gesture.preview(lambda clip, t=d_time, v=d_value: edits.move(clip, selection, t, v))  # type: ignore[misc]
        shown = everything(self.document.clip)
        with pytest.raises(ValueError, match="d_time is nan"):
            gesture.preview(lambda clip: edits.move(clip, selection, np.nan, 0.0))
        assert everything(self.document.clip) == shown
        if keep:
            gesture.commit()
            assert everything(self.document.clip) == shown
        else:
            gesture.cancel()
            assert everything(self.document.clip) == before

    @rule(mask=MASKS, time=TIMES, value=VALUES, f_time=FACTORS, f_value=FACTORS)
    def scale(self, mask: int, time: float, value: float, f_time: float, f_value: float) -> None:
        selection = self.chosen(mask)
        self.do(lambda clip: edits.scale(clip, selection, time, value, f_time, f_value))

    @rule(mask=MASKS, tangent_rule=RULES, side=st.sampled_from(["in", "out", "both"]))
    def set_rule(self, mask: int, tangent_rule: TangentRule, side: str) -> None:
        self.do(lambda clip: edits.set_rule(clip, self.chosen(mask), tangent_rule, side))

    @rule(place=PLACES, key=PLACES, side=SIDES, slope=VALUES)
    def set_slope(self, place: int, key: int, side: str, slope: float) -> None:
        channel = self.channel(place)
        if channel:
            key_id = int(channel.run()["id"][key % len(channel)])
            self.do(lambda clip: edits.set_slope(clip, channel, key_id, side, slope))

    @rule(mask=MASKS, unify=st.booleans())
    def break_or_unify(self, mask: int, unify: bool) -> None:
        verb = edits.unify_tangents if unify else edits.break_tangents
        self.do(lambda clip: verb(clip, self.chosen(mask)))

    @rule(place=PLACES, time=TIMES)
    def insert(self, place: int, time: float) -> None:
        channel = self.channel(place)
        if channel is not None:
            self.do(lambda clip: edits.insert(clip, channel, time), added_keys)
            assert channel.locked or channel.key_at(time) is not None

    @rule(place=PLACES, time=TIMES, value=VALUES, tangent_rule=RULES)
    def insert_key(self, place: int, time: float, value: float, tangent_rule: TangentRule) -> None:
        channel = self.channel(place)
        if channel is not None:
            self.do(lambda clip: edits.insert_key(clip, channel, time, value, tangent_rule))
            assert channel.locked or channel.value(time) == value

    @rule(time=TIMES)
    def key_all(self, time: float) -> None:
        self.do(lambda clip: edits.key_all(clip, clip.channels, time), added_keys)

    @rule(mask=MASKS)
    def delete(self, mask: int) -> None:
        selection = self.document.session.selection = self.chosen(mask)
        edit = self.do(lambda clip: edits.delete(clip, selection))
        if edit is not None and all(not channel.locked for channel in selection.channels):
            assert self.document.session.selection == Selection.NONE

    @rule(mask=MASKS, field=st.sampled_from(["time", "value", "slope_in", "slope_out"]), number=VALUES, add=TIMES)
    def set_field(self, mask: int, field: str, number: float, add: float) -> None:
        def compute(column: np.ndarray) -> np.ndarray:
            with np.errstate(all="ignore"):
                return column * number + add

        before = everything(self.document.clip)
        if not self.refused(
            "must be finite|two keys of", lambda clip: edits.set_field(clip, self.chosen(mask), field, compute)
        ):
            return
        assert everything(self.document.clip) == before

    @rule(mask=MASKS, time=TIMES, replace=st.booleans(), place=PLACES)
    def copy_and_paste(self, mask: int, time: float, replace: bool, place: int) -> None:
        selection = self.chosen(mask)
        if selection:
            text, active = text_from_keys(selection), self.channel(place)
            self.refused(
                "no unlocked channel",
                lambda clip: edits.paste(clip, text, time, active=active, replace=replace),
                added_keys,
            )

    @rule(mask=MASKS, d_time=TIMES, d_value=VALUES)
    def duplicate(self, mask: int, d_time: float, d_value: float) -> None:
        self.do(lambda clip: edits.duplicate(clip, self.chosen(mask), d_time, d_value), added_keys)

    @rule(place=PLACES, pre=MODES, post=MODES)
    def set_extrapolation(self, place: int, pre: Extrapolation, post: Extrapolation) -> None:
        channel = self.channel(place)
        if channel is not None:
            self.do(lambda clip: edits.set_extrapolation(clip, [channel], pre, post))

    @rule(
        place=PLACES,
        setting=st.sampled_from(
            [
                ("locked", True),
                ("locked", False),
                ("unit", "m"),
                ("color", "#10a0ff"),
                ("color", None),
                ("name", "tail.rx"),
            ]
        ),
    )
    def set_setting(self, place: int, setting: tuple[str, Any]) -> None:
        channel = self.channel(place)
        if channel is not None:
            self.refused("already is a channel", lambda clip: edits.set_setting(clip, [channel], *setting))

    @rule(start=TIMES, end=TIMES)
    def set_range(self, start: float, end: float) -> None:
        before = everything(self.document.clip)
        changes = [("start", start), ("end", end)]
        refused = self.refused(
            "before its start",
            lambda clip: [c for name, t in changes for c in edits.set_setting(clip, [clip], name, t)],
        )
        assert refused == (end < start)
        assert not refused or everything(self.document.clip) == before

    @rule(place=PLACES, add=st.booleans())
    def add_or_remove_channel(self, place: int, add: bool) -> None:
        before = tuple(self.document.clip.channels)
        place %= len(before) + 1
        if add and len(before) < 5:
            self.fresh_names += 1
            new = Channel(f"new{self.fresh_names}", make_run([0.0, 1.0], [0.0, 1.0]))
            after = (*before[:place], new, *before[place:])
        else:
            after = (*before[:place], *before[place + 1 :])
        self.document.do("Channels", lambda clip: [Membership(before, after)])

    @rule(mask=MASKS, time=TIMES, part=st.integers(0, 20))
    def fail_in_the_middle(self, mask: int, time: float, part: int) -> None:
        selection = self.chosen(mask)

        def compute(clip: Clip) -> Iterable[Change]:
            changes = [
                *edits.set_extrapolation(clip, clip.channels, pre=Extrapolation.BOUNCE),
                *edits.move(clip, selection, time, 1.0),
            ]
            bad = make_run([0.0, 0.0], 0.0)
            victim = clip.channels[0] if clip.channels else Channel("x")
            changes.insert(min(part, len(changes)), Splice(victim, bad[:0], bad))
            return changes

        with pytest.raises(ValueError, match="key"):
            self.document.do("Fails", compute)

    # --- history

    @rule()
    def undo(self) -> None:
        if self.position:
            self.position -= 1
            edit = self.history[self.position]
            self.document.apply(edit.inverse())
            assert self.document.session.selection == edit.selection_before
            self.sound()

    @rule()
    def redo(self) -> None:
        if self.position < len(self.history):
            edit = self.history[self.position]
            self.position += 1
            self.document.apply(edit)
            assert self.document.session.selection == edit.selection_after
            self.sound()

    @rule(count=st.integers(2, 9))
    def undo_and_redo_many(self, count: int) -> None:
        count = min(count, self.position)
        for _ in range(count):
            self.undo()
        for _ in range(count):
            self.redo()

    # --- what always holds

    @invariant()
    def every_state_is_sound(self) -> None:
        self.sound()

    def sound(self) -> None:
        """Assert what holds after every step, and count the step."""
        Walk.steps += 1
        clip, selection = self.document.clip, self.document.session.selection
        for channel in clip.channels:
            if self.revisions.get(channel) != channel.revision:
                channel.check()
                self.revisions[channel] = channel.revision
        assert everything(clip) == self.states[self.position], "not the bytes of this state"
        for channel in selection.channels:
            assert channel in clip.channels
            assert all(key_id in channel for key_id in selection.ids(channel)), "a key is selected that is gone"

    def teardown(self) -> None:
        placing.FEW, placing.FEW_EACH = self.few
        last = self.position
        while self.position:
            self.undo()
        assert write_bytes(self.document.clip, "hermite") == self.opening
        while self.position < last:
            self.redo()


@pytest.mark.timeout(900)
def test_a_walk_of_20_000_steps_ends_where_it_began() -> None:
    Walk.steps = 0
    run_state_machine_as_test(
        Walk,
        settings=settings(
            max_examples=EXAMPLES,
            stateful_step_count=50,
            deadline=None,
            database=None,
            derandomize=True,
            print_blob=False,
            phases=[Phase.generate, Phase.shrink],
            suppress_health_check=list(HealthCheck),
        ),
    )
    assert Walk.steps >= STEPS
