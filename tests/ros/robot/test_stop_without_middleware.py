"""The emergency stop by the supervisor's socket: obeyed by nodes that hear nobody."""

from __future__ import annotations

import json
import os
import signal
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from launcher.client.stop_road import StopRoad
from launcher.control.socket import connect
from launcher.rundir import run_dir
from launcher.wire import VERSION, encode
from safety.stop_file import StopFile
from tests.ros.node_process import NodeProcess
from tests.ros.supervised import SLEEPER, Launch, running_pid
from tests.waiting import until, wait_until
from tui.session.watching import StopRoads

if TYPE_CHECKING:
    from launcher.client.client import SupervisorClient

ALONE = ("--ros-args", "-r", "/emergency_stop:=/nobody", "-r", "/emergency_stop_state:=/no_state")


@pytest.fixture
async def session(start: Launch) -> SupervisorClient:
    return await start({"node": {"exec": SLEEPER}})


def place(domain: int) -> Path:
    return Path(os.environ["DECK_STATE_DIR"], "stops", str(domain))


async def test_the_screens_road_stops_and_releases_nodes_that_hear_nobody(
    session: SupervisorClient, ros_domain: int
) -> None:
    with NodeProcess("nodes.electronic_differential", ros_domain, arguments=ALONE) as node:
        node.wait_for_words("listens to")
        # From a thread of its own, as the screen's input has one.
        threading.Thread(target=session.emergency_stop, args=(True, time.time_ns())).start()
        await until(lambda: "EMERGENCY STOP" in node.output, "the stop")
        saved = StopFile(ros_domain, "/test").read().stop
        assert saved is not None
        assert saved.by == "screen"
        session.emergency_stop(False, time.time_ns())
        await until(lambda: "is released" in node.output, "the release")
        await until(lambda: not place(ros_domain).exists(), "the file gone")


async def test_stop_and_release_are_carried_in_their_order(session: SupervisorClient, ros_domain: int) -> None:
    for _ in range(20):
        session.emergency_stop(True, time.time_ns())
        session.emergency_stop(False, time.time_ns())
    session.emergency_stop(True, time.time_ns())
    session.emergency_stop(True, time.time_ns())
    await until(lambda: not session.emergency_stop.is_busy, "the end of it")
    assert StopFile(ros_domain, "/test").read().record.engaged


async def test_where_the_supervisor_hangs_the_screen_writes_the_file(
    session: SupervisorClient, ros_domain: int
) -> None:
    pid = session.session.supervisor_pid
    os.kill(pid, signal.SIGSTOP)
    try:
        session.emergency_stop(True, time.time_ns())
        await until(place(ros_domain).exists, "the stop on disk")
    finally:
        os.kill(pid, signal.SIGCONT)


async def test_a_screen_that_only_watches_takes_the_same_road(
    session: SupervisorClient, ros_domain: int, other_domain: int
) -> None:
    del session
    StopRoads(other_domain)(True, time.time_ns())
    roads = StopRoads(ros_domain)
    roads(True, time.time_ns())
    await until(place(ros_domain).exists, "the stop on disk")
    for _ in range(5):
        roads(True, time.time_ns())
        roads(False, time.time_ns())
    await until(lambda: not place(ros_domain).exists(), "the release")
    assert not place(other_domain).exists()


def test_a_session_that_is_gone_is_stopped_on_disk_too(tmp_path: Path, ros_domain: int) -> None:
    StopRoad(tmp_path, ros_domain)(True, time.time_ns())
    wait_until(place(ros_domain).exists, "the stop on disk")


@pytest.mark.parametrize("said_ns", ["now", -1, 0, 1.5, 2**70, None])
async def test_a_time_that_makes_no_sense_is_refused(
    session: SupervisorClient, ros_domain: int, said_ns: object
) -> None:
    (folder,) = [path.parent for path in run_dir().glob("*/control.sock")]
    with connect(folder) as connection:
        connection.settimeout(20)
        request = {"id": 7, "op": "emergency_stop", "said_ns": said_ns}
        connection.sendall(encode({"deck": VERSION}) + encode(request))
        with connection.makefile("rb") as lines:
            reply = next(found for line in lines if "reply" in (found := json.loads(line)))
    assert reply["error"]["kind"] == "bad_request"
    assert not place(ros_domain).exists()
    assert await running_pid(session, "node")
