"""How the Flow screen looks, at three sizes and in both languages."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

from textual.pilot import Pilot

from launcher.events import LogEvent
from tests.tui.recorded import RecordedGraph, RecordedOpener, RecordedSession, lesson_update
from tests.tui.recorded_flow import BEFORE, command, update, voice, voice_lines
from tests.tui.snapshots import Look, SnapCompare, every_look, one_look, settle
from tui.app import DeckApp

Before = Callable[[Pilot[Any]], Awaitable[None]]


def before_speech() -> RecordedOpener:
    """Lesson 9 before anybody has spoken."""
    return RecordedOpener(RecordedSession(lines=()), RecordedGraph(update(*BEFORE)))


def spoken(*keys: str, twice: bool = False) -> Before:
    """Let somebody speak, a person type a word if `twice`, then press keys."""

    async def before(pilot: Pilot[Any]) -> None:
        await settle(pilot)
        app = pilot.app
        assert isinstance(app, DeckApp)
        session, graph = app.feed.link, app.feed.graph
        assert isinstance(session, RecordedSession)
        assert isinstance(graph, RecordedGraph)
        graph.show(update(*voice(0.0)))
        session.say(LogEvent(voice_lines(0.0)))
        if twice:
            await pilot.pause()
            graph.show(update(*command(9.0)))
        for _round in range(4):
            await pilot.pause()
        await pilot.press(*keys)
        await pilot.pause()

    return before


@every_look
def test_one_utterance(look: Look, snap_compare: SnapCompare) -> None:
    """From the microphone to wheels and head, each with its delay and a bar on an axis of time."""
    assert snap_compare(
        look.app("flow", before_speech()), terminal_size=look.size, run_before=spoken()
    )


@one_look
def test_nobody_has_spoken(look: Look, dump_compare: SnapCompare) -> None:
    """Why it is empty, and what to do: wait for the microphone, or type a word."""
    app = look.app("flow", before_speech())
    assert dump_compare(app, terminal_size=look.size, run_before=look.settle)


@one_look
def test_two_utterances(look: Look, dump_compare: SnapCompare) -> None:
    """The newest on top; the cursor is on the older one, at its third step."""
    before = spoken("n", "down", "down", "down", twice=True)
    assert dump_compare(
        look.app("flow", before_speech()), terminal_size=look.size, run_before=before
    )


@one_look
def test_less_and_more(look: Look, dump_compare: SnapCompare) -> None:
    """Other logs shown, the microphone hidden, an even axis, the newest folded, and paused."""
    before = spoken("enter", "n", "down", "m", "l", "s", "p", twice=True)
    assert dump_compare(
        look.app("flow", before_speech()), terminal_size=look.size, run_before=before
    )


@one_look
def test_nothing_to_speak_to(look: Look, dump_compare: SnapCompare) -> None:
    """No topic that a voice or a command would come on: says so."""
    empty = RecordedOpener(
        RecordedSession(lines=()), RecordedGraph(lesson_update(topics=(), samples={}))
    )
    app = look.app("flow", empty)
    assert dump_compare(app, terminal_size=look.size, run_before=look.settle)
