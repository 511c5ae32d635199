"""The requests of clients: methods of their names, whose arguments are checked by their types.

Those of agents, and of the screens that answer them, are here as well.
"""

from __future__ import annotations

import inspect
from collections.abc import Awaitable, Callable, Hashable, Mapping
from typing import Annotated, Any, TypeVar

from launcher.consent import Approval, ConsentAnswer
from launcher.control.consent import ConsentDesk
from launcher.status import Severity
from launcher.wire import encode, unpack
from text.packing import unpack_text
from text.plain import plain
from text.sentences import say

F = TypeVar("F", bound=Callable[..., Any])

_MARK = "is_request"
MAX_QUESTION_LINES = 6
MAX_SENTENCE_BYTES = 4000
"""Most bytes of a sentence of a question, or of a line for the log, packed."""
LONGEST_NAME = 80


class BadRequestError(Exception):
    """A client's request is invalid; the text says why."""


def request(function: F) -> F:
    """Mark the method that serves the requests of its name; it is given the client that asks, too."""
    setattr(function, _MARK, True)
    return function


def requests_of(*servers: object) -> dict[str, Callable[..., Any]]:
    """Return the methods that are marked so, by name."""
    return {
        name: getattr(server, name)
        for server in servers
        for name, method in vars(type(server)).items()
        if hasattr(method, _MARK)
    }


async def serve(requests: Mapping[str, Callable[..., Any]], client: Hashable, message: Mapping[str, Any]) -> object:
    """Call what serves a request; return its result.

    Raises:
        BadRequestError: if there is no such request, or its arguments are wrong.
    """
    op = message.get("op")
    serves = requests.get(op) if isinstance(op, str) else None
    if serves is None:
        raise BadRequestError(say("unknown request {op!r}", op=op))
    result = serves(client, **_arguments(serves, message))
    return await result if isinstance(result, Awaitable) else result


def _arguments(serves: Callable[..., Any], message: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments of a request, each of the type that what serves it says."""
    _client, *wanted = inspect.signature(serves, eval_str=True).parameters.values()
    unknown = message.keys() - {"id", "op", *(each.name for each in wanted)}
    arguments = {}
    for name in unknown:
        raise BadRequestError(say("{field}: {reason}", field=name, reason="unexpected"))
    for each in wanted:
        if each.name in message:
            try:
                arguments[each.name] = unpack(each.annotation, message[each.name])
            except ValueError as error:
                raise BadRequestError(say("{field}: {reason}", field=each.name, reason=str(error))) from error
        elif each.default is each.empty:
            raise BadRequestError(say("{field}: {reason}", field=each.name, reason="missing"))
    return arguments


def _bounded(packed: object) -> object:
    if not packed or len(encode({"": packed})) > MAX_SENTENCE_BYTES:
        raise ValueError(f"expected a sentence of at most {MAX_SENTENCE_BYTES} bytes")
    return packed


def _short(name: object) -> object:
    if isinstance(name, str) and len(name) > LONGEST_NAME:
        raise ValueError(f"expected at most {LONGEST_NAME} characters")
    return name


def _few(lines: object) -> object:
    if isinstance(lines, list) and not 1 <= len(lines) <= MAX_QUESTION_LINES:
        raise ValueError(f"expected 1 to {MAX_QUESTION_LINES} lines")
    return lines


Short = Annotated[str, _short]
"""The name of an agent, or what distinguishes those of one connection."""
BoundedSentence = Annotated[str, _bounded, unpack_text]
Lines = Annotated[tuple[BoundedSentence, ...], _few]


class AgentRequests:
    """The requests of agents and of the screens that answer them."""

    def __init__(self, desk: ConsentDesk, tell: Callable[[Severity, str], None]) -> None:
        """`tell` adds a line to the log."""
        self._desk, self._tell = desk, tell

    @request
    def attend(self, client: Hashable) -> None:
        """Note that a person can answer at this screen."""
        if self._desk.knows(client):
            raise BadRequestError(say("an agent cannot answer its own questions"))
        self._desk.attend(client)

    @request
    def answer(self, client: Hashable, question: int, answer: ConsentAnswer) -> bool:
        if not self._desk.attends(client):
            raise BadRequestError(say("only a screen that attends to agents may answer them"))
        return self._desk.answer(question, answer)

    @request
    def end_consent(self, _client: Hashable) -> None:
        self._desk.end_all()

    @request
    def join(self, client: Hashable, key: Short, name: Short, approval: Approval) -> None:
        if self._desk.attends(client):
            raise BadRequestError(say("an agent cannot answer its own questions"))
        self._desk.join(client, key, plain(name), approval)

    @request
    async def ask(self, client: Hashable, key: Short, lines: Lines, anew: bool = False) -> str:
        """Ask a person; return the verdict."""
        if not self._desk.knows(client, key):
            raise BadRequestError(say("an agent has to join before it asks"))
        return (await self._desk.ask(client, key, lines, anew=anew)).value

    @request
    def withdraw(self, client: Hashable, key: Short | None = None) -> None:
        self._desk.withdraw(client, key)

    @request
    def tell(self, _client: Hashable, severity: Severity, words: BoundedSentence) -> None:
        self._tell(severity, words)
