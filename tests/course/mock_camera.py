"""As in the course."""

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Image


class MockCamera(Node):
    """Ten pictures a second, without a stamp or a frame."""

    def __init__(self) -> None:
        super().__init__("mock_camera")
        self.publisher = self.create_publisher(Image, "/camera/color/image_raw", 10)
        self.create_timer(0.1, self.shoot)

    def shoot(self) -> None:
        image = Image(height=480, width=640, encoding="bgr8", step=3 * 640)
        image.data = bytes(480 * 640 * 3)
        self.publisher.publish(image)


def main() -> None:
    rclpy.init()
    node = MockCamera()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
