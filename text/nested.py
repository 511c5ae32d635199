"""JSON from elsewhere: files, servers, nodes, other processes; bounded in depth.

The standard parser follows brackets as deep as its stack holds and ends in a RecursionError, and
what just fits ends whoever walks through it later. All of Deck reads by the
function here, and YAML by that of `text.nested_yaml`.
"""

from __future__ import annotations

import json
from typing import Any

MAX_DEPTH = 64
"""Levels of nesting; nothing that Deck exchanges with anybody has ten."""


class NestedTooDeeplyError(ValueError):
    """A text has more than `MAX_DEPTH` brackets inside each other."""

    def __init__(self) -> None:
        super().__init__(f"nested deeper than {MAX_DEPTH} levels")


def read_json(text: str | bytes | bytearray) -> Any:  # noqa: ANN401 - anything that JSON can express
    """Parse a JSON text.

    Raises:
        ValueError: if it is none, or nested deeper than `MAX_DEPTH`.
    """
    try:
        value = json.loads(text)  # noqa: TID251 - the one place
    except RecursionError:
        raise NestedTooDeeplyError from None
    opening = (b"[", b"{") if isinstance(text, (bytes, bytearray)) else ("[", "{")
    # Nearly every text has fewer brackets than it may have levels.
    if sum(map(text.count, opening)) > MAX_DEPTH:  # type: ignore[arg-type]
        check_depth(value)
    return value


def check_depth(value: object) -> None:
    """Raise NestedTooDeeplyError for lists and dicts that are nested deeper than `MAX_DEPTH`."""
    level = [value]
    for _level in range(MAX_DEPTH):
        level = [child for each in level for child in _children(each)]
        if not level:
            return
    raise NestedTooDeeplyError


def _children(value: object) -> list[object]:
    """Return the lists and dicts in a list or dict."""
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return [each for each in inner if isinstance(each, (dict, list))]
