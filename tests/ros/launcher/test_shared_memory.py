"""What killed processes leave in /dev/shm does not hold up those that are started after them."""

from __future__ import annotations

import asyncio
import signal
import sys
from typing import TYPE_CHECKING

import pytest

from launcher.processes.shared_memory import held_segments, port_numbers
from launcher.status import NodeState
from tests.ros.peer import ROOT
from tests.ros.supervised import Launch, kill, until_state
from tests.shared_memory_port import ports_of
from tests.unfinished_shared_memory import make_old
from tests.waiting import until

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.nightly

NODE = {"node": {"run": "nodes.hello"}}


async def test_nodes_start_where_a_process_was_killed_as_it_joined(
    unfinished: list[Path], start: Launch
) -> None:
    make_old(unfinished)
    client = await start(NODE)
    await until_state(client, "node", NodeState.READY)


@pytest.mark.usefixtures("unfinished")
async def test_nodes_that_a_killed_process_holds_up_are_let_go(start: Launch) -> None:
    """The files are young when the nodes start: they may yet be finished, and are waited for."""
    client = await start(NODE)
    await until_state(client, "node", NodeState.READY)


@pytest.mark.parametrize("killed", ["node", "supervisor"])
async def test_a_node_that_dies_with_a_message_in_hand_holds_up_nobody(
    start: Launch, killed: str
) -> None:
    """Whoever sends to it next would try for ever to take its mark away."""
    client = await start({"node": {**NODE["node"], "restart": "never"}})
    pid = (await until_state(client, "node", NodeState.READY)).pid
    assert pid is not None
    # Not to be finished with this message.
    kill(pid, signal.SIGSTOP)
    ports = ports_of(pid)
    assert ports
    for port in ports:
        port.take_in_hand()
    kill(pid if killed == "node" else client.session.supervisor_pid, signal.SIGKILL)
    await until(lambda: not any(port.in_hand for port in ports), "the ports without a mark")


DIE_WITH_THE_LOCKS = """
import os, signal, sys
from tests.shared_memory_port import SharedMemoryPort
for number in sys.argv[1:]:
    SharedMemoryPort(int(number)).lock()
os.kill(os.getpid(), signal.SIGKILL)
"""


async def test_a_lock_of_a_node_that_anybody_dies_with_is_opened(start: Launch) -> None:
    """The node would make its port anew, and die if it ends meanwhile."""
    client = await start(NODE)
    pid = (await until_state(client, "node", NodeState.READY)).pid
    assert pid is not None
    # Not to give up before, however slow this machine is.
    kill(pid, signal.SIGSTOP)
    try:
        ports = ports_of(pid)
        numbers = map(str, port_numbers(held_segments(pid)))
        holder = await asyncio.create_subprocess_exec(
            sys.executable, "-c", DIE_WITH_THE_LOCKS, *numbers, cwd=ROOT
        )
        assert await holder.wait() == -signal.SIGKILL
        await until(lambda: not any(port.is_locked for port in ports), "the locks open")
    finally:
        kill(pid, signal.SIGCONT)
