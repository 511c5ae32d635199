"""Attributes that the learner's own node has not: made elsewhere, later, without self, misspelt."""

from __future__ import annotations

import ast
import inspect
import sys
from typing import Any

from launcher.faults.failure import ENTERING, UNKNOWN, Failure, is_from, name_of, shown
from launcher.faults.homes import ROS1, ros1
from text.sentences import Words, say
from text.suggestions import near as near_words
from text.suggestions import nearest

_LOGGER = ("logger", "log", "info", "warn", "warning", "error", "debug", "fatal", "get_log")

_OF_RCLPY = {
    "spin": "rclpy.spin(node)", "spin_once": "rclpy.spin_once(node)", "ok": "rclpy.ok()",
    "shutdown": "rclpy.try_shutdown()", "init": "rclpy.init()",
}  # fmt: skip
_MADE_BY = {
    "timer": "create_timer", "publisher": "create_publisher", "pub": "create_publisher",
    "subscription": "create_subscription", "subscriber": "create_subscription",
    "sub": "create_subscription", "client": "create_client", "service": "create_service",
    "rate": "create_rate",
}  # fmt: skip


def wanted(failure: Failure) -> tuple[Any, str] | None:
    """Return the object and the name of the attribute that it has not."""
    error = failure.error
    if not isinstance(error, AttributeError):
        return None
    name, of = getattr(error, "name", None), getattr(error, "obj", UNKNOWN)
    if name is None and str(error) in ENTERING:
        return None
    if name is None:
        for each in failure.all(ast.Attribute):
            return failure.value(each.value), each.attr
        return None
    return of, name


def unmade(failure: Failure) -> Words | None:
    """The node itself has no such attribute: made elsewhere, later, without self, or misspelt."""
    found = wanted(failure)
    if found is None or found[0] is UNKNOWN:
        return None
    of, name = found
    if is_from(of, "rclpy", "Node") and not _is_made(of):
        return say(
            "super().__init__(name) has not been called yet: it comes first in __init__, before"
            " anything of the node is used."
        )
    if type(of).__module__ != "__main__" and not _is_own(of, failure):
        if not failure.is_own:
            # What a library asks of it says nothing about the learner's own line.
            return None
        words = of_node(name) if is_from(of, "rclpy", "Node") else None
        if words is not None:
            return words
        return near(name_of(type(of)), name, [each for each in dir(of) if not each.startswith("_")])
    if not failure.is_own:
        return _taken(failure, of)
    return _made_where(failure, name) or _near_own(of, name) or _made_nowhere(failure, of, name)


def _is_own(of: Any, failure: Failure) -> bool:  # noqa: ANN401
    module = sys.modules.get(type(of).__module__)
    return (getattr(module, "__file__", None) or "").rpartition("/")[0] == failure.folder


def _is_made(node: Any) -> bool:  # noqa: ANN401
    return "_Node__handle" in vars(node) or "_Node__node" in vars(node)


def _taken(failure: Failure, of: Any) -> Words | None:  # noqa: ANN401
    """Say that the learner has used a name that rclpy uses itself, where rclpy fails by it."""
    return taken_name(failure) if is_from(of, "rclpy", "Node") and not failure.is_own else None


def taken_name(failure: Failure) -> Words | None:
    """A name that rclpy uses itself in each node has another value, or another method."""
    nodes = [value for level in failure.levels for value in level.values.values() if is_from(value, "rclpy", "Node")]
    for node in nodes:
        base = next(each for each in type(node).__mro__ if each.__module__.startswith("rclpy."))
        used = {*dir(base), *inspect.unwrap(vars(base)["__init__"]).__code__.co_names}
        made = {
            name
            for each in type(node).__mro__
            if each.__module__ not in (base.__module__, "builtins")
            for name in vars(each)
        }
        made |= _assigned_names(failure)
        clash = sorted(name for name in made & used if not name.startswith("__"))
        if clash:
            return say(
                "{name} is a name that rclpy uses itself in every node: give yours another one.", name=clash[0]
            )
    return None


def _assigned_names(failure: Failure) -> set[str]:
    return {
        each.attr
        for each in ast.walk(failure.tree)
        if isinstance(each, ast.Attribute) and isinstance(each.ctx, ast.Store) and shown(each.value) == "self"
    }


def _made_where(failure: Failure, name: str) -> Words | None:
    """Say where the attribute is made, if it is made anywhere."""
    cls = failure.own_class
    if cls is None or failure.own is None:
        return None
    for method, each in _stores(cls, name):
        if not _is_changed(failure, each):
            return _only_there(failure, name, method, each)
    return _otherwise_made(cls, name) or _outside(failure, cls, name)


def _outside(failure: Failure, cls: ast.ClassDef, name: str) -> Words | None:
    """Say that a method is written outside of its class."""
    for each in failure.tree.body:
        if isinstance(each, ast.FunctionDef) and each.name == name and each.args.args:
            return say(
                "{name} (line {line}) stands outside of the class {owner}: indent it, as deep as the other methods.",
                name=name,
                line=each.lineno,
                owner=cls.name,
            )
    return None


def _stores(cls: ast.ClassDef, name: str) -> list[tuple[ast.FunctionDef, ast.Attribute]]:
    """Return the places of a class that give an attribute a value, with their methods."""
    return [
        (method, each)
        for method in cls.body
        if isinstance(method, ast.FunctionDef)
        for each in ast.walk(method)
        if isinstance(each, ast.Attribute) and isinstance(each.ctx, ast.Store) and each.attr == name
    ]


def _is_changed(failure: Failure, node: ast.Attribute) -> bool:
    """Whether a line changes an attribute, as += does, and needs it made before."""
    statement = getattr(node, "parent", None)
    if isinstance(statement, ast.AugAssign):
        return True
    return statement is not None and statement is failure.statement


def _only_there(failure: Failure, name: str, method: ast.FunctionDef, node: ast.expr) -> Words:
    """Say that the attribute is made elsewhere, and why it is not there now."""
    assert failure.own is not None
    here = failure.own.function
    line = node.lineno
    if method.name == here and line > failure.own.line:
        return say("self.{name} is only made in line {line}, after this one.", name=name, line=line)
    if _is_in_branch(node, method):
        return say(
            "self.{name} is only made in line {line}, in a branch that was not taken: give it a"
            " value in __init__ in every case.",
            name=name,
            line=line,
        )
    if method.name in (here, "__init__"):
        return say(
            "self.{name} is made in line {line}, and this line is run before: make it at the very"
            " beginning of __init__.",
            name=name,
            line=line,
        )
    return say(
        "self.{name} is only made in {method} (line {line}), which has not run yet: make it in __init__.",
        name=name,
        method=method.name,
        line=line,
    )


def _is_in_branch(node: ast.AST, method: ast.FunctionDef) -> bool:
    above = getattr(node, "parent", None)
    while above is not None and above is not method:
        if isinstance(above, (ast.If, ast.For, ast.While, ast.Try)):
            return True
        above = getattr(above, "parent", None)
    return False


def _otherwise_made(cls: ast.ClassDef, name: str) -> Words | None:
    """Say that a method stands too deep, or that a variable was made without self."""
    for method in [each for each in cls.body if isinstance(each, ast.FunctionDef)]:
        for each in ast.walk(method):
            if isinstance(each, ast.FunctionDef) and each is not method and each.name == name:
                return say(
                    "{name} (line {line}) stands within {method}, since it is indented too deep:"
                    " its def belongs at the depth of that of {method}.",
                    name=name,
                    line=each.lineno,
                    method=method.name,
                )
            if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store) and each.id == name:
                return say(
                    "In line {line} {name} is made without self, and is forgotten when {method}"
                    " ends: write self.{name} there.",
                    line=each.lineno,
                    name=name,
                    method=method.name,
                )
    return None


def _near_own(of: Any, name: str) -> Words | None:  # noqa: ANN401
    known = [each for each in dir(of) if each[0] != "_" or (name[0] == "_" and each[1:2] != "_")]
    own = [each for each in known if not hasattr(_base_of(of), each)]
    meant = nearest(name, own)
    if not meant and is_from(of, "rclpy", "Node"):
        words = of_node(name)
        if words is not None:
            return words
    if not meant and name in ROS1:
        return ros1(name)
    meant = meant or next(iter(near_words(name, known, cutoff=0.7)), "")
    if meant:
        return (
            say("The node has no {name}; did you mean self.{meant}?", name=name, meant=meant)
            if is_from(of, "rclpy", "Node")
            else say("{type} has no {name}; did you mean {meant}?", type=type(of).__name__, name=name, meant=meant)
        )
    return None


def _base_of(of: Any) -> type:  # noqa: ANN401
    """Return the class of rclpy that the learner's own is made of."""
    classes = type(of).__mro__
    return next((each for each in classes if each.__module__.startswith("rclpy.")), object)


def of_node(name: str) -> Words | None:
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
    if maker:
        return say(
            "self.{name} is made nowhere: keep what {maker} gives, self.{name} = self.{maker}(…), in __init__.",
            name=name,
            maker=maker,
        )
    return None


def _made_nowhere(failure: Failure, of: Any, name: str) -> Words:  # noqa: ANN401
    if failure.own_class is not None and _stores(failure.own_class, name):
        return say(
            "self.{name} is changed here, and has no value before: give it one in __init__, self.{name} = 0.",
            name=name,
        )
    return say(
        "{type} has no {name}: it is made nowhere in this class. Make it in __init__, self.{name} = ….",
        type=type(of).__name__,
        name=name,
    )


def near(kind: str, name: str, known: list[str]) -> Words:
    """Say that a type has no such attribute, and which of those known may be meant."""
    same = [each for each in known if each.casefold() == name.casefold()]
    meant = next(iter(same or near_words(name, known, cutoff=0.7)), "")
    if meant:
        return say("{type} has no {name}; did you mean {meant}?", type=kind, name=name, meant=meant)
    return say(
        "{type} has no {name}: is it spelled right, or is something else meant than {type}?", type=kind, name=name
    )
