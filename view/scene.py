"""All that is drawn: which topics are wanted, and what each of their messages becomes."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from graph.heavy_types import COMPRESSED_IMAGE, IMAGE
from graph.housekeeping import is_hidden
from graph.pictures.compressed import to_jpeg
from graph.pictures.picture import METRES
from graph.pictures.pixels import ImageError, pixels_of
from graph.pictures.reading import read_picture
from space.reading.fields import NotDrawnError
from text.i18n import localized
from text.plain import plain
from text.ros_names import ROBOT_DESCRIPTION, TF, TF_STATIC
from text.sentences import Words, reason_of, say
from view.shapes import (
    Drawn,
    Frames,
    RobotShapes,
    Trails,
    cloud,
    cone,
    grid,
    many,
    marker,
    newest_of,
    path,
    posed,
    ray,
    scan,
    several,
    topic_path,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    import numpy as np
    from numpy.typing import NDArray

    from graph.data import Sample, TopicRow
    from view.shapes import Message

    Reader = Callable[[str, Message], Iterable[Drawn]]

# ---------------------------------------------------------------- words

LOG = "log"
"""The root of all log lines in the tree of entities."""
OURS = "deck"
LEVELS = ((50, "CRITICAL"), (40, "ERROR"), (30, "WARN"), (20, "INFO"), (0, "DEBUG"))
"""Least numbers of `rcl_interfaces/msg/Log` and Rerun's names."""
LONGEST, LONGEST_NODE = 4000, 200


def rosout(topic: str, message: Message) -> list[Drawn]:
    """Return a line of a node."""
    import rerun

    del topic
    number = int(message["level"])
    level = next(name for least, name in LEVELS if number >= least)
    node = plain(str(message["name"]), LONGEST_NODE) or "?"
    line = rerun.TextLog(plain(str(message["msg"]), LONGEST), level=level)
    return [Drawn((LOG, node), (line,))]


def remark(words: str) -> Drawn:
    """Return a line of Deck's own."""
    import rerun

    return Drawn((LOG, OURS), (rerun.TextLog(plain(words, LONGEST), level="WARN"),))


# ---------------------------------------------------------------- pictures

PICTURES = "pictures"
"""The root of all pictures in the tree of entities."""
AS_IT_IS = {b"\xff\xd8\xff": "image/jpeg", b"\x89PNG": "image/png"}
"""The first bytes of what the viewer decodes itself."""


def image(topic: str, message: Message, *, compact: bool) -> list[Drawn]:
    """Return a `sensor_msgs/Image`, as JPEG if it is to be `compact`. Raises ImageError."""
    import rerun

    if message["encoding"] in METRES:
        metre = 1 / METRES[message["encoding"]]
        shape = rerun.DepthImage(_numbers(message), meter=metre)
    else:
        shape = _picture(IMAGE, message, compact=compact)
    return [Drawn(topic_path(PICTURES, topic), (shape,))]


def compressed(topic: str, message: Message, *, compact: bool) -> list[Drawn]:
    """Return a `sensor_msgs/CompressedImage`, still compressed if that will do.

    Raises ImageError.
    """
    import rerun

    data = bytes(message["data"])
    kind = next((kind for first, kind in AS_IT_IS.items() if data.startswith(first)), "")
    if kind and compact:
        shape = rerun.EncodedImage(contents=data, media_type=kind)
    else:
        shape = _picture(COMPRESSED_IMAGE, message, compact=compact)
    return [Drawn(topic_path(PICTURES, topic), (shape,))]


def _picture(type_name: str, message: Message, *, compact: bool) -> Any:  # noqa: ANN401
    import rerun

    rgb = read_picture(type_name, message, lambda width, height: (width, height)).rgb
    if compact:
        return rerun.EncodedImage(contents=to_jpeg(rgb), media_type="image/jpeg")
    # A viewer on this machine shows them at once, and would take longer to decode them.
    return rerun.Image(rgb)


def _numbers(message: Message) -> NDArray[np.generic]:
    """Return the pixels of a depth image, shape (height, width)."""
    numbers = pixels_of(message)[:, :, 0]
    # Rerun reads the machine's own order of bytes.
    return numbers.astype(numbers.dtype.newbyteorder("="))


# ---------------------------------------------------------------- numbers

PLOTS = "plots"
"""The root of all numbers in the tree of entities."""
LONGEST_JOINT = 80
MOST_JOINTS = 64


def numbers(type_name: str, topic: str, message: Message) -> list[Drawn]:
    """Return the numbers of a message of one of `PLOTTED`, without those that are none."""
    import rerun

    return [
        Drawn(topic_path(PLOTS, topic, *name), (rerun.Scalars(number),))
        for name, number in PLOTTED[type_name](message)
        if math.isfinite(number)
    ]


_Named = tuple[tuple[str, ...], float]


def _data(message: Message) -> Iterator[_Named]:
    yield (), float(message["data"])


def _range(message: Message) -> Iterator[_Named]:
    yield (), float(message["range"])


def _twist(message: Message) -> Iterator[_Named]:
    yield ("linear_x",), float(message["linear"]["x"])
    yield ("angular_z",), float(message["angular"]["z"])


def _odometry(message: Message) -> Iterator[_Named]:
    yield from _twist(message["twist"]["twist"])


def _steered(message: Message) -> Iterator[_Named]:
    yield ("speed",), float(message["drive"]["speed"])
    yield ("steering_angle",), float(message["drive"]["steering_angle"])


def _joints(message: Message) -> Iterator[_Named]:
    for name, position in zip(message["name"][:MOST_JOINTS], message["position"], strict=False):
        yield (plain(str(name), LONGEST_JOINT),), float(position)


def _battery(message: Message) -> Iterator[_Named]:
    yield ("voltage",), float(message["voltage"])


def _twist_stamped(message: Message) -> Iterator[_Named]:
    yield from _twist(message["twist"])


_NUMBERS = ("Float32", "Float64", "Int8", "Int16", "Int32", "UInt8", "UInt16", "UInt32")
PLOTTED: dict[str, Callable[[Message], Iterator[_Named]]] = {
    **dict.fromkeys((f"std_msgs/msg/{name}" for name in _NUMBERS), _data),
    "ackermann_msgs/msg/AckermannDriveStamped": _steered,
    "geometry_msgs/msg/Twist": _twist,
    "geometry_msgs/msg/TwistStamped": _twist_stamped,
    "nav_msgs/msg/Odometry": _odometry,
    "sensor_msgs/msg/BatteryState": _battery,
    "sensor_msgs/msg/JointState": _joints,
    "sensor_msgs/msg/Range": _range,
}
"""Types whose numbers are plotted, and which of them."""


# ---------------------------------------------------------------- all

PICTURE_TYPES = frozenset({IMAGE, COMPRESSED_IMAGE})
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
            COMPRESSED_IMAGE: (partial(compressed, compact=compact),),
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
