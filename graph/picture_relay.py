"""The relay of a session over a network: raw pictures of this machine's cameras, small and few.

For each topic of raw images that is published on this machine it offers another one, whose name
begins with that topic's and ends with `graph.pictures.source.THINNED`. While somebody listens
there, and only then, it takes the raw pictures, and publishes what a terminal can
draw: see `graph.pictures.compressed`. It runs until its stdin ends.
"""

from __future__ import annotations

import os
import select
import sys
import time
from typing import TYPE_CHECKING

from graph.heavy_types import COMPRESSED_IMAGE, IMAGE
from graph.housekeeping import is_hidden
from graph.messages.types import load_message
from graph.observer.tap import SHALLOW, Tap
from graph.pictures.compressed import thinned_picture
from graph.pictures.pixels import ImageError
from graph.pictures.source import THINNED, host_of, to_see
from graph.qos import BEST_EFFORT, Qos, profile
from graph.ros import open_ros
from graph.scan.endpoints import TopicEnds, publishers
from text.nested import read_json

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    from rclpy.node import Node

    from graph.data import Value
    from graph.ros import Ros

ROLE = "relay"
PICTURE_S = 0.2
"""Between two pictures: a panel draws three a second, and some are lost on the way."""
LOOK_S = 1.0
"""Between two looks at which cameras there are, and whether anybody listens."""
LINGER_S = 10.0
"""How long after the last listener has left the raw pictures are still taken."""
MOST = 16
"""Topics that are offered."""


class ThinnedCamera:
    """The thinned pictures of one topic; close it when the camera is gone."""

    def __init__(self, node: Node, topic: str) -> None:
        from rclpy.event_handler import PublisherEventCallbacks

        self._node = node
        self._topic = topic
        self._message = load_message(COMPRESSED_IMAGE)()
        self._publisher = node.create_publisher(
            type(self._message),
            topic + THINNED,
            profile(Qos(BEST_EFFORT), 1),
            event_callbacks=PublisherEventCallbacks(use_default_callbacks=False),
        )
        self._tap: Tap | None = None
        self._asked_s = 0.0
        """When somebody listened last, on the monotonic clock."""

    @property
    def is_asked_for(self) -> bool:
        """Whether the raw pictures are taken now."""
        return self._tap is not None

    def look(self, ends: TopicEnds) -> None:
        """Begin or cease to take raw pictures, as somebody listens or not."""
        now_s = time.monotonic()
        if self._publisher.get_subscription_count():
            self._asked_s = now_s
            if self._tap is None:
                self._tap = Tap(self._node, self._topic, IMAGE, to_see(ends), SHALLOW)
        elif self._tap is not None and now_s - self._asked_s > LINGER_S:
            self._tap.close()
            self._tap = None

    def step(self) -> None:
        """Pass the newest picture on, if there is one."""
        samples = () if self._tap is None else self._tap.drain(one_publisher=True, decode=1)
        for sample in samples[-1:]:
            try:
                self._message.format, self._message.data = thinned_picture(sample.value)
            except ImageError:
                continue  # The raw picture's viewers report what is wrong with it.
            _copy_header(sample.value, self._message.header)
            self._publisher.publish(self._message)

    def close(self) -> None:
        if self._tap is not None:
            self._tap.close()
        self._node.destroy_publisher(self._publisher)


class PictureRelay:
    """All offers, kept in step with the graph."""

    def __init__(self, ros: Ros) -> None:
        self._node = ros.node
        self._name = ros.name
        self._offers: dict[str, ThinnedCamera] = {}

    @property
    def is_asked_for(self) -> bool:
        return any(offer.is_asked_for for offer in self._offers.values())

    def look(self) -> None:
        """Offer what the cameras of this machine publish, and no more what they do not."""
        cameras = self._cameras()
        for topic in self._offers.keys() - cameras.keys():
            self._offers.pop(topic).close()
        for topic, ends in cameras.items():
            if topic not in self._offers and len(self._offers) < MOST:
                self._offers[topic] = ThinnedCamera(self._node, topic)
            if topic in self._offers:
                self._offers[topic].look(ends)

    def step(self) -> None:
        for offer in self._offers.values():
            offer.step()

    def _cameras(self) -> dict[str, TopicEnds]:
        found = {}
        own = {end for end in publishers(self._node, "/parameter_events") if end.node == self._name}
        hosts = {host_of(end) for end in own}
        for name, types in self._node.get_topic_names_and_types():
            if IMAGE in types and not is_hidden(name):
                here = [end for end in publishers(self._node, name) if host_of(end) in hosts]
                if here:
                    found[name] = TopicEnds(name, tuple(types), tuple(here))
        return found


def main() -> None:
    """Relay in the domain, and with the discovery, given as JSON, until stdin ends."""
    domain, discovery = read_json(sys.argv[1])
    ros = open_ros(domain, discovery if isinstance(discovery, str) else tuple(discovery), ROLE)
    try:
        relay, look_s = PictureRelay(ros), 0.0
        while True:
            now_s = time.monotonic()
            if now_s >= look_s:
                relay.look()
                look_s = now_s + LOOK_S
            relay.step()
            wait_s = PICTURE_S if relay.is_asked_for else LOOK_S
            if select.select([0], [], [], wait_s)[0] and not os.read(0, 1):
                return
    finally:
        ros.close()


def _copy_header(value: Mapping[str, Value], header: Any) -> None:  # noqa: ANN401 - made by rosidl
    said: Any = value["header"]
    header.frame_id = said["frame_id"]
    header.stamp.sec, header.stamp.nanosec = said["stamp"]["sec"], said["stamp"]["nanosec"]


if __name__ == "__main__":
    main()
