"""The protocol of the control socket: one JSON object per line, both ways, versioned.

The supervisor speaks first, with a `launcher.events.Hello`: `{"deck": VERSION, "session": ...}`.
A client answers `{"deck": VERSION}`, then sends requests such as `{"id": 1, "op": "start", "nodes":
["sonar"]}`. It receives `{"reply": 1, "result": ...}` or `{"reply": 1, "error": {...}}`, and in
between events (`launcher.events`): `{"event": "status", "nodes": [...]}`.

`{"id": 1, "op": "emergency_stop", "said_ns": ...}` gives the robot an emergency stop, and
`emergency_release` releases those from before it, by the file that the nodes watch: no middleware
is needed. `said_ns` is when it was said, unix time; without it, that is when the request arrives.

What goes through it are plain dataclasses, read by the types of their fields: pydantic would be a third of a
supervisor's memory.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from text.packing import pack_text, unpack_text
from text.sentences import InLanguages, Words

VERSION = 4
MAX_REQUEST_BYTES = 1 << 20
"""Longest line from a client; a longer one is an error."""
MAX_MESSAGE_BYTES = 64 << 20
"""Longest line that the supervisor can send."""

Sentence = Annotated[str, unpack_text]
"""A text that can still be translated at the other end."""


def encode(message: Mapping[str, Any]) -> bytes:
    """Return a message as one line; file names in it may contain lone surrogates."""
    text = json.dumps(message, ensure_ascii=False, separators=(",", ":"))
    return text.encode("utf-8", "surrogatepass") + b"\n"


def pack(value: Any) -> Any:  # noqa: ANN401 - JSON
    """Return a dataclass, and whatever may be in one, as JSON."""
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, (Words, InLanguages)):
        return pack_text(value)
    if hasattr(value, "packed"):
        return value.packed()
    if is_dataclass(value):
        return {field.name: pack(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {key: pack(inner) for key, inner in value.items()}
    return [pack(inner) for inner in value] if isinstance(value, (tuple, list)) else value


def unpack(kind: Any, packed: Any) -> Any:  # noqa: ANN401 - JSON, and of which type is for the caller to say
    """Return what `pack` was given; raises ValueError if that cannot be of this type.

    A function in `Annotated` is given what was sent, and returns what is to be read in its place.
    """
    origin, inner = get_origin(kind), get_args(kind)
    if origin is Annotated:
        for read in filter(callable, kind.__metadata__):
            packed = _read(read, packed)
        return unpack(inner[0], packed)
    if origin in (Union, UnionType):
        return _one_of(inner, packed)
    if origin is None:
        return _single(kind, packed)
    if origin is Literal and packed in inner:
        return packed
    if origin is tuple and isinstance(packed, (list, tuple)):
        kinds = inner[:1] * len(packed) if inner[-1] is ... else inner
        if len(kinds) == len(packed):
            return tuple(_part(place, each, packed[place]) for place, each in enumerate(kinds))
    if origin in (dict, Mapping) and isinstance(packed, dict):
        return {unpack(inner[0], key): _part(key, inner[1], one) for key, one in packed.items()}
    raise _other(kind, packed)


def _single(kind: Any, packed: Any) -> Any:  # noqa: ANN401 - of that type
    if kind is Any or (kind is float and type(packed) is int):
        return packed
    if hasattr(kind, "unpacked"):
        return _read(kind.unpacked, packed)
    if is_dataclass(kind) and isinstance(packed, dict):
        return _dataclass(kind, packed)
    if issubclass(kind, Enum):
        return kind(packed)
    if isinstance(packed, kind) and (type(packed) is not bool or kind is bool):
        return packed
    raise _other(kind, packed)


def _one_of(kinds: tuple[Any, ...], packed: object) -> Any:  # noqa: ANN401 - of one of these types
    """Return it as the first of these types that it can be; only None is null."""
    if packed is None and type(None) in kinds:
        return None
    first, *others = [kind for kind in kinds if kind is not type(None)]
    if not others:
        return unpack(first, packed)
    with suppress(ValueError):
        return unpack(first, packed)
    return _one_of(tuple(others), packed)


def _dataclass(kind: Any, packed: Mapping[str, Any]) -> Any:  # noqa: ANN401 - of that type
    kinds = _kinds(kind)
    given = {name: _part(name, kinds[name], packed[name]) for name in kinds if name in packed}
    return _read(lambda parts: kind(**parts), given)


@cache
def _kinds(kind: Any) -> dict[str, Any]:  # noqa: ANN401 - a dataclass
    hints = get_type_hints(kind, include_extras=True)
    return {field.name: hints[field.name] for field in fields(kind)}


def _part(place: object, kind: Any, packed: object) -> Any:  # noqa: ANN401 - of that type
    try:
        return unpack(kind, packed)
    except ValueError as error:
        raise ValueError(f"{place}: {error}") from error


def _read(read: Any, packed: object) -> Any:  # noqa: ANN401 - a function, and what it returns
    try:
        return read(packed)
    except (TypeError, AttributeError, KeyError, IndexError) as error:
        raise ValueError(f"cannot be read: {error}") from error


def _other(kind: object, packed: object) -> ValueError:
    return ValueError(f"expected {getattr(kind, '__name__', kind)}, found {packed!r:.80}")
