"""The list of findings: told once they last, counted on the tab, and a way to each place."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable

import pytest

from launcher.status import NodeState
from tests.tui.graph_stage import GraphStage, opened
from tests.tui.recorded import RecordedGraph
from tests.tui.recorded_findings import ill_graph
from tests.tui.recorded_nodes import graph_update
from tui import clock
from tui.graph.places import GraphKind, GraphPlace
from tui.widgets.tab_line import TabLine

LATER_S = 60.0
NEAR = "near-name topic /sensor/sonar_frnt"


@pytest.fixture
def later(monkeypatch: pytest.MonkeyPatch) -> Callable[[float], None]:
    """Set the steady clock to so many seconds after the start."""
    start_s = clock.steady()

    def at(seconds: float) -> None:
        monkeypatch.setattr(clock, "steady", lambda: start_s + seconds)

    at(0.0)
    return at


@pytest.fixture
async def listed(later: Callable[[float], None]) -> AsyncIterator[GraphStage]:
    """The list of what is wrong with a graph that is ill, once it has lasted."""
    async with opened(RecordedGraph(update=ill_graph())) as stage:
        later(LATER_S)
        stage.screen.list_kind(GraphKind.FINDING)
        await stage.show(ill_graph())
        yield stage


def tab_words(stage: GraphStage) -> str:
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


async def test_a_finding_that_is_mended_leaves_the_list(listed: GraphStage) -> None:
    await listed.choose(NEAR)
    await listed.show(graph_update())
    await listed.wait_for("no findings")
    assert "Findings 0" in tab_words(listed)
    assert "gone" not in listed.seen()


async def test_enter_goes_to_the_topic_and_links_to_the_nodes(listed: GraphStage) -> None:
    await listed.choose(NEAR)
    pane = listed.screen.pane
    assert pane is not None
    assert pane.ros2_command() == "ros2 topic info --verbose /sensor/sonar_frnt"
    first = pane.first()
    assert first is not None
    first.focus()
    await listed.press("down", "enter")
    assert listed.screen.history.here == GraphPlace(GraphKind.NODE, "/guard")
    await listed.press("escape")
    assert listed.screen.history.here == GraphPlace(GraphKind.FINDING, NEAR)
    await listed.press("enter")
    assert listed.app.screen is listed.app.get_screen("topics")
    await listed.wait_for("/sensor/sonar_frnt")


async def test_a_node_of_the_lesson_that_has_failed_is_found() -> None:
    async with opened() as stage:
        assert "Findings 0" in tab_words(stage)
        stage.session.set_state("camera", NodeState.FAILED, detail="exit code 1", pid=None)
        await stage.wait(lambda: "Findings 1" in tab_words(stage))
        stage.screen.list_kind(GraphKind.FINDING)
        await stage.wait_for("✗ error · has failed")
        await stage.wait_for("It has failed, and is not started again: exit code 1")
        stage.session.set_state("camera", NodeState.READY, detail="", pid=7)
        await stage.wait(lambda: "Findings 0" in tab_words(stage))
