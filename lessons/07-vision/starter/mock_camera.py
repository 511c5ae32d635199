import cv2
import numpy as np
import rclpy
from cv_bridge import CvBridge
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Image


class MockCamera(Node):
    def __init__(self):
        super().__init__("mock_camera")
        self.bridge = CvBridge()
        self.count = 0
        # MISSING: a publisher of Image on /camera/color/image_raw, in self.publisher.
        # НЕ ХВАТАЕТ: издателя Image в топике /camera/color/image_raw, в self.publisher.
        # MISSING: a timer that calls self.shoot ten times a second.
        # НЕ ХВАТАЕТ: таймера, который вызывает self.shoot десять раз в секунду.
        self.get_logger().info("the camera is on")  # ru: "камера включена"

    def shoot(self):
        # MISSING: a black picture of 640x480, in three colours of uint8.
        # НЕ ХВАТАЕТ: чёрного кадра 640x480, в трёх цветах uint8.
        # MISSING: the number self.count drawn on it, one more each time.
        # НЕ ХВАТАЕТ: номера self.count на кадре, каждый раз на единицу больше.
        # MISSING: an Image of it, encoding bgr8, published.
        # НЕ ХВАТАЕТ: сообщения Image из него, в кодировке bgr8, и публикации.
        pass


def main(args=None):
    rclpy.init(args=args)
    node = MockCamera()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
