"""The model that a node asks: beside the node, by the user's settings, and what that costs."""

from __future__ import annotations

import asyncio
import contextlib
import os
import threading
from collections import deque
from collections.abc import Callable, Coroutine
from concurrent.futures import Future
from typing import TYPE_CHECKING, Any, TypeVar

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from brain.budget import Ledger
from brain.faults import ModelError
from brain.key import key_of
from brain.settings import required
from nodes.parts.node import DEPTH, LessonNode
from robot.topics import BRAIN_STATE
from text.i18n import N_
from text.run_path import run_folder

if TYPE_CHECKING:
    from brain.budget import TokenUsage
    from brain.client import ModelClient
    from brain.ladder import Ladder
    from brain.settings import ModelSettings

T = TypeVar("T")
_CLOSING_S = 2.0


class AskedModel:
    """Asks one question at a time, on a thread of its own; `close` it at the node's end.

    A node's callbacks must not wait for a network. A newer question takes the place of the one under
    way, which is hung up on; what comes of it is called on the node's thread.
    """

    def __init__(self, node: LessonNode, name: Callable[[ModelSettings], str]) -> None:
        """`name` chooses which of the settings' models is asked.

        Raises:
            ModelError: if there are no settings that can be used.
        """
        settings = required()
        self.settings, self.name = settings, name(settings)
        self.key, self.who = key_of(settings), str(node.get_name())
        self.ledger = Ledger(run_folder(os.environ))
        self._results: deque[Callable[[], None]] = deque()
        self._wake = node.create_guard_condition(self._take)
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="model", daemon=True)
        self._thread.start()
        self._question: Future[Any] | None = None
        self._number = 0
        self._ladder: Ladder | None = None
        self._client: ModelClient | None = None
        # The client takes a second to import, on a Pi: not of the first answer.
        self.call(self._import)

    @property
    def busy(self) -> bool:
        """Whether a question is under way."""
        return self._question is not None

    def ask(
        self,
        question: Callable[[Ladder], Coroutine[Any, Any, T]],
        answered: Callable[[T], None],
        failed: Callable[[ModelError], None],
    ) -> None:
        """Ask in place of the question under way."""

        async def asking() -> T:
            return await question(self._made())

        self.run(asking(), answered, failed)

    def run(
        self, work: Coroutine[Any, Any, T], answered: Callable[[T], None], failed: Callable[[ModelError], None]
    ) -> None:
        """Do something else with the server, in place of the question under way."""
        self.cancel()
        number = self._number
        asked = asyncio.run_coroutine_threadsafe(work, self._loop)
        self._question = asked

        def done(future: Future[T]) -> None:
            if not future.cancelled():
                self.later(lambda: self._finish(number, future, answered, failed))

        asked.add_done_callback(done)

    def cancel(self) -> None:
        """Hang up on the question under way; nothing is called for it any more."""
        self._number += 1
        question, self._question = self._question, None
        if question is not None:
            question.cancel()

    def later(self, call: Callable[[], None]) -> None:
        """Have something called on the node's thread; from any thread."""
        self._results.append(call)
        self._wake.trigger()

    def call(self, call: Callable[[], object]) -> None:
        """Call something on the thread, between the steps of a question."""
        self._loop.call_soon_threadsafe(call)

    def begin(self, work: Coroutine[Any, Any, None]) -> None:
        """Do something on the thread beside the question under way; its end is not waited for."""
        asyncio.run_coroutine_threadsafe(work, self._loop)

    def close(self) -> None:
        """Hang up, close the connections, and end the thread."""
        self.cancel()
        if self._client is not None:
            with contextlib.suppress(Exception):
                asyncio.run_coroutine_threadsafe(self._client.close(), self._loop).result(_CLOSING_S)
        self.call(self._loop.stop)
        self._thread.join(_CLOSING_S)

    def _finish(
        self, number: int, future: Future[T], answered: Callable[[T], None], failed: Callable[[ModelError], None]
    ) -> None:
        if number != self._number:
            return
        self._question = None
        error = future.exception()
        if error is None:
            answered(future.result())
        elif isinstance(error, ModelError):
            failed(error)
        else:
            raise error

    def _take(self) -> None:
        while self._results:
            self._results.popleft()()

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


_EVERY_S = 1.0
_RULES = N_("follows its rules")
_WAITS = N_("waits for a voice; {model}")
_THINKS = N_("thinks; {model}")
_ANSWERED = N_("has answered; {model}")


class BrainState:
    """/brain_state at each change, and once a second: what the brain does, and what that takes.

    A status named after the node: OK while it thinks and answers, WARN by its rules, ERROR if a model
    that is set up gave no answer. The values are for programs; what is unknown is empty.
    """

    def __init__(self, node: LessonNode, model: AskedModel | None) -> None:
        self._node, self._model = node, model
        self._status = DiagnosticStatus(name=str(node.get_name()))
        self._usage: TokenUsage | None = None
        self._fault = ""
        self._publisher = node.create_publisher(DiagnosticArray, BRAIN_STATE, DEPTH)
        if model is None:
            self._say(DiagnosticStatus.WARN, _RULES)
        else:
            self.waits()
        node.every(_EVERY_S, self._publish)

    def waits(self) -> None:
        """Nothing is under way."""
        self._say(DiagnosticStatus.OK, _WAITS)

    def thinks(self) -> None:
        """A question is under way."""
        self._say(DiagnosticStatus.OK, _THINKS)

    def answered(self, usage: TokenUsage) -> None:
        self._usage, self._fault = usage, ""
        self._say(DiagnosticStatus.OK, _ANSWERED)

    def failed(self, error: ModelError) -> None:
        """There is no answer, and the robot stands."""
        self._fault = error.kind.value
        self._say(DiagnosticStatus.ERROR, str(error.words.template), **error.words.values)

    def _say(self, level: bytes, phrase: str, **values: object) -> None:
        name = self._model.name if self._model is not None else ""
        self._status.level = level
        self._status.message = self._node.say.text(phrase, **{"model": name, **values})
        self._publish()

    def _publish(self) -> None:
        self._status.values = [KeyValue(key=key, value=value) for key, value in self._values()]
        message = DiagnosticArray(status=[self._status])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)

    def _values(self) -> list[tuple[str, str]]:
        model, usage = self._model, self._usage
        values = [("backend", "rules" if model is None else "llm"), ("fault", self._fault)]
        if model is None:
            return values
        totals, budget = model.ledger.totals(), model.settings.budget
        values += [
            ("model", model.name),
            ("calls_last_minute", str(totals.calls_last_minute)),
            ("calls_per_minute", str(budget.calls_per_minute)),
            ("tokens", str(totals.tokens)),
            ("tokens_per_session", str(budget.tokens_per_session)),
        ]
        if usage is not None:
            prices = model.settings.prices
            cost = usage.cost(prices)
            values += [
                ("input_tokens", str(usage.input_tokens)),
                ("output_tokens", str(usage.output_tokens)),
                ("first_token_s", f"{usage.first_token_s:.3f}"),
                ("total_s", f"{usage.total_s:.3f}"),
                ("cost", "" if cost is None else f"{cost:.6f}"),
                ("currency", "" if prices is None else prices.currency),
            ]
        return values
