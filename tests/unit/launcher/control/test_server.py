"""How much one client can ask at once."""

from __future__ import annotations

import asyncio
import contextlib
import socket

import pytest

from launcher.control.requests import BadRequestError
from launcher.control.server import MAX_REQUESTS, Client


async def test_of_requests_that_take_time_a_client_has_only_so_many() -> None:
    ours, theirs = socket.socketpair()
    _reader, writer = await asyncio.open_connection(sock=ours)
    client, done = Client(writer, {}), asyncio.Event()

    async def serving() -> None:
        await done.wait()

    with contextlib.closing(theirs), contextlib.closing(writer):
        for _request in range(MAX_REQUESTS):
            client.begin(serving())
        with pytest.raises(BadRequestError, match="too many requests at once"):
            client.begin(serving())
        done.set()
