"""What is asked of a spawn server that takes nothing more, and then ends."""

from __future__ import annotations

import asyncio
import contextlib
import os
import socket

import pytest

from launcher.spawn_server import SpawnRequest, spawner
from launcher.spawn_server.start import SpawnServerHandle
from text.sentences import Words


def _none(_run_id: str, *, warm: bool) -> SpawnServerHandle:
    raise FileNotFoundError(2, f"no server (pid 0), warm: {warm}")


async def test_a_server_that_ends_before_it_has_room_is_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(spawner, "start_spawn_server", _none)
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    ours.setblocking(False)
    with contextlib.suppress(BlockingIOError):
        while ours.send(b"."):
            pass
    told: list[Words] = []
    subject = spawner.Spawner("run", SpawnServerHandle(ours, os.getpid(), 0, warm=True), told.append)
    spawning = asyncio.ensure_future(
        subject.spawn(SpawnRequest("exec", "node", "deck: node", ("true",), "/", {}), ())
    )
    await asyncio.sleep(0)
    theirs.close()
    with pytest.raises(spawner.SpawnError, match="there is no spawn server"):
        await spawning
    assert [str(words).partition(" (pid")[0] for words in told[:2]] == [
        "the spawn server",
        "no spawn server can be started: no server",
    ]
