"""The observer's loop: it polls the graph and its queues, and carries out what is asked for.

Messages do not wake it. It runs in a process of its own (`graph.observer.process`), on one thread.
"""

from __future__ import annotations

import logging
import time
from dataclasses import replace
from typing import TYPE_CHECKING

from graph.data import GraphUpdate
from graph.observer.interest import Interest
from graph.observer.node import ObserverNode
from graph.observer.orders import Orders
from graph.observer.requests import ObserverError, Perform, RequestQueue
from graph.observer.settings import LOOK_AT_GRAPH_S
from graph.ros import open_ros
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import Protocol

    from graph.observer.census import Census
    from graph.observer.settings import ObserverSettings

    class Company(Protocol):
        """Whom the loop works for."""

        def tell(self, update: GraphUpdate) -> None:
            """Take an update."""

        def wait(self, within_s: float) -> None:
            """Wait for orders, so long at most."""

        def look(self) -> bool:
            """Take the orders that have come, without waiting; return whether there were any."""


logger = logging.getLogger(__name__)


class ObserverLoop:
    """One observer at work; all methods are called on the thread of `run`."""

    def __init__(self, settings: ObserverSettings, company: Company) -> None:
        self._settings = settings
        self._company = company
        self._interest = Interest()
        self._requests = RequestQueue()
        self._is_over = False
        self.orders = Orders(self._requests)
        self.period_s = 0.1
        """Seconds between two updates."""
        self._node: ObserverNode | None = None

    def census(self) -> Census | None:
        """Count who is in the domain; None before it is entered."""
        settings = self._settings
        is_networked = settings.discovery != "localhost"
        node = self._node
        return None if node is None else node.census(settings.domain, is_networked)

    def number_from(self, first: int) -> None:
        """Count goals and publications from this number on."""
        self._requests.put(Perform(lambda node: node.number_from(first)))

    def stop(self) -> None:
        """Let `run` leave the graph and return."""
        self._is_over = True

    def watch(self, topics: Iterable[str]) -> None:
        """See `Observer`, as for those below."""
        self._look_at(watched=frozenset(topics))

    def follow(self, topics: Iterable[str]) -> None:
        """Hand over every message."""
        self._look_at(followed=frozenset(topics))

    def watch_pictures(self, topics: Iterable[str]) -> None:
        """Hand over the newest picture."""
        self._look_at(pictures=frozenset(topics))

    def measure(self, wanted: tuple[bool, bool, bool]) -> None:
        self._look_at(all_topics=wanted[0], all_images=wanted[1], all_fast=wanted[2])

    def watch_goals(self, actions: Iterable[str]) -> None:
        self._look_at(actions=frozenset(actions))

    def watch_inner_states(self, wanted: bool) -> None:
        """Ask nodes for their lifecycle."""
        self._look_at(inner_states=wanted)

    def watch_frames(self, wanted: bool) -> None:
        self._look_at(frames=wanted)

    def run(self) -> ObserverError | None:
        """Observe until it is stopped; return why that was impossible, if it was."""
        refusal = None
        end = ObserverError(say("the observer has been stopped"))
        try:
            # This imports rclpy.
            ros = open_ros(self._settings.domain, self._settings.discovery, self._settings.role, self._settings.owner)
            node = ObserverNode(ros, self._settings.graph_s)
            node.serve_urgent = lambda: self.serve_urgent(node)
            self._node = node
        except Exception as error:  # noqa: BLE001 - reported to the screen
            words = say("ROS cannot be used: {error}", error=str(error))
            end = refusal = ObserverError(words)
            self._company.tell(GraphUpdate(time.time(), error=words))
        else:
            try:
                self._observe(node)
            finally:
                self._node = None
                node.close(end)
        finally:
            self._requests.refuse(end)
        return refusal

    def _look_at(self, **changes: frozenset[str] | bool) -> None:
        self._interest = replace(self._interest, **changes)  # type: ignore[arg-type]

    def _observe(self, node: ObserverNode) -> None:
        next_look_s = 0.0
        interest = self._interest
        while not self._is_over:
            self._requests.carry_out(node)
            try:
                due_s = node.step()
                now_s = time.monotonic()
                if now_s >= next_look_s or self._interest != interest:
                    interest = self._interest
                    period_s = self._settings.graph_s if node.is_idle else self.period_s
                    # At a steady pace; an extra look out of turn does not delay the next.
                    next_look_s = max(now_s, min(next_look_s, now_s) + period_s)
                    self._look(node, interest)
            except Exception as error:
                # The graph changes while it is being scanned: the next look has another chance.
                logger.exception("a look at the graph failed")
                words = say("the ROS graph: {error}", error=str(error))
                self._company.tell(GraphUpdate(time.time(), error=words))
                next_look_s, due_s = time.monotonic() + LOOK_AT_GRAPH_S, None
            until_s = next_look_s if due_s is None else min(next_look_s, due_s)
            self._company.wait(max(0.0, until_s - time.monotonic()))

    def serve_urgent(self, node: ObserverNode) -> None:
        """Serve what cannot wait for the end of a look: stops, and held topics."""
        self._company.look()
        self._requests.carry_out_urgent(node)
        node.dead_man_switch.step()

    def _look(self, node: ObserverNode, interest: Interest) -> None:
        update = node.look(interest)
        if update is not None:
            self._company.tell(update)
