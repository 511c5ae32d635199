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
        self.create_service(
            AddTwoInts,
            "set_head_position",
            self.move_head,
            callback_group=MutuallyExclusiveCallbackGroup(),
        )
        self.publisher = self.create_publisher(JointState, "/head_state", 10)
        self.create_timer(0.1, self.tell)
        self.get_logger().info("the head looks ahead")

    def move_head(self, request, response):
        if abs(request.a) > 90 or abs(request.b) > 90:
            response.sum = 0
            return response
        time.sleep(1.0)
        self.pan = request.a
        self.tilt = request.b
        response.sum = 1
        return response

    def tell(self):
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        message.name = ["pan_joint", "tilt_joint"]
        message.position = [float(self.pan), float(self.tilt)]
        self.publisher.publish(message)


def main(args=None):
    rclpy.init(args=args)
    node = HeadController()
    try:
        rclpy.spin(node, executor=MultiThreadedExecutor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
