"""Where the names of ROS live: which module has `Node`, which package `Twist`; what Deck does not bring."""

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
OF_ROS1 = (
    "rospy", "roslib", "rosbag", "tf", "actionlib", "roslaunch", "dynamic_reconfigure",
    "tf_conversions", "moveit_commander", "ros_numpy", "rosgraph", "rosmsg", "rosnode", "rosparam",
    "rosserial_msgs", "rosserial_python", "rosservice", "rostopic",
)  # fmt: skip
OF_ROS = (
    "action_tutorials_interfaces", "action_tutorials_py", "actionlib_msgs", "ament_copyright",
    "ament_flake8", "ament_index_python", "ament_pep257", "apriltag_msgs", "audio_common_msgs",
    "camera_calibration", "can_msgs", "cartographer_ros_msgs", "control_msgs", "controller_manager",
    "controller_manager_msgs", "demo_nodes_py", "depthai_ros_msgs", "diagnostic_aggregator",
    "diagnostic_updater", "domain_coordinator", "dwb_msgs", "event_camera_msgs",
    "examples_rclpy_executors", "examples_rclpy_minimal_action_client",
    "examples_rclpy_minimal_action_server", "examples_rclpy_minimal_client",
    "examples_rclpy_minimal_publisher", "examples_rclpy_minimal_service",
    "examples_rclpy_minimal_subscriber", "foxglove_msgs", "gazebo_msgs", "geographic_msgs",
    "gps_msgs", "grid_map_msgs", "image_geometry", "image_transport", "irobot_create_msgs",
    "joint_state_publisher", "laser_geometry", "launch", "launch_pytest", "launch_ros",
    "launch_testing", "launch_xml", "launch_yaml", "map_msgs", "mavros", "mavros_msgs",
    "message_filters", "micro_ros_msgs", "moveit", "moveit_configs_utils", "moveit_msgs",
    "nav2_common", "nav2_msgs", "nav2_simple_commander", "nav_2d_msgs", "nmea_msgs",
    "object_recognition_msgs", "octomap_msgs", "pcl_msgs", "py_trees", "py_trees_ros", "PyKDL",
    "python_qt_binding", "qt_gui", "radar_msgs", "rclpy_message_converter",
    "realsense2_camera_msgs", "rmf_task_msgs", "robot_localization", "ros2action", "ros2bag",
    "ros2cli", "ros2doctor", "ros2interface", "ros2launch", "ros2lifecycle", "ros2node",
    "ros2param", "ros2pkg", "ros2run", "ros2service", "ros2topic", "ros_gz_interfaces", "rosapi",
    "rosapi_msgs", "rosbag2_interfaces", "rosbag2_py", "rosbridge_library", "rosbridge_msgs",
    "rosidl_runtime_py", "rqt", "rqt_graph", "rqt_gui", "rqt_gui_py", "rqt_plot", "rtabmap_msgs",
    "sensor_msgs_py", "slam_toolbox", "sros2", "statistics_msgs", "teleop_twist_keyboard",
    "test_msgs", "tf2_kdl", "tf2_sensor_msgs", "tf2_tools", "tf_transformations",
    "tracetools_trace", "turtle_tf2_py", "turtlebot3_msgs", "turtlebot4_msgs", "turtlesim",
    "ublox_msgs", "ur_msgs", "urdf_parser_py", "velodyne_msgs", "vision_msgs", "webots_ros2_driver",
    "webots_ros2_msgs", "xacro",
)  # fmt: skip
"""Packages of ROS that Deck does not bring."""
_PACKAGED = {
    "moveit": "moveit-py", "PyKDL": "python-orocos-kdl-vendor", "urdf_parser_py": "urdfdom-py",
}  # fmt: skip
"""Where it is not called as what is imported."""
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


def apt_name(name: str) -> str:
    """Return what follows `ros-jazzy-` in the name of the package with this module."""
    return _PACKAGED.get(name, name.replace("_", "-"))
