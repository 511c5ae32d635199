"""The learner's own classes: how they begin, and what they call of their base."""

from __future__ import annotations

import ast
from types import ModuleType

from launcher.faults.failure import UNKNOWN, Failure, is_from, shown
from text.sentences import Words, say

_INIT = "__init__"


def of_super(failure: Failure) -> Words | None:
    """`super().__init__` of a node was called without a name, or `super` without brackets."""
    for call in failure.refused_calls():
        func = call.func
        if not isinstance(func, ast.Attribute) or func.attr != "__init__":
            continue
        if isinstance(func.value, ast.Name) and func.value.id == "super":
            return say("The brackets of super() are missing: super().__init__(…).")
        me = failure.named("self")
        if me is UNKNOWN:
            continue
        if not is_from(me, "rclpy", "Node"):
            return say("The class {name} is not a node yet: class {name}(Node).", name=type(me).__name__)
        if not call.args and not call.keywords:
            return say('A node needs a name: super().__init__("my_node").')
        return say('A node is given its name, and nothing before or after it: super().__init__("my_node").')
    return None


def base(failure: Failure) -> Words | None:
    """A class was derived from a module or from a node."""
    statement = failure.statement
    if not isinstance(failure.error, TypeError) or not isinstance(statement, ast.ClassDef):
        return None
    for each in statement.bases:
        if isinstance(each, ast.Call) and isinstance(failure.value(each.func), type):
            return say(
                "Between the brackets of a class stands the class alone, without brackets of its"
                " own: class {name}({what}).",
                name=statement.name,
                what=shown(each.func),
            )
        value = failure.value(each)
        if isinstance(value, ModuleType):
            return say(
                "{what} is a module, and a class cannot be made of it: from rclpy.node import Node,"
                " and class {name}(Node).",
                what=shown(each),
                name=statement.name,
            )
    return None


def unwritten_init(failure: Failure) -> Words | None:
    """A node's class has no `__init__`, or has one that is not written as Python asks for."""
    for call in failure.refused_calls():
        kind = failure.value(call.func)
        if not isinstance(kind, type) or not any(
            each.__name__ == "Node" and each.__module__ == "rclpy.node" for each in kind.__mro__[1:]
        ):
            continue
        own = vars(kind).get(_INIT)
        if own is not None and not own.__code__.co_argcount:
            return say(
                "The first argument of a method is self: def {name}({arguments}).", name=_INIT, arguments="self"
            )
        if call.args or call.keywords or own is not None:
            continue
        like = next((each for each in vars(kind) if _is_like_init(each)), "")
        if like:
            return say(
                "{name} is not {init}, with two underscores on either side, and is never run.", name=like, init=_INIT
            )
        return say(
            'The node has no name yet: in {name}, def __init__(self): super().__init__("my_node").',
            name=kind.__name__,
        )
    return None


def _is_like_init(name: str) -> bool:
    return name.strip("_").lower() in ("init", "int", "innit", "inti", "intit") and name != _INIT


RULES = (of_super, base, unwritten_init)
