"""The protocol of the control socket: one JSON object per line, both ways, versioned.

The supervisor speaks first, with a `launcher.events.Hello`: `{"deck": VERSION, "session": ...}`.
A client answers `{"deck": VERSION}`, then sends requests such as `{"id": 1, "op": "start", "nodes":
["sonar"]}`. It receives `{"reply": 1, "result": ...}` or `{"reply": 1, "error": {...}}`, and in
between events (`launcher.events`): `{"event": "status", "nodes": [...]}`.

`{"id": 1, "op": "emergency_stop", "said_ns": ...}` gives the robot an emergency stop, and
`emergency_release` releases those from before it, by the file that the nodes watch: no middleware
is needed. `said_ns` is when it was said, unix time; without it, that is when the request arrives.

Plain dataclasses go through it as pydantic has them; pydantic itself is loaded when the first one does.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, TypeVar

from text.packing import pack_text, unpack_text

T = TypeVar("T")

VERSION = 4
MAX_REQUEST_BYTES = 1 << 20
"""Longest line from a client; a longer one is an error."""
MAX_MESSAGE_BYTES = 64 << 20
"""Longest line that the supervisor can send."""


@dataclass(frozen=True)
class Sent:
    """Has pydantic send a value in a form of its own."""

    pack: Callable[[Any], Any]
    unpack: Callable[[Any], Any]

    def __get_pydantic_core_schema__(self, *_: object) -> Any:  # noqa: ANN401 - pydantic's own
        """Return how pydantic reads and writes it."""
        from pydantic_core import core_schema

        written = core_schema.plain_serializer_function_ser_schema(self.pack)
        return core_schema.no_info_plain_validator_function(self._read, serialization=written)

    def _read(self, packed: object) -> object:
        try:
            return self.unpack(packed)
        except (TypeError, AttributeError, KeyError, IndexError) as error:
            raise ValueError(f"cannot be read: {error}") from error


Sentence = Annotated[str, Sent(pack_text, unpack_text)]
"""A text that can still be translated at the other end."""


def encode(message: Mapping[str, Any]) -> bytes:
    """Return a message as one line; file names in it may contain lone surrogates."""
    text = json.dumps(message, ensure_ascii=False, separators=(",", ":"))
    return text.encode("utf-8", "surrogatepass") + b"\n"


_ADAPTERS: dict[type, Any] = {}
"""What pydantic knows of each type that was sent."""


def _adapter(kind: type) -> Any:  # noqa: ANN401 - a TypeAdapter of that type
    from pydantic import TypeAdapter

    if kind not in _ADAPTERS:
        _ADAPTERS[kind] = TypeAdapter(kind)
    return _ADAPTERS[kind]


def pack(value: object) -> Any:  # noqa: ANN401 - JSON
    """Return a dataclass as JSON."""
    return _adapter(type(value)).dump_python(value, mode="json")


def unpack(kind: type[T], fields: object) -> T:
    """Return the dataclass that `pack` was given; raises ValueError if it is anything else."""
    found: T = _adapter(kind).validate_python(fields)
    return found
