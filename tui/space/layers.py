"""The layers of the picture: one for each topic of a type that can be drawn."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial

from graph.data import GraphUpdate, TopicRow, Trouble
from space.reading.fields import NotDrawnError
from space.reading.kinds import KINDS, LayerKind, LayerReader, NewestReader
from space.reading.robot import ModelReader
from space.reading.scans import read_sonar
from text.robot import robot
from text.ros_names import ROBOT_DESCRIPTION
from text.sentences import reason_of

CLOUD = "sensor_msgs/msg/PointCloud2"
FLOAT, TEXT = "std_msgs/msg/Float32", "std_msgs/msg/String"
FLEETING = frozenset({FLOAT, "sensor_msgs/msg/LaserScan", CLOUD, "sensor_msgs/msg/Range"})
"""Measurements: once nothing more arrives, what came last is no longer so."""

STREAMS = FLEETING | {"nav_msgs/msg/Odometry"}
"""What comes all the time, if it comes at all; the others may be published now and then."""


class SpaceLayer:
    """What one topic shows."""

    def __init__(self, topic: str, type_name: str, kind: LayerKind) -> None:
        self.topic = topic
        self.type_name = type_name
        self.on = True
        self.every = kind.every
        self._takes_all = kind.every or kind.grows
        self.reader: LayerReader = kind.make()
        self.row: TopicRow | None = None
        self.refused = ""
        """Why the newest message cannot be drawn."""
        self.apart = ""
        self.frame = ""
        self.heard = False

    @property
    def is_drawn(self) -> bool:
        if not self.on:
            return False
        return self.type_name not in FLEETING or self.row is None or self.row.trouble is None

    @property
    def rests(self) -> bool:
        """Whether it is silent without a fault, as a goal is until somebody sets one."""
        row = self.row
        if row is None or row.trouble is not Trouble.QUIET:
            return False
        return self.type_name not in STREAMS and row.steady_hz is None

    def read(self, update: GraphUpdate, now_s: float) -> bool:
        """Take the messages of this update; return whether there were any."""
        samples = update.samples.get(self.topic, ())
        for sample in samples if self._takes_all else samples[-1:]:
            self.heard = True
            if sample.type_name != self.type_name:
                continue
            try:
                self.reader.read(sample.value, now_s)
                self.refused = ""
            except NotDrawnError as error:
                self.refused = reason_of(error)
        return bool(samples)

    def forget(self) -> None:
        self.reader.clear()
        self.refused = self.apart = self.frame = ""


class SpaceLayers:
    """All layers, by topic."""

    def __init__(self) -> None:
        self._layers: dict[str, SpaceLayer] = {}

    def __iter__(self) -> Iterator[SpaceLayer]:
        return iter(self._layers.values())

    def get(self, topic: str) -> SpaceLayer | None:
        return self._layers.get(topic)

    def see(self, update: GraphUpdate) -> bool:
        """Add and drop layers by the topics there are; return whether any came or went."""
        before = self._layers
        found: dict[str, SpaceLayer] = {}
        for row in update.topics:
            there = row.publishers or row.own_publishers
            known = before.get(row.name)
            if known is not None and (there or known.heard):
                known.row = row
                found[row.name] = known
            elif there and (kind := _kind_of(row.name, row.type_names)):
                found[row.name] = SpaceLayer(row.name, *kind)
                found[row.name].row = row
        for topic, layer in before.items():
            if layer.heard and topic not in found:
                # Its publisher has gone, and with it the topic.
                if layer.row is not None:
                    layer.row = replace(layer.row, publishers=0, trouble=Trouble.NO_PUBLISHER, hz=None)
                found[topic] = layer
        self._layers = dict(sorted(found.items()))
        return self._layers.keys() != before.keys()

    def clear(self) -> None:
        self._layers.clear()

    def watched(self) -> set[str]:
        """Return the topics of which the newest message is needed."""
        return {layer.topic for layer in self if layer.on and not layer.every}

    def followed(self) -> set[str]:
        """Return the topics of which every message is needed."""
        return {layer.topic for layer in self if layer.on and layer.every}


def _kind_of(topic: str, type_names: Iterable[str]) -> tuple[str, LayerKind] | None:
    for name in type_names:
        if name in KINDS:
            return name, KINDS[name]
        if name == TEXT and topic == ROBOT_DESCRIPTION:
            return name, LayerKind(ModelReader)
        if name == FLOAT and topic in robot().frames:
            return name, LayerKind(partial(NewestReader, partial(read_sonar, frame_id=robot().frames[topic])))
    return None
