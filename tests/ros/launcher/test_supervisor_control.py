"""The control socket: private, versioned, and unharmed by whatever a client sends."""

from __future__ import annotations

import asyncio
import json
import stat
from typing import TYPE_CHECKING, Any

import pytest

from launcher.client.client import attach, running
from launcher.control.socket import connect
from launcher.errors import AlreadyRunningError, ConnectionLostError
from launcher.events import ClosedEvent, StatusEvent
from launcher.rundir import run_dir
from launcher.status import NodeState
from launcher.wire import VERSION
from tests.ros.supervised import SLEEPER, Launch, running_pid, until_state
from tests.slowness import patient
from tests.waiting import until

if TYPE_CHECKING:
    from launcher.client.client import SupervisorClient

NODE = {"node": {"exec": SLEEPER}}


class RawClient:
    """A client that can say anything."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.reader, self.writer = reader, writer

    def say(self, line: bytes) -> None:
        self.writer.write(line + b"\n")

    async def hear(self) -> dict[str, Any]:
        """Return the next message, {} at the end."""
        try:
            line = await asyncio.wait_for(self.reader.readline(), 20)
        except ConnectionError:
            line = b""
        return json.loads(line) if line else {}

    async def reply(self) -> dict[str, Any]:
        while True:
            message = await self.hear()
            if not message or "reply" in message:
                return message


async def raw(client: SupervisorClient) -> RawClient:
    ends = await asyncio.open_unix_connection(sock=connect(run_dir() / client.session.run_id), limit=1 << 26)
    return RawClient(*ends)


async def test_only_the_user_can_reach_it(start: Launch) -> None:
    client = await start(NODE)
    folder = run_dir() / client.session.run_id
    assert stat.S_IMODE((folder / "control.sock").stat().st_mode) == 0o600
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700


NONSENSE = [
    (b"not json", "bad_request", "JSON"),
    (b"[1, 2]", "bad_request", "object"),
    (b"\xff\x00", "bad_request", "JSON"),
    (b"[" * 100_000, "bad_request", "JSON"),
    (b'{"id": 1, "op": "fly"}', "bad_request", "fly"),
    (b'{"id": 1, "op": ["start"]}', "bad_request", "unknown request"),
    (b'{"id": 1, "op": "start", "nodes": "node"}', "bad_request", "nodes"),
    (b'{"id": 1, "op": "start", "nodes": ["no"]}', "unknown_node", "no"),
    (b'{"id": 1, "op": "history", "node": null, "limit": -1}', "bad_request", "limit"),
    (b'{"id": 1, "op": "history", "node": {}, "limit": 1}', "bad_request", "node"),
    (b'{"id": 1, "op": "stop_strays", "strays": [1]}', "bad_request", "strays"),
    (b'{"id": 1, "op": "stop_strays"}', "bad_request", "strays"),
]


async def test_nonsense_gets_an_answer_and_harms_nobody(start: Launch) -> None:
    client = await start(NODE)
    pid = await running_pid(client, "node")
    for line, kind, word in NONSENSE:
        bad = await raw(client)
        await bad.hear()
        bad.say(b'{"deck": %d}' % VERSION)
        bad.say(line)
        error = (await bad.reply())["error"]
        assert error["kind"] == kind, line[:80]
        assert word in error["message"]
        bad.say(b'{"id": 2, "op": "history", "node": "node", "limit": 1}')
        assert (await bad.reply())["reply"] == 2, "the same connection still serves"
        bad.writer.close()
    assert await running_pid(client, "node") == pid


async def test_a_client_of_another_version_is_told_so(start: Launch) -> None:
    client = await start(NODE)
    old = await raw(client)
    assert (await old.hear())["deck"] == VERSION
    old.say(b'{"deck": 0}')
    assert "version" in (await old.reply())["error"]["message"]
    assert await old.hear() == {}
    await running_pid(client, "node")
    old.writer.close()


async def test_the_owner_attaches_past_100_connections_that_say_nothing(start: Launch) -> None:
    client = await start(NODE)
    folder = run_dir() / client.session.run_id
    half_open = []
    try:
        for _connection in range(100):
            half_open.append(await asyncio.to_thread(connect, folder))
            half_open[-1].send(b'{"deck": ')
        other = await asyncio.wait_for(attach(), patient(20))
        await other.restart("node")
        await other.aclose()
        await running_pid(client, "node")
    finally:
        for connection in half_open:
            connection.close()


async def test_every_client_sees_what_another_does(start: Launch) -> None:
    client = await start(NODE)
    await running_pid(client, "node")
    other = await attach()
    await other.stop("node")
    assert other.nodes["node"].state is NodeState.EXITED
    await until_state(client, "node", NodeState.EXITED)
    await other.aclose()
    assert [session.run_id for session in running()] == [client.session.run_id]


async def test_events_begin_with_what_is_and_end_with_why_it_ended(start: Launch) -> None:
    client = await start(NODE)
    other = await attach()
    events = []

    async def listen() -> None:
        async for event in other.events():
            events.append(event)  # noqa: PERF401 - they come one by one

    listening = asyncio.create_task(listen())
    await until(lambda: events, "the first event")
    assert isinstance(events[0], StatusEvent)
    await client.shutdown()
    await asyncio.wait_for(listening, 20)
    assert events[-1] == ClosedEvent("stopped")
    with pytest.raises(ConnectionLostError):
        await other.start("node")
    await other.aclose()


async def test_the_same_profile_is_not_started_twice_in_a_domain(start: Launch, ros_domain: int) -> None:
    client = await start(NODE)
    with pytest.raises(AlreadyRunningError) as caught:
        await start(NODE)
    assert caught.value.session.run_id == client.session.run_id
    assert f"domain {ros_domain}" in str(caught.value)
    await start({"other": {"exec": SLEEPER}}, name="other")
