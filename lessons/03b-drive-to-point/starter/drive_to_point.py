import math
import time

import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from deck_interfaces.action import DriveToPoint
from nav_msgs.msg import Odometry
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

SPEED = 0.5
PERIOD = 0.1


class DriveToPointNode(Node):
    def __init__(self):
        super().__init__("drive_to_point")
        # A simulated robot: it turns on the spot, and always drives straight at its goal.
        # Робот в симуляции: поворачивается на месте и всегда едет прямо к цели.
        self.x = 0.0
        self.y = 0.0
        self.drive = self.create_publisher(AckermannDriveStamped, "/drive", 10)
        self.odometry = self.create_publisher(Odometry, "/odom", 10)
        # MISSING: an ActionServer for DriveToPoint, "drive_to_point", that calls self.execute.
        # НЕ ХВАТАЕТ: ActionServer для DriveToPoint, "drive_to_point", вызывающего self.execute.
        self.get_logger().info("waiting for goals")  # ru: "жду целей"

    def on_goal(self, goal):
        # MISSING: refuse a goal more than 5 m away from the origin.
        # НЕ ХВАТАЕТ: отказа, если цель дальше 5 м от начала координат.
        return GoalResponse.ACCEPT

    def on_cancel(self, goal_handle):
        return CancelResponse.ACCEPT

    def execute(self, goal_handle):
        goal = goal_handle.request
        result = DriveToPoint.Result()
        # MISSING: drive until self.distance_to(goal) is less than 0.1, then stand.
        # НЕ ХВАТАЕТ: ехать, пока self.distance_to(goal) не меньше 0.1, затем остановиться.
        # MISSING: feedback in each step, and an end if it is to be cancelled.
        # НЕ ХВАТАЕТ: обратной связи на каждом шаге и остановки, если просят отмену.
        # MISSING: say that it succeeded, and fill the result.
        # НЕ ХВАТАЕТ: сообщить об успехе и заполнить результат.
        return result

    def distance_to(self, goal):
        """Metres left. Сколько осталось метров."""
        return math.hypot(goal.x - self.x, goal.y - self.y)

    def step_towards(self, goal):
        """Drive for a tenth of a second. Проехать десятую долю секунды."""
        heading = math.atan2(goal.y - self.y, goal.x - self.x)
        metres = min(SPEED * PERIOD, self.distance_to(goal))
        self.x += metres * math.cos(heading)
        self.y += metres * math.sin(heading)
        self.tell(SPEED, heading)

    def stand(self):
        """Stop. Остановиться."""
        self.tell(0.0, 0.0)

    def tell(self, speed, heading):
        command = AckermannDriveStamped()
        command.header.stamp = self.get_clock().now().to_msg()
        command.drive.speed = speed
        self.drive.publish(command)
        odometry = Odometry()
        odometry.header.stamp = command.header.stamp
        odometry.header.frame_id = "odom"
        odometry.child_frame_id = "base_link"
        odometry.pose.pose.position.x = self.x
        odometry.pose.pose.position.y = self.y
        odometry.pose.pose.orientation.z = math.sin(heading / 2)
        odometry.pose.pose.orientation.w = math.cos(heading / 2)
        odometry.twist.twist.linear.x = speed
        self.odometry.publish(odometry)


def main(args=None):
    rclpy.init(args=args)
    node = DriveToPointNode()
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
