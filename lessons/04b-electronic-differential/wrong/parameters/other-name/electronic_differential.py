import math

import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import JointState


class ElectronicDifferential(Node):
    def __init__(self):
        super().__init__("electronic_differential")
        self.publisher = self.create_publisher(JointState, "/wheel_commands", 10)
        self.create_subscription(AckermannDriveStamped, "/drive", self.on_drive, 10)
        self.declare_parameter("wheelbase", 0.25)
        self.declare_parameter("track_width", 0.15)
        self.watchdog = self.create_timer(0.5, self.on_silence)
        self.get_logger().info("the differential waits for /drive")

    def on_drive(self, message):
        self.watchdog.reset()
        wheelbase = self.get_parameter("wheelbase").value
        track = self.get_parameter("track_width").value
        v = message.drive.speed
        delta = message.drive.steering_angle
        if abs(delta) < 0.01:
            self.tell(v, v)
            return
        radius = wheelbase / math.tan(delta)
        left = v * (1 - track / (2 * radius))
        right = v * (1 + track / (2 * radius))
        self.tell(left, right)
        self.get_logger().info(f"radius {radius:.2f} m: left {left:.2f}, right {right:.2f} m/s")

    def on_silence(self):
        self.tell(0.0, 0.0)

    def tell(self, left, right):
        """Publish the speeds of the wheels. Опубликовать скорости колёс."""
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        message.name = ["rear_left_wheel_joint", "rear_right_wheel_joint"]
        message.velocity = [left, right]
        self.publisher.publish(message)


def main(args=None):
    rclpy.init(args=args)
    node = ElectronicDifferential()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
