"""What the attributes of URDF hold: names, numbers, places."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from space.transform import IDENTITY, Transform, Vector
from text.sentences import say
from text.suggestions import no_number

if TYPE_CHECKING:
    from collections.abc import Iterable

    from space.xml_elements import Element

FARTHEST_M = 1e5
"""A longer length is a mistake, and sums of far longer ones are not numbers any more."""
LONGEST_SHOWN = 60
"""Characters of a value that a sentence repeats."""
ZEROS: Vector = (0.0, 0.0, 0.0)


def written(element: Element, attribute: str) -> str:
    """Return an attribute that must not be empty. Raises XmlError."""
    value = element.attributes.get(attribute, "").strip()
    if not value:
        raise element.wrong(
            say("<{tag}> has no {attribute}", tag=element.tag, attribute=attribute),
            say('write <{tag} {attribute}="...">', tag=element.tag, attribute=attribute),
        )
    return value


def inner(element: Element, tag: str) -> Element:
    """Return an element that must be there. Raises XmlError."""
    found = element.first(tag)
    if found is None:
        raise element.wrong(say("<{outer}> {name} has no <{tag}>", outer=element.tag, name=name_of(element), tag=tag))
    return found


def name_of(element: Element) -> str:
    """Return the name as it is shown, empty without one."""
    return element.attributes.get("name", "")


def number(element: Element, attribute: str, default: float | None = None) -> float:
    """Return one finite number; without a default it must be there. Raises XmlError."""
    if default is not None and attribute not in element.attributes:
        return default
    (value,) = numbers(element, attribute, 1)
    return value


def numbers(element: Element, attribute: str, count: int) -> tuple[float, ...]:
    """Return so many finite numbers. Raises XmlError."""
    words = written(element, attribute).split()
    if len(words) != count:
        raise element.wrong(
            say(
                "{attribute} of <{tag}> has {found} numbers, and not {count}",
                attribute=attribute,
                tag=element.tag,
                found=len(words),
                count=count,
            ),
            say("separate them with spaces"),
        )
    return tuple(_finite(element, attribute, word) for word in words)


def vector(element: Element, attribute: str, default: Vector) -> Vector:
    """Return three finite numbers, `default` where the attribute is missing. Raises XmlError."""
    if attribute not in element.attributes:
        return default
    x, y, z = numbers(element, attribute, 3)
    return x, y, z


def length(element: Element, attribute: str) -> float:
    """Return a size in metres. Raises XmlError."""
    (metres,) = lengths(element, attribute, 1)
    return metres


def lengths(element: Element, attribute: str, count: int) -> tuple[float, ...]:
    """Return so many sizes in metres. Raises XmlError."""
    sizes = numbers(element, attribute, count)
    for size in sizes:
        if not 0.0 <= size <= FARTHEST_M:
            raise element.wrong(
                say("{attribute} of <{tag}> is {size:g} m", attribute=attribute, tag=element.tag, size=size),
                say("a size is from 0 to {most:g} m", most=FARTHEST_M),
            )
    return sizes


def origin(element: Element) -> Transform:
    """Return the `<origin>` of an element: metres, and roll, pitch and yaw. Raises XmlError."""
    found = element.first("origin")
    if found is None:
        return IDENTITY
    place = vector(found, "xyz", ZEROS)
    if max(map(abs, place)) > FARTHEST_M:
        raise found.wrong(say("<origin> is more than {most:g} m away", most=FARTHEST_M), say("write metres"))
    return Transform.from_rpy(place, vector(found, "rpy", ZEROS))


def one_of(element: Element, attribute: str, known: Iterable[str]) -> str:
    """Return an attribute that must be one of the known words. Raises XmlError."""
    word = written(element, attribute)
    choices = list(known)
    if word not in choices:
        raise element.wrong(
            say(
                "{attribute} of <{tag}> {name} is {word}",
                attribute=attribute,
                tag=element.tag,
                name=name_of(element),
                word=word[:LONGEST_SHOWN],
            ),
            say("it can be: {known}", known=", ".join(choices)),
        )
    return word


def _finite(element: Element, attribute: str, word: str) -> float:
    try:
        # Python would read 1_0 as ten.
        value = float(word.replace("_", "?"))
    except ValueError:
        reason = no_number(word, word[:LONGEST_SHOWN])
    else:
        if math.isfinite(value):
            return value
        reason = say("{word} is not a finite number", word=word[:LONGEST_SHOWN])
    raise element.wrong(say("{attribute} of <{tag}>: {reason}", attribute=attribute, tag=element.tag, reason=reason))
