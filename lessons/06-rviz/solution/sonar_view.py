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
        self.broadcaster.sendTransform(self.place())

    def place(self):
        transform = TransformStamped()
        transform.header.stamp = self.get_clock().now().to_msg()
        transform.header.frame_id = "base_link"
        transform.child_frame_id = FRAME
        transform.transform.translation.x = 0.2
        transform.transform.translation.z = 0.1
        transform.transform.rotation.w = 1.0
        return transform

    def on_distance(self, message):
        reading = Range()
        reading.header.stamp = self.get_clock().now().to_msg()
        reading.header.frame_id = FRAME
        reading.range = message.data
        reading.field_of_view = math.radians(25)
        reading.min_range = 0.2
        reading.max_range = 3.0
        self.ranges.publish(reading)
        marker = Marker()
        marker.header = reading.header
        marker.type = Marker.SPHERE
        marker.pose.position.x = message.data
        marker.pose.orientation.w = 1.0
        marker.scale.x = marker.scale.y = marker.scale.z = 0.1
        marker.color.r = 1.0
        marker.color.a = 1.0
        self.markers.publish(marker)


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
