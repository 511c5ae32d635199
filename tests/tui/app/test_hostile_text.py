"""Whatever text a robot, a recording or a profile brings: no screen gives it to the terminal.

Each screen is led through what it can show, with a recorded world in which every text is hostile.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from textual.events import Paste
from textual.widgets import Static

from graph.data import (
    CallResult,
    EndpointInfo,
    Goal,
    GoalStatus,
    GraphUpdate,
    ParameterRow,
    ParametersResult,
    Publication,
    Sample,
    TopicRow,
    Trouble,
)
from launcher.errors import StartError
from launcher.events import ClosedEvent, StatusEvent, StraysEvent
from launcher.status import NodeState, Stray
from tests.hostile_text import EVIL, poisoned
from tests.tui import recorded_devices
from tests.tui.looked_through import looked_through
from tests.tui.recorded import (
    LESSONS,
    LINES,
    NODES,
    PARAMETERS,
    SESSION,
    TOPICS,
    RecordedGraph,
    RecordedOpener,
    RecordedSession,
    line,
    sample,
)
from tests.tui.recorded_nodes import graph_update
from text.sentences import say
from tui.composer import screen as composer_screen
from tui.composer.json_editor import JsonEditor
from tui.graph import ask as graph_ask
from tui.graph import type as graph_type
from tui.session.requests import Lesson, OpenRequest
from tui.topics import screen as topics_screen
from tui.yaml_form import form as yaml_form

pytestmark = pytest.mark.nightly

STRING = "std_msgs/msg/String"
NAME = "evil\x1bc\u202e[/]"
"""Of a profile; it has room in the title."""


def hostile_topics() -> tuple[TopicRow, ...]:
    """The topics as they are, and each once more with a name, a type and peers that are hostile."""
    troubled = [
        replace(row, trouble=trouble, detail=f"{trouble.value} {EVIL}", name=f"/{trouble.name}")
        for row, trouble in zip(TOPICS, Trouble, strict=False)
    ]
    listened = TopicRow("/llm_raw_json", (STRING,), 0, 1)
    listened = replace(listened, subscribed_by=(EndpointInfo(EVIL, EVIL, EVIL, EVIL),))
    rows = (listened, *TOPICS, *troubled, *map(poisoned, TOPICS), *map(poisoned, troubled))
    return tuple(sorted(rows, key=lambda row: row.name))


def hostile_samples(
    samples: dict[str, tuple[Sample, ...]], *, keys: bool
) -> dict[str, tuple[Sample, ...]]:
    """Messages with hostile texts on every topic, on those with hostile names, too."""
    found: dict[str, tuple[Sample, ...]] = {}
    for name, ones in samples.items():
        found[name] = tuple(
            replace(one, value=poisoned(one.value) if keys else _values(one.value)) for one in ones
        )
        found[poisoned(name)] = tuple(map(poisoned, ones))
    return found


def _values(value: Any) -> Any:
    """The values alone are hostile: a name of a joint or of an encoding stays what it is."""
    if isinstance(value, dict):
        kept = {"name", "encoding"}
        return {key: one if key in kept else _values(one) for key, one in value.items()}
    if isinstance(value, list):
        return [_values(one) for one in value]
    return poisoned(value)


def hostile_update(base: GraphUpdate, *, keys: bool = False) -> GraphUpdate:
    """The graph of lesson 9, and beside it the same with hostile names."""
    goals = tuple(
        Goal(
            number,
            f"/go{EVIL}",
            f"deck_interfaces/action/DriveToPoint{EVIL if keys else ''}",
            status,
            {"frame": EVIL},
            {"distance": EVIL},
            3,
            {"message": EVIL},
            EVIL,
        )
        for number, status in enumerate(GoalStatus, 1)
    )
    return replace(
        base,
        topics=hostile_topics() if base.topics == TOPICS else base.topics,
        samples=hostile_samples(dict(base.samples), keys=keys),
        nodes=(*base.nodes, *map(poisoned, base.nodes)),
        services=(*base.services, *map(poisoned, base.services)),
        actions=(*base.actions, *map(poisoned, base.actions)),
        goals=goals,
        publications=(Publication(1, f"/a{EVIL}", f"b{EVIL}", 2.0, 3, 1, EVIL),),
    )


class HostileOpener(RecordedOpener):
    """Lessons with hostile titles."""

    async def lessons(self) -> list[Lesson]:
        return [*LESSONS, *map(poisoned, LESSONS)]


def hostile_opener(base: GraphUpdate | None = None, *, keys: bool = False) -> HostileOpener:
    """A session and a graph in which every text is hostile."""
    nodes = {
        name: replace(
            node,
            detail=EVIL,
            command=poisoned(node.command),
            state=state,
            signal=f"SIG{EVIL}",
            needs=(EVIL,),
        )
        for (name, node), state in zip(NODES.items(), NodeState, strict=False)
    }
    nodes[f"bad{EVIL}"] = poisoned(NODES["camera"])
    lines = [*map(poisoned, LINES), *(replace(each, text=EVIL, logger=EVIL) for each in LINES)]
    graph = RecordedGraph(update=hostile_update(base or graph_update(), keys=keys))
    rows = (
        *map(poisoned, PARAMETERS),
        *(replace(row, description=EVIL, constraints=EVIL) for row in PARAMETERS),
        ParameterRow("evil", "string", EVIL, EVIL, EVIL),
        ParameterRow("many", "string_array", [EVIL, EVIL]),
    )
    for row in graph.update.nodes if graph.update else ():
        # The types are those of ROS: else nobody could change them.
        known = tuple(replace(each, type_name=each.type_name.split("evil")[0]) for each in rows)
        graph.node_parameters[row.name] = ParametersResult(row.name, known, "", 0.1)
    graph.refusals = {row.name: EVIL for row in rows}
    answer = CallResult("/set_head_position", True, {"text": EVIL}, EVIL, 0.1)
    graph.answers = {"/set_head_position": answer}
    session = (
        replace(poisoned(SESSION), name=NAME)
        if keys
        else replace(SESSION, title=poisoned(SESSION.title), name=NAME, hardware=EVIL)
    )
    return HostileOpener(RecordedSession(session, nodes, lines), graph, [poisoned(SESSION)])


@pytest.fixture(autouse=True)
def _all_colours(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """On a terminal of 16 colours Deck itself writes one of those that are looked for."""
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setenv("COLORTERM", "truecolor")
    # A screen saves parameters where it runs.
    monkeypatch.chdir(tmp_path)


@pytest.fixture(autouse=True)
def _at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is chosen or typed is looked at without a pause: each key shows all that it leads to."""
    for module in (graph_ask, graph_type, topics_screen):
        monkeypatch.setattr(module, "SETTLED_S", 0.001)
    for module in (composer_screen, yaml_form):
        monkeypatch.setattr(module, "CHECKED_AFTER_S", 0.001)


worlds = pytest.mark.parametrize("keys", [False, True], ids=["values", "all"])

WALKS: dict[str, tuple[str, ...]] = {
    "deck": (
        *("down", "m", "o", "a", "down", "v", "t", "up", "escape", "u", "f1", "escape"),
        *("c", *"abc", "escape", "ctrl+x", "f9"),
    ),
    "topics": (
        *("a", *(("down", "e", "V", "v", "y", "e") * 10), "i", *"><z"),
        *("slash", *"evil", "enter", "down", "P", "ctrl+t", "ctrl+s", "ctrl+g", "escape"),
    ),
    "composer": ("ctrl+o", "ctrl+s", "ctrl+t", "escape", "alt+up", "ctrl+n"),
    "logs": (
        *("up", "up", "y", "Y", "w", "m", "o", "a", "u", "e", "down", "enter", "escape"),
        *("slash", *"evil", "enter", "n", "f", "escape"),
    ),
    "graph": (
        *("a", *(("down", "enter", "E", "M", "escape", "escape") * 3)),
        *("right", *(("down", "enter", "escape") * 3)),
        *("right", *(("down", "enter", "escape") * 2)),
        *("right", *(("down", "enter", "escape") * 3)),
    ),
    "flow": ("n", "N", "p", "u", "down", "y", "m", "a"),
    "devices": (*("down", "up") * 3, "p", "b", "f", "v", "slash", *"evil", "enter"),
}
"""Through all that a screen shows; a hostile name stands beside the one that it is made of."""


@worlds
@pytest.mark.parametrize("screen", WALKS)
async def test_no_screen_gives_it_to_the_terminal(screen: str, keys: bool) -> None:
    base = None
    if screen == "devices":
        samples = (*recorded_devices.STATUSES, recorded_devices.of_chassis())
        base = recorded_devices.update(*samples)
    async with looked_through(screen, hostile_opener(base, keys=keys)) as stage:
        await stage.press(*WALKS[screen])


async def test_a_parameter_is_opened_refused_and_left() -> None:
    async with looked_through("graph", hostile_opener()) as stage:
        await stage.press("down", "E")
        for _row in range(5):
            await stage.press("down", "enter", "end", "left", "x", "enter", "escape")
        await stage.press("W", "enter", "escape", "O", "enter", "escape")


async def test_the_lessons_and_what_is_wrong_with_them() -> None:
    opener = hostile_opener()
    opener.refusal = StartError(say("{what}: nothing\n{what}", what=EVIL))
    async with looked_through("picker", opener, OpenRequest()) as stage:
        await stage.press(*("down",) * 8, "enter", "escape", "up", "enter", "escape")


async def test_what_the_supervisor_says() -> None:
    opener = hostile_opener()
    async with looked_through("deck", opener) as stage:
        opener.link.say(StraysEvent((Stray(1, 1.0, EVIL, EVIL, EVIL),)))
        opener.link.say(StatusEvent((poisoned(NODES["camera"]),)))
        await stage.pilot.pause(0.1)
        await stage.press("escape", "s", "x", "r")
        stage.app.notify(EVIL, title=EVIL)
        await stage.pilot.pause(0.1)
        opener.link.hold_shutdown = True
        await stage.press("q")
        await stage.pilot.pause(0.1)
        await stage.press("q")
        opener.link.say(ClosedEvent(EVIL))
        await stage.pilot.pause(0.1)


async def test_an_observer_that_cannot_work() -> None:
    opener = hostile_opener()
    opener.graph.update = replace(graph_update(), error=EVIL)
    async with looked_through("deck", opener) as stage:
        await stage.press("2", "5", "1")


async def test_what_is_pasted_into_a_field_of_textuals_own() -> None:
    async with looked_through("deck", hostile_opener(), all_plain=False) as stage:
        await stage.press("ctrl+p")
        stage.app.post_message(Paste(EVIL.replace("\n", "")))
        await stage.pilot.pause(0.1)


@pytest.mark.parametrize(
    "show", [lambda text: Static(text, markup=False), lambda text: Static(text * 3, markup=False)]
)
async def test_what_somebody_forgot_is_found_by_the_last_look(
    show: Callable[[str], Static],
) -> None:
    async with looked_through("deck", hostile_opener(), all_plain=False) as stage:
        await stage.app.screen.mount(show(EVIL), before=0)
        await stage.pilot.pause(0.1)


async def test_lines_that_come_over_rosout() -> None:
    opener = hostile_opener()
    async with looked_through("logs", opener) as stage:
        opener.link.say(
            StatusEvent((replace(NODES["camera"], detail=EVIL, state=NodeState.FAILED),))
        )
        stage.app.feed.note([line("deck", 1, EVIL)])
        await stage.pilot.pause(0.1)


async def test_what_is_composed_and_what_came_of_it() -> None:
    opener = hostile_opener()
    async with looked_through("composer", opener) as stage:
        text = '{"thought": "' + EVIL + '", "' + EVIL + '": [' + EVIL + "]}"
        stage.app.screen.query_one(JsonEditor).post_message(Paste(text))
        await stage.pilot.pause(0.1)
        await stage.press("ctrl+o")
        results = [
            sample("/llm_result", STRING, {"data": json.dumps(poisoned(told))})
            for told in ({"event": "refused", "problems": ["x"]}, {"event": "accepted"})
        ]
        raw = sample("/llm_result", STRING, {"data": EVIL})
        samples = {"/llm_result": (*results, raw)}
        opener.graph.show(replace(graph_update(), samples=samples))
        await stage.pilot.pause(0.1)
        await stage.press("ctrl+n", "f9", "alt+up")
