"""The supervisor's connection to one spawn server: sends messages in order, without blocking."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import json
import os
import signal
import socket
from collections import deque
from typing import TYPE_CHECKING, Any

from launcher.processes.signal import send
from text.nested import read_json

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from launcher.spawn_server.start import SpawnServerHandle

_FULL_S = 0.01
_FULL = (errno.EAGAIN, errno.ETOOMANYREFS)
MAX_ANSWER = 65536


class SpawnServerLink:
    """The connection to one spawn server, for as long as its socket is open."""

    def __init__(
        self,
        handle: SpawnServerHandle,
        on_answer: Callable[[dict[str, Any]], None],
        on_end: Callable[[SpawnServerLink], None],
    ) -> None:
        """`on_end` is called once, after its last answer, when the server has died."""
        self.handle = handle
        self.answered = False
        """Whether it has ever answered."""
        self.hung = False
        """Whether it was killed because it did not answer in time."""
        self._on_answer = on_answer
        self._on_end = on_end
        self._socket = handle.link
        self._outbox: deque[list[int]] = deque()
        self._again: asyncio.TimerHandle | None = None
        self._loop = asyncio.get_running_loop()
        self._loop.add_reader(self._socket, self._read)

    def tell(self, message: Mapping[str, object], fds: Sequence[int] = ()) -> None:
        """Send a message, with copies of descriptors, as soon as there is room.

        Raises:
            OSError: if memory or descriptors have run out.
        """
        self._outbox.append(_packed(message, fds))
        if self._again is None:
            self._write()

    def kill(self, *, hung: bool = False) -> None:
        """Kill the server; answers that it has already sent are still read."""
        self.hung = self.hung or hung
        send(self.handle, signal.SIGKILL)

    def drop(self) -> None:
        if self._again is not None:
            self._again.cancel()
        self._forget_outbox()
        self._loop.remove_reader(self._socket)
        self._socket.close()

    def _write(self) -> None:
        self._again = None
        while self._outbox:
            try:
                socket.send_fds(self._socket, [b"."], self._outbox[0])
            except OSError as problem:
                if problem.errno in _FULL:
                    # It is busy importing, which usually takes a second.
                    self._again = self._loop.call_later(_FULL_S, self._write)
                else:
                    # It is dead; the reading side will notice after its last answers.
                    self._forget_outbox()
                return
            _close(self._outbox.popleft())

    def _read(self) -> None:
        try:
            packet = self._socket.recv(MAX_ANSWER)
        except BlockingIOError:
            return
        except OSError:
            packet = b""
        if packet:
            self.answered = True
            self._on_answer(read_json(packet))
        else:
            self.drop()
            self._on_end(self)

    def _forget_outbox(self) -> None:
        while self._outbox:
            _close(self._outbox.popleft())


def _packed(message: Mapping[str, object], fds: Sequence[int]) -> list[int]:
    """Return a descriptor of a memory file with the message, then the copies.

    A socket packet is limited to some 200 kB, less than a command line may need.
    """
    packed = [os.memfd_create("deck message")]
    try:
        data = json.dumps(message).encode()
        while data:
            data = data[os.write(packed[0], data) :]
        packed.extend(map(os.dup, fds))
    except OSError:
        _close(packed)
        raise
    return packed


def _close(fds: Sequence[int]) -> None:
    for fd in fds:
        with contextlib.suppress(OSError):
            os.close(fd)
