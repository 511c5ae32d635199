"""What `echo`, `hz`, `bw` and `delay` do first: find the type of a topic, and subscribe to it."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from ros2 import naming

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

    from ros2.joining import Guest

AGAIN_S = 0.1
OTHERS_S = 5.0
"""So long are a topic's other publishers waited for once there is one, while somebody is there who
has not told all: Fast DDS announces a participant each 3 s."""


def type_of(me: Guest, topic: str) -> type[Any] | None:
    """Return the class of a topic's messages, None if the topic does not appear for a while."""
    full, found = naming.expanded(topic, me.node), list[str]()

    def there() -> bool:
        found[:] = naming.types_of_topic(full, me.node)
        return bool(found)

    if not me.await_until(there):
        return None
    if len(found) > 1:
        raise RuntimeError(f"Cannot echo topic '{topic}', as it contains more than one type: [{', '.join(found)}]")
    return naming.message_class(found[0])


def awaited_type(me: Guest, topic: str) -> type[Any]:
    """Return the class of a topic's messages, however long it takes the topic to appear."""
    cls = type_of(me, topic)
    if cls is None:
        print(f"WARNING: topic [{topic}] does not appear to be published yet", flush=True)
    while cls is None:
        time.sleep(AGAIN_S)
        cls = type_of(me, topic)
    return cls


def matching_qos(me: Guest, topic: str, *, words: bool = True) -> QoSProfile:
    """Return the strongest request that all publishers of a topic meet; `words`: say if not all."""
    import copy

    from rclpy.qos import DurabilityPolicy, ReliabilityPolicy, qos_profile_sensor_data

    full = naming.expanded(topic, me.node)
    if me.await_until(lambda: me.node.count_publishers(full) > 0):
        me.settle(OTHERS_S)
        me.forgive()
    profile = copy.copy(qos_profile_sensor_data)
    ends = me.node.get_publishers_info_by_topic(full)
    if not ends:
        return profile
    offers = [end.qos_profile for end in ends]
    for policy, strong, weak in (
        ("reliability", ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT),
        ("durability", DurabilityPolicy.TRANSIENT_LOCAL, DurabilityPolicy.VOLATILE),
    ):
        count = sum(getattr(offer, policy) == strong for offer in offers)
        if 0 < count < len(offers) and words:
            print(
                f'Some, but not all, publishers on topic "{topic}" are offering {strong!s}. '
                f"Falling back to {weak!s} as it will connect to all publishers",
                flush=True,
            )
        setattr(profile, policy, strong if count == len(offers) else weak)
    return profile
