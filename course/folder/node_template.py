"""An empty node, as the course writes one, and the profile that runs it."""

from __future__ import annotations

NODE = """\
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class {class_name}(Node):
    def __init__(self):
        super().__init__("{name}")
        self.get_logger().info("{name} is on")
        self.create_timer(1.0, self.tick)

    def tick(self):
        self.get_logger().info("tick")


def main(args=None):
    rclpy.init(args=args)
    node = {class_name}()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
"""
PROFILE = """\
title: {{en: My node, ru: Мой узел}}
nodes:
  {name}:
    run: ./{name}.py
"""
