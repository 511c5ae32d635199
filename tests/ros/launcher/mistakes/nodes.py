"""Mistakes with nodes: made, given arguments, spun, parameters, clocks, frames, pictures."""

from __future__ import annotations

from tests.ros.launcher.mistakes.programs import (
    HEAD,
    bare,
    bare_heard,
    heard,
    node,
    script,
    ticking,
)

PUBLISHER = 'self.create_publisher(Float32, "/out", 10)'
CB = "def cb(self, msg):\n    pass"
LISTENER = """\
from tf2_ros import Buffer, TransformListener, TransformBroadcaster
self.buffer = Buffer()
"""
HIDDEN = {
    "hidden by a finally": script(
        'rclpy.init()\n\ndef main():\n    try:\n        timer = Node("m").create_timer(-0.5, print)\n'
        "    finally:\n        timer.cancel()\n\nmain()"
    ),
    "hidden by a handler": script(
        'rclpy.init()\n\ndef main():\n    try:\n        timer = Node("m").create_timer(None, print)\n'
        "    except Exception:\n        timer.cancel()\n\nmain()"
    ),
    "hidden by the end of a with": script(
        "rclpy.init()\n\nclass Port:\n    def __enter__(self):\n        return self\n\n"
        "    def __exit__(self, *error):\n        self.socket.close()\n\n"
        "with Port():\n    Node('my node')"
    ),
    "hidden by a handler that has None": script(
        "rclpy.init()\n\ndef main():\n    node = None\n    try:\n        node = Node('my node')\n"
        "    except Exception as error:\n        node.get_logger().error(str(error))\n\nmain()"
    ),
    "hidden by two that clean up": script(
        "class N(Node):\n    def __init__(self):\n        super().__init__('n')\n        try:\n"
        "            self.p = self.create_publisher(Float32, '/my topic', 10)\n        finally:\n"
        "            self.close()\n    def close(self):\n        self.p.destroy()\n"
        "rclpy.init()\ntry:\n    n = N()\nfinally:\n    n.destroy_node()"
    ),
}
"""Where Python tells last of what comes of another mistake."""
MADE = {
    "no super": node(PUBLISHER, above="pass"),
    "super too late": node("pass", above=f'{PUBLISHER}\nsuper().__init__("mistaken")'),
    "super without a name": node("pass", above="super().__init__()"),
    "super without brackets": node("pass", above='super.__init__("mistaken")'),
    "super with two names": node("pass", above='super().__init__("mistaken", 10)'),
    "not a node": node(PUBLISHER).replace("class Mistaken(Node)", "class Mistaken"),
    "derived from a module": node("pass").replace("(Node):", "(rclpy.node):", 1),
    "no init": node("pass").replace("rclpy.init()\n", ""),
    "init twice": node("pass").replace("rclpy.init()", "rclpy.init()\nrclpy.init()"),
    "shutdown twice": node("pass").replace(
        "rclpy.spin(node)", "rclpy.shutdown()\nrclpy.shutdown()"
    ),
    "class spun": node("pass").replace("node = Mistaken()", "node = Mistaken"),
    "nothing spun": node("pass").replace("rclpy.spin(node)", "rclpy.spin()"),
    "None spun": node("pass").replace("node = Mistaken()", "node = None"),
    "with init": script('with rclpy.init():\n    rclpy.spin(Node("mistaken"))'),
    "blank in a node": node("pass", above='super().__init__("my node")'),
    "hyphen in a node": node("pass", above='super().__init__("my-node")'),
    "digit first in a node": node("pass", above='super().__init__("2nd")'),
    "number as a node's name": node("pass", above="super().__init__(7)"),
    "used after it was destroyed": node(PUBLISHER).replace(
        "rclpy.spin(node)", 'node.destroy_node()\nnode.create_publisher(Float32, "/x", 10)'
    ),
    "Ctrl-C": ticking("raise KeyboardInterrupt"),
    "publishers is rclpy's own": node("self.publishers = []"),
    "timers is rclpy's own": node("self.timers = {}"),
    "clock is rclpy's own": node("self._clock = 0\nself.get_clock().now()"),
    "logger is rclpy's own": node("self._logger = None\n" + 'self.get_logger().info("x")'),
    "handle is a method": node(PUBLISHER, "def handle(self, msg):\n    pass"),
    "method called on the class": node("pass").replace("node = Mistaken()", "Mistaken.get_name()"),
    "init without self": script(
        'class N(Node):\n    def __init__():\n        super().__init__("n")\nrclpy.init()\nN()'
    ),
    "derived from a node that is made": script("class N(Node()):\n    pass"),
    "name given to init": script('rclpy.init("talker")'),
    "node spins itself": node("pass").replace("rclpy.spin(node)", "node.spin()"),
    "rate of rclpy": ticking("r = rclpy.create_rate(10)"),
    **HIDDEN,
    "mistake within a handler": script(
        "try:\n    {}['speed']\nexcept KeyError:\n    x = nothing_at_all"
    ),
    "own mistake in a finally": script(
        'rclpy.init()\nnode = Node("mistaken")\ntry:\n    pass\nfinally:\n    node.stop_it()'
    ),
    "nodes spun by threads": script(
        "import threading\nrclpy.init()\n"
        'nodes = [Node(f"n{i}") for i in range(3)]\n'
        "threads = [threading.Thread(target=rclpy.spin, args=(n,), daemon=True) for n in nodes]\n"
        "for each in threads:\n    each.start()\n"
        "for each in threads:\n    each.join(2)"
    ),
    "spun by threads and by main": script(
        'import threading\nrclpy.init()\nfirst, second = Node("first"), Node("second")\n'
        "threading.Thread(target=rclpy.spin, args=(first,), daemon=True).start()\n"
        "while True:\n    rclpy.spin_once(second)"
    ),
    "maker called on the class": ticking('Node.create_publisher(Float32, "/x", 10)'),
}
CREATED = {
    "two types for a topic": node(
        f'{PUBLISHER}\nself.create_subscription(String, "/out", lambda msg: None, 10)'
    ),
    "a function that tells nothing of what it takes": node(
        'self.create_subscription(Float32, "/x", max, 10)'
    ),
    "no queue depth": node('self.create_publisher(Float32, "/out")'),
    "no queue depth for a subscription": node(
        'self.create_subscription(Float32, "/x", self.cb)', CB
    ),
    "queue depth as text": node('self.create_publisher(Float32, "/out", "10")'),
    "negative queue depth": node('self.create_publisher(Float32, "/out", -1)'),
    "publisher's arguments swapped": node('self.create_publisher("/out", Float32, 10)'),
    "subscription's arguments swapped": node(
        'self.create_subscription("/x", Float32, self.cb, 10)', CB
    ),
    "callback and depth swapped": node('self.create_subscription(Float32, "/x", 10, self.cb)', CB),
    "timer's arguments swapped": node(
        "self.create_timer(self.tick, 1.0)", "def tick(self):\n    pass"
    ),
    "service's arguments swapped": node('self.create_service("/s", Trigger, self.cb)', CB),
    "client's arguments swapped": node('self.create_client("/s", Trigger)'),
    "timer's method called": node(
        "self.create_timer(0.0, self.tick())", "def tick(self):\n    pass"
    ),
    "timer without a period": node("self.create_timer(self.tick)", "def tick(self):\n    pass"),
    "subscription's method called": node(
        'self.create_subscription(Float32, "/x", self.cb(), 10)', "def cb(self):\n    pass"
    ),
    "type as text": node('self.create_publisher("Float32", "/out", 10)'),
    "type is a module": script("import std_msgs.msg")
    + node('self.create_publisher(std_msgs.msg, "/out", 10)').replace(
        HEAD, HEAD + "import std_msgs.msg\n"
    ),
    "service for a topic": node('self.create_publisher(Trigger, "/out", 10)'),
    "message for a service": node('self.create_service(String, "/s", self.cb)', CB),
    "topic without quotes": node("self.create_publisher(Float32, out, 10)"),
    "topic is a number": node("self.create_publisher(Float32, 5, 10)"),
    "blank in a topic": node('self.create_publisher(Float32, "/my topic", 10)'),
    "hyphen in a topic": node('self.create_subscription(Float32, "/my-topic", self.cb, 10)', CB),
    "blank in a service": node('self.create_service(Trigger, "/my service", self.cb)', CB),
    "timer with a message": ticking("pass", "self, msg"),
    "no self": ticking("pass", ""),
    "subscription without message": node(
        'self.create_subscription(Float32, "/x", self.cb, 10)', "def cb(self):\n    pass"
    ),
    "subscription with three": node(
        'self.create_subscription(Float32, "/x", self.cb, 10)',
        "def cb(self, msg, other, third):\n    pass",
    ),
    "keyword misspelt": node('self.create_publisher(Float32, "/out", qos=10)'),
    "profile without depth": node("QoSProfile()"),
    "profile without a name": node("QoSProfile(10)"),
    "negative period": node("self.create_timer(-0.5, print)"),
    "callback as text": node('self.create_timer(0.0, "tick")', "def tick(self):\n    pass"),
    "service as text": node('self.create_client("AddTwoInts", "/add")'),
    "f missing in a topic": node('self.create_publisher(Float32, "/{name}/x", 10)'),
    "policy as text": node('QoSProfile(depth=10, reliability="best_effort")'),
    "method within __init__": node("self.create_timer(0.1, self.tick)\ndef tick(self):\n    pass"),
    "executor with a class": script(
        "from rclpy.executors import MultiThreadedExecutor\nrclpy.init()\n"
        "e = MultiThreadedExecutor()\ne.add_node(Node)\ne.spin()"
    ),
    "executor made with a node": script(
        "from rclpy.executors import MultiThreadedExecutor\nrclpy.init()\n"
        'MultiThreadedExecutor(Node("x"))'
    ),
    "init misspelt": node("pass").replace("__init__(self)", "__int__(self)"),
    "no init in the class": script("class N(Node):\n    pass\nrclpy.init()\nN()"),
    "queue_size of ROS 1": node('self.create_publisher(Float32, "/out", queue_size=10)'),
    "depth in quotes": bare('QoSProfile(depth="10")'),
    "policy misspelt": bare("QoSProfile(depth=10, durable=True)"),
    "policy in small letters": bare(
        "from rclpy.qos import ReliabilityPolicy\nReliabilityPolicy.best_effort"
    ),
    "group without brackets": script(
        "from rclpy.callback_groups import ReentrantCallbackGroup\nrclpy.init()\n"
        'Node("x").create_timer(1.0, lambda: None, ReentrantCallbackGroup)'
    ),
    "wait in quotes": ticking('self.create_client(Trigger, "/s").wait_for_service("1.0")'),
    "rate in quotes": ticking('self.create_rate("10")'),
    "arguments too many": node("pass").replace("node = Mistaken()", 'node = Mistaken("x")'),
}


def given(value: str, default: str) -> str:
    """Return a program that declares a parameter, and is given it on its command line."""
    return script(
        f'rclpy.init(args=["--ros-args", "-p", "p:={value}"])\n'
        f'Node("n").declare_parameter("p", {default})'
    )


def given_in_file(lines: str) -> str:
    """Return a program that is given these lines of a file of parameters."""
    return script(
        "from pathlib import Path\nfile = Path(__file__).with_name('given.yaml')\n"
        f"file.write_text('/**:\\n  ros__parameters:\\n    {lines}')\n"
        'rclpy.init(args=["--ros-args", "--params-file", str(file)])'
    )


PARAMETERS = {
    "off for a text": given("off", "'slow'"),
    "y in a list of texts": given("[y, n]", "['x', 'y']"),
    "number for a text": given("5", "'slow'"),
    "on for a number": given("on", "1.5"),
    "text for a boolean": given("'off'", "True"),
    "text for a number of a parameter": given("'5'", "1.5"),
    "whole number for a fraction": given("5", "1.5"),
    "comma for a point of a parameter": given("2,5", "1.5"),
    "number with its unit for a parameter": given("2.5 m", "1.5"),
    "list for a single value": given("[1.5]", "1.5"),
    "single value for a list": given("1.5", "[1.5]"),
    "off among texts": given_in_file("p: [slow, off]"),
    "off before a text": given_in_file("p: [off, slow]"),
    "number among texts": given_in_file("p: [slow, 5]"),
    "colon without a space in a file": given_in_file("p:slow"),
    "two colons without a space in a file": given_in_file("p:slow\\n    q: 5"),
    "no-break space in a file": given_in_file("p:\\u00a0slow"),
    "ros__parameters misspelt in a file": given_in_file("p: slow").replace(
        "ros__parameters", "ros_parameters"
    ),
    "file of parameters in another encoding": given_in_file("p: медленно").replace(
        "write_text(", "write_text(encoding='cp1251', data="
    ),
    "parameter not declared": node('self.get_parameter("speed")'),
    "parameter declared twice": node(
        'self.declare_parameter("v", 1.0)\nself.declare_parameter("v", 2.0)'
    ),
    "value forgotten, times": node(
        'self.declare_parameter("v", 1.0)\nx = self.get_parameter("v") * 2.0'
    ),
    "value forgotten, compared": node(
        'self.declare_parameter("v", 1.0)\nif self.get_parameter("v") > 0.5:\n    pass'
    ),
    "value forgotten, kept": node(
        'self.declare_parameter("v", 1.0)\nself.v = self.get_parameter("v")\nx = 1.0 / self.v'
    ),
    "value forgotten, float": node(
        'self.declare_parameter("v", 1.0)\nx = float(self.get_parameter("v"))'
    ),
    "value forgotten, timer": node(
        'self.v = self.declare_parameter("v", 1.0)\nself.create_timer(self.v, print)'
    ),
    "value forgotten, range": node(
        'self.v = self.declare_parameter("v", 1)\nfor i in range(self.v):\n    pass'
    ),
    "value as an attribute": node(
        'self.declare_parameter("v", 1.0)\nx = self.get_parameter("v").double_value'
    ),
    "never given a value": node(
        'self.declare_parameter("robot", Parameter.Type.STRING)\nself.get_parameter("robot").value'
    ),
    "other type set": node(
        'self.declare_parameter("v", 1.0)\nself.set_parameters([Parameter("v", value="x")])[0]\nself.declare_parameter("v")'
    ),
    "name and value swapped": node('self.declare_parameter(1.0, "v")'),
    "get_param of ROS 1": node('self.get_param("v")'),
    "parameter misspelt": node('self.declare_parameter("speed", 1.0)\nself.get_parameter("sped")'),
    "no value, calculated with": node(
        'self.declare_parameter("speed", None)\nx = self.get_parameter("speed").value * 2.0'
    ),
    "value with brackets": node(
        'self.declare_parameter("v", 1.0)\nx = self.get_parameter("v").value()'
    ),
    "dictionary as a parameter": node('self.declare_parameter("gains", {"p": 1.0})'),
    "list of two types": node('self.declare_parameter("gains", [1, 2.0])'),
    "one parameter set": node(
        'self.declare_parameter("v", 1.0)\nself.set_parameters(Parameter("v", value=2.0))'
    ),
    "pair set": node('self.declare_parameter("v", 1.0)\nself.set_parameters([("v", 2.0)])'),
    "undeclared set": node('self.set_parameters([Parameter("speed", value=2.0)])'),
    "type and value of a parameter": bare('Parameter("v", Parameter.Type.DOUBLE, 2)'),
    "parameters without pairs": node('self.declare_parameters("", ["v", 1.0])'),
    "message around a parameter's value": node(
        'self.declare_parameter("v", 1.0)\nx = self.get_parameter("v").get_parameter_value() * 2'
    ),
    "parameter that is a word": node(
        'self.declare_parameter("v", "fast")\nx = self.get_parameter("v").value + 1'
    ),
    "parameter that is a number in quotes": node(
        'self.declare_parameter("v", "5")\nx = self.get_parameter("v").value * 1.5'
    ),
    "one name for a list of names": node('self.get_parameters("speed")'),
    "callback of parameters without them": node(
        'self.declare_parameter("v", 1.0)\nself.add_on_set_parameters_callback(self.on)\n'
        'self.set_parameters([Parameter("v", value=2.0)])',
        "def on(self):\n    pass",
    ),
    "callback of parameters called": node(
        "self.add_on_set_parameters_callback(self.on())", "def on(self):\n    pass"
    ),
}
CLOCKS = {
    "stamp subtracted from now": heard(
        "dt = self.get_clock().now() - msg.header.stamp", "Odometry", "Odometry()"
    ),
    "stamps subtracted": heard(
        "dt = msg.header.stamp - msg.header.stamp", "Odometry", "Odometry()"
    ),
    "seconds added to a time": ticking("t = self.get_clock().now() + 1.0"),
    "duration compared": ticking("t = self.get_clock().now()\nif t - t > 1.0:\n    pass"),
    "duration without a name": bare("d = Duration(1.0)"),
    "clocks mixed": ticking("d = self.get_clock().now() - Time()"),
    "to_sec of ROS 1": ticking("t = self.get_clock().now().to_sec()"),
    "sec of a time": ticking("t = self.get_clock().now()\nt.sec"),
    "time.sleep of text": bare('time.sleep("1")'),
    "negative sleep": bare("time.sleep(-1)"),
    "timer stopped": ticking("self.t.stop()", init="self.t = self.create_timer(1.0, print)"),
    "now of the class": bare("Time.now()"),
    "function of a time": ticking("self.get_clock().now().seconds_nanoseconds[0]"),
}
SEEN = {
    "buffer without a listener": ticking(
        'self.buffer.lookup_transform("map", "base_link", Time())', init=LISTENER
    ),
    "frame that nobody publishes to a listener elsewhere": script(
        "from tf2_ros import Buffer, TransformListener\nclass Finder:\n"
        "    def __init__(self, buffer):\n        self.buffer = buffer\n    def find(self):\n"
        "        return self.buffer.lookup_transform('map', 'base_link', Time())\n"
        "def main():\n    rclpy.init()\n    buffer = Buffer()\n"
        "    TransformListener(buffer, Node('finder'))\n    Finder(buffer).find()\nmain()"
    ),
    "frame that nobody publishes": ticking(
        'self.buffer.lookup_transform("map", "base_link", Time())',
        init=LISTENER + "self.l = TransformListener(self.buffer, self)",
    ),
    "transform of this moment": ticking(
        "from geometry_msgs.msg import TransformStamped\nt = TransformStamped()\n"
        't.header.frame_id = "map"\nt.child_frame_id = "base_link"\nt.header.stamp.sec = 5\n'
        'self.buffer.set_transform(t, "me")\n'
        'self.buffer.lookup_transform("map", "base_link", self.get_clock().now())',
        init=LISTENER,
    ),
    "slash before a frame": ticking(
        'self.buffer.lookup_transform("/map", "base_link", Time())', init=LISTENER
    ),
    "window of OpenCV": bare('import cv2\ncv2.imshow("w", np.zeros((4, 4, 3), np.uint8))'),
    "picture is None": bare("import cv2\ncv2.cvtColor(self.last, cv2.COLOR_BGR2GRAY)"),
    "picture is empty": bare(
        "import cv2\nx = np.zeros((0, 0, 3), np.uint8)\ncv2.cvtColor(x, cv2.COLOR_BGR2GRAY)"
    ),
    "picture of another encoding": bare(
        'from cv_bridge import CvBridge\nm = Image()\nm.encoding = "32FC1"\nm.width = m.height = 1\nm.step = 4\n'
        'm.data = [0, 0, 0, 0]\nCvBridge().imgmsg_to_cv2(m, "bgr8")'
    ),
    "pixels reshaped": bare("a = np.zeros(10)\nb = a.reshape(3, 4)"),
    "arrays of other shapes": bare("a = np.zeros(3)\nb = np.zeros(4)\nc = a + b"),
    "if of an array": bare("a = np.zeros(3)\nif a > 0:\n    pass"),
    "time-out is a number": ticking(
        'self.buffer.lookup_transform("map", "base_link", Time(), 1.0)', init=LISTENER
    ),
    "another message is sent as a transform": ticking(
        "from tf2_ros import TransformBroadcaster\n"
        "TransformBroadcaster(self).sendTransform(Twist())"
    ),
    "message for a picture": bare_heard("import cv2\ncv2.cvtColor(msg, 6)", "Image()"),
    "encoding that there is none": bare(
        "from cv_bridge import CvBridge\n"
        'CvBridge().cv2_to_imgmsg(np.zeros((4, 4, 3), np.uint8), "bgr")'
    ),
    "array of another encoding": bare(
        "from cv_bridge import CvBridge\n"
        'CvBridge().cv2_to_imgmsg(np.zeros((4, 4), np.uint8), "bgr8")'
    ),
    "bridge without brackets": bare(
        'from cv_bridge import CvBridge\nself.b = CvBridge\nself.b.imgmsg_to_cv2(Image(), "bgr8")'
    ),
    "class for a picture": bare(
        'from cv_bridge import CvBridge\nCvBridge().imgmsg_to_cv2(Image, "bgr8")'
    ),
    "list for a picture": bare(
        'from cv_bridge import CvBridge\nCvBridge().cv2_to_imgmsg([1, 2, 3], "bgr8")'
    ),
    "picture that is not there": bare('import cv2\nf = cv2.imread("nothing.png")\nf.shape'),
    "no picture of the camera": bare(
        "class Camera:\n    def read(self):\n        return False, None\n"
        "ok, f = Camera().read()\nf.shape"
    ),
    "fraction for a picture's size": bare(
        "import cv2\ncv2.resize(np.zeros((4, 4, 3), np.uint8), (2.0, 2.0))"
    ),
    "fraction for a point": bare(
        "import cv2\na = np.zeros((4, 4, 3), np.uint8)\nw = 4\n"
        "cv2.circle(a, (w / 2, 1), 3, (0, 0, 255))"
    ),
    "fraction for a radius": bare(
        "import cv2\na = np.zeros((4, 4, 3), np.uint8)\ncv2.circle(a, (1, 1), 3.5, (0, 0, 255))"
    ),
    "number for a point": bare(
        "import cv2\na = np.zeros((4, 4, 3), np.uint8)\ncv2.circle(a, 1, 3, (0, 0, 255))"
    ),
    "name of a colour": bare(
        'import cv2\na = np.zeros((4, 4, 3), np.uint8)\ncv2.circle(a, (1, 1), 3, "red")'
    ),
    "file for a picture": bare('import cv2\ncv2.cvtColor("a.png", cv2.COLOR_BGR2GRAY)'),
    "number for a text in a picture": bare(
        "import cv2\na = np.zeros((4, 4, 3), np.uint8)\ncv2.putText(a, 5, (0, 0), 0, 1, (0, 0, 0))"
    ),
    "picture and file swapped": bare(
        'import cv2\na = np.zeros((4, 4, 3), np.uint8)\ncv2.imwrite(a, "a.png")'
    ),
    "thresholds missing": bare("import cv2\na = np.zeros((4, 4), np.uint8)\ncv2.Canny(a)"),
    "filter of even size": bare(
        "import cv2\na = np.zeros((4, 4), np.uint8)\ncv2.GaussianBlur(a, (4, 4), 0)"
    ),
    "grey picture made grey": bare(
        "import cv2\na = np.zeros((4, 4), np.uint8)\ncv2.cvtColor(a, cv2.COLOR_BGR2GRAY)"
    ),
    "arrays that are not multiplied": bare("np.array([1, 2]) @ np.array([1, 2, 3])"),
}
LOGGED = {
    "logger without brackets": ticking('self.get_logger.info("x")'),
    "logger like print": ticking('self.get_logger().info("speed is", 3.0)'),
    "logger like print, with a variable": ticking('x = 3\nself.get_logger().warn("x:", x)'),
    "logger without a text": ticking("self.get_logger().info()"),
    "logger's print": ticking('self.get_logger().print("x")'),
    "severity changes": ticking(
        "for n in range(2):\n    log = self.get_logger().info if n else self.get_logger().error\n    log('x')"
    ),
    "input in a node": bare('x = input("name? ")'),
    "loginfo of ROS 1": script('rclpy.loginfo("x")'),
    "logger with a number": ticking("self.get_logger().info(1.0)"),
    "logger like printf": ticking('self.get_logger().info("v = %.2f", 1.0)'),
    "logger's option": ticking('self.get_logger().info("x", throttle=1.0)'),
    "logger of the node": ticking('self.logger.info("x")'),
}
