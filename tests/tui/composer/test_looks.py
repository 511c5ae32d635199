"""How the composer looks, at three sizes and in both languages."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot

from brain.budget import TokenUsage
from brain.settings import settings_path
from brain.thinking import Thought
from robot.commands.schema import parse_llm
from tests.tui.composer.test_composer import PARSER
from tests.tui.composer.test_outcome import drive, head, result, safety, wheels
from tests.tui.recorded import RecordedGraph, RecordedOpener, lesson_update
from tests.tui.snapshots import (
    Look,
    SnapCompare,
    both_languages,
    every_look,
    one_look,
    settle,
)
from tests.waiting import until
from tui import clock
from tui.app import DeckApp
from tui.composer.compare import ComparedAnswer, CompareDialog
from tui.composer.json_editor import JsonEditor
from tui.composer.question import ModelAnswer
from tui.composer.screen import ComposerScreen

BAD = """{
  "thought": "I am in a hurry",
  "commands": [
    {"action": "turn_head", "pan": 120, "tilt": 10.5},
    {"action": "drive", "speed": "fast", "stering": 0.1},
    {"action": "jump"}
  ]
}
"""

Before = Callable[[Pilot[Any]], Awaitable[None]]


@pytest.fixture(autouse=True)
def _own_history(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


@pytest.fixture(autouse=True)
def _budget_of_the_beginning(monkeypatch: pytest.MonkeyPatch) -> None:
    """How many calls there were in the last minute would be told by the clock, again and again."""
    monkeypatch.setattr(ComposerScreen, "_show_budget", lambda _screen: None)


def with_parser() -> RecordedOpener:
    """A lesson with llm_parser in it."""
    topics = (*lesson_update().topics, PARSER)
    return RecordedOpener(graph=RecordedGraph(update=lesson_update(topics=topics)))


def written(text: str | None, *keys: str, came: tuple[tuple[float, Any], ...] = ()) -> Before:
    """Write this text, press these keys, and let these messages come so long after."""

    async def before(pilot: Pilot[Any]) -> None:
        await settle(pilot)
        app = pilot.app
        assert isinstance(app, DeckApp)
        screen, graph = app.screen, app.feed.graph
        assert isinstance(screen, ComposerScreen)
        if text is not None:
            screen.editor.replace_all(text)
            screen.check()
        await pilot.press(*keys)
        samples: dict[str, tuple[Any, ...]] = {}
        for after_s, message in came:
            arrived = replace(message, received_s=clock.now() + after_s)
            samples[arrived.topic] = (*samples.get(arrived.topic, ()), arrived)
        topics = (*lesson_update().topics, PARSER)
        graph.show(lesson_update(topics=topics, samples=samples))  # type: ignore[union-attr]
        for _round in range(3):
            await pilot.pause()

    return before


@every_look
def test_accepted(look: Look, snap_compare: SnapCompare) -> None:
    """The example in colour, valid; what came of it in order of time, each with its delay."""
    came = (
        (0.012, result(event="accepted", commands=2, thought="Something moved on the right.")),
        (0.015, drive("/drive", 0.2, -0.3)),
        (0.019, drive("/drive_safe", 0.2, -0.3)),
        (0.031, wheels(6.36, 5.75)),
        (0.4, head(-0.4, 0.1)),
        (1.03, head(-0.7854, 0.1745)),
        (1.043, result(event="head", pan=-45, tilt=10, sum=1)),
    )
    before = written(None, "ctrl+s", came=came)
    assert snap_compare(
        look.app("composer", with_parser()), terminal_size=look.size, run_before=before
    )


@one_look
@pytest.mark.every_frame
def test_wrong(look: Look, dump_compare: SnapCompare) -> None:
    """Wrong values underlined, their lines marked, each problem listed with its place."""
    app = look.app("composer", with_parser())
    assert dump_compare(app, terminal_size=look.size, run_before=written(BAD))


@one_look
@pytest.mark.every_frame
def test_refused_and_held(look: Look, dump_compare: SnapCompare) -> None:
    """Sent all the same: refused with its reasons; the safety node holds the wheels meanwhile."""
    problem = {
        "field": "commands[0].pan", "line": 4, "column": 36, "message": "must be a number",
        "code": "number", "args": {},
    }  # fmt: skip
    came = (
        (0.009, result(event="refused", problems=[problem])),
        (0.2, safety("obstacle at 0.38 m")),
    )
    before = written(BAD, "ctrl+o", came=came)
    assert dump_compare(
        look.app("composer", with_parser()), terminal_size=look.size, run_before=before
    )


@pytest.mark.parametrize("language", ["en", "ru"])
def test_hostile_text(language: str, dump_compare: SnapCompare) -> None:
    """Escape sequences and markup in the editor, the problems and the answer: all harmless."""
    look = Look((80, 24), language)
    text = '{"thought": "\x1b]52;c;aGVsbG8=\x07 [red] \u202e", "\x1b[2J": "[/]"}'
    answer = result(event="accepted", commands=1, thought="[b]\x1b[31m\x00\u202e[/b]")
    before = written(text, "ctrl+o", came=((0.01, answer),))
    assert dump_compare(
        look.app("composer", with_parser()), terminal_size=look.size, run_before=before
    )


@pytest.mark.parametrize("language", ["en", "ru"])
def test_templates(language: str, dump_compare: SnapCompare) -> None:
    """A dialog over the composer lists the templates, right ones first."""
    look = Look((120, 40), language)
    before = written(None, "ctrl+t")
    assert dump_compare(
        look.app("composer", with_parser()), terminal_size=look.size, run_before=before
    )


def test_a_tiny_terminal(dump_compare: SnapCompare) -> None:
    """At 40x12 there is still an editor, a verdict and the beginning of what came."""
    app = Look((40, 12), "en").app("composer", with_parser())
    assert dump_compare(app, terminal_size=(40, 12), run_before=written(None, "ctrl+s"))


ANSWER = """{
  "thought": "Something moved on the right. I look there.",
  "commands": [
    {"action": "turn_head", "pan": -45, "tilt": 10}
  ]
}
"""
TOOK = TokenUsage("qwen3-1.7b", 412, 86, 0.31, 1.204)


def settings() -> None:
    """Write down two models and their prices."""
    path = settings_path()
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(
        "base_url: http://127.0.0.1:9/v1\nmodel: qwen3-1.7b\ncompare_with: qwen3-4b\n"
        "prices: {input_per_million: 0.15, output_per_million: 0.6}\n",
        encoding="utf-8",
    )


@both_languages
def test_a_model_has_answered(look: Look, dump_compare: SnapCompare) -> None:
    """AUTO in the colour of a warning; below the line what the answer took, and the budget."""
    settings()

    async def before(pilot: Pilot[Any]) -> None:
        await written(ANSWER, "alt+q", "alt+a")(pilot)
        screen = pilot.app.screen
        assert isinstance(screen, ComposerScreen)
        screen.asking.answer = ModelAnswer(ANSWER, TOOK)
        screen.asking.show_status()
        await pilot.pause()

    app = look.app("composer", with_parser())
    assert dump_compare(app, terminal_size=look.size, run_before=before)


@both_languages
def test_nobody_answers(look: Look, dump_compare: SnapCompare) -> None:
    """Why, and what to do about it, below the verdict on the text that stands there again."""
    settings()

    async def before(pilot: Pilot[Any]) -> None:
        await written(ANSWER, "alt+q", *"left", "enter")(pilot)
        screen = pilot.app.screen
        assert isinstance(screen, ComposerScreen)
        await until(lambda: not screen.is_asking, "the failure")
        screen.line.show_status("")
        await pilot.pause()

    app = look.app("composer", with_parser())
    assert dump_compare(app, terminal_size=look.size, run_before=before)


@both_languages
def test_two_models_compared(look: Look, dump_compare: SnapCompare) -> None:
    """Side by side, or one above the other; the answer that Enter takes has a coloured title."""
    settings()

    async def before(pilot: Pilot[Any]) -> None:
        await written(None)(pilot)
        screen = pilot.app.screen
        assert isinstance(screen, ComposerScreen)
        screen.line.field.value = "look right"
        await pilot.press("alt+c")
        dialog = pilot.app.screen
        assert isinstance(dialog, CompareDialog)
        first, second = dialog.query(ComparedAnswer)
        await until(lambda: second.state.whole, "both failures")
        first.state.fault = None
        first.state.thought = Thought(parse_llm(ANSWER), ANSWER, (TOOK,))
        dialog.redraw()
        first.query_one(JsonEditor).move_cursor((0, 0))
        await pilot.pause()

    app = look.app("composer", with_parser())
    assert dump_compare(app, terminal_size=look.size, run_before=before)
