"""Mistakes with actions: their two classes, goals and handles, feedback, results."""

from __future__ import annotations

from tests.ros.launcher.mistakes.programs import HEAD, indented, node

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


CLIENTS = {
    "action client of the node": acting('self.create_action_client(Fibonacci, "f")'),
    "action server of the node": acting('self.create_action_server(Fibonacci, "f", self.x)'),
    "action client without the node": acting('ActionClient(Fibonacci, "f")'),
    "action client's arguments swapped": acting('ActionClient(self, "f", Fibonacci)'),
    "action server's arguments swapped": acting('ActionServer(Fibonacci, self, "f", print)'),
    "action server without a callback": acting('ActionServer(self, Fibonacci, "f")'),
    "action server's method called": acting(
        'ActionServer(self, Fibonacci, "f", self.execute())', "def execute(self):\n    pass"
    ),
    "action's type as text": acting('ActionServer(self, "Fibonacci", "f", print)'),
    "goal is a class": acting('ActionClient(self, Fibonacci, "f").send_goal_async(Fibonacci.Goal)'),
    "goal is a number": acting('ActionClient(self, Fibonacci, "f").send_goal_async(5)'),
    "action is sent": acting('ActionClient(self, Fibonacci, "f").send_goal_async(Fibonacci())'),
    "goal without making it": acting('ActionClient(self, Fibonacci, "f").send_goal_async(order=5)'),
    "server waited for as a service": acting(
        'self.c = ActionClient(self, Fibonacci, "f")\nself.c.wait_for_service()'
    ),
    "handle for a result": sending(
        accepted="def accepted(self, future):\n    print(future.result().result.sequence)"
    ),
    "future for a handle": sending(
        accepted="def accepted(self, future):\n    future.get_result_async()"
    ),
    "result around the result": sending(
        done="def done(self, future):\n    print(future.result().sequence)"
    ),
    "feedback around the feedback": sending(heard="def heard(self, msg):\n    print(msg.sequence)"),
    "feedback callback without message": sending(heard="def heard(self):\n    pass"),
}
SERVERS = {
    "execute without a handle": serving("pass", "def execute(self):"),
    "execute like a service": serving("pass", "def execute(self, request, response):"),
    "execute returns nothing": serving("goal_handle.succeed()"),
    "execute returns a list": serving("goal_handle.succeed()\nreturn [0, 1]"),
    "execute returns the class": serving("goal_handle.succeed()\nreturn Fibonacci.Result"),
    "goal of the handle": serving("print(goal_handle.goal.order)"),
    "order of the handle": serving("print(goal_handle.order)"),
    "feedback is a list": serving("goal_handle.publish_feedback([0, 1])"),
    "feedback's field of the tutorial": serving(
        "msg = Fibonacci.Feedback()\nmsg.partial_sequence = [0]"
    ),
    "succeeded of ROS 1": serving("goal_handle.set_succeeded(Fibonacci.Result())"),
    "succeed twice": serving("goal_handle.succeed()\ngoal_handle.succeed()"),
    "cancelled by itself": serving("goal_handle.canceled()"),
    "cancel asked with brackets": serving("if goal_handle.is_cancel_requested():\n    pass"),
    "asyncio in a callback": serving(
        "import asyncio\nawait asyncio.sleep(0.1)", "async def execute(self, goal_handle):"
    ),
}
