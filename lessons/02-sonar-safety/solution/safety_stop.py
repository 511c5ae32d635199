import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float32


class SafetyStop(Node):
    def __init__(self):
        super().__init__("safety_stop")
        self.declare_parameter("stop_distance", 0.5)
        self.create_subscription(Float32, "/sensor/sonar_front", self.on_distance, 10)
        self.get_logger().info("the safety node is on guard")

    def on_distance(self, message):
        stop_distance = self.get_parameter("stop_distance").value
        if message.data < stop_distance:
            self.get_logger().warning(f"STOP: an obstacle at {message.data:.3f} m")
        else:
            self.get_logger().info(f"the path is clear: {message.data:.3f} m")


def main(args=None):
    rclpy.init(args=args)
    node = SafetyStop()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
