"""Packets over a stream socket, in order: the length in eight bytes, then that many bytes.

Nothing here waits. What the other end does not take at once stays here, until `flush` is called
when the socket has room.
"""

from __future__ import annotations

import socket
import struct
from collections import deque
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

LENGTH = struct.Struct("!Q")
LONGEST_BYTES = 1 << 31
"""Nothing that is sent is longer: whoever says so has lost the thread."""
ROOM_BYTES = 1 << 20
"""Asked for on both sides, so that a picture goes over in few pieces; the kernel may give less."""
SMALL_BYTES = 1 << 16
MOST_AT_ONCE = 64
"""Pieces in one call."""


class Wire:
    """One end; whoever has it owns the socket, and may use it from one thread at a time."""

    def __init__(self, end: socket.socket) -> None:
        self._socket = end
        end.setblocking(False)
        for option in (socket.SO_SNDBUF, socket.SO_RCVBUF):
            end.setsockopt(socket.SOL_SOCKET, option, ROOM_BYTES)
        self._out: deque[memoryview] = deque()
        self._begun = bytearray()
        """What has come of packets that are not complete, unless one is being filled."""
        self._filling: bytearray | None = None
        self._filled = 0

    def fileno(self) -> int:
        """Return the descriptor, for a poll."""
        return self._socket.fileno()

    @property
    def is_behind(self) -> bool:
        """Whether something still waits to be taken."""
        return bool(self._out)

    def send(self, pieces: Iterable[bytes]) -> None:
        """Send one packet, in pieces that need not be joined; raises OSError if nobody is there."""
        parts = [piece for piece in pieces if piece]
        self._out.append(memoryview(LENGTH.pack(sum(map(len, parts)))))
        self._out.extend(map(memoryview, parts))
        self.flush()

    def flush(self) -> None:
        """Send what there is room for; raises OSError if nobody is there."""
        while self._out:
            pieces = [self._out[at] for at in range(min(MOST_AT_ONCE, len(self._out)))]
            try:
                sent = self._socket.sendmsg(pieces)
            except BlockingIOError:
                return
            while sent:
                first = self._out[0]
                if sent < len(first):
                    self._out[0] = first[sent:]
                    break
                sent -= len(first)
                self._out.popleft()

    def receive(self) -> list[bytearray]:
        """Return the packets that have come; raises EOFError, or OSError, if nobody is there."""
        packets: list[bytearray] = []
        try:
            while self._take(packets):
                pass
        except BlockingIOError:
            pass
        except EOFError:
            if not packets:
                raise
        return packets

    def close(self) -> None:
        """Close it; the other end hears of that."""
        self._socket.close()

    def _take(self, packets: list[bytearray]) -> bool:
        """Take once; return whether there may be more."""
        if self._filling is not None:
            room = memoryview(self._filling)[self._filled :]
            count = self._socket.recv_into(room)
            if not count:
                raise EOFError
            self._filled += count
            if self._filled == len(self._filling):
                packets.append(self._filling)
                self._filling = None
            return True
        came = self._socket.recv(SMALL_BYTES)
        if not came:
            raise EOFError
        self._begun += came
        self._split(packets)
        return len(came) == SMALL_BYTES or self._filling is not None

    def _split(self, packets: list[bytearray]) -> None:
        at = 0
        while len(self._begun) - at >= LENGTH.size:
            (length,) = LENGTH.unpack_from(self._begun, at)
            if length > LONGEST_BYTES:
                raise ConnectionError(f"a packet of {length} bytes")
            begins, ends = at + LENGTH.size, at + LENGTH.size + length
            if ends > len(self._begun):
                if length > SMALL_BYTES:
                    # The rest comes straight to where it belongs.
                    self._filled = len(self._begun) - begins
                    self._filling = bytearray(length)
                    self._filling[: self._filled] = self._begun[begins:]
                    at = len(self._begun)
                break
            packets.append(self._begun[begins:ends])
            at = ends
        del self._begun[:at]
