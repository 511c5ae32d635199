"""The hash of an interface, made from nothing but its fields.

Source: REP 2016, ROS 2 Interface Type Descriptions; how it is put down is in rosidl's
`rosidl_generator_type_description`: SHA-256 of the description as JSON, without defaults.
"""

from __future__ import annotations

import hashlib
import json
import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

Fields = tuple[tuple[str, str], ...]
"""Name and type of each, the type as in a .msg file: `uint8[16] client_gid`."""
NESTED, ARRAY, BOUNDED, UNBOUNDED = 1, 48, 96, 144
IDS = {
    "int8": 2,
    "uint8": 3,
    "char": 3,
    "int16": 4,
    "uint16": 5,
    "int32": 6,
    "uint32": 7,
    "int64": 8,
    "uint64": 9,
    "float32": 10,
    "float64": 11,
    "bool": 15,
    "byte": 16,
    "string": 17,
    "wstring": 18,
}
TIME, EVENT_INFO = "builtin_interfaces/msg/Time", "service_msgs/msg/ServiceEventInfo"
NOTHING: Fields = (("structure_needs_at_least_one_member", "uint8"),)
OF_SERVICES: dict[str, Fields] = {
    TIME: (("sec", "int32"), ("nanosec", "uint32")),
    EVENT_INFO: (
        ("event_type", "uint8"),
        ("stamp", TIME),
        ("client_gid", "uint8[16]"),
        ("sequence_number", "int64"),
    ),
}


def with_service(name: str, request: Fields, response: Fields) -> dict[str, Fields]:
    """Return the types that a service consists of."""
    parts = {"request": f"{name}_Request", "response": f"{name}_Response", "event": f"{name}_Event"}
    return {
        **OF_SERVICES,
        parts["request"]: request or NOTHING,
        parts["response"]: response or NOTHING,
        parts["event"]: (
            ("info", EVENT_INFO),
            ("request", f"{parts['request']}[<=1]"),
            ("response", f"{parts['response']}[<=1]"),
        ),
        name: tuple((f"{part}_message", of) for part, of in parts.items()),
    }


def type_hash(name: str, types: Mapping[str, Fields]) -> str:
    """Return the hash of a type; `types` has it, and all that are nested in it."""
    others = sorted(_nested(name, types) - {name})
    described = {
        "type_description": _described(name, types[name]),
        "referenced_type_descriptions": [_described(other, types[other]) for other in others],
    }
    return f"RIHS01_{hashlib.sha256(json.dumps(described).encode()).hexdigest()}"


def _nested(name: str, types: Mapping[str, Fields]) -> set[str]:
    inner = {_parts(of)[0] for _field, of in types[name]} & types.keys()
    return inner.union(*(_nested(one, types) for one in inner))


def _described(name: str, fields: Fields) -> dict[str, Any]:
    return {
        "type_name": name,
        "fields": [{"name": field, "type": _type_of(of)} for field, of in fields],
    }


def _type_of(written: str) -> dict[str, Any]:
    base, kind, capacity = _parts(written)
    return {
        "type_id": IDS.get(base, NESTED) + kind,
        "capacity": capacity,
        "string_capacity": 0,
        "nested_type_name": "" if base in IDS else base,
    }


def _parts(written: str) -> tuple[str, int, int]:
    """Return the type without brackets, what they add to its number, and how many fit in."""
    base, brackets, most, count = re.fullmatch(r"([^[]+)(\[(<=)?(\d*)\])?", written).groups()  # type: ignore[union-attr]
    kind = 0 if not brackets else BOUNDED if most else ARRAY if count else UNBOUNDED
    return base, kind, int(count or 0)
