"""Parameters: set, declared and asked for by something that is none, and what callbacks get."""

from __future__ import annotations

import inspect
import re
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.faults.failure import Failure, is_from, name_of
from launcher.faults.remedy import listed
from text.sentences import say
from text.suggestions import no_number
from text.yaml_faults import YamlError
from text.yaml_reading import Rules, check_colons, mapping, read
from text.yaml_tree import Branch, empty

if TYPE_CHECKING:
    from text.sentences import Words
    from text.yaml_tree import Tree

_OF_TYPE = re.compile(r"set parameter '(.+?)' to '(.*)' of type '(\w+)', expecting type '(\w+)'", re.DOTALL)
"""What rclpy says of a parameter of the wrong type."""
_FILE = re.compile(r"parse params file: '(?:--params-file )?(?P<file>[^']+)'")
_MIXED = re.compile(r"same type. Value type '(?P<type>\w+)' do not belong at line_num (?P<line>\d+)")
"""What rcl_yaml_param_parser says of a file, and of a list in it."""
_ABOVE = "before ros__parameters"
_BOOLEAN = re.compile(r"(?<![\w'\"])(?:y|n|yes|no|on|off|true|false)(?![\w'\"])", re.IGNORECASE)
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_RULES = Rules(shares=True, longest=1 << 20, deepest=64, most=100_000, joins=True)
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
    if isinstance(given, (list, tuple)) and not all(is_from(each, "rclpy", "Parameter") for each in given):
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
            "A parameter is a number, a text, True or False, or a list of one of them, and not {type}.",
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
    level = next((e for e in failure.below("rclpy") if e.function in ("declare_parameters", "get_parameters")), None)
    if level is None:
        return None
    names, pairs = level.values.get("names"), level.values.get("parameters")
    if level.function == "get_parameters" and isinstance(names, str):
        return say("get_parameters takes a list of names: [{name}].", name=repr(names))
    fits = isinstance(pairs, (list, tuple)) and all(isinstance(e, (list, tuple)) for e in pairs)
    if level.function == "declare_parameters" and not fits:
        return say(
            "declare_parameters takes a list of pairs, each in brackets of its own: [('speed', 1.0), ('turn', 0.5)]."
        )
    return None


def told(failure: Failure) -> Words | None:
    """A callback of new values has the wrong arguments."""
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
            "The callback gets a list of the parameters, and returns SetParametersResult: def {name}({me}params).",
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
            "{name} is declared as a text, and {value} without quotes is a number: put it in quotes.",
            name=name,
            value=value,
        )
    if wanted == "BOOL":
        return say("{name} is declared as a boolean: true or false, without quotes.", name=name)
    if wanted in _NUMBERS and given == "BOOL":
        return say(
            "{name} is declared as a number, and ROS takes yes, no, on, off, y, n, true and false for booleans.",
            name=name,
        )
    if wanted in _NUMBERS and given == "STRING":
        return _no_number(name, value)
    return None


def _no_number(name: str, value: str) -> Words:
    """Say what is wrong with a text where a number should be, or a list of them."""
    if value.startswith("[") or _NUMBER.fullmatch(value.strip()):
        return say("{name} is declared as a number: write one, without quotes.", name=name)
    reason = no_number(value, ascii(value) if not value.isprintable() else repr(value))
    return say("{name} is declared as a number: {reason}.", name=name, reason=reason)


def in_file(failure: Failure) -> Words | None:
    """A file of parameters cannot be read by rcl."""
    found = _FILE.search(str(failure.error))
    if found is None:
        return None
    path, name = Path(found["file"]), found["file"].rpartition("/")[2]
    try:
        raw = path.read_bytes()
        text = raw.decode("utf-8-sig")
        _check(read(text, _RULES))
    except UnicodeDecodeError as error:
        return say(
            "{file}, line {line}: this is not UTF-8 text.", file=name, line=raw.count(b"\n", 0, error.start) + 1
        )
    except YamlError as error:
        return say(
            "{file}, line {line}, column {column}: {reason}.",
            file=name,
            line=error.line,
            column=error.column,
            reason=error.message,
        )
    except (OSError, ValueError):
        return None
    if _ABOVE in str(failure.error):
        return say(
            "{file}: parameters stand below ros__parameters, with two underscores, and this stands"
            " below the name of the node.",
            file=name,
        )
    return _mixed(str(failure.error), name, text.splitlines())


def _check(tree: Tree | None) -> None:
    """Raise YamlError where a space is missing after a colon."""
    if isinstance(tree, Branch):
        check_colons(tree)
        for name, entry in tree.entries.items():
            if name == "ros__parameters" and not empty(entry.value):
                mapping(entry.value)
            _check(entry.value)


def _mixed(said: str, file: str, lines: list[str]) -> Words | None:
    """Say that a list has values of several types; None if nothing is said of one."""
    found = _MIXED.search(said)
    if found is None:
        return None
    number = int(found["line"])
    line = lines[number - 1] if number <= len(lines) else ""
    if found["type"] == "bool" or _BOOLEAN.search(line):
        return say(
            "Line {line} of {file}: a list has values of one type, and ROS takes yes, no, on, off,"
            " y, n, true and false without quotes for booleans: put all of them in quotes.",
            line=number,
            file=file,
        )
    return say(
        "Line {line} of {file}: a list has values of one type: put all of them in quotes, or none;"
        " 1.0 is a double, 1 an integer.",
        line=number,
        file=file,
    )


RULES = (listing, parameters, parameter_value, told, declared, in_file)
