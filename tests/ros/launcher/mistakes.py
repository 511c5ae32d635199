"""The usual mistakes of beginners: programs with one mistake each, and words that explain it."""

from __future__ import annotations

HEAD = """\
import json
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool, ByteMultiArray, Float32, Float32MultiArray, Int32, String
from geometry_msgs.msg import Twist
from sensor_msgs.msg import JointState
from example_interfaces.srv import AddTwoInts
"""
SERVICE = """\
self.create_service(AddTwoInts, "/add", self.add)
self.client = self.create_client(AddTwoInts, "/add")
self.client.wait_for_service()
self.client.call_async(AddTwoInts.Request())"""


def indented(text: str, depth: int) -> str:
    return "".join(f"{' ' * depth}{line}\n" for line in text.splitlines())


def node(init: str, methods: str = "", above: str = 'super().__init__("mistaken")') -> str:
    """A node whose __init__ has these lines."""
    return (
        f"{HEAD}\nclass Mistaken(Node):\n    def __init__(self):\n{indented(above, 8)}"
        f"{indented(init, 8)}\n{indented(methods, 4)}\n"
        "rclpy.init()\nnode = Mistaken()\nrclpy.spin(node)\n"
    )


def ticking(body: str, arguments: str = "self") -> str:
    """A node whose timer runs these lines."""
    init = 'self.p = self.create_publisher(Float32, "/out", 10)\nself.create_timer(0.01, self.tick)'
    return node(init, f"def tick({arguments}):\n{indented(body, 4)}")


PUBLISHER = 'self.create_publisher(Float32, "/out", 10)'
MISTAKES: dict[str, tuple[str, str]] = {
    "int for float64": (ticking("m = Float32()\nm.data = 1"), "float: write 1.0"),
    "int for float in the constructor": (ticking("self.p.publish(Float32(data=1))"), "a float"),
    "text for float": (ticking('m = Float32()\nm.data = "1.0"'), "data is a float"),
    "number for text": (ticking("m = String()\nm.data = 1.5"), "data is text"),
    "float for int": (ticking("m = Int32()\nm.data = 1.5"), "whole number"),
    "int for bool": (ticking("m = Bool()\nm.data = 1"), "True or False"),
    "number for a message": (ticking("m = Twist()\nm.linear = 0.5"), "make a Vector3"),
    "number for a list": (ticking("m = Float32MultiArray()\nm.data = 0.5"), "is a list"),
    "ints in a list of floats": (
        ticking("m = JointState()\nm.position = [1, 2]"),
        "each of its values a float",
    ),
    "text for bytes": (ticking('m = ByteMultiArray()\nm.data = "abc"'), "single bytes"),
    "field misspelt": (ticking("msg = Float32()\nmsg.dat = 1.0"), "Float32 has no field dat"),
    "field misspelt in the constructor": (ticking("Float32(dat=1.0)"), "no field dat"),
    "another type published": (ticking("self.p.publish(String())"), "something else"),
    "a number published": (ticking("self.p.publish(1.0)"), "something else"),
    "no super": (node(PUBLISHER, above="pass"), "super().__init__(name) first"),
    "super without a name": (node("pass", above="super().__init__()"), "needs a name"),
    "no init": (node("pass").replace("rclpy.init()\n", ""), "before a node is made"),
    "init twice": (node("pass").replace("rclpy.init()", "rclpy.init()\nrclpy.init()"), "second"),
    "shutdown twice": (
        node("pass").replace("rclpy.spin(node)", "rclpy.shutdown()\nrclpy.shutdown()"),
        "rclpy.try_shutdown()",
    ),
    "two types for a topic": (
        node(f'{PUBLISHER}\nself.create_subscription(String, "/out", print, 10)'),
        "a topic has one type",
    ),
    "bytes of a ByteMultiArray": (
        ticking('m = ByteMultiArray()\nm.data = [b"a", b"b"]\nbytes(m.data)'),
        'b"".join(msg.data)',
    ),
    "timer's method called": (
        node("self.create_timer(0.01, self.tick())", "def tick(self):\n    pass"),
        "without brackets",
    ),
    "subscription's method called": (
        node('self.create_subscription(Float32, "/x", self.cb(), 10)', "def cb(self):\n    pass"),
        "goes without brackets",
    ),
    "class spun": (node("pass").replace("node = Mistaken()", "node = Mistaken"), "given a class"),
    "timer with a message": (ticking("pass", "self, msg"), "gets nothing but self"),
    "no self": (ticking("pass", ""), "first argument of a method is self"),
    "timer's arguments swapped": (
        node("self.create_timer(self.tick, 1.0)", "def tick(self):\n    pass"),
        "period comes first",
    ),
    "no queue depth": (node('self.create_publisher(Float32, "/out")'), "queue depth"),
    "queue depth as text": (node('self.create_publisher(Float32, "/out", "10")'), "quotes"),
    "blank in a topic": (node('self.create_publisher(Float32, "/my topic", 10)'), "no blanks"),
    "blank in a node": (node("pass", above='super().__init__("my node")'), "name of a node"),
    "parameter not declared": (node('self.get_parameter("speed")'), "Declare the parameter"),
    "parameter declared twice": (
        node('self.declare_parameter("v", 1.0)\nself.declare_parameter("v", 2.0)'),
        "declared twice",
    ),
    "no response returned": (
        node(SERVICE, "def add(self, request, response):\n    response.sum = 3"),
        "return the response",
    ),
    "service with one argument": (
        node(SERVICE, "def add(self, request):\n    return 3"),
        "a service's callback takes three",
    ),
    "subscription without message": (
        node('self.create_subscription(Float32, "/x", self.cb, 10)', "def cb(self):\n    pass"),
        "takes self and the message",
    ),
    "type as text": (node('self.create_publisher("Float32", "/out", 10)'), "is imported"),
    "indentation": (f"{HEAD}def main():\nprint(1)\n", "indentation"),
    "tabs": (f"{HEAD}def main():\n    a = 1\n\tb = 2\n", "no tabs"),
    "bracket": (f"{HEAD}print((1)\n", "never closed"),
    "colon": (f"{HEAD}def main()\n    pass\n", "colon"),
    "quotation mark": (f'{HEAD}print("a)\n', "quotation mark"),
    "one equals sign": (f"{HEAD}a = 1\nif a = 1:\n    pass\n", "two equals signs"),
    "module misspelt": ("import rclpyy\n", "no module rclpyy"),
    "import misspelt": ("from std_msgs.msg import Flaot32\n", "has no Flaot32"),
    "self has another name": (
        ticking("self.x = 1").replace("def tick(self)", "def tick(me)"),
        "called self",
    ),
    "self forgotten": (ticking("publish(1)"), "publish is unknown here"),
    "attribute never made": (ticking("self.out.publish(Float32())"), "Mistaken has no out"),
    "not UTF-8": (ticking(r'b"\xff".decode()'), "not UTF-8"),
    "not JSON": (ticking('json.loads("{")'), "not JSON"),
    "not the model": (
        (
            f"{HEAD}from pydantic import BaseModel\nclass A(BaseModel):\n    x: int\n"
            'A.model_validate_json("{}")\n'
        ),
        "does not fit the model",
    ),
    "division by zero": (ticking("1 / 0"), "Divided by zero"),
    "text plus number": (ticking('"a" + 1.0'), "cannot be added"),
    "key": (ticking('{}["speed"]'), "There is no 'speed'"),
    "index": (ticking("[][0]"), "not that long"),
    "logger without brackets": (ticking('self.get_logger.info("x")'), "Brackets are missing"),
    "None compared": (ticking("None < 0.5"), "The value is None"),
    "Ctrl-C": (ticking("raise KeyboardInterrupt"), "catch it around rclpy.spin"),
}
