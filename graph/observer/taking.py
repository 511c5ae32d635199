"""Takes messages together with the identifier of the publisher that sent them.

The middleware tells it with every message, in `rmw_message_info_t.publisher_gid`, but the rclpy of
Jazzy leaves it out of what `take_message` returns (later ones have it: ros2/rclpy, pull request
1466). So this calls the function of rcl that rclpy calls itself, by ctypes, in the library that
rclpy has loaded, with the subscription that rclpy has made.

Sources: rcl/subscription.h (`rcl_take_serialized_message`), rmw/types.h (`rmw_message_info_t`),
rcutils/types/uint8_array.h and rcutils/allocator.h, as Jazzy has them.

Nothing of that is trusted blindly. Whoever finds another library gets no `SenderReader`, and all
that C writes goes to buffers with room to spare. Each gid has a pointer to the name of the
middleware before it: where that is not the very pointer that the middleware itself gives for its
name, the layout is another one, and no sender is known.
"""

from __future__ import annotations

import ctypes
import struct
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.subscription import Subscription
    from typing_extensions import Self

TAKE_FAILED = 401
"""No message is waiting. Source: rcl/types.h, `RCL_RET_SUBSCRIPTION_TAKE_FAILED`."""
INFO = struct.Struct("@qqQQP16s")
"""Sent and received, ns, unix time; numbers at the publisher and here; middleware; its gid."""
UNNUMBERED = 2**64 - 1
"""Source: rmw/types.h, `RMW_MESSAGE_INFO_SEQUENCE_NUMBER_UNSUPPORTED`."""
ROOM = 256
"""Bytes for what a library of another version may fill in: three times as much as this one does."""
FIRST_BYTES = 4096
"""Of the buffer, which grows with the messages."""
SENDER = "sender"
"""What is known of a message besides what rclpy says: the gid of its publisher; None if it is not
known."""


class TakeError(Exception):
    """rcl has refused to take a message; rclpy says why."""


class _Allocator(ctypes.Structure):
    _fields_ = (("functions", ctypes.c_void_p * 4), ("state", ctypes.c_void_p))


class _ReturnedAllocator(ctypes.Structure):
    _fields_ = (("allocator", _Allocator), ("room", ctypes.c_ubyte * ROOM))


class _Bytes(ctypes.Structure):
    _fields_ = (
        ("buffer", ctypes.c_void_p),
        ("length", ctypes.c_size_t),
        ("capacity", ctypes.c_size_t),
        ("allocator", _Allocator),
        ("room", ctypes.c_ubyte * ROOM),
    )


class SenderReader:
    """Takes the messages of subscriptions; create it by `load`, close it."""

    def __init__(self, library: ctypes.CDLL) -> None:
        """Prepare; raises AttributeError and ValueError for a library that is not Jazzy's."""
        self._take: Callable[..., int] = library.rcl_take_serialized_message
        self._forget_error = library.rcutils_reset_error
        self._end = library.rcutils_uint8_array_fini
        begin = library.rcutils_uint8_array_init
        name = library.rmw_get_implementation_identifier
        name.restype = ctypes.c_void_p
        usual = library.rcutils_get_default_allocator
        usual.restype = _ReturnedAllocator
        self._middleware: int | None = name()
        self._info = ctypes.create_string_buffer(ROOM)
        self._bytes = _Bytes()
        self._place = ctypes.byref(self._bytes)
        allocator = usual().allocator
        failed = begin(self._place, ctypes.c_size_t(FIRST_BYTES), ctypes.byref(allocator))
        if failed or not self._middleware or not self._is_as_expected(allocator):
            # Not given back: who knows where it is.
            raise ValueError("rcl has another layout")

    @classmethod
    def load(cls) -> Self | None:
        """Return one for the library that rclpy uses; None if there is no such thing in it."""
        from rclpy.impl.implementation_singleton import rclpy_implementation as rclpy_c

        try:
            # Found in it are the functions of all that it is linked with. A PyDLL keeps the
            # interpreter's lock, as rclpy does: after each message, another thread would have it.
            return cls(ctypes.PyDLL(rclpy_c.__file__))
        except (AttributeError, OSError, ValueError):
            return None

    def take(self, subscription: Subscription) -> tuple[bytes, dict[str, Any]] | None:
        """Take the next message as rclpy's `take_message` does, and add its `SENDER`.

        None if there is none. The subscription's handle must be entered. Raises TakeError.
        """
        pointer = ctypes.c_void_p(subscription.handle.pointer)
        failed = self._take(pointer, self._place, self._info, None)
        if failed:
            if failed == TAKE_FAILED:
                return None
            self._forget_error()
            raise TakeError(failed)
        sent_ns, received_ns, number, _, middleware, gid = INFO.unpack_from(self._info)
        return ctypes.string_at(self._bytes.buffer or 0, self._bytes.length), {
            "source_timestamp": sent_ns,
            "received_timestamp": received_ns,
            "publication_sequence_number": None if number == UNNUMBERED else number,
            SENDER: gid if middleware == self._middleware else None,
        }

    def close(self) -> None:
        """Give the buffer back; it cannot take any more."""
        self._end(self._place)

    def _is_as_expected(self, allocator: _Allocator) -> bool:
        made = self._bytes
        return (
            all(allocator.functions)
            and bool(made.buffer)
            and (made.length, made.capacity) == (0, FIRST_BYTES)
            and bytes(made.allocator) == bytes(allocator)
            and not any(made.room)
        )
