"""As in the course."""

import cv2
import numpy as np
import rclpy
from cv_bridge import CvBridge
from rclpy.node import Node
from sensor_msgs.msg import Image


class MockCamera(Node):
    """Ten pictures a second, without a stamp or a frame."""

    def __init__(self) -> None:
        super().__init__("mock_camera")
        self.bridge = CvBridge()
        self.publisher = self.create_publisher(Image, "/camera/color/image_raw", 10)
        self.create_timer(0.1, self.shoot)

    def shoot(self) -> None:
        frame = np.zeros((480, 640, 3), dtype=np.uint8)
        green = (0, 255, 0)
        cv2.putText(frame, "a frame", (50, 240), cv2.FONT_HERSHEY_SIMPLEX, 1, green, 2)
        self.publisher.publish(self.bridge.cv2_to_imgmsg(frame, encoding="bgr8"))


def main() -> None:
    rclpy.init()
    node = MockCamera()
    node.get_logger().info("started")
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
