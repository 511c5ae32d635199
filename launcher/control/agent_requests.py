"""The requests of agents, and of the screens that answer them; every field is checked."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Any, TypeVar

from launcher.consent import Approval, ConsentAnswer
from launcher.control.bad_request import BadRequestError
from launcher.control.protocol import encode
from launcher.status import Severity
from text.packing import unpack_text
from text.plain import plain
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable

    from launcher.control.consent import ConsentDesk

AGENT_OPS = frozenset({"attend", "answer", "end_consent", "join", "ask", "withdraw", "tell"})
MAX_AGENT_CHARS = 80
"""Longest name of an agent."""
MAX_QUESTION_LINES = 6
MAX_QUESTION_BYTES = 4000
"""Most bytes of a sentence of a question, or of a line for the log, packed."""

Choice = TypeVar("Choice", bound=Enum)


async def serve_agents(
    consent: ConsentDesk, client: Hashable, request: dict[str, Any], tell: Callable[[Severity, str], None]
) -> object:
    """Serve one of `AGENT_OPS`; `tell` adds a line to the log.

    Raises:
        BadRequestError: if it is invalid.
        TooManyError: if there are too many agents or questions.
    """
    op = request["op"]
    if op == "attend":
        if consent.knows(client):
            raise BadRequestError(say("an agent cannot answer its own questions"))
        consent.attend(client)
    elif op == "answer":
        _check_attends(consent, client)
        return consent.answer(*_given_answer(request))
    elif op == "end_consent":
        consent.end_all()
    elif op == "join":
        if consent.attends(client):
            raise BadRequestError(say("an agent cannot answer its own questions"))
        consent.join(client, _key(request), _agent_name(request), _approval(request))
    elif op == "ask":
        anew = request.get("anew") is True
        if not consent.knows(client, _key(request)):
            raise BadRequestError(say("an agent has to join before it asks"))
        return (await consent.ask(client, _key(request), _lines(request), anew=anew)).value
    elif op == "withdraw":
        consent.withdraw(client, None if request.get("key") is None else _key(request))
    else:
        tell(*_line_for_log(request))
    return None


def _check_attends(consent: ConsentDesk, client: Hashable) -> None:
    if not consent.attends(client):
        raise BadRequestError(say("only a screen that attends to agents may answer them"))


def _given_answer(request: dict[str, Any]) -> tuple[int, ConsentAnswer]:
    number = request.get("question")
    if not isinstance(number, int):
        raise BadRequestError(say("question: expected a number, found {x!r}", x=number))
    return number, _one_of(ConsentAnswer, request, "answer")


def _approval(request: dict[str, Any]) -> Approval:
    return _one_of(Approval, request, "approval")


def _one_of(choices: type[Choice], request: dict[str, Any], field: str) -> Choice:
    try:
        return choices(request.get(field))
    except ValueError:
        known = ", ".join(str(choice.value) for choice in choices)
        words = say("{field}: expected one of {known}, found {x!r}", field=field, known=known, x=request.get(field))
        raise BadRequestError(words) from None


def _key(request: dict[str, Any]) -> str:
    return _short(request, "key")


def _agent_name(request: dict[str, Any]) -> str:
    return plain(_short(request, "name"))


def _short(request: dict[str, Any], field: str) -> str:
    text = request.get(field)
    if not isinstance(text, str) or len(text) > MAX_AGENT_CHARS:
        raise BadRequestError(say("{field}: expected a short text", field=field))
    return text


def _lines(request: dict[str, Any]) -> tuple[str, ...]:
    packed = request.get("lines")
    if not isinstance(packed, list) or not 0 < len(packed) <= MAX_QUESTION_LINES:
        raise BadRequestError(say("lines: expected a short list of sentences"))
    return tuple(_sentence(line) for line in packed)


def _line_for_log(request: dict[str, Any]) -> tuple[Severity, str]:
    return _one_of(Severity, request, "severity"), _sentence(request.get("words"))


def _sentence(packed: object) -> str:
    """Return a sentence that `pack_text` was given, if it is not too long."""
    try:
        if packed and len(encode({"": packed})) <= MAX_QUESTION_BYTES:
            return unpack_text(packed)
    except (TypeError, ValueError, AttributeError):
        pass
    raise BadRequestError(say("expected a sentence of at most {n} bytes", n=MAX_QUESTION_BYTES))
