"""The names of ROS: which characters they may have, and three that several rooms know.

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
EMERGENCY_STOP = "/emergency_stop"
"""Where people and screens say that the robot has to stand still."""
