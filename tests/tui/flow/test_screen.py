"""What the Flow screen does: it follows, walks, hides, pauses, copies, and keeps what it has."""

from __future__ import annotations

from contextlib import AbstractAsyncContextManager
from typing import Any

from launcher.events import LogEvent
from launcher.status import LogLine, Severity
from tests.tui.recorded import NOW_S, RecordedGraph, RecordedOpener, RecordedSession
from tests.tui.recorded_brain import brain_state, no_answer_yet
from tests.tui.recorded_flow import BEFORE, command, update, voice, voice_lines, word
from tests.tui.recorded_flow import at as told
from tests.tui.screen_stage import ScreenStage, on_stage
from tui.flow.chains import Lane
from tui.flow.reading import TOPICS
from tui.flow.screen import FlowScreen
from tui.flow.view import FlowView
from tui.outcome.model_usage import COMPOSER, UsageFigures, noted


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
            *("/audio/mic_raw", "ai_brain", "ai_brain", "ai_brain"),
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


async def test_who_looks_at_an_older_one_is_not_carried_away_by_a_newer_one() -> None:
    async with stage() as at:
        await at.hear(*voice(0.0))
        await at.press("down", "down", "down")
        chosen = at.screen.chosen_step
        await at.hear(*command(9.0))
        assert at.screen.chosen_step == chosen
        assert len(at.screen.chains) == 2


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


async def test_an_utterance_is_copied_as_text() -> None:
    async with stage() as at:
        await at.hear(*command(9.0))
        await at.press("y")
        copied = at.app.clipboard
        assert "“налево” · 4 steps in 5.2 ms" in copied
        assert "2.1 ms  /drive" in copied
        assert "a person" in copied


async def test_a_model_s_answer_is_named_with_what_it_took() -> None:
    """Once for the chain, however often it is reported, and not by whoever looks at pictures."""
    async with stage() as at:
        await at.hear(told(no_answer_yet(), -3.0))
        await at.hear(*voice(0.0), told(brain_state(), 0.3))
        await at.hear(told(brain_state(), 1.3), told(brain_state(node="vlm_agent", model="v"), 1.4))
        took = "m-1: 412 + 86 tokens · first 0.31 s · all 1.20 s · 0.00011 USD"
        assert at.rows()[1] == took
        assert not any("/brain_state" in row for row in at.rows())
        await at.press("y")
        assert took in at.app.clipboard


async def test_what_the_composer_sent_is_named_with_what_it_took() -> None:
    async with stage() as at:
        await at.hear(told(word("{}", 0.0, "/llm_raw_json"), 0.0))
        usage = UsageFigures("m-2", 100, 20, 0.5, 1.0, 0.5, "EUR")
        noted_at_s = NOW_S + 0.001
        at.session.say(
            LogEvent(
                (LogLine(COMPOSER, 1, noted_at_s, Severity.INFO, noted(usage), source="deck"),)
            )
        )
        for _round in range(3):
            await at.pilot.pause()
        rows = at.rows()
        assert rows[1] == "m-2: 100 + 20 tokens · first 0.50 s · all 1.00 s · 0.50 EUR"
        assert any(row.split()[2:3] == [COMPOSER] for row in rows)
