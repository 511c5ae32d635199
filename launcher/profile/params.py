"""A node's parameters, with the types of ROS.

ROS has bool, 64-bit integer, double, string, and lists of one of these. A list that mixes integers and
other numbers becomes a list of doubles; rcl would refuse the mixture.
"""

from __future__ import annotations

import re
import sys
from typing import TypeAlias

from launcher.profile.reading import Problems
from text.sentences import say
from text.yaml_tree import Branch, Listing, Scalar, Tree, Where

Single: TypeAlias = bool | int | float | str
Param: TypeAlias = bool | int | float | str | list[bool] | list[int] | list[float] | list[str]

NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*(\.[A-Za-z_/][A-Za-z0-9_/]*)*")
"""The names that rcl accepts in `-p name:=value`: `a`, `a.b`, `qos_overrides./scan.depth`."""
LONGEST_TEXT = 32_768
"""Linux refuses an argument of 128 KiB; and escaping makes text longer."""
INT64 = 2**63


def flatten(params: Tree, where: Where, problems: Problems) -> dict[str, Param]:
    """Return {name: value}, nested names joined by dots; values ROS cannot hold are problems."""
    flat: dict[str, Param] = {}
    if isinstance(params, Branch):
        _flatten(params, "", where, flat, problems)
    return flat


def _flatten(params: Branch, prefix: str, where: Where, flat: dict[str, Param], problems: Problems) -> None:
    for key, entry in params.entries.items():
        name, here = prefix + key, (*where, key)
        if isinstance(entry.value, Branch):
            _flatten(entry.value, name + ".", here, flat, problems)
        elif not NAME.fullmatch(name):
            problems.add(
                entry.key_place,
                here,
                say("{name!r} is not a valid name for a ROS parameter", name=name),
                say("letters, digits and _, joined by dots"),
            )
        elif name in flat:
            problems.add(entry.key_place, here, say("the parameter {name} is given twice", name=name))
        elif isinstance(entry.value, Listing):
            items = _list(entry.value, here, problems)
            if items is not None:
                flat[name] = items
        else:
            value = _single(entry.value, here, problems)
            if value is not None:
                flat[name] = value


def _single(scalar: Scalar, where: Where, problems: Problems) -> Single | None:
    value = scalar.value
    if isinstance(value, str):
        message = _text_trouble(value)
    elif isinstance(value, (bool, int, float)):
        message = _number_trouble(value)
    else:
        hint = say("give it a value, or leave it out")
        problems.add(scalar.place, where, say("a ROS parameter cannot be empty"), hint)
        return None
    if message:
        problems.add(scalar.place, where, message)
        return None
    return value


def _text_trouble(text: str) -> str:
    if "\0" in text:
        return say("ROS cannot carry a NUL character in a string")
    if any("\ud800" <= character <= "\udfff" for character in text):
        return say("an incomplete character: a lone surrogate")
    if len(text) > LONGEST_TEXT:
        return say("the text is longer than {limit} characters", limit=LONGEST_TEXT)
    return ""


def _number_trouble(number: float) -> str:
    if isinstance(number, int) and not -INT64 <= number < INT64:
        return say("{value} does not fit into 64 bits", value=number)
    if 0 < abs(number) < sys.float_info.min:
        return say("{value} is too small for ROS", value=number)
    return ""


def _list(listing: Listing, where: Where, problems: Problems) -> Param | None:
    if not listing.items:
        problems.add(listing.place, where, say("an empty list has no type in ROS"), say("leave the parameter out"))
        return None
    items: list[Single] = []
    for index, item in enumerate(listing.items):
        if not isinstance(item, Scalar):
            kind = say("a list of lists") if isinstance(item, Listing) else say("a list of mappings")
            problems.add(
                item.place,
                (*where, index),
                say("ROS has no parameter that is {kind}", kind=kind),
                say("give each its own name"),
            )
            return None
        value = _single(item, (*where, index), problems)
        if value is not None:
            items.append(value)
    return _of_one_type(items, listing, where, problems) if len(items) == len(listing.items) else None


def _of_one_type(items: list[Single], listing: Listing, where: Where, problems: Problems) -> Param | None:
    kinds = {type(item) for item in items}
    if kinds == {int, float}:
        return [float(item) for item in items]
    if len(kinds) == 1:
        return items  # type: ignore[return-value]
    words = {bool: "bool", int: "integer", float: "double", str: "string"}
    names = ", ".join(sorted(words[kind] for kind in kinds))
    problems.add(
        listing.place,
        where,
        say("a list in ROS holds one type, this one holds {names}", names=names),
        say("quote all of them, or none"),
    )
    return None
