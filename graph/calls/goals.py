"""Deck's own goals: any number at once, each followed to its end by what its server says, none blocking."""

from __future__ import annotations

import itertools
import time
import uuid
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from graph.calls.action_client import PolledActionClient
from graph.data import ANSWER_WITHIN_S, Goal, GoalStatus
from graph.messages.fields import to_tree
from graph.messages.making import draft
from graph.messages.types import UnknownTypeError
from text.i18n import N_
from text.sentences import SaidError, say

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rclpy.node import Node

    from graph.calls.action_client import GoalAnswers
    from graph.data import ActionRow, Value
    from graph.messages.making import Draft


GONE_AFTER_S = 0.5
"""A server's last messages may arrive a little after it has left the graph."""
STATUS = {
    1: GoalStatus.ACCEPTED,
    2: GoalStatus.EXECUTING,
    3: GoalStatus.CANCELING,
    4: GoalStatus.SUCCEEDED,
    5: GoalStatus.CANCELED,
    6: GoalStatus.ABORTED,
}
"""Source: action_msgs/GoalStatus."""
ENDS = frozenset({GoalStatus.SUCCEEDED, GoalStatus.CANCELED, GoalStatus.ABORTED})
LOST = N_("its server has left the graph")
REFUSED = N_("the server refuses to cancel it")
NO_WORD_OF_CANCEL = N_("no answer to the request to cancel it within {seconds} s")


class GoalLife:
    """One goal. `hear` and `act` are called in turn until it `is_settled`."""

    def __init__(self, told: Goal, goal_id: bytes, message: Draft, client: PolledActionClient) -> None:
        """Start with a goal that is `SENDING`, to be sent as `message` through `client`."""
        self.told = told
        """The goal as the screen shows it, except `elapsed_s`."""
        self.client = client
        self.is_forgotten = False
        self._id = goal_id
        self._message = message
        self._began_s = time.monotonic()
        self._ended_s: float | None = None
        self._wants_cancel = False
        self._request: int | None = None
        self._request_s = 0.0
        self._accepted: bool | None = None
        self._result: int | None = None
        self._cancel: int | None = None
        self._cancel_s = 0.0
        self._over_s: float | None = None
        """When the status was first reported to be one of `ENDS`."""
        self._servers: frozenset[bytes] = frozenset()
        self._servers_seen_s = 0.0

    @property
    def is_settled(self) -> bool:
        """Whether neither side has anything more to send."""
        if not self.told.ended or self._cancel is not None:
            return False
        # A goal that Deck gave up before it was accepted would still be executed.
        awaits_answer = self._request is not None and self._accepted is None
        return not (awaits_answer and self.client.servers())

    @property
    def is_urgent(self) -> bool:
        """Whether an answer is due any moment."""
        return self._cancel is not None or (self._accepted is None and not self.told.ended)

    @property
    def may_drive(self) -> bool:
        return not self.told.ended or not self.is_settled

    def snapshot(self) -> Goal:
        until_s = self._ended_s if self._ended_s is not None else time.monotonic()
        return replace(self.told, elapsed_s=until_s - self._began_s)

    def cancel(self) -> None:
        """Have it cancelled: at once, or as soon as it has been accepted."""
        if self._result is not None or self._accepted is None:
            self._wants_cancel = True

    def hear(self, heard: GoalAnswers) -> None:
        if self._request in heard.accepted and self._accepted is None:
            self._answered(accepted=heard.accepted[self._request])
        news = heard.feedback.get(self._id)
        if news and not self.told.ended:
            count = self.told.feedback_count + len(news)
            self.told = replace(self.told, feedback=to_tree(news[-1]), feedback_count=count)
        if self._id in heard.status:
            if self._request is not None and self._accepted is None:
                # The answer itself is lost if the server has not discovered this client yet.
                self._answered(accepted=True)
            self._status(STATUS.get(heard.status[self._id]))
        if self._cancel in heard.cancelled:
            self._cancel_answered(heard.cancelled[self._cancel])
        if self._result in heard.results:
            self._take_result(heard.results[self._result])

    def act(self) -> None:
        """Send what is due, and give up requests without an answer."""
        now_s = time.monotonic()
        if self._request is None:
            self._send(now_s)
        elif self._accepted is None:
            if not self.told.ended and now_s - self._request_s >= ANSWER_WITHIN_S:
                self._wants_cancel = True
                self._end(GoalStatus.FAILED, say("no answer within {seconds} s", seconds=f"{ANSWER_WITHIN_S:g}"))
        else:
            self._ask_to_cancel(now_s)
            self._look_after_server(now_s)

    def fail(self, error: str) -> None:
        """End the goal as failed: Deck cannot continue with it."""
        self._result = self._cancel = None
        self._end(GoalStatus.FAILED, error)

    def cancel_blindly(self) -> None:
        """Ask for it to be cancelled although the server has not accepted it yet."""
        if self._request is not None and self._accepted is None:
            self.client.cancel(self._id)

    def _send(self, now_s: float) -> None:
        if self.told.ended:
            return
        if self._wants_cancel:
            self._end(GoalStatus.CANCELED, say("it was cancelled before it was sent"))
        elif self.client.is_ready:
            self._request = self.client.send(self._id, self._message.dated())
            self._request_s = now_s
        elif now_s - self._began_s >= ANSWER_WITHIN_S:
            self._end(GoalStatus.FAILED, say("no server appeared within {seconds} s", seconds=f"{ANSWER_WITHIN_S:g}"))

    def _answered(self, *, accepted: bool) -> None:
        self._accepted = accepted
        if not accepted:
            if not self.told.ended:
                self._end(GoalStatus.REJECTED, say("the server rejected it"))
            return
        self._servers = self.client.servers()
        self._servers_seen_s = time.monotonic()
        self._result = self.client.ask_result(self._id)
        if not self.told.ended:
            self.told = replace(self.told, status=GoalStatus.ACCEPTED)
        self._ask_to_cancel(time.monotonic())

    def _status(self, status: GoalStatus | None) -> None:
        if status in ENDS:
            # The result says the same, and more.
            self._over_s = self._over_s or time.monotonic()
        elif status is not None and not self.told.ended and self._accepted:
            self.told = replace(self.told, status=status)

    def _ask_to_cancel(self, now_s: float) -> None:
        if self._cancel is not None and now_s - self._cancel_s >= ANSWER_WITHIN_S:
            self._cancel = None
            word = say(NO_WORD_OF_CANCEL, seconds=f"{ANSWER_WITHIN_S:g}")
            self.told = replace(self.told, error=word) if not self.told.ended else self.told
        if self._wants_cancel and self._accepted:
            self._wants_cancel = False
            self._cancel = self.client.cancel(self._id)
            self._cancel_s = now_s

    def _cancel_answered(self, agreed: bool) -> None:
        self._cancel = None
        if not agreed and not self.told.ended:
            self.told = replace(self.told, error=say(REFUSED))

    def _take_result(self, response: Any) -> None:  # noqa: ANN401 - generated
        self._result = self._cancel = None
        self._wants_cancel = False
        status = STATUS.get(response.status)
        if status not in ENDS:
            self._end(GoalStatus.FAILED, say("the server does not know it"))
            return
        result = to_tree(response.result)
        self._end(status, _reason(result) if status == GoalStatus.ABORTED else "")
        self.told = replace(self.told, result=result)

    def _look_after_server(self, now_s: float) -> None:
        if self.told.ended:
            return
        servers = self.client.servers()
        self._servers = self._servers or servers
        if self._servers & servers:
            self._servers_seen_s = now_s
        elif now_s - self._servers_seen_s >= GONE_AFTER_S:
            self._cancel = None
            self._end(GoalStatus.FAILED, say(LOST))
        if self._over_s is not None and now_s - self._over_s >= ANSWER_WITHIN_S:
            self._end(GoalStatus.FAILED, say("it has ended, but its result has not arrived"))

    def _end(self, status: GoalStatus, error: str) -> None:
        self._ended_s = time.monotonic()
        self.told = replace(self.told, status=status, error=error)


def _reason(result: dict[str, Any]) -> str:
    """Return the server's reasons for an aborted goal: the texts in its result."""
    texts = [value.strip() for value in result.values() if isinstance(value, str)]
    return "; ".join(text for text in texts if text) or say("the server aborted it")


LEAVE_WITHIN_S = 1.5
"""How long a stopping observer waits for servers to agree to cancel."""
LOOK_S = 0.01


class GoalError(SaidError):
    """The goal cannot be sent; str() says why, `words` says it in translatable form."""


class Goals:
    """All goals that have been sent, until they are forgotten."""

    def __init__(self, node: Node, first_number: int = 1) -> None:
        self._node = node
        self._numbers = itertools.count(first_number)
        self._lives: dict[int, GoalLife] = {}
        self._clients: dict[tuple[str, str], PolledActionClient] = {}
        self._sent: set[bytes] = set()
        """Ids of all goals, forgotten ones included."""

    @property
    def under_way(self) -> bool:
        """Whether any goal has not ended."""
        return any(not life.told.ended for life in self._lives.values())

    def send(self, action: str, type_name: str, goal: Mapping[str, Value], known: ActionRow | None) -> int:
        """Send a goal as soon as there is a server; return its number.

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
        return number

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
