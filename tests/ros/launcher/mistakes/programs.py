"""Small programs with one mistake each: a node around a line that is wrong."""

from __future__ import annotations

HEAD = """\
import json
import math
import time

import numpy as np
import rclpy
from example_interfaces.srv import AddTwoInts
from geometry_msgs.msg import Point, PoseStamped, Twist, Vector3
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.duration import Duration
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from rclpy.time import Time
from sensor_msgs.msg import Image, JointState, LaserScan, Range
from std_msgs.msg import Bool, ByteMultiArray, Float32, Float32MultiArray, Int32, String, UInt8
from std_srvs.srv import Trigger
"""
SERVICE = """\
self.create_service(AddTwoInts, "/add", self.add)
self.client = self.create_client(AddTwoInts, "/add")
self.client.wait_for_service()
self.future = self.client.call_async(AddTwoInts.Request())"""


def indented(text: str, depth: int) -> str:
    return "".join(f"{' ' * depth}{line}\n" for line in text.splitlines())


def node(init: str, methods: str = "", above: str = 'super().__init__("mistaken")') -> str:
    """Return a program with a node whose __init__ has these lines."""
    return (
        f"{HEAD}\nclass Mistaken(Node):\n    def __init__(self):\n{indented(above, 8)}"
        f"{indented(init, 8)}\n{indented(methods, 4)}\n"
        "rclpy.init()\nnode = Mistaken()\nrclpy.spin(node)\n"
    )


def ticking(body: str, arguments: str = "self", init: str = "") -> str:
    """Return a program with a node whose timer runs these lines."""
    lines = 'self.p = self.create_publisher(Float32, "/out", 10)\nself.last = None\n'
    lines += f"{init}\nself.create_timer(0.0, self.tick)"
    return node(lines, f"def tick({arguments}):\n{indented(body, 4)}")


def heard(body: str, kind: str = "Float32", message: str = "Float32(data=2.0)") -> str:
    """Return a program whose callback of a subscription runs these lines, with a message."""
    return (
        ticking(f"self.cb({message})", init="")
        .replace("    def tick(self)", f"    def cb(self, msg):\n{indented(body, 8)}\n    def tick(self)")
        .replace(
            "self.last = None",
            f'self.last = None\n        self.create_subscription({kind}, "/heard", self.cb, 10)',
            1,
        )
    )


def bare(body: str) -> str:
    """Return a program with a class that is no node, for which ROS need not be started."""
    return (
        f"{HEAD}\nclass Mistaken:\n    def __init__(self):\n        self.last = None\n\n"
        f"    def tick(self):\n{indented(body, 8)}\nMistaken().tick()\n"
    )


def bare_heard(body: str, message: str = "Float32(data=2.0)") -> str:
    """Return the same, whose method is handed a message."""
    return f"{HEAD}\nclass Mistaken:\n    def cb(self, msg):\n{indented(body, 8)}\nMistaken().cb({message})\n"


def script(body: str) -> str:
    """Return a program of these lines below the imports."""
    return f"{HEAD}{body}\n"


def given(value: str, default: str) -> str:
    """Return a program that declares a parameter, and is given it on its command line."""
    return script(f'rclpy.init(args=["--ros-args", "-p", "p:={value}"])\nNode("n").declare_parameter("p", {default})')


# ---------------------------------------------------------------- actions

IMPORTS = """\
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient, ActionServer
"""
SERVER = """\
def execute(self, goal_handle):
    goal_handle.publish_feedback(Fibonacci.Feedback())
    goal_handle.succeed()
    return Fibonacci.Result()
"""
GO = """\
self.server = ActionServer(self, Fibonacci, "fibonacci", self.execute)
self.client = ActionClient(self, Fibonacci, "fibonacci")
self.client.wait_for_server(timeout_sec=5.0)
self.sent = self.client.send_goal_async(Fibonacci.Goal(order=3), feedback_callback=self.heard)
self.sent.add_done_callback(self.accepted)"""
ACCEPTED = """\
def accepted(self, future):
    self.result = future.result().get_result_async()
    self.result.add_done_callback(self.done)
"""
HEARD = """\
def heard(self, msg):
    pass
"""
DONE = """\
def done(self, future):
    raise SystemExit
"""


def acting(init: str, methods: str = "") -> str:
    """A node that makes something of an action in its __init__."""
    return node(init, methods).replace(HEAD, HEAD + IMPORTS)


def sending(*, accepted: str = ACCEPTED, heard: str = HEARD, done: str = DONE) -> str:
    """A node that sends itself a goal, whose client has these methods."""
    return acting(GO, f"{SERVER}\n{accepted}\n{heard}\n{done}")


def serving(body: str, head: str = "def execute(self, goal_handle):") -> str:
    """A node that sends itself a goal, whose server runs these lines; rclpy catches what fails."""
    done = "def done(self, future):\n    import os\n    os._exit(0)\n"
    return acting(GO, f"{head}\n{indented(body, 4)}\n{ACCEPTED}\n{HEARD}\n{done}")
