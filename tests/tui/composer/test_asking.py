"""The Composer asks a model, of a real server: what comes, what is sent, and what never is."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from contextlib import AbstractAsyncContextManager
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from textual.widgets import OptionList, Static

from brain.settings import settings_path
from graph.data import Sample
from graph.observer.requests import Publish
from robot.topics import LLM_RAW_JSON, LLM_RESULT, SONAR_FRONT
from safety.topics import SAFETY_STATE
from tests.model_server import KEY, Exchange, ModelServer, obeys
from tests.tui.composer.test_composer import PARSER, ComposerStage
from tests.tui.recorded import RecordedGraph, RecordedOpener, lesson_update
from tests.tui.recorded_lesson import SESSION
from tests.tui.screen_stage import on_stage
from tests.tui.snapshots import Look, seen
from tests.waiting import until
from tui import clock
from tui.composer.dialogs import PromptDialog
from tui.composer.question import RobotSenses

if TYPE_CHECKING:
    from tests.model_server import Script

pytestmark = pytest.mark.nightly
DRIVE = {"action": "drive", "speed": 0.2, "steering": 0.0}
GOOD = json.dumps({"thought": "I roll closer.", "commands": [DRIVE]})
FAST = json.dumps({"thought": "I hurry.", "commands": [{**DRIVE, "speed": 5}]})
WORDS = "roll closer"


def _closes(exchange: Exchange) -> None:
    exchange.begins()
    exchange.piece({"content": GOOD[:30]})
    raise OSError


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
    stage.screen.draft.line.field.value = words
    await stage.pilot.press("enter")
    await stage.pilot.pause()


async def answered(stage: ComposerStage) -> None:
    """Wait until nothing is under way any more."""
    await until(lambda: not stage.screen.is_asking, "the end of the question")
    await stage.pilot.pause()


def verdict(stage: ComposerStage) -> str:
    """The line that says how the JSON stands."""
    return str(stage.screen.draft.verdict.query_one(Static).content)


def status(stage: ComposerStage) -> str:
    return str(stage.screen.query_one("#ask-status", Static).content)


def sent(stage: ComposerStage) -> list[object]:
    return [value["data"] for topic, _, value, _ in stage.graph.asked(Publish) if topic == LLM_RAW_JSON]


@pytest.fixture(autouse=True)
def own_folders(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("THE_KEY", KEY)
    (tmp_path / "run" / SESSION.run_id).mkdir(parents=True)


@pytest.fixture
def server() -> Iterator[ModelServer]:
    """A model that gives one good answer, again and again."""
    with ModelServer(Answers(GOOD)) as server:
        yield server


FAULTS: dict[str, tuple[Script, str, str]] = {
    "key": (lambda one: one.fails(401), "does not take the key (401)", "key_env or key_file"),
    "model": (lambda one: one.fails(404), "does not know the model m-1", "base_url and model"),
    "busy": (lambda one: one.fails(429), "too many requests", ""),
    "server": (lambda one: one.fails(503), "the server failed (503)", ""),
    "cut": (_closes, "connection was lost in the middle", ""),
    "empty": (lambda one: one.says(""), "the answer is empty", ""),
    "html": (lambda one: one.fails(200, "<p>", "text/html"), "not the address of a model", "/v1"),
}


async def test_an_answer_waits_in_the_editor_to_be_sent(server: ModelServer) -> None:
    set_up(server.url)
    async with composer() as stage:
        example = stage.screen.draft.editor.text
        await stage.pilot.press("x")
        before = stage.screen.draft.editor.text
        await ask(stage)
        await answered(stage)
        assert stage.screen.draft.editor.text == GOOD
        assert verdict(stage) == "✓ valid: 1 command"
        assert stage.screen.draft.editor.has_focus
        assert sent(stage) == []
        await stage.pilot.press("ctrl+s")
        await stage.pilot.pause()
        assert sent(stage) == [GOOD]
        assert stage.screen.draft.line.note == ""
        await stage.pilot.press("ctrl+z")
        assert stage.screen.draft.editor.text == before
        await stage.pilot.press("ctrl+z")
        assert stage.screen.draft.editor.text == example


async def test_the_answer_grows_and_is_checked_while_it_comes(server: ModelServer) -> None:
    """Nobody can edit it meanwhile, and what is wrong is listed before it is whole."""
    cut = FAST.index("]")
    answer = InPieces(FAST[:19], FAST[19:cut], FAST[cut:])
    server.script = Answers(answer, GOOD)
    set_up(server.url)
    async with composer() as stage:
        await ask(stage)
        await until(lambda: "asking m-1" in verdict(stage), "that it is asked")
        answer.give()
        await until(lambda: stage.screen.draft.editor.text == FAST[:19], "the first piece")
        assert verdict(stage) == "… m-1 answers: 0 commands so far"
        stage.screen.draft.editor.focus()
        await stage.pilot.press("x", "ctrl+s")
        assert stage.screen.draft.editor.text == FAST[:19]
        answer.give()
        await until(lambda: verdict(stage) == "✗ m-1 answers: 1 problem so far", "what is wrong")
        listed = stage.screen.draft.verdict.query_one(OptionList)
        assert "must be from -0.5 to 0.5 m/s" in str(listed.get_option_at_index(0).prompt)
        answer.give()
        await answered(stage)
        assert stage.screen.draft.editor.text == GOOD
        assert sent(stage) == []


async def test_a_refused_answer_is_repaired_in_sight(server: ModelServer) -> None:
    second = InPieces(GOOD[:19], GOOD[19:])
    server.script = Answers(FAST, second)
    set_up(server.url)
    async with composer() as stage:
        await ask(stage)
        await until(lambda: "is asked once more" in stage.screen.draft.line.note, "the second question")
        assert "commands[0].speed: must be from -0.5 to 0.5 m/s, not 5" in stage.screen.draft.line.note
        second.give()
        second.give()
        await answered(stage)
        assert stage.screen.draft.editor.text == GOOD
        assert "the second is" in stage.screen.draft.line.note
        assert status(stage).startswith("m-1: 824 + 172 tokens")


@pytest.mark.parametrize("kind", FAULTS)
async def test_each_failure_has_its_own_words_that_stay(kind: str, server: ModelServer) -> None:
    """The editor has its text again, AUTO is over, and nothing was sent."""
    script, words, mend = FAULTS[kind]
    set_up(server.url)
    async with composer() as stage:
        before = stage.screen.draft.editor.text
        await ask(stage)
        await answered(stage)
        await stage.write(before)
        server.script = Answers(script)
        await stage.pilot.press("alt+a")
        await ask(stage)
        await answered(stage)
        assert words in stage.screen.draft.line.note
        assert mend in stage.screen.draft.line.note
        assert stage.screen.draft.editor.text == before
        assert not stage.screen.draft.editor.read_only
        assert not stage.screen.draft.auto
        assert sent(stage) == []
        await stage.hear()
        assert words in stage.screen.draft.line.note


async def test_escape_hangs_up_and_brings_the_text_back(server: ModelServer) -> None:
    answer = InPieces(GOOD[:19], GOOD[19:])
    server.script = Answers(answer)
    set_up(server.url)
    async with composer() as stage:
        before = stage.screen.draft.editor.text
        await ask(stage)
        await until(lambda: len(server.exchanges) == 2, "the question")
        answer.give()
        await until(lambda: stage.screen.draft.editor.text == GOOD[:19], "the first piece")
        await stage.pilot.press("escape")
        await stage.pilot.pause()
        assert not stage.screen.is_asking
        assert stage.screen.draft.editor.text == before
        await until(answer.hung_up.is_set, "the end of the connection")


async def test_auto_sends_a_valid_answer_by_itself(server: ModelServer) -> None:
    set_up(server.url)
    async with composer() as stage:
        assert "AUTO" not in seen(stage.app)
        await stage.pilot.press("alt+a")
        await stage.pilot.pause()
        assert " AUTO " in seen(stage.app)
        await ask(stage)
        await answered(stage)
        assert sent(stage) == [GOOD]
        assert stage.screen.draft.auto
        await stage.pilot.press("alt+a")
        await ask(stage)
        await answered(stage)
        assert sent(stage) == [GOOD]


async def test_the_emergency_stop_ends_auto_while_the_answer_comes(server: ModelServer) -> None:
    """The answer is there to be looked at, and goes nowhere, not even after a release."""
    answer = InPieces(GOOD[:19], GOOD[19:])
    server.script = Answers(answer, GOOD)
    set_up(server.url)
    async with composer() as stage:
        await stage.pilot.press("alt+a")
        await ask(stage)
        answer.give()
        await until(lambda: stage.screen.draft.editor.text == GOOD[:19], "the first piece")
        await stage.pilot.press("ctrl+x")
        await stage.pilot.pause()
        assert not stage.screen.draft.auto
        assert "the emergency stop has ended it" in stage.screen.draft.line.note
        await stage.pilot.press("alt+a")
        assert not stage.screen.draft.auto
        await stage.pilot.press("ctrl+r")
        answer.give()
        await answered(stage)
        assert stage.screen.draft.editor.text == GOOD
        assert sent(stage) == []
        assert not stage.screen.draft.auto


async def test_the_prompt_that_went_out_can_be_looked_at(server: ModelServer) -> None:
    """Every message with the repair, and the form; the key is nowhere, here or on any screen."""
    server.script = Answers(FAST, GOOD)
    set_up(server.url)
    async with composer() as stage:
        await stage.pilot.press("alt+p")
        await stage.pilot.pause()
        assert "Nothing has been asked" in seen(stage.app)
        await stage.pilot.press("escape")
        await ask(stage, f"roll closer {KEY}")
        await answered(stage)
        await stage.pilot.press("alt+p")
        await stage.pilot.pause()
        dialog = stage.app.screen
        assert isinstance(dialog, PromptDialog)
        text = dialog.words().plain
        for words in ("You turn what a person says", 'Somebody says: "roll closer', FAST, "strict"):
            assert words in text
        assert "That answer is not valid" in text
        assert KEY not in text
        await stage.pilot.press("escape")
        await stage.pilot.pause()
        assert stage.app.screen is stage.screen
    assert server.exchanges[-1].headers["authorization"] == f"Bearer {KEY}"


async def test_no_model_is_set_up() -> None:
    """The line says so and where to read on; the rest of the Composer works."""
    async with composer() as stage:
        assert "docs/models.md" in stage.screen.draft.line.field.placeholder
        await ask(stage)
        assert "no language model is set up — docs/models.md" in stage.screen.draft.line.note
        assert not stage.screen.is_asking
        await stage.write(GOOD)
        await stage.pilot.press("ctrl+s")
        await stage.pilot.pause()
        assert sent(stage) == [GOOD]


def test_the_model_is_told_what_the_screen_sees() -> None:
    """Distance, the gate's sentence, and what became of the last commands."""
    refused = {"data": '{"event": "refused", "problems": []}'}
    gate = {"status": [{"name": "safety_stop", "message": "forward is blocked", "values": []}]}
    senses = RobotSenses()
    for topic, kind, value in (
        (SONAR_FRONT, "std_msgs/msg/Float32", {"data": 1.25}),
        (SAFETY_STATE, "diagnostic_msgs/msg/DiagnosticArray", gate),
        (LLM_RESULT, "std_msgs/msg/String", refused),
    ):
        senses.see({topic: (Sample(topic, kind, clock.now(), 0.0, 100, value),)})
    situation = senses.situation("go on")
    assert (situation.heard, situation.front_m) == ("go on", 1.25)
    assert situation.gate == "forward is blocked"
    assert situation.refused
