"""How the screen of the graph looks, at three sizes and in both languages."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import replace
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input

from graph.data import CallResult, GoalStatus, GraphUpdate, ParametersResult, SeenGoal
from tests.tui.recorded import RecordedGraph, RecordedOpener
from tests.tui.recorded_findings import ill_graph
from tests.tui.recorded_nodes import NODE_ROWS, graph_update
from tests.tui.snapshots import Look, SnapCompare, both_languages, every_look, one_look, settle
from tests.waiting import until
from tui import clock
from tui.app import DeckApp
from tui.graph.places import GraphKind, GraphPlace
from tui.graph.screen import GraphScreen

pytestmark = pytest.mark.nightly

Step = Callable[[GraphScreen, RecordedGraph], object]
NODE = GraphPlace(GraphKind.NODE, "/safety_stop")
SERVICE = GraphPlace(GraphKind.SERVICE, "/set_head_position")
ACTION = GraphPlace(GraphKind.ACTION, "/drive_to_point")
TYPE = GraphPlace(GraphKind.TYPE, "sensor_msgs/msg/JointState")


def app_of(look: Look, update: GraphUpdate | None = None) -> DeckApp:
    graph = RecordedGraph(update=update or graph_update())
    return look.app("graph", RecordedOpener(graph=graph))


async def settled(pilot: Pilot[Any]) -> tuple[GraphScreen, RecordedGraph]:
    """Return the screen and the recorded graph, once what was recorded is shown."""
    await settle(pilot)
    assert isinstance(pilot.app, DeckApp)
    screen, graph = pilot.app.screen, pilot.app.feed.graph
    assert isinstance(screen, GraphScreen)
    assert isinstance(graph, RecordedGraph)
    return screen, graph


def at(place: GraphPlace, *steps: str | Step) -> Callable[[Pilot[Any]], Awaitable[None]]:
    """Go to a place, then press keys and take steps."""

    async def before(pilot: Pilot[Any]) -> None:
        screen, graph = await settled(pilot)
        await screen.go(place)
        await still(pilot, screen)
        for step in steps:
            if isinstance(step, str):
                await pilot.press(step)
            else:
                step(screen, graph)
            await still(pilot, screen)

    return before


async def still(pilot: Pilot[Any], screen: GraphScreen) -> None:
    """Wait until nothing is loaded or checked any more."""

    def at_rest() -> bool:
        # Forms and types wait until a choice stands.
        return not screen.is_settling and all(
            one.is_finished or one.node is pilot.app for one in pilot.app.workers
        )

    await pilot.pause()
    await until(at_rest, "a screen at rest")
    for _round in range(3):
        await pilot.pause()


def executing(_screen: GraphScreen, graph: RecordedGraph) -> None:
    feedback = {"distance": 1.25}
    graph.change_goal(1, status=GoalStatus.SUCCEEDED, result={"reached": True}, elapsed_s=4.2)
    graph.change_goal(
        2, status=GoalStatus.EXECUTING, feedback=feedback, feedback_count=12, elapsed_s=1.8
    )


@every_look
def test_a_node(look: Look, snap_compare: SnapCompare) -> None:
    """Nodes at the left; safety_stop with its process, what it says and hears, and with whom."""
    assert snap_compare(app_of(look), terminal_size=look.size, run_before=at(NODE))


@both_languages
def test_parameters(look: Look, dump_compare: SnapCompare) -> None:
    """Five parameters with type and limits; at 80x24 in place of the links, else below them."""
    assert dump_compare(app_of(look), terminal_size=look.size, run_before=at(NODE, "E", "down"))


@one_look
def test_a_parameter_that_is_refused(look: Look, dump_compare: SnapCompare) -> None:
    """A dialog with description, type, range, the typed value, and why the node refuses it."""

    def refuse(_screen: GraphScreen, graph: RecordedGraph) -> None:
        graph.refusals["rate"] = "expected 0.1 to 50.0, got 99.0"

    def type_it(screen: GraphScreen, _graph: RecordedGraph) -> None:
        field = screen.app.screen.query_one(Input)
        field.value = "99.0"

    before = at(NODE, "E", "down", refuse, "enter", type_it, "enter")
    assert dump_compare(app_of(look), terminal_size=look.size, run_before=before)


@one_look
def test_a_node_that_does_not_answer(look: Look, dump_compare: SnapCompare) -> None:
    """In place of the parameters: they could not be read, and why."""

    def hang(_screen: GraphScreen, graph: RecordedGraph) -> None:
        graph.node_parameters[NODE.name] = ParametersResult(NODE.name, (), "no answer within 5 s")

    before = at(NODE, hang, "E")
    assert dump_compare(app_of(look), terminal_size=look.size, run_before=before)


@one_look
def test_a_service(look: Look, dump_compare: SnapCompare) -> None:
    """Type and nodes as links, a form that fits, sum 1 with its time; below the call itself."""
    before = at(SERVICE, "enter", "ctrl+s")
    assert dump_compare(app_of(look), terminal_size=look.size, run_before=before)


@one_look
def test_a_call_under_way_and_one_that_failed(look: Look, dump_compare: SnapCompare) -> None:
    """The newest call waits, seconds are counted, F7 cancels; the one below failed by time-out."""

    def fail(_screen: GraphScreen, graph: RecordedGraph) -> None:
        why = "no answer within 5 s"
        graph.answers[SERVICE.name] = CallResult(SERVICE.name, False, None, why, 5.0)

    def hold(_screen: GraphScreen, graph: RecordedGraph) -> None:
        graph.hold_calls = True

    async def before(pilot: Pilot[Any]) -> None:
        await at(SERVICE, fail, "ctrl+s", hold)(pilot)
        assert isinstance(pilot.app, DeckApp)
        await pilot.press("ctrl+s")
        for _round in range(5):
            await pilot.pause()

    assert dump_compare(app_of(look), terminal_size=look.size, run_before=before)


@one_look
def test_an_action(look: Look, dump_compare: SnapCompare) -> None:
    """Goal form; two own goals, one succeeded, one at its twelfth feedback; one of another's."""
    before = at(ACTION, "enter", "ctrl+s", "ctrl+s", executing)
    theirs = SeenGoal(
        ACTION.name, "deck_interfaces/action/DriveToPoint", "8d00b7f4" * 4,
        GoalStatus.CANCELING, 75.25, {"distance": 0.5}, 3,
    )  # fmt: skip
    update = graph_update(seen_goals=(theirs,))
    assert dump_compare(app_of(look, update), terminal_size=look.size, run_before=before)


@one_look
def test_a_goal_of_another_client_is_to_be_cancelled(look: Look, dump_compare: SnapCompare) -> None:
    """A dialog asks: it names the action, the whole id, the state, and who waits for its end."""
    theirs = SeenGoal(ACTION.name, "", "8d00b7f4" * 4, GoalStatus.EXECUTING, 75.25)
    update = graph_update(seen_goals=(theirs,))
    before = at(ACTION, "enter", "f12")
    assert dump_compare(app_of(look, update), terminal_size=look.size, run_before=before)


@one_look
def test_a_type(look: Look, dump_compare: SnapCompare) -> None:
    """JointState down to its fields, the header unfolded; below the topics that are of it."""
    before = at(TYPE, "enter", "right")
    assert dump_compare(app_of(look), terminal_size=look.size, run_before=before)


@both_languages
def test_the_map(look: Look, snap_compare: SnapCompare) -> None:
    """safety_stop in a box; what it hears at the left, what it says at the right, with whom."""
    before = at(NODE, "M", "left")
    assert snap_compare(app_of(look), terminal_size=look.size, run_before=before)


def told(
    patch: pytest.MonkeyPatch, *choices: str, mend: bool = False
) -> Callable[[Pilot[Any]], Awaitable[None]]:
    """List the findings of a graph that is ill, as they are once they have lasted."""

    async def before(pilot: Pilot[Any]) -> None:
        screen, graph = await settled(pilot)
        screen.list_kind(GraphKind.FINDING)
        late_s = clock.steady() + 60.0
        patch.setattr(clock, "steady", lambda: late_s)
        graph.show(graph_update() if mend else ill_graph())
        await still(pilot, screen)
        for name in choices:
            screen.names.choose(f"finding|{name}")
            await still(pilot, screen)

    return before


@every_look
def test_findings(look: Look, dump_compare: SnapCompare, monkeypatch: pytest.MonkeyPatch) -> None:
    """Four findings, the worst first; of a misspelt name what is wrong, what to do, and where."""
    before = told(monkeypatch, "near-name topic /sensor/sonar_frnt")
    app = app_of(look, ill_graph())
    assert dump_compare(app, terminal_size=look.size, run_before=before)


@both_languages
def test_no_findings(
    look: Look, dump_compare: SnapCompare, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing is wrong, and what was looked for."""
    assert dump_compare(
        app_of(look), terminal_size=look.size, run_before=told(monkeypatch, mend=True)
    )


@one_look
def test_findings_are_seen_from_another_tab(
    look: Look, dump_compare: SnapCompare, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nodes are listed, and the last tab has the number of findings in red."""

    async def before(pilot: Pilot[Any]) -> None:
        await told(monkeypatch)(pilot)
        assert isinstance(pilot.app.screen, GraphScreen)
        pilot.app.screen.list_kind(GraphKind.NODE)
        await still(pilot, pilot.app.screen)

    app = app_of(look, ill_graph())
    assert dump_compare(app, terminal_size=look.size, run_before=before)


@one_look
def test_a_node_that_has_left(look: Look, dump_compare: SnapCompare) -> None:
    """The list marks it as gone; the detail says so, and what it last did."""

    def leave(_screen: GraphScreen, graph: RecordedGraph) -> None:
        rest = tuple(row for row in NODE_ROWS if row.name != NODE.name)
        graph.show(graph_update(nodes=rest))

    before = at(NODE, leave)
    assert dump_compare(app_of(look), terminal_size=look.size, run_before=before)


@one_look
def test_an_empty_domain(look: Look, dump_compare: SnapCompare) -> None:
    """No node at all: it says why that may be."""
    app = app_of(look, GraphUpdate(0.0))
    assert dump_compare(app, terminal_size=look.size, run_before=look.settle)


@pytest.mark.parametrize("drawn", [False, True], ids=["list", "map"])
def test_hostile_names(drawn: bool, dump_compare: SnapCompare) -> None:
    """Escape sequences, markup and endless names are shown as they are, and shortened."""
    look = Look((80, 24), "en")
    long = "/" + "endless/" * 40
    evil = replace(
        NODE_ROWS[0],
        name="/\x1b[2J[red]evil[/red]\x00",
        publishes=("/\x1b]0;title\x07[blink]", long),
        subscribes=("/\u202enwod_edispu", "/日本語"),
    )
    app = app_of(look, graph_update(nodes=(evil, replace(NODE_ROWS[1], name=long))))
    before = at(GraphPlace(GraphKind.NODE, evil.name), *(("M",) if drawn else ()))
    assert dump_compare(app, terminal_size=look.size, run_before=before)


def test_a_tiny_terminal(dump_compare: SnapCompare) -> None:
    """At 40x12 names are shortened; nothing breaks."""
    look = Look((40, 12), "en")
    assert dump_compare(app_of(look), terminal_size=look.size, run_before=at(NODE))
