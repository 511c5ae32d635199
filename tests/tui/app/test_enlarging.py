"""One part of a screen in the place of all others, by key and by mouse, on every screen."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widget import Widget

from course.lessons.catalog import SHIPPED
from course.lessons.lesson import LessonFolder
from tests.tui import recorded_flow
from tests.tui.agents.test_banner import asks
from tests.tui.app_runs import opened
from tests.tui.recorded import NOW_S, SESSION, RecordedOpener, lesson_update, sample
from tests.tui.recorded_devices import with_drivers
from tests.tui.snapshots import Look, SnapCompare, every_look
from tests.waiting import until
from tui.app import DeckApp
from tui.deck.command_line import CommandLine
from tui.deck.nodes_table import NodesTable
from tui.frame.agent_banner import AgentBanner
from tui.frame.key_bar import KeyBar
from tui.frame.title_bar import TitleBar
from tui.panels.camera import CameraPanel
from tui.panels.panel import Panel
from tui.panels.panel_grid import PanelGrid
from tui.panels.sonar.panel import SonarPanel
from tui.panels.sonar.widget import Sonar
from tui.panels.wheels.panel import WheelsPanel

pytestmark = pytest.mark.nightly


def shown(app: DeckApp) -> str:
    return "\n".join(strip.text for strip in app.screen._compositor.render_strips())


def keys(app: DeckApp) -> str:
    return str(app.screen.query_one(KeyBar).render())


def large(app: DeckApp) -> Widget | None:
    """Return what is enlarged."""
    return app.screen.maximized


def fills_the_screen(app: DeckApp) -> bool:
    """Whether the enlarged part has all lines between the title and the keys."""
    part, (width, height) = large(app), app.size
    return part is not None and part.outer_size == (width, height - 2) and part.region.y == 1


@pytest.mark.parametrize("size", [(80, 24), (120, 40)])
async def test_every_panel_is_enlarged_in_turn_and_everything_comes_back(
    size: tuple[int, int],
) -> None:
    async with opened(size=size) as (app, pilot):
        await pilot.press("tab", "z")
        await pilot.pause()
        seen: list[object] = []
        while large(app) not in seen:
            assert isinstance(large(app), Panel)
            assert fills_the_screen(app)
            seen.append(large(app))
            await pilot.press("v")
            await pilot.pause()
        assert seen == list(app.screen.query(Panel))
        await pilot.press("я")
        await pilot.pause()
        assert large(app) is None
        assert isinstance(app.focused, PanelGrid)
        assert app.focused.chosen is seen[0]
        assert app.screen.query_one(NodesTable).region.height > 2


async def test_the_arrow_keys_choose_which_panel() -> None:
    async with opened() as (app, pilot):
        await pilot.press("tab", "right", "z")
        await pilot.pause()
        assert isinstance(large(app), WheelsPanel)
        await pilot.press("escape", "left", "z")
        await pilot.pause()
        assert isinstance(large(app), SonarPanel)


async def test_two_clicks_enlarge_a_panel_and_one_only_chooses_it() -> None:
    async with opened(size=(200, 60)) as (app, pilot):
        await pilot.click(CameraPanel)
        assert large(app) is None
        assert app.screen.query_one(PanelGrid).chosen is app.screen.query_one(CameraPanel)
        await pilot.click(CameraPanel, times=2)
        await pilot.pause()
        assert isinstance(large(app), CameraPanel)


async def test_an_enlarged_panel_goes_on_living() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("tab", "z")
        await pilot.pause()
        topic = "/sensor/sonar_front"
        reading = sample(topic, "std_msgs/msg/Float32", {"data": 0.27})
        opener.graph.show(lesson_update(samples={topic: (reading,)}))
        front = app.screen.query_one("#front", Sonar)
        await until(lambda: "STOP" in front.render_line(0).text, "the new distance")


async def test_the_stop_works_and_is_seen_above_an_enlarged_panel() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("tab", "z", "space")
        await pilot.pause()
        assert ("/emergency_stop", "std_msgs/msg/Bool", {"data": True}, True) in (
            opener.graph.published
        )
        assert "STOP" in app.screen.query_one(TitleBar).text
        assert app.screen.query_one(TitleBar).region.y == 0
        assert fills_the_screen(app)


async def test_an_agent_can_ask_beside_an_enlarged_panel_and_is_answered() -> None:
    opener = RecordedOpener()
    async with opened(opener, size=(80, 24)) as (app, pilot):
        await pilot.press("tab", "z")
        opener.link.say(asks())
        banner = app.screen.query_one(AgentBanner)
        await until(lambda: banner.region.height >= 3, "the question")
        assert "claude" in banner.text
        await until(lambda: app.agents.was_read, "a question that was read")
        await pilot.press("shift+f9")
        await until(lambda: ("answer", "1", "refuse") in opener.link.asked, "the answer")


async def test_no_key_acts_on_a_node_that_is_hidden() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("tab", "z", "x", "r", "m")
        await pilot.pause()
        assert opener.link.asked == []
        assert "x Stop" not in keys(app)
        assert "z Back to all" in keys(app)
        await pilot.press("z", "x")
        await pilot.pause()
        assert opener.link.asked == [("stop", "sonar_front")]
        assert "z Back" not in keys(app)


async def test_what_takes_the_focus_elsewhere_shows_everything_again() -> None:
    async with opened() as (app, pilot):
        await pilot.press("tab", "z", "c")
        await pilot.pause()
        assert large(app) is None
        assert app.focused is app.screen.query_one(CommandLine).field


async def test_a_panel_that_goes_with_its_session_does_not_stay_enlarged() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("tab", "z")
        await pilot.pause()
        opener.link.session = replace(SESSION, panels=("camera",))
        app.feed.connect(opener.link, opener.graph)
        await until(lambda: len(app.screen.query(Panel)) == 1, "the other panels")
        await pilot.pause()
        assert large(app) is None
        assert "sonar_front" in shown(app)


PARTS = {
    "topics": ("z", "TopicDetail"),
    "graph": ("z", "GraphDetail"),
    "logs": ("я", "LogPane"),
    "flow": ("z", "FlowView"),
    "devices": ("z", "LogPane"),
    "composer": ("alt+z", "#composer-right"),
    "lesson": ("z", "#lesson-reading"),
    "deck": ("z", "#nodes"),
}


def with_everything() -> RecordedOpener:
    """A session of a lesson, with drivers."""
    opener = with_drivers()
    opener.task = LessonFolder(SHIPPED / "02-sonar-safety")
    return opener


@pytest.mark.parametrize("screen", PARTS)
async def test_a_part_of_every_screen_is_enlarged_and_comes_back(screen: str) -> None:
    key, part = PARTS[screen]
    opener = with_everything()
    async with opened(opener, screen=screen, size=(80, 24)) as (app, pilot):
        opener.graph.show(recorded_flow.update(*recorded_flow.voice(NOW_S)))
        shows = app.screen.query
        await until(lambda: any(one.region.height for one in shows(part)), "the part")
        had = app.focused
        await pilot.press(key)
        await pilot.pause()
        assert large(app) is app.screen.query_one(part)
        assert fills_the_screen(app)
        await pilot.press("escape")
        await pilot.pause()
        assert large(app) is None
        assert app.focused is had


async def test_nothing_is_enlarged_where_there_is_nothing_yet() -> None:
    async with opened(screen="devices") as (app, pilot):
        await pilot.press("z")
        await pilot.pause()
        assert large(app) is None


async def test_letters_typed_into_a_field_enlarge_nothing() -> None:
    async with opened(screen="topics") as (app, pilot):
        await pilot.press("slash", "z", "я")
        await pilot.pause()
        assert large(app) is None
        assert getattr(app.focused, "value", "") == "zя"


@every_look
def test_an_enlarged_panel_looks(look: Look, dump_compare: SnapCompare) -> None:
    """The map between title and keys, without a page number; the footer names the way back."""

    async def enlarge(pilot: Pilot[Any]) -> None:
        await look.settle(pilot)
        await pilot.press("tab", "z")
        await pilot.pause()

    assert dump_compare(look.app(), terminal_size=look.size, run_before=enlarge)
