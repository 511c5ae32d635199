"""Names that are unknown: of another alphabet, misspelt, not imported, not of this function."""

from __future__ import annotations

import ast
import builtins
import importlib
import importlib.util
import re
import sys
import unicodedata

from launcher.faults.failure import UNKNOWN, Failure
from launcher.faults.homes import ROS1, home_of, ros1
from text.sentences import Words, say
from text.suggestions import near

_ALIASES = {"np": "import numpy as np", "cv": "import cv2", "plt": "import matplotlib.pyplot as plt"}
_OTHER_WORDS = {
    "true": "True", "false": "False", "null": "None", "none": "None", "nil": "None", "TRUE": "True",
    "FALSE": "False", "Error": "Exception", "console": "print(…)", "printf": "print(…)", "this": "self",
}  # fmt: skip
_OF_TODAY = ("sleep", "Time", "Timer", "Service", "get_time")
"""Names of rospy that other modules have as well."""
_CYRILLIC = str.maketrans("асеорхукАСЕОРХКМТВН", "aceopxykACEOPXKMTBH")
_USUAL = ("time", "math", "random", "functools", "datetime", "threading", "copy", "pathlib")
"""Modules whose names beginners use without importing them."""


def alphabet(failure: Failure) -> Words | None:
    """A name has a letter that only looks like a Latin one."""
    error = failure.error
    names = [getattr(error, "name", None), getattr(error, "name_from", None)]
    if isinstance(error, (TypeError, AssertionError, KeyError)):
        names += [each.arg for call in failure.all(ast.Call) for each in call.keywords]
        names += list(error.args) if isinstance(error, KeyError) else []
    elif not isinstance(error, (NameError, AttributeError, ImportError)):
        return None
    if isinstance(error, ImportError) and isinstance(failure.statement, ast.ImportFrom):
        names += [each.name for each in failure.statement.names]
    if isinstance(error, AttributeError):
        names += [each.attr for each in failure.all(ast.Attribute)]
    return next((words for each in names if isinstance(each, str) and (words := mixed(each)) is not None), None)


def mixed(name: str) -> Words | None:
    """Say which letter of a name is of another alphabet than the rest; None if none is."""
    has_latin = any(each.isascii() and each.isalpha() for each in name)
    for index, each in enumerate(name):
        if has_latin and not each.isascii() and each.isalpha():
            return say(
                "In {name} the letter {number}, {letter}, is not Latin ({alphabet}): type it again"
                " on the Latin keyboard.",
                name=name,
                number=index + 1,
                letter=each,
                alphabet=unicodedata.name(each, "?").partition(" ")[0].title(),
            )
    return None


def _name(error: NameError) -> str:
    """Return the name of an error, which has it apart since Python 3.10 only for what is global."""
    found = re.search(r"'([^']+)'", str(error))
    return str(getattr(error, "name", None) or (found[1] if found else "?"))


def local(failure: Failure) -> Words | None:
    """A variable of a function was read before it has a value."""
    if not isinstance(failure.error, UnboundLocalError):
        return None
    name = _name(failure.error)
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
    if not isinstance(failure.error, NameError) or isinstance(failure.error, UnboundLocalError):
        return None
    name, me = _name(failure.error), failure.named("self")
    if name in _OTHER_WORDS and not (name == "this" and me is UNKNOWN):
        return say("In Python it is written {meant}, not {name}.", meant=_OTHER_WORDS[name], name=name)
    if name in ("self", "this"):
        return say(
            "self is unknown here: it is the first argument of a method, def on_timer(self), and"
            " outside of a method there is none."
        )
    if me is not UNKNOWN and (hasattr(type(me), name) or name in vars(me)):
        return say("{name} belongs to the node: write self.{name}.", name=name)
    if name in ("name", "main", "_name_") and "__main__" in [each.value for each in failure.all(ast.Constant)]:
        return say("{name} has two underscores on either side here: {meant}.", name=name, meant="__name__")
    known = {*failure.own.values, *failure.own.frame.f_globals} if failure.own is not None else ()
    alike = next((each for each in known if not each.isascii() and each.translate(_CYRILLIC) == name), "")
    if alike:
        return say(
            "{name} is unknown here; the {other} above looks the same, and is written in"
            " Cyrillic letters: type it again on the Latin keyboard.",
            name=name,
            other=alike,
        )
    return (
        _of_ros1(failure, name)
        or _importable(failure, name)
        or _misspelt(failure, name)
        or say(
            "{name} is unknown here: is it spelled right and imported, is it made above in the same"
            " function? If it is a text, it stands in quotes.",
            name=name,
        )
    )


def _of_ros1(failure: Failure, name: str) -> Words | None:
    """Say what is written instead of a name of rospy."""
    if name == "rospy":
        name = next((each.attr for each in failure.all(ast.Attribute) if each.attr in ROS1), "")
    return ros1(name) if name in ROS1 and name not in _OF_TODAY else None


def _importable(failure: Failure, name: str) -> Words | None:
    if name in _ALIASES:
        return say("{name} is not imported: {line}.", name=name, line=_ALIASES[name])
    home = home_of(name)
    if not home:
        asked = [each.attr for each in failure.all(ast.Attribute) if getattr(each.value, "id", "") == name]
        if asked and _has(name, asked):
            return say("{name} is not imported: import {name}.", name=name)
        home = next((each for each in _USUAL if hasattr(sys.modules.get(each), name)), "")
    if home and not name.startswith("_"):
        return say("{name} is not imported: from {home} import {name}.", name=name, home=home)
    return None


def _has(name: str, asked: list[str]) -> bool:
    """Whether there is a module with one of the names that are asked of it."""
    try:
        if name in ("this", "antigravity") or importlib.util.find_spec(name) is None:
            return False
        module = sys.modules.get(name) or importlib.import_module(name)
    except Exception:  # noqa: BLE001 - whatever is wrong there, it is not what the learner asks
        return False
    return any(hasattr(module, each) for each in asked)


def _misspelt(failure: Failure, name: str) -> Words | None:
    if failure.own is None:
        return None
    own = {*failure.own.values, *failure.own.frame.f_globals} - set(vars(builtins))
    usual = [each for each in vars(builtins) if len(each) > 3 and (each[0].islower() or each[-5:] == name[-5:])]
    me = failure.named("self")
    of_self = near(name, dir(me), cutoff=0.75) if me is not UNKNOWN else []
    found = near(name, [*own, *usual], cutoff=0.75) or near(name, own, cutoff=0.67)
    found += [f"self.{each}" for each in of_self]
    return say("{name} is unknown here; did you mean {meant}?", name=name, meant=found[0]) if found else None
