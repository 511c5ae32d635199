"""The plot: numbers of any field, gaps, and what stands on screen."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from graph.data import GraphUpdate, Sample
from tests.tui.panel_stage import Bare, rows
from tests.tui.recorded import NOW_S, RecordedGraph, RecordedOpener, lesson_update
from tests.tui.snapshots import Look, settle
from tui.topics.plot import TopicPlot, axis_for, curve
from tui.topics.plot_history import History, PlotField
from tui.topics.screen import TopicsScreen

FLOAT = "std_msgs/msg/Float32"
DATA = PlotField("/number", ("data",))


def said(topic: str, at_s: float, **value: Any) -> Sample:
    return Sample(topic, FLOAT, at_s, 0.0, 8, value)


def update(at_s: float, *samples: Sample) -> GraphUpdate:
    return GraphUpdate(at_s, samples={sample.topic: (sample,) for sample in samples})


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
        (("joints", 1, "x"), {"joints": [{"x": 1}, {"x": 2}]}, 2.0),
        (("data",), {"data": "5"}, None),
        (("gone",), {"data": 5}, None),
    ],
)
def test_any_number_of_a_message_can_be_had(path: tuple[str | int, ...], value: Any, number: float | None) -> None:
    assert PlotField("/a", path).number(value) == number


def drawn_in(dots: NDArray[Any]) -> NDArray[np.bool_]:
    """Of each column of cells whether anything is drawn in it."""
    drawn: NDArray[np.bool_] = np.any(dots, axis=0).reshape(-1, 2).any(axis=1)
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


async def test_two_fields_have_letters_a_range_and_their_own_look() -> None:
    plot = TopicPlot()
    async with Bare(plot).run_test(size=(90, 24)):
        assert plot.toggle(DATA)
        assert plot.toggle(PlotField("/other", ("pose", "x")))
        for n in range(40):
            at_s = NOW_S + n / 4
            other = said("/other", at_s, pose={"x": 5.0 - n / 10})
            plot.take(update(at_s, said("/number", at_s, data=n / 10), other))
        text = "\n".join(rows(plot))
        assert "Plot · 30 s" in text
        assert "A /number data" in text
        assert "3.9000    0.0000    3.9000" in text
        assert "B /other pose.x" in text
        assert text.splitlines()[-1].endswith("now")
        assert plot.topics == {"/number", "/other"}
        assert not plot.toggle(DATA)
        assert "/number" not in "\n".join(rows(plot))
        assert "B /other pose.x" in "\n".join(rows(plot))


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
    assert screen.plot_place == "none"
    await pilot.press("enter", "down", "down", "V")
    await pilot.pause()
    assert screen.plot.fields == (PlotField("/drive", ("drive", "steering_angle")),)
    assert screen.plot.display
    assert "/drive" in graph.wanted.followed
    assert any("◂ A" in screen.detail.echo.render_line(y).text for y in range(6))
    await pilot.press("4")
    await settle(pilot)
    assert "/drive" in graph.wanted.followed
    await pilot.press("2")
    graph.show(lesson_update())
    await settle(pilot)
    screen.detail.echo.focus()
    await pilot.press("home", "down", "down", "V")
    await pilot.pause()
    assert not screen.plot.fields
    assert screen.plot_place == "none"
    assert "/drive" not in screen.follow_topics()
