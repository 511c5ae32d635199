"""The node of one command: joins the domain of the environment, and waits until it sees the others.

There is no daemon that knows the graph already. A command waits until all who are there have told
what they have, or, if it needs one thing, until that is found. Who has not told in time is named,
and the command ends with the exit code 1: what it has printed may not be all.
"""

from __future__ import annotations

import math
import os
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from graph.participants import Roll
from graph.ros import PEERS, RANGE, announcing
from launcher.domain.participants import LocalParticipants
from ros2.ending import was_interrupted
from ros2.presence import ANSWERED_WITHIN_S, NETWORK_S, Missing, is_off, is_wide, missing, stopped, words
from text.i18n import localized

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Iterator

    from rclpy.executors import SingleThreadedExecutor
    from rclpy.node import Node
    from rclpy.task import Future

    from launcher.domain.participants import LocalParticipant

QUIET_S = 0.1
"""Without news for so long, what has just been told is taken to be all."""
ALONE_S = 0.8
"""So long must nobody else be found for the graph to be taken as empty."""
SILENT_S = 6.5
"""So long is waited without any news from those who are there: more than two announcements."""
LONGEST_S = 20.0
"""A graph that never comes to rest is taken as it is."""
READY_S = 10.0
"""So long may a service of a node that is there take to be found."""
LOOK_S = 0.05
KERNEL_S = 0.1
"""The kernel is asked so often who is there."""
GONE_S = 1.0
"""A server that is not seen for so long has gone."""
SPIN_S = 0.1
"""How late Ctrl-C may be noticed: the middleware does not wake up for signals."""


class NoAnswerError(RuntimeError):
    """A node is there and does not answer, or has gone before it did."""


class Guest:
    """A node in the graph, with what drives it."""

    def __init__(self, node: Node, executor: SingleThreadedExecutor, answered_within_s: float) -> None:
        self.node = node
        self.answered_within_s = answered_within_s
        self._executor = executor
        self._roll = Roll(node)
        self._kernel = LocalParticipants(node.context.get_domain_id())
        self._since = self._news_at = time.monotonic()
        self._asked_at = -math.inf
        self._here: list[LocalParticipant] = []
        self._known: object = None
        self._is_alone = True
        self.missing = Missing()
        """Who has not told all, for which reason something may not have been found."""

    def spin_once(self, timeout_s: float = SPIN_S) -> None:
        """Take in what has come, or wait a moment for it."""
        try:
            self._executor.spin_once(timeout_sec=timeout_s)
        except TypeError as error:
            if was_interrupted(error):
                raise KeyboardInterrupt from error
            raise

    def finish(
        self,
        future: Future,
        owner: str,
        *,
        within_s: float | None = None,
        is_there: Callable[[], bool] = lambda: True,
    ) -> None:
        """Wait for the answer of `owner`, as long as the option says unless told otherwise.

        Raises:
            NoAnswerError: if it has not come by then, or `is_there` has said no for a while.
        """
        within_s = self.answered_within_s if within_s is None else within_s
        begun = there_at = time.monotonic()
        while not future.done():
            self.spin_once()
            now = time.monotonic()
            if is_there():
                there_at = now
            if now - there_at > GONE_S:
                raise NoAnswerError(f"{owner} has gone before it answered")
            if now - begun > within_s:
                raise NoAnswerError(
                    f"{owner} has not answered within {within_s:g} s: it may be stuck in a"
                    " callback, or before it spins, or be killed; --timeout waits longer"
                )

    def call(self, service: str, kind: Any, owner: str, **fields: object) -> Any:  # noqa: ANN401
        """Call a service of the node `owner` and return the answer; RuntimeError without one."""
        client = self.node.create_client(kind, service)
        try:
            found = client.wait_for_service(timeout_sec=READY_S)
            if not found and not self.await_until(client.service_is_ready):
                raise RuntimeError("Wait for service timed out")
            future = client.call_async(kind.Request(**fields))
            self.finish(future, owner, is_there=client.service_is_ready)
            response = future.result()
            if response is None:
                why = future.exception()
                raise RuntimeError(f"Exception while calling service of node '{owner}': {why}")
            return response
        finally:
            self.node.destroy_client(client)

    def settle(self, longest_s: float = LONGEST_S) -> None:
        """Wait until all who are there have told all, so long at most."""
        self._await(lambda: False, longest_s)

    def await_until(self, there: Callable[[], bool]) -> bool:
        """Wait for one thing until it is there, or would be; return whether it is there."""
        return there() or self._await(there)

    def forgive(self) -> None:
        """Take it that what was needed has been found, whoever has not told all."""
        self.missing = Missing()

    def look(self) -> None:
        """See who is missing at this moment."""
        attendance = self._roll.look()
        now = time.monotonic()
        if now >= self._asked_at + KERNEL_S:
            self._asked_at = now
            self._here = [] if is_off() else self._kernel.look()
        self.missing = missing(attendance, self._here)
        if (attendance, self.missing) != self._known:
            self._known, self._news_at = (attendance, self.missing), now
        self._is_alone = len(attendance.found) <= 1 and len(self._here) <= 1

    def _await(self, there: Callable[[], bool], longest_s: float = LONGEST_S) -> bool:
        begun = time.monotonic()
        while True:
            self.look()
            if there():
                self.forgive()
                return True
            now = time.monotonic()
            if self._is_over(now) or now - begun >= longest_s:
                return False
            time.sleep(LOOK_S)

    def _is_over(self, now: float) -> bool:
        """Return whether waiting on would bring nothing."""
        age_s, quiet_s = now - self._since, now - self._news_at
        if self.missing.without(stopped(self.missing.pids)):
            return quiet_s >= SILENT_S
        return quiet_s >= QUIET_S and age_s >= self._least_s()

    def _least_s(self) -> float:
        """Return for how long others may be there who have not announced themselves yet."""
        if is_wide():
            return NETWORK_S
        return ALONE_S if self._is_alone else 0.0

    def leave(self) -> None:
        self._roll.close()
        self._executor.shutdown()
        self.node.destroy_node()


@contextmanager
def joined(args: argparse.Namespace, name: str = "", *, settled: bool = False) -> Iterator[Guest]:
    """Open the node of a command for the length of a `with`; `settled`: it sees everybody."""
    from rclpy.context import Context
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.node import Node
    from rclpy.parameter import Parameter

    context = Context()
    if os.environ.get(RANGE, "").upper() == "LOCALHOST" and not os.environ.get(PEERS):
        os.environ.update({name: value for name, value in announcing("localhost").items() if value})
    context.init(args=[], initialize_logging=False)
    own = [Parameter("start_type_description_service", value=False)]
    if getattr(args, "use_sim_time", False):
        own.append(Parameter("use_sim_time", value=True))
    try:
        node = Node(
            name or f"_ros2cli_{os.getpid()}",
            context=context,
            use_global_arguments=False,
            start_parameter_services=False,
            parameter_overrides=own,
        )
    except Exception as error:
        context.try_shutdown()
        raise RuntimeError(str(error)) from error
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    me = Guest(node, executor, getattr(args, "timeout", ANSWERED_WITHIN_S))
    try:
        spin_s = getattr(args, "spin_time", None)
        if spin_s is not None:
            time.sleep(spin_s)
            me.look()
        elif settled:
            me.settle()
        yield me
        if me.missing:
            args.missing = localized(words(me.missing, context.get_domain_id()))
    finally:
        me.leave()
        context.try_shutdown()
