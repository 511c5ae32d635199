"""Publishers that bypass the gate and the differential, and so command the wheels directly.

The nodes of the session may publish anything that their profile says. Any other publisher on these
topics bypasses the gate, and so does a second publisher with the name of one of them. If the
session has no such node of Deck's, the owner of the topic is unknown; then only two publishers are
reported.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robot.topics import DRIVE_SAFE, WHEEL_COMMANDS
from text.i18n import _
from text.plain import plain

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from graph.data import GraphUpdate, TopicRow
    from launcher.status import NodeStatus

OURSELVES = "Deck"
"""Stands for what is published from this screen at a rate."""
NAMELESS = "_NODE_NAME_UNKNOWN_"
"""Source: rmw, `get_topic_endpoint_info.h`."""
NAMED_WITHIN_S = 3.0
"""An endpoint gets its name slightly later; one without a node never gets a name."""
FORGOTTEN_S = 25.0
"""For this long the middleware may still report a publisher that was killed with its node."""


@dataclass(frozen=True)
class Keeper:
    """The node of Deck's that should be the only publisher on a topic."""

    module: str
    topic: str
    type_name: str
    names: frozenset[str]
    """Its names when no profile contains it."""


KEEPERS = (
    Keeper(
        "nodes.safety_stop",
        DRIVE_SAFE,
        "ackermann_msgs/msg/AckermannDriveStamped",
        frozenset({"/safety_node", "/safety_stop"}),
    ),
    Keeper(
        "nodes.electronic_differential",
        WHEEL_COMMANDS,
        "sensor_msgs/msg/JointState",
        frozenset({"/electronic_differential"}),
    ),
)


@dataclass(frozen=True)
class Stranger:
    """A publisher on a topic reserved for another node."""

    topic: str
    node: str
    """Full name; ends with `NAMELESS` for a publisher that is not a ROS node."""
    is_namesake: bool = False
    """Whether it has the name of a node that may publish the topic."""

    @property
    def called(self) -> str:
        """Its name for display."""
        if self.node.endswith(NAMELESS):
            return _("a program without a node's name")
        name = plain(self.node, 60)
        return _("another {name}").format(name=name) if self.is_namesake else name


class Strangers:
    """The current strangers."""

    def __init__(self) -> None:
        self.now: tuple[Stranger, ...] = ()
        self._seen_s: dict[Stranger, float] = {}

    def see(self, update: GraphUpdate, nodes: Mapping[str, NodeStatus]) -> bool:
        """Examine the graph; return whether the strangers have changed."""
        if update.error:
            return False
        ours = frozenset(one.topic for one in update.publications if not one.error)
        found = {
            stranger: self._seen_s.get(stranger, update.time_s)
            for keeper in KEEPERS
            for stranger in _on_topics_of(keeper, update.topics, nodes, ours)
        }
        before, self._seen_s = self.now, found
        self.now = tuple(
            stranger
            for stranger, seen_s in found.items()
            if not stranger.node.endswith(NAMELESS) or update.time_s - seen_s > NAMED_WITHIN_S
        )
        return self.now != before

    def forget(self) -> None:
        """Reset for another session."""
        self.now, self._seen_s = (), {}

    def words(self) -> tuple[str, ...]:
        """Return texts that say who they are, from long to short; empty if there are none."""
        if not self.now:
            return ()
        topics = ", ".join(dict.fromkeys(plain(stranger.topic, 60) for stranger in self.now))
        names = ", ".join(dict.fromkeys(stranger.called for stranger in self.now))
        words = _("⚠ Foreign commands on {topics}: {names}").format(topics=topics, names=names)
        last = _("the wheels obey whoever spoke last")
        return (f"{words} · {last}", words, f"⚠ {topics}: {names}")


def _on_topics_of(
    keeper: Keeper,
    rows: Iterable[TopicRow],
    nodes: Mapping[str, NodeStatus],
    ours: Collection[str],
) -> Iterator[Stranger]:
    keeping = {f"/{node.name}": node for node in nodes.values() if node.command == keeper.module}
    for row in rows:
        if row.name != keeper.topic and keeper.type_name not in row.type_names:
            continue
        by = Counter(end.node for end in row.published_by)
        if row.name in ours:
            by[OURSELVES] += 1
        # Its profile may have remapped the topic.
        is_kept = keeper.type_name in row.type_names and bool(by.keys() & keeping.keys())
        if is_kept or (row.name == keeper.topic and (row.subscribers or sum(by.values()) > 1)):
            yield from _strangers(row.name, by, keeper, keeping, nodes)


def _strangers(
    topic: str,
    by: Counter[str],
    keeper: Keeper,
    keeping: Mapping[str, NodeStatus],
    nodes: Mapping[str, NodeStatus],
) -> Sequence[Stranger]:
    own = {f"/{name}" for name in nodes}
    if not keeping:
        if sum(by.values()) < 2:
            return ()
        own |= keeper.names
    strange = [Stranger(topic, name) for name in by if name not in own]
    twice = [name for name, count in by.items() if count > 1 and name in own]
    alike = [Stranger(topic, name, True) for name in twice if not _may_be_left(keeping.get(name))]
    return [*strange, *alike]


def _may_be_left(node: NodeStatus | None) -> bool:
    """Whether the second publisher of that name may be left over from a crash."""
    return node is not None and node.restarts > 0 and (node.uptime_s or 0.0) < FORGOTTEN_S
