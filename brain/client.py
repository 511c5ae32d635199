"""One client for every server that speaks OpenAI's protocol of chat completions.

An answer is always streamed. It is asked for once: nothing is repeated behind the caller's back,
and a server that wants to be left alone (429) is, for as long as it says.
Protocol: https://platform.openai.com/docs/api-reference/chat/streaming.
"""

from __future__ import annotations

import math
import time
from collections.abc import AsyncIterator, Callable, Iterator, Mapping, Sequence
from contextlib import asynccontextmanager, contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeAlias

import anyio

from brain.budget import TokenUsage, estimated_tokens
from brain.faults import FaultKind, ModelError, cut_off
from text.sentences import say

if TYPE_CHECKING:
    import openai
    from typing_extensions import Self

    from brain.budget import Ledger
    from brain.key import ServerKey
    from brain.settings import ModelSettings

Message: TypeAlias = "dict[str, Any]"
"""`{"role": "user", "content": "..."}`; content may be a list of parts, pictures among them."""
LONGEST_TEXT = 64 * 1024
"""Characters of an answer that are read: nothing that Deck asks for is nearly as long."""
_LONGEST_ERROR = 200
_FIRST_BUSY_S = 5.0
"""How long a server is left alone that is busy and does not say for how long."""


@dataclass(frozen=True)
class ModelRequest:
    """What is asked, and in which form the answer shall come."""

    messages: Sequence[Message]
    model: str
    form: Mapping[str, Any] = field(default_factory=dict)
    """Further fields of the request: `response_format`, or `tools` with `tool_choice`."""


@dataclass(frozen=True)
class Answer:
    """A model's whole answer, and what it has cost."""

    text: str
    """What the model wrote, or the arguments of the tool that it called."""
    usage: TokenUsage


@dataclass
class _Received:
    """What has come of an answer."""

    text: list[str] = field(default_factory=list)
    arguments: list[str] = field(default_factory=list)
    refusal: list[str] = field(default_factory=list)
    length: int = 0
    finish: str = ""
    first_s: float | None = None
    tokens: tuple[int, int] | None = None

    def take(self, chunk: Any, now_s: float) -> str:  # noqa: ANN401 - a server may send anything
        """Add a piece of the stream; return what it added to the text."""
        if (usage := getattr(chunk, "usage", None)) is not None:
            self.tokens = int(usage.prompt_tokens or 0), int(usage.completion_tokens or 0)
        piece = ""
        for choice in getattr(chunk, "choices", None) or ():
            self.finish = _text(choice.finish_reason) or self.finish
            if (delta := choice.delta) is None:
                continue
            if self.first_s is None and (delta.model_fields_set - {"role"}):
                self.first_s = now_s
            self.refusal.append(_text(delta.refusal))
            piece = _text(delta.content)
            self.text.append(piece)
            for call in delta.tool_calls or ():
                # Of several calls only the first counts: one form was asked for, once.
                if call.function is not None and call.index == 0:
                    self.arguments.append(_text(call.function.arguments))
                    piece += self.arguments[-1]
            self.length += len(piece)
        return piece


class ModelClient:
    """Asks one server; close it at the end, or use it in an `async with`."""

    def __init__(self, settings: ModelSettings, key: ServerKey, ledger: Ledger, who: str) -> None:
        """`who` stands in the ledger: the node, or the part of Deck, that asks."""
        self.settings = settings
        self._key, self._ledger, self._who = key, ledger, who
        self.went_out: ModelRequest | None = None
        """The last request that was sent, as it was sent; None before the first."""
        self._made: openai.AsyncOpenAI | None = None
        self._not_before_s = 0.0

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()

    async def close(self) -> None:
        if self._made is not None:
            await self._made.close()
            self._made = None

    async def ask(self, request: ModelRequest, on_text: Callable[[str], None] = lambda _: None) -> Answer:
        """Return the answer; `on_text` gets its pieces as they come.

        Raises:
            ModelError: whatever went wrong. Cancelling closes the connection.
        """
        self._leave_alone()
        self._ledger.begin(self._who, self.settings.budget)
        self.went_out = request
        begun_s, received = time.monotonic(), _Received()
        try:
            with self._faults(received):
                # Not asyncio.wait_for, which before Python 3.12 can lose a cancellation.
                with anyio.fail_after(self.settings.timeout_s):
                    await self._receive(request, received, on_text)
        finally:
            usage = _usage(request, received, begun_s)
            self._ledger.end(self._who, usage)
        return Answer(_whole(received), usage)

    def _leave_alone(self) -> None:
        wait_s = self._not_before_s - time.monotonic()
        if wait_s > 0:
            words = say("the server wants to be left alone for another {wait:.0f} s", wait=wait_s)
            raise ModelError(FaultKind.BUSY, words, retry_after_s=wait_s)

    async def _receive(self, request: ModelRequest, received: _Received, on_text: Callable[[str], None]) -> None:
        limit_s = self.settings.first_token_s
        with anyio.move_on_after(limit_s) as beginning:
            async with self._open(request) as stream:
                async for chunk in stream:
                    if piece := _taken(received, chunk):
                        on_text(piece)
                    if received.first_s is not None:
                        beginning.deadline = math.inf
                    if received.length > LONGEST_TEXT:
                        raise ModelError(FaultKind.TOO_LONG, say("the answer has no end: cut off"))
        if beginning.cancelled_caught:
            words = say("no answer began within {limit:g} s", limit=limit_s)
            raise ModelError(FaultKind.TIMEOUT, words, say("first_token_s in llm.yaml"))

    @asynccontextmanager
    async def _open(self, request: ModelRequest) -> AsyncIterator[Any]:
        """Send the request, and give its stream once it is known to be one."""
        fields: dict[str, Any] = {
            "model": request.model,
            "messages": list(request.messages),
            "stream": True,
            "stream_options": {"include_usage": True},
            **request.form,
        }
        completions: Any = self._client().chat.completions.with_streaming_response
        async with completions.create(**fields) as response:
            kind = response.headers.get("content-type", "").split(";")[0].strip()
            if kind != "text/event-stream":
                raise _not_an_api(self.settings.base_url, kind)
            yield await response.parse()

    def _client(self) -> openai.AsyncOpenAI:
        if self._made is None:
            from brain.bounds import bounded_client

            self._made = bounded_client(self.settings, self._key)
        return self._made

    @contextmanager
    def _faults(self, received: _Received) -> Iterator[None]:
        try:
            yield
        except TimeoutError:
            words = say("no answer within {limit:g} s", limit=self.settings.timeout_s)
            raise ModelError(FaultKind.TIMEOUT, words, say("timeout_s in llm.yaml")) from None
        except ModelError:
            raise
        except Exception as error:
            from brain.client_faults import fault_of

            begun = received.first_s is not None
            fault = fault_of(error, self.settings, self._key, begun=begun)
            if fault is None:
                raise
            if fault.kind is FaultKind.BUSY:
                self._not_before_s = time.monotonic() + (fault.retry_after_s or _FIRST_BUSY_S)
            # Not `from error`: its text and its request hold what must not be shown.
            raise fault from None


def _text(value: object) -> str:
    if value is not None and not isinstance(value, str):
        raise TypeError
    return value or ""


def _taken(received: _Received, chunk: Any) -> str:  # noqa: ANN401 - a server may send anything
    """Return what a piece of the stream adds; the client checks no types, so that is done here."""
    try:
        piece = received.take(chunk, time.monotonic())
    except (AttributeError, TypeError, ValueError, OverflowError):
        words = say("what the server sent cannot be read")
        raise ModelError(FaultKind.NOT_AN_API, words) from None
    return piece


def _not_an_api(base_url: str, kind: str) -> ModelError:
    words = say("{url} is not the address of a model server: it sent {kind}", url=base_url, kind=kind or "-")
    return ModelError(FaultKind.NOT_AN_API, words, say("base_url usually ends in /v1"))


def _usage(request: ModelRequest, received: _Received, begun_s: float) -> TokenUsage:
    now_s = time.monotonic()
    counted = received.tokens is not None
    asked = sum(estimated_tokens(str(message.get("content", ""))) for message in request.messages)
    tokens = received.tokens or (asked, (received.length + 3) // 4)
    first_s = (now_s if received.first_s is None else received.first_s) - begun_s
    return TokenUsage(request.model, *tokens, first_s, now_s - begun_s, counted)


def _whole(received: _Received) -> str:
    """Return the text of an answer that is whole; raises ModelError otherwise."""
    refusal = "".join(received.refusal).strip()
    if refusal:
        words = say("the model refuses: {words}", words=refusal[:_LONGEST_ERROR])
        raise ModelError(FaultKind.REFUSAL, words)
    if received.finish == "content_filter":
        raise ModelError(FaultKind.REFUSAL, say("a filter of the server took the answer away"))
    if received.finish == "length":
        words = say("the answer is longer than the server allows: cut off")
        raise ModelError(FaultKind.TOO_LONG, words)
    if not received.finish:
        raise cut_off()
    text = "".join(received.arguments) or "".join(received.text)
    if not text.strip():
        raise ModelError(FaultKind.EMPTY, say("the answer is empty"))
    return text
