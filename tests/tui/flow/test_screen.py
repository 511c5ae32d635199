"""What the Flow screen does: it follows, walks, hides, pauses, and keeps what it has."""

from __future__ import annotations

from contextlib import AbstractAsyncContextManager
from typing import Any

from launcher.events import LogEvent
from tests.tui.recorded import RecordedGraph, RecordedOpener, RecordedSession
from tests.tui.recorded_flow import BEFORE, command, update, voice, voice_lines
from tests.tui.screen_stage import ScreenStage, on_stage
from tui.flow.chains import Lane
from tui.flow.reading import TOPICS
from tui.flow.screen import FlowScreen
from tui.flow.view import FlowView


class FlowStage(ScreenStage[FlowScreen]):
    """The screen with its recorded session and graph."""

    name, kind = "flow", FlowScreen

    async def hear(self, *samples: Any) -> None:
        await self.show(update(*samples))

    def rows(self) -> list[str]:
        """What is drawn, without blanks at the ends."""
        view = self.screen.query_one(FlowView)
        height = int(view.virtual_size.height)
        view.scroll_to(y=0, animate=False)
        return [view.render_line(y).text.strip() for y in range(min(height, view.size.height))]


def stage() -> AbstractAsyncContextManager[FlowStage]:
    graph, session = RecordedGraph(update(*BEFORE)), RecordedSession(lines=())
    return on_stage(FlowStage, RecordedOpener(session, graph))


async def test_it_follows_its_topics_also_behind_another_screen() -> None:
    async with stage() as at:
        assert at.graph.followed >= set(TOPICS)
        await at.press("1")
        assert at.graph.followed >= set(TOPICS)
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
        assert [row.split()[2] for row in rows[2:6]] == [
            *("/audio/mic_raw", "ai_brain", "ai_brain", "ai_brain")
        ]


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
