"""The Unix socket of a session, in a folder whose path may have any length.

The path of a socket is limited to 107 bytes, so it is addressed through an open descriptor of its
folder, which gives a short path.
"""

from __future__ import annotations

import contextlib
import os
import socket
import stat
import struct
from collections.abc import Iterator
from pathlib import Path

SOCKET_NAME = "control.sock"
TAKEN_WITHIN_S = 10


def listen(folder: Path) -> socket.socket:
    """Return a socket of mode 0600 in `folder` that clients can connect to."""
    server = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    with _short_path(folder) as path:
        with contextlib.suppress(FileNotFoundError):
            if stat.S_ISSOCK((folder / SOCKET_NAME).lstat().st_mode):
                (folder / SOCKET_NAME).unlink()
        before = os.umask(0o177)
        try:
            server.bind(path)
        finally:
            os.umask(before)
    server.listen(16)
    server.setblocking(False)
    return server


def connect(folder: Path, within_s: float = TAKEN_WITHIN_S) -> socket.socket:
    """Return a connection to the session in `folder`; raises OSError if nobody accepts it."""
    client = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        # If the server is suspended and its queue is full, connecting would block for ever.
        client.setsockopt(
            socket.SOL_SOCKET, socket.SO_SNDTIMEO, struct.pack("ll", int(within_s), int(within_s % 1 * 1e6))
        )
        with _short_path(folder) as path:
            client.connect(path)
    except OSError:
        client.close()
        raise
    client.setblocking(False)
    return client


@contextlib.contextmanager
def _short_path(folder: Path) -> Iterator[str]:
    descriptor = os.open(folder, os.O_PATH | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        yield f"/proc/self/fd/{descriptor}/{SOCKET_NAME}"
    finally:
        os.close(descriptor)
