"""As in the course."""

from typing import Any

import rclpy
from cv_bridge import CvBridge
from rclpy.node import Node
from sensor_msgs.msg import Image


class VlmAgent(Node):
    """Keeps the newest picture, and tells its size every three seconds."""

    def __init__(self) -> None:
        super().__init__("vlm_agent")
        self.bridge = CvBridge()
        self.image: Any = None
        self.create_subscription(Image, "/camera/color/image_raw", self.keep, 10)
        self.create_timer(3.0, self.ask)

    def keep(self, message: Image) -> None:
        self.image = self.bridge.imgmsg_to_cv2(message, desired_encoding="bgr8")

    def ask(self) -> None:
        if self.image is None:
            self.get_logger().warning("no picture yet")
        else:
            height, width, _ = self.image.shape
            self.get_logger().info(f"a picture of {width}x{height}")


def main() -> None:
    rclpy.init()
    node = VlmAgent()
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
