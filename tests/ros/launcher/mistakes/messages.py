"""Mistakes with messages: fields, their values, what is published, requests and responses."""

from __future__ import annotations

from tests.ros.launcher.mistakes.programs import SERVICE, bare, bare_heard, node, ticking

FIELDS = {
    "int for float": bare("m = Float32()\nm.data = 1"),
    "int variable for float": bare("n = 3\nm = Float32()\nm.data = n"),
    "int for float in the constructor": ticking("self.p.publish(Float32(data=1))"),
    "text for float": bare('m = Float32()\nm.data = "1.0"'),
    "None for float": bare("m = Float32()\nm.data = self.last"),
    "message for float": bare("m = Float32()\nm.data = Float32(data=1.0)"),
    "parameter for float": ticking(
        'm = Float32()\nm.data = self.get_parameter("v")', init='self.declare_parameter("v", 1.0)'
    ),
    "numpy for float": bare("m = Float32()\nm.data = np.float32(1.0)"),
    "list for float": bare("m = Float32()\nm.data = [1.0]"),
    "too large for float32": bare("m = Float32()\nm.data = 1e300"),
    "method for float": ticking(
        "m = Float32()\nm.data = self.speed", init="self.speed = time.time"
    ),
    "number for text": bare("m = String()\nm.data = 1.5"),
    "bytes for text": bare('m = String()\nm.data = b"abc"'),
    "float for int": bare("m = Int32()\nm.data = 1.5"),
    "text for int": bare('m = Int32()\nm.data = "7"'),
    "300 for uint8": bare("m = UInt8()\nm.data = 300"),
    "negative for uint8": bare("m = UInt8()\nm.data = -1"),
    "int for bool": bare("m = Bool()\nm.data = 1"),
    "number for a message": bare("m = Twist()\nm.linear = 0.5"),
    "other message for a message": bare("m = Twist()\nm.linear = Point()"),
    "class for a message": bare("m = Twist()\nm.linear = Vector3"),
    "clock's time for a stamp": ticking("m = Odometry()\nm.header.stamp = self.get_clock().now()"),
    "seconds for a stamp": bare("m = Odometry()\nm.header.stamp = time.time()"),
    "number for a list": bare("m = Float32MultiArray()\nm.data = 0.5"),
    "numpy for a list": bare("m = Float32MultiArray()\nm.data = np.zeros(3)"),
    "ints in a list of floats": bare("m = JointState()\nm.position = [1, 2]"),
    "numbers in a list of texts": bare("m = JointState()\nm.name = [1, 2]"),
    "covariance too short": bare("m = Odometry()\nm.pose.covariance = [0.0] * 9"),
    "covariance of ints": bare("m = Odometry()\nm.pose.covariance = [0] * 36"),
    "pixels above 255": bare("m = Image()\nm.data = [300, 2, 3]"),
    "text for bytes": bare('m = ByteMultiArray()\nm.data = "abc"'),
    "numbers for bytes": bare("m = ByteMultiArray()\nm.data = [1, 2]"),
    "text for pixels": bare('m = Image()\nm.data = "abc"'),
    "field misspelt": bare("msg = Float32()\nmsg.dat = 1.0"),
    "field of another message": bare("msg = Twist()\nmsg.speed = 1.0"),
    "field misspelt in the constructor": bare("Float32(dat=1.0)"),
    "field that is not in the constructor": bare("Twist(speed=1.0)"),
    "field read that is not there": bare_heard("msg.ranges"),
    "data of a Twist": bare_heard("msg.data", "Twist()"),
    "value without a name": ticking("self.p.publish(Float32(1.5))"),
    "field with Cyrillic": bare("m = Float32()\nm.dаta = 1.0"),
    "constructor with Cyrillic": bare("Float32(dаta=1.0)"),
    "brackets behind a field": bare_heard("x = msg.data()"),
    "square brackets for a field": bare_heard('x = msg["data"]'),
    "data of a number": bare_heard("x = msg.data\ny = x.data"),
    "field deeper in the message": bare("m = Twist()\nm.x = 1.0"),
    "field two deeper": bare_heard("msg.position", "Odometry()"),
    "seq of ROS 1": bare_heard("msg.header.seq", "Range()"),
    "now of a message's time": bare(
        "from builtin_interfaces.msg import Time as Stamp\nm = Range()\nm.header.stamp = Stamp.now()"
    ),
    "to_sec of a stamp": bare_heard("msg.header.stamp.to_sec()", "Range()"),
    "secs of a stamp": bare_heard("msg.header.stamp.secs", "Range()"),
    "text for bool": bare('m = Bool()\nm.data = "False"'),
    "None written for text": bare("m = String()\nm.data = None"),
    "values without names": bare("v = Vector3(1.0, 2.0, 3.0)"),
    "value without a name for a message": bare("t = Twist(0.3, 0.1)"),
    "whole number without a name": bare("m = Float32(1)"),
    "value without a name for a list": bare("m = Float32MultiArray([1, 2])"),
    "field written with _": bare("t = Twist()\nt.linear_x = 1.0"),
    "field written with _ in the constructor": bare("Twist(linear_x=1.0)"),
    "field of the message around": bare(
        "from geometry_msgs.msg import TransformStamped\nt = TransformStamped()\n"
        't.header.child_frame_id = "base_link"'
    ),
    "constant in quotes": bare('r = Range()\nr.radiation_type = "ULTRASOUND"'),
    "word for int": bare('m = Int32()\nm.data = "seven"'),
    "fraction as text for int": bare('m = Int32()\nm.data = "7.5"'),
    "word for float": bare('m = Float32()\nm.data = "fast"'),
    "dictionary for float": bare("m = Float32()\nm.data = {}"),
    "class for float": bare("m = Float32()\nm.data = Float32"),
    "comma after a number": bare("m = Float32()\nm.data = 1.0,"),
    "comma after a text": bare('p = PoseStamped()\np.header.frame_id = "map",'),
    "text for a header": bare('p = PoseStamped()\np.header = "map"'),
    "pixels with three dimensions": bare("m = Image()\nm.data = np.zeros((2, 2, 3), np.uint8)"),
    "pixels of floats": bare("m = Image()\nm.data = np.zeros((2, 2, 3))"),
    "array of whole numbers": bare("m = Float32MultiArray()\nm.data = np.array([1, 2])"),
    "array with two dimensions": bare("m = LaserScan()\nm.ranges = np.array([[1.0, 2.0]])"),
    "array of texts": bare('m = Float32MultiArray()\nm.data = np.array(["a"])'),
    "list of lists": bare("m = Float32MultiArray()\nm.data = [[1.0, 2.0], [3.0, 4.0]]"),
    "list with None": bare("m = JointState()\nm.position = [None]"),
    "range for floats": bare("m = LaserScan()\nm.ranges = range(3)"),
    "map for a list": bare("m = LaserScan()\nm.ranges = map(float, [1, 2])"),
    "dictionary for a list": bare("m = LaserScan()\nm.ranges = {}"),
    "text with commas for a list": bare('m = Float32MultiArray()\nm.data = "1,2,3"'),
    "number for a covariance": bare("m = Odometry()\nm.pose.covariance = 0.0"),
    "rows of a covariance": bare("m = Odometry()\nm.pose.covariance = np.eye(6).tolist()"),
    "square brackets for a vector": bare_heard("x = msg.linear[1]", "Twist()"),
    "square brackets for a reading": bare_heard("x = msg[0]", "Float32MultiArray(data=[1.0])"),
}
SENT = {
    "another type published": ticking("self.p.publish(String())"),
    "a number published": ticking("self.p.publish(1.0)"),
    "a class published": ticking("m = Float32\nm.data = 1.0\nself.p.publish(m)"),
    "None published": ticking("self.p.publish(self.last)"),
    "the namesake published": ticking(
        "from example_interfaces.msg import Float32 as Other\nself.p.publish(Other())"
    ),
    "nothing published": ticking("self.p.publish()"),
    "service made": bare("r = AddTwoInts()"),
    "service asked without a request": node(
        'self.c = self.create_client(AddTwoInts, "/add")\nself.c.call_async(AddTwoInts.Request)'
    ),
    "service asked with numbers": node(
        'self.c = self.create_client(AddTwoInts, "/add")\nself.c.call_async(3)'
    ),
    "two numbers for a request": node(
        'self.c = self.create_client(AddTwoInts, "/add")\nself.c.call_async(1, 2)'
    ),
    "request in small letters": bare("r = AddTwoInts.request()"),
    "answer read at once": ticking(
        "r = self.c.call_async(Trigger.Request())\nr.success",
        init='self.c = self.create_client(Trigger, "/t")',
    ),
    "answer in a number": ticking(
        "x = self.c.call_async(Trigger.Request()) + 1",
        init='self.c = self.create_client(Trigger, "/t")',
    ),
    "result before it is there": ticking(
        "r = self.c.call_async(Trigger.Request()).result()\nr.success",
        init='self.c = self.create_client(Trigger, "/t")',
    ),
    "no response returned": node(
        SERVICE, "def add(self, request, response):\n    response.sum = 3"
    ),
    "number returned": node(SERVICE, "def add(self, request, response):\n    return 3"),
    "service with one argument": node(SERVICE, "def add(self, request):\n    return 3"),
    "response's field misspelt": node(
        SERVICE, "def add(self, request, response):\n    response.summe = 3\n    return response"
    ),
    "done callback without future": node(
        SERVICE + "\nself.future.add_done_callback(self.done)",
        "def add(self, request, response):\n    return response\ndef done(self):\n    pass",
    ),
    "a dictionary published": ticking('self.p.publish({"data": 1.0})'),
    "another message in a list": ticking(
        "from nav_msgs.msg import Path\nq = self.create_publisher(Path, '/path', 10)\n"
        "q.publish(Path(poses=[]))\nm = Path()\nm.poses.append(Point())\nq.publish(m)"
    ),
    "text in an array of numbers": bare(
        'm = Float32MultiArray()\nm.data = [1.0]\nm.data.append("x")'
    ),
    "publish of the node": ticking("self.publish(Float32())"),
    "publish of the function that makes": ticking("self.create_publisher.publish(Float32())"),
    "publish of a subscription": ticking(
        "self.s.publish(Float32())",
        init='self.s = self.create_subscription(Float32, "/x", lambda m: None, 10)',
    ),
    "request and response swapped": node(
        SERVICE,
        "def add(self, response, request):\n    response.sum = request.a\n    return response",
    ),
    "class of the response returned": node(
        SERVICE, "def add(self, request, response):\n    return AddTwoInts.Response"
    ),
    "future for its answer": node(
        f"{SERVICE}\nself.future.add_done_callback(self.done)",
        "def add(self, request, response):\n    return response\n\n"
        "def done(self, answer):\n    print(answer.sum)",
    ),
    "a whole number published": ticking("self.p.publish(1)"),
    "class in a list of messages": ticking(
        "from tf2_ros import TransformBroadcaster\nfrom geometry_msgs.msg import TransformStamped\n"
        "TransformBroadcaster(self).sendTransform(TransformStamped)"
    ),
}
