"""Imports that fail: ROS 1, another package of ROS, a misspelt name, a file that hides a module."""

from __future__ import annotations

import ast
import pkgutil
import sys
from collections.abc import Iterable

from launcher.faults.failure import Failure
from launcher.faults.homes import KINDS, OF_ROS, OF_ROS1, PACKAGES, ROS1, apt_name, home_of, ros1
from launcher.faults.rules.attributes import shadowing
from text.sentences import Words, say
from text.suggestions import near, nearest

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


def missing(failure: Failure) -> Words | None:
    """There is no such module, or it is beside this file and imported with a point before it."""
    error, statement = failure.error, failure.statement
    if isinstance(error, ImportError) and isinstance(statement, ast.ImportFrom) and statement.level:
        return say(
            "A file beside this one is imported without a point: from {module} import {name}.",
            module=statement.module or "x",
            name=statement.names[0].name,
        )
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
        return _within(name, first, rest, folder)
    if first in OF_TUTORIALS:
        return _of_tutorial(first)
    if first in OF_ROS:
        return say(
            "{name} is a package of ROS that Deck does not bring: with a ROS of its own,"
            " apt install"
            " ros-jazzy-{apt}.",
            name=first,
            apt=apt_name(first),
        )
    meant = _meant(first)
    if meant:
        return say("There is no module {name}; did you mean {meant}?", name=first, meant=meant)
    if first in OF_PYPI:
        return say("The module {name} is not installed: pip install {package}.", name=first, package=OF_PYPI[first])
    if first.endswith(("_msgs", "_srvs", "_interfaces")):
        return missing_messages(first, "", [])
    return say(
        "The module {name} is not installed; put its file beside this one, or install it with pip.", name=first
    )


def _meant(name: str) -> str:
    """Return the module that is meant by a name, empty if none is."""
    if name in (*KNOWN, *OF_PYPI):
        return ""
    if name in OF_CPP:
        return OF_CPP[name]
    return _like(name, OF_ROS, 0.9) or _like(name, KNOWN, 0.75)


def _within(name: str, first: str, rest: str, folder: str) -> Words:
    module = sys.modules.get(first)
    own = shadowing(module, folder) if module is not None else None
    if own is not None:
        return own
    parent, _, last = name.rpartition(".")
    if last[:1].isupper():
        return say(
            "{last} is a class, not a module: from {parent} import {last}.",
            last=last,
            parent=home_of(last, parent) or parent,
        )
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
        return say(
            "{name} is in the modules .msg, .srv or .action of a package: from {module}.msg import ….",
            name=name,
            module=module,
        )
    return say("{module} has no {name}: is it spelled right, capitals included?", module=module, name=name)
