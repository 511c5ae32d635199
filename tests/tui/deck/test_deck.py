"""The Deck: nodes, their states and what can be done to them; panels page by page."""

from __future__ import annotations

from dataclasses import replace

import pytest
from rich.color import ColorSystem
from textual.widgets import Input

from graph.inner_states import LifecycleRow
from graph.observer.requests import Publish
from launcher.profile.panels import PANELS
from launcher.status import NodeState
from tests.tui.recorded import RecordedGraph, RecordedOpener
from tests.tui.recorded_inner import managed_update
from tests.tui.snapshots import opened, settle
from text.sentences import say
from tui.app import DeckApp
from tui.deck.nodes_table import NodesTable
from tui.deck.screen import LessonDeck
from tui.frame import title
from tui.frame.key_bar import KeyBar
from tui.panels.camera import CameraPanel
from tui.panels.head import HeadPanel
from tui.panels.panel import Panel
from tui.panels.panel_grid import PanelGrid, heights, in_rows, made, paged
from tui.panels.sonar import SonarPanel
from tui.panels.voice import VoicePanel
from tui.panels.wheels import WheelsPanel
from tui.themes import CYCLE


async def test_a_node_and_all_nodes_are_started_stopped_restarted() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (_app, pilot):
        await pilot.press("down")
        for key, *what in (
            ("x", "stop", "camera"),
            ("r", "restart", "camera"),
            ("ч", "stop", "camera"),
            ("s", "start", "camera"),
            ("S", "start"),
            ("X", "stop"),
            ("R", "restart"),
        ):
            if key == "s":
                opener.link.set_state("camera", NodeState.EXITED)
                await pilot.pause()
            await pilot.press(key)
            await pilot.pause()
            assert opener.link.asked.pop() == tuple(what)
            assert not opener.link.asked


async def test_what_is_done_already_is_not_offered() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        for state, keys in (
            (NodeState.WAITING, "s Start  x Stop  r Restart"),
            (NodeState.READY, "x Stop  r Restart"),
            (NodeState.BACKOFF, "s Start  x Stop  r Restart"),
            (NodeState.FAILED, "s Start  r Restart"),
        ):
            opener.link.set_state("sonar_front", state)
            await settle(pilot)
            shown = str(app.screen.query_one(KeyBar).render()).strip()
            assert shown.startswith(f"{keys}  u My own  m Mute")


async def test_a_node_that_is_not_ready_or_dies_looks_like_none_that_is_well() -> None:
    opener = RecordedOpener()
    late = say("not ready within {seconds:g} s: {why}", seconds=10.0, why="nobody publishes /x")
    async with opened(opener, size=(200, 60)) as (app, pilot):
        opener.link.set_state("camera", NodeState.RUNNING, detail=late)
        await settle(pilot)
        row = app.screen.query_one(NodesTable).render_line(2).text
        assert "◔ running" in row
        assert "not ready within 10 s" in row
        assert "○ 7/8" in title.states(app)[0]
        opener.link.set_state("camera", NodeState.RUNNING, detail="")
        await settle(pilot)
        assert "● running" in app.screen.query_one(NodesTable).render_line(2).text
        assert "● 8/8" in title.states(app)[0]
        opener.link.set_state("camera", NodeState.BACKOFF, signal="SIGKILL", restarts=1, pid=None)
        await settle(pilot)
        row = app.screen.query_one(NodesTable).render_line(2).text
        assert "↻ restarts" in row
        assert "ended by SIGKILL" in row
        assert "◔ 7/8" in title.states(app)[0]


async def test_only_what_is_shown_is_asked_for() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (_app, pilot):
        assert opener.graph.wanted.pictures == {"/camera/color/image_raw"}
        assert {"/audio/mic_raw", "/emergency_stop", "/safety_state"} <= opener.graph.wanted.followed
        graph = opener.graph
        assert (graph.wanted.all_topics, graph.wanted.all_fast) == (True, False), (
            "rates of slow topics before somebody looks"
        )
        await pilot.press("2")
        await pilot.pause()
        assert opener.graph.wanted.all_fast
        assert "/camera/color/image_raw" not in opener.graph.wanted.watched | opener.graph.wanted.pictures
        assert "/audio/mic_raw" in opener.graph.wanted.followed


async def test_a_command_is_written_and_published() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("c", *"left", "enter")
        await pilot.pause()
        sent = ("/ai_command", "std_msgs/msg/String", {"data": "left"}, False)
        assert opener.graph.asked(Publish) == [sent]
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


def test_lines_that_a_panel_has_no_use_for_go_to_another() -> None:
    rows: list[list[Panel]] = [[WheelsPanel()], [CameraPanel()]]
    words, drawn, high = heights(rows, 17, 0), heights(rows, 24, 0), heights(rows, 60, 0)
    assert (words, sum(drawn), high) == ([4, 13], 24, [12, 48])
    assert drawn[0] >= 8


async def test_any_size_is_survived() -> None:
    async with opened() as (app, pilot):
        for size in ((40, 10), (20, 5), (3, 2), (59, 60), (300, 8)):
            for columns, rows in (size, (120, 40)):
                await pilot.resize_terminal(columns, rows)
                await pilot.pause()
            assert "sonar_front" in app.screen.query_one(NodesTable).render_line(1).text


def states(app: DeckApp) -> dict[str, str]:
    """Node to what its row says of its state."""
    assert isinstance(app.screen, LessonDeck)
    rows = app.screen.table._rows
    return {row.cells[0].text: " ".join(row.cells[1].text.split()) for row in rows}


async def test_a_state_is_shown_in_place_of_ready_and_follows_the_node() -> None:
    opener = RecordedOpener(graph=RecordedGraph(update=managed_update()))
    async with opened(opener) as (app, pilot):
        assert states(app)["camera"] == "● inactive"
        assert states(app)["sonar_front"] == "● active"
        assert states(app)["safety_stop"] == "● ready"
        errors = (LifecycleRow("/camera", "errorprocessing"),)
        opener.graph.show(replace(managed_update(), lifecycles=errors))
        await settle(pilot)
        assert states(app)["camera"] == "● errorprocessing"
        assert states(app)["sonar_front"] == "● ready"
        opener.link.set_state("camera", NodeState.FAILED, detail="configure failed")
        await settle(pilot)
        assert states(app)["camera"] == "✗ failed configure failed"


async def test_of_16_colours_good_bad_and_plain_words_have_their_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("textual.constants.COLOR_SYSTEM", "auto")
    monkeypatch.delenv("COLORTERM", raising=False)
    monkeypatch.setenv("TERM", "linux")
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        assert app.console.color_system == "standard"
        opener.link.set_state("camera", NodeState.FAILED)
        table = app.screen.query_one(NodesTable)
        for app.theme in CYCLE:
            await settle(pilot)
            inks = {
                segment.text.strip(): segment.style.color.downgrade(ColorSystem.STANDARD).number
                for y in range(table.size.height)
                for segment in table.render_line(y)
                if segment.style is not None and segment.style.color is not None
            }
            good, bad, plain = (
                next(ink for text, ink in inks.items() if text.startswith(word))
                for word in ("● ready", "✗ failed", "ai_brain")
            )
            assert good in {2, 10}, app.theme
            assert bad in {1, 9}, app.theme
            assert plain not in {good, bad}, app.theme


@pytest.mark.parametrize("name", PANELS)
def test_every_panel_of_the_file_format_has_its_class(name: str) -> None:
    assert isinstance(made(name), Panel)
