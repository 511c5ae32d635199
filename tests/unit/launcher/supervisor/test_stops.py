"""How a node is stopped: never undone, in stages, and with all that it started."""

from __future__ import annotations

import asyncio
import signal
from dataclasses import replace

import pytest

from launcher.status import NodeState, Severity
from tests.unit.launcher.supervisor.fake_session import (
    PLAN,
    FakeProcess,
    FakeSession,
    crash,
    started,
)
from tests.unit.manual_clock import settle


@pytest.mark.parametrize("restart", ["on-failure", "always"])
async def test_a_stop_by_hand_is_never_undone(session: FakeSession, restart: str) -> None:
    node = await started(session, replace(PLAN, restart=restart))
    await node.stop()
    assert (node.state, node.detail) == (NodeState.EXITED, "stopped by SIGINT")
    await session.clock.advance(300)
    assert len(session.started) == 1


async def test_a_stop_during_the_wait_for_the_next_try_is_never_undone(
    session: FakeSession,
) -> None:
    node = await started(session)
    await crash(session)
    await node.stop()
    await session.clock.advance(300)
    assert (node.state, len(session.started)) == (NodeState.EXITED, 1)


async def test_a_restart_while_one_is_pending_does_not_start_two(session: FakeSession) -> None:
    node = await started(session)
    await crash(session)
    node.restart()
    node.restart()
    await session.clock.advance(300)
    assert (node.state, len(session.started)) == (NodeState.RUNNING, 2)


async def test_restarts_while_it_stops_start_one(session: FakeSession) -> None:
    session.ends_by = set()
    node = await started(session)
    node.restart()
    await settle()
    assert node.state is NodeState.STOPPING
    node.restart()
    node.start()
    await session.clock.advance(60)
    assert (node.state, len(session.started)) == (NodeState.RUNNING, 2)


async def test_a_start_while_it_stops_waits_for_the_end(session: FakeSession) -> None:
    session.ends_by = {signal.SIGTERM}
    node = await started(session)
    stopping = asyncio.ensure_future(node.stop())
    await settle()
    node.start()
    await settle()
    assert (node.state, len(session.started)) == (NodeState.STOPPING, 1)
    await session.clock.advance(5.1)
    assert (node.state, len(session.started)) == (NodeState.RUNNING, 2)
    stopping.cancel()


async def test_a_stop_after_a_restart_counts(session: FakeSession) -> None:
    session.ends_by = {signal.SIGTERM}
    node = await started(session)
    node.restart()
    await settle()
    stopping = asyncio.ensure_future(node.stop())
    await session.clock.advance(60)
    await stopping
    assert (node.state, len(session.started)) == (NodeState.EXITED, 1)


def signals_of(process: FakeProcess) -> list[int]:
    heard = [number for pid, number in process.heard if pid == process.pid]
    return list(dict.fromkeys(heard))


async def test_a_stop_has_three_stages_of_five_seconds(session: FakeSession) -> None:
    session.ends_by = set()
    node = await started(session)
    stopping = asyncio.ensure_future(node.stop())
    await session.clock.advance(4.9)
    assert signals_of(session.process) == [signal.SIGINT]
    assert node.detail == "SIGINT sent, waiting for 100 (fake)"
    await session.clock.advance(0.2)
    assert signals_of(session.process) == [signal.SIGINT, signal.SIGTERM]
    await session.clock.advance(5)
    assert signals_of(session.process) == [signal.SIGINT, signal.SIGTERM, signal.SIGKILL]
    await stopping
    assert node.detail == "stopped by SIGKILL"


async def test_asking_in_a_hurry_skips_the_waiting(session: FakeSession) -> None:
    session.ends_by = set()
    node = await started(session)
    stopping = asyncio.ensure_future(node.stop())
    await session.clock.advance(1)
    hurrying = asyncio.ensure_future(node.stop(now=True))
    await session.clock.advance(1)
    await asyncio.gather(stopping, hurrying)
    assert node.state is NodeState.EXITED


async def test_a_stop_is_not_over_when_only_the_leader_has_ended(session: FakeSession) -> None:
    session.grandchild_ends_by = {signal.SIGTERM}
    node = await started(session)
    stopping = asyncio.ensure_future(node.stop())
    await session.clock.advance(3)
    assert (node.state, node.detail) == (
        NodeState.STOPPING,
        "SIGINT sent, waiting for 101 (fake)",
    )
    await session.clock.advance(2.3)
    await stopping
    assert (node.state, session.process.left()) == (NodeState.EXITED, [])


async def test_what_a_crashed_node_leaves_is_stopped_before_it_returns(
    session: FakeSession,
) -> None:
    session.grandchild_ends_by = {signal.SIGTERM}
    node = await started(session)
    await crash(session)
    assert (node.state, node.detail) == (NodeState.STOPPING, "it ended and left 101 (fake) running")
    await session.clock.advance(4.9)
    assert (node.state, len(session.started)) == (NodeState.STOPPING, 1)
    await session.clock.advance(0.3)
    assert node.state is NodeState.BACKOFF
    await session.clock.advance(1)
    assert (node.state, len(session.started)) == (NodeState.RUNNING, 2)


async def test_who_outlives_sigkill_is_named_and_not_called_stopped(session: FakeSession) -> None:
    """A process that is stuck in the kernel: the stop comes back, the node is still stopping."""
    session.ends_by = set()
    node = await started(session)
    session.process.immortal = True
    stopping = asyncio.ensure_future(node.stop())
    await session.clock.advance(14)
    assert not stopping.done()
    await session.clock.advance(2)
    await stopping
    assert [process.pid for process in node.outlived] == [100]
    assert (node.state, node.detail) == (
        NodeState.STOPPING,
        "still running after SIGKILL: 100 (fake)",
    )
    assert session.gravest is Severity.ERROR
    # It is killed as soon as that is possible, and only then has it stopped.
    session.process.immortal = False
    await session.clock.advance(1)
    assert (node.state, node.outlived) == (NodeState.EXITED, ())


async def test_an_end_of_which_nobody_tells_is_looked_up_and_not_waited_for(
    session: FakeSession,
) -> None:
    node = await started(session)
    session.process.told = False
    stopping = asyncio.ensure_future(node.stop())
    await session.clock.advance(5)
    await stopping
    assert (node.state, session.process.closed) == (NodeState.EXITED, True)
    assert session.process.looked > 0
    assert "gone, nobody saw how it ended" in session.lines
