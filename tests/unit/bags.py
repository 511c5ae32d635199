"""Small bags for tests, written by the library's own writer, with no ROS at hand."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from rosbags.interfaces import Connection, Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

BEGIN_NS = 1_700_000_000_000_000_000
"""Unix time of the first message, unless another is asked for."""
SECOND_NS = 1_000_000_000
BATTERY = "other_msgs/msg/Battery"
BATTERY_TEXT = "float32 volts\nuint8[] cells\nbool charging\nbyte level\nstring[] names\n"
FOREVER = QosTime(9223372036, 854775807)
LATCHED = Qos(
    QosHistory.KEEP_LAST, 1, QosReliability.RELIABLE, QosDurability.TRANSIENT_LOCAL,
    FOREVER, FOREVER, QosLiveliness.AUTOMATIC, FOREVER, False,
)  # fmt: skip


def store() -> Typestore:
    """The types of ROS 2 Jazzy, and one that is installed nowhere."""
    made = get_typestore(Stores.ROS2_JAZZY)
    made.register(get_types_from_msg(BATTERY_TEXT, BATTERY))
    return made


def write_bag(
    folder: Path, seconds: float = 10.0, hz: float = 10.0, storage: StoragePlugin = StoragePlugin.MCAP
) -> Path:
    """A bag with the rising /number, the /battery of an unknown package and a latched /map_name.

    /number counts from 0 at `hz`, from 0 to `seconds`; /battery and /map_name speak once, at 0.
    """
    types = store()
    number, text = types.types["std_msgs/msg/Float32"], types.types["std_msgs/msg/String"]
    battery = types.types[BATTERY]
    with Writer(folder, version=9, storage_plugin=storage) as writer:

        def channel(topic: str, kind: str, offers: Sequence[Qos] = ()) -> Connection:
            return writer.add_connection(topic, kind, typestore=types, offered_qos_profiles=offers)

        numbers = channel("/number", "std_msgs/msg/Float32")
        batteries = channel("/battery", BATTERY)
        names = channel("/map_name", "std_msgs/msg/String", [LATCHED])

        def put(connection: Connection, message: object, kind: str, at_s: float) -> None:
            raw = bytes(types.serialize_cdr(message, kind))
            writer.write(connection, BEGIN_NS + int(at_s * SECOND_NS), raw)

        put(names, text(data="kitchen"), "std_msgs/msg/String", 0.0)
        cells = np.array([1, 2, 3], dtype=np.uint8)
        full = battery(volts=12.5, cells=cells, charging=True, level=7, names=["a", "b"])
        put(batteries, full, BATTERY, 0.0)
        for count in range(int(seconds * hz) + 1):
            put(numbers, number(data=float(count)), "std_msgs/msg/Float32", count / hz)
    return folder


def write_robot_bag(folder: Path, silent: Sequence[str] = ()) -> Path:
    """A bag of ten seconds in which a robot drives: sonar, wheels, and one line of /rosout.

    `silent`: topics for words that nobody has said.
    """
    types = store()
    made = types.types
    joint, header, stamp = (
        made[name] for name in ("sensor_msgs/msg/JointState", "std_msgs/msg/Header", "builtin_interfaces/msg/Time")
    )
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:

        def channel(topic: str, kind: str) -> Connection:
            return writer.add_connection(topic, kind, typestore=types)

        for topic in silent:
            channel(topic, "std_msgs/msg/String")
        sonar = channel("/sensor/sonar_front", "std_msgs/msg/Float32")
        wheels = channel("/wheel_commands", "sensor_msgs/msg/JointState")
        said = made["rcl_interfaces/msg/Log"](
            stamp=stamp(sec=BEGIN_NS // SECOND_NS, nanosec=0),
            level=30,
            name="safety_stop",
            msg="too near",
            file="",
            function="",
            line=0,
        )
        raw = types.serialize_cdr(said, "rcl_interfaces/msg/Log")
        writer.write(channel("/rosout", "rcl_interfaces/msg/Log"), BEGIN_NS, bytes(raw))
        for turn in range(101):
            at_ns = BEGIN_NS + turn * SECOND_NS // 10
            metres = made["std_msgs/msg/Float32"](data=2.0 - turn * 0.015)
            raw = types.serialize_cdr(metres, "std_msgs/msg/Float32")
            writer.write(sonar, at_ns, bytes(raw))
            turned = joint(
                header=header(stamp=stamp(sec=at_ns // SECOND_NS, nanosec=0), frame_id=""),
                name=["rear_left_wheel_joint", "rear_right_wheel_joint", "steering_joint"],
                position=np.array([0.0, 0.0, 0.2]),
                velocity=np.array([8.0, 9.0, 0.0]),
                effort=np.array([]),
            )
            raw = types.serialize_cdr(turned, "sensor_msgs/msg/JointState")
            writer.write(wheels, at_ns, bytes(raw))
    return folder
