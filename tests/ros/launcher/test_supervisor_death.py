"""Whoever dies, no node is left that nobody knows of; and what should live on, lives on."""

from __future__ import annotations

import asyncio
import json
import signal
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from launcher.client.client import attach, running
from launcher.events import ClosedEvent
from launcher.processes.table import command_line, read_process
from launcher.runs.record import supervisors, supervisors_everywhere
from launcher.runs.strays import find_strays
from launcher.status import NodeState, Stray
from tests.ros.supervised import (
    DEAF,
    SLEEPER,
    Launch,
    alive,
    end_sessions,
    kill,
    of_run,
    running_pid,
    said,
    script,
    spawn_server_of,
    until_state,
    write_profile,
)
from tests.waiting import until

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

GONE_WITHIN_S = 15.0
"""After 2 s no node is alive; a machine under load is given more."""

DEAF_FAMILY = """
import os, signal, sys, time
signal.signal(signal.SIGINT, signal.SIG_IGN)
signal.signal(signal.SIGTERM, signal.SIG_IGN)
if os.fork() == 0:
    os.setsid()
    os.fork()
print("pid", os.getpid(), flush=True)
time.sleep(1000)
"""


async def all_gone(run_id: str) -> None:
    """Wait until a run has no process left."""
    await until(lambda: not of_run(run_id), "the end of every process of the run", GONE_WITHIN_S)


@pytest.fixture
async def own(tmp_path: Path, ros_domain: int) -> AsyncIterator[Any]:
    """Start a session in a process of its own, which can then be killed."""
    owners: list[asyncio.subprocess.Process] = []

    async def begin(
        nodes: dict[str, Any], mode: str = "foreground"
    ) -> tuple[asyncio.subprocess.Process, dict[str, Any]]:
        owner = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "tests.ros.owner"),
            *(str(write_profile(tmp_path, nodes)), str(ros_domain), mode),
            stdout=asyncio.subprocess.PIPE,
            start_new_session=True,
        )
        owners.append(owner)
        assert owner.stdout is not None
        line = await asyncio.wait_for(owner.stdout.readline(), 40)
        return owner, json.loads(line)

    yield begin
    for owner in owners:
        if owner.returncode is None:
            owner.kill()
        await owner.communicate()
    await end_sessions()


async def test_the_supervisor_killed_takes_everything_with_it(start: Launch) -> None:
    """Its nodes, their children, and what has left for a session of its own."""
    client = await start({"deaf": {"exec": script(DEAF_FAMILY)}, "other": {"exec": SLEEPER, "restart": "always"}})
    await running_pid(client, "other")
    run_id = client.session.run_id
    await until(lambda: len(of_run(run_id)) == 5, "the deaf node, its two children, the other")
    kill(client.session.supervisor_pid, signal.SIGKILL)
    await all_gone(run_id)
    assert running() == []


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGHUP, signal.SIGTERM])
async def test_a_foreground_session_ends_with_its_screen(own: Any, number: int) -> None:
    """Killed, or its terminal closed: everything is over quickly, deaf children included."""
    owner, told = await own({"deaf": {"exec": script(DEAF_FAMILY)}, "other": {"exec": SLEEPER}})
    owner.send_signal(number)
    await all_gone(told["session"]["run_id"])
    await until(lambda: not alive(told["session"]["supervisor_pid"]), "the supervisor's end")
    assert running() == []


async def test_a_background_session_outlives_whoever_started_it(own: Any) -> None:
    owner, told = await own({"node": {"exec": SLEEPER}}, "background")
    owner.kill()
    await owner.wait()
    kill(told["session"]["supervisor_pid"], signal.SIGHUP)
    client = await attach()
    assert client.session.run_id == told["session"]["run_id"]
    assert await running_pid(client, "node") == told["pids"]["node"]
    await client.shutdown()
    assert not alive(told["pids"]["node"])


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
async def test_a_signal_to_the_supervisor_is_an_orderly_stop(start: Launch, tmp_path: Path, number: int) -> None:
    note = tmp_path / "note"
    text = f"""
        import time
        try: print("up", flush=True); time.sleep(1000)
        except KeyboardInterrupt: open({str(note)!r}, "w").write("orderly")
    """
    client = await start({"node": {"exec": script(text)}})
    await said(client, "node", "up")
    kill(client.session.supervisor_pid, number)
    events = [event async for event in client.events()]
    assert isinstance(events[-1], ClosedEvent)
    assert events[-1].reason == f"{signal.Signals(number).name} received"
    assert note.read_text() == "orderly"


async def test_a_second_signal_skips_the_waiting(start: Launch) -> None:
    stubborn = DEAF + "signal.signal(signal.SIGTERM, signal.SIG_IGN); "
    run = {"exec": script(stubborn + "print('up'); time.sleep(1000)")}
    # One after the other, each would be waited for 10 s: a minute in all.
    names = [f"deaf_{number}" for number in range(6)]
    needs = [[], *([name] for name in names)]
    client = await start({name: {**run, "needs": need} for name, need in zip(names, needs, strict=False)})
    for name in names:
        await said(client, name, "up")
    kill(client.session.supervisor_pid, signal.SIGINT)
    await until_state(client, names[-1], NodeState.STOPPING)
    kill(client.session.supervisor_pid, signal.SIGINT)
    await all_gone(client.session.run_id)


async def test_the_death_of_the_spawn_server_harms_nobody(start: Launch) -> None:
    client = await start({"node": {"exec": SLEEPER}, "other": {"exec": SLEEPER}})
    pid = await running_pid(client, "node")
    before = await running_pid(client, "other")
    server = await spawn_server_of(client.session.run_id)
    kill(server, signal.SIGKILL)
    assert "ended" in await said(client, "deck", f"the spawn server (pid {server})")
    assert await running_pid(client, "node") == pid
    await client.restart("other")
    # It may have been started again before anybody looks.
    await until(lambda: client.nodes["other"].pid not in (None, before), "its next process")
    await running_pid(client, "other")


async def test_a_guardian_that_is_killed_is_told_of_and_ends_nothing(start: Launch) -> None:
    client = await start({"node": {"exec": SLEEPER}})
    assert not client.unguarded
    pid = await running_pid(client, "node")
    guardian = guardian_of(client.session.supervisor_pid)
    assert command_line(guardian) == "deck: guardian"
    kill(guardian, signal.SIGTERM)
    kill(guardian, signal.SIGKILL)
    await said(client, "deck", f"the guardian (pid {guardian}) ended")
    await until(lambda: client.unguarded, "the word for the screen")
    another = await attach(client.session.run_id)
    assert another.unguarded, "who comes later is told, too"
    await another.aclose()
    assert await running_pid(client, "node") == pid


def guardian_of(supervisor: int) -> int:
    process = read_process(supervisor)
    assert process is not None
    return process.parent


async def test_what_an_earlier_run_left_is_told_of_and_ended_on_demand(start: Launch) -> None:
    """Supervisor, spawn server and guardian killed together: a child of the node is left."""
    client = await start({"deaf": {"exec": script(DEAF_FAMILY)}}, name="earlier")
    run_id = client.session.run_id
    await until(lambda: len(of_run(run_id)) == 4, "the deaf node and its children")
    supervisor = client.session.supervisor_pid
    every = (guardian_of(supervisor), await spawn_server_of(run_id), supervisor)
    for number in (signal.SIGSTOP, signal.SIGKILL):
        for pid in every:
            kill(pid, number)
    # The node itself dies with the supervisor, though on a busy machine not at the same moment.
    await until(lambda: len(of_run(run_id)) == 2, "the end of all but the node's children")
    left = {each.pid for each in of_run(run_id)}

    later = await start({"node": {"exec": SLEEPER}}, name="later")

    def ours() -> list[Stray]:
        """Not those that another run of the tests may have left."""
        return [stray for stray in later.strays if stray.run_id == run_id]

    await until(lambda: {stray.pid for stray in ours()} == left, "the strays")
    assert {stray.node for stray in ours()} == {"deaf"}
    assert left <= {each.pid for each in of_run(run_id)}, "they are ended only on demand"
    await later.stop_strays(ours())
    assert of_run(run_id) == []
    await until(lambda: not ours(), "the word that nothing is left")


@pytest.mark.machine("namespaces")
def test_a_robot_in_a_container_is_alive_though_its_supervisor_has_another_pid_in_there(
    tmp_path: Path, ros_domain: int
) -> None:
    """Its own run directory and processes, as in Docker; the same user, seen from outside."""
    profile = write_profile(tmp_path, {"node": {"exec": SLEEPER}})
    told = f"{sys.executable} -m tests.ros.owner {profile} {ros_domain} foreground"
    container = ("unshare", "--map-root-user", "--pid", "--kill-child", "--mount-proc")
    with subprocess.Popen(
        [*container, "env", f"XDG_RUNTIME_DIR={tmp_path}", *told.split()], stdout=subprocess.PIPE
    ) as robot:
        try:
            assert robot.stdout is not None
            run_id = json.loads(robot.stdout.readline())["session"]["run_id"]
            assert of_run(run_id), "they are seen from out here"
            assert not [stray for stray in find_strays() if stray.run_id == run_id]
            found = [one.domain for one in supervisors_everywhere() if one.run_id == run_id]
            assert found == [ros_domain]
            assert run_id not in [one.run_id for one in supervisors()], "nothing can be sent to it"
        finally:
            robot.kill()
