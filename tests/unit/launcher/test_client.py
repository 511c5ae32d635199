"""What a client hears of a session; what starts a node, and with which arguments."""

from __future__ import annotations

import runpy
import subprocess
import sys
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from launcher.client import client as client_module
from launcher.client import inbox as client_inbox
from launcher.client.client import SupervisorClient, attach
from launcher.client.inbox import Inbox, newer
from launcher.control.server import MAX_LINES, Client
from launcher.errors import ConnectionLostError
from launcher.events import ClosedEvent, LogEvent, StatusEvent, pack_event
from launcher.faults.crash import refused_arguments
from launcher.faults.explain import explained
from launcher.logs.ring import LogRing
from launcher.spawn_server.probe import COUNTED, ArrivalRate
from launcher.status import LogLine, NodeState, NodeStatus, Severity
from launcher.wire import encode
from tests.dying_supervisor import HELLO, DyingSupervisor

MOST = 1000


async def test_news_that_nobody_takes_are_merged_and_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(client_inbox, "MAX_LINES", MOST)
    inbox = Inbox()
    for state in (NodeState.STARTING, NodeState.READY):
        inbox.put(StatusEvent((NodeStatus("sonar", "x", state),)))
    for number in range(3 * MOST // 100):
        first = 100 * number + 1
        lines = tuple(LogLine("sonar", first + i, 0.0, Severity.INFO, "x") for i in range(100))
        inbox.put(LogEvent(lines, {"sonar": 1}))
    inbox.put(ClosedEvent("over"))
    status, log, closed = [event async for event in inbox.events()]
    assert isinstance(status, StatusEvent)
    assert [node.state for node in status.nodes] == [NodeState.READY]
    assert isinstance(log, LogEvent)
    assert len(log.lines) == MOST
    assert log.lines[-1].seq == 3 * MOST
    assert log.skipped == {"sonar": 2 * MOST + 3 * MOST // 100}
    assert closed == ClosedEvent("over")


LINE = LogLine("sonar", 1, 0.0, Severity.INFO, "x")
NEWS = encode(pack_event(LogEvent((LINE,))))
GONE = ClosedEvent(client_module.GONE)

REQUESTS: dict[str, Callable[[SupervisorClient], Awaitable[object]]] = {
    "start": lambda client: client.start("sonar"),
    "ask": lambda client: client.ask_consent("key", ["drive"]),
}


@pytest.fixture
async def dying(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[DyingSupervisor]:
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


@pytest.mark.parametrize("past", [0, 10])
@pytest.mark.parametrize("rest", [b"", NEWS, NEWS[:20], b"\xff\n"], ids=["", "news", "half of it", "rubbish"])
async def test_one_that_dies_once_it_has_greeted(dying: DyingSupervisor, rest: bytes, past: int) -> None:
    dying.says = HELLO + rest
    await dying.serve()
    client = await attach()
    events = [event async for event in client.events(past=past)]
    assert events[-1] == GONE
    assert [event for event in events if isinstance(event, LogEvent)] == ([LogEvent((LINE,))] if rest == NEWS else [])
    await client.aclose()


@pytest.mark.parametrize("words", [b"", b'{"reply": 1'], ids=["nothing", "half a reply"])
@pytest.mark.parametrize("op", REQUESTS)
async def test_one_that_dies_when_it_is_asked(dying: DyingSupervisor, op: str, words: bytes) -> None:
    dying.dies_on, dying.last_words = op, words
    await dying.serve()
    client = await attach()
    with pytest.raises(ConnectionLostError):
        await REQUESTS[op](client)
    with pytest.raises(ConnectionLostError):
        await REQUESTS[op](client)
    assert [event async for event in client.events(past=10)][-1] == GONE
    await client.shutdown()


def line(seq: int, node: str = "sonar") -> LogLine:
    return LogLine(node, seq, 0.0, Severity.INFO, "x")


def lines(first: int, last: int, node: str = "sonar") -> tuple[LogLine, ...]:
    return tuple(line(seq, node) for seq in range(first, last + 1))


@pytest.mark.parametrize(
    ("known", "event", "expected"),
    [
        ({}, LogEvent(lines(1, 3), {"sonar": 2}), LogEvent(lines(1, 3), {"sonar": 2})),
        ({"sonar": 5}, LogEvent(lines(4, 7)), LogEvent(lines(6, 7))),
        ({"sonar": 5}, LogEvent(lines(6, 7)), LogEvent(lines(6, 7))),
        ({"sonar": 9}, LogEvent(lines(4, 7)), LogEvent(())),
        ({"sonar": 5}, LogEvent(lines(1, 2, "gate")), LogEvent(lines(1, 2, "gate"))),
    ],
    ids=["nothing known", "overlap", "joint", "all known", "another node"],
)
def test_what_is_known_does_not_come_again(known: dict[str, int], event: LogEvent, expected: LogEvent) -> None:
    assert newer(event, known) == expected


NOBODY: Any = None


def fill(ring: LogRing, node: str, count: int, time_s: float = 0.0) -> None:
    for _line in range(count):
        ring.append(LogLine(node, ring.last_seq + 1, time_s, Severity.INFO, "x"))


def test_a_flood_of_one_node_skips_none_of_another() -> None:
    rings = {"flood": LogRing(), "sonar": LogRing()}
    feed = Client(NOBODY, rings)
    fill(rings["flood"], "flood", 5 * MAX_LINES)
    fill(rings["sonar"], "sonar", 3)
    news = feed.log_news()
    assert news is not None
    assert news["skipped"] == {"flood": 4 * MAX_LINES}
    assert len([line for line in news["lines"] if line[0] == "sonar"]) == 3
    assert [line[1] for line in news["lines"] if line[0] == "flood"][-1] == 5 * MAX_LINES
    assert feed.log_news() is None


def test_of_many_changes_of_a_node_the_last_is_told() -> None:
    feed = Client(NOBODY, {})
    for _change in range(100):
        feed.changed["sonar"] = None
    status = NodeStatus("sonar", "nodes.mock_sonar", NodeState.READY)
    news = feed.status_news(lambda: {"sonar": status})
    assert news is not None
    assert [node["state"] for node in news["nodes"]] == ["ready"]
    assert feed.status_news(lambda: {"sonar": status}) is None


ARGPARSE = """\
import argparse
parser = argparse.ArgumentParser()
{argument}
parser.parse_args()
"""
OF_ROS = ("--ros-args", "-r", "__node:=arg")


def printed_by(file: Path, text: str) -> list[str]:
    file.write_text(text)
    ended = subprocess.run([sys.executable, "-I", file, *OF_ROS], capture_output=True, text=True, check=False)
    assert ended.returncode != 0
    return (ended.stdout + ended.stderr).splitlines()


@pytest.mark.parametrize(
    "argument",
    [
        'parser.add_argument("seconds", type=int)',
        'parser.add_argument("side", choices=("left", "right"))',
        'parser.add_argument("--rate", type=float)',
    ],
)
def test_a_parser_that_refuses_them(tmp_path: Path, argument: str) -> None:
    file = tmp_path / "arg.py"
    lines = printed_by(file, ARGPARSE.format(argument=argument))
    fault = refused_arguments(lines, str(file))
    assert fault is not None
    assert (fault.kind, fault.line, fault.source_line) == ("crash", 4, "parser.parse_args()")
    assert "arg.py: error:" in fault.exception
    assert "rclpy.utilities.remove_ros_args(sys.argv)[1:]" in fault.meaning


@pytest.mark.parametrize("text", ["import sys\nx = int(sys.argv[1])\n", "import sys\nopen(sys.argv[3])\n"])
def test_a_program_that_reads_them_itself(tmp_path: Path, text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "arg.py"
    file.write_text(text)
    monkeypatch.setattr(sys, "argv", [str(file), *OF_ROS])
    with pytest.raises((ValueError, OSError)) as raised:
        runpy.run_path(str(file))
    fault = explained(raised.value, str(tmp_path))
    assert fault.line == 2
    assert "after --ros-args" in fault.meaning


@pytest.mark.parametrize(
    ("sent_each_s", "received_each_s", "count", "later_s", "hz"),
    [
        (0.02, 0.02, COUNTED, 0.0, 50),
        (0.02, 0.02, COUNTED - 1, 0.0, 0),
        # Held up, they arrive together.
        (0.02, 0.001, COUNTED, 0.0, 50),
        (0.02, 0.02, COUNTED, 4.0, 1),
    ],
)
def test_the_rate_that_a_topic_is_ready_by(
    sent_each_s: float, received_each_s: float, count: int, later_s: float, hz: float
) -> None:
    counted, now_s = ArrivalRate(), 1_800_000_000.0
    for number in range(count):
        counted.add(number * sent_each_s + 7.0, now_s + number * received_each_s)
    found = counted.hz(now_s + (count - 1) * received_each_s + later_s)
    assert found == pytest.approx(hz, rel=0.1)
