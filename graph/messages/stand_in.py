"""A class for a type that is not installed: enough to receive its messages, not to decode them.

A subscription needs the name of a type and functions to read and write it. Messages are taken raw,
so the functions are never called: those of `std_msgs/String` take their place.
"""

from __future__ import annotations

import ctypes
from ctypes import CFUNCTYPE, POINTER, Structure, c_char_p, c_uint8, c_void_p, cast, pointer
from functools import lru_cache
from typing import Any

MIDDLEWARE = "rmw_fastrtps_cpp"
IDENTIFIER = b"rosidl_typesupport_fastrtps_c"
INTROSPECTION = b"rosidl_typesupport_introspection_c"
MODEL = {b"std_msgs::msg", b"std_msgs__msg"}, b"String"
NAME_PARTS = 3
SPARE = 10
"""Zero words after a structure, in case a later release looks for more."""

Find = CFUNCTYPE(c_void_p, c_void_p, c_char_p)
HashOf = CFUNCTYPE(c_void_p, c_void_p)


class _TypeHash(Structure):
    """`rosidl_type_hash_t`; version 0 means unknown."""

    _fields_ = (("version", c_uint8), ("value", c_uint8 * 32))


class _TypeSupport(Structure):
    """`rosidl_message_type_support_t` of Jazzy."""

    _fields_ = (
        ("identifier", c_char_p),
        ("data", c_void_p),
        ("find", c_void_p),
        ("hash_of", c_void_p),
        ("description", c_void_p),
        ("sources", c_void_p),
        ("spare", c_void_p * SPARE),
    )


class _Callbacks(Structure):
    """`message_type_support_callbacks_t` of Jazzy's `rosidl_typesupport_fastrtps_cpp`."""

    _fields_ = (("namespace", c_char_p), ("name", c_char_p), ("functions", c_void_p * 5), ("spare", c_void_p * SPARE))


@lru_cache(maxsize=256)
def stand_in(type_name: str) -> type[Any] | None:
    """Return a class to subscribe to `foo_msgs/msg/Bar` with, and to take its messages raw.

    None if the middleware is not Fast DDS, or not the version that this was written for. The class
    lives as long as the process does: the middleware keeps references to it.
    """
    parts = type_name.split("/")
    if len(parts) != NAME_PARTS or not all(part.isidentifier() for part in parts):
        return None
    model = _model()
    if model is None:
        return None
    capsule, kept = _support(*model, "::".join(parts[:-1]), parts[-1])
    # rclpy looks these four up, but calls none of them for raw messages.
    words = ("_CREATE_ROS_MESSAGE", "_CONVERT_FROM_PY", "_CONVERT_TO_PY", "_DESTROY_ROS_MESSAGE")
    meta = type("StandInType", (type,), {"_TYPE_SUPPORT": capsule, **dict.fromkeys(words, capsule)})
    made: type[Any] = meta(parts[-1], (), {"kept": kept})
    return made


def _model() -> tuple[int, _TypeSupport, _Callbacks] | None:
    """Return the address of the model's type support, and copies of its two parts."""
    from rclpy.impl.implementation_singleton import rclpy_implementation as rclpy_c
    from std_msgs.msg import String

    if rclpy_c.rclpy_get_rmw_implementation_identifier() != MIDDLEWARE:
        return None
    meta: Any = type(String)
    if meta._TYPE_SUPPORT is None:  # noqa: SLF001 - rclpy finds it this way
        meta.__import_type_support__()
    address = _address(meta._TYPE_SUPPORT)  # noqa: SLF001
    finder = _TypeSupport.from_address(address).find
    found = Find(finder)(address, IDENTIFIER)
    if not found:
        return None
    support, callbacks = _TypeSupport(), _Callbacks()
    ctypes.memmove(pointer(support), found, _TypeSupport.spare.offset)
    ctypes.memmove(pointer(callbacks), support.data, _Callbacks.spare.offset)
    namespaces, name = MODEL
    if support.identifier != IDENTIFIER or callbacks.name != name:
        return None
    return (address, support, callbacks) if callbacks.namespace in namespaces else None


def _support(
    model: int, support: _TypeSupport, callbacks: _Callbacks, namespace: str, name: str
) -> tuple[object, tuple[object, ...]]:
    """Return a type support of that name as rclpy expects it, and what must outlive it."""
    callbacks.namespace, callbacks.name = namespace.encode(), name.encode()
    type_hash = _TypeHash()
    find_in_model = Find(_TypeSupport.from_address(model).find)

    def find(_: int, identifier: bytes) -> int | None:
        if identifier == IDENTIFIER:
            return ctypes.addressof(support)
        # It asks for the fields: those of the model will do, nobody compares them.
        return find_in_model(model, identifier) if identifier == INTROSPECTION else None

    finder, hasher = Find(find), HashOf(lambda _: ctypes.addressof(type_hash))
    support.data = cast(pointer(callbacks), c_void_p)
    support.find = cast(finder, c_void_p)
    support.hash_of = cast(hasher, c_void_p)
    return _capsule(support), (support, callbacks, type_hash, finder, hasher)


def _address(capsule: object) -> int:
    get = ctypes.pythonapi.PyCapsule_GetPointer
    get.restype, get.argtypes = c_void_p, [ctypes.py_object, c_char_p]
    return int(get(capsule, _capsule_name(capsule)))


def _capsule_name(capsule: object) -> bytes | None:
    get = ctypes.pythonapi.PyCapsule_GetName
    get.restype, get.argtypes = c_char_p, [ctypes.py_object]
    name: bytes | None = get(capsule)
    return name


def _capsule(support: _TypeSupport) -> object:
    make = ctypes.pythonapi.PyCapsule_New
    make.restype, make.argtypes = ctypes.py_object, [POINTER(_TypeSupport), c_char_p, c_void_p]
    made: object = make(pointer(support), None, None)
    return made
