"""Nodes as processes: nothing is started twice, and nothing is left when they are stopped."""

from __future__ import annotations

import asyncio
import json
import signal
from functools import partial
from typing import TYPE_CHECKING

import pytest

from launcher.processes.table import read_marks, read_process
from launcher.status import NodeState
from tests.ros.supervised import SLEEPER, Launch, alive, kill, running_pid, said, script, until_state
from tests.waiting import until

if TYPE_CHECKING:
    from pathlib import Path

    from launcher.client.client import SupervisorClient


async def pid_of(client: SupervisorClient, name: str) -> int:
    """Return the number of a node's process as soon as there is one."""
    return await until(lambda: client.nodes[name].pid, "a process")


FORK_OFF = """
import os, sys, time
middle = os.fork()
if middle == 0:
    if "session" in sys.argv: os.setsid()
    if "twice" in sys.argv and os.fork(): os._exit(0)
    if "deaf" in sys.argv:
        import signal
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
    print("grandchild", os.getpid(), flush=True)
    time.sleep(1000)
if "quit" in sys.argv:
    time.sleep(0.5)
    sys.exit(3)
try: time.sleep(1000)
except KeyboardInterrupt: sys.exit(0)
"""


def _is_child(pid: int, parent: int) -> bool:
    process = read_process(pid)
    return process is not None and process.parent == parent


async def test_each_node_leads_a_session_and_a_group_of_its_own(start: Launch) -> None:
    client = await start({"one": {"exec": SLEEPER}, "two": {"exec": SLEEPER}})
    for name in client.nodes:
        pid = await running_pid(client, name)
        process = read_process(pid)
        assert process is not None
        assert (process.group, process.session) == (pid, pid)
        # The process that has forked it tells of it first, and then ends.
        await until(partial(_is_child, pid, client.session.supervisor_pid), "a child of the supervisor")
        assert (read_marks(pid) or {}).get("DECK_RUN_ID") == client.session.run_id


async def test_a_node_gets_its_environment_and_no_terminal(start: Launch, tmp_path: Path, ros_domain: int) -> None:
    text = """
        import json, os
        print("env", json.dumps([dict(os.environ), os.getcwd(), os.read(0, 9).hex()]))
    """
    client = await start({"env": {"exec": script(text), "env": {"SPEED": "3"}, "cwd": "."}})
    await until_state(client, "env", NodeState.EXITED)
    environ, cwd, read = json.loads(await said(client, "env", "env"))
    assert environ["SPEED"] == "3"
    assert environ["ROS_DOMAIN_ID"] == str(ros_domain)
    assert environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "SYSTEM_DEFAULT"
    assert environ["DECK_NODE"] == "env"
    assert (cwd, read) == (str(tmp_path), "")


ENDS: dict[str, tuple[str, NodeState, int | None, str | None, str]] = {
    "well": ("pass", NodeState.EXITED, 0, None, "ended"),
    "code": ("raise SystemExit(3)", NodeState.FAILED, 3, None, "exit code 3"),
    "abort": ("import os; print('dying'); os.abort()", NodeState.FAILED, None, "SIGABRT", "killed by SIGABRT: dying"),
    "error": ("1/0", NodeState.FAILED, 1, None, "exit code 1: ZeroDivisionError: division by zero"),
}
"""What a node does, and how that is told."""


async def test_how_a_node_ended_is_told(start: Launch) -> None:
    client = await start({name: {"exec": script(end[0])} for name, end in ENDS.items()})
    for name, (_text, state, code, number, detail) in ENDS.items():
        status = await until_state(client, name, NodeState.EXITED, NodeState.FAILED)
        assert (status.state, status.exit_code, status.signal) == (state, code, number)
        assert (status.detail, status.pid) == (detail, None)


async def test_a_node_that_is_interrupted_while_it_starts_ends_without_a_word(start: Launch) -> None:
    client = await start({"node": {"run": "nodes.hello"}})
    for _ in range(15):
        kill(await pid_of(client, "node"), signal.SIGINT)
        status = await until_state(client, "node", NodeState.EXITED, NodeState.FAILED)
        assert (status.state, status.exit_code, status.signal) == (NodeState.EXITED, 0, None)
        await client.start("node")
    text = "\n".join(line.text for line in await client.history("node", 1000))
    assert "Traceback" not in text


WAYS = {"group": "", "session": "session", "daemon": "session twice"}
"""Where a grandchild may be: in the node's group, in a session of its own, or daemonised."""


def is_named(client: SupervisorClient, name: str, pid: int) -> bool:
    """Whether the node's detail names a process."""
    return str(pid) in client.nodes[name].detail


async def test_a_deaf_grandchild_is_ended_with_its_node(start: Launch) -> None:
    client = await start({name: {"exec": script(FORK_OFF, "deaf", *way.split())} for name, way in WAYS.items()})
    grandchildren = {name: int(await said(client, name, "grandchild")) for name in WAYS}
    stopping = asyncio.ensure_future(client.stop())
    for name, pid in grandchildren.items():
        await until(partial(is_named, client, name, pid), "who holds it up")
        assert client.nodes[name].state is NodeState.STOPPING
        assert "SIGINT sent, waiting for" in client.nodes[name].detail
        assert alive(pid)
    await client.stop(now=True)
    await stopping
    for name, pid in grandchildren.items():
        assert client.nodes[name].state is NodeState.EXITED
        assert not alive(pid)


async def test_what_a_crashed_node_leaves_is_ended_before_it_returns(start: Launch) -> None:
    client = await start(
        {
            name: {"exec": script(FORK_OFF, "quit", *way.split()), "restart": "on-failure"}
            for name, way in WAYS.items()
        }
    )
    grandchildren = {name: int(await said(client, name, "grandchild")) for name in WAYS}
    for name, pid in grandchildren.items():
        await until_state(client, name, NodeState.BACKOFF)
        assert not alive(pid)


@pytest.fixture
async def robot(start: Launch, tmp_path: Path) -> tuple[SupervisorClient, Path]:
    """Three nodes that need each other, and the file in which they note what happens to them."""
    notes = tmp_path / "notes"
    text = f"""
        import sys, time
        def note(word): open({str(notes)!r}, "a").write(f"{{word}} {{sys.argv[1]}}\\n")
        note("up")
        try: time.sleep(1000)
        except KeyboardInterrupt: time.sleep(0.2); note("down")
    """
    client = await start(
        {
            "brain": {"exec": script(text, "brain"), "needs": ["safety"]},
            "safety": {"exec": script(text, "safety"), "needs": ["sonar"]},
            "sonar": {"exec": script(text, "sonar")},
        }
    )
    await until(lambda: notes.exists() and notes.read_text().count("up") == 3, "all are up")
    return client, notes


async def test_a_restart_of_all_stops_dependants_first_and_starts_them_again(
    robot: tuple[SupervisorClient, Path],
) -> None:
    client, notes = robot
    await client.restart()
    await client.restart()
    await until(lambda: notes.read_text().count("up") == 6, "all are up again")
    order = notes.read_text().splitlines()[3:]
    assert order[:3] == ["down brain", "down safety", "down sonar"]
    assert len(order) == 6


async def test_a_suspended_node_can_be_stopped(start: Launch) -> None:
    # One that is still starting may lose the first signal.
    client = await start({"node": {"exec": script("print('up'); import time; time.sleep(1000)")}})
    await said(client, "node", "up")
    kill(await running_pid(client, "node"), signal.SIGSTOP)
    await client.stop("node")
    assert client.nodes["node"].signal == "SIGINT", "it took no stronger signal"


async def test_what_eludes_every_search_ends_with_the_session(start: Launch) -> None:
    """A daemon without a mark in its environment: the supervisor has adopted it all the same."""
    text = """
        import os, signal
        if os.fork() == 0:
            os.setsid()
            if os.fork(): os._exit(0)
            command = "echo daemon $$; sleep 1000"
            os.execve("/bin/sh", ["sh", "-c", command], {"PATH": os.environ["PATH"]})
        # It stays, for after its end nobody would listen to the daemon.
        signal.pause()
    """
    client = await start({"node": {"exec": script(text)}})
    daemon = int(await said(client, "node", "daemon"))
    await client.shutdown()
    assert not alive(daemon)
