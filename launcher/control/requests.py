"""The requests of clients: methods of their names, whose arguments are checked by their types.

Those of agents, and of the screens that answer them, are here as well.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Hashable, Mapping
from typing import Annotated, Any, TypeVar

from pydantic import BeforeValidator, ConfigDict, Field, ValidationError, validate_call

from launcher.consent import Approval, ConsentAnswer
from launcher.control.consent import ConsentDesk
from launcher.status import Severity
from launcher.wire import Sentence, encode
from text.plain import plain
from text.sentences import Words, say

F = TypeVar("F", bound=Callable[..., Any])

_MARK = "is_request"
_CONFIG = ConfigDict(arbitrary_types_allowed=True)
MAX_QUESTION_LINES = 6
MAX_SENTENCE_BYTES = 4000
"""Most bytes of a sentence of a question, or of a line for the log, packed."""


class BadRequestError(Exception):
    """A client's request is invalid; the text says why."""


def request(function: F) -> F:
    """Mark the method that serves the requests of its name; it is given the client that asks, too."""
    setattr(function, _MARK, True)
    return function


def requests_of(*servers: object) -> dict[str, Callable[..., Any]]:
    """Return the methods that are marked so, by name; they check their arguments."""
    return {
        name: validate_call(config=_CONFIG)(getattr(server, name))
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
    try:
        result = serves(client, **{name: value for name, value in message.items() if name not in ("id", "op")})
        return await result if isinstance(result, Awaitable) else result
    except ValidationError as error:
        raise BadRequestError(_first(error)) from error


def _first(error: ValidationError) -> Words:
    first = error.errors(include_url=False)[0]
    return say("{field}: {reason}", field=".".join(map(str, first["loc"])), reason=first["msg"])


def _bounded(packed: object) -> object:
    if not packed or len(encode({"": packed})) > MAX_SENTENCE_BYTES:
        raise ValueError(f"expected a sentence of at most {MAX_SENTENCE_BYTES} bytes")
    return packed


Short = Annotated[str, Field(max_length=80)]
"""The name of an agent, or what distinguishes those of one connection."""
BoundedSentence = Annotated[Sentence, BeforeValidator(_bounded)]
Lines = Annotated[tuple[BoundedSentence, ...], Field(min_length=1, max_length=MAX_QUESTION_LINES)]


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
