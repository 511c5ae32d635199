"""The Deck: nodes and what can be done to them, panels by the profile, the log."""

from __future__ import annotations

from dataclasses import replace

import pytest
from textual.events import Key
from textual.widgets import Input

from launcher.events import LogEvent
from launcher.status import NodeState, Severity
from tests.tui.app_runs import opened
from tests.tui.lesson_openers import llm
from tests.tui.recorded import (
    SESSION,
    TOPICS,
    RecordedGraph,
    RecordedOpener,
    lesson_update,
    line,
    topic,
)
from tests.tui.snapshots import settle
from tests.waiting import until
from text.i18n import set_language
from text.sentences import say
from tui.app import DeckApp
from tui.deck.command_line import CommandLine
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
from tui.panels.sonar.widget import Sonar, SonarView
from tui.panels.voice.panel import VoicePanel
from tui.panels.wheels.panel import WheelsPanel
from tui.panels.wheels.widget import WheelsView
from tui.widgets.image_view import ImageView
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


async def test_a_node_is_chosen_by_a_click_and_stopped_by_a_click() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.click(NodesTable, offset=(8, 4))
        assert deck_of(app).chosen_node == "head_controller"
        keys = app.screen.query_one("KeyBar")
        at = str(keys.render()).index("x Stop")
        await pilot.click("KeyBar", offset=(at + 2, 0))
        await pilot.pause()
        assert opener.link.asked == [("stop", "head_controller")]


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


@pytest.mark.parametrize(
    ("state", "sign"),
    [
        (NodeState.WAITING, "◔"),
        (NodeState.STARTING, "◔"),
        (NodeState.BACKOFF, "◔"),
        (NodeState.STOPPING, "○"),
        (NodeState.EXITED, "○"),
        (NodeState.FAILED, "○"),
    ],
)
async def test_the_title_says_starting_only_while_a_node_is_to_come(
    state: NodeState, sign: str
) -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        assert "● 8/8" in title.states(app)[0]
        opener.link.set_state("camera", state)
        await pilot.pause()
        await pilot.pause()
        assert f"{sign} 7/8" in title.states(app)[0]


async def test_hostile_log_lines_and_names_are_shown_harmlessly() -> None:
    bad = "\x1b]52;c;aGk=\x07[red]no markup[/red]\x00\u202egnp"
    opener = RecordedOpener()
    async with opened(opener) as (app, _pilot):
        opener.link.say(LogEvent((line("[b]evil[/b]", 1, "x" * 1_000_000), line("camera", 9, bad))))

        def seen() -> str:
            strips = app.screen._compositor.render_strips()
            return "\n".join(strip.text for strip in strips)

        await until(lambda: "[red]no markup[/red]" in seen(), "the line, its markup as it is")
        screen = seen()
        assert "\x1b" not in screen
        assert "\u202e" not in screen


async def test_panels_show_what_their_topics_say() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.pause()
        gauge = app.screen.query_one(SonarPanel).query_one(SonarView)
        assert gauge.query_one("#front", Sonar).has_value
        assert app.screen.query_one(CameraPanel).query_one(ImageView).has_picture
        wheels = app.screen.query_one(WheelsPanel).query_one(WheelsView)
        assert "left wheel slower" in "\n".join(
            wheels.render_line(y).text for y in range(wheels.size.height)
        )


async def test_without_a_differential_the_wheels_show_what_drive_would_do() -> None:
    rows = (topic("/drive", "ackermann_msgs/msg/AckermannDriveStamped", 1.0),)
    opener = RecordedOpener(graph=RecordedGraph(lesson_update(topics=rows)))
    async with opened(opener) as (app, pilot):
        await pilot.pause()
        wheels = app.screen.query_one(WheelsPanel)
        assert "← /drive" in str(wheels.border_title)
        drawn = wheels.query_one(WheelsView)
        text = "\n".join(drawn.render_line(y).text for y in range(drawn.size.height))
        assert "0.25 m/s" in text
        assert "0.35 m/s" in text


async def test_the_rear_sonar_comes_with_its_publisher_and_stays_without_it() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        gauge = app.screen.query_one(SonarView)
        assert not gauge.has_class("-both")
        rear = topic("/sensor/sonar_rear", "std_msgs/msg/Float32", 1.0)
        opener.graph.show(lesson_update(topics=(*TOPICS, rear)))
        await pilot.pause()
        await pilot.pause()
        assert gauge.has_class("-both")
        opener.graph.show(lesson_update(topics=(*TOPICS, replace(rear, publishers=0))))
        await pilot.pause()
        await pilot.pause()
        assert gauge.has_class("-both")


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


async def test_what_is_typed_without_a_pause_after_the_key_is_in_the_field() -> None:
    async with opened() as (app, pilot):
        for key in "cleft":
            app.post_message(Key(key, key))
        await pilot.pause()
        assert app.screen.query_one(CommandLine).field.value == "left"
        await pilot.press("c", "с", "x")
        assert app.screen.query_one(CommandLine).field.value == "leftcсx"


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


@pytest.mark.parametrize(
    ("size", "words"),
    [
        ((80, 24), "─Сонар · стр. 1/2 (v — дальше)─"),
        ((120, 18), "─ Сонар · страница 1 из 2 (v — дальше) ─"),
    ],
)
async def test_the_title_that_tells_of_more_pages_is_whole(
    size: tuple[int, int], words: str
) -> None:
    set_language("ru")
    async with opened(size=size) as (app, _pilot):
        first = app.screen.query_one(SonarPanel)
        upper = app.screen._compositor.render_strips()[first.region.y].text
        assert words in upper


async def test_no_column_of_the_nodes_is_cut_beside_the_panels() -> None:
    set_language("ru")
    async with opened(size=(120, 40)) as (app, _pilot):
        table = app.screen.query_one(NodesTable)
        assert table.render_line(0).text.rstrip().endswith(" Память")
        assert "● готов " in table.render_line(1).text
        assert table.render_line(1).text.rstrip().endswith(" 17 МБ")


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


@pytest.mark.parametrize("first", [(60, 20), (80, 24), (120, 40)])
async def test_panels_of_a_window_that_grew_lie_as_in_one_that_was_large(
    first: tuple[int, int],
) -> None:
    def places(app: DeckApp) -> list[object]:
        return [panel.region for panel in app.screen.query_one(PanelGrid).panels]

    async with opened(size=(200, 60)) as (app, _pilot):
        large = places(app)
    async with opened(size=first) as (app, pilot):
        await pilot.resize_terminal(200, 60)
        await pilot.pause()
        assert places(app) == large


async def test_any_size_is_survived() -> None:
    async with opened() as (app, pilot):
        for size in ((40, 10), (20, 5), (3, 2), (59, 60), (300, 8)):
            for columns, rows in (size, (120, 40)):
                await pilot.resize_terminal(columns, rows)
                await pilot.pause()
            assert "sonar_front" in app.screen.query_one(NodesTable).render_line(1).text


async def test_a_terminal_too_small_for_panels_says_so() -> None:
    async with opened(size=(50, 30)) as (app, _pilot):
        assert app.screen.query_one("#small").display
        assert not app.screen.query_one(PanelGrid).display


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
