"""The plot: numbers of any field, gaps, round axes, bounded memory, and what stands on screen."""

from __future__ import annotations

import math
import tracemalloc
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from numpy.typing import NDArray
from textual.app import App, ComposeResult

from graph.data import GraphUpdate, Sample
from tests.tui.recorded import NOW_S, RecordedGraph, RecordedOpener, lesson_update
from tests.tui.snapshots import Look, settle
from tui.topics.plot.axis import axis_for
from tui.topics.plot.curve import curve
from tui.topics.plot.field import PlotField
from tui.topics.plot.history import History
from tui.topics.plot.plot import TopicPlot
from tui.topics.plotting import PlotPlace
from tui.topics.screen import TopicsScreen

if TYPE_CHECKING:
    from collections.abc import Iterable

FLOAT = "std_msgs/msg/Float32"
DATA = PlotField("/number", ("data",))


class PlotApp(App[None]):
    """A bare app with nothing but the plot."""

    def compose(self) -> ComposeResult:
        """The plot fills the screen."""
        yield TopicPlot()

    @property
    def plot(self) -> TopicPlot:
        """The plot."""
        return self.query_one(TopicPlot)

    def text(self) -> str:
        """What is drawn."""
        return "\n".join(
            self.plot.render_line(y).text.rstrip() for y in range(self.plot.size.height)
        )


def said(topic: str, at_s: float, **value: Any) -> Sample:
    return Sample(topic, FLOAT, at_s, 0.0, 8, value)


def update(at_s: float, *samples: Sample) -> GraphUpdate:
    by_topic: dict[str, tuple[Sample, ...]] = {}
    for sample in samples:
        by_topic[sample.topic] = (*by_topic.get(sample.topic, ()), sample)
    return GraphUpdate(at_s, samples=by_topic)


def history(numbers: Iterable[tuple[float, float | None]]) -> History:
    kept = History()
    for at_s, number in numbers:
        kept.add(NOW_S + at_s, number)
    return kept


@pytest.mark.parametrize(
    ("path", "value", "number"),
    [
        (("data",), {"data": 1.5}, 1.5),
        (("data",), {"data": True}, 1.0),
        (("data",), {"data": np.float32(0.5)}, 0.5),
        (("data",), {"data": 10**400}, math.inf),
        (("ranges", 3), {"ranges": np.arange(9, dtype=np.float32)}, 3.0),
        (("ranges", 9), {"ranges": np.arange(9)}, None),
        (("ranges",), {"ranges": np.arange(1)}, None),
        (("pose", "x"), {"pose": {"x": -2}}, -2.0),
        (("joints", 1, "x"), {"joints": [{"x": 1}, {"x": 2}]}, 2.0),
        (("data", 0), {"data": "5"}, None),
        (("data",), {"data": "5"}, None),
        (("data",), {"data": b"5"}, None),
        (("gone",), {"data": 5}, None),
        (("data", "deeper"), {"data": 5}, None),
    ],
)
def test_any_number_of_a_message_can_be_had(
    path: tuple[str | int, ...], value: Any, number: float | None
) -> None:
    assert PlotField("/a", path).number(value) == number


def drawn_in(dots: NDArray[Any]) -> NDArray[np.bool_]:
    """Of each column whether anything is drawn in it."""
    drawn: NDArray[np.bool_] = np.any(dots, axis=0)
    return drawn


def test_what_is_not_finite_leaves_a_gap_and_so_does_silence() -> None:
    axis = axis_for(0, 2, 2)
    whole = history([(t / 2, 1.0) for t in range(20)])
    assert drawn_in(curve(whole.columns(NOW_S + 10, 10.0, 40), axis, 2))[1:19].all()
    broken = history([(t / 2, math.nan if 6 <= t < 14 else 1.0) for t in range(20)])
    drawn = drawn_in(curve(broken.columns(NOW_S + 10, 10.0, 40), axis, 2))
    assert drawn[2:5].all()
    assert not drawn[7:12].any()
    assert drawn[15:18].all()
    silent = history([*((t / 2, 1.0) for t in range(5)), (9, 1.0), (9.5, 1.0)])
    assert not drawn_in(curve(silent.columns(NOW_S + 10, 10.0, 40), axis, 2))[8:16].any()


def test_a_peak_between_two_dots_is_not_lost() -> None:
    peak = history([*((t / 100, 0.0) for t in range(3000)), (30.005, 5.0), (30.01, 0.0)])
    assert np.nanmax(peak.columns(NOW_S + 300, 300.0, 40).high) == 5.0


def test_memory_is_bounded_however_much_comes() -> None:
    kept = History()
    tracemalloc.start()
    for n in range(12_000):
        kept.add(NOW_S + n / 20, float(n))
    grown, _peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    # Every sample kept would be a megabyte; another thread may take a little meanwhile.
    assert grown < 100_000
    assert kept.range(NOW_S + 600, 300.0) == pytest.approx((6_000, 11_999), abs=5)


@pytest.mark.parametrize(
    ("low", "high"),
    [(0, 1), (-0.2, 2.82), (1e-7, 3e-7), (-1e12, 5e13), (5, 5), (0, 0), (-3, -3), (1e300, 1e308)],
)
@pytest.mark.parametrize("ticks", [1, 3, 10])
def test_axes_hold_their_numbers_and_have_round_ticks(low: float, high: float, ticks: int) -> None:
    axis = axis_for(low, high, ticks)
    bound = 1e15
    assert axis.low <= max(-bound, min(low, bound))
    assert axis.high >= min(high, bound) * (1 - 1e-12)
    assert 1 <= len(axis.ticks) <= ticks + 2
    labels = [axis.label(tick) for tick in axis.ticks]
    assert len(set(labels)) == len(labels)
    assert all(len(label) <= 10 for label in labels)


async def test_two_fields_have_letters_a_range_and_their_own_look() -> None:
    app = PlotApp()
    async with app.run_test(size=(90, 24)):
        assert app.plot.toggle(DATA)
        assert app.plot.toggle(PlotField("/other", ("pose", "x")))
        for n in range(40):
            at_s = NOW_S + n / 4
            other = said("/other", at_s, pose={"x": 5.0 - n / 10})
            app.plot.take(update(at_s, said("/number", at_s, data=n / 10), other))
        text = app.text()
        assert "Plot · 30 s" in text
        assert "A /number data" in text
        assert "3.9000    0.0000    3.9000" in text
        assert "B /other pose.x" in text
        assert text.splitlines()[-1].endswith("now")
        assert app.plot.topics == {"/number", "/other"}
        assert not app.plot.toggle(DATA)
        assert "/number" not in app.text()
        assert "B /other pose.x" in app.text()


async def test_a_field_that_is_gone_says_so() -> None:
    app = PlotApp()
    async with app.run_test(size=(90, 24)):
        app.plot.toggle(PlotField("/a", ("ranges", 3)))
        app.plot.take(update(NOW_S, said("/a", NOW_S, ranges=np.arange(2))))
        assert "no number there" in app.text()


@pytest.fixture
async def stage() -> Any:
    graph = RecordedGraph()
    look = Look((120, 40), "en")
    app = look.app("topics", RecordedOpener(graph=graph))
    async with app.run_test(size=look.size) as pilot:
        await settle(pilot)
        screen = app.screen
        assert isinstance(screen, TopicsScreen)
        screen.table.choose("/drive")
        await pilot.pause()
        graph.show(lesson_update())
        await pilot.pause()
        yield screen, pilot, graph


async def test_a_key_plots_the_number_at_the_cursor_and_every_message_is_wanted(stage: Any) -> None:
    screen, pilot, graph = stage
    await pilot.press("V")
    assert screen.plotting.place is PlotPlace.NONE
    await pilot.press("enter", "down", "down", "V")
    await pilot.pause()
    assert screen.plot.fields == (PlotField("/drive", ("drive", "steering_angle")),)
    assert screen.plot.display
    assert "/drive" in graph.followed
    assert any("◂ A" in screen.detail.echo.render_line(y).text for y in range(6))
    screen.table.choose("/sensor/sonar_front")
    await pilot.pause()
    assert screen.plot.fields
    assert "/drive" in graph.followed
    await pilot.press("4")
    await settle(pilot)
    assert "/drive" in graph.followed
    sample = replace(lesson_update().samples["/drive"][0], received_s=NOW_S + 4)
    graph.show(lesson_update(time_s=NOW_S + 4, samples={"/drive": (sample,)}))
    await pilot.press("2")
    await pilot.pause()
    screen.table.choose("/drive")
    await pilot.pause()
    graph.show(lesson_update())
    await pilot.pause()
    screen.detail.echo.focus()
    await pilot.press("home", "down", "down", "V")
    await pilot.pause()
    assert not screen.plot.fields
    assert screen.plotting.place is PlotPlace.NONE
    assert "/drive" not in graph.followed


async def test_the_plot_goes_beside_alone_and_away(stage: Any) -> None:
    screen, pilot, _graph = stage
    await pilot.press("enter", "down", "down", "V", "v")
    await pilot.pause()
    assert screen.plotting.covers_all
    assert not screen.table.display
    await pilot.press("A", "p")
    assert "Plot · 60 s" in screen.plot.render_line(0).text
    assert screen.plot.paused
    await pilot.press("escape")
    await pilot.pause()
    assert screen.plotting.place is PlotPlace.BESIDE
    assert screen.table.has_focus
    await pilot.press("p")
    assert not screen.plot.paused
    await pilot.press("v", "v")
    await pilot.pause()
    assert not screen.plot.display
    assert screen.plot.fields
    await pilot.press("D")
    assert not screen.plot.fields
