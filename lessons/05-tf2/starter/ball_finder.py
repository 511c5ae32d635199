import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.time import Time
from tf2_geometry_msgs import do_transform_point
from tf2_ros import Buffer, TransformException, TransformListener


class BallFinder(Node):
    def __init__(self):
        super().__init__("ball_finder")
        self.buffer = Buffer()
        # MISSING: a TransformListener that fills the buffer, in self.listener.
        # НЕ ХВАТАЕТ: TransformListener, который наполняет буфер, в self.listener.
        # MISSING: a publisher of PointStamped on /ball_in_base, in self.publisher,
        # and a subscription to /ball_in_camera that calls self.on_ball.
        # НЕ ХВАТАЕТ: издателя PointStamped в /ball_in_base, в self.publisher,
        # и подписки на /ball_in_camera, которая вызывает self.on_ball.

    def on_ball(self, message):
        # MISSING: the transform from message.header.frame_id to base_link;
        # an unknown frame is a warning with its name, and no answer.
        # НЕ ХВАТАЕТ: преобразования из message.header.frame_id в base_link;
        # неизвестная система — это warning с её именем и никакого ответа.
        # MISSING: a PointStamped in base_link: the point plus the translation, published
        # (step 5: turned as well, by do_transform_point).
        # НЕ ХВАТАЕТ: PointStamped в base_link: точка плюс сдвиг, и публикации
        # (шаг 5: и с поворотом, через do_transform_point).
        pass


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
