import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from tf2_ros import StaticTransformBroadcaster


class CameraTf(Node):
    def __init__(self):
        super().__init__("camera_tf")
        # MISSING: a StaticTransformBroadcaster of this node, in self.broadcaster; then self.send().
        # НЕ ХВАТАЕТ: StaticTransformBroadcaster этого узла, в self.broadcaster; затем self.send().

    def send(self):
        transform = TransformStamped()
        transform.header.stamp = self.get_clock().now().to_msg()
        # MISSING: the parent base_link in header.frame_id, the child camera_link in child_frame_id.
        # НЕ ХВАТАЕТ: родителя base_link в header.frame_id и потомка camera_link в child_frame_id.
        # MISSING: translation (0.15, 0, 0.25) m, and a rotation that does not turn.
        # НЕ ХВАТАЕТ: translation (0.15, 0, 0.25) м и поворота, который ничего не поворачивает.
        # MISSING: give the transform to the broadcaster.
        # НЕ ХВАТАЕТ: отдать преобразование рассыльщику.


def main(args=None):
    rclpy.init(args=args)
    node = CameraTf()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
