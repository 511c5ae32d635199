"""The list of findings: told once they last, counted on the tab, and a way to each place."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.tui.graph_stage import Stage, opened
from tests.tui.recorded import RecordedGraph
from tests.tui.recorded_findings import ill_graph
from tests.tui.recorded_nodes import graph_update
from tui import clock
from tui.graph.places import GraphKind, GraphPlace
from tui.widgets.tab_line import TabLine

LATER_S = 60.0
NEAR = "near-name topic /sensor/sonar_frnt"
UNSERVED = "unserved service /set_head_postion"


@pytest.fixture
def later(monkeypatch: pytest.MonkeyPatch) -> Callable[[float], None]:
    """Set the steady clock to so many seconds after the start."""
    start_s = clock.steady()

    def at(seconds: float) -> None:
        monkeypatch.setattr(clock, "steady", lambda: start_s + seconds)

    at(0.0)
    return at


def tab_words(stage: Stage) -> str:
    return stage.screen.query_one(TabLine).render().plain


async def test_what_lasts_is_counted_on_the_tab_and_listed_the_worst_first(
    later: Callable[[float], None],
) -> None:
    async with opened(RecordedGraph(update=ill_graph())) as stage:
        assert "Findings 0" in tab_words(stage)
        later(LATER_S)
        # Nothing need arrive for that.
        await stage.wait(lambda: "Findings 4" in tab_words(stage))
        stage.screen.list_kind(GraphKind.FINDING)
        await stage.wait_for("✗ error · incompatible QoS")
        assert stage.graph.measured
        listed = [entry.label for entry in stage.screen.index.listed[GraphKind.FINDING]]
        assert listed == [
            "✗ /camera/color/image_raw",
            "✗ /sensor/sonar_frnt",
            "✗ /set_head_postion",
            "▲ /imu",
        ]
        stage.screen.list_kind(GraphKind.NODE)
        await stage.press()
        assert not stage.graph.measured


async def test_a_finding_that_is_mended_leaves_the_list(later: Callable[[float], None]) -> None:
    async with opened(RecordedGraph(update=ill_graph())) as stage:
        later(LATER_S)
        stage.screen.list_kind(GraphKind.FINDING)
        await stage.show(ill_graph())
        await stage.choose(NEAR)
        await stage.show(graph_update())
        await stage.wait_for("no findings")
        assert "Findings 0" in tab_words(stage)
        assert "gone" not in stage.seen()


async def test_enter_goes_to_the_topic_and_links_to_the_nodes(
    later: Callable[[float], None],
) -> None:
    async with opened(RecordedGraph(update=ill_graph())) as stage:
        later(LATER_S)
        stage.screen.list_kind(GraphKind.FINDING)
        await stage.show(ill_graph())
        await stage.choose(NEAR)
        pane = stage.screen.pane
        assert pane is not None
        assert pane.ros2_command() == "ros2 topic info --verbose /sensor/sonar_frnt"
        first = pane.first()
        assert first is not None
        first.focus()
        await stage.press("down", "enter")
        assert stage.screen.history.here == GraphPlace(GraphKind.NODE, "/guard")
        await stage.press("escape")
        assert stage.screen.history.here == GraphPlace(GraphKind.FINDING, NEAR)
        await stage.press("enter")
        assert stage.app.screen is stage.app.get_screen("topics")
        await stage.wait_for("/sensor/sonar_frnt")


async def test_a_service_that_does_not_exist_leads_to_who_calls_it(
    later: Callable[[float], None],
) -> None:
    async with opened(RecordedGraph(update=ill_graph())) as stage:
        later(LATER_S)
        stage.screen.list_kind(GraphKind.FINDING)
        await stage.show(ill_graph())
        await stage.choose(UNSERVED)
        await stage.press("enter")
        assert stage.screen.history.here == GraphPlace(GraphKind.NODE, "/guard")


async def test_the_filter_finds_words_of_the_sentence(later: Callable[[float], None]) -> None:
    async with opened(RecordedGraph(update=ill_graph())) as stage:
        later(LATER_S)
        stage.screen.list_kind(GraphKind.FINDING)
        await stage.show(ill_graph())
        stage.screen.filter.value = "future"
        await stage.wait(lambda: stage.screen.names.chosen_name == "clock topic /imu")
