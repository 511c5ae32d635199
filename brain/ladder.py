"""How a server gives answers in a form: found out once for each server and model.

Servers take a schema by different fields of the request, and some take it, say 200 and ignore it.
So two ways are tried, one after the other, with a form that nobody can guess: `json_schema`, strict,
and the call of a tool whose parameters are the schema.

https://platform.openai.com/docs/guides/structured-outputs
"""

from __future__ import annotations

import contextlib
import json
import os
import secrets
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Any

from platformdirs import user_cache_path

from brain.client import Answer, Message, ModelRequest
from brain.faults import FaultKind, ModelError
from robot.commands.wrapping import read_answer
from text.nested import read_json
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from brain.client import ModelClient

FILE = "llm-forms.json"
NAME = "answer"
"""Of the schema, and of the tool."""


class Rung(Enum):
    """A way to ask for a form."""

    STRICT = "json_schema, strict"
    TOOL = "tool call"


def request_for(rung: Rung, schema: Mapping[str, Any], messages: Sequence[Message], model: str) -> ModelRequest:
    """Return the request for an answer that obeys a JSON schema."""
    if rung is Rung.STRICT:
        named = {"name": NAME, "schema": schema, "strict": True}
        return ModelRequest(messages, model, {"response_format": {"type": "json_schema", "json_schema": named}})
    tool = {"name": NAME, "description": "Gives the answer.", "parameters": schema}
    # llama.cpp takes the name of a function for `auto`; there is only one anyway.
    form = {"tools": [{"type": "function", "function": tool}], "tool_choice": "required"}
    return ModelRequest(messages, model, form)


class Ladder:
    """Asks in the way that this server and model obey."""

    def __init__(self, client: ModelClient, model: str, folder: Path | None = None) -> None:
        """`folder` keeps what was found out, by default the user's cache."""
        self._client, self._model = client, model
        self._path = (folder or user_cache_path("deck")) / FILE
        self._rung: Rung | None = None

    async def ask(
        self, schema: Mapping[str, Any], messages: Sequence[Message], on_text: Callable[[str], None] = lambda _: None
    ) -> Answer:
        """Return an answer that was asked for in a form; whoever asked checks whether it has it.

        Raises:
            ModelError: if there is none.
        """
        rung = await self.rung()
        try:
            return await self._client.ask(request_for(rung, schema, messages, self._model), on_text)
        except ModelError as fault:
            if fault.kind is FaultKind.REQUEST:
                # Another version of the server, perhaps: found out anew the next time.
                self.forget()
            raise

    async def rung(self) -> Rung:
        """Return the way, which may take two requests the first time.

        Raises:
            ModelError: if the server obeys none, or does not answer.
        """
        if self._rung is None:
            self._rung = self._remembered() or await self._found_out()
            self._remember(self._rung)
        return self._rung

    def forget(self) -> None:
        """Find out again at the next question."""
        self._rung = None
        self._remember(None)

    async def _found_out(self) -> Rung:
        faults: list[ModelError] = []
        for rung in Rung:
            try:
                if await self._obeyed(rung):
                    return rung
            except ModelError as fault:  # noqa: PERF203 - twice at most
                if fault.kind not in _OF_THIS_WAY:
                    raise
                faults.append(fault)
        if len(faults) == len(Rung):
            # It has not answered anything at all: the reason is not the form.
            raise faults[-1]
        words = say("{model} gives no answers in the form that is asked for", model=self._model)
        raise ModelError(FaultKind.SHAPE, words, say("docs/models.md names models that do"))

    async def _obeyed(self, rung: Rung) -> bool:
        """Try a way by a word that only the schema holds."""
        word, number = f"deck-{secrets.token_hex(3)}", secrets.randbelow(900) + 100
        schema = {
            "type": "object",
            "properties": {
                "word": {"type": "string", "enum": [word]},
                "number": {"type": "integer", "enum": [number]},
            },
            "required": ["word", "number"],
            "additionalProperties": False,
        }
        messages = [
            {"role": "system", "content": "You answer in JSON, in the form that you are given."},
            {"role": "user", "content": "Fill in the form."},
        ]
        answer = await self._client.ask(request_for(rung, schema, messages, self._model))
        try:
            found = read_answer(answer.text).value
        except ValueError:
            return False
        return bool(found == {"word": word, "number": number})

    # ---------------------------------------------------------------- what was found out

    def _remembered(self) -> Rung | None:
        with contextlib.suppress(OSError, ValueError, KeyError, TypeError, AttributeError):
            return Rung(read_json(self._path.read_text(encoding="utf-8"))[self._name])
        return None

    def _remember(self, rung: Rung | None) -> None:
        """Write it down; without a cache it is found out by every process."""
        with contextlib.suppress(OSError):
            try:
                known = read_json(self._path.read_text(encoding="utf-8"))
            except (OSError, ValueError):
                known = {}
            known = dict(known) if isinstance(known, dict) else {}
            if known.get(self._name) == (rung and rung.value):
                return
            known[self._name] = rung and rung.value
            self._path.parent.mkdir(parents=True, exist_ok=True)
            beside = self._path.with_suffix(f".{os.getpid()}.new")
            beside.write_text(json.dumps(known, indent=2) + "\n", encoding="utf-8")
            beside.replace(self._path)

    @property
    def _name(self) -> str:
        return f"{self._client.settings.base_url} {self._model}"


_OF_THIS_WAY = (FaultKind.REQUEST, FaultKind.EMPTY, FaultKind.REFUSAL, FaultKind.TOO_LONG, FaultKind.SERVER)
"""After these the next way may still work; after a wrong key, none does."""
