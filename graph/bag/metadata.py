"""The `metadata.yaml` of a rosbag2 directory, version 9 (ROS 2 Jazzy)."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from pathlib import Path

    from rclpy.duration import Duration
    from rclpy.qos import QoSProfile

VERSION = 9
NANOSECONDS = 10**9
QosOffer: TypeAlias = Mapping[str, Any]
"""One offered QoS profile, with the names that rosbag2 writes."""


@dataclass
class BagTopic:
    """One topic of a bag that is being written."""

    number: int
    """The number of its channel, counted from 1."""
    name: str
    type_name: str
    digest: str
    """`RIHS01_...` of the type; empty if not known."""
    offers: Sequence[QosOffer] = field(default_factory=tuple)
    messages: int = 0
    bytes: int = 0


def qos_offer(profile: QoSProfile) -> QosOffer:
    """Return the QoS that a publisher offers, as rosbag2 writes it."""
    return {
        "history": profile.history.name.lower(),
        "depth": profile.depth,
        "reliability": profile.reliability.name.lower(),
        "durability": profile.durability.name.lower(),
        "deadline": _time(profile.deadline),
        "lifespan": _time(profile.lifespan),
        "liveliness": profile.liveliness.name.lower(),
        "liveliness_lease_duration": _time(profile.liveliness_lease_duration),
        "avoid_ros_namespace_conventions": profile.avoid_ros_namespace_conventions,
    }


def _time(duration: Duration) -> dict[str, int]:
    seconds, nanoseconds = divmod(duration.nanoseconds, NANOSECONDS)
    return {"sec": seconds, "nsec": nanoseconds}


def as_yaml(content: object) -> str:
    """Return YAML with the keys in their given order."""
    import yaml

    text: str = yaml.safe_dump(content, sort_keys=False, default_flow_style=False)
    return text


def information(file: str, topics: Sequence[BagTopic], first_ns: int, last_ns: int) -> dict[str, Any]:
    """Return the metadata of a bag with one MCAP file; times are unix time in nanoseconds."""
    messages = sum(topic.messages for topic in topics)
    span = {"nanoseconds": last_ns - first_ns if messages else 0}
    begun = {"nanoseconds_since_epoch": first_ns if messages else 0}
    return {
        "version": VERSION,
        "storage_identifier": "mcap",
        "duration": span,
        "starting_time": begun,
        "message_count": messages,
        "topics_with_message_count": [_topic(topic) for topic in topics],
        "compression_format": "",
        "compression_mode": "",
        "relative_file_paths": [file],
        "files": [
            # Copies: YAML would write one object in two places as an alias.
            {"path": file, "starting_time": dict(begun), "duration": dict(span), "message_count": messages}
        ],
        "custom_data": None,
        "ros_distro": os.environ.get("ROS_DISTRO", "jazzy"),
    }


def _topic(topic: BagTopic) -> dict[str, Any]:
    return {
        "topic_metadata": {
            "name": topic.name,
            "type": topic.type_name,
            "serialization_format": "cdr",
            "offered_qos_profiles": [dict(offer) for offer in topic.offers],
            "type_description_hash": topic.digest,
        },
        "message_count": topic.messages,
    }


def write(folder: Path, content: Mapping[str, Any]) -> None:
    """Write or replace `metadata.yaml`; a complete one exists at any moment."""
    fresh = folder / "metadata.yaml.new"
    fresh.write_text(as_yaml({"rosbag2_bagfile_information": dict(content)}), encoding="utf-8")
    fresh.replace(folder / "metadata.yaml")
