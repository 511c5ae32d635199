"""The model that a node asks: made from the user's settings, with its prompt, memory and ledger."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from brain.budget import Ledger
from brain.faults import ModelError
from brain.key import key_of
from brain.settings import required
from nodes.thinking.background import Background
from text.run_path import run_folder

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine
    from typing import Any, TypeVar

    from brain.client import ModelClient
    from brain.ladder import Ladder
    from brain.settings import ModelSettings
    from nodes.parts.node import LessonNode

    T = TypeVar("T")


class AskedModel:
    """Asks one question at a time; `close` it at the node's end."""

    def __init__(self, node: LessonNode, name: Callable[[ModelSettings], str]) -> None:
        """`name` chooses which of the settings' models is asked.

        Raises:
            ModelError: if there are no settings that can be used.
        """
        settings = required()
        self.settings, self.name = settings, name(settings)
        self.key, self.who = key_of(settings), str(node.get_name())
        self.ledger = Ledger(run_folder(os.environ))
        self.background = Background(node)
        """Its thread."""
        self._ladder: Ladder | None = None
        self._client: ModelClient | None = None
        # The client takes a second to import, on a Pi: not of the first answer.
        self.background.call(self._import)

    @property
    def busy(self) -> bool:
        """Whether a question is under way."""
        return self.background.busy

    def ask(
        self,
        question: Callable[[Ladder], Coroutine[Any, Any, T]],
        answered: Callable[[T], None],
        failed: Callable[[ModelError], None],
    ) -> None:
        """Ask in place of the question under way; the outcome comes on the node's thread."""

        async def asking() -> T:
            return await question(self._made())

        self.run(asking(), answered, failed)

    def run(
        self, work: Coroutine[Any, Any, T], answered: Callable[[T], None], failed: Callable[[ModelError], None]
    ) -> None:
        """Do something else with the server, in place of the question under way."""

        def broken(error: Exception) -> None:
            if not isinstance(error, ModelError):
                raise error
            failed(error)

        self.background.ask(work, answered, broken)

    def later(self, call: Callable[[], None]) -> None:
        """Have something called on the node's thread, from that of a question."""
        self.background.post(call)

    def cancel(self) -> None:
        """Hang up on the question under way."""
        self.background.cancel()

    def close(self) -> None:
        self.background.close(self._client.close() if self._client is not None else None)

    def _made(self) -> Ladder:
        if self._ladder is None:
            client_type, ladder_type = self._import()
            self._client = client_type(self.settings, self.key, self.ledger, self.who)
            self._ladder = ladder_type(self._client, self.name)
        return self._ladder

    @staticmethod
    def _import() -> tuple[type[ModelClient], type[Ladder]]:
        import openai  # noqa: F401 - what the client would import with its first request

        from brain.client import ModelClient
        from brain.ladder import Ladder

        return ModelClient, Ladder
