"""Deck's own goals: any number at once, each followed to its end, none blocking."""

from __future__ import annotations

import itertools
import time
import uuid
from typing import TYPE_CHECKING

from graph.calls.action_client import PolledActionClient
from graph.calls.goal_life import GoalLife
from graph.data import Goal, GoalStatus
from graph.messages.fields import to_tree
from graph.messages.making import draft
from graph.messages.types import UnknownTypeError
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping
    from concurrent.futures import Future

    from rclpy.node import Node

    from graph.data import ActionRow, Value

LEAVE_WITHIN_S = 1.5
"""How long a stopping observer waits for servers to agree to cancel."""
LOOK_S = 0.01


class GoalError(Exception):
    """The goal cannot be sent; str() says why, `words` says it in translatable form."""

    def __init__(self, words: str) -> None:
        """Store the reason, made by `text.sentences.say`."""
        super().__init__(words)
        self.words = words


class Goals:
    """All goals that have been sent, until they are forgotten."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._numbers = itertools.count(1)
        self._lives: dict[int, GoalLife] = {}
        self._clients: dict[tuple[str, str], PolledActionClient] = {}
        self._sent: set[bytes] = set()
        """Ids of all goals, forgotten ones included."""

    @property
    def under_way(self) -> bool:
        """Whether any goal has not ended."""
        return any(not life.told.ended for life in self._lives.values())

    def number_from(self, first: int) -> None:
        """Count those to come from this number on."""
        self._numbers = itertools.count(first)

    def send(
        self, action: str, type_name: str, goal: Mapping[str, Value], known: ActionRow | None, future: Future[int]
    ) -> None:
        """Send a goal as soon as there is a server; the future gets its number at once.

        `known` is what the graph knows of the action. Raises GoalError, UnknownTypeError or
        FieldError.
        """
        if known and known.servers and type_name not in known.type_names:
            types = ", ".join(known.type_names)
            raise GoalError(say("{name} is a {types}, not a {type}", name=action, types=types, type=type_name))
        client = self._client(action, type_name)
        try:
            message = draft(client.type.Goal, goal)
        except Exception:
            self._close_clients()
            raise
        number, goal_id = next(self._numbers), uuid.uuid4()
        fields = to_tree(message.dated())
        told = Goal(number, action, type_name, GoalStatus.SENDING, fields, goal_id=goal_id.hex)
        self._lives[number] = GoalLife(told, goal_id.bytes, message, client)
        self._sent.add(goal_id.bytes)
        future.set_result(number)

    def has_sent(self, goal_id: bytes) -> bool:
        """Whether this goal is one of Deck's own."""
        return goal_id in self._sent

    def cancel(self, number: int) -> None:
        """Cancel a goal; one that has ended or is unknown is left as it is."""
        if number in self._lives:
            self._lives[number].cancel()

    def forget(self, number: int) -> None:
        """Stop reporting a goal; one that has not ended is cancelled."""
        life = self._lives.get(number)
        if life is not None:
            life.is_forgotten = True
            if not life.told.ended:
                life.cancel()

    def step(self) -> bool:
        """Take what has arrived, send what is due; return whether an answer is due any moment."""
        if not self._lives:
            return False
        for client in list(self._clients.values()):
            _go_on(client, [life for life in self._lives.values() if life.client is client])
        for number, life in list(self._lives.items()):
            if life.is_forgotten and life.is_settled:
                del self._lives[number]
        self._close_clients()
        return any(life.is_urgent for life in self._lives.values())

    def rows(self) -> tuple[Goal, ...]:
        """Return all goals except forgotten ones, oldest first."""
        return tuple(life.snapshot() for life in self._lives.values() if not life.is_forgotten)

    def cancel_all(self) -> None:
        """Cancel all goals that may still be pursued."""
        for life in self._lives.values():
            if life.may_drive:
                life.cancel()

    def close(self) -> None:
        """Cancel all goals, within a time limit: no robot must drive on with nobody in charge."""
        self.cancel_all()
        until_s = time.monotonic() + LEAVE_WITHIN_S
        while self.step() and time.monotonic() < until_s:
            time.sleep(LOOK_S)
        for life in self._lives.values():
            life.cancel_blindly()
        self._lives.clear()
        self._close_clients()

    def _client(self, action: str, type_name: str) -> PolledActionClient:
        key = (action, type_name)
        if key not in self._clients:
            try:
                self._clients[key] = PolledActionClient(self._node, action, type_name)
            except UnknownTypeError:
                raise
            except Exception as error:
                words = say("{name} cannot be sent a goal: {error}", name=action, error=str(error))
                raise GoalError(words) from error
        return self._clients[key]

    def _close_clients(self) -> None:
        used = {id(life.client) for life in self._lives.values()}
        for key, client in list(self._clients.items()):
            if id(client) not in used:
                client.close()
                del self._clients[key]


def _go_on(client: PolledActionClient, lives: list[GoalLife]) -> None:
    going = lives
    try:
        heard = client.take()
        for life in lives:
            going = [life]
            life.hear(heard)
            life.act()
    except Exception as error:  # noqa: BLE001 - one odd server must not end the other goals
        for life in going:
            life.fail(str(error))
