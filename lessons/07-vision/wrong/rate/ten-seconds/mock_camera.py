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
        self.publisher = self.create_publisher(Image, "/camera/color/image_raw", 10)
        self.create_timer(1.0, self.shoot)
        self.get_logger().info("the camera is on")

    def shoot(self):
        picture = np.zeros((480, 640, 3), dtype=np.uint8)
        text = f"picture {self.count}"
        cv2.putText(picture, text, (50, 240), cv2.FONT_HERSHEY_SIMPLEX, 1, (0, 255, 0), 2)
        self.count += 1
        self.publisher.publish(self.bridge.cv2_to_imgmsg(picture, encoding="bgr8"))


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
