import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class HelloNode(Node):
    def __init__(self):
        super().__init__("hello")
        self.get_logger().info("Hello, ROS 2!")
        self.declare_parameter("period", 1)
        period = self.get_parameter("period").value
        self.count = 0
        self.create_timer(period, self.tick)

    def tick(self):
        self.count += 1
        self.get_logger().info(f"tick {self.count}")


def main(args=None):
    rclpy.init(args=args)
    node = HelloNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
