"""Deck's own node: opened with as little as rclpy allows, and closed without a trace."""

from __future__ import annotations

import os
import time
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from graph.memory import keep_room_for_large_messages

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rclpy.context import Context
    from rclpy.node import Node
    from rclpy.qos import QoSProfile
    from rclpy.subscription import Subscription

NAME_PREFIX = "_deck_"
"""The underscore keeps it out of `ros2 node list`."""
ONLY_LISTENING = tuple(f"/{NAME_PREFIX}{role}_" for role in ("observer", "recorder", "agents", "view", "relay"))
"""Prefixes of the full names of observing nodes, in this or in another process of Deck."""
DOMAINS = range(233)
"""Fast DDS ends the whole process at a greater domain: its port numbers would be out of range."""
FAST_DDS = Path(__file__).with_name("fastdds.xml")
"""Fast DDS settings for all of Deck's processes: fast discovery, on this machine only."""
FAST_DDS_OF_PEERS = FAST_DDS.with_name("fastdds_peers.xml")
TRANSPORTS = "FASTDDS_BUILTIN_TRANSPORTS"
FAST_DDS_VARIABLES = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")
"""Jazzy's Fast DDS reads the first one first."""
ONLY_THESE = "SKIP_DEFAULT_XML_FILE"
"""Keeps Fast DDS from reading DEFAULT_FASTRTPS_PROFILES.xml in the current folder as well."""
LOCALHOST_ONLY = "ROS_LOCALHOST_ONLY"
RMW, FAST_RTPS = "RMW_IMPLEMENTATION", ("", "rmw_fastrtps_cpp", "rmw_fastrtps_dynamic_cpp")
RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
PEERS = "ROS_STATIC_PEERS"
RANGES = {"localhost": "LOCALHOST", "subnet": "SUBNET"}
ACKED_WITHIN_S = 0.5
"""How long a node that leaves waits for those who have not received its last words.

Who is not held up has them at once, and confirms that with the next heartbeat, each 3 s.
"""
_LOOK_S = 0.02


@dataclass(frozen=True)
class Ros:
    """An open node with a context of its own."""

    context: Context
    node: Node
    name: str
    """Full name of the node."""

    def close(self) -> None:
        """Destroy the node and leave the graph, once what was published last has arrived.

        A subscriber that is held up would never get it: it may be a stop.
        """
        self.wait_until_heard(ACKED_WITHIN_S)
        self.node.destroy_node()
        self.context.try_shutdown()
        self.context.destroy()

    def wait_until_heard(self, within_s: float) -> None:
        """Wait until every subscriber has all that was published, so long at most."""
        from rclpy.duration import Duration

        deadline_s = time.monotonic() + within_s
        # Waiting in rclpy would hold up all other threads.
        while not all(each.wait_for_all_acked(Duration()) for each in self.node.publishers):
            if time.monotonic() >= deadline_s:
                return
            time.sleep(_LOOK_S)


def open_ros(domain: int, discovery: str | tuple[str, ...], role: str = "observer", owner: int = 0) -> Ros:
    """Join the domain; takes a tenth of a second or more, most of it the import of rclpy.

    `discovery` is `localhost`, `subnet`, or the addresses of the peers to be found; `role` and
    `owner`, a process, if it is not this one, are part of the node's name. Raises ImportError
    without ROS, ValueError for a domain that does not exist, and what rclpy raises.
    """
    if domain not in DOMAINS:
        raise ValueError(f"domain {domain} is not between {DOMAINS[0]} and {DOMAINS[-1]}")
    from rclpy.context import Context
    from rclpy.impl.logging_severity import LoggingSeverity
    from rclpy.logging import set_logger_level
    from rclpy.node import Node
    from rclpy.parameter import Parameter

    keep_room_for_large_messages()
    context = Context()
    silent = Parameter("start_type_description_service", value=False)
    with _environment(_discovery(discovery) | announcing(discovery)):
        # No arguments of the program, no log file, and no output on the terminal: it is a screen.
        context.init(args=[], initialize_logging=False, domain_id=domain)
        set_logger_level("", LoggingSeverity.FATAL)
        node = Node(
            f"{NAME_PREFIX}{role}_{owner or os.getpid()}",
            context=context,
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
            parameter_overrides=[silent],
        )
    return Ros(context, node, node.get_fully_qualified_name())


def subscribe(node: Node, kind: type[Any], topic: str, qos: QoSProfile | int, *, raw: bool = False) -> Subscription:
    """Subscribe for whoever polls the queue: no executor ever spins a node of Deck's. Raises what rclpy raises."""
    from rclpy.event_handler import SubscriptionEventCallbacks

    quiet = SubscriptionEventCallbacks(use_default_callbacks=False)
    # rclpy insists on a callback.
    return node.create_subscription(kind, topic, lambda _message: None, qos, event_callbacks=quiet, raw=raw)


def taken(subscription: Subscription, most: int) -> Iterator[tuple[Any, dict[str, Any]]]:
    """Yield what is in the queue with what is known of it, `most` at most: a publisher may be faster."""
    handle: Any = subscription.handle
    with handle:
        for _ in range(most):
            found = handle.take_message(subscription.msg_type, subscription.raw)
            if found is None:
                return
            yield found


def unsubscribe(node: Node, subscription: Subscription) -> None:
    """End a subscription, and forget it: rclpy keeps a reference for an executor that does not exist here."""
    node.destroy_subscription(subscription)
    entities = node.default_callback_group.entities
    entities.difference_update([each for each in entities if each() is None])


def _discovery(discovery: str | tuple[str, ...]) -> dict[str, str | None]:
    """Return the variables to set, None for those to remove."""
    # The deprecated variable would win over the others.
    if not isinstance(discovery, str):
        peers = ";".join(discovery)
        return {LOCALHOST_ONLY: None, RANGE: "LOCALHOST", PEERS: peers}
    if discovery not in RANGES:
        raise ValueError(f"discovery '{discovery}' is neither of {', '.join(RANGES)}")
    return {LOCALHOST_ONLY: None, RANGE: RANGES[discovery], PEERS: None}


def announcing(discovery: str | tuple[str, ...]) -> dict[str, str | None]:
    """Return the variables for Deck's Fast DDS settings, unless the user has set their own.

    As in `launcher.domain.discovery`. Those that hurry apply to a single machine only: on a network,
    the announcements of a whole class would add up.
    """
    ours = ("", str(FAST_DDS), str(FAST_DDS_OF_PEERS))
    others = os.environ.get(RMW, "") not in FAST_RTPS
    if others or any(os.environ.get(name, "") not in ours for name in FAST_DDS_VARIABLES):
        return {}
    if discovery == "subnet":
        kept = os.environ.get(TRANSPORTS, "UDPv4")
        return {**dict.fromkeys((*FAST_DDS_VARIABLES, ONLY_THESE)), TRANSPORTS: kept}
    local = discovery == "localhost"
    file = str(FAST_DDS if local else FAST_DDS_OF_PEERS)
    reach = "SYSTEM_DEFAULT" if local else "SUBNET"
    return {**dict.fromkeys(FAST_DDS_VARIABLES, file), ONLY_THESE: "1", RANGE: reach}


@contextmanager
def _environment(settings: dict[str, str | None]) -> Iterator[None]:
    """Set variables only while rcl reads them: the screen's children must not inherit them."""
    before = {name: os.environ.get(name) for name in settings}
    _set(settings)
    try:
        yield
    finally:
        _set(before)


def _set(settings: dict[str, str | None]) -> None:
    for name, value in settings.items():
        if value is None:
            os.environ.pop(name, None)
        else:
            os.environ[name] = value
