"""As in the course."""

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Image


class VlmAgent(Node):
    """Keeps the newest picture, and tells its size every three seconds."""

    def __init__(self) -> None:
        super().__init__("vlm_agent")
        self.image: Image | None = None
        self.create_subscription(Image, "/camera/color/image_raw", self.keep, 10)
        self.create_timer(3.0, self.ask)

    def keep(self, message: Image) -> None:
        self.image = message

    def ask(self) -> None:
        if self.image is None:
            self.get_logger().warning("no picture yet")
        else:
            self.get_logger().info(f"a picture of {self.image.width}x{self.image.height}")


def main() -> None:
    rclpy.init()
    node = VlmAgent()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
