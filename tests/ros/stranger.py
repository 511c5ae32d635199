"""`python -m tests.ros.stranger [drive]`: who is not of Deck, with whatever settings he has.

Each line that it prints is what it has seen so far: names of nodes, and the fastest wheel.
"""

from __future__ import annotations

import contextlib
import json
import sys

import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import JointState

PERIOD_S = 0.1
SPEED_M_S = 0.3


class Stranger(Node):
    """Looks on, and drives if told to."""

    def __init__(self, *, drives: bool) -> None:
        super().__init__("stranger", start_parameter_services=False, enable_rosout=False)
        self._nodes: set[str] = set()
        self._fastest = 0.0
        self._orders = self.create_publisher(AckermannDriveStamped, "/drive", 1) if drives else None
        self.create_subscription(JointState, "/wheel_commands", self._hear, 10)
        self.create_timer(PERIOD_S, self._tell)

    def _hear(self, message: JointState) -> None:
        self._fastest = max(self._fastest, *(abs(speed) for speed in message.velocity))

    def _tell(self) -> None:
        self._nodes.update(name for name in self.get_node_names() if name != "stranger")
        seen = {"nodes": sorted(self._nodes), "fastest": self._fastest}
        print(json.dumps(seen), flush=True)  # noqa: T201
        if self._orders:
            order = AckermannDriveStamped()
            order.header.stamp = self.get_clock().now().to_msg()
            order.drive.speed = SPEED_M_S
            self._orders.publish(order)


if __name__ == "__main__":
    rclpy.init()
    with contextlib.suppress(ExternalShutdownException):
        rclpy.spin(Stranger(drives="drive" in sys.argv))
