import rclpy
from cv_bridge import CvBridge
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Image


class VlmAgentStub(Node):
    def __init__(self):
        super().__init__("vlm_agent")
        self.bridge = CvBridge()
        self.newest = None
        self.create_subscription(Image, "/camera/color/image_raw", self.on_picture, 10)
        self.create_timer(3.0, self.look)
        self.get_logger().info("waiting for pictures")

    def on_picture(self, message):
        self.newest = self.bridge.imgmsg_to_cv2(message, desired_encoding="bgr8")

    def look(self):
        if self.newest is None:
            self.get_logger().warning("there is no picture yet")
            return
        self.get_logger().info("a picture of 640x480 would go to the model now")


def main(args=None):
    rclpy.init(args=args)
    node = VlmAgentStub()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
