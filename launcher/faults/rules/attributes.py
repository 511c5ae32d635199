"""Attributes that are not there: of None, of a message, of a module, of rclpy's objects, of the learner's own."""

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
from launcher.faults.remedy import future, is_none, parameter
from launcher.faults.rules.fields import no_field, time_now
from launcher.faults.rules.names import ROS1, home_of, ros1, shadowing
from text.i18n import N_
from text.sentences import Words, say
from text.suggestions import near

_OTHER_NAMES = {
    ("list", "push"): "append", ("list", "add"): "append", ("list", "length"): "len(…)", ("list", "size"): "len(…)",
    ("str", "length"): "len(…)", ("list", "shape"): "np.array(…).shape", ("array", "shape"): "np.array(…).shape",
    ("array", "min"): "min(…)", ("array", "max"): "max(…)", ("array", "sum"): "sum(…)",
    ("ndarray", "append"): "np.append(…, x)",
    ("Time", "to_sec"): ".nanoseconds / 1e9", ("Time", "secs"): ".nanoseconds", ("Time", "nsecs"): ".nanoseconds",
    ("Time", "sec"): ".to_msg().sec", ("Time", "nanosec"): ".to_msg().nanosec",
    ("Time", "seconds"): ".nanoseconds / 1e9", ("Duration", "to_sec"): ".nanoseconds / 1e9",
    ("Duration", "seconds"): ".nanoseconds / 1e9", ("Duration", "sec"): ".nanoseconds / 1e9",
    ("Timer", "stop"): ".cancel()", ("Timer", "start"): ".reset()",
    ("Publisher", "send"): ".publish(msg)", ("Publisher", "pub"): ".publish(msg)",
    ("Client", "call_service"): ".call_async(request)", ("Client", "send_request"): ".call_async(request)",
    ("Client", "publish"): ".call_async(request)",
    ("RcutilsLogger", "print"): ".info(…)", ("RcutilsLogger", "critical"): ".fatal(…)",
    ("ServerGoalHandle", "set_succeeded"): ".succeed()", ("ServerGoalHandle", "set_aborted"): ".abort()",
    ("ServerGoalHandle", "set_canceled"): ".canceled()", ("ServerGoalHandle", "set_preempted"): ".canceled()",
    ("ServerGoalHandle", "send_feedback"): ".publish_feedback(feedback)",
    ("ActionClient", "wait_for_service"): ".wait_for_server()",
    ("ActionClient", "call_async"): ".send_goal_async(goal)",
}  # fmt: skip
"""By class and name: what beginners call by another name."""
_OF_RCLPY = {
    "spin": "rclpy.spin(node)", "spin_once": "rclpy.spin_once(node)", "ok": "rclpy.ok()",
    "shutdown": "rclpy.try_shutdown()", "init": "rclpy.init()",
}  # fmt: skip
_LOGGER = ("logger", "log", "info", "warn", "warning", "error", "debug", "fatal", "get_log")
_MADE_BY = {
    "timer": "create_timer", "publisher": "create_publisher", "pub": "create_publisher",
    "subscription": "create_subscription", "subscriber": "create_subscription", "sub": "create_subscription",
    "client": "create_client", "service": "create_service", "rate": "create_rate",
}  # fmt: skip
_ACTIONS = {
    "create_action_client": "ActionClient(self, Fibonacci, 'name')",
    "create_action_server": "ActionServer(self, Fibonacci, 'name', self.execute)",
}


def _wanted(failure: Failure) -> tuple[Any, str] | None:
    """Return the object and the name of the attribute that it has not."""
    error = failure.error
    if not isinstance(error, AttributeError):
        return None
    name, of = getattr(error, "name", None), getattr(error, "obj", UNKNOWN)
    if name is None and not str(error).startswith("__"):
        return next(((failure.value(each.value), each.attr) for each in failure.all(ast.Attribute)), None)
    return None if name is None else (of, name)


def _asks(failure: Failure, name: str) -> ast.Attribute | None:
    """Return the expression of the learner's own line that asks for the attribute."""
    return next((each for each in failure.all(ast.Attribute) if each.attr == name), None) if failure.is_own else None


def _known(of: object) -> list[str]:
    return [each for each in dir(of) if not each.startswith("_")]


def unsettable(failure: Failure) -> Words | None:
    """A name of rclpy's own in every node was given another value."""
    for each in failure.all(ast.Attribute) if isinstance(failure.error, AttributeError) else ():
        of = failure.value(each.value)
        found = inspect.getattr_static(type(of), each.attr, None)
        if isinstance(each.ctx, ast.Store) and isinstance(found, property) and is_from(of, "rclpy", "Node"):
            return say(
                "self.{name} is rclpy's own in every node, and cannot be set: take another name, self.my_{name}.",
                name=each.attr,
            )
    return None


def missing(failure: Failure) -> Words | None:
    """What was asked has no such attribute."""
    found = _wanted(failure)
    if found is None or found[0] is UNKNOWN:
        return None
    of, name = found
    node = _asks(failure, name)
    what = shown(node.value) if node is not None else "x"
    if is_message(of):
        return no_field(type(of), name)
    call = node.value if node is not None and isinstance(node.value, ast.Call) else None
    if call is not None and _is_of_rclpy(failure.called(call)) and not _is_of_rclpy(type(of)):
        words = taken_name(failure)
        if words is not None:
            return words
    if of is None:
        return is_none(failure, node.value) if node is not None else None
    if isinstance(of, ModuleType):
        return _of_module(of, name, failure.folder)
    if isinstance(of, type):
        return _of_class(of, name)
    if inspect.isroutine(of):
        return _of_routine(of, name, what)
    return _of_rclpy(of, name, what) or _of_object(failure, of, name)


def _is_of_rclpy(function: object) -> bool:
    return str(getattr(function, "__module__", "")).startswith("rclpy.")


def _of_module(module: ModuleType, name: str, folder: str) -> Words:
    """Say where a name lives that a module has not, or that the module is the learner's own file."""
    own = shadowing(module, folder)
    if own is not None:
        return own
    of, home = module.__name__, home_of(name, module.__name__)
    if of == "rclpy" and name in ROS1:
        return ros1(name)
    if home:
        return say("{name} is in {home}: from {home} import {name}.", name=name, home=home)
    if name == "now" and of in ("rclpy.time", "rclpy.clock"):
        return time_now()
    if of == "rclpy" and hasattr(module.node.Node, name):
        return say("{name} is of the node, not of rclpy: self.{name}(…).", name=name)
    meant = _meant(name, _known(module), 0.6)
    if meant:
        return say("{module} has no {name}; did you mean {meant}?", module=of, name=name, meant=meant)
    return say("{module} has no {name}: is it spelled right, capitals included?", module=of, name=name)


def _meant(name: str, known: list[str], cutoff: float) -> str:
    same = [each for each in known if each.casefold() == name.casefold()]
    return next(iter(same or near(name, known, cutoff=cutoff)), "")


def _of_class(kind: type, name: str) -> Words:
    if is_service_class(kind) or is_action_class(kind):
        parts = ("Request", "Response") if is_service_class(kind) else ("Goal", "Result", "Feedback")
        phrase = N_("{type} has the parts {parts}, written like this: {type}.{first}.")
        return say(phrase, type=kind.__name__, parts=", ".join(parts), first=parts[0])
    if is_message_class(kind):
        return no_field(kind, name)
    return time_now() if name == "now" and kind.__name__ == "Time" else _near(kind.__name__, name, _known(kind))


def _of_routine(of: Any, name: str, what: str) -> Words:
    if of.__name__.startswith("create_") and _is_of_rclpy(of):
        phrase = N_(
            "{what} makes what is asked for: keep what it gives, self.x = {what}(…), and use that: self.x.{name}."
        )
        return say(phrase, what=what, name=name)
    return say("{what} is a function: its brackets are missing, {what}().{name}.", what=what, name=name)


def _of_rclpy(of: Any, name: str, what: str) -> Words | None:
    """Say that an object of rclpy, or of Python, has it under another name, or that another one is meant."""
    if is_from(of, "rclpy", "Node") and name in _ACTIONS:
        phrase = N_(
            "A node makes no actions; they have classes of their own: {call}, from rclpy.action import {name}."
        )
        return say(phrase, call=_ACTIONS[name], name=_ACTIONS[name].partition("(")[0])
    if is_from(of, "rclpy", "ClientGoalHandle") and (name in ("result", "get_result") or not near(name, _known(of))):
        return say(
            "{what} is the goal's handle, not its result: {what}.get_result_async() gives a future, and"
            " in the done callback of that future.result().result is the result.",
            what=what,
        )
    if is_from(of, "rclpy", "ServerGoalHandle") and name in ("goal", *(fields := list(fields_of(of.request)))):
        phrase = N_("{what} is the goal's handle; the goal itself is {what}.request: {what}.request.{field}.")
        return say(phrase, what=what, field=name if name in fields else next(iter(fields), "x"))
    if is_from(of, "rclpy", "Future", "Task"):
        return future(what, of)
    if is_from(of, "rclpy", "Parameter"):
        return parameter(what)
    kind = type(of).__name__
    if isinstance(of, str) and name == "decode":
        return say("{what} is of type {type} already: {name} is not needed.", what=what, type=kind, name=name)
    meant = next(
        (_OTHER_NAMES[each.__name__, name] for each in type(of).__mro__ if (each.__name__, name) in _OTHER_NAMES), ""
    )
    if meant.startswith("."):
        return say(
            "{type} of rclpy has no {name}: write {what}{meant}.", type=kind, name=name, what=what, meant=meant
        )
    if meant:
        return say("{type} has no {name}: {meant} does that.", type=kind, name=name, meant=meant)
    return None


def _of_object(failure: Failure, of: Any, name: str) -> Words | None:
    """Say of an object what it has instead; of the learner's own, where its attribute is made."""
    is_node = is_from(of, "rclpy", "Node")
    if is_node and not {"_Node__handle", "_Node__node"} & vars(of).keys():
        return say(
            "super().__init__(name) has not been called yet: it comes first in __init__, before"
            " anything of the node is used."
        )
    module = sys.modules.get(type(of).__module__)
    is_own = (getattr(module, "__file__", None) or "").rpartition("/")[0] == failure.folder
    if not failure.is_own:
        # What a library asks of it says nothing about the learner's own line.
        return taken_name(failure) if is_own and is_node else None
    if type(of).__module__ != "__main__" and not is_own:
        return (_of_node(name) if is_node else None) or _near(name_of(type(of)), name, _known(of))
    return _made_where(failure, of, name) or _near_own(of, name) or _made_nowhere(failure, of, name)


def other_names(failure: Failure) -> Words | None:
    """A name of rclpy's own was taken, and rclpy fails by it."""
    is_likely = isinstance(failure.error, (AttributeError, TypeError)) and not failure.is_own
    return taken_name(failure) if is_likely else None


def taken_name(failure: Failure) -> Words | None:
    """Say that a name that rclpy uses itself in each node has another value, or another method."""
    assigned = {
        each.attr
        for each in ast.walk(failure.tree)
        if isinstance(each, ast.Attribute) and isinstance(each.ctx, ast.Store) and shown(each.value) == "self"
    }
    for node in (value for level in failure.levels for value in level.values.values()):
        if not is_from(node, "rclpy", "Node"):
            continue
        base = next(each for each in type(node).__mro__ if each.__module__.startswith("rclpy."))
        used = {*dir(base), *inspect.unwrap(vars(base)["__init__"]).__code__.co_names}
        own = (each for each in type(node).__mro__ if each.__module__ not in (base.__module__, "builtins"))
        clash = sorted(
            name
            for name in {*assigned, *(one for each in own for one in vars(each))} & used
            if not name.startswith("__")
        )
        if clash:
            return say(
                "{name} is a name that rclpy uses itself in every node: give yours another one.", name=clash[0]
            )
    return None


def _made_where(failure: Failure, of: Any, name: str) -> Words | None:
    """Say where the attribute is made, if it is made anywhere."""
    cls = failure.own_class
    if cls is None or failure.own is None:
        return None
    methods = [each for each in cls.body if isinstance(each, ast.FunctionDef)]
    for method, each in _stores(methods, name):
        statement = getattr(each, "parent", None)
        # What changes it, as += does, needs it made before.
        if not isinstance(statement, ast.AugAssign) and statement is not failure.statement:
            return _only_there(failure, name, method, each)
    for method in methods:
        for one in ast.walk(method):
            if isinstance(one, ast.FunctionDef) and one is not method and one.name == name:
                phrase = N_(
                    "{name} (line {line}) stands within {method}, since it is indented too deep:"
                    " its def belongs at the depth of that of {method}."
                )
                return say(phrase, name=name, line=one.lineno, method=method.name)
            if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store) and one.id == name:
                phrase = N_(
                    "In line {line} {name} is made without self, and is forgotten when {method}"
                    " ends: write self.{name} there."
                )
                return say(phrase, line=one.lineno, name=name, method=method.name)
    for one in failure.tree.body:
        if isinstance(one, ast.FunctionDef) and one.name == name and one.args.args:
            phrase = N_(
                "{name} (line {line}) stands outside of the class {owner}: indent it, as deep as the other methods."
            )
            return say(phrase, name=name, line=one.lineno, owner=cls.name)
    node = getattr(sys.modules.get("rclpy.node"), "Node", None)
    if node is not None and not isinstance(of, node) and hasattr(node, name):
        return say("The class {name} is not a node yet: class {name}(Node).", name=cls.name)
    return None


def _stores(methods: list[ast.FunctionDef], name: str) -> list[tuple[ast.FunctionDef, ast.Attribute]]:
    """Return the places of a class that give an attribute a value, with their methods."""
    return [
        (method, each)
        for method in methods
        for each in ast.walk(method)
        if isinstance(each, ast.Attribute) and isinstance(each.ctx, ast.Store) and each.attr == name
    ]


def _only_there(failure: Failure, name: str, method: ast.FunctionDef, node: ast.expr) -> Words:
    """Say that the attribute is made elsewhere, and why it is not there now."""
    assert failure.own is not None
    here, line = failure.own.function, node.lineno
    if method.name == here and line > failure.own.line:
        return say("self.{name} is only made in line {line}, after this one.", name=name, line=line)
    above = getattr(node, "parent", None)
    while above is not None and above is not method:
        if isinstance(above, (ast.If, ast.For, ast.While, ast.Try)):
            phrase = N_(
                "self.{name} is only made in line {line}, in a branch that was not taken: give it a"
                " value in __init__ in every case."
            )
            return say(phrase, name=name, line=line)
        above = getattr(above, "parent", None)
    if method.name in (here, "__init__"):
        phrase = N_(
            "self.{name} is made in line {line}, and this line is run before: make it at the very"
            " beginning of __init__."
        )
        return say(phrase, name=name, line=line)
    phrase = N_("self.{name} is only made in {method} (line {line}), which has not run yet: make it in __init__.")
    return say(phrase, name=name, method=method.name, line=line)


def _near_own(of: Any, name: str) -> Words | None:
    is_node = is_from(of, "rclpy", "Node")
    base = next((each for each in type(of).__mro__ if each.__module__.startswith("rclpy.")), object)
    known = [each for each in dir(of) if each[0] != "_" or (name[0] == "_" and each[1:2] != "_")]
    meant = next(iter(near(name, [each for each in known if not hasattr(base, each)])), "")
    words = _of_node(name) if is_node and not meant else None
    if words is None and not meant and name in ROS1:
        words = ros1(name)
    if words is not None:
        return words
    meant = meant or next(iter(near(name, known, cutoff=0.7)), "")
    if not meant:
        return None
    if is_node:
        return say("The node has no {name}; did you mean self.{meant}?", name=name, meant=meant)
    return say("{type} has no {name}; did you mean {meant}?", type=type(of).__name__, name=name, meant=meant)


def _of_node(name: str) -> Words | None:
    """Say what beginners ask a node for, and another thing has."""
    if name == "publish":
        return say(
            "It is not the node that publishes, but its publisher: self.pub ="
            " self.create_publisher(…), self.pub.publish(msg)."
        )
    if name in _LOGGER:
        return say("A node logs by self.get_logger().info(…), .warn(…) and .error(…).")
    if name in _OF_RCLPY:
        return say("{name} is of rclpy, not of the node: {instead}.", name=name, instead=_OF_RCLPY[name])
    maker = _MADE_BY.get(name.strip("_"))
    if not maker:
        return None
    phrase = N_("self.{name} is made nowhere: keep what {maker} gives, self.{name} = self.{maker}(…), in __init__.")
    return say(phrase, name=name, maker=maker)


def _made_nowhere(failure: Failure, of: Any, name: str) -> Words:
    methods = [each for each in getattr(failure.own_class, "body", ()) if isinstance(each, ast.FunctionDef)]
    if _stores(methods, name):
        phrase = N_("self.{name} is changed here, and has no value before: give it one in __init__, self.{name} = 0.")
        return say(phrase, name=name)
    phrase = N_("{type} has no {name}: it is made nowhere in this class. Make it in __init__, self.{name} = ….")
    return say(phrase, type=type(of).__name__, name=name)


def _near(kind: str, name: str, known: list[str]) -> Words:
    """Say that a type has no such attribute, and which of those known may be meant."""
    meant = _meant(name, known, 0.7)
    if meant:
        return say("{type} has no {name}; did you mean {meant}?", type=kind, name=name, meant=meant)
    return say(
        "{type} has no {name}: is it spelled right, or is something else meant than {type}?", type=kind, name=name
    )
