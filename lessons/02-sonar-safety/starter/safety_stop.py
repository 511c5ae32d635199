import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float32


class SafetyStop(Node):
    def __init__(self):
        super().__init__("safety_stop")
        self.declare_parameter("stop_distance", 0.5)
        # MISSING: a subscription to /sensor/sonar_front that calls self.on_distance.
        # НЕ ХВАТАЕТ: подписки на /sensor/sonar_front, которая вызывает self.on_distance.
        self.get_logger().info("the safety node is on guard")  # ru: "узел безопасности следит за расстоянием"

    def on_distance(self, message):
        # MISSING: below stop_distance a warning with the distance, otherwise info.
        # НЕ ХВАТАЕТ: если ближе stop_distance — warning с расстоянием, иначе info.
        pass


def main(args=None):
    rclpy.init(args=args)
    node = SafetyStop()
    # MISSING: catch Ctrl-C around spin, and end without an error.
    # НЕ ХВАТАЕТ: перехватить Ctrl-C вокруг spin и завершиться без ошибки.
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
