"""Reads YAML for messages and parameters: plain values only, without anchors and aliases."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from text.sentences import say
from text.yaml_faults import YamlError
from text.yaml_tree import Listing, Rules, check_colons, empty, mapping, plain
from text.yaml_tree import read as read_tree

if TYPE_CHECKING:
    from text.yaml_tree import Branch, Tree

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
    if root is not None:
        check_colons(root)
    if isinstance(root, Listing):
        for item in root.items:
            check_colons(item)
    return root


def value_of(text: str) -> Any:  # noqa: ANN401 - whatever was written
    """Return the value that the only document of `text` is, None for nothing. Raises YamlError."""
    root = read_tree(text, RULES)
    return None if root is None else plain(root)
