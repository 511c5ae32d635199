"""Service calls with a time-out, any number at once, none of them blocking."""

from __future__ import annotations

import time
from concurrent.futures import Future
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from graph.data import CallResult
from graph.messages.fields import to_tree
from graph.messages.making import FieldError, draft
from graph.messages.types import UnknownTypeError, load_service
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Container, Mapping

    from rclpy.client import Client
    from rclpy.node import Node

    from graph.data import ServiceRow, Value
    from graph.messages.making import Draft


KEPT = 32
"""Looking at the parameters of a hundred nodes must not leave three hundred clients behind."""
SETTLE_S = 0.1
"""A service is discovered here before it discovers the client; until then its answers are lost."""


class Clients:
    """Clients by service and type, the most recently used one last."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clients: dict[tuple[str, str], Client] = {}
        self._ready_since_s: dict[Client, float] = {}

    def get(self, service: str, type_name: str, busy: Container[Client]) -> Client:
        """Return the client; may close others that are not `busy`.

        Raises UnknownTypeError, and what rclpy raises for an invalid name.
        """
        key = (service, type_name)
        client = self._clients.pop(key, None)
        if client is None:
            client = self._node.create_client(load_service(type_name), service)
            self._close_some(busy)
            # Its time starts now, although the first request may come later.
            self.is_ready(client)
        self._clients[key] = client
        return client

    def is_ready(self, client: Client) -> bool:
        """Tell whether a request would be received, and its answer too."""
        if not client.service_is_ready():
            self._ready_since_s.pop(client, None)
            return False
        now_s = time.monotonic()
        return now_s - self._ready_since_s.setdefault(client, now_s) >= SETTLE_S

    def _close_some(self, busy: Container[Client]) -> None:
        idle = [key for key, client in self._clients.items() if client not in busy]
        for key in idle[: max(0, len(self._clients) - KEPT)]:
            client = self._clients.pop(key)
            self._ready_since_s.pop(client, None)
            self._node.destroy_client(client)


QUEUE = 10
"""Requests that a busy service queues by default (source: rmw, the services' QoS)."""
GONE_AFTER_S = 0.5
"""A last answer may come a little after its service has left the graph."""
LATE_KEPT = 20
"""Timed-out calls whose answer would still be taken; their clients are kept, too."""


@dataclass
class _Call:
    service: str
    client: Client
    request: Draft
    future: Future[CallResult]
    started_s: float
    timeout_s: float
    sequence: int | None = None
    """Number of the request, once sent."""
    served_s: float = 0.0
    """When its service was last seen, once sent."""
    is_late: bool = False
    """Whether it has timed out; `future` is then the one for a late answer."""


class Calls:
    """The calls that are under way."""

    def __init__(self, node: Node) -> None:
        self._clients = Clients(node)
        self._calls: list[_Call] = []

    def begin(
        self,
        service: str,
        type_name: str,
        request: Mapping[str, Value],
        known: ServiceRow | None,
        future: Future[CallResult],
        timeout_s: float,
    ) -> None:
        """Begin a call; the future's result reports every failure in words, it never raises.

        `known` is what the graph knows of the service. A call without an answer within `timeout_s` is reported as
        failed, but still listened for.
        """
        started_s = time.monotonic()
        if known and type_name not in known.type_names:
            types = ", ".join(known.type_names)
            words = say("{name} is a {types}, not a {type}", name=service, types=types, type=type_name)
            future.set_result(_failed(service, words, started_s))
            return
        try:
            client = self.prepare(service, type_name)
            made = draft(load_service(type_name).Request, request)
        except UnknownTypeError as error:
            future.set_result(_failed(service, error.words, started_s))
            return
        except FieldError as error:
            words = say("{field}: {message}", field=error.field, message=error.message)
            future.set_result(_failed(service, words if error.field else error.message, started_s))
            return
        except Exception as error:  # noqa: BLE001 - rclpy's, for an invalid name
            words = say("{name} cannot be called: {error}", name=service, error=str(error))
            future.set_result(_failed(service, words, started_s))
            return
        self._calls.append(_Call(service, client, made, future, started_s, timeout_s))
        self.step()

    def prepare(self, service: str, type_name: str) -> Client:
        """Create the client now, so that its first call need not wait for it.

        Raises UnknownTypeError, and what rclpy raises for an invalid name.
        """
        return self._clients.get(service, type_name, {call.client for call in self._calls})

    def step(self) -> bool:
        """Send, take answers, give up; return whether any call still waits within its time-out."""
        if not self._calls:
            return False
        answers = self._take_answers()
        for call in list(self._calls):
            result = self._result(call, answers)
            if result is not None:
                self._calls.remove(call)
                call.future.set_result(result)
            elif not call.is_late and time.monotonic() - call.started_s >= call.timeout_s:
                self._give_up(call)
        return any(not call.is_late for call in self._calls)

    def fail(self, error: Exception) -> None:
        """End every call that is under way."""
        while self._calls:
            call = self._calls.pop()
            call.future.set_result(_failed(call.service, reason_of(error), call.started_s))

    def _result(self, call: _Call, answers: dict[tuple[Client, int], Any]) -> CallResult | None:
        try:
            if call.sequence is None and self._has_its_turn(call):
                with call.client.handle:
                    call.sequence = call.client.handle.send_request(call.request.dated())
            answer = answers.get((call.client, call.sequence or 0))
            if answer is not None:
                elapsed_s = time.monotonic() - call.started_s
                return CallResult(call.service, True, to_tree(answer), "", elapsed_s)
        except Exception as error:  # noqa: BLE001 - one bad call must not end the others
            words = say("{name} failed: {error}", name=call.service, error=str(error))
            return _failed(call.service, words, call.started_s)
        if call.sequence is not None and _has_gone(call):
            words = say("{name} has left the graph and has not answered", name=call.service)
            return _failed(call.service, words, call.started_s)
        return None

    def _give_up(self, call: _Call) -> None:
        """Report the time-out; the answer to a request that was sent is still awaited."""
        future = call.future
        if call.sequence is None:
            self._calls.remove(call)
            words = say("{name}: no server appeared within {seconds:g} s", **_facts(call))
            future.set_result(_failed(call.service, words, call.started_s))
            return
        late = [other for other in self._calls if other.is_late]
        for oldest in late[: max(0, len(late) + 1 - LATE_KEPT)]:
            self._calls.remove(oldest)
            words = say("{name}: no longer waiting for the response", name=oldest.service)
            oldest.future.set_result(_failed(oldest.service, words, oldest.started_s))
        call.is_late, call.future = True, Future()
        # A caller that stops waiting must not leave a future behind that cannot be set.
        call.future.set_running_or_notify_cancel()
        words = say("{name}: no answer within {seconds:g} s", **_facts(call))
        told = _failed(call.service, words, call.started_s)
        future.set_result(replace(told, late=call.future))

    def _has_its_turn(self, call: _Call) -> bool:
        """Whether the service exists and has room: what overflows its queue gets no answer."""
        sent = sum(
            other.client is call.client and other.sequence is not None and not other.is_late for other in self._calls
        )
        return sent < QUEUE and self._clients.is_ready(call.client)

    def _take_answers(self) -> dict[tuple[Client, int], Any]:
        """Take all answers there are; those to calls that nobody awaits are dropped here."""
        answers = {}
        for client in {call.client for call in self._calls}:
            with client.handle:
                while True:
                    header, response = client.handle.take_response(_response(client))
                    if header is None:
                        break
                    answers[client, header.request_id.sequence_number] = response
        return answers


def _response(client: Client) -> type[Any]:
    service: Any = client.srv_type
    response: type[Any] = service.Response
    return response


def _has_gone(call: _Call) -> bool:
    now_s = time.monotonic()
    if not call.served_s or call.client.service_is_ready():
        call.served_s = now_s
    return now_s - call.served_s >= GONE_AFTER_S


def _facts(call: _Call) -> dict[str, str | float]:
    return {"name": call.service, "seconds": call.timeout_s}


def _failed(service: str, error: str, started_s: float) -> CallResult:
    return CallResult(service, False, None, error, time.monotonic() - started_s)
