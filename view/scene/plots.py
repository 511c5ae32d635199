"""Numbers over time: distances, speeds, joints, voltages."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from text.plain import plain
from view.scene.drawn import Drawn, topic_path

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from view.scene.drawn import Message

PLOTS = "plots"
"""The root of all numbers in the tree of entities."""
LONGEST = 80
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
        yield (plain(str(name), LONGEST),), float(position)


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
