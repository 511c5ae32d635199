"""Publishers that bypass the gate and the differential, or speak for a sonar of the gate; and what is normal.

The nodes of the session may publish anything that their profile says. Any other publisher on these topics bypasses
the gate, and so does a second publisher with the name of one of them. If no node of the session has that role, the
owner of the topic is unknown; then only two publishers are reported, and so it is with the distances, of which the
gate takes the lowest.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from graph.data import NAMELESS
from graph.findings.finding import GraphNorms
from safety.moving_topics import moves
from safety.topics import EMERGENCY_STOP
from text.i18n import _
from text.plain import plain
from text.robot import robot

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from graph.data import GraphUpdate, TopicRow
    from launcher.status import NodeStatus
    from text.robot import SoleTopic


NORMS = GraphNorms(
    moves, frozenset(one.topic for one in robot().sole), robot().of_many, robot().may_wait | {EMERGENCY_STOP}
)
OURSELVES = "Deck"
"""Stands for what is published from this screen at a rate."""
NAMED_WITHIN_S = 3.0
"""An endpoint gets its name slightly later; one without a node never gets a name."""
FORGOTTEN_S = 25.0
"""For this long the middleware may still report a publisher that was killed with its node."""


@dataclass(frozen=True)
class BypassingPublisher:
    """A publisher on a topic reserved for another node."""

    topic: str
    node: str
    """Full name; ends with `NAMELESS` for a publisher that is not a ROS node."""
    is_namesake: bool = False
    """Whether it has the name of a node that may publish the topic."""

    @property
    def called(self) -> str:
        if self.node.endswith(NAMELESS):
            return _("a program without a node's name")
        name = plain(self.node, 60)
        return _("another {name}").format(name=name) if self.is_namesake else name


class BypassDetector:
    """Finds the publishers that bypass the gate or the differential now."""

    def __init__(self) -> None:
        self.now: tuple[BypassingPublisher, ...] = ()
        self._seen_s: dict[BypassingPublisher, float] = {}

    def see(self, update: GraphUpdate, nodes: Mapping[str, NodeStatus]) -> bool:
        """Examine the graph; return whether these publishers have changed."""
        if update.error:
            return False
        ours = frozenset(one.topic for one in update.publications if not one.error)
        found = {
            publisher: self._seen_s.get(publisher, update.time_s)
            for reserved in robot().sole
            for publisher in _on_topics_of(reserved, update.topics, nodes, ours)
        }
        found |= {
            publisher: self._seen_s.get(publisher, update.time_s)
            for row in update.topics
            if row.name in robot().frames
            for publisher in _with_sonars(row, nodes, ours)
        }
        before, self._seen_s = self.now, found
        self.now = tuple(
            publisher
            for publisher, seen_s in found.items()
            if not publisher.node.endswith(NAMELESS) or update.time_s - seen_s > NAMED_WITHIN_S
        )
        return self.now != before

    def forget(self) -> None:
        """Reset for another session."""
        self.now, self._seen_s = (), {}

    def words(self) -> tuple[str, ...]:
        """Return texts that say who they are, from long to short; empty if there are none."""
        commands = [one for one in self.now if one.topic not in robot().frames]
        # The screen has one line, and who commands the wheels is the worse.
        shown = commands or list(self.now)
        if not shown:
            return ()
        topics = ", ".join(dict.fromkeys(plain(publisher.topic, 60) for publisher in shown))
        names = ", ".join(dict.fromkeys(publisher.called for publisher in shown))
        words = _("⚠ Foreign commands on {topics}: {names}").format(topics=topics, names=names)
        follows = _("the slowest command counts")
        if not commands:
            words = _("⚠ Several publish {topics}: {names}").format(topics=topics, names=names)
            follows = _("the lowest distance counts")
        return (f"{words} · {follows}", words, f"⚠ {topics}: {names}")


def _on_topics_of(
    reserved: SoleTopic, rows: Iterable[TopicRow], nodes: Mapping[str, NodeStatus], ours: Collection[str]
) -> Iterator[BypassingPublisher]:
    owners = {f"/{node.name}": node for node in nodes.values() if reserved.role in node.roles}
    for row in rows:
        if row.name != reserved.topic and reserved.type_name not in row.type_names:
            continue
        by = Counter(end.node for end in row.published_by)
        if row.name in ours:
            by[OURSELVES] += 1
        # Its profile may have remapped the topic.
        is_reserved = reserved.type_name in row.type_names and bool(by.keys() & owners.keys())
        is_used = row.subscribers or sum(by.values()) > 1
        if is_reserved or (row.name == reserved.topic and is_used):
            yield from _bypassing(row.name, by, reserved, owners, nodes)


def _with_sonars(row: TopicRow, nodes: Mapping[str, NodeStatus], ours: Collection[str]) -> list[BypassingPublisher]:
    """Return who speaks for a sonar beside the session's own node; all if that is not known."""
    by = Counter(end.node for end in row.published_by)
    if row.name in ours:
        by[OURSELVES] += 1
    if sum(by.values()) < 2:
        return []
    own = {f"/{name}": node for name, node in nodes.items()}
    foreign = [name for name in by if name not in own] or list(by)
    twice = [name for name in by.keys() & own.keys() if by[name] > 1]
    return [
        *(BypassingPublisher(row.name, name) for name in foreign if len(by) > 1),
        *(BypassingPublisher(row.name, name, True) for name in twice if not _may_be_left(own[name])),
    ]


def _bypassing(
    topic: str,
    by: Counter[str],
    reserved: SoleTopic,
    owners: Mapping[str, NodeStatus],
    nodes: Mapping[str, NodeStatus],
) -> Sequence[BypassingPublisher]:
    own = {f"/{name}" for name in nodes}
    if not owners:
        if sum(by.values()) < 2:
            return ()
        own |= reserved.names
    foreign = [BypassingPublisher(topic, name) for name in by if name not in own]
    twice = [name for name, count in by.items() if count > 1 and name in own]
    namesakes = [name for name in twice if not _may_be_left(owners.get(name))]
    return [*foreign, *(BypassingPublisher(topic, name, True) for name in namesakes)]


def _may_be_left(node: NodeStatus | None) -> bool:
    """Whether the second publisher of that name may be left over from a crash."""
    return node is not None and node.restarts > 0 and (node.uptime_s or 0.0) < FORGOTTEN_S
