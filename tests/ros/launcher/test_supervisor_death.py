"""Whoever dies, no node is left that nobody knows of; and what should live on, lives on."""

from __future__ import annotations

import asyncio
import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from launcher.client.client import attach, running
from launcher.client.start import StartingSupervisor
from launcher.events import ClosedEvent
from launcher.processes.table import (
    NODE_MARK,
    RUN_MARK,
    command_line,
    processes,
    read_marks,
    read_process,
)
from launcher.runs.strays import find_strays
from launcher.status import NodeState, Stray
from tests.ros.supervised import (
    DEAF,
    SLEEPER,
    Launch,
    alive,
    end_sessions,
    kill,
    running_pid,
    said,
    script,
    until_state,
    write_profile,
)
from tests.waiting import until
from text.run_path import OWN_RUN_DIR

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


def of_run(run_id: str) -> list[int]:
    """Every process of a run, its spawn server too."""
    return [
        process.pid
        for process in processes()
        if not process.zombie and (read_marks(process.pid) or {}).get(RUN_MARK) == run_id
    ]


async def all_gone(run_id: str) -> None:
    """Wait until a run has no process left."""
    await until(lambda: not of_run(run_id), "the end of every process of the run", GONE_WITHIN_S)


def spawn_servers_of(run_id: str) -> list[int]:
    return [
        pid for pid in of_run(run_id) if (read_marks(pid) or {}).get(NODE_MARK, "").startswith("--")
    ]


async def spawn_server_of(run_id: str) -> int:
    (pid,) = await until(
        lambda: len(servers := spawn_servers_of(run_id)) == 1 and servers, "one spawn server"
    )
    return int(pid)


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
    client = await start(
        {"deaf": {"exec": script(DEAF_FAMILY)}, "other": {"exec": SLEEPER, "restart": "always"}}
    )
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
async def test_a_signal_to_the_supervisor_is_an_orderly_stop(
    start: Launch, tmp_path: Path, number: int
) -> None:
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
    client = await start(
        {name: {**run, "needs": need} for name, need in zip(names, needs, strict=False)}
    )
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


async def test_a_start_that_a_spawn_server_dies_over_is_not_lost(
    start: Launch, tmp_path: Path
) -> None:
    (tmp_path / "plain_module.py").write_text("print('running'); import time; time.sleep(1000)")
    client = await start({"node": {"run": "./plain_module.py", "ready": {"topic": "/never"}}})
    # It is still importing what warm nodes need; the request waits.
    kill(await spawn_server_of(client.session.run_id), signal.SIGKILL)
    await said(client, "node", "running")
    starts = [line for line in await client.history("node", 99) if "started" in line.text]
    assert len(starts) == 1


async def test_a_new_spawn_server_is_an_undertaker_too(start: Launch) -> None:
    client = await start({"deaf": {"exec": script(DEAF_FAMILY)}})
    run_id = client.session.run_id
    await until(lambda: len(of_run(run_id)) == 4, "the deaf node and its children")
    kill(await spawn_server_of(run_id), signal.SIGKILL)
    await said(client, "deck", "the spawn server")
    kill(client.session.supervisor_pid, signal.SIGKILL)
    await all_gone(run_id)


UNMARKED_DAEMON = """
    import os, time
    if os.fork() == 0:
        os.setsid()
        if os.fork(): os._exit(0)
        command = "trap '' INT TERM; echo daemon $$; while :; do sleep 1; done"
        os.execve("/bin/sh", ["sh", "-c", command], {"PATH": os.environ["PATH"]})
    time.sleep(1000)
"""


async def test_a_daemon_without_a_mark_does_not_outlive_a_killed_supervisor(start: Launch) -> None:
    """In a session of its own, nobody's child, with an empty environment, deaf to signals."""
    client = await start({"node": {"exec": script(UNMARKED_DAEMON)}})
    daemon = int(await said(client, "node", "daemon"))
    kill(client.session.supervisor_pid, signal.SIGKILL)
    await until(lambda: not alive(daemon), "the end of the daemon", GONE_WITHIN_S)
    await all_gone(client.session.run_id)


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


async def test_a_guardian_ends_with_its_supervisor(start: Launch) -> None:
    client = await start({"node": {"exec": SLEEPER}})
    guardian = guardian_of(client.session.supervisor_pid)
    await client.shutdown()
    await until(lambda: not alive(guardian), "its end")


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
    left = set(of_run(run_id))

    later = await start({"node": {"exec": SLEEPER}}, name="later")

    def ours() -> list[Stray]:
        """Not those that another run of the tests may have left."""
        return [stray for stray in later.strays if stray.run_id == run_id]

    await until(lambda: {stray.pid for stray in ours()} == left, "the strays")
    assert {stray.node for stray in ours()} == {"deaf"}
    assert left <= set(of_run(run_id)), "they are ended only on demand"
    await later.stop_strays(ours())
    assert of_run(run_id) == []
    await until(lambda: not ours(), "the word that nothing is left")


async def test_a_process_that_has_the_number_of_a_stray_is_left_alone(start: Launch) -> None:
    from launcher.status import Stray

    client = await start({"node": {"exec": SLEEPER}})
    bystander = await asyncio.create_subprocess_exec("sleep", "1000")
    started = time.time() - 1000
    await client.stop_strays([Stray(bystander.pid, started, "node", "sleep", "20200101-1-1")])
    assert alive(bystander.pid)
    bystander.kill()
    await bystander.wait()


async def test_a_running_session_has_no_strays(start: Launch) -> None:
    one = await start({"one": {"exec": SLEEPER}}, name="one")
    await running_pid(one, "one")
    two = await start({"two": {"exec": SLEEPER}}, name="two")
    await running_pid(two, "two")
    ours = {one.session.run_id, two.session.run_id}
    assert not [stray for stray in two.strays if stray.run_id in ours]
    # By the second in which they began, which may be the same.
    assert sorted(session.name for session in running()) == ["one", "two"]


def test_strays_of_runs_that_are_kept_apart_are_nobody_elses(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(RUN_MARK, "20200101-1-1")
    with subprocess.Popen(["sleep", "1000"]) as left:
        try:
            assert [stray.pid for stray in find_strays(tmp_path)] == [left.pid]
            monkeypatch.setenv(OWN_RUN_DIR, str(tmp_path / "another"))
            assert find_strays(tmp_path) == ()
        finally:
            left.kill()


async def test_one_that_dies_before_it_is_given_a_plan_is_not_given_one() -> None:
    """Its guardian, the process that was started, lives a moment longer."""
    with StartingSupervisor() as starting:
        guardian = starting._process.pid

        def supervisor() -> int | None:
            return next((one.pid for one in processes() if one.parent == guardian), None)

        pid = await until(supervisor, "a supervisor")
        place = Path(f"/proc/{guardian}/cwd")
        await until(lambda: str(place.readlink()) == "/", "a guardian at work")
        assert starting.waits
        kill(guardian, signal.SIGSTOP)
        kill(pid, signal.SIGKILL)
        await until(lambda: not starting.waits, "no supervisor")
        assert alive(guardian)
        kill(guardian, signal.SIGCONT)
