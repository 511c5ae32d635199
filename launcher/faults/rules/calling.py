"""Calls of the learner's own lines: other arguments than the function asks for, not callable."""

from __future__ import annotations

import array
import ast
import inspect
from types import ModuleType
from typing import Any

from launcher.faults.failure import (
    UNKNOWN,
    Failure,
    is_from,
    is_message,
    is_message_class,
    name_of,
    shown,
)
from launcher.faults.remedy import is_none, listed, remedy
from text.sentences import Words, say
from text.suggestions import nearest

_LOGS = ("debug", "info", "warn", "warning", "error", "fatal")


def logger(failure: Failure) -> Words | None:
    """A method of the logger was given several things, as print takes them."""
    for call in _calls(failure):
        if (
            isinstance(call.func, ast.Attribute)
            and call.func.attr in _LOGS
            and len(call.args) != 1
            and (
                "logger" in shown(call.func)
                or is_from(failure.value(call.func.value), "rclpy", "RcutilsLogger")
            )
        ):
            if not call.args:
                return say('The text is missing: {call}("…").', call=shown(call.func))
            return say(
                'The logger takes one text, not several as print does: {call}(f"{text}'
                ' {{{value}}}").',
                call=shown(call.func),
                text=_text_of(call.args[0]),
                value=shown(call.args[1]),
            )
    return None


def of_super(failure: Failure) -> Words | None:
    """`super().__init__` of a node was called without a name, or `super` without brackets."""
    for call in _calls(failure):
        func = call.func
        if not isinstance(func, ast.Attribute) or func.attr != "__init__":
            continue
        if isinstance(func.value, ast.Name) and func.value.id == "super":
            return say("The brackets of super() are missing: super().__init__(…).")
        me = failure.named("self")
        if me is UNKNOWN:
            continue
        if not is_from(me, "rclpy", "Node"):
            return say(
                "The class {name} is not a node yet: class {name}(Node).", name=type(me).__name__
            )
        if not call.args and not call.keywords:
            return say('A node needs a name: super().__init__("my_node").')
        return say(
            'A node is given its name, and nothing before or after it: super().__init__("my_node").'
        )
    return None


def base(failure: Failure) -> Words | None:
    """A class was derived from a module or from a node."""
    statement = failure.statement
    if not isinstance(failure.error, TypeError) or not isinstance(statement, ast.ClassDef):
        return None
    for each in statement.bases:
        value = failure.value(each)
        if isinstance(value, ModuleType):
            return say(
                "{what} is a module, and a class cannot be made of it: from rclpy.node import Node,"
                " and class {name}(Node).",
                what=shown(each),
                name=statement.name,
            )
    return None


def arguments(failure: Failure) -> Words | None:
    """A function was called with other arguments than it asks for."""
    for call in _calls(failure):
        function = failure.called(call)
        if function is UNKNOWN or not callable(function):
            continue
        words = _misfit(failure, call, function)
        if words is not None:
            return words
    return None


def not_callable(failure: Failure) -> Words | None:
    """Brackets stand behind something that cannot be called."""
    for call in _calls(failure):
        value, what = failure.value(call.func), shown(call.func)
        if value is UNKNOWN or callable(value):
            continue
        if value is None:
            return is_none(failure, call.func)
        if isinstance(value, ModuleType):
            last = value.__name__.rpartition(".")[2]
            there = getattr(value, last, None) or getattr(value, last.title(), None)
            if callable(there):
                return say(
                    "{what} is a module; what is meant is in it: {what}.{name}().",
                    what=what,
                    name=there.__name__,
                )
            return say("{what} is a module: name what is meant in it, {what}.x.", what=what)
        if isinstance(value, (list, tuple, dict, array.array)) and call.args:
            return say(
                "{what} is of type {type}: one of its values is had with square brackets,"
                " {what}[{index}].",
                what=what,
                type=type(value).__name__,
                index=shown(call.args[0]),
            )
        return say(
            "{what} is a value of type {type}, not a function: write it without brackets.",
            what=what,
            type=name_of(type(value)),
        )
    return None


def not_indexable(failure: Failure) -> Words | None:
    """Square brackets stand behind something that has no values by number or key."""
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    for each in failure.all(ast.Subscript):
        value, what = failure.value(each.value), shown(each.value)
        index = failure.value(each.slice)
        if is_message(value):
            return say(
                "{what} is a message, {type}: its fields are had with a point, {what}.{field}.",
                what=what,
                type=name_of(type(value)),
                field=index if isinstance(index, str) else "data",
            )
        if inspect.isroutine(value):
            return say(
                "{what} is a function: it is called with round brackets, {what}(…).", what=what
            )
        if isinstance(value, (list, tuple, array.array)) and isinstance(index, str):
            return say(
                "{what} is a list: its values have numbers, {what}[0], not names. If a dictionary"
                " was meant, it is one level further in.",
                what=what,
            )
        if isinstance(value, (list, tuple, array.array, str)) and isinstance(index, float):
            return say(
                "An index is a whole number: {what}[int({index})].",
                what=what,
                index=shown(each.slice),
            )
        if isinstance(value, str) and isinstance(index, str):
            return say(
                "{what} is a text. If it is JSON, read it first: json.loads({what})[{index!r}].",
                what=what,
                index=index,
            )
        if isinstance(value, (str, tuple)) and isinstance(each.ctx, ast.Store):
            return say(
                "{what} is of type {type}, which cannot be changed: make a new one, such as"
                " list({what}).",
                what=what,
                type=type(value).__name__,
            )
        words = remedy(failure, each.value)
        if words is not None:
            return words
    return None


def builtin(failure: Failure) -> Words | None:
    """`float`, `len`, `range` and the like were given something that they do not take."""
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    for call in _calls(failure):
        function = failure.value(call.func)
        if inspect.isfunction(function) or inspect.ismethod(function):
            continue
        for each in call.args:
            value = failure.value(each)
            if function is range and isinstance(value, float):
                return say("range takes whole numbers: range(int({what})).", what=shown(each))
            if _is_join(call) or function in (bytes, bytearray):
                words = _bytes(call, value)
                if words is not None:
                    return words
            if function is len and type(value) in (int, float):
                return say(
                    "{what} is one number: only a list or a text has a length.", what=shown(each)
                )
            if function in (float, int) and isinstance(value, (list, tuple, array.array)):
                return say(
                    "{what} is a list: take one of its values, {call}({what}[0]), or all,"
                    " [{call}(v) for v in {what}].",
                    what=shown(each),
                    call=shown(call.func),
                )
            words = remedy(failure, each)
            if words is not None:
                return words
    return None


def not_iterable(failure: Failure) -> Words | None:
    """Something that is no list stands where one is gone through."""
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    statement = failure.statement
    gone = [statement.iter] if isinstance(statement, ast.For) else []
    gone += [each.iter for each in failure.all(ast.comprehension)]
    if isinstance(statement, ast.Assign) and isinstance(
        statement.targets[0], (ast.Tuple, ast.List)
    ):
        gone.append(statement.value)
    for each in gone:
        value = failure.value(each)
        if isinstance(value, int):
            return say("{what} is a number: for i in range({what}) counts to it.", what=shown(each))
        words = remedy(failure, each)
        if words is not None:
            return words
    return None


def context(failure: Failure) -> Words | None:
    """`with` was used with something that is not made for it."""
    statement = failure.statement
    if not isinstance(failure.error, (TypeError, AttributeError)) or not isinstance(
        statement, ast.With
    ):
        return None
    if not failure.is_own or not _is_about_with(failure):
        return None
    for item in statement.items:
        if shown(item.context_expr).startswith(("rclpy.init(", "init(")):
            return say(
                "`with rclpy.init()` needs a newer ROS than Jazzy. Here: rclpy.init(args=args) on a"
                " line of its own, and rclpy.try_shutdown() at the end."
            )
        value = failure.value(item.context_expr)
        if value is None:
            return is_none(failure, item.context_expr)
        return say(
            "{what} cannot stand behind with: only files, locks and the like can.",
            what=shown(item.context_expr),
        )
    return None


def _is_about_with(failure: Failure) -> bool:
    name = getattr(failure.error, "name", None)
    return isinstance(failure.error, TypeError) or name in ("__enter__", "__exit__")


def awaited(failure: Failure) -> Words | None:
    """Something was awaited that is not a future."""
    found = failure.first(ast.Await)
    if not isinstance(failure.error, TypeError) or found is None or not failure.is_own:
        return None
    return say(
        "{what} cannot be awaited: await goes with a future, such as await"
        " self.client.call_async(request).",
        what=shown(found.value),
    )


def _calls(failure: Failure) -> list[ast.Call]:
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return []
    return failure.all(ast.Call)


def _text_of(node: ast.expr) -> str:
    value = node.value if isinstance(node, ast.Constant) else None
    return value if isinstance(value, str) else "{" + shown(node) + "}"


def _is_join(call: ast.Call) -> bool:
    return isinstance(call.func, ast.Attribute) and call.func.attr == "join"


def _bytes(call: ast.Call, value: Any) -> Words | None:  # noqa: ANN401
    if isinstance(value, (list, tuple)) and value and isinstance(value[0], bytes):
        what = shown(call.args[0])
        return say(
            '{what} is a list of single bytes: b"".join({what}) puts them together.', what=what
        )
    if isinstance(value, (list, tuple)) and _is_join(call):
        return say(
            "join puts texts together, and {what} has other values: [str(v) for v in {what}].",
            what=shown(call.args[0]),
        )
    return None


def _misfit(failure: Failure, call: ast.Call, function: Any) -> Words | None:  # noqa: ANN401
    if any(isinstance(each, ast.Starred) for each in call.args) or is_message_class(function):
        return None
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        return _without_self(call, function)
    names = [each.arg for each in call.keywords if each.arg is not None]
    if len(names) < len(call.keywords):
        return None
    unbound = not isinstance(call.func, ast.Attribute) or failure.value(call.func) is not UNKNOWN
    given = (*range(len(call.args) + (not unbound)),)
    try:
        signature.bind(*given, **dict.fromkeys(names))
    except TypeError:
        return _unbound(failure, call, function, signature) or _says(
            call, function, signature, names, called_on=not unbound
        )
    return None


def _unbound(
    failure: Failure,
    call: ast.Call,
    function: Any,  # noqa: ANN401
    signature: inspect.Signature,
) -> Words | None:
    """Say that a method was called on its class, or has no self."""
    on_class = isinstance(call.func, ast.Attribute) and isinstance(
        failure.value(call.func.value), type
    )
    if on_class and next(iter(signature.parameters), "") == "self":
        assert isinstance(call.func, ast.Attribute)
        return say(
            "{name} belongs to an object, and {owner} is the class: make one first, {owner}().",
            name=call.func.attr,
            owner=shown(call.func.value),
        )
    return _without_self(call, function)


def _without_self(call: ast.Call, function: Any) -> Words | None:  # noqa: ANN401
    inner = getattr(function, "__func__", None)
    code = getattr(inner, "__code__", None)
    if code is None:
        return None
    names = code.co_varnames[: code.co_argcount]
    if not names or (names[0] != "self" and len(call.args) == code.co_argcount):
        return say(
            "The first argument of a method is self: def {name}({arguments}).",
            name=function.__name__,
            arguments=", ".join(("self", *names)),
        )
    return None


def _says(
    call: ast.Call,
    function: Any,  # noqa: ANN401
    signature: inspect.Signature,
    names: list[str],
    *,
    called_on: bool,
) -> Words:
    parameters = list(signature.parameters.values())[int(called_on) :]
    known = [each.name for each in parameters]
    takes = ", ".join(
        each.name for each in parameters if each.default is each.empty and each.kind in (0, 1)
    )
    what = shown(call.func)
    extra = next((name for name in names if name not in known), "")
    if extra:
        meant = next((each for each in known if each.startswith(extra)), "") or nearest(
            extra, known
        )
        if meant:
            return say(
                "{what} has no argument {name}; did you mean {meant}?",
                what=what,
                name=extra,
                meant=meant,
            )
        return say(
            "{what} has no argument {name}; it has: {known}.",
            what=what,
            name=extra,
            known=listed(known) or "-",
        )
    missing = [
        each.name
        for each in parameters[len(call.args) :]
        if each.default is each.empty and each.kind in (0, 1, 3) and each.name not in names
    ]
    if missing == ["qos_profile"]:
        return say(
            "The last argument is missing, the queue depth: {what}({takes}), such as 10"
            " for qos_profile.",
            what=what,
            takes=takes,
        )
    if missing:
        return say(
            "{what} is called without {missing}; it takes {takes}.",
            what=what,
            missing=", ".join(missing),
            takes=takes,
        )
    by_name = [each.name for each in parameters if each.kind == each.KEYWORD_ONLY]
    if function.__name__ == "QoSProfile":
        by_name = ["depth"]
    if not takes and by_name:
        return say(
            "{what} takes its values by name: {what}({name}={value}).",
            what=what,
            name=by_name[0],
            value=shown(call.args[0]),
        )
    return say(
        "{what} takes {takes}, and is given {count} values.",
        what=what,
        takes=takes or say("nothing"),
        count=len(call.args),
    )


RULES = (
    logger,
    of_super,
    base,
    context,
    awaited,
    not_callable,
    not_indexable,
    arguments,
    builtin,
    not_iterable,
)
