import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, TransformException, TransformListener


class BallFinder(Node):
    def __init__(self):
        super().__init__("ball_finder")
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.publisher = self.create_publisher(PointStamped, "/ball_in_base", 10)
        self.create_subscription(PointStamped, "/ball_in_camera", self.on_ball, 10)

    def on_ball(self, message):
        frame = message.header.frame_id
        try:
            transform = self.buffer.lookup_transform("base_link", frame, Time())
        except TransformException as error:
            self.get_logger().warning(f"the frame {frame} is unknown: {error}")
            return
        moved = transform.transform.translation
        answer = PointStamped()
        answer.header.stamp = message.header.stamp
        answer.header.frame_id = "base_link"
        answer.point.x = message.point.x + moved.x
        answer.point.y = message.point.y + moved.y
        answer.point.z = message.point.z + moved.z
        self.publisher.publish(answer)


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
