"""Lesson 9 as a graph: who says what to whom, with services and an action, as it was seen."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from graph.data import ActionRow, GraphUpdate, NodeRow, ServiceRow
from tests.tui.recorded_lesson import lesson_update

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
