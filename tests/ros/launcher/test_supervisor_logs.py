"""Logs of real nodes: no flood delays anybody, and no text is more than text."""

from __future__ import annotations

import asyncio
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from launcher.client.client import attach
from launcher.events import LogEvent
from launcher.logs.lines import MAX_LINE_BYTES
from launcher.processes.usage import proportional_memory
from launcher.status import NodeState, Severity
from tests.ros.supervised import (
    Launch,
    running_pid,
    said,
    script,
    until_state,
)
from tests.waiting import until

if TYPE_CHECKING:
    from launcher.client.client import SupervisorClient
    from launcher.status import LogLine

pytestmark = pytest.mark.nightly

FLOOD_LINES = 30_000
FLOOD = """
import sys, time
begin = time.monotonic()
for second in range(3):
    for block in range(100):
        line = f"[INFO] [1700000000.0] [flood]: line {second} {block}\\n"
        sys.stdout.write(100 * line)
        sys.stdout.flush()
        time.sleep(max(0, begin + second + block / 100 - time.monotonic()))
print("done")
time.sleep(1000)
"""
STEADY = """
import time
for i in range(25):
    print("steady", i, time.time(), flush=True)
    time.sleep(0.1)
print("steady end", flush=True)
time.sleep(1000)
"""

COUNTING = """
import itertools, time
for number in itertools.count():
    print(number)
    time.sleep(0.01)
"""


async def listen(client: SupervisorClient, node: str, last: str) -> tuple[list[LogLine], int, int]:
    """Return the node's lines up to `last`, how many were skipped, and the largest batch."""
    lines: list[LogLine] = []
    skipped = largest = 0
    async for event in client.events():
        if isinstance(event, LogEvent):
            batch = [line for line in event.lines if line.node == node]
            lines += batch
            largest = max(largest, len(batch))
            skipped += event.skipped.get(node, 0)
            if any(last in line.text for line in batch):
                break
    return lines, skipped, largest


async def test_a_flood_delays_nobody_and_loses_only_what_it_says(start: Launch) -> None:
    client = await start({"flood": {"exec": script(FLOOD)}, "steady": {"exec": script(STEADY)}})
    memory = proportional_memory([client.session.supervisor_pid])
    flood: list[LogLine] = []
    steady: list[LogLine] = []
    late: list[float] = []
    skipped: dict[str, int] = {}
    batches = []
    async for event in client.events():
        if not isinstance(event, LogEvent):
            continue
        now = time.time()
        flood += [line for line in event.lines if line.node == "flood"]
        new = [line for line in event.lines if line.node == "steady"]
        late += [
            now - float(line.text.split()[2])
            for line in new
            if line.text[-1].isdigit() and line.source == "stdout"
        ]
        steady += new
        batches.append(len(event.lines))
        for name, count in event.skipped.items():
            skipped[name] = skipped.get(name, 0) + count
        if any("done" in line.text for line in flood[-200:]) and any(
            "steady end" in line.text for line in steady
        ):
            break
    assert "steady" not in skipped
    assert [line.text.split()[1] for line in steady if line.source == "stdout"] == [
        *map(str, range(25)),
        "end",
    ]
    assert sorted(late)[len(late) // 2] < 1.0, "half of the steady lines came at once"
    assert len(flood) + skipped["flood"] == flood[-1].seq >= FLOOD_LINES
    now_memory = proportional_memory([client.session.supervisor_pid])
    assert memory is not None
    assert now_memory is not None
    assert now_memory - memory < 25_000_000
    log = Path(client.session.log_dir) / "flood.log"
    await until(lambda: b"done" in log.read_bytes()[-4096:], "the end of the file")
    assert log.read_bytes().count(b"\n") >= FLOOD_LINES


async def test_a_client_that_comes_later_reads_what_was(start: Launch) -> None:
    text = "print('one'); print('two'); import sys; print('three', file=sys.stderr)"
    client = await start({"node": {"exec": script(text)}})
    await until_state(client, "node", NodeState.EXITED)
    lines = await client.history("node", 100)
    assert {line.text for line in lines} >= {"one", "two", "three", "ended"}
    assert [line.seq for line in lines] == list(range(1, len(lines) + 1))
    sources = {line.text: line.source for line in lines}
    assert (sources["two"], sources["three"], sources["ended"]) == ("stdout", "stderr", "deck")
    assert len(await client.history("node", 2)) == 2
    everything = await client.history(None, 100)
    assert [line.time_s for line in everything] == sorted(line.time_s for line in everything)


async def test_who_attaches_hears_the_log_from_its_past_on_each_line_once(start: Launch) -> None:
    client = await start({"node": {"exec": script(COUNTING)}})
    await said(client, "node", "20")
    late = await attach()
    await said(client, "node", "60")
    lines = []
    async for event in late.events(past=1000):
        if isinstance(event, LogEvent):
            assert not event.skipped
            lines += [line for line in event.lines if line.node == "node"]
            if lines[-1].seq > 150:
                break
    await late.aclose()
    assert [line.seq for line in lines] == list(range(1, len(lines) + 1))
    assert {line.text for line in lines} >= {"0", "20", "60"}


async def test_hostile_text_is_text(start: Launch) -> None:
    text = r"""
        import sys
        out = sys.stdout.buffer
        out.write(b"\x1b]52;c;aGk=\x07 \x1b[2J\x1b[31mred\x1b[0m [bold]x[/] a\0b \xff\n")
        out.write(b"\x1b]0;never finished\n")
        out.write(b"x" * 1_000_000 + b"\n")
        out.write("[ERROR] [1700000000.5] [глаз]: нет камеры\n".encode())
        out.write(b"half \xd0")
        out.flush()
    """
    client = await start({"node": {"exec": script(text)}})
    await until_state(client, "node", NodeState.EXITED)
    lines = [line for line in await client.history("node", 10) if line.source == "stdout"]
    assert lines[0].text == "␛]52;c;aGk=␇ ␛[2Jred [bold]x[/] a␀b �"
    assert lines[1].text == "␛]0;never finished"
    missing = 1_000_000 - MAX_LINE_BYTES
    assert lines[2].text.endswith(f"x … [{missing} more bytes, see the log file]")
    assert (lines[3].severity, lines[3].logger) == (Severity.ERROR, "глаз")
    assert (lines[3].text, lines[3].time_s) == ("нет камеры", 1_700_000_000.5)
    assert lines[4].text == "half �"
    data = (Path(client.session.log_dir) / "node.log").read_bytes()
    assert b"x" * 1_000_000 in data, "the file has every byte"


async def test_output_without_line_ends_is_seen_and_bounded(start: Launch) -> None:
    text = """
        import sys, time
        for i in range(300_000): sys.stdout.write(f"{i} %\\r")
        sys.stdout.flush()
        time.sleep(1000)
    """
    client = await start({"node": {"exec": script(text)}})
    await said(client, "node", "299999 %")
    assert len(await client.history("node", 1000)) < 30


def transport_of(client: SupervisorClient) -> asyncio.ReadTransport:
    """The connection that a client reads, which can be told to wait."""
    reader: Any = client._reader
    transport: asyncio.ReadTransport = reader._transport
    return transport


async def test_a_slow_client_costs_nothing_and_is_right_at_once(start: Launch) -> None:
    client = await start({"flood": {"exec": script(FLOOD)}})
    await running_pid(client, "flood")
    transport_of(client).pause_reading()
    # For as long as the flood lasts.
    log = Path(client.session.log_dir) / "flood.log"
    await until(lambda: log.exists() and b"done" in log.read_bytes()[-4096:], "its end")
    before = proportional_memory([client.session.supervisor_pid]) or 0
    transport_of(client).resume_reading()
    lines, skipped, largest = await listen(client, "flood", "done")
    assert len(lines) + skipped == lines[-1].seq
    assert largest <= 10_000
    assert before < 80_000_000


async def test_a_node_whose_output_nobody_reads_is_never_blocked(start: Launch) -> None:
    """Not even by a client that has stopped reading."""
    text = """
        import sys
        for i in range(200_000): print("x" * 80)
        print("all written", file=sys.stderr)
    """
    client = await start({"node": {"exec": script(text)}})
    transport_of(client).pause_reading()
    log = Path(client.session.log_dir) / "node.log"
    await until(lambda: log.exists() and b"all written" in log.read_bytes(), "the end of it")
    transport_of(client).resume_reading()
    await until_state(client, "node", NodeState.EXITED)
