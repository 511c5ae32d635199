"""All that is drawn: which topics are wanted, and what each of their messages becomes."""

from __future__ import annotations

import time
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from graph.housekeeping import is_hidden
from graph.pictures.picture import COMPRESSED, IMAGE
from graph.pictures.pixels import ImageError
from robot.topics import ROBOT_DESCRIPTION, TF, TF_STATIC
from space.reading.fields import NotDrawnError
from text.i18n import localized
from text.sentences import Words, reason_of, say
from view.scene.clouds import cloud, scan
from view.scene.drawn import Drawn
from view.scene.frames import Frames, newest_of
from view.scene.log import remark, rosout
from view.scene.maps import grid
from view.scene.markers import marker, several
from view.scene.pictures import compressed, image
from view.scene.plots import PLOTTED, numbers
from view.scene.poses import Trails, many, path, posed
from view.scene.ranges import cone, ray
from view.scene.robot import RobotShapes

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from graph.data import Sample, TopicRow
    from view.scene.drawn import Message

    Reader = Callable[[str, Message], Iterable[Drawn]]

PICTURE_TYPES = frozenset({IMAGE, COMPRESSED})
MARKER, MARKERS = "visualization_msgs/msg/Marker", "visualization_msgs/msg/MarkerArray"
LOG_LINE = "rcl_interfaces/msg/Log"
EVERY_ONE = PICTURE_TYPES | {MARKER, MARKERS, LOG_LINE}
"""Pictures, and what later messages do not replace."""
AGAIN_EVERY_S = 5.0
"""As the server forgets what is old."""


class ViewScene:
    """From samples to what is drawn; it remembers frames, trails, and what it has complained of."""

    def __init__(self, *, compact: bool = False) -> None:
        """With `compact`, pictures are compressed, for a viewer behind a slow line."""
        self._frames = Frames()
        self._trails = Trails()
        self._robot = RobotShapes()
        self._again_at_s = 0.0
        self._faults: dict[str, str] = {}
        self._ends_s: dict[tuple[str, ...], float] = {}
        """When what does not last is to be removed, unix time."""
        self._readers: dict[str, tuple[Reader, ...]] = {
            "geometry_msgs/msg/PoseArray": (many,),
            "geometry_msgs/msg/PoseStamped": (posed,),
            "geometry_msgs/msg/PoseWithCovarianceStamped": (posed,),
            "nav_msgs/msg/OccupancyGrid": (grid,),
            "nav_msgs/msg/Odometry": (self._trails.read,),
            "nav_msgs/msg/Path": (path,),
            LOG_LINE: (rosout,),
            "sensor_msgs/msg/LaserScan": (scan,),
            "sensor_msgs/msg/PointCloud2": (cloud,),
            "sensor_msgs/msg/Range": (cone,),
            "std_msgs/msg/Float32": (ray,),
            MARKER: (marker,),
            MARKERS: (several,),
            IMAGE: (partial(image, compact=compact),),
            COMPRESSED: (partial(compressed, compact=compact),),
        }
        for type_name in PLOTTED:
            known = self._readers.get(type_name, ())
            self._readers[type_name] = (*known, partial(numbers, type_name))
        self._by_name: dict[str, Reader] = {
            ROBOT_DESCRIPTION: self._robot.read,
            TF: self._frames.moved,
            TF_STATIC: self._frames.fixed,
        }

    def wanted(self, topics: Iterable[TopicRow]) -> frozenset[str]:
        """Return the topics that can be drawn, of those that somebody publishes."""
        return frozenset(
            row.name
            for row in topics
            if not is_hidden(row.name)
            and (row.name in self._by_name or any(one in self._readers for one in row.type_names))
        )

    def every_one_of(self, topics: Iterable[TopicRow]) -> frozenset[str]:
        """Return those of which every message counts; of the others, the newest will do."""
        return frozenset(
            row.name for row in topics if row.name in (TF, TF_STATIC) or not EVERY_ONE.isdisjoint(row.type_names)
        )

    def seen_small(self, topics: Iterable[TopicRow]) -> frozenset[str]:
        """Return those with pictures that come over a network: the newest, small, will do."""
        return frozenset(row.name for row in topics if row.from_afar and not PICTURE_TYPES.isdisjoint(row.type_names))

    def draw(self, samples: Iterable[Sample]) -> Iterator[tuple[float, Drawn]]:
        """Yield what is drawn, with its time (unix time, seconds), in the order of arrival."""
        now_s = time.time()
        if now_s >= self._again_at_s:
            self._again_at_s = now_s + AGAIN_EVERY_S
            for drawn in (*self._frames.roots(), *self._robot.again()):
                yield now_s, drawn
        for entity in [entity for entity, end_s in self._ends_s.items() if end_s <= now_s]:
            del self._ends_s[entity]
            yield now_s, Drawn(entity, (), recursive=True)
        for sample in sorted(_fewer(samples), key=_arrival_s):
            for drawn in self._read(sample):
                yield _arrival_s(sample), drawn
                if drawn.lifetime_s > 0:
                    self._ends_s[drawn.path] = _arrival_s(sample) + drawn.lifetime_s
                else:
                    self._ends_s.pop(drawn.path, None)

    def _read(self, sample: Sample) -> Iterator[Drawn]:
        own = self._by_name.get(sample.topic)
        readers = (own,) if own else self._readers.get(sample.type_name, ())
        fault = ""
        for reader in readers:
            try:
                yield from self._placed(reader(sample.topic, sample.value))
            except (ImageError, NotDrawnError) as error:  # noqa: PERF203
                fault = reason_of(error)
            except Exception as error:  # noqa: BLE001 - whatever is published under a known name
                fault = say("it cannot be read: {reason}", reason=reason_of(error))
        yield from self._complaint(sample.topic, fault)

    def _placed(self, found: Iterable[Drawn]) -> Iterator[Drawn]:
        """Yield what is drawn, and before it the frames it is in."""
        for drawn in found:
            if drawn.frame:
                yield from self._frames.need(drawn.frame)
            yield drawn

    def _complaint(self, topic: str, fault: str) -> Iterator[Drawn]:
        """Yield what is wrong with a topic, once, until it is right or something else is wrong."""
        before, self._faults[topic] = self._faults.get(topic, ""), fault
        if fault and fault != before:
            words: Words = say("{topic} is not drawn: {fault}", topic=topic, fault=fault)
            yield remark(localized(words))


def _arrival_s(sample: Sample) -> float:
    return sample.received_s - sample.age_s


def _fewer(samples: Iterable[Sample]) -> Iterator[Sample]:
    """Yield the samples, those of /tf put together: fifty a second are too many to draw."""
    moved = []
    for sample in samples:
        if sample.topic == TF:
            moved.append(sample)
        else:
            yield sample
    if len(moved) > 1 and all("transforms" in sample.value for sample in moved):
        yield replace(moved[-1], value=newest_of([sample.value for sample in moved]))
    else:
        yield from moved
