"""Parameters: set, declared and asked for by something that is none, and what is told of them."""

from __future__ import annotations

import inspect
import re
from typing import TYPE_CHECKING

from launcher.faults.failure import Failure, is_from, name_of
from launcher.faults.remedy import listed
from text.sentences import say

if TYPE_CHECKING:
    from text.sentences import Words

_OF_TYPE = re.compile(
    r"set parameter '(.+?)' to '(.*)' of type '(\w+)', expecting type '(\w+)'", re.DOTALL
)
"""What rclpy says of a parameter of the wrong type."""
_MIXED = re.compile(
    r"params file: '(?:--params-file )?(?P<file>[^']+)'.*Sequence should be of same type. "
    r"Value type '(?P<type>\w+)' do not belong at line_num (?P<line>\d+)",
    re.DOTALL,
)
"""What rcl_yaml_param_parser says of a list."""
_NUMBERS = ("INTEGER", "DOUBLE")
_SETTERS = ("set_parameters", "set_parameters_atomically", "_check_undeclared_parameters")
_LISTS = ("declare_parameters", "get_parameters")


def parameters(failure: Failure) -> Words | None:
    """Parameters were set by something that is no list of them."""
    level = next((each for each in failure.below("rclpy") if each.function in _SETTERS), None)
    if level is None or not isinstance(failure.error, (TypeError, AttributeError)):
        return None
    given = level.values.get("parameter_list")
    if is_from(given, "rclpy", "Parameter"):
        return say("{call} takes a list, even of one parameter: [parameter].", call=level.function)
    if isinstance(given, (list, tuple)) and not all(
        is_from(each, "rclpy", "Parameter") for each in given
    ):
        return say(
            "{call} takes a list of parameters: [Parameter('speed', value=2.0)], from"
            " rclpy.parameter import Parameter.",
            call=level.function,
        )
    return None


def parameter_value(failure: Failure) -> Words | None:
    """A parameter cannot hold such a value, or not as this type."""
    inner = failure.inner
    if inner is None or not inner.is_in("rclpy", "parameter"):
        return None
    if isinstance(failure.error, TypeError) and inner.function == "from_parameter_value":
        value = inner.values.get("parameter_value")
        if isinstance(value, (list, tuple)):
            return say(
                "The values of a parameter's list are all of one type, and these are: {types}.",
                types=listed(sorted({name_of(type(each)) for each in value})),
            )
        return say(
            "A parameter is a number, a text, True or False, or a list of one of them, and not"
            " {type}.",
            type=name_of(value if isinstance(value, type) else type(value)),
        )
    if isinstance(failure.error, ValueError) and inner.function == "__init__":
        return say(
            "The type of the parameter, {type}, and its value, {value}, do not agree:"
            " Parameter({name!r}, value=…) finds the type by itself.",
            type=str(getattr(inner.values.get("type_"), "name", "?")),
            value=str(inner.values.get("value")),
            name=str(inner.values.get("name")),
        )
    return None


def listing(failure: Failure) -> Words | None:
    """Parameters were declared or asked for by something that is no list of them."""
    level = next(
        (
            e
            for e in failure.below("rclpy")
            if e.function in ("declare_parameters", "get_parameters")
        ),
        None,
    )
    if level is None:
        return None
    names, pairs = level.values.get("names"), level.values.get("parameters")
    if level.function == "get_parameters" and isinstance(names, str):
        return say("get_parameters takes a list of names: [{name}].", name=repr(names))
    fits = isinstance(pairs, (list, tuple)) and all(isinstance(e, (list, tuple)) for e in pairs)
    if level.function == "declare_parameters" and not fits:
        return say(
            "declare_parameters takes a list of pairs, each in brackets of its own:"
            " [('speed', 1.0), ('turn', 0.5)]."
        )
    return None


def told(failure: Failure) -> Words | None:
    """A callback that is told of new values does not take them."""
    inner = failure.inner
    if inner is None or not isinstance(failure.error, TypeError):
        return None
    callback, code = inner.values.get("callback"), inner.frame.f_code
    given = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    # What makes timers and the like has the callback as an argument, and does not call it.
    if not inner.is_in("rclpy", "node") or not callable(callback) or "callback" in given:
        return None
    name = getattr(callback, "__name__", "")
    try:
        inspect.signature(callback).bind([])
    except (TypeError, ValueError) as error:
        if isinstance(error, ValueError) and inspect.isbuiltin(callback):
            return None
        return say(
            "The callback gets a list of the parameters, and returns SetParametersResult:"
            " def {name}({me}params).",
            name=name if name.isidentifier() else "on_change",
            me="self, " if inspect.ismethod(callback) else "",
        )
    return None


def declared(failure: Failure) -> Words | None:
    """A parameter was given from outside as another type than it is declared with."""
    if type(failure.error).__name__ != "InvalidParameterTypeException":
        return None
    found = _OF_TYPE.search(str(failure.error))
    declares = any(each.function.startswith("declare_param") for each in failure.below("rclpy"))
    if found is None or not declares:
        return None
    name, value, given, wanted = found.groups()
    if given.endswith("_ARRAY") != wanted.endswith("_ARRAY"):
        if wanted.endswith("_ARRAY"):
            return say("{name} is declared as a list, and is given a single value.", name=name)
        return say("{name} is declared as a single value, and is given a list.", name=name)
    given, wanted = given.replace("_ARRAY", ""), wanted.replace("_ARRAY", "")
    if given == "BOOL" and wanted == "STRING":
        return say(
            "{name} is declared as a text, and ROS takes yes, no, on, off, y, n, true and false"
            " without quotes for booleans: put the word in quotes.",
            name=name,
        )
    if wanted == "STRING" and given in _NUMBERS:
        return say(
            "{name} is declared as a text, and {value} without quotes is a number: put it in"
            " quotes.",
            name=name,
            value=value,
        )
    if wanted == "BOOL":
        return say("{name} is declared as a boolean: true or false, without quotes.", name=name)
    if wanted in _NUMBERS and given == "BOOL":
        return say(
            "{name} is declared as a number, and ROS takes yes, no, on, off, y, n, true and false"
            " for booleans.",
            name=name,
        )
    if wanted in _NUMBERS and given == "STRING":
        return say("{name} is declared as a number: write one, without quotes.", name=name)
    return None


def mixed_list(failure: Failure) -> Words | None:
    """A list in a file of parameters has values of several types."""
    found = _MIXED.search(str(failure.error))
    if found is None:
        return None
    file = found["file"].rpartition("/")[2]
    if found["type"] == "bool":
        return say(
            "Line {line} of {file}: a list has values of one type, and ROS takes yes, no, on, off,"
            " y, n, true and false without quotes for booleans: put all of them in quotes.",
            line=found["line"],
            file=file,
        )
    return say(
        "Line {line} of {file}: a list has values of one type: put all of them in quotes, or none;"
        " 1.0 is a double, 1 an integer.",
        line=found["line"],
        file=file,
    )


RULES = (listing, parameters, parameter_value, told, declared, mixed_list)
