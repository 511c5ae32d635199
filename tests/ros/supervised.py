"""Sessions of small scripts under a real supervisor."""

from __future__ import annotations

import contextlib
import json
import os
import sys
import textwrap
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

from launcher.client.client import SupervisorClient, attach, launch, running
from launcher.errors import ConnectionLostError, NotRunningError, SilentSupervisorError
from launcher.processes.table import NODE_MARK, RUN_MARK, Process, processes, read_marks, read_process
from launcher.status import NodeState, NodeStatus
from tests.waiting import DEADLINE_S, until

Launch = Callable[..., Awaitable[SupervisorClient]]

NODE_DEADLINE_S = DEADLINE_S


def script(text: str, *arguments: str) -> list[str]:
    """Return the command line of a Python script that starts at once: no site, no ROS."""
    return [sys.executable, "-I", "-S", "-u", "-c", textwrap.dedent(text), *arguments]


SLEEPER = script("import time; time.sleep(1000)")
DEAF = "import signal, time; signal.signal(signal.SIGINT, signal.SIG_IGN); "


def write_profile(folder: Path, nodes: dict[str, Any], name: str = "test") -> Path:
    path = folder / f"{name}.yaml"
    path.write_text(json.dumps({"title": {"en": "Test"}, "nodes": nodes}, ensure_ascii=False), "utf-8")
    return path


@pytest.fixture
async def start(tmp_path: Path, ros_domain: int) -> AsyncIterator[Launch]:
    clients: list[SupervisorClient] = []

    async def begin(nodes: dict[str, Any], **options: Any) -> SupervisorClient:
        path = write_profile(tmp_path, nodes, options.pop("name", "test"))
        client = await launch(path, **{"domain": ros_domain, **options})
        clients.append(client)
        return client

    yield begin
    for client in clients:
        # On a busy machine it may take longer than a hurry allows; then it has been killed.
        with contextlib.suppress(SilentSupervisorError):
            await client.shutdown(now=True)


async def end_sessions() -> None:
    """End what still runs of this test; some of it may be ending by itself."""
    for session in running():
        with contextlib.suppress(NotRunningError, ConnectionLostError):
            client = await attach(session.run_id)
            await client.shutdown(now=True)


async def until_state(
    client: SupervisorClient, name: str, *states: NodeState, within_s: float = NODE_DEADLINE_S
) -> NodeStatus:
    """Return the node's status once it is in one of these states."""
    words = " or ".join(state.value for state in states)

    def there() -> NodeStatus | None:
        status = client.nodes[name]
        return status if status.state in states else None

    try:
        status = await until(there, f"{name} {words}", within_s)
    except pytest.fail.Exception:
        node = client.nodes[name]
        needed = [client.nodes[need] for need in node.needs]
        logs = {each.name: [line.text for line in await client.history(each.name, 20)] for each in (node, *needed)}
        pytest.fail(f"{name} is not {words} but {node}; it needs {needed}; logs: {logs}")
    return status


async def running_pid(client: SupervisorClient, name: str) -> int:
    """Return the number of a node's process once it runs."""
    status = await until_state(client, name, NodeState.RUNNING, NodeState.READY)
    assert status.pid is not None
    return status.pid


async def said(client: SupervisorClient, name: str, start: str) -> str:
    """Return what follows `start` in the first line of a node's log that starts so."""

    async def line() -> str | None:
        lines = [line.text for line in await client.history(name, 1000)]
        return next((text for text in lines if text.startswith(start)), None)

    found = await until(line, f"{start!r} of {name}", NODE_DEADLINE_S, every_s=0.05)
    return found.removeprefix(start).strip()


def alive(pid: int) -> bool:
    process = read_process(pid)
    return process is not None and not process.zombie


def kill(pid: int, number: int) -> None:
    """Send a signal to a process that the test has started."""
    os.kill(pid, number)


def of_run(run_id: str, node: str = "") -> list[Process]:
    """Return the living processes of a run, or of one node of it."""
    marked = ((each, read_marks(each.pid) or {}) for each in processes() if not each.zombie)
    return [each for each, marks in marked if marks.get(RUN_MARK) == run_id and node in ("", marks.get(NODE_MARK))]


async def spawn_server_of(run_id: str) -> int:
    """Return the number of the run's spawn server once there is but one."""

    def there() -> list[int]:
        pids = [each.pid for each in of_run(run_id)]
        return [p for p in pids if (read_marks(p) or {}).get(NODE_MARK, "").startswith("--")]

    (pid,) = await until(lambda: len(found := there()) == 1 and found, "one spawn server")
    return int(pid)
