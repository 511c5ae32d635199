"""YAML into plain values with their places, built from PyYAML's events, so memory stays bounded.

Anchors, aliases and tags are refused, depth and size are bounded.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NoReturn

import yaml

from text.sentences import Words, say
from text.yaml_faults import YamlError, events
from text.yaml_scalars import meaning

if TYPE_CHECKING:
    from collections.abc import Iterator

MAX_BYTES = 1024 * 1024
MAX_DEPTH = 64
_TAG = "tag:yaml.org,2002:"


@dataclass(slots=True)
class YamlNode:
    """A value and its position, counted from 1."""

    value: Any
    """A single value, a dict of names to nodes, or a list of nodes."""
    line: int
    column: int
    key_line: int = 0
    key_column: int = 0
    """Where its name stands; 0 for what has none."""

    def plain(self) -> Any:  # noqa: ANN401 - whatever was written
        """Return the value without places."""
        if isinstance(self.value, dict):
            return {name: node.plain() for name, node in self.value.items()}
        if isinstance(self.value, list):
            return [node.plain() for node in self.value]
        return self.value

    def find(self, path: str, prefix: str = "") -> YamlNode:
        """Return the node of a path such as `points[2].x`, or the nearest one that is around it."""
        for name, node in self._children(prefix):
            if name == path:
                return node
            if path.startswith((f"{name}.", f"{name}[")):
                return node.find(path, name)
        return self

    def _children(self, prefix: str) -> Iterator[tuple[str, YamlNode]]:
        if isinstance(self.value, dict):
            for key, node in self.value.items():
                yield (f"{prefix}.{key}" if prefix else key), node
        elif isinstance(self.value, list):
            for index, node in enumerate(self.value):
                yield f"{prefix}[{index}]", node


def read(text: str) -> YamlNode:
    """Return the only document of `text`, a mapping. Raises YamlError."""
    return _mapping(_read(text))


def value_of(text: str) -> Any:  # noqa: ANN401 - whatever was written
    """Return the value that the only document of `text` is, None for nothing. Raises YamlError."""
    root = _read(text)
    return None if root is None else root.plain()


def _read(text: str) -> YamlNode | None:
    if len(text.encode(errors="replace")) > MAX_BYTES:
        raise YamlError(1, 1, say("is longer than {limit} KiB", limit=MAX_BYTES // 1024))
    builder = _Builder()
    for event in events(text):
        builder.take(event)
    return builder.root


def _mapping(root: YamlNode | None) -> YamlNode:
    if root is None or root.value is None:
        raise YamlError(1, 1, say("is empty: write {} for a message with nothing but defaults"))
    if not isinstance(root.value, dict):
        words = say("expected fields as `name: value`, found a single value")
        if isinstance(root.value, list):
            words = say("expected fields as `name: value`, found a list")
        raise YamlError(root.line, root.column, words)
    return root


@dataclass(slots=True)
class _Open:
    """A mapping or a list that has not ended yet."""

    node: YamlNode
    key: YamlNode | None = None


class _Builder:
    """Takes events, builds the tree."""

    def __init__(self) -> None:
        self.root: YamlNode | None = None
        self._stack: list[_Open] = []

    def take(self, event: yaml.Event) -> None:
        """Take the next event."""
        if isinstance(event, yaml.ScalarEvent):
            _check(event)
            self._put(_node(event, self._scalar(event)))
        elif isinstance(event, yaml.CollectionStartEvent):
            self._open(event)
        elif isinstance(event, yaml.CollectionEndEvent):
            opened = self._stack.pop()
            if not self._stack:
                self.root = opened.node
        elif isinstance(event, yaml.AliasEvent):
            _refuse(event, say("aliases are refused: write the value out"))
        elif isinstance(event, yaml.DocumentStartEvent) and self.root is not None:
            _refuse(event, say("a second document begins here; one message, one document"))

    def _open(self, event: yaml.CollectionStartEvent) -> None:
        _check(event)
        if len(self._stack) >= MAX_DEPTH:
            _refuse(event, say("is nested deeper than {limit} levels", limit=MAX_DEPTH))
        node = _node(event, {} if isinstance(event, yaml.MappingStartEvent) else [])
        self._put(node)
        self._stack.append(_Open(node))

    def _put(self, node: YamlNode) -> None:
        """Put a value where it belongs: the root, a list, a name or a name's value."""
        if not self._stack:
            self.root = node
            return
        top = self._stack[-1]
        if isinstance(top.node.value, list):
            top.node.value.append(node)
        elif top.key is None:
            self._begin(top, node)
        else:
            node.key_line, node.key_column = top.key.line, top.key.column
            top.node.value[top.key.value] = node
            top.key = None

    def _begin(self, top: _Open, key: YamlNode) -> None:
        if isinstance(key.value, (dict, list)):
            raise YamlError(
                key.line, key.column, say("expected a field's name, found a list or fields")
            )
        first = top.node.value.get(key.value)
        if first is not None:
            words = say(
                "the field {name} appears a second time, first on line {line}",
                name=repr(key.value),
                line=first.key_line,
            )
            raise YamlError(key.line, key.column, words)
        top.key = key

    def _scalar(self, event: yaml.ScalarEvent) -> Any:  # noqa: ANN401 - whatever was written
        is_name = bool(self._stack) and self._stack[-1].key is None
        if is_name and isinstance(self._stack[-1].node.value, dict):
            # The names of fields are words, `on` and `y` too.
            return event.value
        is_text = bool(event.style) or event.tag == f"{_TAG}str"
        return event.value if is_text else meaning(event.value)


def _node(event: yaml.NodeEvent, value: Any) -> YamlNode:  # noqa: ANN401 - whatever was written
    return YamlNode(value, *_place(event))


def _place(event: yaml.Event) -> tuple[int, int]:
    mark = event.start_mark
    return (mark.line + 1, mark.column + 1) if mark else (1, 1)


def _check(event: yaml.ScalarEvent | yaml.CollectionStartEvent) -> None:
    if event.anchor is not None:
        _refuse(event, say("anchors are refused: write the value out"))
    if event.tag not in (None, f"{_TAG}str"):
        tag = event.tag.replace(_TAG, "!!")
        _refuse(event, say("the tag {tag} is refused: a message holds plain values", tag=tag))


def _refuse(event: yaml.Event, message: Words) -> NoReturn:
    raise YamlError(*_place(event), message)
