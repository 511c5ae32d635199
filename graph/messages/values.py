"""Messages as trees of plain values, for every installed type."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

from graph.messages.fields import BYTES, FieldType, parse

if TYPE_CHECKING:
    from collections.abc import Callable

    from graph.data import Value

DUMMY = "structure_needs_at_least_one_member"
"""Dummy field that the generator puts into a message without fields."""


def to_tree(message: Any) -> dict[str, Value]:  # noqa: ANN401 - generated, without a base class
    """Return the message's fields in order, by the rules of `graph.data.Value`.

    Arrays of numbers that the message owns are not copied: do not change the message afterwards.
    """
    return {name: read(getattr(message, name)) for name, read in _readers(type(message))}  # type: ignore[arg-type]


def fields_of(cls: type[Any]) -> tuple[tuple[str, str], ...]:
    """Return names and types of a message's fields as the class has them, in order."""
    fields: dict[str, str] = cls.get_fields_and_field_types()
    return tuple((name, kind) for name, kind in fields.items() if name != DUMMY)


@lru_cache(maxsize=512)
def _readers(cls: type[Any]) -> tuple[tuple[str, Callable[[Any], Value]], ...]:
    return tuple((name, _reader(parse(kind))) for name, kind in fields_of(cls))


def _reader(kind: FieldType) -> Callable[[Any], Value]:
    if kind.is_message:
        return _read_messages if kind.is_many else to_tree
    if not kind.is_many:
        return _read_octet if kind.element == "octet" else _read_plain
    if kind.element == "octet":
        return b"".join
    if kind.element in BYTES:
        return bytes
    return _read_numbers if kind.is_number else list


def _read_plain(value: Value) -> Value:
    return value


def _read_octet(value: bytes) -> Value:
    return value[0]


def _read_messages(values: list[Any]) -> Value:
    return [to_tree(value) for value in values]


def _read_numbers(values: Any) -> Value:  # noqa: ANN401 - array.array or numpy.ndarray
    import numpy as np

    array: Value = np.asarray(values)
    return array
