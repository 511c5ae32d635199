import math

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Range
from std_msgs.msg import Float32
from tf2_ros import StaticTransformBroadcaster
from visualization_msgs.msg import Marker

FRAME = "sonar_front_link"


class SonarView(Node):
    def __init__(self):
        super().__init__("sonar_view")
        self.broadcaster = StaticTransformBroadcaster(self)
        self.ranges = self.create_publisher(Range, "/sonar/range", 10)
        self.markers = self.create_publisher(Marker, "/sonar/obstacle", 10)
        self.create_subscription(Float32, "/sensor/sonar_front", self.on_distance, 10)
        # MISSING: send self.place() with the broadcaster.
        # НЕ ХВАТАЕТ: отправить self.place() через рассыльщик.

    def place(self):
        transform = TransformStamped()
        transform.header.stamp = self.get_clock().now().to_msg()
        # MISSING: base_link -> sonar_front_link, x 0.2, z 0.1, not turned.
        # НЕ ХВАТАЕТ: base_link -> sonar_front_link, x 0.2, z 0.1, без поворота.
        return transform

    def on_distance(self, message):
        reading = Range()
        # MISSING: header (stamp and frame_id), range, field_of_view, min_range, max_range;
        # publish it with self.ranges.
        # НЕ ХВАТАЕТ: header (stamp и frame_id), range, field_of_view, min_range, max_range;
        # публикации через self.ranges.
        marker = Marker()
        # MISSING: header, type, pose.position.x, scale (x, y, z), color (with a);
        # publish it with self.markers.
        # НЕ ХВАТАЕТ: header, type, pose.position.x, scale (x, y, z), color (вместе с a);
        # публикации через self.markers.


def main(args=None):
    rclpy.init(args=args)
    node = SonarView()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
