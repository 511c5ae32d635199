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
        self.server = ActionServer(
            self,
            DriveToPoint,
            "drive_to_point",
            self.execute,
            goal_callback=self.on_goal,
            cancel_callback=self.on_cancel,
        )
        self.get_logger().info("waiting for goals")

    def on_goal(self, goal):
        if math.hypot(goal.x, goal.y) > 5.0:
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def on_cancel(self, goal_handle):
        return CancelResponse.ACCEPT

    def execute(self, goal_handle):
        goal = goal_handle.request
        result = DriveToPoint.Result()
        while self.distance_to(goal) > 0.1:
            if goal_handle.is_cancel_requested:
                self.stand()
                result.distance = self.distance_to(goal)
                goal_handle.canceled()
                return result
            self.step_towards(goal)
            feedback = DriveToPoint.Feedback()
            feedback.distance = self.distance_to(goal)
            goal_handle.publish_feedback(feedback)
            time.sleep(PERIOD)
        self.stand()
        result.distance = self.distance_to(goal)
        goal_handle.succeed()
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
        rclpy.spin(node, executor=MultiThreadedExecutor())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
