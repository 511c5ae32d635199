"""`deck doctor llm`: one question to the language model, and how it takes a form of an answer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from brain.budget import Ledger
from brain.faults import ModelError
from brain.key import key_of
from brain.settings import KEY_VARIABLE, ModelSettings, required
from brain.situation import Memory, Situation, conversation
from brain.thinking import think
from cli.doctor.finding import Finding, fail, ok
from launcher.processes.interrupts import run
from robot.commands.schema import SpokenResponse, parse_llm
from text.i18n import _, decimal, localized

if TYPE_CHECKING:
    from brain.client import ModelClient

_PROMPT = "You are a robot that is being tested. Stand still: give no commands, and say hello."


def try_model() -> list[Finding]:
    """Return what came of asking the model that is set up.

    Raises:
        ModelError: if none is, or the settings cannot be used.
    """
    settings = required()
    # Needs what is only there with the extra.
    from brain.client import ModelClient

    key = key_of(settings)
    source = settings.key_env or settings.key_file or KEY_VARIABLE
    told = _("from {source}").format(source=source) if key else _("none needed, none sent")
    found = [
        ok("llm.server", _("{model} at {url}").format(model=settings.model, url=settings.base_url)),
        ok("llm.key", _("key: {source}").format(source=told)),
    ]
    ledger = Ledger()
    client = ModelClient(settings, key, ledger, "doctor")
    try:
        found += run(_ask(client, settings))
    except ModelError as error:
        found.append(fail("llm.answer", localized(error.words), localized(error.fix)))
    totals = ledger.totals()
    words = _("{calls} requests, {tokens} tokens").format(calls=totals.calls, tokens=totals.tokens)
    return [*found, ok("llm.usage", words)]


async def _ask(client: ModelClient, settings: ModelSettings) -> list[Finding]:
    from brain.ladder import Ladder

    async with client:
        ladder = Ladder(client, settings.model)
        ladder.forget()
        rung = await ladder.rung()
        form = ok("llm.form", _("answers as {form}").format(form=rung.value))
        messages = conversation(_PROMPT, Memory(), Situation("hello"))
        schema = SpokenResponse.model_json_schema()
        thought = await think(ladder, schema, messages, lambda text: parse_llm(text, SpokenResponse))
    usage = thought.usages[-1]
    text = _("the answer of a test came whole: first token after {first} s, all of it after {total} s")
    first, total = (decimal(f"{seconds:.2f}") for seconds in (usage.first_token_s, usage.total_s))
    return [form, ok("llm.answer", text.format(first=first, total=total))]
