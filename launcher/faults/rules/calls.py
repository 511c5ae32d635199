"""Calls with other things than the function takes: rclpy's own functions, and the learner's."""

from __future__ import annotations

import ast
import inspect
import itertools
import re
import typing
from collections.abc import Callable
from types import ModuleType
from typing import Any

from launcher.faults.failure import (
    UNKNOWN,
    Failure,
    TraceLevel,
    is_action_class,
    is_from,
    is_message,
    is_message_class,
    is_service_class,
    name_of,
    shown,
)
from launcher.faults.remedy import given, listed, of_message, of_text, parameter
from launcher.faults.rules.callbacks import SUBSCRIPTION, asks_for_other, not_handed_over
from launcher.faults.rules.names import home_of
from text.i18n import N_
from text.sentences import Words, say
from text.suggestions import nearest


def _is_text(value: object) -> bool:
    return isinstance(value, str)


_FITS: dict[str, Callable[[Any], bool]] = {
    "msg_type": is_message_class,
    "srv_type": is_service_class,
    "action_type": is_action_class,
    "topic": _is_text, "srv_name": _is_text, "action_name": _is_text, "name": _is_text, "node_name": _is_text,
    "callback": callable,
    "execute_callback": callable,
    "qos_profile": lambda value: is_from(value, "rclpy", "QoSProfile") or (type(value) is int and value >= 0),
    "timer_period_sec": lambda value: type(value) in (int, float) and value >= 0,
    "node": lambda value: is_from(value, "rclpy", "Node"),
}  # fmt: skip
"""What the arguments of rclpy's functions have to be, by rclpy's own names of them."""
_EXAMPLES = {
    "msg_type": ("std_msgs.msg", "Float32"),
    "srv_type": ("example_interfaces.srv", "AddTwoInts"),
    "action_type": ("example_interfaces.action", "Fibonacci"),
}
_SETTERS = ("set_parameters", "set_parameters_atomically", "_check_undeclared_parameters")
_LOGS = ("debug", "info", "warn", "warning", "error", "fatal")
_OPTIONS = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once", "name")
_PLACE = re.compile(r"%[-+ 0#]*\d*(?:\.\d+)?[dfsgeixr]")
"""Where a value is put into a text by the operator %."""


def made(failure: Failure) -> Words | None:
    """A function of rclpy that makes something was given other things than it needs."""
    level = next(failure.below("rclpy"), None)
    me = level.values.get("self") if level is not None else None
    if level is None or not (
        (
            level.function.startswith(("create_", "declare_parameter", "get_parameter"))
            and is_from(me, "rclpy", "Node")
        )
        or (level.function == "__init__" and is_from(me, "rclpy", "Node", "ActionClient", "ActionServer"))
    ):
        return None
    code = level.frame.f_code
    handed = {name: level.values[name] for name in _FITS if name in code.co_varnames[: code.co_argcount]}
    wrong = [name for name, value in handed.items() if not _FITS[name](value)]
    call = type(me).__name__ if level.function == "__init__" else f"self.{level.function}"
    if not wrong:
        is_heard = level.function == "create_subscription"
        return asks_for_other(SUBSCRIPTION, handed["callback"]) if is_heard else None
    if len(wrong) > 1 and any(
        all(_FITS[name](handed[other]) for name, other in zip(wrong, order, strict=True))
        for order in itertools.permutations(wrong)
    ):
        signature = inspect.signature(getattr(type(me), level.function))
        names = [each.name for each in signature.parameters.values() if each.default is each.empty]
        phrase = N_("The arguments are in another order: {call}({arguments}).")
        return say(phrase, call=call, arguments=", ".join(names[1:]).removesuffix(", kwargs"))
    name, value = wrong[0], handed[wrong[0]]
    if is_from(value, "rclpy", "Parameter"):
        return parameter(_written(failure, value))
    return _wrong(call, name, value)


def _written(failure: Failure, value: object) -> str:
    """Return the learner's expression for what was handed over."""
    return next((shown(each) for each in _arguments(failure) if failure.value(each) is value), "x")


def _arguments(failure: Failure) -> list[ast.expr]:
    calls = failure.all(ast.Call)
    return [one for each in calls for one in (*each.args, *(keyword.value for keyword in each.keywords))]


def _wrong(call: str, name: str, value: Any) -> Words:
    if name in ("callback", "execute_callback"):
        return not_handed_over(value)
    if _FITS[name] is _is_text:
        return say(
            "{call}: {name} is a text in quotes, and is given {given}.", call=call, name=name, given=given(value)
        )
    if name == "qos_profile":
        return say(
            "{call}: qos_profile is the queue depth, a whole number without quotes such as 10, or a"
            " QoSProfile(depth=10, …).",
            call=call,
        )
    if name == "timer_period_sec" and type(value) in (int, float):
        return say("{call}: the period is a number of seconds, and not below 0.", call=call)
    if name == "timer_period_sec" and is_message(value):
        return of_message(name, type(value))
    if name == "timer_period_sec":
        phrase = N_("{call}: the period comes first, as a number of seconds: self.create_timer(0.5, self.on_timer).")
        return say(phrase, call=call)
    if name == "node":
        return say("{call}: the node comes first: {call}(self, …).", call=call)
    return _wrong_type(call, name, value)


def _wrong_type(call: str, name: str, value: Any) -> Words:
    if is_message(value):
        phrase = N_("{call}: the type is handed over as it is, without brackets: {type}.")
        return say(phrase, call=call, type=name_of(type(value)))
    if isinstance(value, ModuleType):
        phrase = N_("{call}: {module} is a module; the type is a class in it: {module}.String.")
        return say(phrase, call=call, module=value.__name__)
    if isinstance(value, str):
        kind = value.rpartition("/")[2]
        home, kind = (home_of(kind), kind) if home_of(kind) else _EXAMPLES[name]
        phrase = N_(
            "{call}: the type is a class that is imported, and stands without quotes: from {home} import {type}."
        )
        return say(phrase, call=call, home=home, type=kind)
    kinds = (
        (is_service_class, say("a service")),
        (is_action_class, say("an action")),
        (is_message_class, say("a message")),
    )
    for fits, words in kinds:
        if fits(value):
            phrase = N_(
                "{call}: {type} is the type of {kind}, which does not go with it: a topic has"
                " messages (.msg), a service .srv, an action .action."
            )
            return say(phrase, call=call, type=value.__name__, kind=words)
    return say(
        "{call}: {name} is a class that is imported, such as from std_msgs.msg import Float32.", call=call, name=name
    )


def parameters(failure: Failure) -> Words | None:
    """Parameters were set, declared or asked for by something that is no list of them, or no value."""
    level = next((each for each in failure.below("rclpy") if each.function in _SETTERS), None)
    if level is not None and isinstance(failure.error, (TypeError, AttributeError)):
        new = level.values.get("parameter_list")
        if not isinstance(new, (list, tuple)) or not all(is_from(each, "rclpy", "Parameter") for each in new):
            return say(
                "{call} takes a list of parameters: [Parameter('speed', value=2.0)], from"
                " rclpy.parameter import Parameter.",
                call=level.function,
            )
    level = next((each for each in failure.below("rclpy") if each.function == "declare_parameters"), None)
    pairs = level.values.get("parameters") if level is not None else None
    is_list = isinstance(pairs, (list, tuple)) and all(isinstance(each, (list, tuple)) for each in pairs)
    if level is not None and not is_list:
        return say(
            "declare_parameters takes a list of pairs, each in brackets of its own: [('speed', 1.0), ('turn', 0.5)]."
        )
    inner = failure.inner
    if inner is None or not inner.is_in("rclpy", "parameter"):
        return None
    if isinstance(failure.error, TypeError) and inner.function == "from_parameter_value":
        value = inner.values.get("parameter_value")
        if isinstance(value, (list, tuple)):
            phrase = N_("The values of a parameter's list are all of one type, and these are: {types}.")
            return say(phrase, types=listed(sorted({name_of(type(each)) for each in value})))
        phrase = N_("A parameter is a number, a text, True or False, or a list of one of them, and not {type}.")
        return say(phrase, type=name_of(value if isinstance(value, type) else type(value)))
    if isinstance(failure.error, ValueError) and inner.function == "__init__":
        return say(
            "The type of the parameter, {type}, and its value, {value}, do not agree:"
            " Parameter({name!r}, value=…) finds the type by itself.",
            type=str(getattr(inner.values.get("type_"), "name", "?")),
            value=str(inner.values.get("value")),
            name=str(inner.values.get("name")),
        )
    return None


def spun(failure: Failure) -> Words | None:
    """`rclpy.spin`, or an executor, was given a class, or nothing that is a node."""
    spins = (each for each in failure.levels if each.is_in("rclpy") and each.function in ("spin", "spin_once"))
    level = next(spins, None)
    node = level.values.get("node", UNKNOWN) if level is not None else UNKNOWN
    if isinstance(node, type):
        return say("rclpy.spin was given a class: make a node of it first, node = {name}().", name=node.__name__)
    if node is not UNKNOWN and not is_from(node, "rclpy", "Node"):
        return say("rclpy.spin was given {type}, not a node.", type=name_of(type(node)))
    for level in failure.below("rclpy"):
        nodes = getattr(level.values.get("self"), "_nodes", ()) if level.is_in("rclpy", "executors") else ()
        kind = next((each for each in nodes if isinstance(each, type)), None)
        if kind is not None:
            return say(
                "The executor was given the class {name}: make a node of it first, executor.add_node({name}()).",
                name=kind.__name__,
            )
    return None


def _called(failure: Failure) -> tuple[ast.Call, TraceLevel] | None:
    """Return the call of the learner's own line whose function of ROS failed inside, and its level."""
    if failure.own is None or failure.is_own:
        return None
    level = failure.levels[failure.levels.index(failure.own) + 1]
    if not any(level.is_in(library) for library in ("rclpy", "tf2_ros", "cv_bridge")):
        return None
    for call in failure.all(ast.Call):
        if level.function in (shown(call.func).rpartition(".")[2], "__init__"):
            return call, level
    return None


def misused(failure: Failure) -> Words | None:
    """A function of ROS was handed something of another class than it says that it takes."""
    found = _called(failure)
    if found is None:
        return None
    call, level = found
    kind = failure.value(call.func.value) if isinstance(call.func, ast.Attribute) else UNKNOWN
    if isinstance(kind, type) and not isinstance(level.values.get("self", UNKNOWN), (kind, type(UNKNOWN))):
        phrase = N_("{what} is the class {name} itself: its brackets are missing where it is made, {name}().")
        return say(phrase, what=shown(call.func).rpartition(".")[0], name=kind.__name__)
    if "allable" in str(failure.error) and not callable(level.values.get("callback", callable)):
        return not_handed_over(level.values["callback"])
    if level.function == "sendTransform":
        value = level.values.get("transform")
        return say(
            "sendTransform takes a TransformStamped, or a list of them, and is given {given}.", given=given(value)
        )
    picture = level.values.get("img_msg", UNKNOWN)
    if picture is not UNKNOWN and not is_message(picture):
        phrase = N_("{call} takes the message of a picture, as a callback gets it, and is given {given}.")
        return say(phrase, call=shown(call.func), given=given(picture))
    return _annotated(failure, call, level)


def _annotated(failure: Failure, call: ast.Call, level: TraceLevel) -> Words | None:
    if not isinstance(failure.error, (TypeError, AttributeError, ValueError)):
        return None
    function = failure.called(call)
    function = inspect.unwrap(function) if callable(function) else function
    try:
        hints, known = typing.get_type_hints(function), inspect.signature(function).parameters
    except (AttributeError, NameError, TypeError, ValueError):  # A hint may be anything, and of what is not imported.
        hints, known = getattr(function, "__annotations__", {}), inspect.Signature().parameters
    for name, kind in hints.items():
        value = level.values.get(name, UNKNOWN)
        if "Duration" in str(kind) and isinstance(value, (int, float)):
            phrase = N_(
                "{function}: {name} is a Duration of rclpy: Duration(seconds={value}), from rclpy.duration"
                " import Duration."
            )
            return say(phrase, function=level.function, name=name, value=str(value))
        # A default may be of another class than what is asked for, and a float may be an int.
        if name not in known or not isinstance(kind, type) or kind is float:
            continue
        if value is UNKNOWN or value is known[name].default or isinstance(value, kind):
            continue
        phrase = N_("{function}: {name} is of type {type}, and is given {given}.")
        return say(phrase, function=level.function, name=name, type=kind.__name__, given=given(value))
    return None


def text_for_number(failure: Failure) -> Words | None:
    """A function of ROS or of Python was given a number in quotes."""
    if failure.own is None or failure.is_own or not isinstance(failure.error, (TypeError, ValueError)):
        return None
    for each in _arguments(failure) if re.search("str|digits", str(failure.error)) else ():
        value = failure.value(each)
        words = of_text(shown(each), value) if isinstance(value, str) else None
        if words is not None:
            return words
    return None


def logger(failure: Failure) -> Words | None:
    """The logger was given several things as print is, a number, or an option that it has not."""
    inner = failure.inner
    calls = [each for each in failure.all(ast.Call) if getattr(each.func, "attr", "") in _LOGS]
    if not isinstance(failure.error, TypeError) or inner is None or not calls:
        return None
    call, args = shown(calls[0].func), calls[0].args
    if inner.is_in("rclpy", "rcutils_logger"):
        unknown = next((each.arg for each in calls[0].keywords if each.arg not in (*_OPTIONS, None)), None)
        if unknown is not None:
            return _no_argument(call, unknown, list(_OPTIONS))
        message = inner.values.get("message")
        if args and not isinstance(message, str):
            return say(
                "The logger takes a text, and {what} is of type {type}: {call}(str({what})).",
                what=shown(args[0]),
                type=name_of(message if isinstance(message, type) else type(message)),
                call=call,
            )
    if calls[0] not in failure.refused_calls() or len(args) < 2 or "logger" not in call:
        return None
    text = failure.value(args[0])
    if isinstance(text, str) and _PLACE.search(text):
        return say(
            "The logger does not fill in {place} as printf does: {call}({text} % ({values})).",
            place=_PLACE.findall(text)[0],
            call=call,
            text=shown(args[0]),
            values=", ".join(map(shown, args[1:])),
        )
    return say(
        'The logger takes one text, not several as print does: {call}(f"{text} {{{value}}}").',
        call=call,
        text=text if isinstance(args[0], ast.Constant) else "{" + shown(args[0]) + "}",
        value=shown(args[1]),
    )


def arguments(failure: Failure) -> Words | None:
    """A function was called with other arguments than it asks for."""
    for call in failure.refused_calls():
        function = failure.called(call)
        if function is UNKNOWN or not callable(function) or is_message_class(function):
            continue
        if any(isinstance(each, ast.Starred) for each in call.args) or any(not each.arg for each in call.keywords):
            continue
        try:
            signature = inspect.signature(function)
        except (TypeError, ValueError):
            return _without_self(call, function)
        names = [each.arg for each in call.keywords if each.arg is not None]
        # What was found on the class has its self yet to get.
        of_class = isinstance(call.func, ast.Attribute) and failure.value(call.func) is UNKNOWN
        try:
            signature.bind(*range(len(call.args) + of_class), **dict.fromkeys(names))
        except TypeError:
            parameters = list(signature.parameters.values())[int(of_class) :]
            return _on_class(failure, call, signature) or _without_self(call, function) or _misfit(call, parameters)
    return None


def _on_class(failure: Failure, call: ast.Call, signature: inspect.Signature) -> Words | None:
    """Say that a method was called on its class."""
    if not isinstance(call.func, ast.Attribute) or call.func.attr == "__init__":
        return None
    of, me, owner = failure.value(call.func.value), failure.named("self"), shown(call.func.value)
    if not isinstance(of, type) or next(iter(signature.parameters), "") != "self":
        return None
    if me is not UNKNOWN and isinstance(me, of):
        return say("{owner} is the class: the node itself is self, self.{name}(…).", owner=owner, name=call.func.attr)
    phrase = N_("{name} belongs to an object, and {owner} is the class: make one first, {owner}().")
    return say(phrase, name=call.func.attr, owner=owner)


def _without_self(call: ast.Call, function: Any) -> Words | None:
    code = getattr(getattr(function, "__func__", None), "__code__", None)
    names = code.co_varnames[: code.co_argcount] if code is not None else ("self",)
    if names and (names[0] == "self" or len(call.args) != len(names)):
        return None
    phrase = N_("The first argument of a method is self: def {name}({arguments}).")
    return say(phrase, name=function.__name__, arguments=", ".join(("self", *names)))


def _misfit(call: ast.Call, parameters: list[inspect.Parameter]) -> Words:
    known, names = [each.name for each in parameters], [each.arg for each in call.keywords if each.arg]
    takes = ", ".join(each.name for each in parameters if each.default is each.empty and each.kind in (0, 1))
    what, extra = shown(call.func), next((name for name in names if name not in known), "")
    if extra == "queue_size" and "qos_profile" in known:
        phrase = N_("queue_size is of ROS 1; here the number alone stands at the end: {what}({takes}).")
        return say(phrase, what=what, takes=takes)
    if extra:
        return _no_argument(what, extra, known)
    missing = [
        each.name
        for each in parameters[len(call.args) :]
        if each.default is each.empty and each.kind in (0, 1, 3) and each.name not in names
    ]
    if missing == ["qos_profile"]:
        phrase = N_("The last argument is missing, the queue depth: {what}({takes}), such as 10 for qos_profile.")
        return say(phrase, what=what, takes=takes)
    if missing:
        phrase = N_("{what} is called without {missing}; it takes {takes}.")
        return say(phrase, what=what, missing=", ".join(missing), takes=takes)
    by_name = ["depth"] if what == "QoSProfile" else [each.name for each in parameters if each.kind == 3]
    if what == "rclpy.init" and call.args and isinstance(call.args[0], ast.Constant):
        return say(
            'rclpy.init takes no name: rclpy.init(). The name is given to the node, super().__init__("my_node").'
        )
    if not takes and by_name and call.args:
        phrase = N_("{what} takes its values by name: {what}({name}={value}).")
        return say(phrase, what=what, name=by_name[0], value=shown(call.args[0]))
    places, values = (
        ", ".join(each.name for each in parameters if each.kind in (0, 1)),
        listed([shown(each) for each in call.args]),
    )
    if not places:
        return say("{what} takes nothing, and is given {given}.", what=what, given=values)
    return say("{what} takes {takes}, and is given {given}.", what=what, takes=places, given=values or say("nothing"))


def _no_argument(what: str, name: str, known: list[str]) -> Words:
    meant = next((each for each in known if each.startswith(name)), "") or nearest(name, known)
    if meant:
        return say("{what} has no argument {name}; did you mean {meant}?", what=what, name=name, meant=meant)
    return say("{what} has no argument {name}; it has: {known}.", what=what, name=name, known=listed(known) or "-")


def of_super(failure: Failure) -> Words | None:
    """`super().__init__` of a node was called without a name, or `super` without brackets."""
    for call in failure.refused_calls():
        if not isinstance(call.func, ast.Attribute) or call.func.attr != "__init__":
            continue
        if shown(call.func.value) == "super":
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
        if isinstance(failure.value(each), ModuleType):
            phrase = N_(
                "{what} is a module, and a class cannot be made of it: from rclpy.node import Node,"
                " and class {name}(Node)."
            )
            return say(phrase, what=shown(each), name=statement.name)
    return None


def unwritten_init(failure: Failure) -> Words | None:
    """A node's class has no `__init__`, or has one that is not written as Python asks for."""
    for call in failure.refused_calls():
        kind = failure.value(call.func)
        if not isinstance(kind, type) or not any(each.__module__ == "rclpy.node" for each in kind.__mro__[1:]):
            continue
        own = vars(kind).get("__init__")
        if own is not None and not own.__code__.co_argcount:
            return say(
                "The first argument of a method is self: def {name}({arguments}).", name="__init__", arguments="self"
            )
        if call.args or call.keywords or own is not None:
            continue
        like = (each for each in vars(kind) if each.strip("_").lower() in ("init", "int", "innit", "inti", "intit"))
        name = next(like, "")
        if name:
            phrase = N_("{name} is not {init}, with two underscores on either side, and is never run.")
            return say(phrase, name=name, init="__init__")
        phrase = N_('The node has no name yet: in {name}, def __init__(self): super().__init__("my_node").')
        return say(phrase, name=kind.__name__)
    return None
