"""What to do with a value that is of another kind than the line needs: a parameter, a message."""

from __future__ import annotations

import ast
import inspect
import re
from types import ModuleType
from typing import Any

from launcher.faults.failure import UNKNOWN, Failure, fields_of, is_from, is_message_class, name_of, shown
from text.i18n import N_
from text.sentences import Words, say

FEW = 6
"""As many fields are named."""
_CHANGING = ("append", "sort", "reverse", "extend", "update", "add", "insert")


def remedy(failure: Failure, node: ast.AST | None, value: Any = UNKNOWN) -> Words | None:
    """Return what to write in an expression's place where a number or a text is needed."""
    what = f"({shown(node)})" if isinstance(node, ast.BinOp) else shown(node)
    value = failure.value(node) if value is UNKNOWN else value
    if value is UNKNOWN:
        kind = failure.type_of(node)
        return None if kind is None else _of_type(failure, what, node, kind)
    if isinstance(value, type):
        return say("{what} is a class: the brackets are missing, {what}().", what=what)
    if inspect.isroutine(value):
        return say("{what} is a function: the brackets are missing, {what}().", what=what)
    if isinstance(value, ModuleType):
        return say("{what} is a module: name what is meant in it, {what}.x.", what=what)
    if isinstance(value, str):
        return of_text(what, value)
    return _of_type(failure, what, node, type(value))


def of_list(what: str, call: str) -> Words:
    phrase = N_("{what} is a list: take one of its values, {call}({what}[0]), or all, [{call}(v) for v in {what}].")
    return say(phrase, what=what, call=call)


def is_none(failure: Failure, node: ast.AST | None) -> Words | None:
    """Say that an expression is None, and what that may come from."""
    what = shown(node)
    if isinstance(node, ast.Attribute) and node.attr == "value" and isinstance(node.value, ast.Call):
        words = unset_parameter(failure, node.value)
        if words is not None:
            return words
    if isinstance(node, ast.Constant) or node is None:
        return is_none_here("None")
    if _read_from(failure, node):
        return say(
            "No picture has come, and {what} is None: then the first of the two that read() gives"
            " is False. Is the camera there?",
            what=what,
        )
    call = node if isinstance(node, ast.Call) else failure.given_by(node)
    return is_none_here(what) if call is None else _nothing_given(call)


def unset_parameter(failure: Failure, call: ast.Call) -> Words | None:
    """Say that a parameter has no value, if it is asked for here and has none."""
    node = failure.named("self")
    if not isinstance(call.func, ast.Attribute) or not call.args or not is_from(node, "rclpy", "Node"):
        return None
    name = failure.value(call.args[0])
    if call.func.attr != "get_parameter" or not isinstance(name, str) or not node.has_parameter(name):
        return None
    if node.get_parameter(name).value is not None:
        return None
    return say(
        "The parameter {name!r} has no value: declare it with a default,"
        " self.declare_parameter({name!r}, 0.0), or set it in the profile.",
        name=name,
    )


def is_none_here(what: str) -> Words:
    """Say that a value that was handed over is None."""
    if what == "None":
        return say("None is not a value here: has nothing been put there yet?")
    return say(
        "{what} is None: nothing has been put there yet, such as a first message. Ask before:"
        " if {what} is None: return.",
        what=what,
    )


def _read_from(failure: Failure, node: ast.AST) -> bool:
    """Whether a name stands for the second of two that a camera's read has given."""
    return any(
        isinstance(each, ast.Assign)
        and isinstance(each.value, ast.Call)
        and getattr(each.value.func, "attr", "") == "read"
        and isinstance(each.targets[0], ast.Tuple)
        and shown(node) in [shown(target) for target in each.targets[0].elts[1:]]
        for each in ast.walk(failure.tree)
    )


def _nothing_given(call: ast.Call) -> Words:
    name = call.func.attr if isinstance(call.func, ast.Attribute) else ""
    if name == "result":
        return say(
            "result() of a future gives None until its answer is there: ask for it in a done"
            " callback, future.add_done_callback(self.on_answer)."
        )
    if name == "imread":
        return say(
            "{what} gives None: there is no such file, or it is not a picture. A name without a"
            " slash in front is looked for where the program was started.",
            what=shown(call),
        )
    if name in _CHANGING:
        return say(
            "{name} changes the list itself and gives None: write it on a line of its own, without an equals sign.",
            name=name,
        )
    return say("{what} gives None: does it have a return, and does it return a value in this case?", what=shown(call))


def of_message(what: str, kind: Any) -> Words:
    """Say that an expression is a whole message, and which of its fields may be meant."""
    fields = list(fields_of(kind))
    if "data" in fields:
        return say("{what} is a whole message, {type}; what is in it is {what}.data.", what=what, type=name_of(kind))
    phrase = N_("{what} is a whole message, {type}; use one of its fields: {fields}.")
    return say(phrase, what=what, type=name_of(kind), fields=listed(fields))


def given(value: object) -> Words | str:
    """Return what an object is in a sentence: of a class that it is one."""
    return say("the class {name}", name=name_of(value)) if isinstance(value, type) else name_of(type(value))


def listed(names: list[str]) -> str:
    """Return some names, with an ellipsis if they are many."""
    return ", ".join(names[:FEW]) + (", …" if len(names) > FEW else "")


def future(what: str, of: Any = None) -> Words:
    """Say how to get at the answer that a future promises, or has."""
    if of is not None and of.done():
        return say("{what} is the future; the answer is in it: {what}.result().", what=what)
    return say(
        "{what} is a future: the answer is not there yet. Have it called back,"
        " future.add_done_callback(self.on_answer), and read future.result() there.",
        what=what,
    )


def parameter(what: str) -> Words:
    return say("{what} is a parameter; its value is {what}.value.", what=what)


def of_text(what: str, value: str) -> Words | None:
    """Say how a text becomes a number."""
    if re.fullmatch(r"\s*[-+]?\d+\s*", value):
        return say("{what} is a text, not a number: int({what}), or with a fraction float({what}).", what=what)
    if re.fullmatch(r"\s*[-+]?\d+\.\d*\s*", value):
        return say("{what} is a text, not a number: float({what}).", what=what)
    return None


def _of_type(failure: Failure, what: str, node: ast.AST | None, kind: type) -> Words | None:
    module, name = kind.__module__.partition(".")[0], kind.__name__
    if kind is type(None):
        return is_none(failure, node)
    if is_message_class(kind) and name == "ParameterValue":
        return say(
            "{what} is a message around the value; the value alone is self.get_parameter(name).value.", what=what
        )
    if module == "builtin_interfaces":
        phrase = N_("{what} is the message {type}: Time.from_msg({what}) of rclpy.time can be calculated with.")
        return say(phrase, what=what, type=name_of(kind))
    if is_message_class(kind):
        return of_message(what, kind)
    if module != "rclpy":
        return None
    if name == "Parameter":
        return parameter(what)
    if name in ("Future", "Task"):
        return future(what)
    if name == "Duration":
        return say(
            "{what} is of type Duration: {what}.nanoseconds / 1e9 are its seconds, and"
            " Duration(seconds=0.5) makes one.",
            what=what,
        )
    if name == "Time":
        return say(
            "{what} is of type Time: {what}.nanoseconds / 1e9 are seconds, and a Duration can be"
            " added to it: Duration(seconds=0.5).",
            what=what,
        )
    return None
