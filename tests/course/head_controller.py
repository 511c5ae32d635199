"""As in the course."""

import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class HeadController(Node):
    """Takes a second for each turn, and says 1; there is no topic of its angles."""

    def __init__(self) -> None:
        super().__init__("head_controller")
        self.create_service(AddTwoInts, "set_head_position", self.turn)

    def turn(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        self.get_logger().info(f"turning to {request.a}, {request.b}")
        time.sleep(1.0)
        response.sum = 1
        return response


def main() -> None:
    rclpy.init()
    node = HeadController()
    node.get_logger().info("started")
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
