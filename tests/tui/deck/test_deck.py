"""The Deck: nodes and what can be done to them, panels by the profile, the log."""

from __future__ import annotations

import pytest
from textual.widgets import Input

from launcher.status import NodeState, Severity
from tests.tui.app_runs import opened
from tests.tui.lesson_openers import llm
from tests.tui.recorded import (
    SESSION,
    RecordedOpener,
)
from tests.tui.snapshots import settle
from text.sentences import say
from tui.app import DeckApp
from tui.deck.nodes_table import NodesTable
from tui.deck.screen import LessonDeck
from tui.frame import title
from tui.frame.key_bar import KeyBar
from tui.frame.title_bar import TitleBar
from tui.outcome.view import Outcome
from tui.panels.camera import CameraPanel
from tui.panels.head.panel import HeadPanel
from tui.panels.llm import LlmPanel
from tui.panels.panel_grid import PanelGrid, heights, in_rows, paged
from tui.panels.sonar.panel import SonarPanel
from tui.panels.voice.panel import VoicePanel
from tui.panels.wheels.panel import WheelsPanel
from tui.widgets.node_words import duration


def deck_of(app: DeckApp) -> LessonDeck:
    """Return the screen."""
    assert isinstance(app.screen, LessonDeck)
    return app.screen


async def test_a_node_and_all_nodes_are_started_stopped_restarted() -> None:
    opener = RecordedOpener()
    asked: list[tuple[str, ...]] = []
    async with opened(opener) as (_app, pilot):
        await pilot.press("down")
        for key, verb in (("x", "stop"), ("r", "restart"), ("ч", "stop")):
            asked.append((verb, "camera"))
            await pilot.press(key)
            await pilot.pause()
            assert opener.link.asked == asked
        opener.link.set_state("camera", NodeState.EXITED)
        await pilot.pause()
        asked.append(("start", "camera"))
        await pilot.press("s")
        await pilot.pause()
        assert opener.link.asked == asked
        for key, verb in (("S", "start"), ("X", "stop"), ("R", "restart")):
            asked.append((verb,))
            await pilot.press(key)
            await pilot.pause()
            assert opener.link.asked == asked


@pytest.mark.parametrize(
    ("state", "keys"),
    [
        (NodeState.WAITING, "s Start  x Stop  r Restart"),
        (NodeState.STARTING, "x Stop  r Restart"),
        (NodeState.READY, "x Stop  r Restart"),
        (NodeState.RUNNING, "x Stop  r Restart"),
        (NodeState.STOPPING, "s Start  x Stop  r Restart"),
        (NodeState.BACKOFF, "s Start  x Stop  r Restart"),
        (NodeState.EXITED, "s Start  r Restart"),
        (NodeState.FAILED, "s Start  r Restart"),
    ],
)
async def test_what_is_done_already_is_not_offered(state: NodeState, keys: str) -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        opener.link.set_state("sonar_front", state)
        await pilot.pause()
        await pilot.pause()
        shown = str(app.screen.query_one(KeyBar).render()).strip()
        assert shown.startswith(f"{keys}  u My own  m Mute")


async def test_a_node_is_muted_heard_alone_and_heard_again() -> None:
    async with opened() as (app, pilot):
        deck = deck_of(app)
        await pilot.press("m")
        assert deck.log_filter.muted == {"sonar_front"}
        await pilot.press("down", "o")
        assert deck.log_filter.only == "camera"
        shown = {entry.node for entry in deck.pane.view.index.shown}
        assert shown == {"camera"}
        await pilot.press("F", "F", "a")
        assert deck.log_filter.muted == frozenset()
        assert deck.log_filter.minimum is Severity.DEBUG


async def test_a_node_that_dies_is_shown_by_word_and_sign() -> None:
    opener = RecordedOpener()
    async with opened(opener, size=(200, 60)) as (app, pilot):
        opener.link.set_state("camera", NodeState.BACKOFF, signal="SIGKILL", restarts=1, pid=None)
        await pilot.pause()
        await pilot.pause()
        table = app.screen.query_one(NodesTable)
        row = table.render_line(2).text
        assert "↻ restarts" in row
        assert "ended by SIGKILL" in row
        assert "◔ 7/8" in title.states(app)[0]


async def test_a_node_that_runs_but_is_not_ready_looks_like_none_that_is_well() -> None:
    opener = RecordedOpener()
    late = say("not ready within {seconds:g} s: {why}", seconds=10.0, why="nobody publishes /x")
    async with opened(opener, size=(200, 60)) as (app, pilot):
        opener.link.set_state("camera", NodeState.RUNNING, detail=late)
        await pilot.pause()
        await pilot.pause()
        row = app.screen.query_one(NodesTable).render_line(2).text
        assert "◔ running" in row
        assert "not ready within 10 s" in row
        assert "○ 7/8" in title.states(app)[0]
        opener.link.set_state("camera", NodeState.RUNNING, detail="")
        await pilot.pause()
        await pilot.pause()
        assert "● running" in app.screen.query_one(NodesTable).render_line(2).text
        assert "● 8/8" in title.states(app)[0]


async def test_the_trail_of_a_json_shows_without_the_composer() -> None:
    async with opened(llm()) as (app, pilot):
        await pilot.pause()
        trail = app.screen.query_one(LlmPanel).query_one(Outcome)
        assert any("Turn and look" in entry.text for entry in trail.entries)
        assert ("set_head_position", "✓") in {(entry.topic, entry.mark) for entry in trail.entries}


async def test_only_what_is_shown_is_asked_for() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (_app, pilot):
        assert opener.graph.pictures == {"/camera/color/image_raw"}
        assert {"/audio/mic_raw", "/emergency_stop", "/safety_state"} <= opener.graph.followed
        before = opener.graph.measured
        assert not before
        await pilot.press("2")
        await pilot.pause()
        assert opener.graph.measured
        assert "/camera/color/image_raw" not in opener.graph.watched | opener.graph.pictures
        assert "/audio/mic_raw" in opener.graph.followed


async def test_a_command_is_written_and_published() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("c", *"left", "enter")
        await pilot.pause()
        sent = ("/ai_command", "std_msgs/msg/String", {"data": "left"}, False)
        assert opener.graph.published == [sent]
        await pilot.press("escape")
        assert not isinstance(app.focused, Input)


async def test_on_a_small_terminal_the_panels_come_page_by_page() -> None:
    async with opened(size=(80, 24)) as (app, pilot):
        grid = app.screen.query_one(PanelGrid)

        def shown() -> list[str]:
            return [type(panel).__name__ for panel in grid.panels if panel.display]

        first = shown()
        assert 0 < len(first) < 5
        await pilot.press("v")
        await pilot.pause()
        assert set(first).isdisjoint(shown())
        await pilot.click(PanelGrid, offset=(5, 0))
        await pilot.pause()
        assert shown() == first


@pytest.mark.parametrize("width", [30, 52, 79, 80, 120])
@pytest.mark.parametrize("height", [1, 6, 13, 22, 38, 60])
def test_every_panel_has_a_place_on_one_page_and_pages_are_filled(width: int, height: int) -> None:
    panels = [SonarPanel(), WheelsPanel(), CameraPanel(), HeadPanel(), VoicePanel()]
    rows = in_rows(panels, width)
    pages = paged(rows, height, 1)
    placed = [panel for page in pages for row in page for panel in row]
    assert sorted(map(id, placed)) == sorted(map(id, panels))
    for page in pages:
        lines = heights(page, height, 1)
        needed = [1 + max(panel.least for panel in row) for row in page]
        assert all(given >= least for given, least in zip(lines, needed, strict=True))
        assert sum(lines) == height or len(page) == 1


async def test_any_size_is_survived() -> None:
    async with opened() as (app, pilot):
        for size in ((40, 10), (20, 5), (3, 2), (59, 60), (300, 8)):
            for columns, rows in (size, (120, 40)):
                await pilot.resize_terminal(columns, rows)
                await pilot.pause()
            assert "sonar_front" in app.screen.query_one(NodesTable).render_line(1).text


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(None, ""), (0, "0s"), (59.9, "59s"), (83, "1m23"), (3660, "1h01"), (90_000, "1d01")],
)
def test_a_time_is_told_in_its_two_greatest_units(seconds: float | None, words: str) -> None:
    assert duration(seconds) == words


@pytest.mark.parametrize("size", [(40, 12), (80, 24), (120, 40), (200, 60)])
async def test_the_domain_stands_in_the_title_at_every_size(size: tuple[int, int]) -> None:
    async with opened(size=size) as (app, pilot):
        for screen in ("deck", "topics", "logs"):
            await app.show_screen(screen)
            await settle(pilot)
            assert f"domain {SESSION.domain}" in app.screen.query_one(TitleBar).text
