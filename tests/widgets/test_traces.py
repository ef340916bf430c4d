"""How channels are drawn: which curves are dashed."""

import pytest

from model.channel import Channel
from model.clip import Clip
from model.document import Document
from model.keyframe import make_run
from widgets.theme import Theme
from widgets.traces import MOST_DASHED, Trace, traces_of


def traces_with(count: int, *, lock: bool = False) -> tuple[Trace, ...]:
    """The traces of so many channels, of which the last is the active one and maybe locked."""
    document = Document(Clip([Channel(f"c{i}", make_run([0.0, 1.0], [0.0, 1.0])) for i in range(count)]))
    document.session.active = document.clip.channels[-1]
    document.clip.channels[-1].locked = lock
    return traces_of(document, Theme.current())


@pytest.mark.usefixtures("qapp")
def test_of_few_curves_those_of_one_colour_are_told_apart_by_dashes() -> None:
    dashes: dict[int, list[tuple[float, ...]]] = {}
    for trace in traces_with(MOST_DASHED):
        if not trace.active:  # the others are dimmed
            dashes.setdefault(trace.color.rgba(), []).append(trace.dash)
    alike = [patterns for patterns in dashes.values() if len(patterns) > 1]
    assert alike
    assert all(len(set(patterns)) == len(patterns) for patterns in alike)


@pytest.mark.usefixtures("qapp")
def test_of_many_curves_all_are_whole_the_active_one_too_unless_it_is_locked() -> None:
    assert all(trace.dash == () for trace in traces_with(MOST_DASHED + 1))
    assert [trace.active for trace in traces_with(MOST_DASHED + 1, lock=True) if trace.dash] == [True]


@pytest.mark.usefixtures("qapp")
def test_curves_given_the_same_colour_have_different_dashes() -> None:
    channels = [Channel(f"c{i}.v", make_run([0.0, 1.0], [0.0, 1.0]), color="#ff0000") for i in range(4)]
    traces = traces_of(Document(Clip(channels)), Theme.current())
    assert len({trace.dash for trace in traces}) == 4
    hidden = Document(Clip(channels))
    hidden.session.hidden = {channels[0]}
    before = {trace.channel: trace.dash for trace in traces}
    assert all(trace.dash == before[trace.channel] for trace in traces_of(hidden, Theme.current()))
