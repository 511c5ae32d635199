"""Decodes the raw bytes of a bag into trees, using the definitions stored in the bag itself.

No ROS is needed, and a type may belong to a package that is not installed, or to another
distribution. The trees are those of `graph.data.Value`.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from graph.bag.errors import BagError
from graph.messages.fields import BYTES
from graph.messages.values import DUMMY
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

    Raises BagError for a type that is neither defined nor known. The returned function may raise
    any exception for bytes that are not such a message.
    """
    store = _store(kind)
    if kind.name not in store.fielddefs:
        raise BagError(
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
    except (BagError, KeyError):
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
        raise BagError(words) from error
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
