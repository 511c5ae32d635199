"""A listener that subscribes to everything the serial drivers publish, until SIGINT."""

from __future__ import annotations

import contextlib

import rclpy
from nav_msgs.msg import Odometry
from rclpy.executors import ExternalShutdownException
from sensor_msgs.msg import JointState, Range
from std_msgs.msg import Float32
from tf2_msgs.msg import TFMessage

TOPICS = {
    "/joint_states": JointState,
    "/odom": Odometry,
    "/tf": TFMessage,
    "/sensor/sonar_front": Float32,
    "/sensor/sonar_front/range": Range,
    "/sensor/sonar_rear": Float32,
    "/sensor/sonar_rear/range": Range,
}


def main() -> None:
    rclpy.init()
    node = rclpy.create_node("listener")
    for topic, kind in TOPICS.items():
        node.create_subscription(kind, topic, lambda _message: None, 10, raw=True)
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)


if __name__ == "__main__":
    main()
