"""A Composer over a recorded lesson 9, the model it asks, and what is seen of the two."""

from __future__ import annotations

import json
import threading
from contextlib import AbstractAsyncContextManager
from typing import TYPE_CHECKING

from textual.widgets import Static

from brain.settings import settings_path
from robot.topics import LLM_RAW_JSON
from tests.model_server import Exchange, obeys
from tests.tui.composer.test_composer import PARSER, ComposerStage
from tests.tui.recorded import RecordedGraph, RecordedOpener, lesson_update
from tests.tui.screen_stage import on_stage
from tests.tui.snapshots import Look
from tests.waiting import until

if TYPE_CHECKING:
    from tests.model_server import Script

DRIVE = {"action": "drive", "speed": 0.2, "steering": 0.0}
GOOD = json.dumps({"thought": "I roll closer.", "commands": [DRIVE]})
FAST = json.dumps({"thought": "I hurry.", "commands": [{**DRIVE, "speed": 5}]})
WORDS = "roll closer"


class Answers:
    """A server that obeys, and answers questions one after the other; the last one again."""

    def __init__(self, *answers: str | Script) -> None:
        self.left = list(answers)

    def __call__(self, exchange: Exchange) -> None:
        if "deck-" in json.dumps(exchange.request):
            obeys("")(exchange)
            return
        answer = self.left.pop(0) if len(self.left) > 1 else self.left[0]
        if isinstance(answer, str):
            exchange.says(answer, usage=(412, 86))
        else:
            answer(exchange)


class InPieces:
    """An answer of which each piece waits for the test."""

    def __init__(self, *pieces: str) -> None:
        self._pieces = pieces
        self._gates = [threading.Event() for _ in pieces]
        self._given = 0
        self.hung_up = threading.Event()

    def give(self) -> None:
        """Let the next piece go."""
        self._gates[self._given].set()
        self._given += 1

    def __call__(self, exchange: Exchange) -> None:
        exchange.begins()
        for gate, piece in zip(self._gates, self._pieces, strict=True):
            self._wait(gate, exchange)
            exchange.piece({"content": piece})
        exchange.ends(usage=(412, 86))

    def _wait(self, gate: threading.Event, exchange: Exchange) -> None:
        try:
            while not gate.wait(0.02):
                # A comment, which says nothing: it fails once the other end has hung up.
                exchange.bytes(b": \n\n")
        except OSError:
            self.hung_up.set()
            raise


def set_up(url: str, **more: str) -> None:
    """Write settings that name this server."""
    fields = {"base_url": url, "model": "m-1", "key_env": "THE_KEY", **more}
    settings_path().parent.mkdir(parents=True, exist_ok=True)
    text = "".join(f"{name}: {value}\n" for name, value in fields.items())
    settings_path().write_text(text, encoding="utf-8")


def composer(size: tuple[int, int] = (120, 40)) -> AbstractAsyncContextManager[ComposerStage]:
    """Open the Composer over a recorded lesson 9."""
    topics = (*lesson_update().topics, PARSER)
    graph = RecordedGraph(update=lesson_update(topics=topics))
    return on_stage(ComposerStage, RecordedOpener(graph=graph), Look(size, "en"))


async def ask(stage: ComposerStage, words: str = WORDS) -> None:
    """Say it in the line, and press Enter."""
    await stage.pilot.press("alt+q")
    stage.screen.line.field.value = words
    await stage.pilot.press("enter")
    await stage.pilot.pause()


async def answered(stage: ComposerStage) -> None:
    """Wait until nothing is under way any more."""
    await until(lambda: not is_asking(stage), "the end of the question")
    await stage.pilot.pause()


def is_asking(stage: ComposerStage) -> bool:
    """Whether an answer is under way."""
    return stage.screen.is_asking


def is_auto(stage: ComposerStage) -> bool:
    """Whether a valid answer is sent by itself."""
    return stage.screen.is_auto


def shown(stage: ComposerStage) -> str:
    """Everything on the screen in front."""
    return "\n".join(strip.text for strip in stage.app.screen._compositor.render_strips())


def verdict(stage: ComposerStage) -> str:
    """The line that says how the JSON stands."""
    return str(stage.screen.verdict.query_one(Static).content)


def status(stage: ComposerStage) -> str:
    """What the answer took, and the budget."""
    return str(stage.screen.query_one("#ask-status", Static).content)


def sent(stage: ComposerStage) -> list[object]:
    """What went to the robot."""
    return [value["data"] for topic, _, value, _ in stage.graph.published if topic == LLM_RAW_JSON]
