"""The user's models, asked for commands to the robot: what the Composer does with words.

The settings are read again for each question, so that an edited file counts at once.
"""

from __future__ import annotations

import asyncio
from importlib import import_module
from typing import TYPE_CHECKING

from brain.budget import Ledger
from brain.key import key_of
from brain.settings import required
from robot.commands.schema import LlmResponse, parse_llm

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from brain.client import Message, ModelClient, ModelRequest
    from brain.key import ServerKey
    from brain.ladder import Ladder
    from brain.settings import ModelSettings
    from brain.thinking import Thought


class AskedModels:
    """Asks by the current settings, one question after the other; `close` it at the end."""

    def __init__(self, who: str, folder: Path | None = None) -> None:
        """`who` stands in the ledger, which is kept in the run's `folder`, or in memory."""
        self._who = who
        self.ledger = Ledger(folder)
        self._client: ModelClient | None = None
        self._key: ServerKey | None = None
        self._ladders: dict[str, Ladder] = {}

    @property
    def went_out(self) -> ModelRequest | None:
        """The last request that was sent, None before the first."""
        return None if self._client is None else self._client.went_out

    def hidden_in(self, text: str) -> str:
        """Return a text without the key."""
        return text if self._key is None else self._key.hidden_in(text)

    @staticmethod
    def settings() -> ModelSettings:
        """Return the settings as they are now.

        Raises:
            ModelError: if there are none, or they cannot be used.
        """
        return required()

    async def ask(
        self,
        model: str,
        messages: Sequence[Message],
        on_text: Callable[[str], None] = lambda _: None,
        on_repair: Callable[[str], None] = lambda _: None,
    ) -> Thought[LlmResponse]:
        """Return a valid answer of this model; the callbacks are those of `brain.thinking.think`.

        Raises:
            ModelError: if there is none. Cancelling hangs up.
        """
        # Half a second on a PC, two on a Pi: not on the thread that draws.
        await asyncio.to_thread(import_module, "openai")
        from brain.thinking import think

        ladder = await self._ladder(model)
        schema = LlmResponse.model_json_schema()
        return await think(ladder, schema, messages, parse_llm, on_text, on_repair)

    async def close(self) -> None:
        client, self._client = self._client, None
        self._ladders.clear()
        if client is not None:
            await client.close()

    async def _ladder(self, model: str) -> Ladder:
        from brain.client import ModelClient
        from brain.ladder import Ladder

        settings = self.settings()
        key = key_of(settings)
        before = self._client
        if before is None or self._key is None or before.settings != settings or key != self._key:
            await self.close()
            self._key = key
            self._client = before = ModelClient(settings, key, self.ledger, self._who)
        if model not in self._ladders:
            self._ladders[model] = Ladder(before, model)
        return self._ladders[model]
