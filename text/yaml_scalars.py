"""What a word of YAML stands for, and how a text is written so that it stays a text.

As `ros2 topic pub` reads it (YAML 1.1 by PyYAML) but for what surprises people: `1e3`, `nan` and
`inf` are numbers, `0o17` is one too, while times (`12:30`) and dates are texts, not numbers in
base 60 or objects.
"""

from __future__ import annotations

import json
import math
import re
from functools import lru_cache
from typing import Any, TypeAlias

from text.plain import is_plain, replaced

Scalar: TypeAlias = "bool | int | float | str | None"

LONGEST_WORD = 1000
"""Characters; what is longer is a text, whatever it looks like."""

_BOOLS = {"yes": True, "no": False, "true": True, "false": False, "on": True, "off": False}
_NULLS = frozenset({"", "~", "null", "Null", "NULL"})
_INTEGER = re.compile(r"[-+]?(?:0b[01][01_]*|0x[0-9a-fA-F][0-9a-fA-F_]*|0o?[0-7][0-7_]*|0|[1-9][0-9_]*)")
_FLOAT = re.compile(r"[-+]?(?:[0-9][0-9_]*\.[0-9_]*|\.[0-9][0-9_]*|[0-9][0-9_]*(?=[eE]))(?:[eE][-+]?[0-9]+)?")
_NOT_FINITE = re.compile(r"(?P<sign>[-+]?)\.?(?:inf|Inf|INF)|\.?(?:nan|NaN|NAN)")
_PLAIN = re.compile(r"[^\W\d][\w/.+-]*(?: [\w/.+-]+)*|/[\w/.+-]*")
"""Texts that need no quotes, whatever stands around them."""
_BASES = {"0b": 2, "0x": 16, "0o": 8}


def meaning(word: str) -> Scalar:
    """Return what a word without quotes stands for; None is YAML's null."""
    if word in _NULLS:
        return None
    if word.lower() in _BOOLS and word in (word.lower(), word.capitalize(), word.upper()):
        return _BOOLS[word.lower()]
    return word if len(word) > LONGEST_WORD else _number_or_text(word)


def _number_or_text(word: str) -> int | float | str:
    if _INTEGER.fullmatch(word):
        return _integer(word.replace("_", ""))
    if _FLOAT.fullmatch(word):
        number = float(word.replace("_", ""))
        # Whoever writes 1e400 does not mean infinity.
        return number if math.isfinite(number) else word
    if special := _NOT_FINITE.fullmatch(word):
        sign = special["sign"]
        return math.nan if sign is None else math.copysign(math.inf, -1 if sign == "-" else 1)
    return word


def _integer(word: str) -> int:
    sign = -1 if word[0] == "-" else 1
    digits = word.lstrip("+-")
    if digits[:2] in _BASES:
        return sign * int(digits[2:], _BASES[digits[:2]])
    is_octal = len(digits) > 1 and digits[0] == "0"
    return sign * int(digits, 8 if is_octal else 10)


def written(value: Scalar) -> str:
    """Return a single value so that Deck and PyYAML both read the same value of it."""
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return _float(value)
    return quoted(value) if isinstance(value, str) else str(value)


def _float(number: float) -> str:
    if math.isnan(number):
        return ".nan"
    if math.isinf(number):
        return ".inf" if number > 0 else "-.inf"
    text = repr(number)
    # PyYAML takes `1e-05` for a text.
    return text.replace("e", ".0e") if "e" in text and "." not in text else text


@lru_cache(maxsize=4096)
def quoted(text: str) -> str:
    """Return a text, in double quotes where it would else be something different."""
    is_word = len(text) <= LONGEST_WORD and _PLAIN.fullmatch(text) and is_plain(text)
    is_text = is_word and meaning(text) == text
    return text if is_text and _stays_text(text) else in_quotes(text)


def _stays_text(text: str) -> bool:
    # A supervisor writes parameters, and does without the rest of YAML.
    import yaml

    resolver: Any = yaml.resolver.Resolver()
    return bool(resolver.resolve(yaml.ScalarNode, text, (True, False)) == _TEXT)


def in_quotes(text: str) -> str:
    """Return a text in double quotes, with escapes for what could not be seen, or be YAML."""
    return replaced(json.dumps(text, ensure_ascii=False), escaped).replace("\xa0", "\\u00A0")


def escaped(character: str) -> str:
    """Return a character as an escape, as it may stand between double quotes."""
    code = ord(character)
    is_half_a_character = 0xD800 <= code <= 0xDFFF
    if code > 0xFFFF:
        return f"\\U{code:08X}"
    return f"\\u{0xFFFD if is_half_a_character else code:04X}"


def unquoted(text: str) -> str | None:
    """Return the text that stands between double quotes, None if it is written otherwise."""
    if len(text) < 2 or not (text.startswith('"') and text.endswith('"')):
        return None
    import yaml

    from text.nested_yaml import read_yaml

    try:
        value = read_yaml(text)
    except (yaml.YAMLError, ValueError):
        return None
    return value if isinstance(value, str) else None


_TEXT = "tag:yaml.org,2002:str"
