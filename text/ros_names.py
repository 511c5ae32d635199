"""The names of ROS: which characters they may have, and those that any robot has.

Source: design.ros2.org/articles/topic_and_service_names.html.
"""

from __future__ import annotations

import re

_PART = r"[A-Za-z_]\w*"
ROS_NAME = re.compile(rf"[~/]?{_PART}(/{_PART})*", re.ASCII)
"""Of a topic, service or action; without a slash in front it is relative."""
TOPIC_NAME = re.compile(rf"/{_PART}(/{_PART})*", re.ASCII)
"""The full name of a topic."""
TF, TF_STATIC = "/tf", "/tf_static"
"""Where tf2 listens, in whichever namespace a node is."""
DIAGNOSTICS = "/diagnostics"
GOAL_POSE, INITIAL_POSE = "/goal_pose", "/initialpose"
"""Where RViz says them, and navigation hears them."""
ROBOT_DESCRIPTION = "/robot_description"
"""The robot as URDF, std_msgs/String, latched."""
