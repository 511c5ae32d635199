"""Service calls with a time-out, any number at once, none of them waited for."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from graph.data import CallResult
from graph.making import FieldError, to_message
from graph.types import UnknownTypeError, load_service
from graph.values import to_tree

if TYPE_CHECKING:
    from collections.abc import Mapping
    from concurrent.futures import Future

    from rclpy.client import Client
    from rclpy.node import Node

    from graph.data import ServiceRow, Value


QUEUE = 10
"""Requests that a service keeps while it is busy, by default (source: rmw, the services' QoS)."""


@dataclass
class _Call:
    service: str
    client: Client
    request: Any
    future: Future[CallResult]
    started_s: float
    timeout_s: float
    sequence: int | None = None
    """Number of the request, once it is sent."""


class Calls:
    """Deck's service clients, made once and kept, and the calls that are under way."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clients: dict[tuple[str, str], Client] = {}
        self._calls: list[_Call] = []

    def begin(
        self,
        service: str,
        type_name: str,
        request: Mapping[str, Value],
        known: ServiceRow | None,
        future: Future[CallResult],
        timeout_s: float,
        started_s: float,
    ) -> None:
        """Begin a call; the future's result tells of every failure in words, it never raises.

        `known` is what the graph says of the service, `started_s` when it was asked for.
        """
        if known and type_name not in known.type_names:
            error = f"{service} is a {', '.join(known.type_names)}, not a {type_name}"
            future.set_result(_failed(service, error, started_s))
            return
        try:
            client = self._client(service, type_name)
            made = to_message(load_service(type_name).Request, request)
        except (UnknownTypeError, FieldError) as error:
            future.set_result(_failed(service, str(error), started_s))
            return
        except Exception as error:  # noqa: BLE001 - of rclpy's, a name that is none
            future.set_result(_failed(service, f"{service} cannot be called: {error}", started_s))
            return
        self._calls.append(_Call(service, client, made, future, started_s, timeout_s))
        self.step()

    def step(self) -> bool:
        """Send, take answers, give up; tell whether any call is still under way."""
        if not self._calls:
            return False
        answers = self._take_answers()
        for call in list(self._calls):
            result = self._result(call, answers)
            if result is not None:
                self._calls.remove(call)
                call.future.set_result(result)
        return bool(self._calls)

    def fail(self, error: Exception) -> None:
        """End every call that is under way."""
        while self._calls:
            call = self._calls.pop()
            call.future.set_result(_failed(call.service, str(error), call.started_s))

    def _result(self, call: _Call, answers: dict[tuple[Client, int], Any]) -> CallResult | None:
        try:
            if call.sequence is None and self._has_its_turn(call):
                with call.client.handle:
                    call.sequence = call.client.handle.send_request(call.request)
            answer = answers.get((call.client, call.sequence or 0))
            if answer is not None:
                elapsed_s = time.monotonic() - call.started_s
                return CallResult(call.service, True, to_tree(answer), "", elapsed_s)
        except Exception as error:  # noqa: BLE001 - one bad call must not end the others
            return _failed(call.service, f"{call.service} failed: {error}", call.started_s)
        if time.monotonic() - call.started_s < call.timeout_s:
            return None
        what = "nobody serves it" if call.sequence is None else "no answer"
        return _failed(
            call.service, f"{call.service}: {what} within {call.timeout_s:g} s", call.started_s
        )

    def _has_its_turn(self, call: _Call) -> bool:
        """Whether the service is there and has room: what overflows its queue gets no answer."""
        sent = sum(
            other.client is call.client and other.sequence is not None for other in self._calls
        )
        return sent < QUEUE and call.client.service_is_ready()

    def _take_answers(self) -> dict[tuple[Client, int], Any]:
        """Take all answers there are; those to calls that were given up are dropped here."""
        answers = {}
        for client in {call.client for call in self._calls}:
            with client.handle:
                while True:
                    header, response = client.handle.take_response(_response(client))
                    if header is None:
                        break
                    answers[client, header.request_id.sequence_number] = response
        return answers

    def _client(self, service: str, type_name: str) -> Client:
        key = (service, type_name)
        if key not in self._clients:
            self._clients[key] = self._node.create_client(load_service(type_name), service)
        return self._clients[key]


def _response(client: Client) -> type[Any]:
    service: Any = client.srv_type
    response: type[Any] = service.Response
    return response


def _failed(service: str, error: str, started_s: float) -> CallResult:
    return CallResult(service, False, None, error, time.monotonic() - started_s)
