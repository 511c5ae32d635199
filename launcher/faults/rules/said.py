"""Exceptions that tell by themselves what is wrong: a table, and what needs a look at the objects as well."""

from __future__ import annotations

import ast
import gc
import re
from typing import NamedTuple

from launcher.faults.failure import Failure, is_from, shown
from launcher.faults.rules.names import mixed
from text.i18n import N_
from text.sentences import Words, say
from text.suggestions import nearest

UNHEARD = N_(
    "A Buffer hears nothing by itself: self.listener = TransformListener(self.buffer, self) in __init__ fills it."
)
OF_ROS = "--ros-args|__node:=|__ns:="
_NO_JSON = N_("The text is not JSON: catch the exception, and move nothing.")
TAKEN_ARGUMENTS = N_(
    "the arguments of ROS stand after --ros-args, and this reads them as its own; take them "
    "out first: rclpy.utilities.remove_ros_args(sys.argv)[1:], as in parser.parse_args(...)"
)


class Said(NamedTuple):
    """What a mistake of a beginner looks like, and what it means."""

    kinds: str
    """The names of the exception's classes; of all, if there is none."""
    raised_in: str
    """A pattern of `file:function` at some level of the traceback."""
    said: str
    """A pattern of what the exception says; its groups fill the sentence."""
    sentence: str


ROWS = (
    Said("", "", OF_ROS, TAKEN_ARGUMENTS),
    Said("NotInitializedException", "", "", N_("rclpy.init() has to be called before a node is made.")),
    Said(
        "ExternalShutdownException", "", "",
        N_("The node was asked to end: catch ExternalShutdownException around rclpy.spin."),
    ),
    Said(
        "KeyboardInterrupt", "", "", N_("Ctrl-C is the exception KeyboardInterrupt: catch it around rclpy.spin.")
    ),
    Said("ParameterAlreadyDeclaredException", "", "", N_("The parameter is declared twice.")),
    Said(
        "InvalidParameterTypeException", "", "",
        N_("The parameter has another type than its default: 1.0 is a double, 1 an integer."),
    ),
    Said(
        "InvalidParameterValueException", "", "",
        N_("The value was refused, by the range in the parameter's descriptor or by your own callback."),
    ),
    Said(
        "ParameterUninitializedException", "", "(?P<name>'[^']+')",
        N_("The parameter {name} was declared by its type alone, and nobody has given it a value:"
           " declare it with a default, self.declare_parameter({name}, …), or set it in the"
           " profile."),
    ),
    Said(
        "ParameterImmutableException", "", "",
        N_("The parameter is read_only: its value is given at the start, and not changed."),
    ),
    Said("InvalidHandle", "", "", N_("This was destroyed already: it is used after destroy_node().")),
    Said("InvalidQoSProfileException", "", "", N_("A QoSProfile needs its depth: QoSProfile(depth=10).")),
    Said("UnknownROSArgsError", "", "", N_("ROS does not know the arguments that stand after --ros-args.")),
    Said(
        "NoTypeSupportImportedException", "", "",
        N_("The type's package is not built for Python: is it built and sourced?"),
    ),
    Said(
        "RuntimeError", "/rclpy/.*:init$", "called once",
        N_("rclpy.init() was called a second time: once, in main, is enough."),
    ),
    Said(
        "RCLError RuntimeError", "/rclpy/.*:shutdown$", "",
        N_("rclpy has been shut down already: write rclpy.try_shutdown(), not rclpy.shutdown()."),
    ),
    Said(
        "ValueError", "/rclpy/impl/rcutils_logger", "",
        N_("A line of a program logs always alike, with one severity, one name, one filter: write two"
           " lines, an info() in the one branch and an error() in the other."),
    ),
    Said(
        "RCLError", "/rclpy/action/server.py:(succeed|abort)$", "",
        N_("The goal has ended already: succeed, abort or canceled comes once, at the end."),
    ),
    Said(
        "RCLError", "/rclpy/action/server.py:canceled$", "",
        N_("Only a goal that somebody has cancelled ends by canceled(): ask before, if"
           " goal_handle.is_cancel_requested."),
    ),
    Said(
        "RuntimeError", "/asyncio/", "",
        N_("rclpy does not run asyncio: in its callbacks await goes with futures of rclpy, such as"
           " client.call_async(request); for a pause take a timer."),
    ),
    Said(
        "TypeError", "/rclpy/time.py:", "different clock types",
        N_("The two times are of different clocks: Time() alone is the system's, the node's is that of"
           " ROS. Make both by self.get_clock().now() or Time.from_msg(stamp)."),
    ),
    Said(
        "ConnectivityException", "", "",
        N_("Both frames are there, and nothing joins them: a transform between them is missing, or is"
           " published under another name."),
    ),
    Said(
        "InvalidArgumentException", "", "",
        N_("The name of a frame is empty, or begins with a slash: base_link, without one."),
    ),
    Said(
        "SerialException", "", r"port (?P<port>COM\d+)",
        N_("{port} is a name of Windows: here a serial port is /dev/ttyUSB0 or /dev/ttyACM0."),
    ),
    Said(
        "SerialException", "", r"port (?P<port>\S+): \[Errno 2\]",
        N_("{port} is not there: is the device plugged in?"),
    ),
    Said(
        "SerialException", "", r"port (?P<port>\S+): \[Errno 13\]",
        N_("{port} may not be opened: is the user in the group dialout?"),
    ),
    Said("SerialException", "", r"port (?P<port>\S+): \[Errno 16\]", N_("{port} is in use by another program.")),
    Said(
        "FileNotFoundError", "subprocess", "directory: '(?P<name>[^']+)'",
        N_("There is no program {name} here: is it installed?"),
    ),
    Said(
        "FileNotFoundError", "", "directory: '(?P<name>[^']+)'",
        N_("There is no file {name}. A name without a slash in front is looked for in the folder"
           " that the program was started in, not beside its file: Path(__file__).parent / …"),
    ),
    Said("IsADirectoryError", "", "directory: '(?P<name>[^']+)'", N_("{name} is a folder, not a file.")),
    Said(
        "PermissionError", "", ": '(?P<name>[^']+)'",
        N_("{name} may not be opened: whose is it? For a device, is the user in its group (dialout, video, audio)?"),
    ),
    Said(
        "ConnectionRefusedError", "", "",
        N_("Nobody listens there: is the server running, and is the port right?"),
    ),
    Said(
        "EOFError", "", "reading a line",
        N_("A node has no keyboard: input() gets nothing. Take a parameter, or a topic that is published to."),
    ),
    Said(
        "ValueError", "/rclpy/", "name '(?P<name>[^']+)' is invalid: unknown substitution",
        N_('The f is missing in front of the name: f"{name}" puts the value of a variable there.'),
    ),
    Said("UnicodeDecodeError", "", "", N_('The bytes are not UTF-8: decode("utf-8", errors="replace").')),
    Said("JSONDecodeError", "", "", _NO_JSON),
    Said(
        "ValidationError", "/pydantic/", "",
        N_("The JSON does not fit the model: catch ValidationError, and move nothing."),
    ),
    Said(
        "AttributeError", "/json/__init__.py:load$", "",
        N_("json.load reads from a file that is open: with open(…) as file: json.load(file). Of a"
           " text it is json.loads."),
    ),
    Said(
        "TypeError", "", "bytes-like object is required, not 'str'|please encode to bytes|can't concat str to bytes",
        N_("Text and bytes do not go together: text.encode() makes bytes, data.decode() text."),
    ),
    Said("RecursionError", "", "", N_("{name} calls itself again and again, and never comes to an end.")),
    Said(
        "RuntimeError", "/threading.py:start$", "once", N_("A thread is started once: make a new one for each time.")
    ),
    Said(
        "ValueError", "", "truth value of an array",
        N_("An array has many values, and if asks one question: any(…) or all(…)."),
    ),
    Said(
        "ValueError", "", r"array of size (?P<count>\d+) into shape (?P<shape>\([\d, ]+\))",
        N_("{count} values do not make an array of the shape {shape}."),
    ),
    Said(
        "ValueError", "", "matmul|not aligned|broadcast|number of dimensions",
        N_("The shapes of the two arrays do not fit each other: look at a.shape, b.shape."),
    ),
    Said("ValueError", "", "zero-size array|of an empty sequence", N_("The array is empty: ask len(…) before.")),
)  # fmt: skip
"""In order: the first that fits counts."""


def rows(failure: Failure) -> Words | None:
    """What the table says of an exception."""
    kinds = {each.__name__ for each in type(failure.error).__mro__}
    places = [f"{each.file}:{each.function}" for each in failure.levels]
    said = str(failure.error)
    for row in ROWS:
        if row.kinds and kinds.isdisjoint(row.kinds.split()):
            continue
        found = re.search(row.said, said)
        if found and any(re.search(row.raised_in, each) for each in places):
            function = failure.own.function if failure.own is not None else "?"
            return say(row.sentence, **{"name": function, **found.groupdict()})
    return None


def undeclared(failure: Failure) -> Words | None:
    """A parameter was not declared."""
    if type(failure.error).__name__ != "ParameterNotDeclaredException":
        return None
    node, calls = failure.named("self"), [one for each in failure.all(ast.Call) for one in ast.walk(each)]
    asked = [failure.value(each.args[0]) for each in calls if isinstance(each, ast.Call) and each.args]
    name = next((each for each in asked if isinstance(each, str)), "name")
    meant = nearest(name, list(node._parameters)) if is_from(node, "rclpy", "Node") else ""
    if meant:
        return say("No parameter {name} is declared; did you mean {meant!r}?", name=repr(name), meant=meant)
    return say(
        "Declare the parameter before you read it, in __init__: self.declare_parameter({name}, 0.0).", name=repr(name)
    )


def bad_name(failure: Failure) -> Words | None:
    """The name of a node, a topic or a service is not allowed."""
    kinds = {each.__name__ for each in type(failure.error).__mro__}
    if "NameValidationException" not in kinds:
        return None
    values = failure.inner.values if failure.inner is not None else {}
    at = values.get("invalid_index", 0)
    name = next((each for each in values.values() if isinstance(each, str) and each != values.get("error_msg")), "")
    words = mixed(name)
    if words is not None:
        return words
    sign = name[at] if isinstance(at, int) and at < len(name) else ""
    if "InvalidNodeNameException" in kinds:
        phrase = N_(
            "The name of a node has letters, digits and _, and begins with no digit; {name!r} has"
            " {sign!r} at {place}."
        )
        return say(phrase, name=name, sign=sign, place=at + 1)
    if "InvalidNamespaceException" in kinds:
        return say("A namespace has letters, digits, _ and /: {name!r}.", name=name)
    phrase = N_(
        "The name of a topic or service has letters, digits, _ and /, and no digit after a /;"
        " {name!r} has {sign!r} at {place}."
    )
    return say(phrase, name=name, sign=sign, place=at + 1)


def spun_twice(failure: Failure) -> Words | None:
    """An executor was spun while it was spun already: within a callback, or by another thread."""
    if not is_spun_twice(failure):
        return None
    if any(level.function == "handler" and level.is_in("rclpy") for level in failure.levels):
        return say(
            "The node is spun within its own callback: spin once, in main, and have answers"
            " called back, future.add_done_callback(self.on_answer)."
        )
    return say(
        "Several threads spin one executor, which only one can, and rclpy.spin(node) takes the same"
        " for all nodes: give them all to one, executor = MultiThreadedExecutor(),"
        " executor.add_node(node), and executor.spin() once, in main."
    )


def is_spun_twice(failure: Failure) -> bool:
    """Whether an executor says that somebody else is at work in it."""
    inner = failure.inner
    if inner is None or inner.function != "wait_for_ready_callbacks" or not inner.is_in("rclpy"):
        return False
    return isinstance(failure.error, (TypeError, ValueError)) and bool(
        re.search("generator already executing|not an iterator", str(failure.error))
    )


def two_types(failure: Failure) -> Words | None:
    """A topic was used with two types in one node."""
    makers = ("create_publisher", "create_subscription")
    level = next((each for each in failure.below("rclpy") if each.function in makers), None)
    if level is None or type(failure.error).__name__ not in ("RCLError", "RuntimeError"):
        return None
    node, topic = level.values["self"], level.values.get("final_topic", level.values.get("topic"))
    others = {each.msg_type.__name__ for each in (*node.publishers, *node.subscriptions) if each.topic_name == topic}
    if not others:
        return None
    phrase = N_("This node uses {topic} with the type {other} already: a topic has one type.")
    return say(phrase, topic=topic, other=", ".join(others))


def looked_up(failure: Failure) -> Words | None:
    """A frame is not known, or not at that time."""
    kind = type(failure.error).__name__
    asked = [level.values for level in failure.levels if level.is_in("tf2_ros")]
    buffer = next((each["self"] for each in asked if type(each.get("self")).__name__ == "Buffer"), None)
    if kind == "LookupException":
        # A node keeps the listener that it was given to, whoever has made it.
        if buffer is not None and not buffer.all_frames_as_yaml().strip(" {}[]\n"):
            listeners = (each for each in gc.get_objects() if type(each).__name__ == "TransformListener")
            if not any(vars(each).get("buffer") is buffer for each in listeners):
                return say(UNHEARD)
        return say(
            "Nobody has published this frame yet: in the first seconds that is normal, so catch"
            " TransformException and try again; later, look at its name in Frames."
        )
    if kind == "ExtrapolationException":
        if any(getattr(each.get("time"), "nanoseconds", 1) == 0 for each in asked):
            return say("The frames have no time in common: one of them is published no more.")
        return say(
            "The transform of this very moment is still under way: ask for the newest one,"
            " rclpy.time.Time(), or wait for it, timeout=Duration(seconds=0.1) in a thread of"
            " its own. Catch TransformException."
        )
    return None


_CALL = re.compile(r"\w+\((?P<names>[^)]*)\)")
"""How the documentation of OpenCV's functions begins, which alone has the names of their arguments."""
_REFUSED = re.compile(r"'(?P<name>\w+)'(?: is required to be an integer|. Sequence item with index)")


def opencv(failure: Failure) -> Words | None:
    """OpenCV or cv_bridge refuses a picture."""
    error, calls = failure.error, failure.all(ast.Call)
    if type(error).__name__ == "CvBridgeError":
        found = re.search(r"encoding \[(\w+)\]", str(error))
        if found:
            return say(
                "ROS has no encoding {name!r}; the usual ones are bgr8, rgb8, mono8, 16UC1 and 32FC1.", name=found[1]
            )
        if not any(each.function == "imgmsg_to_cv2" for each in failure.levels):
            return None
        return say(
            'The picture has another encoding than is asked for: look at msg.encoding, or ask for "passthrough".'
        )
    if type(error).__module__ != "cv2":
        return None
    if {getattr(each.func, "attr", "") for each in calls} & {"imshow", "waitKey", "namedWindow", "destroyAllWindows"}:
        return say("This OpenCV has no windows: publish the picture, and look at it in Topics.")
    for call in calls:
        for each in call.args:
            value, what = failure.value(each), shown(each)
            if hasattr(type(value), "get_fields_and_field_types"):
                return say(
                    '{what} is a message, not a picture: CvBridge().imgmsg_to_cv2({what}, "bgr8") makes one of it.',
                    what=what,
                )
            if value is None or getattr(value, "size", 1) == 0:
                return say("{what} is not a picture, or is an empty one: was it read, has one arrived?", what=what)
    found = _REFUSED.search(str(error))
    for call in calls if found else ():
        known = _CALL.match(getattr(failure.called(call), "__doc__", None) or "")
        names = re.findall(r"\w+", known["names"]) if known else []
        at = names.index(found["name"]) if found and found["name"] in names else len(call.args)
        node = call.args[at] if at < len(call.args) else None
        if node is not None and found is not None:
            if "item" not in found[0]:
                phrase = N_("{call}: {name} is a whole number: int({what}) cuts the fraction off.")
                return say(phrase, call=shown(call.func), name=found["name"], what=shown(node))
            items: list[ast.expr] = getattr(node, "elts", [])
            parts = [shown(one) if type(failure.value(one)) is int else f"int({shown(one)})" for one in items]
            made = f"({', '.join(parts)})" if parts else f"tuple(int(v) for v in {shown(node)})"
            phrase = N_("{call}: the values of {name} are whole numbers: {made}.")
            return say(phrase, call=shown(call.func), name=found["name"], made=made)
    for call in calls:
        for each in call.args:
            value = failure.value(each)
            if hasattr(value, "dtype") and hasattr(value, "shape"):
                return say(
                    "{call} does not take these values: {what} has the shape {shape} and the type"
                    " {dtype}. Is that what it needs, and are the other values?",
                    call=shown(call.func),
                    what=shown(each),
                    shape=str(value.shape),
                    dtype=str(value.dtype),
                )
    return None
