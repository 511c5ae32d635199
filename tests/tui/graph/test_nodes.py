"""The graph: nodes and their inner states, links between them, and what is found wrong."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from dataclasses import replace

import pytest

from graph.inner_states import LifecycleRow, TransitionResult
from graph.observer.requests import ChangeState
from launcher.status import NodeState
from tests.tui.graph_stage import GraphStage, opened
from tests.tui.recorded import RecordedGraph
from tests.tui.recorded_inner import managed_update
from tests.tui.recorded_nodes import NODE_ROWS, graph_update, ill_graph
from tui import clock
from tui.dialogs.choice import ChoiceScreen
from tui.frame.key_bar import KeyBar
from tui.graph.index import GraphKind, GraphPlace
from tui.topics.screen import TopicsScreen
from tui.widgets.tab_line import TabLine


@pytest.fixture
async def stage() -> AsyncIterator[GraphStage]:
    async with opened() as opened_room:
        yield opened_room


async def test_a_node_tells_with_whom_it_talks_and_which_process_it_is(stage: GraphStage) -> None:
    await stage.choose("/safety_stop")
    seen = " ".join(stage.seen().split())
    assert "● ready · process 4205 · CPU 2 % · 22 MB" in seen
    assert "/drive_safe → electronic_differential" in seen
    assert "/sensor/sonar_front ← sonar_front" in seen
    assert "/emergency_stop nobody" in seen
    assert "parameter_events" not in seen


async def test_what_ros_needs_is_hidden_until_it_is_asked_for(stage: GraphStage) -> None:
    await stage.press("right")
    assert stage.screen.history.kind is GraphKind.SERVICE
    assert "/camera/set_parameters" not in stage.seen()
    await stage.press("a")
    assert "/camera/set_parameters" in stage.seen()
    await stage.press("left", "a")
    assert "/rosout" not in stage.seen()


async def test_enter_on_a_topic_goes_to_the_screen_of_topics(stage: GraphStage) -> None:
    await stage.choose("/sonar_front")
    await stage.press("enter", "enter")
    await stage.wait(lambda: isinstance(stage.app.screen, TopicsScreen))
    topics = stage.app.screen
    assert isinstance(topics, TopicsScreen)
    await stage.wait(lambda: topics.table.chosen == "/sensor/sonar_front")
    await stage.press("5")
    assert stage.app.screen is stage.screen
    assert stage.screen.history.here == GraphPlace(GraphKind.NODE, "/sonar_front")


async def test_a_chosen_node_that_vanishes_stays_and_says_so(stage: GraphStage) -> None:
    await stage.choose("/camera")
    rest = tuple(row for row in NODE_ROWS if row.name != "/camera")
    await stage.show(graph_update(nodes=rest))
    assert stage.screen.names.chosen_name == "/camera"
    assert "this node has left the graph" in stage.seen()
    assert "/camera (gone)" in stage.seen()
    assert "/camera/color/image_raw" in stage.seen()
    await stage.show(graph_update())
    assert "this node has left the graph" not in stage.seen()


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


async def test_what_lasts_is_counted_on_the_tab_and_listed_the_worst_first(later: Callable[[float], None]) -> None:
    async with opened(RecordedGraph(update=ill_graph())) as stage:
        assert "Findings 0" in tab_words(stage)
        later(LATER_S)
        # Nothing need arrive for that.
        await stage.wait(lambda: "Findings 4" in tab_words(stage))
        stage.screen.list_kind(GraphKind.FINDING)
        await stage.wait_for("✗ error · incompatible QoS")
        assert stage.graph.wanted.all_fast
        listed = [entry.label for entry in stage.screen.index.listed[GraphKind.FINDING]]
        assert listed == ["✗ /camera/color/image_raw", "✗ /sensor/sonar_frnt", "✗ /set_head_postion", "▲ /imu"]
        stage.screen.list_kind(GraphKind.NODE)
        await stage.press()
        assert not stage.graph.wanted.all_fast


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


@pytest.fixture
async def managed() -> AsyncIterator[GraphStage]:
    async with opened(RecordedGraph(update=managed_update())) as opened_room:
        yield opened_room


async def until_told(managed: GraphStage, words: str) -> None:
    await managed.wait(lambda: any(words in one.message for one in managed.app._notifications))


def footer(managed: GraphStage) -> str:
    return str(managed.app.screen.query_one(KeyBar).render())


@pytest.mark.nightly
async def test_a_state_is_followed_and_only_what_is_possible_is_offered(managed: GraphStage) -> None:
    await managed.choose("/safety_stop")
    assert "lifecycle" not in managed.seen()
    assert "Lifecycle" not in footer(managed)
    await managed.press("J")
    assert not isinstance(managed.app.screen, ChoiceScreen)
    await managed.choose("/camera")
    await managed.wait_for("lifecycle: inactive · can cleanup, activate, shutdown")
    assert "Lifecycle" in footer(managed)
    await managed.show(replace(managed_update(), lifecycles=(LifecycleRow("/camera", "activating"),)))
    await managed.wait_for("lifecycle: activating")
    await managed.wait(lambda: "Lifecycle" not in footer(managed))
    hanging = LifecycleRow("/camera", "activating", (), "/camera does not answer within 5 s")
    await managed.show(replace(managed_update(), lifecycles=(hanging,)))
    await managed.wait_for("lifecycle: activating · /camera does not answer within 5 s")


@pytest.mark.nightly
async def test_a_transition_is_made_by_a_key_and_its_outcome_is_told(managed: GraphStage) -> None:
    await managed.choose("/camera")
    await managed.press("J")
    await managed.wait(lambda: isinstance(managed.app.screen, ChoiceScreen))
    await managed.press("down", "enter")
    await until_told(managed, "/camera is active now")
    assert managed.graph.asked(ChangeState)[0][:2] == ("/camera", "activate")
    why = "/camera refuses to cleanup and stays inactive; its log may say why"
    managed.graph.outcomes = {"cleanup": TransitionResult("/camera", "cleanup", "", why)}
    await managed.press("J", "enter")
    await until_told(managed, "/camera refuses to cleanup and stays inactive")


@pytest.mark.nightly
async def test_a_log_level_is_set_or_it_is_said_how_to_allow_that(managed: GraphStage) -> None:
    await managed.choose("/camera")
    await managed.press("K")
    await managed.wait(lambda: isinstance(managed.app.screen, ChoiceScreen))
    await managed.press("up", "enter")
    await until_told(managed, "/camera logs from debug on")
    assert managed.graph.levels == {"/camera": "debug"}
    managed.graph.refusals["/audio"] = "/audio does not let others change its log level"
    await managed.choose("/audio")
    await managed.press("K")
    await until_told(managed, "/audio does not let others change its log level")
