"""Sentences of this room that can still be translated by whoever shows them.

`str()` of one is English; it remembers the template and the values that it was made of, by which
the screen looks it up in a catalogue.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from text.plain import filled

if TYPE_CHECKING:
    from typing_extensions import Self


class Words(str):
    """An English sentence that remembers what it was made of.

    As a text it is harmless, whatever its values are; `values` holds them as they came.
    """

    __slots__ = ("template", "values")

    template: str
    values: dict[str, object]

    def __new__(cls, template: str, values: dict[str, object]) -> Self:
        """Fill `template`, in the manner of `str.format`, with `values`."""
        words = super().__new__(cls, filled(template, values))
        words.template = template
        words.values = values
        return words


def say(template: str, **values: object) -> Words:
    """Make a sentence: `say("no such bag: {path}", path=path)`."""
    return Words(template, values)


def no_number(value: object, shown: str) -> Words:
    """Say that a number was expected; of `0,5` that a fraction is written with a point."""
    if isinstance(value, str) and (comma := _DECIMAL_COMMA.fullmatch(value.strip())):
        return say("write a fraction with a point: {mended}", mended=".".join(comma.groups()))
    return say("expected a number, got {value}", value=shown)


_DECIMAL_COMMA = re.compile(r"([-+]?[0-9]+),([0-9]+)")
