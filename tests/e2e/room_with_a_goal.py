"""A node with a latched map, which says what goals it hears."""

from __future__ import annotations

import math
import sys

import rclpy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
CELLS = 20


class Room(Node):
    """Publishes a map with walls around it."""

    def __init__(self) -> None:
        super().__init__("room")
        grid = OccupancyGrid()
        grid.header.frame_id = "hall"
        grid.info.width = grid.info.height = CELLS
        grid.info.resolution = 0.2
        grid.data = [
            100 if {row, column} & {0, CELLS - 1} else 0
            for row in range(CELLS)
            for column in range(CELLS)
        ]
        self._map = self.create_publisher(OccupancyGrid, "/map", LATCHED)
        self._map.publish(grid)
        self.create_subscription(PoseStamped, "/goal_pose", self._hear, 1)

    def _hear(self, goal: PoseStamped) -> None:
        turn = goal.pose.orientation
        degrees = math.degrees(2 * math.atan2(turn.z, turn.w))
        sys.stdout.write(f"goal in {goal.header.frame_id}, facing {degrees:.0f} degrees\n")
        sys.stdout.flush()


if __name__ == "__main__":
    rclpy.init()
    rclpy.spin(Room())
