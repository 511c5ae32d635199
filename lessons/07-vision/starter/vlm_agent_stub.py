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
        # MISSING: a subscription to /camera/color/image_raw that calls self.on_picture.
        # НЕ ХВАТАЕТ: подписки на /camera/color/image_raw, которая вызывает self.on_picture.
        # MISSING: a timer that calls self.look every 3 seconds.
        # НЕ ХВАТАЕТ: таймера, который вызывает self.look раз в 3 секунды.
        self.get_logger().info("waiting for pictures")  # ru: "жду кадров"

    def on_picture(self, message):
        # MISSING: the picture as an array, kept in self.newest.
        # НЕ ХВАТАЕТ: кадра в виде массива, в self.newest.
        pass

    def look(self):
        # MISSING: a warning if there is no picture yet; otherwise its size, 640x480, with info.
        # НЕ ХВАТАЕТ: warning, если кадров ещё нет; иначе размера, 640x480, через info.
        pass


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
