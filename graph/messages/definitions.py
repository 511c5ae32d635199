"""The definitions of message types as text, as a bag stores them, and messages decoded by such a text.

Where a type is installed, its text comes from the library's own store of this ROS 2, else from the `.msg` files of
its package, or, where that has none, is made from the fields of its class. Decoding needs no ROS: a type in a bag may
belong to a package that is not installed, or to another distribution. The trees are those of `graph.data.Value`.
"""

from __future__ import annotations

import os
import re
import sys
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from graph.distro import distro
from graph.heavy_types import IMAGE, POINT_CLOUD
from graph.messages.fields import BYTES, DUMMY, parse, ros_name, to_tree
from graph.messages.types import UnknownTypeError, load_action, load_message, load_service
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable

    from rosbags.typesys.store import Typestore

    from graph.data import Value

AS_BYTES = BYTES | {"byte"}
CDR = frozenset({b"\x00\x00", b"\x00\x01"})
"""The first bytes of big-endian and little-endian plain CDR (OMG DDS-XTypes 1.3, 7.6.3.1.2)."""
HEADER = "std_msgs/msg/Header"
LISTED = frozenset({"bool", "string"})
WIDE = "deck/msg/Wide"
"""Stands for `wstring`, which the library cannot decode: the middleware writes its UTF-16 as
integers of 32 bits."""
_WIDE_FIELD = re.compile(r"(?m)^[^\S\n]*wstring(?:<=\d+)?(?P<many>\[[^\]\n]*\])?(?P<name>\s+\w+\b)(?!\s*=)[^#\n]*")
"""One in a `.msg`, with what it is when nobody has set it."""
_WIDE_CONSTANT = re.compile(r"(?m)^[^\S\n]*wstring(?=\s+\w+\s*=)")
_WIDE_IN_IDL = re.compile(r"\bwstring\b(?:\s*<\s*\d+\s*>)?(?=\s*[\w,>])(?!\s+\w+\s*=)")
_WIDE_LITERAL = re.compile(r'(?<==)\s*L(?=")')
LARGE = frozenset({IMAGE, POINT_CLOUD})
"""Types whose bytes rclpy copies three times, and the library once: a cloud of 300 000 points has 5 MB."""
SEPARATOR = "=" * 80
PLAIN = frozenset(
    {
        *("bool", "byte", "char", "float32", "float64", "string", "wstring"),
        *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)),
    }
)
PARTS = {"Feedback": "action", "Request": "srv", "Response": "srv"}
"""The kind of interface that a generated message belongs to, by the suffix of its name."""
_TYPE = re.compile(r"^\s*(?P<name>[A-Za-z][\w/]*)")
_CONSTANT = re.compile(r"^\s*\S+\s+\w+\s*=")


def decoder(type_name: str) -> Callable[[bytes], dict[str, Value]]:
    """Return a function that decodes a serialized message of an installed type into a tree.

    Raises UnknownTypeError; the returned function raises what rclpy raises for bytes that are not such a message.
    """
    from rclpy.serialization import deserialize_message

    cls = load_message(type_name)

    def decode(raw: bytes) -> dict[str, Value]:
        return to_tree(deserialize_message(raw, cls))

    if type_name not in LARGE:
        return decode
    quick = bag_decoder(TypeText(type_name))

    def decode_quickly(raw: bytes) -> dict[str, Value]:
        try:
            return quick(raw)
        except Exception:  # noqa: BLE001 - rclpy says what is wrong with it
            return decode(raw)

    return decode_quickly


class TypeText(NamedTuple):
    """The definition of a type in a bag."""

    name: str
    text: str = ""
    """Empty if the bag does not define its types: sqlite3 before ROS 2 Iron."""
    is_idl: bool = False
    distro: str = ""
    """ROS distribution that wrote the bag, if recorded."""


@lru_cache(maxsize=256)
def bag_decoder(kind: TypeText) -> Callable[[bytes], dict[str, Value]]:
    """Return a function that decodes a message of this type into a tree.

    Raises UnknownTypeError for a type that is neither defined nor known. The returned function may raise
    any exception for bytes that are not such a message.
    """
    store = _store(kind)
    if kind.name not in store.fielddefs:
        raise UnknownTypeError(
            say(
                "type {type} is not defined in the bag, and is not one of ROS's own; record "
                "the bag again with its definitions: `deck record`, or `ros2 bag record -s "
                "mcap`",
                type=kind.name,
            )
        )
    read = _reader(store, kind.name)
    plan = store.get_msgdef(kind.name)

    def decode(raw: bytes) -> dict[str, Value]:
        if raw[:2] not in CDR:
            raise ValueError("it is not in plain CDR")
        take = plan.deserialize_cdr_le if raw[1] else plan.deserialize_cdr_be
        # The store's own method refuses messages with trailing bytes, which rmw produces.
        message, _end = take(memoryview(raw)[4:], 0, plan.cls, store)
        return read(message)

    return decode


@lru_cache(maxsize=256)
def begins_with_header(kind: TypeText) -> bool:
    """Return whether messages of this type begin with a `std_msgs/Header`, as far as is known."""
    from rosbags.interfaces import Nodetype

    try:
        fields = _store(kind).fielddefs[kind.name][1]
    except (UnknownTypeError, KeyError):
        return False
    return bool(fields) and fields[0][1] == (Nodetype.NAME, HEADER)


def _store(kind: TypeText) -> Typestore:
    from rosbags.typesys import Stores, TypesysError, get_types_from_idl, get_types_from_msg, get_typestore

    if not kind.text:
        known = {store.name: store for store in Stores}
        return get_typestore(known.get(f"ROS2_{kind.distro.upper()}", Stores.ROS2_JAZZY))
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg("uint32[] units", WIDE))
    try:
        if kind.is_idl:
            text = _WIDE_IN_IDL.sub(WIDE.replace("/", "::"), kind.text)
            store.register(get_types_from_idl(_WIDE_LITERAL.sub("", text)))
        else:
            # Whoever writes definitions on Windows ends their lines so.
            text = kind.text.replace("\r\n", "\n")
            text = _WIDE_FIELD.sub(rf"{WIDE}\g<many>\g<name>", text)
            text = _WIDE_CONSTANT.sub("string", text)
            found = get_types_from_msg(text, kind.name)
            # The library mistakes the name of a service's message for that of a package.
            for name in found.keys() - {kind.name}:
                if name.replace("/srv/msg/", "/srv/") == kind.name:
                    found[kind.name] = found.pop(name)
            store.register(found)
    except (TypesysError, ValueError, KeyError) as error:
        words = say("the definition of type {type} in the bag cannot be read: {reason}", type=kind.name, reason=error)
        raise UnknownTypeError(words) from error
    return store


def _reader(store: Typestore, type_name: str) -> Callable[[Any], dict[str, Value]]:
    """Return a function that reads all fields of a message whose type is in the store."""
    from rosbags.typesys.base import normalize_fieldname

    fields = [
        (name, normalize_fieldname(name), _field(store, kind))
        for name, kind in store.fielddefs[type_name][1]
        if name != DUMMY
    ]

    def read(message: Any) -> dict[str, Value]:  # noqa: ANN401 - generated, without a base class
        return {name: field(getattr(message, attribute)) for name, attribute, field in fields}

    return read


def _field(store: Typestore, kind: Any) -> Callable[[Any], Value]:  # noqa: ANN401 - nested tuples
    from rosbags.interfaces import Nodetype

    node, rest = kind
    if node is Nodetype.BASE:
        return _as_it_is
    if node is Nodetype.NAME:
        return _one(store, rest)
    element, name = rest[0]
    if element is Nodetype.NAME:
        read = _one(store, name)
        return lambda values: [read(value) for value in values]
    if name[0] in AS_BYTES:
        return lambda values: bytes(values.tobytes())
    return list if name[0] in LISTED else _as_it_is


def _one(store: Typestore, name: str) -> Callable[[Any], Value]:
    return _wide_text if name == WIDE else _reader(store, name)


def _wide_text(message: Any) -> Value:  # noqa: ANN401 - generated, without a base class
    units = message.units.astype("<u2", casting="unsafe").tobytes()
    return str(units, "utf-16-le", "replace")


def _as_it_is(value: Value) -> Value:
    return value


def definition(type_name: str, digest: str = "") -> str:
    """Return the text of a type, followed by those of the types in it.

    `digest`, `RIHS01_...`, is the publisher's hash of its type: a definition in the store with
    another hash is not used. Raises UnknownTypeError for a type that is not installed.
    """
    store = typestore()
    if type_name in store.fielddefs and digest in {"", store.hash_rihs01(type_name)}:
        return store.generate_msgdef(type_name, ros_version=2)[0]
    return _gathered(type_name)


def hash_of(type_name: str) -> str:
    """Return the hash of a type in the store, empty for any other."""
    store = typestore()
    return store.hash_rihs01(type_name) if type_name in store.fielddefs else ""


@lru_cache(maxsize=1)
def typestore() -> Typestore:
    """Return the library's types of this ROS 2, else of its newest; a tenth of a second the first time."""
    from rosbags.typesys import Stores, get_typestore

    name = f"ros2_{distro()}"
    return get_typestore(Stores(name) if name in {each.value for each in Stores} else Stores.LATEST)


def _gathered(type_name: str) -> str:
    """Return the installed text of a type, followed by every type that it needs."""
    texts: dict[str, str] = {}
    wanted = [type_name]
    while wanted:
        name = wanted.pop(0)
        if name not in texts:
            texts[name] = _installed(name)
            wanted += _needed(name, texts[name])
    first, *others = texts.items()
    below = (f"{SEPARATOR}\nMSG: {name.replace('/msg/', '/')}\n{text}" for name, text in others)
    return "".join((first[1], *below))


def _installed(type_name: str) -> str:
    package, kind, name = type_name.split("/")
    prefixes = [*os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep), sys.prefix]
    for prefix in filter(None, prefixes):
        path = Path(prefix, "share", package, kind, f"{name}.msg")
        if path.is_file():
            return path.read_text(encoding="utf-8", errors="replace").rstrip() + "\n"
    fields: dict[str, str] = _class(type_name).get_fields_and_field_types()
    return "".join(f"{_written(kind)} {name}\n" for name, kind in fields.items())


def _class(type_name: str) -> Any:  # noqa: ANN401 - generated, without a base class
    """Return the class of a message, which may be an inner part of an action or a service."""
    whole, _, part = type_name.rpartition("_")
    if whole and part in PARTS:
        owner = load_action(whole) if PARTS[part] == "action" else load_service(whole)
        return getattr(owner, part)
    return load_message(type_name)


def _written(text: str) -> str:
    """Return how a `.msg` file writes the type of a field."""
    of = PARTS.get(parse(text).element.rpartition("_")[2])
    # In full: readers take a shorter name for a message's, which has another hash.
    return ros_name(text) if of is None else ros_name(text).replace("/", f"/{of}/", 1)


def _needed(type_name: str, text: str) -> list[str]:
    """Return the full names of the messages among the fields of a definition."""
    found = []
    for line in text.splitlines():
        match = _TYPE.match(line.partition("#")[0])
        if match is None or match["name"] in PLAIN or _CONSTANT.match(line):
            continue
        parts = match["name"].split("/")
        if parts == ["Header"]:
            parts = ["std_msgs", "Header"]
        if len(parts) == 1:
            parts = [type_name.split("/", maxsplit=1)[0], *parts]
        found.append("/".join(parts) if len(parts) > 2 else "/msg/".join(parts))
    return found
