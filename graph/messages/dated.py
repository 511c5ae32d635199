"""Fills in the time of sending: `stamp: now` and `header: auto`, as in `ros2 topic pub`.

Source of the two keywords: ros2cli, `ros2 topic pub --help`.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from graph.messages.fields import FieldType, parse
from graph.messages.making import to_message
from graph.messages.stamps import HEADER
from graph.messages.types import load_message
from graph.messages.values import fields_of

if TYPE_CHECKING:
    from graph.data import Value

TIME = "builtin_interfaces/Time"
NOW, AUTO = "now", "auto"
_WORDS = {TIME: NOW, HEADER: AUTO}
_STAMP = {TIME: (), HEADER: ("stamp",)}
"""Path of the time within the field that the keyword replaces."""
NANOSECONDS_PER_S = 1_000_000_000
Path: TypeAlias = "tuple[str | int, ...]"


@dataclass(frozen=True, slots=True)
class Draft:
    """A message to be sent, once or periodically."""

    message: Any
    stamps: tuple[Path, ...] = ()
    """The fields that hold the time of sending."""

    def dated(self, now_ns: int | None = None) -> Any:  # noqa: ANN401 - generated, no base class
        """Return the message as it should be sent at this moment, or else by the system clock."""
        now_ns = time.time_ns() if now_ns is None else now_ns
        seconds, nanoseconds = divmod(now_ns, NANOSECONDS_PER_S)
        for path in self.stamps:
            field = self.message
            for step in path:
                field = field[step] if isinstance(step, int) else getattr(field, step)
            field.sec, field.nanosec = seconds, nanoseconds
        return self.message


def draft(cls: type[Any], tree: Mapping[str, Value]) -> Draft:
    """Return a message of the class with these fields, as `to_message` does, with the two keywords.

    Raises FieldError.
    """
    stamps: list[Path] = []
    return Draft(to_message(cls, _without_words(cls, tree, (), stamps)), tuple(stamps))


def with_words(cls: type[Any], tree: Mapping[str, Value]) -> dict[str, Value]:
    """Return the tree with `now` as the stamp of every header that is not in an array."""
    shown: dict[str, Value] = dict(tree)
    for name, text in fields_of(cls):
        kind = parse(text)
        value = tree[name]
        if kind.is_message and not kind.is_many and isinstance(value, Mapping):
            if kind.element == HEADER:
                shown[name] = {**value, "stamp": NOW}
            else:
                shown[name] = with_words(_class_of(kind), value)
    return shown


def _without_words(
    cls: type[Any],
    tree: Any,  # noqa: ANN401 - whatever was typed; errors are reported when the message is made
    path: Path,
    stamps: list[Path],
) -> Any:  # noqa: ANN401
    if not isinstance(tree, Mapping):
        return tree
    fields = dict(fields_of(cls))
    plain = dict(tree)
    for name, value in tree.items():
        kind = parse(fields[name]) if name in fields else None
        if kind is None or not kind.is_message:
            continue
        if kind.is_many and isinstance(value, list):
            plain[name] = [
                _without_word(kind, each, (*path, name, index), stamps) for index, each in enumerate(value)
            ]
        elif not kind.is_many:
            plain[name] = _without_word(kind, value, (*path, name), stamps)
    return plain


def _without_word(kind: FieldType, value: Value, path: Path, stamps: list[Path]) -> Any:  # noqa: ANN401
    if isinstance(value, str) and value == _WORDS.get(kind.element):
        stamps.append((*path, *_STAMP[kind.element]))
        return {}
    return _without_words(_class_of(kind), value, path, stamps)


def _class_of(kind: FieldType) -> type[Any]:
    found: type[Any] = load_message(kind.message_type)
    return found
