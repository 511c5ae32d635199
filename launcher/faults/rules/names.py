"""Names and modules: unknown, misspelt, not imported, of ROS 1, of another alphabet, hidden; where ROS has them."""

from __future__ import annotations

import ast
import builtins
import importlib
import importlib.util
import pkgutil
import re
import sys
import unicodedata
from collections.abc import Iterable
from types import ModuleType

from launcher.faults.failure import UNKNOWN, Failure
from text.i18n import N_
from text.sentences import Words, say
from text.suggestions import near, nearest

MODULES = (
    "rclpy.node", "rclpy.qos", "rclpy.time", "rclpy.duration", "rclpy.executors", "rclpy.action",
    "rclpy.callback_groups", "rclpy.parameter", "rclpy.clock", "rclpy.exceptions", "rclpy.logging",
    "tf2_ros", "cv_bridge",
)  # fmt: skip
PACKAGES = (
    "std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs", "std_srvs", "example_interfaces",
    "builtin_interfaces", "diagnostic_msgs", "visualization_msgs", "trajectory_msgs",
    "rcl_interfaces", "ackermann_msgs", "tf2_msgs", "deck_interfaces", "action_msgs",
)  # fmt: skip
OF_ROS1 = (
    "rospy", "roslib", "rosbag", "tf", "actionlib", "roslaunch", "dynamic_reconfigure",
    "tf_conversions", "moveit_commander", "ros_numpy", "rosgraph", "rosmsg", "rosnode", "rosparam",
    "rosserial_msgs", "rosserial_python", "rosservice", "rostopic",
)  # fmt: skip
OF_ROS = (
    "action_tutorials_interfaces", "action_tutorials_py", "actionlib_msgs", "ament_copyright",
    "ament_flake8", "ament_index_python", "ament_pep257", "apriltag_msgs", "audio_common_msgs",
    "camera_calibration", "can_msgs", "cartographer_ros_msgs", "control_msgs", "controller_manager",
    "controller_manager_msgs", "demo_nodes_py", "depthai_ros_msgs", "diagnostic_aggregator",
    "diagnostic_updater", "domain_coordinator", "dwb_msgs", "event_camera_msgs",
    "examples_rclpy_executors", "examples_rclpy_minimal_action_client",
    "examples_rclpy_minimal_action_server", "examples_rclpy_minimal_client",
    "examples_rclpy_minimal_publisher", "examples_rclpy_minimal_service",
    "examples_rclpy_minimal_subscriber", "foxglove_msgs", "gazebo_msgs", "geographic_msgs",
    "gps_msgs", "grid_map_msgs", "image_geometry", "image_transport", "irobot_create_msgs",
    "joint_state_publisher", "laser_geometry", "launch", "launch_pytest", "launch_ros",
    "launch_testing", "launch_xml", "launch_yaml", "map_msgs", "mavros", "mavros_msgs",
    "message_filters", "micro_ros_msgs", "moveit", "moveit_configs_utils", "moveit_msgs",
    "nav2_common", "nav2_msgs", "nav2_simple_commander", "nav_2d_msgs", "nmea_msgs",
    "object_recognition_msgs", "octomap_msgs", "pcl_msgs", "py_trees", "py_trees_ros", "PyKDL",
    "python_qt_binding", "qt_gui", "radar_msgs", "rclpy_message_converter",
    "realsense2_camera_msgs", "rmf_task_msgs", "robot_localization", "ros2action", "ros2bag",
    "ros2cli", "ros2doctor", "ros2interface", "ros2launch", "ros2lifecycle", "ros2node",
    "ros2param", "ros2pkg", "ros2run", "ros2service", "ros2topic", "ros_gz_interfaces", "rosapi",
    "rosapi_msgs", "rosbag2_interfaces", "rosbag2_py", "rosbridge_library", "rosbridge_msgs",
    "rosidl_runtime_py", "rqt", "rqt_graph", "rqt_gui", "rqt_gui_py", "rqt_plot", "rtabmap_msgs",
    "sensor_msgs_py", "slam_toolbox", "sros2", "statistics_msgs", "teleop_twist_keyboard",
    "test_msgs", "tf2_kdl", "tf2_sensor_msgs", "tf2_tools", "tf_transformations",
    "tracetools_trace", "turtle_tf2_py", "turtlebot3_msgs", "turtlebot4_msgs", "turtlesim",
    "ublox_msgs", "ur_msgs", "urdf_parser_py", "velodyne_msgs", "vision_msgs", "webots_ros2_driver",
    "webots_ros2_msgs", "xacro",
)  # fmt: skip
"""Packages of ROS that Deck does not bring."""
_PACKAGED = {
    "moveit": "moveit-py", "PyKDL": "python-orocos-kdl-vendor", "urdf_parser_py": "urdfdom-py",
}  # fmt: skip
"""Where it is not called as what is imported."""
KINDS = ("msg", "srv", "action")
ROS1 = {
    "init_node": N_("rclpy.init(), and a class of its own: class MyNode(Node)"),
    "Publisher": N_('self.create_publisher(String, "topic", 10), in a node'),
    "Subscriber": N_('self.create_subscription(String, "topic", self.callback, 10), in a node'),
    "Service": N_('self.create_service(AddTwoInts, "name", self.callback), in a node'),
    "ServiceProxy": N_('self.create_client(AddTwoInts, "name"), in a node'),
    "Timer": N_("self.create_timer(0.5, self.on_timer), in a node"),
    "Rate": N_("self.create_timer(0.1, self.on_timer), in a node, instead of a loop"),
    "sleep": N_("self.create_timer(0.5, self.on_timer), in a node, instead of waiting"),
    "loginfo": "self.get_logger().info(…)",
    "logwarn": "self.get_logger().warn(…)",
    "logerr": "self.get_logger().error(…)",
    "get_param": "self.declare_parameter(name, default).value",
    "is_shutdown": "rclpy.ok()",
    "get_time": "self.get_clock().now()",
    "Time": N_("rclpy.time.Time, or self.get_clock().now()"),
    "ROSInterruptException": "rclpy.executors.ExternalShutdownException",
    "wait_for_message": N_("self.create_subscription(…), and a callback"),
}
"""Names of rospy, and what is written in ROS 2 instead."""


def ros1(name: str) -> Words:
    """Say what takes the place of a name of ROS 1."""
    return say("{name} is of ROS 1. In ROS 2 it is: {instead}.", name=name, instead=say(ROS1[name]))


def home_of(name: str, not_in: str = "") -> str:
    """Return the module that has a class of this name, empty if none of ROS has it."""
    if not re.fullmatch(r"[A-Z]\w*", name):
        return ""
    inside = not_in.partition(".")[0]
    packages = sorted(PACKAGES, key=lambda each: each != inside)
    places = [*MODULES, *(f"{package}.{kind}" for package in packages for kind in KINDS)]
    if inside in PACKAGES:
        places = places[len(MODULES) :] + places[: len(MODULES)]
    return next((each for each in places if each != not_in and _has_class(each, name)), "")


def _has_class(module: str, name: str) -> bool:
    try:
        if importlib.util.find_spec(module) is None:
            return False
        found = getattr(importlib.import_module(module), name, None)
        return isinstance(found, type) and found.__module__.startswith(module)
    except Exception:  # noqa: BLE001 - whatever is wrong there, it is not what the learner asks
        return False


def apt_name(name: str) -> str:
    """Return what follows `ros-jazzy-` in the name of the package with this module."""
    return _PACKAGED.get(name, name.replace("_", "-"))


def shadowing(module: ModuleType | None, folder: str) -> Words | None:
    """Say that a file of the learner's own has the name of a module, and hides it."""
    file, name = getattr(module, "__file__", None) or "", getattr(module, "__name__", "")
    known = name in sys.stdlib_module_names or name in ("rclpy", "numpy", "cv2", "std_msgs", "tf2_ros")
    if not known or file.rpartition("/")[0] != folder:
        return None
    return say("Your own file {name}.py hides the module {name}: give the file another name.", name=name)


_ALIASES = {"np": "import numpy as np", "cv": "import cv2", "plt": "import matplotlib.pyplot as plt"}
_OTHER_WORDS = {
    "true": "True", "false": "False", "null": "None", "none": "None", "nil": "None", "TRUE": "True",
    "FALSE": "False", "Error": "Exception", "console": "print(…)", "printf": "print(…)", "this": "self",
}  # fmt: skip
_OF_TODAY = ("sleep", "Time", "Timer", "Service", "get_time")
"""Names of rospy that other modules have as well."""
_CYRILLIC = str.maketrans("асеорхукАСЕОРХКМТВН", "aceopxykACEOPXKMTBH")
_USUAL = ("time", "math", "random", "functools", "datetime", "threading", "copy", "pathlib")
"""Modules whose names beginners use without importing them."""


def alphabet(failure: Failure) -> Words | None:
    """A name has a letter that only looks like a Latin one."""
    error = failure.error
    names = [getattr(error, "name", None), getattr(error, "name_from", None)]
    if isinstance(error, (TypeError, AssertionError, KeyError)):
        names += [each.arg for call in failure.all(ast.Call) for each in call.keywords]
        names += list(error.args) if isinstance(error, KeyError) else []
    elif not isinstance(error, (NameError, AttributeError, ImportError)):
        return None
    if isinstance(error, ImportError) and isinstance(failure.statement, ast.ImportFrom):
        names += [each.name for each in failure.statement.names]
    if isinstance(error, AttributeError):
        names += [each.attr for each in failure.all(ast.Attribute)]
    return next((words for each in names if isinstance(each, str) and (words := mixed(each)) is not None), None)


def mixed(name: str) -> Words | None:
    """Say which letter of a name is of another alphabet than the rest; None if none is."""
    has_latin = any(each.isascii() and each.isalpha() for each in name)
    for index, each in enumerate(name):
        if has_latin and not each.isascii() and each.isalpha():
            return say(
                "In {name} the letter {number}, {letter}, is not Latin ({alphabet}): type it again"
                " on the Latin keyboard.",
                name=name,
                number=index + 1,
                letter=each,
                alphabet=unicodedata.name(each, "?").partition(" ")[0].title(),
            )
    return None


def _name(error: NameError) -> str:
    """Return the name of an error, which has it apart since Python 3.10 only for what is global."""
    found = re.search(r"'([^']+)'", str(error))
    return str(getattr(error, "name", None) or (found[1] if found else "?"))


def local(failure: Failure) -> Words | None:
    """A variable of a function was read before it has a value."""
    if not isinstance(failure.error, UnboundLocalError):
        return None
    name = _name(failure.error)
    if failure.own is not None and name in failure.own.frame.f_globals:
        return say(
            "{name} is given a value in this function, and is therefore a variable of its own here."
            " For the one outside: global {name}; in a node rather self.{name}.",
            name=name,
        )
    return say(
        "{name} has no value yet: it is given one only below, or in a branch that was not taken. Give it one before.",
        name=name,
    )


def unknown(failure: Failure) -> Words | None:
    """A name is unknown."""
    if not isinstance(failure.error, NameError) or isinstance(failure.error, UnboundLocalError):
        return None
    name, me = _name(failure.error), failure.named("self")
    if name in _OTHER_WORDS and not (name == "this" and me is UNKNOWN):
        return say("In Python it is written {meant}, not {name}.", meant=_OTHER_WORDS[name], name=name)
    if name in ("self", "this"):
        return say(
            "self is unknown here: it is the first argument of a method, def on_timer(self), and"
            " outside of a method there is none."
        )
    if me is not UNKNOWN and (hasattr(type(me), name) or name in vars(me)):
        return say("{name} belongs to the node: write self.{name}.", name=name)
    if name in ("name", "main", "_name_") and "__main__" in [each.value for each in failure.all(ast.Constant)]:
        return say("{name} has two underscores on either side here: {meant}.", name=name, meant="__name__")
    known = {*failure.own.values, *failure.own.frame.f_globals} if failure.own is not None else ()
    alike = next((each for each in known if not each.isascii() and each.translate(_CYRILLIC) == name), "")
    if alike:
        phrase = N_(
            "{name} is unknown here; the {other} above looks the same, and is written in"
            " Cyrillic letters: type it again on the Latin keyboard."
        )
        return say(phrase, name=name, other=alike)
    return (
        _of_ros1(failure, name)
        or _importable(failure, name)
        or _misspelt(failure, name)
        or say(
            "{name} is unknown here: is it spelled right and imported, is it made above in the same"
            " function? If it is a text, it stands in quotes.",
            name=name,
        )
    )


def _of_ros1(failure: Failure, name: str) -> Words | None:
    """Say what is written instead of a name of rospy."""
    if name == "rospy":
        name = next((each.attr for each in failure.all(ast.Attribute) if each.attr in ROS1), "")
    return ros1(name) if name in ROS1 and name not in _OF_TODAY else None


def _importable(failure: Failure, name: str) -> Words | None:
    if name in _ALIASES:
        return say("{name} is not imported: {line}.", name=name, line=_ALIASES[name])
    home = home_of(name)
    if not home:
        asked = [each.attr for each in failure.all(ast.Attribute) if getattr(each.value, "id", "") == name]
        if asked and _answers(name, asked):
            return say("{name} is not imported: import {name}.", name=name)
        home = next((each for each in _USUAL if hasattr(sys.modules.get(each), name)), "")
    if home and not name.startswith("_"):
        return say("{name} is not imported: from {home} import {name}.", name=name, home=home)
    return None


def _answers(name: str, asked: list[str]) -> bool:
    """Whether there is a module with one of the names that are asked of it."""
    try:
        if name in ("this", "antigravity") or importlib.util.find_spec(name) is None:
            return False
        module = sys.modules.get(name) or importlib.import_module(name)
    except Exception:  # noqa: BLE001 - whatever is wrong there, it is not what the learner asks
        return False
    return any(hasattr(module, each) for each in asked)


def _misspelt(failure: Failure, name: str) -> Words | None:
    if failure.own is None:
        return None
    own = {*failure.own.values, *failure.own.frame.f_globals} - set(vars(builtins))
    usual = [each for each in vars(builtins) if len(each) > 3 and (each[0].islower() or each[-5:] == name[-5:])]
    me = failure.named("self")
    of_self = near(name, dir(me), cutoff=0.75) if me is not UNKNOWN else []
    found = near(name, [*own, *usual], cutoff=0.75) or near(name, own, cutoff=0.67)
    found += [f"self.{each}" for each in of_self]
    return say("{name} is unknown here; did you mean {meant}?", name=name, meant=found[0]) if found else None


OF_TUTORIALS = ("tutorial_interfaces", "more_interfaces", "custom_action_interfaces")
"""Packages of messages that the tutorials of ROS have one make."""
OF_PYPI = {
    "serial": "pyserial", "yaml": "pyyaml", "PIL": "pillow", "sklearn": "scikit-learn",
    "usb": "pyusb", "smbus": "smbus2", "Image": "pillow", "RPi": "RPi.GPIO", "rospkg": "rospkg",
}  # fmt: skip
KNOWN = (
    "ackermann_msgs", "builtin_interfaces", "cv2", "cv_bridge", "deck_interfaces",
    "diagnostic_msgs", "example_interfaces", "geometry_msgs", "json", "math", "nav_msgs", "numpy",
    "pydantic", "random", "rclpy", "sensor_msgs", "std_msgs", "std_srvs", "tf2_msgs", "tf2_ros",
    "time", "visualization_msgs",
)  # fmt: skip
"""Modules that a beginner may have meant."""
OF_CPP = {"tf2": "tf2_ros", "rclcpp": "rclpy"}
"""Packages for C++, and what takes their place in Python."""


def not_found(failure: Failure) -> Words | None:
    """There is no such module, or it is beside this file and imported with a point before it."""
    error, statement = failure.error, failure.statement
    if isinstance(error, ImportError) and isinstance(statement, ast.ImportFrom) and statement.level:
        phrase = N_("A file beside this one is imported without a point: from {module} import {name}.")
        return say(phrase, module=statement.module or "x", name=statement.names[0].name)
    if not isinstance(error, ModuleNotFoundError) or not error.name:
        return None
    if isinstance(statement, ast.ImportFrom) and "." in error.name:
        name = statement.names[0].name
        home = home_of(name, error.name)
        if home:
            return say("{name} is in {home}: from {home} import {name}.", name=name, home=home)
    return missing_import(error.name, statement, failure.folder)


def missing_import(name: str, statement: ast.stmt | None, folder: str) -> Words:
    """Say what is meant by a module that a statement imports and that is not there."""
    if isinstance(statement, ast.ImportFrom):
        package, _, kind = (statement.module or "").partition(".")
        if package == name and kind in KINDS:
            return missing_messages(package, kind, [each.name for each in statement.names])
    return missing_module(name, folder)


def missing_messages(package: str, kind: str, names: list[str]) -> Words:
    """Say what is meant by a package of messages that is not there, or how to get it."""
    if package in OF_TUTORIALS:
        return _of_tutorial(package)
    of_ros = package in (*OF_ROS1, *OF_ROS)
    meant = "" if of_ros or package in PACKAGES else _like(package, PACKAGES, 0.8)
    if meant:
        return say("There is no module {name}; did you mean {meant}?", name=package, meant=meant)
    for name in names:
        home = home_of(name)
        if home == f"example_interfaces.{kind}":
            return say("{name} is in {home}: from {home} import {name}.", name=name, home=home)
    if of_ros:
        return missing_module(package, "")
    return say(
        "The message package {name} is not here: is it spelled right? One of your own goes into"
        " interfaces/, and make setup builds it.",
        name=package,
    )


def _of_tutorial(package: str) -> Words:
    return say(
        "{name} is a package that the tutorial has you make yourself: copy its folder into"
        " interfaces/, and make setup builds it.",
        name=package,
    )


def _like(name: str, known: Iterable[str], cutoff: float) -> str:
    """Return the name that may be meant, empty if none is.

    Of two that end alike, what is before counts: else every …_interfaces would be like every other.
    """
    meant = next(iter(near(name, known, cutoff=cutoff)), "")
    stem, _, end = name.rpartition("_")
    other, _, same = meant.rpartition("_")
    return meant if end != same or near(stem, [other], cutoff=cutoff) else ""


def missing_module(name: str, folder: str) -> Words:
    """Say what is meant by a module that is not there, or how to get it."""
    first, _, rest = name.partition(".")
    if first in OF_ROS1:
        return say(
            "{name} is of ROS 1; this is ROS 2: import rclpy, and a class of its own, class MyNode(Node).", name=first
        )
    if rest and first not in (*OF_ROS, *OF_CPP):
        return _within_package(name, first, rest, folder)
    if first in OF_TUTORIALS:
        return _of_tutorial(first)
    if first in OF_ROS:
        phrase = N_(
            "{name} is a package of ROS that Deck does not bring: with a ROS of its own, apt install ros-jazzy-{apt}."
        )
        return say(phrase, name=first, apt=apt_name(first))
    meant = _meant_module(first)
    if meant:
        return say("There is no module {name}; did you mean {meant}?", name=first, meant=meant)
    if first in OF_PYPI:
        return say("The module {name} is not installed: pip install {package}.", name=first, package=OF_PYPI[first])
    if first.endswith(("_msgs", "_srvs", "_interfaces")):
        return missing_messages(first, "", [])
    return say(
        "The module {name} is not installed; put its file beside this one, or install it with pip.", name=first
    )


def _meant_module(name: str) -> str:
    """Return the module that is meant by a name, empty if none is."""
    if name in (*KNOWN, *OF_PYPI):
        return ""
    if name in OF_CPP:
        return OF_CPP[name]
    return _like(name, OF_ROS, 0.9) or _like(name, KNOWN, 0.75)


def _within_package(name: str, first: str, rest: str, folder: str) -> Words:
    module = sys.modules.get(first)
    own = shadowing(module, folder) if module is not None else None
    if own is not None:
        return own
    parent, _, last = name.rpartition(".")
    if last[:1].isupper():
        phrase = N_("{last} is a class, not a module: from {parent} import {last}.")
        return say(phrase, last=last, parent=home_of(last, parent) or parent)
    places = getattr(sys.modules.get(first), "__path__", ())
    meant = next(iter(near(rest, [*KINDS, *(each.name for each in pkgutil.iter_modules(places))], cutoff=0.7)), "")
    if meant:
        return say("There is no module {name}; did you mean {meant}?", name=name, meant=f"{first}.{meant}")
    return say("The module {package} has no {name}.", package=first, name=rest)


def misplaced(failure: Failure) -> Words | None:
    """A module is there, and has no such name."""
    error, statement = failure.error, failure.statement
    if not isinstance(error, ImportError) or isinstance(error, ModuleNotFoundError):
        return None
    module = sys.modules.get(error.name or "")
    if module is None or not isinstance(statement, ast.ImportFrom):
        return None
    own = shadowing(module, failure.folder)
    if own is not None:
        return own
    name = next((each.name for each in statement.names if not hasattr(module, each.name)), "")
    if not name:
        return None
    spec = getattr(module, "__spec__", None)
    if getattr(spec, "_initializing", False):
        return say(
            "{module} and this file import each other: move what both need into a third file.", module=module.__name__
        )
    return _elsewhere(name, module.__name__, dir(module))


def _elsewhere(name: str, module: str, known: list[str]) -> Words:
    if module == "rclpy" and name in ROS1:
        home = home_of(name, module)
        return say("{name} is in {home}: from {home} import {name}.", name=name, home=home) if home else ros1(name)
    home = home_of(name, module)
    if home:
        return say("{name} is in {home}: from {home} import {name}.", name=name, home=home)
    meant = nearest(name, [each for each in known if not each.startswith("_")])
    if meant:
        return say("{module} has no {name}; did you mean {meant}?", module=module, name=name, meant=meant)
    if module in PACKAGES:
        phrase = N_("{name} is in the modules .msg, .srv or .action of a package: from {module}.msg import ….")
        return say(phrase, name=name, module=module)
    return say("{module} has no {name}: is it spelled right, capitals included?", module=module, name=name)
