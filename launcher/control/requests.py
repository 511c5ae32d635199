"""The requests of clients: methods of their names, whose arguments are checked by their types."""

from __future__ import annotations

import inspect
from collections.abc import Awaitable, Callable, Hashable, Mapping
from typing import Any, TypeVar

from launcher.wire import unpack
from text.sentences import say

F = TypeVar("F", bound=Callable[..., Any])

_MARK = "is_request"


class BadRequestError(Exception):
    """A client's request is refused; the text says why."""

    def __init__(self, words: str, kind: str = "bad_request") -> None:
        """`kind` is for clients."""
        super().__init__(words)
        self.kind = kind


def request(function: F) -> F:
    """Mark the method that serves the requests of its name; a `client` that it takes is who asks."""
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
    result = serves(**_arguments(serves, client, message))
    return await result if isinstance(result, Awaitable) else result


def _arguments(serves: Callable[..., Any], client: Hashable, message: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments of a request, each of the type that what serves it says."""
    wanted = dict(inspect.signature(serves, eval_str=True).parameters)
    arguments = {} if wanted.pop("client", None) is None else {"client": client}
    for name in message.keys() - {"id", "op", *wanted}:
        raise BadRequestError(say("{field}: {reason}", field=name, reason="unexpected"))
    for each in wanted.values():
        if each.name in message:
            try:
                arguments[each.name] = unpack(each.annotation, message[each.name])
            except ValueError as error:
                raise BadRequestError(say("{field}: {reason}", field=each.name, reason=str(error))) from error
        elif each.default is each.empty:
            raise BadRequestError(say("{field}: {reason}", field=each.name, reason="missing"))
    return arguments
