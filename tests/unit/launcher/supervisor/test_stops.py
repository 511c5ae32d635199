"""Stops, restarts and their order."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import AsyncIterator
from pathlib import Path

import pytest

from launcher.profile.node import Node
from launcher.status import NodeState, Severity
from launcher.supervisor.own_files import OwnFiles
from launcher.supervisor.plan import plan_of, stop_waves, with_needs
from launcher.supervisor.restart_policy import (
    CRASH_WINDOW_S,
    LAST_DELAY_S,
    MAX_CRASHES,
    STABLE_S,
    Again,
    GivenUp,
    RestartPolicy,
)
from tests.unit.launcher.supervisor.fake_session import FakeProcess, FakeSession, crash, planned, started
from tests.unit.manual_clock import settle
from tests.unit.profile_files import loaded
from tests.waiting import until


@pytest.mark.parametrize("restart", ["on-failure", "always"])
async def test_a_stop_by_hand_is_never_undone(session: FakeSession, restart: str) -> None:
    node = await started(session, planned(restart=restart))
    await node.stop()
    assert (node.state, node.detail) == (NodeState.EXITED, "stopped by SIGINT")
    await session.clock.advance(300)
    assert len(session.started) == 1


async def test_a_stop_during_the_wait_for_the_next_try_is_never_undone(session: FakeSession) -> None:
    node = await started(session)
    await crash(session)
    await node.stop()
    await session.clock.advance(300)
    assert (node.state, len(session.started)) == (NodeState.EXITED, 1)


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
    assert (node.state, node.detail) == (NodeState.STOPPING, "SIGINT sent, waiting for 101 (fake)")
    await session.clock.advance(2.3)
    await stopping
    assert (node.state, session.process.left()) == (NodeState.EXITED, [])


async def test_what_a_crashed_node_leaves_is_stopped_before_it_returns(session: FakeSession) -> None:
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
    assert (node.state, node.detail) == (NodeState.STOPPING, "still running after SIGKILL: 100 (fake)")
    assert session.gravest is Severity.ERROR
    # It is killed as soon as that is possible, and only then has it stopped.
    session.process.immortal = False
    await session.clock.advance(1)
    assert (node.state, node.outlived) == (NodeState.EXITED, ())


async def test_an_end_of_which_nobody_tells_is_looked_up_and_not_waited_for(session: FakeSession) -> None:
    node = await started(session)
    session.process.told = False
    stopping = asyncio.ensure_future(node.stop())
    await session.clock.advance(5)
    await stopping
    assert (node.state, session.process.closed) == (NodeState.EXITED, True)
    assert session.process.looked > 0
    assert "gone, nobody saw how it ended" in session.lines


@pytest.mark.parametrize(
    ("kind", "clean", "verdict"),
    [
        ("never", True, None),
        ("never", False, GivenUp(1)),
        ("on-failure", True, None),
        ("on-failure", False, Again(1.0)),
        ("always", True, Again(1.0)),
        ("always", False, Again(1.0)),
    ],
)
def test_the_first_end(kind: str, clean: bool, verdict: object) -> None:
    assert RestartPolicy(kind).after(clean=clean, lasted_s=0.1, now=0.0) == verdict


def test_the_delay_doubles_up_to_its_bound() -> None:
    policy = RestartPolicy("on-failure")
    now = 0.0
    delays = []
    for _crash in range(8):
        verdict = policy.after(clean=False, lasted_s=STABLE_S - 1, now=now)
        assert isinstance(verdict, Again)
        delays.append(verdict.delay_s)
        now += CRASH_WINDOW_S
    assert delays == [1, 2, 4, 8, 16, LAST_DELAY_S, LAST_DELAY_S, LAST_DELAY_S]


def test_a_crash_loop_is_given_up() -> None:
    policy = RestartPolicy("on-failure")
    now = 0.0
    for _crash in range(MAX_CRASHES - 1):
        verdict = policy.after(clean=False, lasted_s=0.0, now=now)
        assert isinstance(verdict, Again)
        now += verdict.delay_s
    assert policy.after(clean=False, lasted_s=0.0, now=now) == GivenUp(MAX_CRASHES, now)


def test_a_node_that_ran_well_for_a_while_begins_anew() -> None:
    policy = RestartPolicy("on-failure")
    for number in range(MAX_CRASHES - 1):
        policy.after(clean=False, lasted_s=0.0, now=float(number))
    assert policy.after(clean=False, lasted_s=STABLE_S, now=40.0) == Again(1.0)


NEEDS = {"sonar": (), "camera": (), "safety": ("sonar",), "drive": ("safety",), "brain": ("camera", "drive")}


def test_what_a_node_needs_comes_before_it() -> None:
    assert with_needs(["brain"], NEEDS) == ["camera", "sonar", "safety", "drive", "brain"]
    assert with_needs(["safety", "sonar"], NEEDS) == ["sonar", "safety"]


def test_dependants_are_stopped_first() -> None:
    waves = stop_waves(NEEDS, NEEDS)
    assert waves == [["brain"], ["camera", "drive"], ["safety"], ["sonar"]]


def test_a_node_between_two_that_stay_does_not_matter() -> None:
    assert stop_waves(["sonar", "drive"], NEEDS) == [["drive"], ["sonar"]]
    assert stop_waves(["camera", "sonar"], NEEDS) == [["camera", "sonar"]]
    assert stop_waves([], NEEDS) == []


PROFILE = """
title: {en: Mixed}
nodes:
  sonar: {run: nodes.mock_sonar}
  cold: {run: nodes.mock_sonar, warm: false}
  mine: {run: ./talker.py}
  program: {exec: [python3, ./talker.py]}
  other: {exec: [sleep, "100"]}
"""


def of_profile(folder: Path) -> dict[str, Node]:
    (folder / "talker.py").write_text("")
    profile = loaded(folder, PROFILE, domain=1)
    plan = plan_of(profile, run_dir="", log_dir="", foreground=True, node_lang="")
    return {node.name: node for node in plan.nodes}


def test_only_modules_of_deck_are_its_own(tmp_path: Path) -> None:
    ours = {name for name, node in of_profile(tmp_path).items() if node.is_ours}
    assert ours == {"sonar", "cold"}


class Watched:
    """The file of one node, watched."""

    def __init__(self, file: Path) -> None:
        self.saves: list[str] = []
        self.files = OwnFiles(lambda: {"own": str(file)}, lambda node, _: self.saves.append(node))
        self._tasks: list[asyncio.Task[None]] = []

    def begin(self) -> None:
        self._tasks.append(asyncio.create_task(self.files.watch()))

    async def end(self) -> None:
        for task in self._tasks:
            task.cancel()
        await asyncio.wait(self._tasks)


@pytest.fixture
async def watched(tmp_path: Path) -> AsyncIterator[Watched]:
    (tmp_path / "beside.py").write_text("number = 1\n")
    (tmp_path / "own.py").write_text("import beside\n")
    watched = Watched(tmp_path / "own.py")
    yield watched
    await watched.end()


@pytest.mark.parametrize("saved", ["own.py", "beside.py"])
async def test_what_is_saved_after_the_start_and_before_the_watch_counts(
    watched: Watched, tmp_path: Path, saved: str
) -> None:
    watched.files.note("own", str(tmp_path / "own.py"))
    (tmp_path / saved).write_text("import beside  # saved\n")
    watched.begin()
    await until(lambda: watched.saves, "the save is told")
    # Told once: the next one is of another save.
    watched.files.look_again()
    (tmp_path / "own.py").write_text("import beside  # saved again\n")
    await until(lambda: len(watched.saves) > 1, "the next save is told")
    assert watched.saves == ["own", "own"]
