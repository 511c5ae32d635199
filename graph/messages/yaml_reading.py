"""Reads YAML for messages and parameters: plain values only, without anchors and aliases."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from text.sentences import say
from text.yaml_faults import YamlError, fault
from text.yaml_reading import Rules, mapping
from text.yaml_reading import read as read_tree
from text.yaml_tree import Branch, Listing, Scalar, empty, plain

if TYPE_CHECKING:
    from text.sentences import Words
    from text.yaml_tree import FilePlace, Tree

SHOWN = 30
"""Characters of a value that an error repeats."""
WITHOUT_SPACE = re.compile(r"(?P<name>[A-Za-z]\w*):(?P<value>[^/\s][^\n]*)")
"""A field and its value in one word, as no field is called; not `http://`."""
RULES = Rules(shares=False, longest=1024 * 1024, deepest=64)


def read(text: str, rules: Rules = RULES) -> Branch | None:
    """Return the only document of `text`, a mapping, None if there is nothing. Raises YamlError."""
    root = read_tree(text, rules)
    return None if root is None or empty(root) else mapping(root)


def read_message(text: str) -> Branch:
    """Return the fields of a message. Raises YamlError."""
    root = read_fields(text)
    if root is None or empty(root):
        raise YamlError(1, 1, say("is empty: write {} for a message with nothing but defaults"))
    return mapping(root)


def read_fields(text: str) -> Tree | None:
    """Return what stands in a text that should be the fields of a message. Raises YamlError."""
    root = read_tree(text, RULES)
    if isinstance(root, Scalar):
        _check_colon(root.text, root.place)
    elif root is not None:
        _check_colons(root)
    return root


def _check_colons(tree: Tree) -> None:
    """Raise YamlError for `x:0`, which is a name without a value: no field is called so."""
    if isinstance(tree, Branch):
        for name, entry in tree.entries.items():
            if empty(entry.value):
                _check_colon(name, entry.key_place)
            _check_colons(entry.value)
    elif isinstance(tree, Listing):
        for item in tree.items:
            _check_colons(item)


def _check_colon(text: str, place: FilePlace) -> None:
    if found := WITHOUT_SPACE.match(text):
        raise fault(place, space_missing(found))


def space_missing(found: re.Match[str]) -> Words:
    """Say where the space goes."""
    value = found["value"] if len(found["value"]) <= SHOWN else f"{found['value'][:SHOWN]}…"
    return say("a space is missing after the ':': {mended}", mended=f"{found['name']}: {value}")


def value_of(text: str) -> Any:  # noqa: ANN401 - whatever was written
    """Return the value that the only document of `text` is, None for nothing. Raises YamlError."""
    root = read_tree(text, RULES)
    return None if root is None else plain(root)
