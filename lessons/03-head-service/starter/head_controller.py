import math
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import JointState


class HeadController(Node):
    def __init__(self):
        super().__init__("head_controller")
        # Where the head looks, in degrees. Куда смотрит голова, в градусах.
        self.pan = 0
        self.tilt = 0
        # MISSING: a service AddTwoInts "set_head_position" that calls self.move_head.
        # НЕ ХВАТАЕТ: сервиса AddTwoInts "set_head_position", который вызывает self.move_head.
        # MISSING: a publisher of JointState on /head_state, in self.publisher.
        # НЕ ХВАТАЕТ: издателя JointState в топике /head_state, в self.publisher.
        # MISSING: a timer that calls self.tell ten times a second.
        # НЕ ХВАТАЕТ: таймера, который вызывает self.tell десять раз в секунду.
        self.get_logger().info("the head looks ahead")  # ru: "голова смотрит вперёд"

    def move_head(self, request, response):
        # MISSING: refuse angles beyond -90 to 90 degrees: sum is 0.
        # НЕ ХВАТАЕТ: отказа, если угол вне пределов от -90 до 90 градусов: sum равна 0.
        # MISSING: the movement, one second; then the new self.pan and self.tilt.
        # НЕ ХВАТАЕТ: поворота, он длится секунду; затем новых self.pan и self.tilt.
        # MISSING: the answer: sum is 1.
        # НЕ ХВАТАЕТ: ответа: sum равна 1.
        return response

    def tell(self):
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        message.name = ["pan_joint", "tilt_joint"]
        # MISSING: both angles in radians, in message.position; then publish.
        # НЕ ХВАТАЕТ: обоих углов в радианах, в message.position; затем публикации.


def main(args=None):
    rclpy.init(args=args)
    node = HeadController()
    try:
        # MISSING (last step): an executor with several threads.
        # НЕ ХВАТАЕТ (последний шаг): исполнителя с несколькими потоками.
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
