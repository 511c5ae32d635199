import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.time import Time
from tf2_geometry_msgs import do_transform_point
from tf2_ros import Buffer, TransformListener


class BallFinder(Node):
    def __init__(self):
        super().__init__("ball_finder")
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.publisher = self.create_publisher(PointStamped, "/ball_in_base", 10)
        self.create_subscription(PointStamped, "/ball_in_camera", self.on_ball, 10)

    def on_ball(self, message):
        frame = message.header.frame_id
        transform = self.buffer.lookup_transform("base_link", frame, Time())
        self.publisher.publish(do_transform_point(message, transform))


def main(args=None):
    rclpy.init(args=args)
    node = BallFinder()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
