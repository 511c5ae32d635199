"""Everything that the observer's loop owns: the node, the last known graph, the subscriptions."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from graph.calls.exchanges import Exchanges, LoggerLevels
from graph.calls.goals import Goals
from graph.calls.goals_seen import SeenGoals
from graph.calls.lifecycle import Containers, Lifecycles
from graph.calls.parameters import ParameterCalls
from graph.calls.services import Calls
from graph.data import GraphUpdate, Interest
from graph.frames.book import FRAME_TOPICS, FrameBook
from graph.observer.taps import Taps
from graph.publishing.dead_man_switch import DeadManSwitch
from graph.publishing.outbox import Outbox, RepeatedPublications
from graph.scan import Scan, Signature, is_complete, scan, signature

if TYPE_CHECKING:
    from collections.abc import Callable

    from graph.data import ActionRow, FrameRow, NodeRow, Sample, ServiceRow
    from graph.ros import Ros
    from graph.scan import TopicEnds

PENDING_S = 0.01
"""How often calls and messages under way are polled."""
RESCAN_S = 3.0
"""A node replaced by an identical one between two scans is noticed after this long."""


class ObserverNode:
    """One open node at work; no method blocks."""

    def __init__(self, ros: Ros, graph_s: float, first_number: int = 1) -> None:
        """Take a node; it looks at the graph every `graph_s` seconds, and its first goal has that number."""
        self.graph_s = graph_s
        self.calls = Calls(ros.node)
        self.outbox = Outbox(ros.node)
        self.goals = Goals(ros.node, first_number)
        self.seen_goals = SeenGoals(ros.node, self.goals.has_sent)
        self.publications = RepeatedPublications(ros.node, first_number)
        self.dead_man_switch = DeadManSwitch(ros.node)
        self.exchanges = Exchanges(self.calls, self._known_node, self._known_service)
        self.parameters = ParameterCalls(self.exchanges)
        self.logger_levels = LoggerLevels(self.exchanges)
        self.lifecycles = Lifecycles(ros.node, self.exchanges)
        self.containers = Containers(self.exchanges)
        self.serve_urgent: Callable[[], object] = _nothing
        """Called repeatedly during long operations, for what cannot wait."""
        self._ros = ros
        self._frames = FrameBook()
        self._taps = Taps(ros.node, self._frames)
        self._scan = Scan()
        self._signature: Signature | None = None
        self._looked_s = 0.0
        self._scanned_s = 0.0
        self._tuned = (self._scan, Interest())
        self._told: tuple[object, ...] = ()

    @property
    def is_idle(self) -> bool:
        """Whether there is nothing to do but look at the graph."""
        return not (self._taps.any_open or self.goals.under_way)

    def ends(self, topic: str) -> TopicEnds | None:
        """Return what is known of a topic now."""
        self._look_at_graph()
        return self._scan.topics.get(topic)

    def service(self, name: str) -> ServiceRow | None:
        """Return what is known of a service now."""
        self._look_at_graph()
        return self._known_service(name)

    def action(self, name: str) -> ActionRow | None:
        """Return what is known of an action now."""
        self._look_at_graph()
        return next((row for row in self._scan.actions if row.name == name), None)

    def look(self, interest: Interest) -> GraphUpdate | None:
        """Look at the graph and at the queues; return what is new, None if nothing is."""
        if time.monotonic() - self._looked_s >= self.graph_s:
            self._look_at_graph()
        tuned = (self._scan, interest)
        if tuned != self._tuned or self._taps.need_tuning():
            self._tuned = tuned
            self._taps.tune(*tuned)
            self.seen_goals.tune(interest.actions, self._scan.actions)
            services = self._scan.services if interest.inner_states else ()
            self.lifecycles.tune(self._scan.nodes, services)
            self.containers.tune(self._scan.nodes, services)
        self.lifecycles.look()
        self.containers.look()
        samples = self._taps.drain(self.serve_urgent)
        return self._update(samples, self._frame_rows() if interest.frames else ())

    def step(self) -> float | None:
        """Continue what is under way; return when to continue again, on the monotonic clock.

        None if nothing needs that before the next look.
        """
        # A held topic may have to send its rest message first of all; then what is due.
        due_s = _sooner(self.dead_man_switch.step(), self.publications.step())
        calling = self.calls.step()
        # Answers that have just arrived lead to the next question.
        talking = self.exchanges.step()
        pursuing = self.goals.step()
        canceling = self.seen_goals.step()
        sending = self.outbox.step()
        if not (calling or talking or pursuing or canceling or sending):
            return due_s
        return _sooner(due_s, time.monotonic() + PENDING_S)

    def stop_commanding(self) -> None:
        """Release what is held, stop publishing periodically, cancel goals."""
        self.dead_man_switch.close()
        self.publications.close()
        self.goals.cancel_all()

    def close(self, error: Exception) -> None:
        """Cancel goals, let everything else under way fail, and leave the graph."""
        try:
            self.dead_man_switch.close()
            self.publications.close()
            self.goals.close()
            self.seen_goals.close()
        finally:
            self.exchanges.fail(error)
            self.lifecycles.close()
            self.calls.fail(error)
            self.outbox.fail(error)
            self._taps.close()
            self._ros.close()

    def _known_service(self, name: str) -> ServiceRow | None:
        return next((row for row in self._scan.services if row.name == name), None)

    def _known_node(self, name: str) -> NodeRow | None:
        return next((row for row in self._scan.nodes if row.name == name), None)

    def _look_at_graph(self) -> None:
        now_s = time.monotonic()
        self._looked_s = now_s
        found = signature(self._ros.node)
        is_news = found != self._signature or not is_complete(self._scan)
        if not is_news and now_s - self._scanned_s < RESCAN_S:
            return
        self._signature, self._scanned_s = found, now_s
        seen = scan(self._ros.node, self._ros.name, self.serve_urgent)
        # Also if only the passive subscriptions have changed.
        self.publications.tune(seen.topics)
        if seen != self._scan:
            self.dead_man_switch.tune(seen.topics)
        # Also if it is equal: endpoints may have been replaced by others like them.
        self._scan = seen

    def _frame_rows(self) -> tuple[FrameRow, ...]:
        now_s = time.time()
        for topic in FRAME_TOPICS:
            ends = self._scan.topics.get(topic)
            everyone = ends.everyone_publishing if ends else ()
            there = {end.gid: end.node if end.is_named else "" for end in everyone}
            self._frames.published_by(topic, there)
        return self._frames.rows(now_s)

    def _update(self, samples: dict[str, tuple[Sample, ...]], frames: tuple[FrameRow, ...]) -> GraphUpdate | None:
        rows = self._taps.rows()
        seen = self._scan
        doing = (self.goals.rows(), self.seen_goals.rows(), self.publications.rows())
        inner = (self.lifecycles.rows(), self.containers.rows())
        told = (rows, seen.nodes, seen.services, seen.actions, *doing, *inner, frames)
        if not samples and told == self._told:
            return None
        self._told = told
        return GraphUpdate(
            time.time(),
            rows,
            samples,
            seen.nodes,
            seen.services,
            seen.actions,
            *doing,
            frames,
            lifecycles=inner[0],
            containers=inner[1],
        )


def _nothing() -> None:
    """Do nothing."""


def _sooner(one_s: float | None, other_s: float | None) -> float | None:
    times_s = [each_s for each_s in (one_s, other_s) if each_s is not None]
    return min(times_s, default=None)
