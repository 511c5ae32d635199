"""The Composer asks a model, of a real server: what comes, what is sent, and what never is."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from textual.widgets import OptionList

from tests.model_server import KEY, Exchange, ModelServer
from tests.tui.composer.asking import (
    FAST,
    GOOD,
    Answers,
    InPieces,
    answered,
    ask,
    composer,
    is_asking,
    is_auto,
    sent,
    set_up,
    shown,
    status,
    verdict,
)
from tests.tui.recorded_lesson import SESSION
from tests.waiting import until
from text.run_path import MODEL_USAGE
from tui.composer.prompt_dialog import PromptDialog

if TYPE_CHECKING:
    from tests.model_server import Script

pytestmark = [pytest.mark.usefixtures("own_folders"), pytest.mark.nightly]


async def test_an_answer_waits_in_the_editor_to_be_sent(server: ModelServer) -> None:
    set_up(server.url)
    async with composer() as stage:
        example = stage.screen.editor.text
        await stage.pilot.press("x")
        before = stage.screen.editor.text
        await ask(stage)
        await answered(stage)
        assert stage.screen.editor.text == GOOD
        assert verdict(stage) == "✓ valid: 1 command"
        assert stage.screen.editor.has_focus
        assert sent(stage) == []
        await stage.pilot.press("ctrl+s")
        await stage.pilot.pause()
        assert sent(stage) == [GOOD]
        assert stage.screen.line.note == ""
        await stage.pilot.press("ctrl+z")
        assert stage.screen.editor.text == before
        await stage.pilot.press("ctrl+z")
        assert stage.screen.editor.text == example


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
        await until(lambda: stage.screen.editor.text == FAST[:19], "the first piece")
        assert verdict(stage) == "… m-1 answers: 0 commands so far"
        stage.screen.editor.focus()
        await stage.pilot.press("x", "ctrl+s")
        assert stage.screen.editor.text == FAST[:19]
        answer.give()
        await until(lambda: verdict(stage) == "✗ m-1 answers: 1 problem so far", "what is wrong")
        listed = stage.screen.verdict.query_one(OptionList)
        assert "must be from -0.5 to 0.5 m/s" in str(listed.get_option_at_index(0).prompt)
        answer.give()
        await answered(stage)
        assert stage.screen.editor.text == GOOD
        assert sent(stage) == []


async def test_a_refused_answer_is_repaired_in_sight(server: ModelServer) -> None:
    second = InPieces(GOOD[:19], GOOD[19:])
    server.script = Answers(FAST, second)
    set_up(server.url)
    async with composer() as stage:
        await ask(stage)
        await until(lambda: "is asked once more" in stage.screen.line.note, "the second question")
        assert "commands[0].speed: must be from -0.5 to 0.5 m/s, not 5" in stage.screen.line.note
        second.give()
        second.give()
        await answered(stage)
        assert stage.screen.editor.text == GOOD
        assert "the second is" in stage.screen.line.note
        assert status(stage).startswith("m-1: 824 + 172 tokens")


async def test_two_invalid_answers_are_shown_and_not_sent(server: ModelServer) -> None:
    """The second one stands there with its problems; AUTO is over."""
    server.script = Answers(FAST)
    set_up(server.url)
    async with composer() as stage:
        await stage.pilot.press("alt+a")
        await ask(stage)
        await answered(stage)
        assert stage.screen.editor.text == FAST
        assert verdict(stage) == "✗ 1 problem"
        assert "nor is the second" in stage.screen.line.note
        assert not is_auto(stage)
        assert sent(stage) == []


def _closes(exchange: Exchange) -> None:
    exchange.begins()
    exchange.piece({"content": GOOD[:30]})
    raise OSError


FAULTS: dict[str, tuple[Script, str, str]] = {
    "key": (lambda one: one.fails(401), "does not take the key (401)", "key_env or key_file"),
    "model": (lambda one: one.fails(404), "does not know the model m-1", "base_url and model"),
    "busy": (lambda one: one.fails(429), "too many requests", ""),
    "server": (lambda one: one.fails(503), "the server failed (503)", ""),
    "cut": (_closes, "connection was lost in the middle", ""),
    "empty": (lambda one: one.says(""), "the answer is empty", ""),
    "html": (lambda one: one.fails(200, "<p>", "text/html"), "not the address of a model", "/v1"),
}


@pytest.mark.parametrize("kind", FAULTS)
async def test_each_failure_has_its_own_words_that_stay(kind: str, server: ModelServer) -> None:
    """The editor has its text again, AUTO is over, and nothing was sent."""
    script, words, mend = FAULTS[kind]
    set_up(server.url)
    async with composer() as stage:
        before = stage.screen.editor.text
        await ask(stage)
        await answered(stage)
        await stage.write(before)
        server.script = Answers(script)
        await stage.pilot.press("alt+a")
        assert is_auto(stage)
        await ask(stage)
        await answered(stage)
        assert words in stage.screen.line.note
        assert mend in stage.screen.line.note
        assert stage.screen.editor.text == before
        assert not stage.screen.editor.read_only
        assert not is_auto(stage)
        assert sent(stage) == []
        await stage.hear()
        assert words in stage.screen.line.note


async def test_the_budget_is_shared_with_the_nodes_and_kept(
    server: ModelServer, tmp_path: Path
) -> None:
    """What a node has noted in the run's folder counts here, and the other way round."""
    set_up(server.url, budget="{tokens_per_session: 1000}")
    ledger = tmp_path / "run" / SESSION.run_id / MODEL_USAGE
    spent = {"ended_s": 1.0, "who": "ai_brain", "input_tokens": 300, "output_tokens": 60}
    ledger.write_text(json.dumps(spent) + "\n", encoding="utf-8")
    async with composer() as stage:
        assert status(stage).endswith("360 of 1000 tokens")
        await ask(stage)
        await answered(stage)
        assert '"who": "composer"' in ledger.read_text(encoding="utf-8")
        await ask(stage)
        await answered(stage)
        assert "the budget of 1000 tokens a session is used up" in stage.screen.line.note


async def test_escape_hangs_up_and_brings_the_text_back(server: ModelServer) -> None:
    answer = InPieces(GOOD[:19], GOOD[19:])
    server.script = Answers(answer)
    set_up(server.url)
    async with composer() as stage:
        before = stage.screen.editor.text
        await ask(stage)
        await until(lambda: len(server.exchanges) == 2, "the question")
        answer.give()
        await until(lambda: stage.screen.editor.text == GOOD[:19], "the first piece")
        await stage.pilot.press("escape")
        await stage.pilot.pause()
        assert not is_asking(stage)
        assert stage.screen.editor.text == before
        await until(answer.hung_up.is_set, "the end of the connection")


async def test_auto_sends_a_valid_answer_by_itself(server: ModelServer) -> None:
    set_up(server.url)
    async with composer() as stage:
        assert "AUTO" not in shown(stage)
        await stage.pilot.press("alt+a")
        await stage.pilot.pause()
        assert " AUTO " in shown(stage)
        await ask(stage)
        await answered(stage)
        assert sent(stage) == [GOOD]
        assert is_auto(stage)
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
        await until(lambda: stage.screen.editor.text == GOOD[:19], "the first piece")
        await stage.pilot.press("ctrl+x")
        await stage.pilot.pause()
        assert not is_auto(stage)
        assert "the emergency stop has ended it" in stage.screen.line.note
        await stage.pilot.press("alt+a")
        assert not is_auto(stage)
        await stage.pilot.press("ctrl+r")
        answer.give()
        await answered(stage)
        assert stage.screen.editor.text == GOOD
        assert sent(stage) == []
        assert not is_auto(stage)


async def test_the_prompt_that_went_out_can_be_looked_at(server: ModelServer) -> None:
    """Every message with the repair, and the form; the key is nowhere, here or on any screen."""
    server.script = Answers(FAST, GOOD)
    set_up(server.url)
    async with composer() as stage:
        await stage.pilot.press("alt+p")
        await stage.pilot.pause()
        assert "Nothing has been asked" in shown(stage)
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
        assert "docs/models.md" in stage.screen.line.field.placeholder
        await ask(stage)
        assert "no language model is set up — docs/models.md" in stage.screen.line.note
        assert not is_asking(stage)
        await stage.write(GOOD)
        await stage.pilot.press("ctrl+s")
        await stage.pilot.pause()
        assert sent(stage) == [GOOD]
