"""A supervisor dies at any moment: whoever waits for it is told, and nobody waits any longer."""

from __future__ import annotations

import socket
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from launcher.client import client as client_module
from launcher.client.client import SupervisorClient, attach
from launcher.consent import Approval, ConsentAnswer
from launcher.control.protocol import encode
from launcher.control.socket import connect, listen
from launcher.errors import ConnectionLostError
from launcher.events import ClosedEvent, LogEvent, StatusEvent
from launcher.logs.packing import pack_line
from launcher.status import LogLine, Severity, Stray
from tests.dying_supervisor import HELLO, DyingSupervisor

LINE = LogLine("sonar", 1, 0.0, Severity.INFO, "x")
NEWS = encode({"event": "log", "lines": [pack_line(LINE)], "skipped": {}})
GONE = ClosedEvent(client_module.GONE)

REQUESTS: dict[str, Callable[[SupervisorClient], Awaitable[object]]] = {
    "start": lambda client: client.start("sonar"),
    "stop": lambda client: client.stop("sonar"),
    "restart": lambda client: client.restart("sonar"),
    "exchange": lambda client: client.exchange("sonar", "nodes.mock_sonar"),
    "history": lambda client: client.history(None, 10),
    "stop_strays": lambda client: client.stop_strays([Stray(1, 0.0, "sonar", "x", "run-0")]),
    "attend": lambda client: client.attend(),
    "answer": lambda client: client.answer(1, ConsentAnswer.ONCE),
    "end_consent": lambda client: client.end_consent(),
    "join": lambda client: client.join("key", "agent", Approval.ASK),
    "ask": lambda client: client.ask_consent("key", ["drive"]),
    "withdraw": lambda client: client.withdraw(),
    "tell": lambda client: client.tell(Severity.INFO, "words"),
}


@pytest.fixture
async def dying(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[DyingSupervisor]:
    """What `attach` finds."""
    found = SimpleNamespace(folder=tmp_path)
    monkeypatch.setattr(client_module, "find_running", lambda _name: found)
    supervisor = DyingSupervisor(tmp_path)
    yield supervisor
    supervisor.stop()


@pytest.mark.parametrize("said", [b"", HELLO[:20]], ids=["nothing", "half a greeting"])
async def test_one_that_dies_before_it_has_greeted(dying: DyingSupervisor, said: bytes) -> None:
    dying.says = said
    await dying.serve()
    with pytest.raises(ConnectionLostError):
        await attach()


async def test_one_that_dies_before_it_has_accepted(
    dying: DyingSupervisor, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As one that was suspended before: the connection stands in its queue."""
    listening = listen(dying.folder)

    def connect_to_the_dying(folder: Path) -> socket.socket:
        connection = connect(folder)
        listening.close()
        return connection

    monkeypatch.setattr(client_module, "connect", connect_to_the_dying)
    with pytest.raises(ConnectionLostError):
        await attach()


@pytest.mark.parametrize("past", [0, 10])
@pytest.mark.parametrize(
    "rest", [b"", NEWS, NEWS[:20], b"\xff\n"], ids=["", "news", "half of it", "rubbish"]
)
async def test_one_that_dies_once_it_has_greeted(
    dying: DyingSupervisor, rest: bytes, past: int
) -> None:
    dying.says = HELLO + rest
    await dying.serve()
    client = await attach()
    events = [event async for event in client.events(past=past)]
    assert events[-1] == GONE
    assert [event for event in events if isinstance(event, LogEvent)] == (
        [LogEvent((LINE,))] if rest == NEWS else []
    )
    await client.aclose()


@pytest.mark.parametrize("words", [b"", b'{"reply": 1'], ids=["nothing", "half a reply"])
@pytest.mark.parametrize("op", REQUESTS)
async def test_one_that_dies_when_it_is_asked(
    dying: DyingSupervisor, op: str, words: bytes
) -> None:
    dying.dies_on, dying.last_words = op, words
    await dying.serve()
    client = await attach()
    with pytest.raises(ConnectionLostError):
        await REQUESTS[op](client)
    with pytest.raises(ConnectionLostError):
        await REQUESTS[op](client)
    assert [event async for event in client.events(past=10)][-1] == GONE
    await client.shutdown()


async def test_one_that_dies_when_it_is_asked_for_the_past(dying: DyingSupervisor) -> None:
    dying.dies_on = "history"
    await dying.serve()
    client = await attach()
    await client.attend()
    assert [event async for event in client.events(past=10)][-1] == GONE
    await client.aclose()


async def test_one_that_dies_when_it_is_told_to_end(dying: DyingSupervisor) -> None:
    dying.dies_on = "shutdown"
    await dying.serve()
    client = await attach()
    events = client.events(past=10)
    assert isinstance(await anext(events), LogEvent)
    await client.shutdown()
    assert [event async for event in events][-1] == GONE


async def test_one_that_has_no_past_to_tell_is_heard_all_the_same(dying: DyingSupervisor) -> None:
    """Else nobody would hear that it dies."""
    dying.replies["history"] = {"error": {"kind": "fault", "message": "KeyError: 'sonar'"}}
    dying.dies_on = "tell"
    await dying.serve()
    client = await attach()
    events = client.events(past=10)
    assert isinstance(await anext(events), StatusEvent)
    with pytest.raises(ConnectionLostError):
        await client.tell(Severity.INFO, "words")
    assert [event async for event in events][-1] == GONE
    await client.aclose()
