"""Compares what participants have told with what is in the graph."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from graph.participants.telling import TOPIC, Telling

if TYPE_CHECKING:
    from collections.abc import Set as AbstractSet

    from rclpy.node import Node
    from rmw_dds_common.msg import ParticipantEntitiesInfo

PREFIX = 12
"""Bytes of an endpoint's GUID that are its participant's. Source: RTPS 2.5, 8.2.4."""
UNNAMED = "_NODE_NAME_UNKNOWN_"
"""Source: rmw_dds_common/src/graph_cache.cpp."""
OWN_ENDS = 2
"""Endpoints of each participant that are none of its nodes': it tells on the topic, and hears."""


@dataclass(frozen=True)
class Attendance:
    """Who has been found, and who of them not wholly."""

    found: frozenset[bytes] = frozenset()
    """The participants, by the first 12 bytes of their GUID, this process's too."""
    partly: frozenset[bytes] = frozenset()
    """Those whose nodes are not known, or of whose endpoints some are not found yet."""
    ends: int = 0
    """How many endpoints have been found."""


@dataclass(frozen=True)
class _Told:
    """What a participant has told."""

    nodes: frozenset[tuple[str, str]]
    """Names and namespaces."""
    ends: frozenset[bytes]
    """The GUIDs of their endpoints."""

    def is_in(self, ends: AbstractSet[bytes], nodes: AbstractSet[tuple[str, str]]) -> bool:
        return self.ends <= ends and self.nodes <= nodes


class Roll:
    """What a node's process knows of the participants; close it before the node."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._telling = Telling.load(node)
        self._told: dict[bytes, _Told] = {}

    def close(self) -> None:
        if self._telling is not None:
            self._telling.close()

    def look(self) -> Attendance:
        """Take in what has been told, and compare it with the graph.

        To look for every endpoint takes some 20 ms in the graph of a robot, so that it is only done
        once everybody who speaks on the topic has told.
        """
        speaking = frozenset(_participant(end) for end in self._ends_on(TOPIC))
        if self._telling is None:
            return self._by_names(speaking)
        for told in self._telling.take():
            self._told[_bytes(told.gid)[:PREFIX]] = _told(told)
        silent = speaking - self._told.keys()
        if silent:
            return Attendance(speaking, silent)
        ends = self._ends()
        # The middleware takes its own copy of what was announced, and may be later with that.
        placed = {bytes(end["endpoint_gid"]) for end in ends if end["node_name"] != UNNAMED}
        names = frozenset(self._node.get_node_names_and_namespaces())
        partly = frozenset(one for one in speaking if not self._told[one].is_in(placed, names))
        # Who has endpoints, and none on the topic, is not of ROS and has no nodes.
        return Attendance(speaking | set(map(_participant, ends)), partly, len(placed))

    def _by_names(self, speaking: frozenset[bytes]) -> Attendance:
        """Go by the names of nodes, which the middleware makes of what it has been told."""
        ends = [(_participant(end), end["node_name"]) for end in self._ends()]
        named = {one for one, name in ends if name != UNNAMED}
        # On the topic itself nobody's endpoint has a name.
        counted = Counter(one for one, name in ends if name == UNNAMED)
        return Attendance(
            speaking | {one for one, _ in ends},
            frozenset(one for one in speaking if one not in named or counted[one] > OWN_ENDS),
            len(ends),
        )

    def _ends(self) -> list[dict[str, Any]]:
        topics = self._node.get_topic_names_and_types(no_demangle=True)
        return [end for name, _ in topics for end in self._ends_on(name)]

    def _ends_on(self, topic: str) -> list[dict[str, Any]]:
        from rclpy.impl.implementation_singleton import rclpy_implementation as rclpy_c

        handle = self._node.handle
        # rclpy's own objects cost four times as much.
        with handle:
            return [
                *rclpy_c.rclpy_get_publishers_info_by_topic(handle, topic, True),
                *rclpy_c.rclpy_get_subscriptions_info_by_topic(handle, topic, True),
            ]


def _participant(end: dict[str, Any]) -> bytes:
    return bytes(end["endpoint_gid"][:PREFIX])


def _told(told: ParticipantEntitiesInfo) -> _Told:
    nodes = told.node_entities_info_seq
    return _Told(
        frozenset((node.node_name, node.node_namespace) for node in nodes),
        frozenset(_bytes(gid) for node in nodes for gid in (*node.reader_gid_seq, *node.writer_gid_seq)),
    )


def _bytes(gid: object) -> bytes:
    return bytes(gid.data)  # type: ignore[attr-defined]
