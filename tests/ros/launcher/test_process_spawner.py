"""The supervisor's way to processes, with real spawn servers that hang or die."""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import AsyncIterator, Callable, Iterator
from pathlib import Path

import pytest

from launcher.processes.prctl import become_subreaper
from launcher.processes.signal import lives, send
from launcher.processes.table import RUN_MARK, Process, processes, read_marks, read_process
from launcher.spawn_server.preload import IDLE_AFTER_S
from launcher.spawn_server.spawner import SpawnedProcess, Spawner, SpawnError, SpawnRequest
from launcher.spawn_server.start import start_spawn_server
from tests.waiting import until

Make = Callable[..., Spawner]

SLEEP = SpawnRequest("exec", "node", "deck: node", ("sleep", "1000"), "/")


@pytest.fixture
def run_id(tmp_path_factory: pytest.TempPathFactory) -> str:
    return f"test-{tmp_path_factory.getbasetemp().name}-{os.getpid()}"


@pytest.fixture
def nowhere() -> Iterator[tuple[int, int]]:
    fd = os.open(os.devnull, os.O_WRONLY)
    yield fd, fd
    os.close(fd)


@pytest.fixture
async def make(run_id: str) -> AsyncIterator[Make]:
    """Make spawners; what they have started ends with the test."""
    become_subreaper()
    made: list[Spawner] = []

    def begin(told: list[str], answer_within_s: float = 20.0, *, warm: bool = False) -> Spawner:
        server = start_spawn_server(run_id, warm=warm)
        made.append(Spawner(run_id, server, told.append, answer_within_s))
        return made[-1]

    yield begin
    for spawner in made:
        spawner.close()
    for process in of_run(run_id):
        send(process, signal.SIGKILL)
    await until(lambda: not of_run(run_id), "the end of all that was started")
    become_subreaper(False)


def of_run(run_id: str) -> list[Process]:
    return [
        process
        for process in processes()
        if not process.zombie and (read_marks(process.pid) or {}).get(RUN_MARK) == run_id
    ]


def stop(pid: int | None) -> None:
    assert pid is not None
    os.kill(pid, signal.SIGSTOP)


async def test_what_is_started_is_known_by_its_start_too(
    make: Make, nowhere: tuple[int, int]
) -> None:
    spawned = await make([]).spawn(SLEEP, nowhere)
    process = read_process(spawned.pid)
    assert process is not None
    assert spawned == SpawnedProcess(process.pid, process.started_ticks)


async def test_a_spawn_server_that_does_not_answer_is_replaced(
    make: Make, nowhere: tuple[int, int]
) -> None:
    told: list[str] = []
    spawner = make(told, 2.0)
    await spawner.spawn(SLEEP, nowhere)
    hung = spawner.server_pid
    stop(hung)
    spawned = await asyncio.wait_for(spawner.spawn(SLEEP, nowhere), 60)
    assert lives(spawned)
    assert spawner.server_pid not in (hung, None)
    (words,) = told
    assert words.startswith(
        f"the spawn server (pid {hung}) did not answer within 2 s and was killed"
    )


async def test_two_that_do_not_answer_are_a_reason(
    make: Make, nowhere: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []

    def start_a_stopped_one(run_id: str, *, warm: bool) -> object:
        server = start_spawn_server(run_id, warm=warm)
        stop(server.pid)
        return server

    monkeypatch.setattr("launcher.spawn_server.spawner.start_spawn_server", start_a_stopped_one)
    spawner = make(told, 0.5)
    stop(spawner.server_pid)
    with pytest.raises(SpawnError, match="the spawn server does not answer"):
        await asyncio.wait_for(spawner.spawn(SLEEP, nowhere), 60)
    assert len(told) == 2


async def test_a_process_that_nobody_waits_for_any_more_is_ended(
    make: Make, nowhere: tuple[int, int], run_id: str
) -> None:
    spawner = make([])
    await spawner.spawn(SLEEP, nowhere)
    server = spawner.server_pid
    stop(server)
    with pytest.raises(asyncio.TimeoutError):
        await asyncio.wait_for(spawner.spawn(SLEEP, nowhere), 0.05)
    assert server is not None
    os.kill(server, signal.SIGCONT)
    # Answers come in order: with this one, that of the other has come.
    await spawner.spawn(SLEEP, nowhere)
    await until(lambda: len(of_run(run_id)) == 3, "the spawn server and the two that are known")


async def test_a_full_queue_keeps_nobody_waiting(make: Make, nowhere: tuple[int, int]) -> None:
    spawner = make([])
    spawned = await spawner.spawn(SLEEP, nowhere)
    stop(spawner.server_pid)
    for _ in range(400):
        spawner.preload(["x" * 1000])
    spawner.forget(spawned.pid)


async def test_a_spawn_server_that_dies_at_once_is_replaced(
    make: Make, nowhere: tuple[int, int]
) -> None:
    told: list[str] = []
    spawner = make(told, warm=True)
    dead = spawner.server_pid
    assert dead is not None
    os.kill(dead, signal.SIGKILL)
    await until(lambda: (found := read_process(dead)) is None or found.zombie, "its end")
    spawner.preload(["nodes"])
    assert lives(await spawner.spawn(SLEEP, nowhere))
    assert told == [f"the spawn server (pid {dead}) ended; a new one takes over"]


async def test_where_no_spawn_server_can_be_started_it_is_said(
    make: Make, nowhere: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    spawner = make(told)
    await spawner.spawn(SLEEP, nowhere)

    def refuse(*_: object, **_kinds: object) -> object:
        raise BlockingIOError(11, "Resource temporarily unavailable")

    with monkeypatch.context() as patch:
        patch.setattr("launcher.spawn_server.spawner.start_spawn_server", refuse)
        assert spawner.server_pid is not None
        os.kill(spawner.server_pid, signal.SIGKILL)
        await until(lambda: spawner.server_pid is None, "its end")
        with pytest.raises(SpawnError, match="there is no spawn server"):
            await spawner.spawn(SLEEP, nowhere)
    assert "no spawn server can be started: Resource temporarily unavailable" in told
    assert lives(await spawner.spawn(SLEEP, nowhere))


async def test_what_some_nodes_need_is_imported_while_nobody_waits(
    make: Make, tmp_path: Path
) -> None:
    told: list[str] = []
    spawner = make(told, warm=True)
    spawner.preload(["nodes"])
    tell = tmp_path / "tell.py"
    tell.write_text("import sys\nprint('nodes.safety.gate' in sys.modules)\n")
    out = tmp_path / "out"

    async def has_it() -> bool:
        with out.open("wb") as file:
            request = SpawnRequest("module", "tell", "deck: tell", (str(tell),), str(tmp_path))
            await spawner.spawn(request, (file.fileno(), file.fileno()))
        await until(lambda: out.read_text().endswith("\n"), "its word")
        return out.read_text() == "True\n"

    # Whoever asks without a pause leaves no time for it.
    await until(has_it, "a module loaded beforehand", within_s=55, every_s=2 * IDLE_AFTER_S)
    assert told == []
