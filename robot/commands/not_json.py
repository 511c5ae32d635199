"""What stands in a text where JSON has something else: told by its name and with its fix.

These are the habits of those who write it: people who know Python or JavaScript, models that talk,
keyboards and editors that choose other signs.
"""

from __future__ import annotations

import re
import unicodedata
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

_NAMED = (
    ("tag", re.compile(r"(?P<tag></?think>)")),
    ("fence", re.compile(r"```|~~~")),
    ("comment", re.compile(r"//|/\*|#")),
    ("backslash", re.compile(r"\\")),
    ("quotes", re.compile("(?P<quote>[“”„‟‘’‚«»'`])")),
    ("not_finite", re.compile(r"[+-]?(?:nan|inf(?:inity)?)\b", re.IGNORECASE)),
    ("number_form", re.compile(r"\+[0-9.]|-?\.[0-9]")),
)
"""Code, a key of `robot.commands.problems.TEMPLATES`, and what begins there."""
_ALIKE: Mapping[str, str] = MappingProxyType(dict(zip("，：［］｛｝＂−–", ',:[]{}"--', strict=True)))
"""Signs of other keyboards, and JSON's own."""
_CONSTANTS: Mapping[str, str] = MappingProxyType(
    {"true": "true", "false": "false", "none": "null", "null": "null", "undefined": "null"}
)
"""Words of other languages in lower case, and JSON's own."""
_WORD = re.compile(r"\w+")
_INVISIBLE = frozenset({"Cc", "Cf", "Zl", "Zp", "Zs"})
"""Categories of Unicode: controls, formats, separators."""


class Odd(NamedTuple):
    """A place where the text is not JSON."""

    code: str
    """Key of `robot.commands.problems.TEMPLATES`."""
    details: Mapping[str, str]


def odd(text: str, at: int) -> Odd | None:
    """Return what stands there instead of JSON, None if that has no name here."""
    for code, pattern in _NAMED:
        if found := pattern.match(text, at):
            return Odd(code, found.groupdict())
    sign, word = text[at : at + 1], _WORD.match(text, at)
    if sign in _ALIKE:
        return Odd("alike", {"sign": sign, "right": _ALIKE[sign]})
    if sign and unicodedata.category(sign) in _INVISIBLE:
        return Odd("invisible", {"number": f"U+{ord(sign):04X}"})
    if word and (right := _CONSTANTS.get(word.group().lower())):
        return Odd("constant", {"word": word.group(), "right": right})
    return None


def outside(text: str, at: int) -> str:
    """Return the code of what stands there where the JSON as a whole should begin."""
    if at == len(text):
        return "nothing"
    return "words_before" if "{" in text[at:] else "words"
