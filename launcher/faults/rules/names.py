"""Names that are unknown: of another alphabet, misspelt, not imported, not of this function."""

from __future__ import annotations

import ast
import builtins
import importlib.util
import re
import sys
import unicodedata
from collections.abc import Callable

from launcher.faults.failure import UNKNOWN, Failure
from launcher.faults.homes import ROS1, home_of, ros1
from text.sentences import Words, say
from text.suggestions import near

ALIASES = {"np": "import numpy as np", "cv": "import cv2", "plt": "import matplotlib.pyplot as plt"}
OTHER_WORDS = {
    "true": "True", "false": "False", "null": "None", "none": "None", "nil": "None",
    "TRUE": "True", "FALSE": "False", "Error": "Exception", "console": "print(…)",
    "System": "print(…)", "cout": "print(…)", "printf": "print(…)", "echo": "print(…)",
}  # fmt: skip

_OF_TODAY = ("sleep", "Time", "Timer", "Service", "get_time")
"""Names of rospy that other modules have as well."""
_USUAL = ("time", "math", "random", "functools", "datetime", "threading", "copy", "pathlib")
"""Modules whose names beginners use without importing them."""


def alphabet(failure: Failure) -> Words | None:
    """A name has a letter that only looks like a Latin one."""
    error = failure.error
    names = [getattr(error, "name", None), getattr(error, "name_from", None)]
    if not isinstance(error, (NameError, AttributeError, ImportError)):
        if not isinstance(error, (TypeError, AssertionError, KeyError)):
            return None
        names = [each.arg for call in failure.all(ast.Call) for each in call.keywords]
        names += list(error.args) if isinstance(error, KeyError) else []
    if isinstance(error, ImportError) and isinstance(failure.statement, ast.ImportFrom):
        names += [each.name for each in failure.statement.names]
    if isinstance(error, AttributeError):
        names += [each.attr for each in failure.all(ast.Attribute)]
    for name in names:
        words = mixed(name) if isinstance(name, str) else None
        if words is not None:
            return words
    return None


def mixed(name: str) -> Words | None:
    """Say which letter of a name is of another alphabet than the rest; None if none is."""
    latin = [each for each in name if each.isascii() and each.isalpha()]
    for index, each in enumerate(name):
        if not each.isascii() and each.isalpha() and latin:
            return say(
                "In {name} the letter {number}, {letter}, is not Latin ({alphabet}): type it again"
                " on the Latin keyboard.",
                name=name,
                number=index + 1,
                letter=each,
                alphabet=unicodedata.name(each, "?").partition(" ")[0].title(),
            )
    return None


def local(failure: Failure) -> Words | None:
    """A variable of a function was read before it has a value."""
    error = failure.error
    if not isinstance(error, UnboundLocalError):
        return None
    name = getattr(error, "name", None) or _quoted(error)
    if failure.own is not None and name in failure.own.frame.f_globals:
        return say(
            "{name} is given a value in this function, and is therefore a variable of its own here."
            " For the one outside: global {name}; in a node rather self.{name}.",
            name=name,
        )
    return say(
        "{name} has no value yet: it is given one only below, or in a branch that was not taken. Give it one before.",
        name=name,
    )


def unknown(failure: Failure) -> Words | None:
    """A name is unknown."""
    error = failure.error
    if not isinstance(error, NameError) or isinstance(error, UnboundLocalError):
        return None
    name = getattr(error, "name", None) or _quoted(error)
    if name in OTHER_WORDS:
        return say("In Python it is written {meant}, not {name}.", meant=OTHER_WORDS[name], name=name)
    if name == "this" and failure.named("self") is not UNKNOWN:
        return say("In Python it is written {meant}, not {name}.", meant="self", name=name)
    if name in ("self", "this"):
        return say(
            "self is unknown here: it is the first argument of a method, def on_timer(self), and"
            " outside of a method there is none."
        )
    return (
        _of_self(failure, name)
        or _dunder(failure, name)
        or _alike(failure, name)
        or _of_ros1(failure, name)
        or _importable(failure, name)
        or _misspelt(failure, name)
        or say(
            "{name} is unknown here: is it spelled right and imported, is it made above in the same"
            " function? If it is a text, it stands in quotes.",
            name=name,
        )
    )


def _quoted(error: NameError) -> str:
    """Return the name of an error that does not have it apart, as before Python 3.11."""
    found = re.search(r"'([^']+)'", str(error))
    return found[1] if found else "?"


def _of_self(failure: Failure, name: str) -> Words | None:
    me = failure.named("self")
    if me is UNKNOWN or (not hasattr(type(me), name) and name not in vars(me)):
        return None
    return say("{name} belongs to the node: write self.{name}.", name=name)


def _dunder(failure: Failure, name: str) -> Words | None:
    """Say how the name is written that tells whether a file is the program."""
    values = [each.value for each in failure.all(ast.Constant)]
    if name not in ("name", "main", "_name_") or "__main__" not in values:
        return None
    return say("{name} has two underscores on either side here: {meant}.", name=name, meant="__name__")


_CYRILLIC = str.maketrans("асеорхукАСЕОРХКМТВН", "aceopxykACEOPXKMTBH")


def _alike(failure: Failure, name: str) -> Words | None:
    """Say that a known name looks the same, and is written in Cyrillic."""
    known = {*failure.own.values, *failure.own.frame.f_globals} if failure.own is not None else ()
    for each in known:
        if not each.isascii() and each.translate(_CYRILLIC) == name:
            return say(
                "{name} is unknown here; the {other} above looks the same, and is written in"
                " Cyrillic letters: type it again on the Latin keyboard.",
                name=name,
                other=each,
            )
    return None


def _of_ros1(failure: Failure, name: str) -> Words | None:
    """Say what is written instead of a name of rospy."""
    if name == "rospy":
        asked = next((each.attr for each in failure.all(ast.Attribute) if each.attr in ROS1), "")
        return ros1(asked) if asked else None
    return ros1(name) if name in ROS1 and name not in _OF_TODAY else None


def _importable(failure: Failure, name: str) -> Words | None:
    if name in ALIASES:
        return say("{name} is not imported: {line}.", name=name, line=ALIASES[name])
    home = home_of(name)
    if home:
        return say("{name} is not imported: from {home} import {name}.", name=name, home=home)
    if name in sys.stdlib_module_names or (name.isidentifier() and _is_installed(name)):
        return _module(failure, name)
    module = next((each for each in _USUAL if hasattr(sys.modules.get(each), name)), "")
    if module and not name.startswith("_"):
        return say("{name} is not imported: from {home} import {name}.", name=name, home=module)
    return None


def _module(failure: Failure, name: str) -> Words | None:
    """Say that a module is not imported, if what is asked of the name is in it."""
    asked = [
        each.attr for each in failure.all(ast.Attribute) if isinstance(each.value, ast.Name) and each.value.id == name
    ]
    if not asked or name in ("this", "antigravity"):
        return None
    module = sys.modules.get(name) or importlib.import_module(name)
    if not any(hasattr(module, each) for each in asked):
        return None
    return say("{name} is not imported: import {name}.", name=name)


def _is_installed(name: str) -> bool:
    try:
        return importlib.util.find_spec(name) is not None
    except (ImportError, ValueError):
        return False


def _misspelt(failure: Failure, name: str) -> Words | None:
    if failure.own is None:
        return None
    me = failure.named("self")
    own = {*failure.own.values, *failure.own.frame.f_globals} - set(vars(builtins))
    known = {*own, *vars(builtins)}
    meant = next(iter(near(name, filter(_is_likely(name), known), cutoff=0.75)), "") or next(
        iter(near(name, own, cutoff=0.67)), ""
    )
    if meant:
        return say("{name} is unknown here; did you mean {meant}?", name=name, meant=meant)
    of_self = next(iter(near(name, dir(me), cutoff=0.75)), "") if me is not UNKNOWN else ""
    if of_self:
        return say("{name} is unknown here; did you mean {meant}?", name=name, meant=f"self.{of_self}")
    return None


def _is_likely(name: str) -> Callable[[str], bool]:
    """Return what tells a name of Python's own that is too short, or an exception."""

    def likely(known: str) -> bool:
        value = vars(builtins).get(known)
        if isinstance(value, type) and issubclass(value, BaseException):
            return name.endswith(("Error", "Exception", "Interrupt", "Exit"))
        return value is None or len(known) > 3 or name.startswith(known)

    return likely


RULES = (alphabet, local, unknown)
