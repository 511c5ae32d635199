"""A recording of real messages, and independent readers to look at it."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

from mcap.reader import make_reader
from rosbags.rosbag2 import Reader

from graph.recording.recorder import RecordedTopic, Recorder
from tests.waiting import wait_until


def messages_of(recorder: Recorder, topic: str) -> int:
    """How many messages of a topic are in the recording so far."""
    found = row_of(recorder, topic)
    return found.messages if found else 0


def row_of(recorder: Recorder, topic: str) -> RecordedTopic | None:
    return next((row for row in recorder.status.topics if row.name == topic), None)


def wait_for_topic(recorder: Recorder, topic: str) -> None:
    wait_until(lambda: row_of(recorder, topic), f"{topic} is recorded")


def read_by_mcap(folder: Path) -> dict[str, list[bytes]]:
    """Topic to its raw messages, as the library of Foxglove's finds them."""
    found: dict[str, list[bytes]] = defaultdict(list)
    with next(folder.glob("*.mcap")).open("rb") as file:
        for _schema, channel, message in make_reader(file).iter_messages():
            found[channel.topic].append(message.data)
    return found


def read_by_rosbags(folder: Path) -> dict[str, list[bytes]]:
    """Topic to its raw messages, as rosbags finds them by way of metadata.yaml."""
    found: dict[str, list[bytes]] = defaultdict(list)
    with Reader(folder) as reader:
        for connection, _stamp, raw in reader.messages():
            found[connection.topic].append(bytes(raw))
    return found
