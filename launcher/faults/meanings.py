"""What the usual mistakes of beginners mean: a pattern of what Python or ROS says, and a sentence.

The tests provoke each in a real process; the patterns are of rclpy 7 (Jazzy) and Python 3.10 to
3.13. Wrong types of fields are only reported where rclpy checks them: `CHECK_FIELDS`.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from text.i18n import N_
from text.sentences import say

CHECK_FIELDS = "ROS_PYTHON_CHECK_FIELDS"
"""The variable that has messages of Jazzy check the values of their fields, if it is 1."""
LONGEST = 1000
"""Characters of an exception that are looked at."""


class Meaning(NamedTuple):
    """One mistake."""

    pattern: str
    """Of the exception with its text, or of a line of the log."""
    sentence: str
    """A template; its names are groups of the pattern."""
    source: str = ""
    """A pattern that the line of source code has to have, too."""


FIELDS = (
    Meaning(
        r"'bytes' object cannot be interpreted as an integer",
        N_('The data of a ByteMultiArray is a list of single bytes: write b"".join(msg.data).'),
    ),
    Meaning(
        r"The '(?P<field>\w+)' field must be of type 'float'",
        N_("The field {field} is a float: write 1.0, not 1, or float(x)."),
    ),
    Meaning(
        r"The '(?P<field>\w+)' field must be of type 'str'",
        N_("The field {field} is text: write it in quotes, or str(x)."),
    ),
    Meaning(
        r"The '(?P<field>\w+)' field must be of type 'int'",
        N_("The field {field} is a whole number: write int(x)."),
    ),
    Meaning(
        r"The '(?P<field>\w+)' field must be of type 'bool'",
        N_("The field {field} is True or False."),
    ),
    Meaning(
        r"The '(?P<field>\w+)' field must be a sub message of type '(?P<type>\w+)'",
        N_("The field {field} is a message of its own: make a {type}, and fill that."),
    ),
    Meaning(
        r"The '(?P<field>\w+)' field must be .*each value of type 'bytes'",
        N_("The field {field} is a list of single bytes: write [bytes([b]) for b in data]."),
    ),
    Meaning(
        r"The '(?P<field>\w+)' field must be .*each value of type '(?P<type>\w+)'",
        N_("The field {field} is a list, and each of its values a {type}."),
    ),
    Meaning(
        r"Invalid arguments passed to constructor: (?P<field>.+)",
        N_("The message has no field {field}: `ros2 interface show` lists its fields."),
    ),
    Meaning(
        r"AttributeError: '(?P<type>[A-Z]\w*)' object has no attribute '(?P<field>\w+)'",
        N_("A {type} has no field {field}: `ros2 interface show` lists its fields."),
        r"\b(msg|message|request|response|goal|feedback|result)\.",
    ),
    Meaning(
        r"TypeError: Expected <class .*>, got <class",
        N_("publish was given something else than the type that create_publisher has."),
    ),
)
NODES = (
    Meaning(
        r"AttributeError: '\w+' object has no attribute '_(?:default_callback_group|logger|node|"
        r"parameters|clock|context|Node__\w+)'",
        N_("Call super().__init__(name) first of all in __init__."),
    ),
    Meaning(
        r"missing 1 required positional argument: 'node_name'",
        N_('A node needs a name: super().__init__("my_node").'),
    ),
    Meaning(
        r"rclpy.init\(\) has not been called",
        N_("rclpy.init() has to be called before a node is made."),
    ),
    Meaning(
        r"Context.init\(\) must only be called once",
        N_("rclpy.init() was called a second time: once, in main, is enough."),
    ),
    Meaning(
        r"rcl_shutdown already called|Context must be initialized before it can be shutdown",
        N_("rclpy has been shut down already: write rclpy.try_shutdown(), not rclpy.shutdown()."),
    ),
    Meaning(
        r"ExternalShutdownException",
        N_("The node was asked to end: catch ExternalShutdownException around rclpy.spin."),
    ),
    Meaning(
        r"^KeyboardInterrupt",
        N_("Ctrl-C is the exception KeyboardInterrupt: catch it around rclpy.spin."),
    ),
    Meaning(
        r"'NoneType' object is not callable",
        N_("A method was called instead of handed over: write self.on_timer, without brackets."),
    ),
    Meaning(
        r"'property' object is not iterable",
        N_("rclpy.spin was given a class: make a node of it first, node = MyNode()."),
    ),
    Meaning(
        r"callback should be either be callable with one argument",
        N_("A subscription's callback takes self and the message, and goes without brackets."),
    ),
    Meaning(
        r"missing \d+ required positional arguments?: 'qos_profile'",
        N_("The last argument is missing: the queue depth, such as 10."),
    ),
    Meaning(
        r"Expected QoSProfile or int",
        N_("The last argument is the queue depth, a number without quotes."),
    ),
    Meaning(
        r"TypeError: (?P<name>[\w.]+)\(\) takes 0 positional arguments but 1 was given",
        N_("The first argument of a method is self: def {name}(self)."),
    ),
    Meaning(
        r"TypeError: (?P<name>[\w.]+)\(\) takes (?P<n>\d+) positional arguments? but (?P<m>\d+)",
        N_("{name} takes {n} arguments, and is given {m}: a service's callback takes three."),
    ),
    Meaning(
        r"TypeError: (?P<name>[\w.]+)\(\) missing \d+ required positional arguments?: (?P<what>.*)",
        N_("{name} is called without {what}: a timer's callback gets nothing but self."),
    ),
    Meaning(
        r"TypeError: float\(\) argument must be .*, not '(?:method|function)'",
        N_("The period comes first: create_timer(1.0, self.on_timer)."),
    ),
    Meaning(
        r"Invalid(?:Topic|Service)NameException",
        N_("The name of a topic or service has letters, digits, _ and /, and no blanks."),
    ),
    Meaning(
        r"InvalidNodeNameException",
        N_("The name of a node has letters, digits and _, no blanks and no slashes."),
    ),
    Meaning(
        r"ParameterNotDeclaredException",
        N_("Declare the parameter before you read it: self.declare_parameter(name, value)."),
    ),
    Meaning(r"ParameterAlreadyDeclaredException", N_("The parameter is declared twice.")),
    Meaning(
        r"InvalidParameterTypeException",
        N_("The parameter has another type than its default: 1.0 is a double, 1 an integer."),
    ),
    Meaning(r"^TypeError$", N_("A service's callback has to return the response.")),
    Meaning(
        r"Failed to create (?:subscription|publisher): .*(?:invalid allocator|incompatible type)",
        N_("This node uses the topic with another type already: a topic has one type."),
    ),
    Meaning(
        r"has no attribute '_TYPE_SUPPORT'",
        N_("The type is a class that is imported: from std_msgs.msg import Float32."),
    ),
)
PYTHON = (
    Meaning(
        r"^(?:IndentationError|TabError)",
        N_("The indentation is wrong: four blanks a level, and no tabs."),
    ),
    Meaning(r"SyntaxError: .*(?:never closed|EOF)", N_("A bracket is opened and never closed.")),
    Meaning(
        r"SyntaxError: expected ':'",
        N_("A line with def, class, if, else, for, while, try or with ends in a colon."),
    ),
    Meaning(r"SyntaxError: unterminated", N_("A quotation mark is missing at the end of a text.")),
    Meaning(r"SyntaxError: .*Maybe you meant '=='", N_("A comparison has two equals signs: ==.")),
    Meaning(
        r"^SyntaxError",
        N_("Python cannot read this line; the mistake may also be in the line above."),
    ),
    Meaning(
        r"No module named '(?P<name>[\w.]+)'",
        N_("There is no module {name}: is it spelled right, and is it installed?"),
    ),
    Meaning(
        r"cannot import name '(?P<name>\w+)' from '(?P<module>[\w.]+)'",
        N_("{module} has no {name}: is it spelled right, capitals included?"),
    ),
    Meaning(
        r"NameError: name 'self' is not defined",
        N_("The first argument of a method is called self."),
    ),
    Meaning(
        r"NameError: name '(?P<name>\w+)' is not defined",
        N_("{name} is unknown here: is it imported, or does self. belong before it?"),
    ),
    Meaning(
        r"AttributeError: '(?:function|method)' object has no attribute",
        N_("Brackets are missing: self.get_logger().info(...)."),
    ),
    Meaning(
        r"AttributeError: 'NoneType' object has no attribute",
        N_("It is None: has anything been put there yet?"),
    ),
    Meaning(
        r"AttributeError: '(?P<type>\w+)' object has no attribute '(?P<name>\w+)'",
        N_("A {type} has no {name}: is it made in __init__, and spelled the same there?"),
    ),
    Meaning(
        r"TypeError: .*NoneType",
        N_("The value is None: has anything been put there yet, such as a first message?"),
    ),
    Meaning(
        r"UnicodeDecodeError", N_('The bytes are not UTF-8: decode("utf-8", errors="replace").')
    ),
    Meaning(r"JSONDecodeError", N_("The text is not JSON: catch the exception, and move nothing.")),
    Meaning(
        r"ValidationError",
        N_("The JSON does not fit the model: catch ValidationError, and move nothing."),
    ),
    Meaning(
        r"ZeroDivisionError",
        N_("Divided by zero: straight ahead, the radius of the turn has no end."),
    ),
    Meaning(r"can only concatenate str", N_("A text and a number cannot be added: write str(x).")),
    Meaning(r"KeyError: (?P<key>.+)", N_("There is no {key} in it.")),
    Meaning(r"IndexError", N_("The list is not that long: is it empty?")),
)
CRASHES = (*FIELDS, *NODES, *PYTHON)
"""In order: the first that fits counts."""
WARNINGS = (
    Meaning(
        r"callback \S+ still runs after",
        N_("Until a callback returns, the node hears nothing: let a timer do the waiting."),
    ),
    Meaning(
        r"incompatible QoS",
        N_("The QoS of publisher and subscription do not fit each other: nothing arrives."),
    ),
    Meaning(
        r"Publisher already registered for (?:provided )?node name",
        N_("Two nodes have the same name: rename one of them."),
    ),
)
"""Mistakes that show in a line of the log only, while the node runs on."""


def meaning_of(exception: str, source: str = "") -> str:
    """Return the sentence for an exception, empty if there is none."""
    return _first(CRASHES, exception, source)


def warning_of(line: str) -> str:
    """Return the sentence for a line of the log, empty if there is none."""
    return _first(WARNINGS, line, "")


def _first(rows: tuple[Meaning, ...], text: str, source: str) -> str:
    for row in rows:
        found = re.search(row.pattern, text[:LONGEST])
        if found and re.search(row.source, source):
            return say(row.sentence, **found.groupdict())
    return ""
