"""Attributes that are not there: of None, of a message, of a module, of an object of rclpy's."""

from __future__ import annotations

import ast
import inspect
import sys
from types import ModuleType
from typing import Any

from launcher.faults.failure import (
    UNKNOWN,
    Failure,
    fields_of,
    is_action_class,
    is_from,
    is_message,
    is_message_class,
    is_service_class,
    name_of,
    shown,
)
from launcher.faults.homes import ROS1, home_of, ros1
from launcher.faults.remedy import future, is_none, parameter
from launcher.faults.rules import own_attributes
from launcher.faults.rules.field_names import no_field, time_now
from launcher.faults.rules.own_attributes import near, taken_name, wanted
from text.sentences import Words, say
from text.suggestions import nearest

OTHER_NAMES = {
    (list, "push"): "append", (list, "add"): "append", (list, "length"): "len(…)",
    (list, "size"): "len(…)", (str, "length"): "len(…)", (dict, "has_key"): "key in d",
    (str, "decode"): "", (bytes, "encode"): "", (list, "shape"): "np.array(…).shape",
    (bytes, "shape"): "np.frombuffer(…)", (list, "tolist"): "", ("array", "tolist"): "",
    ("array", "min"): "min(…)", ("array", "max"): "max(…)", ("array", "sum"): "sum(…)",
    ("array", "shape"): "np.array(…).shape", ("ndarray", "append"): "np.append(…, x)",
    ("ndarray", "length"): "len(…)", (str, "append"): "+", (str, "contains"): "x in text",
    (str, "size"): "len(…)", (str, "toUpperCase"): "upper()", (str, "toLowerCase"): "lower()",
    (list, "contains"): "x in list", (list, "includes"): "x in list",
    (list, "forEach"): "for x in list:", (list, "map"): "[f(x) for x in list]",
    ("Serial", "println"): "write(b\"…\\n\")", ("Serial", "print"): "write(b\"…\")",
    ("lock", "lock"): "with lock:", ("lock", "unlock"): "with lock:",
    ("Queue", "push"): "put(x)", ("Queue", "pop"): "get()",
    ("Time", "to_sec"): ".nanoseconds / 1e9", ("Time", "secs"): ".nanoseconds",
    ("Time", "nsecs"): ".nanoseconds", ("Time", "sec"): ".to_msg().sec",
    ("Time", "nanosec"): ".to_msg().nanosec", ("Time", "seconds"): ".nanoseconds / 1e9",
    ("Duration", "to_sec"): ".nanoseconds / 1e9", ("Duration", "seconds"): ".nanoseconds / 1e9",
    ("Duration", "sec"): ".nanoseconds / 1e9", ("Timer", "stop"): ".cancel()",
    ("Timer", "start"): ".reset()", ("Publisher", "send"): ".publish(msg)",
    ("Publisher", "pub"): ".publish(msg)", ("Client", "call_service"): ".call_async(request)",
    ("Client", "send_request"): ".call_async(request)", ("RcutilsLogger", "print"): ".info(…)",
    ("RcutilsLogger", "log_info"): ".info(…)",
    ("RcutilsLogger", "warning_once"): ".warn(…, once=True)",
    ("RcutilsLogger", "critical"): ".fatal(…)", ("Clock", "time"): ".now()",
    ("Rate", "wait"): ".sleep()",
    ("ServerGoalHandle", "set_succeeded"): ".succeed()",
    ("ServerGoalHandle", "succeeded"): ".succeed()",
    ("ServerGoalHandle", "set_aborted"): ".abort()",
    ("ServerGoalHandle", "aborted"): ".abort()",
    ("ServerGoalHandle", "set_canceled"): ".canceled()",
    ("ServerGoalHandle", "set_preempted"): ".canceled()",
    ("ServerGoalHandle", "send_feedback"): ".publish_feedback(feedback)",
    ("ActionClient", "wait_for_service"): ".wait_for_server()",
    ("ActionClient", "call_async"): ".send_goal_async(goal)",
    ("ActionClient", "call"): ".send_goal_async(goal)",
}  # fmt: skip
"""What beginners call by another name, or need not call at all."""
_CHANGES = ("append", "add", "extend", "insert", "remove", "sort", "pop")


def expression(failure: Failure, name: str) -> ast.Attribute | None:
    """Return the expression of the learner's own line that asks for the attribute."""
    if not failure.is_own:
        return None
    return next((each for each in failure.all(ast.Attribute) if each.attr == name), None)


def unsettable(failure: Failure) -> Words | None:
    """A name of rclpy's own in every node was given another value."""
    if not isinstance(failure.error, AttributeError):
        return None
    asked = getattr(failure.error, "name", None)
    for each in failure.all(ast.Attribute):
        if asked not in (None, each.attr):
            continue
        of = failure.value(each.value)
        found = inspect.getattr_static(type(of), each.attr, None)
        if isinstance(each.ctx, ast.Store) and isinstance(found, property):
            if is_from(of, "rclpy", "Node"):
                return say(
                    "self.{name} is rclpy's own in every node, and cannot be set: take another name, self.my_{name}.",
                    name=each.attr,
                )
            return say("{name} can be read, and not be set.", name=shown(each))
    return None


def unset_field(failure: Failure) -> Words | None:
    """A field was set that the message has not."""
    found = wanted(failure)
    if found is None:
        return None
    of, name = found
    if not is_message(of):
        return None
    return _one_up(failure, of, name) or no_field(type(of), name)


def _one_up(failure: Failure, of: Any, name: str) -> Words | None:  # noqa: ANN401
    """Say that the message around the one that was asked has the field."""
    node = expression(failure, name)
    if node is None or not isinstance(node.value, ast.Attribute):
        return None
    around = failure.value(node.value.value)
    if not is_message(around) or name not in fields_of(around):
        return None
    return say(
        "{type} has no field {field}; the message around it has: {what}.{field}.",
        type=name_of(type(of)),
        field=name,
        what=shown(node.value.value),
    )


def of_taken(failure: Failure) -> Words | None:
    """A function of rclpy's has given something else than it does, since its name was taken."""
    found = wanted(failure)
    node = expression(failure, found[1]) if found is not None else None
    if found is None or node is None or not isinstance(node.value, ast.Call):
        return None
    given = type(found[0]).__module__.partition(".")[0]
    if given == "rclpy" or not is_of_rclpy(failure.called(node.value)):
        return None
    return taken_name(failure)


def of_none(failure: Failure) -> Words | None:
    """Something is None that was used as an object."""
    found = wanted(failure)
    if found is None or found[0] is not None or not failure.is_own:
        return None
    node = expression(failure, found[1])
    if node is None:
        return None
    return is_none(failure, node.value)


def of_module(failure: Failure) -> Words | None:
    """A module has no such name: it lives elsewhere, or the module is the learner's own file."""
    found = wanted(failure)
    if found is None or not isinstance(found[0], ModuleType):
        return None
    module, name = found
    own = shadowing(module, failure.folder)
    if own is not None:
        return own
    home = home_of(name, module.__name__)
    if module.__name__ == "rclpy" and name in ROS1:
        return ros1(name)
    if name in ("msg", "srv", "action"):
        return say(
            "{module}.{name} has to be imported by its own name: import {module}.{name}, or from"
            " {module}.{name} import ….",
            module=module.__name__,
            name=name,
        )
    if home:
        return say("{name} is in {home}: from {home} import {name}.", name=name, home=home)
    known = [each for each in dir(module) if not each.startswith("_")]
    if module.__name__ == "rclpy" and hasattr(module.node.Node, name):
        return say("{name} is of the node, not of rclpy: self.{name}(…).", name=name)
    same = [each for each in known if each.casefold() == name.casefold()]
    meant = same[0] if same else nearest(name, known)
    if meant:
        return say("{module} has no {name}; did you mean {meant}?", module=module.__name__, name=name, meant=meant)
    return say("{module} has no {name}: is it spelled right, capitals included?", module=module.__name__, name=name)


def shadowing(module: ModuleType | None, folder: str) -> Words | None:
    """Say that a file of the learner's own has the name of a module, and hides it."""
    file = getattr(module, "__file__", None) or ""
    name = getattr(module, "__name__", "")
    if file.rpartition("/")[0] != folder:
        return None
    if name in sys.stdlib_module_names or name in ("rclpy", "numpy", "cv2", "std_msgs", "tf2_ros"):
        return say("Your own file {name}.py hides the module {name}: give the file another name.", name=name)
    return None


def of_class(failure: Failure) -> Words | None:
    """A class was asked for something that it, or only an object of it, has."""
    found = wanted(failure)
    if found is None or not isinstance(found[0], type):
        return None
    kind, name = found
    if is_service_class(kind) or is_action_class(kind):
        parts = ("Request", "Response") if is_service_class(kind) else ("Goal", "Result", "Feedback")
        return say(
            "{type} has the parts {parts}, written like this: {type}.{first}.",
            type=kind.__name__,
            parts=", ".join(parts),
            first=parts[0],
        )
    if is_message_class(kind):
        return no_field(kind, name)
    if name == "now" and kind.__name__ == "Time":
        return time_now()
    return near(kind.__name__, name, [each for each in dir(kind) if not each.startswith("_")])


def is_of_rclpy(function: object) -> bool:
    """Whether a function is one of rclpy's."""
    return str(getattr(function, "__module__", "")).startswith("rclpy.")


def of_routine(failure: Failure) -> Words | None:
    """A function was used without being called."""
    found = wanted(failure)
    if found is None or not inspect.isroutine(found[0]):
        return None
    node = expression(failure, found[1])
    what = shown(node.value) if node is not None else found[0].__name__
    if found[0].__name__.startswith("create_") and is_of_rclpy(found[0]):
        return say(
            "{what} makes what is asked for: keep what it gives, self.x = {what}(…), and use that: self.x.{name}.",
            what=what,
            name=found[1],
        )
    return say("{what} is a function: its brackets are missing, {what}().{name}.", what=what, name=found[1])


def of_rclpy(failure: Failure) -> Words | None:
    """An object of rclpy, or of Python, has it under another name."""
    found = wanted(failure)
    if found is None or found[0] is UNKNOWN:
        return None
    of, name = found
    node = expression(failure, name)
    what = shown(node.value) if node is not None else "x"
    if is_from(of, "rclpy", "Future", "Task"):
        return future(what, of)
    if is_from(of, "rclpy", "Subscription") and name == "publish":
        return say(
            "{what} is a subscription, which hears; what publishes is made by self.create_publisher(…).", what=what
        )
    if is_from(of, "rclpy", "Parameter"):
        return parameter(what)
    for kind in type(of).__mro__:
        for key in (kind, kind.__name__):
            if (key, name) in OTHER_NAMES:
                return _other(what, of, name, OTHER_NAMES[key, name])
    if isinstance(of, dict):
        return say('{what} is a dictionary: its values are had by key, {what}["{name}"].', what=what, name=name)
    if isinstance(of, tuple) and name in _CHANGES:
        return say(
            "{what} is of type {type}, which cannot be changed: make a new one, such as list({what}).",
            what=what,
            type=type(of).__name__,
        )
    if isinstance(of, (int, float, str, bool)) and name in ("data", "value"):
        return say(
            "{what} is the value itself, of type {type}: without .{name}.",
            what=what,
            type=type(of).__name__,
            name=name,
        )
    return None


def _other(what: str, of: Any, name: str, meant: str) -> Words:  # noqa: ANN401
    kind = type(of).__name__
    if not meant:
        return say("{what} is of type {type} already: {name} is not needed.", what=what, type=kind, name=name)
    if meant.startswith("."):
        return say(
            "{type} of rclpy has no {name}: write {what}{meant}.", type=kind, name=name, what=what, meant=meant
        )
    return say("{type} has no {name}: {meant} does that.", type=kind, name=name, meant=meant)


RULES = (unsettable, unset_field, of_taken, of_none, of_module, of_class, of_routine, of_rclpy, own_attributes.unmade)
