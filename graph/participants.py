"""Who is in the domain, and who of them has told all about its nodes and their endpoints.

Every participant publishes on the DDS topic `ros_discovery_info` which nodes it has, and by which endpoints each of
them speaks. The middleware makes names of nodes from it, and keeps silent about endpoints that were announced there
and have not been found yet. rclpy cannot subscribe to it: rcl puts a slash before every name, and this one has none,
since it is none of ROS's. So the subscription is made by the functions that rcl itself calls, by ctypes, in the
library that rclpy has loaded; and messages are made and converted by the functions that rclpy calls for that.

Sources: rmw/rmw.h (`rmw_create_subscription`, `rmw_take`), rmw/types.h (`rmw_qos_profile_t`),
rmw/subscription_options.h, rcl/node.h (`rcl_node_get_rmw_handle`), rclpy/src/rclpy/utils.cpp,
rmw_dds_common/msg/ParticipantEntitiesInfo.msg, as Jazzy has them. Whoever finds another library gets no `Telling`.
"""

from __future__ import annotations

import ctypes
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator
    from collections.abc import Set as AbstractSet

    from rclpy.node import Node
    from rmw_dds_common.msg import ParticipantEntitiesInfo
    from typing_extensions import Self


TOPIC = "ros_discovery_info"
KEEP_ALL, RELIABLE, TRANSIENT_LOCAL = 2, 1, 1
"""Source: rmw/types.h, `rmw_qos_history_policy_e` and its like."""
ROOM = 256
"""Bytes for what a library of another version may fill in: three times as much as this one does."""
_POINTER = ctypes.c_void_p


class _Time(ctypes.Structure):
    _fields_ = (("sec", ctypes.c_uint64), ("nsec", ctypes.c_uint64))


class _Qos(ctypes.Structure):
    _fields_ = (
        ("history", ctypes.c_int),
        ("depth", ctypes.c_size_t),
        ("reliability", ctypes.c_int),
        ("durability", ctypes.c_int),
        ("deadline", _Time),
        ("lifespan", _Time),
        ("liveliness", ctypes.c_int),
        ("liveliness_lease_duration", _Time),
        ("avoid_ros_namespace_conventions", ctypes.c_bool),
        ("room", ctypes.c_ubyte * ROOM),
    )


class _Options(ctypes.Structure):
    _fields_ = (("room", ctypes.c_ubyte * ROOM),)


class Telling:
    """A subscription to the topic; create it by `load`, close it before its node."""

    def __init__(self, library: ctypes.CDLL, node: Node) -> None:
        """Subscribe; raises AttributeError and ValueError for a library that is not Jazzy's."""
        from rmw_dds_common.msg import ParticipantEntitiesInfo

        kind: Any = type(ParticipantEntitiesInfo)
        if kind._TYPE_SUPPORT is None:  # noqa: SLF001 - rclpy asks in this way too
            kind.__import_type_support__()
        self._take = _function(library, "rmw_take", ctypes.c_int, 4)
        self._destroy = _function(library, "rmw_destroy_subscription", ctypes.c_int, 2)
        self._forget_error = library.rcutils_reset_error
        self._to_python = ctypes.PYFUNCTYPE(ctypes.py_object, _POINTER)(
            _held(kind._CONVERT_TO_PY)  # noqa: SLF001 - rclpy takes it from there too
        )
        self._forget = ctypes.PYFUNCTYPE(None, _POINTER)(
            _held(kind._DESTROY_ROS_MESSAGE)  # noqa: SLF001
        )
        self._new = ctypes.PYFUNCTYPE(_POINTER)(_held(kind._CREATE_ROS_MESSAGE))  # noqa: SLF001
        handle_of = _function(library, "rcl_node_get_rmw_handle", _POINTER, 1)
        usual = library.rmw_get_default_subscription_options
        usual.restype = _Options
        create = _function(library, "rmw_create_subscription", _POINTER, 5)
        qos = _Qos(KEEP_ALL, 0, RELIABLE, TRANSIENT_LOCAL, avoid_ros_namespace_conventions=True)
        with node.handle:
            self._node = handle_of(node.handle.pointer)
            self._subscription = create(
                self._node,
                _held(kind._TYPE_SUPPORT),  # noqa: SLF001
                TOPIC.encode(),
                ctypes.byref(qos),
                ctypes.byref(usual()),
            )
        if not self._subscription:
            self._forget_error()
            raise ValueError(f"no subscription to {TOPIC}")

    @classmethod
    def load(cls, node: Node) -> Self | None:
        """Subscribe beside this node; None if the middleware does not know the topic."""
        from rclpy.impl.implementation_singleton import rclpy_implementation as rclpy_c

        try:
            return cls(ctypes.PyDLL(rclpy_c.__file__), node)
        except (AttributeError, ImportError, OSError, ValueError):
            return None

    def take(self) -> Iterator[ParticipantEntitiesInfo]:
        """Yield what has arrived: of each participant its nodes with all their endpoints."""
        taken = ctypes.c_bool()
        message = self._new()
        try:
            while True:
                taken.value = False
                failed = self._take(self._subscription, message, ctypes.byref(taken), None)
                if failed:
                    self._forget_error()
                if failed or not taken.value:
                    return
                yield self._to_python(message)
        finally:
            self._forget(message)

    def close(self) -> None:
        self._destroy(self._node, self._subscription)


def _function(library: ctypes.CDLL, name: str, result: Any, arguments: int) -> Any:  # noqa: ANN401
    found = getattr(library, name)
    found.restype, found.argtypes = result, [_POINTER] * arguments
    return found


def _held(capsule: object) -> int:
    """Return the pointer in a capsule of Python's C API."""
    name = ctypes.pythonapi.PyCapsule_GetName
    name.restype, name.argtypes = ctypes.c_char_p, [ctypes.py_object]
    pointer = ctypes.pythonapi.PyCapsule_GetPointer
    pointer.restype, pointer.argtypes = _POINTER, [ctypes.py_object, ctypes.c_char_p]
    return int(pointer(capsule, name(capsule)))


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
