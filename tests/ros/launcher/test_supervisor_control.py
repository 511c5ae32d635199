"""The control socket: private, versioned, and unharmed by whatever a client sends."""

from __future__ import annotations

import asyncio
import json
import stat
import sys
from typing import TYPE_CHECKING, Any

import pytest

from launcher.client.client import attach, launch, running
from launcher.control import server as control_server
from launcher.control.protocol import VERSION
from launcher.control.socket import connect
from launcher.errors import (
    AlreadyRunningError,
    ConnectionLostError,
    NotRunningError,
    ProfileError,
    ProtocolError,
    SeveralRunningError,
    UnknownNodeError,
)
from launcher.events import ClosedEvent, StatusEvent
from launcher.rundir import run_dir
from launcher.status import NodeState
from tests.ros.supervised import (
    SLEEPER,
    Launch,
    running_pid,
    until_state,
    write_profile,
)
from tests.waiting import until

if TYPE_CHECKING:
    from pathlib import Path

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
    ends = await asyncio.open_unix_connection(
        sock=connect(run_dir() / client.session.run_id), limit=1 << 26
    )
    return RawClient(*ends)


async def test_only_the_user_can_reach_it(start: Launch) -> None:
    client = await start(NODE)
    folder = run_dir() / client.session.run_id
    assert stat.S_IMODE((folder / "control.sock").stat().st_mode) == 0o600
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700


CONFINED = """
import os, sys
from launcher.processes import system_calls
from launcher.processes.confinement import confine

# The first barrier is out of the way: this is about the second.
system_calls._FAMILIES = (1, *system_calls._FAMILIES)
confine([])
from pathlib import Path
from launcher.control.socket import connect
try:
    client = connect(Path(sys.argv[1]))
    client.setblocking(True)
    client.sendall(b'{"deck": %s}' + bytes([10]))
    print("greeted" if client.recv(1) else "refused")
except OSError:
    print("refused")
"""


async def test_what_is_graded_cannot_reach_it(start: Launch) -> None:
    client = await start(NODE)
    program = CONFINED.replace("%s", str(VERSION))
    folder = str(run_dir() / client.session.run_id)
    graded = await asyncio.create_subprocess_exec(
        *(sys.executable, "-c", program, folder), stdout=asyncio.subprocess.PIPE
    )
    out, _ = await graded.communicate()
    assert out == b"refused\n"


async def test_a_path_too_long_for_a_socket_is_none_for_a_session(
    start: Launch, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("DECK_RUN_DIR", str(tmp_path / ("long" * 40)))
    client = await start(NODE)
    await running_pid(client, "node")
    other = await attach()
    await other.aclose()


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


async def test_a_request_of_many_megabytes_ends_the_connection_only(start: Launch) -> None:
    client = await start(NODE)
    bad = await raw(client)
    await bad.hear()
    bad.say(b'{"deck": %d}' % VERSION)
    bad.say(b"x" * (3 << 20))
    assert (await bad.reply()).get("error", {}).get("kind") in ("too_long", None)
    assert await bad.reply() == {}
    await running_pid(client, "node")
    bad.writer.close()


async def test_a_client_of_another_version_is_told_so(start: Launch) -> None:
    client = await start(NODE)
    old = await raw(client)
    assert (await old.hear())["deck"] == VERSION
    old.say(b'{"deck": 0}')
    assert "version" in (await old.reply())["error"]["message"]
    assert await old.hear() == {}
    await running_pid(client, "node")
    old.writer.close()


async def test_a_supervisor_of_another_version_is_told_apart(
    start: Launch, monkeypatch: pytest.MonkeyPatch
) -> None:
    await start(NODE)
    monkeypatch.setattr("launcher.client.client.VERSION", VERSION + 1)
    with pytest.raises(ProtocolError, match="another version"):
        await attach()


async def test_a_client_that_says_nothing_at_all_is_no_trouble(start: Launch) -> None:
    client = await start(NODE)
    silent = [await raw(client) for _client in range(5)]
    await client.restart("node")
    await running_pid(client, "node")
    for one in silent:
        one.writer.close()


@pytest.mark.parametrize("start_of_a_line", [b"", b'{"deck": '])
async def test_the_owner_attaches_past_500_connections_that_say_nothing(
    start: Launch, start_of_a_line: bytes
) -> None:
    client = await start(NODE)
    folder = run_dir() / client.session.run_id
    half_open = []
    try:
        for _connection in range(500):
            half_open.append(await asyncio.to_thread(connect, folder))
            half_open[-1].send(start_of_a_line)
        other = await asyncio.wait_for(attach(), 20)
        await other.restart("node")
        await other.aclose()
        await running_pid(client, "node")
    finally:
        for connection in half_open:
            connection.close()


async def test_who_never_greets_is_let_go_of(start: Launch) -> None:
    client = await start(NODE)
    silent = await raw(client)
    silent.writer.write(b'{"deck"')
    await silent.hear()
    # The supervisor's own clock; what it says meanwhile is of no interest here.
    while await silent.hear():
        pass
    silent.writer.close()
    await running_pid(client, "node")


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


async def test_an_unknown_node_is_named(start: Launch) -> None:
    client = await start(NODE)
    with pytest.raises(UnknownNodeError) as caught:
        await client.start("nod")
    assert (caught.value.name, caught.value.known) == ("nod", ("node",))
    await running_pid(client, "node")


async def test_the_same_profile_is_not_started_twice_in_a_domain(
    start: Launch, ros_domain: int
) -> None:
    client = await start(NODE)
    with pytest.raises(AlreadyRunningError) as caught:
        await start(NODE)
    assert caught.value.session.run_id == client.session.run_id
    assert f"domain {ros_domain}" in str(caught.value)
    await start({"other": {"exec": SLEEPER}}, name="other")


async def test_a_run_directory_that_fills_up_stops_no_node_from_starting(start: Launch) -> None:
    client = await start(NODE)
    before = await running_pid(client, "node")
    # Where the record is to be written, nothing can be.
    (run_dir() / client.session.run_id / "session.json.new").mkdir()
    await client.restart("node")
    await until(lambda: client.nodes["node"].pid not in (None, before), "another process")
    await running_pid(client, "node")
    assert any("cannot be written" in line.text for line in await client.history(None, 100))


async def test_sessions_are_found_by_name(start: Launch) -> None:
    with pytest.raises(NotRunningError):
        await attach()
    await start(NODE, name="one")
    await start({"other": {"exec": SLEEPER}}, name="two")
    assert [session.name for session in running()] == ["one", "two"]
    with pytest.raises(SeveralRunningError) as several:
        await attach()
    assert several.value.names == ("one", "two")
    with pytest.raises(NotRunningError):
        await attach("three")
    client = await attach("two")
    assert client.session.name == "two"
    await client.aclose()


async def test_a_bad_profile_starts_nothing(tmp_path: Path) -> None:
    profile = write_profile(tmp_path, {"node": {"exec": SLEEPER, "speed": 1}})
    with pytest.raises(ProfileError):
        await launch(profile)
    assert running() == []
    assert list(run_dir().glob("*/*")) == []


async def test_nothing_is_left_of_a_session_but_its_logs(start: Launch) -> None:
    client = await start(NODE)
    await running_pid(client, "node")
    await client.shutdown()
    assert list(run_dir().glob("*/*")) == []


def test_a_stuck_client_is_let_go_of() -> None:
    """For as long as it is stuck it is told nothing, so that it can take no memory."""

    class Transport:
        aborted = False

        def get_write_buffer_size(self) -> int:
            return control_server.MAX_UNSENT_BYTES + 1

        def abort(self) -> None:
            self.aborted = True

    class Writer:
        transport = Transport()

    now = 1000.0
    client = control_server._Client(Writer(), None, lambda: now)  # type: ignore[arg-type]
    assert not client.takes_more()
    now += control_server.STUCK_S - 1
    assert not client.takes_more()
    assert not Writer.transport.aborted
    now += 2
    assert not client.takes_more()
    assert Writer.transport.aborted
