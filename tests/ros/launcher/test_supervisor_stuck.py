"""Whatever hangs, a stop goes on and a session comes to its end."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import time
from typing import TYPE_CHECKING, Any

import pytest

from cli.health import well
from launcher.client.client import attach
from launcher.errors import SilentSupervisorError
from launcher.processes.table import (
    NODE_MARK,
    RUN_MARK,
    TICKS_PER_S,
    Process,
    processes,
    read_marks,
)
from launcher.status import NodeState
from tests.ros.supervised import (
    DEAF,
    SLEEPER,
    Launch,
    alive,
    kill,
    running_pid,
    said,
    script,
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


async def spawn_server_of(run_id: str) -> int:
    """Return the number of the run's spawn server once there is but one."""

    def there() -> list[int]:
        marked = ((each.pid, read_marks(each.pid) or {}) for each in processes())
        return [
            pid
            for pid, marks in marked
            if marks.get(RUN_MARK) == run_id and marks.get(NODE_MARK, "").startswith("--")
        ]

    (pid,) = await until(lambda: len(found := there()) == 1 and found, "one spawn server")
    return int(pid)


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
        return [each.pid for each in of_node(client.session.run_id, "node")]

    await until(lambda: numbers() == [pid], "no process but the one that is known")


@pytest.mark.parametrize("now", [False, True])
async def test_a_session_ends_though_a_start_hangs(
    stuck: tuple[SupervisorClient, int], now: bool
) -> None:
    client, server = stuck
    await soon(client.shutdown(now=now))
    await until(lambda: not alive(server), "the end of the spawn server that hung")


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


def of_node(run_id: str, name: str) -> list[Process]:
    """Return the living processes of a node of this run."""
    marked = ((each, read_marks(each.pid) or {}) for each in processes() if not each.zombie)
    return [
        each
        for each, marks in marked
        if (marks.get(RUN_MARK), marks.get(NODE_MARK)) == (run_id, name)
    ]


@pytest.mark.parametrize("ending", ["stop", "shutdown"])
async def test_a_node_whose_start_a_starved_supervisor_heard_of_late_is_stopped(
    start: Launch, ending: str
) -> None:
    """The process is old, and nobody's, before the supervisor learns that it is there."""
    client = await start(
        {
            "other": {"exec": SLEEPER, "ready": {"topic": "/never", "type": "std_msgs/msg/Bool"}},
            "node": {"exec": SLEEPER, "needs": ["other"]},
        }
    )
    await running_pid(client, "other")
    run_id = client.session.run_id
    server = await spawn_server_of(run_id)
    kill(server, signal.SIGSTOP)
    await client.start("node")
    await until_state(client, "node", NodeState.STARTING)
    kill(client.session.supervisor_pid, signal.SIGSTOP)
    kill(server, signal.SIGCONT)

    def old() -> Process | None:
        now = time.clock_gettime(time.CLOCK_BOOTTIME) * TICKS_PER_S
        found = of_node(run_id, "node")
        return found[0] if found and found[0].started_ticks < now - 4 * TICKS_PER_S else None

    node = await until(old, "a process that has been there for four seconds", 60.0)
    kill(client.session.supervisor_pid, signal.SIGCONT)
    assert await running_pid(client, "node") == node.pid
    await soon(client.stop("node") if ending == "stop" else client.shutdown())
    assert not alive(node.pid)


async def test_a_session_that_does_not_end_is_not_waited_for_without_a_bound(
    start: Launch, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The supervisor has heard the request, and hangs in the middle of the stop."""
    monkeypatch.setattr("launcher.client.client.STOPPED_WITHIN_S", 0.5)
    monkeypatch.setattr("launcher.client.client.HEARD_WITHIN_S", 1.0)
    client = await start({"node": {"exec": script(DEAF + "print('deaf'); time.sleep(1000)")}})
    assert await said(client, "node", "deaf") == ""
    other = await attach()
    pid, node = client.session.supervisor_pid, client.nodes["node"].pid
    down = asyncio.ensure_future(other.shutdown())
    await until_state(other, "node", NodeState.STOPPING)
    kill(pid, signal.SIGSTOP)
    with pytest.raises(SilentSupervisorError) as error:
        await soon(down)
    kill(pid, signal.SIGCONT)
    assert f"{node} (" in str(error.value)
    assert f"kill -9 {pid} ends it" in str(error.value)


async def test_a_command_line_may_be_longer_than_a_packet(start: Launch) -> None:
    word = "ж" * 45_000
    client = await start(
        {"node": {"exec": script("import sys; print('n', len(sys.argv[1]))", word)}}
    )
    assert await said(client, "node", "n") == "45000"


@pytest.fixture
async def stopped(
    start: Launch, monkeypatch: pytest.MonkeyPatch
) -> AsyncIterator[SupervisorClient]:
    """A session whose supervisor has been suspended."""
    monkeypatch.setattr("launcher.client.client.HEARD_IN_A_HURRY_S", 0.5)
    client = await start({"node": {"exec": SLEEPER}})
    await running_pid(client, "node")
    kill(client.session.supervisor_pid, signal.SIGSTOP)
    yield client
    with contextlib.suppress(ProcessLookupError):
        kill(client.session.supervisor_pid, signal.SIGKILL)


async def test_a_supervisor_that_hangs_is_killed_with_all_its_nodes(
    stopped: SupervisorClient,
) -> None:
    supervisor, node = stopped.session.supervisor_pid, stopped.nodes["node"].pid
    first = asyncio.ensure_future(stopped.shutdown())
    await asyncio.sleep(0)
    with pytest.raises(SilentSupervisorError) as error:
        await soon(stopped.shutdown(now=True))
    assert str(error.value) == (
        f"the supervisor (pid {supervisor}) did not answer; it was killed with all its nodes"
    )
    with pytest.raises(SilentSupervisorError):
        await soon(first)
    assert node is not None
    assert not alive(node)
    assert not alive(supervisor)


async def test_what_a_killed_supervisor_has_left_is_named(
    stopped: SupervisorClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("launcher.client.hung_supervisor.GONE_WITHIN_S", 0.5)
    mark = {**os.environ, RUN_MARK: stopped.session.run_id}
    # One that nobody can find by its parents: it stands for another user's.
    left = await asyncio.create_subprocess_exec("sleep", "1000", env=mark, start_new_session=True)
    left.send_signal(signal.SIGSTOP)
    with pytest.raises(SilentSupervisorError, match=rf"still running: .*{left.pid} \(sleep\)"):
        await soon(stopped.shutdown(now=True))
    left.kill()
    await left.wait()


async def test_anothers_supervisor_that_hangs_is_left_alone(stopped: SupervisorClient) -> None:
    pid = stopped.session.supervisor_pid
    kill(pid, signal.SIGCONT)
    other = await attach()
    kill(pid, signal.SIGSTOP)
    with pytest.raises(SilentSupervisorError) as error:
        await soon(other.shutdown(now=True))
    assert str(error.value) == f"the supervisor (pid {pid}) does not answer; kill -9 {pid} ends it"
    assert alive(pid)


async def test_whoever_attaches_to_one_that_hangs_is_told_how_to_end_it(
    stopped: SupervisorClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("launcher.client.client.HELLO_WITHIN_S", 0.5)
    pid = stopped.session.supervisor_pid
    with pytest.raises(SilentSupervisorError, match=f"kill -9 {pid} ends it"):
        await soon(attach())


async def test_a_node_of_which_any_process_is_suspended_is_not_healthy_till_it_goes_on(
    start: Launch,
) -> None:
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
