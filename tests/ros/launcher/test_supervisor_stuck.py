"""Whatever hangs, a stop goes on and a session comes to its end."""

from __future__ import annotations

import asyncio
import contextlib
import signal
from typing import TYPE_CHECKING, Any

import pytest

from cli.health import well
from launcher.errors import SilentSupervisorError
from launcher.status import NodeState
from tests.ros.supervised import (
    SLEEPER,
    Launch,
    alive,
    kill,
    of_run,
    running_pid,
    said,
    script,
    spawn_server_of,
    until_state,
)
from tests.waiting import until

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from launcher.client.client import SupervisorClient

pytestmark = pytest.mark.nightly

SOON_S = 15.0
"""Much less than what a spawn server is given to answer, much more than a stop takes."""


async def soon(asked: Any) -> None:
    await asyncio.wait_for(asked, SOON_S)


@pytest.fixture
async def stuck(start: Launch) -> tuple[SupervisorClient, int]:
    """A session whose spawn server has been suspended, with a node that is starting."""
    client = await start({"node": {"exec": SLEEPER}, "other": {"exec": SLEEPER}})
    await running_pid(client, "node")
    await running_pid(client, "other")
    server = await spawn_server_of(client.session.run_id)
    kill(server, signal.SIGSTOP)
    await client.restart("node")
    await until_state(client, "node", NodeState.STARTING)
    return client, server


async def test_a_start_that_hangs_can_be_stopped(stuck: tuple[SupervisorClient, int]) -> None:
    client, server = stuck
    await soon(client.stop("node"))
    assert client.nodes["node"].state is NodeState.EXITED
    assert client.nodes["other"].state is NodeState.RUNNING
    # What was asked for comes now, and must not stay.
    kill(server, signal.SIGCONT)
    await client.start("node")
    pid = await running_pid(client, "node")

    def numbers() -> list[int]:
        return [each.pid for each in of_run(client.session.run_id, "node")]

    await until(lambda: numbers() == [pid], "no process but the one that is known")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
async def test_a_signal_ends_a_session_though_a_start_hangs(
    stuck: tuple[SupervisorClient, int], number: signal.Signals
) -> None:
    client, server = stuck
    kill(client.session.supervisor_pid, number)

    async def end() -> list[Any]:
        return [event async for event in client.events()]

    events = await asyncio.wait_for(end(), SOON_S)
    assert events[-1].reason == f"{number.name} received"
    await until(lambda: not alive(server), "the end of the spawn server that hung")


@pytest.fixture
async def stopped(start: Launch, monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[SupervisorClient]:
    monkeypatch.setattr("launcher.client.client.HEARD_IN_A_HURRY_S", 0.5)
    client = await start({"node": {"exec": SLEEPER}})
    await running_pid(client, "node")
    kill(client.session.supervisor_pid, signal.SIGSTOP)
    yield client
    with contextlib.suppress(ProcessLookupError):
        kill(client.session.supervisor_pid, signal.SIGKILL)


async def test_a_supervisor_that_hangs_is_killed_with_all_its_nodes(stopped: SupervisorClient) -> None:
    supervisor, node = stopped.session.supervisor_pid, stopped.nodes["node"].pid
    first = asyncio.ensure_future(stopped.shutdown())
    await asyncio.sleep(0)
    with pytest.raises(SilentSupervisorError) as error:
        await soon(stopped.shutdown(now=True))
    assert str(error.value) == (f"the supervisor (pid {supervisor}) did not answer; it was killed with all its nodes")
    with pytest.raises(SilentSupervisorError):
        await soon(first)
    assert node is not None
    assert not alive(node)
    assert not alive(supervisor)


async def test_a_node_of_which_any_process_is_suspended_is_not_healthy_till_it_goes_on(start: Launch) -> None:
    parent = """\
        import subprocess, sys
        child = subprocess.Popen([sys.executable, "-I", "-S", "-c", "import time; time.sleep(999)"])
        print("child", child.pid, flush=True)
        child.wait()
        """
    client = await start({"node": {"exec": script(parent)}, "other": {"exec": SLEEPER}})
    own = await running_pid(client, "node")
    child = int(await said(client, "node", "child "))
    for pid in (own, child):
        kill(pid, signal.SIGSTOP)
        await until(lambda: client.nodes["node"].ails, "the suspended node ails")
        assert f"kill -CONT {pid}" in client.nodes["node"].why
        assert not well(client.nodes["node"])
        assert well(client.nodes["other"])
        kill(pid, signal.SIGCONT)
        await until(lambda: well(client.nodes["node"]), "the node is healthy again")
