"""The graph of lesson 9: who says what to whom, services and an action, and what can go wrong."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from graph.data import ActionRow, EndpointInfo, GraphUpdate, NodeRow, ServiceRow
from tests.tui.recorded_lesson import lesson_update, topic

_OWN = ("/parameter_events", "/rosout")
_ADD = "example_interfaces/srv/AddTwoInts"
_DRIVE_TO = "deck_interfaces/action/DriveToPoint"


def _services(node: str) -> tuple[str, ...]:
    return (f"{node}/get_parameters", f"{node}/list_parameters", f"{node}/set_parameters")


def _node(name: str, says: str = "", hears: str = "", **more: Any) -> NodeRow:
    services = (*more.pop("services", ()), *_services(name))
    return NodeRow(name, (*says.split(), *_OWN), tuple(hears.split()), services=services, **more)


NODE_ROWS = (
    _node("/ai_brain", "/ai_command /audio/speaker_raw",
          "/audio/mic_raw /sensor/sonar_front /camera/color/image_raw",
          clients=("/set_head_position",)),
    _node("/ai_driver", "/drive", "/ai_command"),
    _node("/audio", "/audio/mic_raw", "/audio/speaker_raw"),
    _node("/camera", "/camera/color/image_raw"),
    _node("/drive_to_point", "/drive", "/odom", action_servers=("/drive_to_point",)),
    _node("/electronic_differential", "/wheel_commands", "/drive_safe"),
    _node("/head_controller", "/head_state", services=("/set_head_position",)),
    _node("/lesson_helper", action_clients=("/drive_to_point",)),
    _node("/safety_stop", "/drive_safe /safety_state",
          "/drive /sensor/sonar_front /emergency_stop"),
    _node("/sonar_front", "/sensor/sonar_front"),
)  # fmt: skip

SERVICES = (
    ServiceRow("/set_head_position", (_ADD,), ("/head_controller",)),
    *(
        ServiceRow(f"{row.name}/set_parameters", ("rcl_interfaces/srv/SetParameters",), (row.name,))
        for row in NODE_ROWS
    ),
)
ACTIONS = (ActionRow("/drive_to_point", (_DRIVE_TO,), ("/drive_to_point",), ("/lesson_helper",)),)


def graph_update(**more: Any) -> GraphUpdate:
    """The graph of lesson 9 with all who talk to each other."""
    update = lesson_update(nodes=NODE_ROWS, services=SERVICES, actions=ACTIONS)
    return replace(update, **more)


FLOAT, IMAGE = "std_msgs/msg/Float32", "sensor_msgs/msg/Image"


def _end(node: str, kind: str, reliability: str = "reliable") -> EndpointInfo:
    return EndpointInfo(node, kind, reliability, "volatile")


def ill_graph() -> GraphUpdate:
    """Return a name with a letter missing, QoS that does not fit, a lost service, a slow clock."""
    healthy = graph_update()
    image = "/camera/color/image_raw"
    ill = (
        topic(
            "/sensor/sonar_frnt", FLOAT, None, publishers=0, subscribers=1,
            subscribed_by=(_end("/guard", FLOAT),),
        ),
        topic(
            "/sensor/sonar_front", FLOAT, 1.0, 8, subscribers=2,
            published_by=(_end("/sonar_front", FLOAT),),
        ),
        topic(
            image, IMAGE, 10.0, 921_664, subscribers=1,
            published_by=(_end("/camera", IMAGE, "best_effort"),),
            subscribed_by=(_end("/ai_brain", IMAGE),),
        ),
        topic(
            "/imu", "sensor_msgs/msg/Imu", 50.0, 320, subscribers=0,
            published_by=(_end("/imu_board", "sensor_msgs/msg/Imu"),), latency_s=-2.5,
        ),
    )  # fmt: skip
    names = {row.name for row in ill}
    rows = (*(row for row in healthy.topics if row.name not in names), *ill)
    guard = NodeRow("/guard", subscribes=("/sensor/sonar_frnt",), clients=("/set_head_postion",))
    return replace(
        healthy,
        topics=tuple(sorted(rows, key=lambda row: row.name)),
        nodes=tuple(sorted((*NODE_ROWS, guard), key=lambda row: row.name)),
    )
