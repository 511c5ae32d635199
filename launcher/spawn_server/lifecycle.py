"""Waits until a node with a lifecycle is in a state, and has it go there if that is wanted.

A short-lived process, forked from the spawn server as the probe is: the supervisor does not load
rclpy. It writes a line of JSON to its stdout for every state it sees, `{"state": ...}`; the last
line is `{"state": ..., "failed": transition}` if a transition did not lead where it should, with an
empty transition if none leads to the wanted state.
"""

from __future__ import annotations

import json
import os
import select
import time
from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from launcher.spawn_server.probe import hidden_node
from text.nested import read_json

if TYPE_CHECKING:
    from rclpy.client import Client
    from rclpy.executors import Executor
    from rclpy.node import Node
    from rclpy.task import Future

WAYS = {
    "active": {"unconfigured": ("configure", "inactive"), "inactive": ("activate", "active")},
    "inactive": {"unconfigured": ("configure", "inactive")},
}
"""Wanted state -> current state -> transition, and the state that it should lead to."""
FINALIZED = "finalized"
STABLE = frozenset({"unconfigured", "inactive", "active", FINALIZED})
"""All other states are those of a transition under way."""
LOOK_S = 0.1
SPIN_S = 0.02
ASK_AGAIN_S = 1.0
"""An answer may be lost while two processes discover each other."""
LOST_S = 3.0
"""After so long without an answer, the state alone tells what became of a transition."""
SETTLE_S = 0.2
"""A service is discovered here before it discovers the client."""


class _EndedError(Exception):
    """The supervisor does not want to know any more."""


def watch_lifecycle(argv: Sequence[str]) -> None:
    """Watch one node until stdin ends; `argv` is a JSON list: node, wanted state, whether to go."""
    from rclpy.executors import SingleThreadedExecutor

    name, wanted, goes = read_json(argv[0])
    with hidden_node("deck_lifecycle") as (node, reports), suppress(_EndedError):
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        try:
            _Managed(node, executor, f"/{name.lstrip('/')}", reports).follow(wanted, goes=goes)
        finally:
            executor.shutdown()


class _Managed:
    """The node that is watched, as its services show it."""

    def __init__(self, node: Node, executor: Executor, name: str, reports: int) -> None:
        from lifecycle_msgs.srv import ChangeState, GetState

        self._executor = executor
        self._reports = reports
        self._get: Client = node.create_client(GetState, f"{name}/get_state")
        self._change: Client = node.create_client(ChangeState, f"{name}/change_state")
        self._told = ""

    def follow(self, wanted: str, *, goes: bool) -> None:
        """Report its states until it is in the wanted one, or cannot get there."""
        self._wait_for_services()
        while (state := self._state()) != wanted:
            self._tell(state)
            step = WAYS[wanted].get(state)
            if goes and step is not None:
                transition, goal = step
                state = self._go(transition, state)
                if state != goal:
                    self._fail(transition, state)
                    return
            elif state == FINALIZED:
                self._fail("", state)
                return
            self._pause(LOOK_S)
        self._tell(state)
        self._pause(None)

    def _wait_for_services(self) -> None:
        ready_s = 0.0
        while not ready_s or time.monotonic() - ready_s < SETTLE_S:
            self._pause(SPIN_S)
            if not (self._get.service_is_ready() and self._change.service_is_ready()):
                ready_s = 0.0
            elif not ready_s:
                ready_s = time.monotonic()

    def _go(self, transition: str, before: str) -> str:
        """Ask for a transition; return the state that it led to."""
        request = self._request(self._change)
        request.transition.label = transition
        answer = self._change.call_async(request)
        asked_s = time.monotonic()
        while not answer.done():
            self._pause(LOOK_S)
            state = self._state(answer)
            lost = state in STABLE and (state != before or time.monotonic() - asked_s > LOST_S)
            if lost and not answer.done():
                break
        while (state := self._state()) not in STABLE:
            self._tell(state)
            self._pause(LOOK_S)
        return state

    def _state(self, other: Future | None = None) -> str:
        """Ask for the state until there is an answer; empty if there is one to `other` before."""
        while True:
            question = self._get.call_async(self._request(self._get))
            asked_s = time.monotonic()
            while time.monotonic() - asked_s < ASK_AGAIN_S:
                self._pause(SPIN_S)
                if question.done():
                    return str(question.result().current_state.label)
                if other is not None and other.done():
                    return ""
            self._get.remove_pending_request(question)

    @staticmethod
    def _request(client: Client) -> Any:  # noqa: ANN401 - generated
        service: Any = client.srv_type
        return service.Request()

    def _pause(self, seconds: float | None) -> None:
        """Take in what arrives for so long, for ever if None; raises `_EndedError`."""
        end_s = None if seconds is None else time.monotonic() + seconds
        while True:
            self._executor.spin_once(timeout_sec=SPIN_S if seconds is not None else 0.0)
            if select.select([0], [], [], 0.0 if seconds is not None else 1.0)[0]:
                raise _EndedError
            if end_s is not None and time.monotonic() >= end_s:
                return

    def _tell(self, state: str) -> None:
        if state != self._told:
            self._told = state
            self._report({"state": state})

    def _fail(self, transition: str, state: str) -> None:
        self._report({"state": state, "failed": transition})
        self._pause(None)

    def _report(self, line: dict[str, str]) -> None:
        os.write(self._reports, json.dumps(line).encode() + b"\n")
