"""What the Flow screen does: it follows, walks, hides, pauses, and keeps what it has."""

from __future__ import annotations

from contextlib import AbstractAsyncContextManager
from dataclasses import replace
from typing import Any

import numpy as np

from graph.data import Sample
from launcher.events import LogEvent
from robot.topics import SONAR_FRONT
from tests.tui.recorded import NOW_S, RecordedGraph, RecordedOpener, RecordedSession, sample
from tests.tui.recorded_flow import BEFORE, command, update, voice, voice_lines
from tests.tui.screen_stage import ScreenStage, on_stage
from tests.tui.snapshots import opened, settle
from tests.waiting import until
from tui.flow.chains import Lane
from tui.flow.reading import TOPICS
from tui.flow.screen import FlowScreen
from tui.panels.sonar import Sonar
from tui.session.past import KEPT, Past


def came(name: str, value: dict[str, object], at_s: float) -> Sample:
    """One message, so long after the recording's beginning."""
    return replace(sample(name, "std_msgs/msg/String", value), received_s=NOW_S + at_s)


class FlowStage(ScreenStage[FlowScreen]):
    """The screen with its recorded session and graph."""

    name, kind = "flow", FlowScreen

    async def hear(self, *samples: Any) -> None:
        await self.show(update(*samples))

    def rows(self) -> list[str]:
        """What is drawn, without blanks at the ends."""
        view = self.screen.view
        height = int(view.virtual_size.height)
        view.scroll_to(y=0, animate=False)
        return [view.render_line(y).text.strip(" ▶") for y in range(1, min(height, view.size.height))]


def stage() -> AbstractAsyncContextManager[FlowStage]:
    graph, session = RecordedGraph(update(*BEFORE)), RecordedSession(lines=())
    return on_stage(FlowStage, RecordedOpener(session, graph))


async def test_it_follows_its_topics_also_behind_another_screen() -> None:
    async with stage() as at:
        assert at.graph.wanted.followed >= set(TOPICS)
        await at.press("1")
        assert at.graph.wanted.followed >= set(TOPICS)
        await at.hear(*voice(0.0))
        await at.press("6")
        assert len(at.screen.chains) == 1
        assert any("/wheel_commands" in row for row in at.rows())


async def test_messages_and_log_lines_meet_in_one_chain() -> None:
    async with stage() as at:
        at.session.say(LogEvent(voice_lines(0.0)))
        await at.hear(*voice(0.0))
        rows = at.rows()
        assert "13 steps in 1012 ms" in rows[0]
        assert "/audio/mic_raw" in rows[1]
        assert all("ai_brain" in row and " ms  " in row for row in rows[2:5])


async def test_the_cursor_walks_and_the_whole_of_a_step_is_shown() -> None:
    async with stage() as at:
        await at.hear(*voice(0.0))
        await at.hear(*command(9.0))
        assert at.screen.chosen_chain is at.screen.chains[0]
        await at.press("n")
        assert at.screen.chosen_chain is at.screen.chains[1]
        await at.press("down", "down")
        step = at.screen.chosen_step
        assert step is not None
        assert step.source == "/ai_command"
        assert "вперед" in str(at.screen.query_one("#flow-step").render())
        await at.press("N")
        assert at.screen.chosen_chain is at.screen.chains[0]


async def test_a_kind_can_be_hidden_and_all_shown_again() -> None:
    async with stage() as at:
        await at.hear(*voice(0.0))
        await at.press("down", "m")
        assert not any("/audio/mic_raw" in row for row in at.rows())
        at.screen.action_lane(Lane.WHEELS.value)
        assert not any("/wheel_commands" in row for row in at.rows())
        await at.press("a")
        assert any("/audio/mic_raw" in row for row in at.rows())


async def test_paused_it_stands_still_and_loses_nothing() -> None:
    async with stage() as at:
        await at.hear(*voice(0.0))
        await at.press("p")
        await at.hear(*command(9.0))
        assert len(at.screen.chains) == 1
        assert "+1" in str(at.screen.query_one("#flow-lanes").render())
        await at.press("p")
        assert len(at.screen.chains) == 2


async def test_it_has_what_came_before_it_was_opened_and_the_deck_has_the_trend() -> None:
    graph = RecordedGraph(update(*BEFORE))
    opener = RecordedOpener(RecordedSession(lines=()), graph)
    async with opened(opener, "logs") as (app, pilot):
        assert graph.wanted.followed >= set(TOPICS)
        assert SONAR_FRONT in graph.wanted.watched
        for at_s in range(30):
            far = came(SONAR_FRONT, {"data": 2.0}, at_s)
            graph.show(update(*voice(0.0) if at_s == 3 else (), far))
            await settle(pilot)
        await pilot.press("6")
        await settle(pilot)
        flow = app.screen
        assert isinstance(flow, FlowScreen)
        assert len(flow.chains) == 1
        await pilot.press("1")
        await until(lambda: app.screen.query("Sonar#front"), "the gauge")
        gauge = app.screen.query_one("Sonar#front", Sonar)
        await until(lambda: len(gauge._times) >= 30, "the trend")
        assert len(gauge._times) == 30


def test_of_the_past_what_is_repeated_is_kept_twice_and_the_rest_is_bounded() -> None:
    past, now = Past(), update()
    for at_s in range(500):
        told = {"header": {"stamp": at_s}, "speed": 0.1, "wheels": np.zeros(4)}
        past.take(update(came("/drive", told, at_s), came("/ai_command", {"data": str(at_s)}, at_s)))
    kept = past.before(now, {"/drive", "/ai_command"}).samples
    assert [one.received_s - NOW_S for one in kept["/drive"]] == [0, 1]
    newest = [str(number) for number in range(500 - KEPT, 500)]
    assert [one.value["data"] for one in kept["/ai_command"]] == newest
    assert past.before(now, set()) is now
