"""What the Flow screen does: it follows, walks, hides, pauses, copies, and keeps what it has."""

from __future__ import annotations

from contextlib import AbstractAsyncContextManager
from dataclasses import replace
from typing import Any

from textual.widgets import Static

from launcher.events import LogEvent
from launcher.status import LogLine, Severity
from tests.tui.recorded import NOW_S, RecordedGraph, RecordedOpener, RecordedSession, line
from tests.tui.recorded_brain import brain_state, no_answer_yet
from tests.tui.recorded_flow import BEFORE, command, update, voice, voice_lines, word
from tests.tui.recorded_flow import at as told
from tests.tui.screen_stage import ScreenStage, on_stage
from tui import clock
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


async def test_the_logs_of_other_nodes_come_when_asked() -> None:
    async with stage() as at:
        await at.hear(*voice(0.0))
        at.session.say(LogEvent((line("sonar_front", 1, "Distance: 2.35 m", at_s=0.4),)))
        await at.pilot.pause()
        assert not any("sonar_front" in row for row in at.rows())
        await at.press("F")
        assert any("sonar_front" in row for row in at.rows())


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


async def test_hostile_words_are_drawn_as_they_are() -> None:
    async with stage() as at:
        await at.hear(word("[b]left[/b] \x1b[31m", 9.0))
        assert any("[b]left[/b] ␛[31m" in row for row in at.rows())


async def test_it_speaks_another_language_at_once() -> None:
    async with stage() as at:
        await at.hear(*command(9.0))
        await at.press("f9")
        assert any("рад, влево" in row for row in at.rows())
        await at.press("f9")


async def test_it_says_from_when_on_it_has_collected() -> None:
    async with stage() as at:
        shown = str(at.screen.query_one("#flow-lanes", Static).render())
        # By the time of what has come, which in a replay is not that of the look.
        since = clock.time_of_day(min(one.received_s for one in BEFORE))
        assert f"collected since {since}" in shown.replace("\N{NO-BREAK SPACE}", " ")
        await at.hear(*voice(5.0))
        await at.hear(*(replace(one, received_s=one.received_s - 60) for one in BEFORE))
        earlier = clock.time_of_day(min(one.received_s for one in BEFORE) - 60)
        assert since != earlier
        again = str(at.screen.query_one("#flow-lanes", Static).render())
        assert earlier in again


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


async def test_what_was_answered_before_belongs_to_no_later_chain() -> None:
    async with stage() as at:
        await at.hear(told(brain_state(), -3.0))
        await at.hear(*voice(0.0), told(brain_state(), 0.3))
        assert not any("412 + 86" in row for row in at.rows())


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
