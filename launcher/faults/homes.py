"""Where the names of ROS live: which module has `Node`, which package `Twist`; ROS 1's names."""

from __future__ import annotations

import importlib
import importlib.util
import re
from typing import TYPE_CHECKING

from text.i18n import N_
from text.sentences import say

if TYPE_CHECKING:
    from text.sentences import Words

MODULES = (
    "rclpy.node", "rclpy.qos", "rclpy.time", "rclpy.duration", "rclpy.executors", "rclpy.action",
    "rclpy.callback_groups", "rclpy.parameter", "rclpy.clock", "rclpy.exceptions", "rclpy.logging",
    "tf2_ros", "cv_bridge",
)  # fmt: skip
PACKAGES = (
    "std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs", "std_srvs", "example_interfaces",
    "builtin_interfaces", "diagnostic_msgs", "visualization_msgs", "trajectory_msgs",
    "rcl_interfaces", "ackermann_msgs", "tf2_msgs", "deck_interfaces", "action_msgs",
)  # fmt: skip
KINDS = ("msg", "srv", "action")
ROS1 = {
    "init_node": N_("rclpy.init(), and a class of its own: class MyNode(Node)"),
    "Publisher": N_('self.create_publisher(String, "topic", 10), in a node'),
    "Subscriber": N_('self.create_subscription(String, "topic", self.callback, 10), in a node'),
    "Service": N_('self.create_service(AddTwoInts, "name", self.callback), in a node'),
    "ServiceProxy": N_('self.create_client(AddTwoInts, "name"), in a node'),
    "Timer": N_("self.create_timer(0.5, self.on_timer), in a node"),
    "Rate": N_("self.create_timer(0.1, self.on_timer), in a node, instead of a loop"),
    "sleep": N_("self.create_timer(0.5, self.on_timer), in a node, instead of waiting"),
    "loginfo": "self.get_logger().info(…)",
    "logwarn": "self.get_logger().warn(…)",
    "logerr": "self.get_logger().error(…)",
    "get_param": "self.declare_parameter(name, default).value",
    "is_shutdown": "rclpy.ok()",
    "get_time": "self.get_clock().now()",
    "Time": N_("rclpy.time.Time, or self.get_clock().now()"),
    "ROSInterruptException": "rclpy.executors.ExternalShutdownException",
    "wait_for_message": N_("self.create_subscription(…), and a callback"),
}
"""Names of rospy, and what is written in ROS 2 instead."""


def ros1(name: str) -> Words:
    """Say what takes the place of a name of ROS 1."""
    return say("{name} is of ROS 1. In ROS 2 it is: {instead}.", name=name, instead=say(ROS1[name]))


def home_of(name: str, not_in: str = "") -> str:
    """Return the module that has a class of this name, empty if none of ROS has it."""
    if not re.fullmatch(r"[A-Z]\w*", name):
        return ""
    inside = not_in.partition(".")[0]
    packages = sorted(PACKAGES, key=lambda each: each != inside)
    places = [*MODULES, *(f"{package}.{kind}" for package in packages for kind in KINDS)]
    if inside in PACKAGES:
        places = places[len(MODULES) :] + places[: len(MODULES)]
    return next((each for each in places if each != not_in and _has(each, name)), "")


def _has(module: str, name: str) -> bool:
    try:
        if importlib.util.find_spec(module) is None:
            return False
        found = getattr(importlib.import_module(module), name, None)
        return isinstance(found, type) and found.__module__.startswith(module)
    except Exception:  # noqa: BLE001 - whatever is wrong there, it is not what the learner asks
        return False
