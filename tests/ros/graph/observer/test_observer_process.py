"""The observer's process hangs or dies: nobody waits for it, it is said, and another takes over."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from graph.data import GoalStatus
from graph.observer.process.language import LATE_S, WITHDRAWN_LATE_S
from graph.observer.process.started import ObserverProcess
from graph.observer.requests import ObserverError
from graph.publishing.dead_man_switch import HeldCommand
from graph.ros import FAST_DDS_VARIABLES
from tests.ros.observing import ROOT, Peer, Watcher, let_updates_come
from tests.shared_memory_port import ports_of
from tests.waiting import wait_until

BOOL, FLOAT = "std_msgs/msg/Bool", "std_msgs/msg/Float32"
ADD, DRIVE = "example_interfaces/srv/AddTwoInts", "deck_interfaces/action/DriveToPoint"
NO_WAITING_S = 2.0
"""Forty calls that wait for nothing take less, on a machine that is busy; one that waited for the
process that hangs would take at least as long as that is given."""


@pytest.fixture
def watcher(ros_domain: int) -> Iterator[Watcher]:
    watcher = Watcher(ros_domain, apart=ObserverProcess)
    yield watcher
    watcher.close()


@pytest.fixture
def teller(ros_domain: int) -> Iterator[Peer]:
    peer = Peer("teller", ros_domain)
    peer.advertise("/beat", type_name=FLOAT)
    peer.repeat("/beat", value={"data": 1.0}, hz=20)
    peer.listen("/stop", type_name=BOOL, durability="transient_local")
    yield peer
    peer.close()


def pid_of(watcher: Watcher) -> int:
    line = watcher.observer._client._line
    return line.process.pid if line is not None else 0


def is_gone(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


def seen_by(watcher: Watcher, pid: int) -> bool:
    """Whether a process other than this one shows the graph, and nothing of it is old."""
    update = watcher.update
    named = any(node.name == "/teller" for node in update.nodes)
    return pid_of(watcher) not in (0, pid) and named and update.old_since_s is None


def watched(watcher: Watcher) -> None:
    watcher.observer.watch(["/beat"])
    watcher.observer.measure(True)
    wait_until(lambda: watcher.node("/teller") and watcher.of("/beat"), "the graph", within_s=30)


def check_that_nobody_waits(watcher: Watcher) -> None:
    """Give every kind of order to a process that does not hear any."""
    began_s = time.monotonic()
    for number in range(40):
        observer = watcher.observer
        observer.watch(["/beat", f"/other_{number}"])
        observer.hold("/drive", FLOAT, HeldCommand({}, {}, 20.0, time.monotonic() + 0.5))
        observer.let_go("/drive")
        observer.publish("/x", FLOAT, {"data": 1.0})
        observer.stop_commanding()
    assert time.monotonic() - began_s < NO_WAITING_S


def test_one_that_is_stopped_holds_up_nobody_and_is_replaced(
    watcher: Watcher, teller: Peer
) -> None:
    watched(watcher)
    number = watcher.observer.start_publishing("/mine", FLOAT, {"data": 1.0}, 5.0).result(20)
    wait_until(lambda: watcher.update.publications, "the publication")
    pid, before_s = pid_of(watcher), time.time()
    os.kill(pid, signal.SIGSTOP)
    call = watcher.observer.call("/nowhere", ADD, {}, timeout_s=60)
    stop = watcher.observer.publish("/stop", BOOL, {"data": True}, latched=True)
    check_that_nobody_waits(watcher)
    wait_until(lambda: watcher.update.old_since_s, "it is said to be old", within_s=30)
    since_s = watcher.update.old_since_s
    assert since_s is not None
    assert before_s - 2.0 < since_s < time.time()
    assert watcher.node("/teller"), "what was known is still shown"
    wait_until(lambda: seen_by(watcher, pid), "another has taken over", within_s=40)
    assert is_gone(pid)
    # What moves nothing and what stops was not lost; what waits for an answer is told.
    # It is latched: who has not been found at that moment hears it later.
    assert stop.result(20) in (0, 1)
    wait_until(lambda: "True" in str(teller.heard.get("/stop")), "the stop was heard")
    assert "hung" in call.result(1).error
    (ended,) = watcher.update.publications
    assert (ended.number, "hung" in ended.error) == (number, True)
    watcher.samples.clear()
    wait_until(lambda: watcher.of("/beat"), "messages of what is watched")
    watcher.observer.stop_publishing(number)
    wait_until(lambda: not watcher.update.publications, "the ended one is forgotten")


@pytest.mark.usefixtures("teller")
def test_one_that_was_killed_is_replaced_at_once(watcher: Watcher) -> None:
    watched(watcher)
    goal = watcher.observer.send_goal("/drive_to", DRIVE, {"x": 1.0}).result(20)
    wait_until(lambda: watcher.update.goals, "the goal")
    parameters = watcher.observer.parameters("/teller", timeout_s=60)
    pid = pid_of(watcher)
    os.kill(pid, signal.SIGKILL)
    wait_until(lambda: seen_by(watcher, pid), "another has taken over", within_s=40)
    assert parameters.result(1).error
    (ended,) = watcher.update.goals
    assert (ended.number, ended.status) == (goal, GoalStatus.FAILED)
    assert "died" in ended.error
    # The next one's numbers are others.
    number = watcher.observer.start_publishing("/mine", FLOAT, {"data": 1.0}, 5.0).result(20)
    assert number > goal


def test_marks_of_the_dead_in_its_shared_memory_hold_up_nobody(
    watcher: Watcher, teller: Peer
) -> None:
    watched(watcher)
    pid = pid_of(watcher)
    watcher.observer.publish("/stop", BOOL, {"data": False}, latched=True).result(20)
    (port,) = [port for port in ports_of(teller.process.pid) if port.is_open_in(pid)][:1]
    # As if somebody had been killed between taking this lock and giving it back.
    port.lock()
    try:
        watcher.observer.publish("/stop", BOOL, {"data": True}, latched=True)
        wait_until(lambda: port.is_awaited_by(pid), "it waits for the lock", within_s=20)
        check_that_nobody_waits(watcher)
    finally:
        port.unlock()
    wait_until(lambda: watcher.update.old_since_s is None, "it sees again", within_s=40)


def test_it_leaves_with_whoever_it_works_for(ros_domain: int) -> None:
    program = (
        "import threading, time\n"
        "from graph.observer.observer import Observer\n"
        f"observer, told = Observer({ros_domain}), threading.Event()\n"
        "observer.start(lambda update: told.set())\n"
        "assert told.wait(30)\n"
        "print(observer._client._line.process.pid, flush=True)\n"
        "time.sleep(60)"
    )
    screen = subprocess.Popen(
        [sys.executable, "-c", program], cwd=ROOT, stdout=subprocess.PIPE, text=True
    )
    with screen:
        assert screen.stdout is not None
        # Fast DDS may have a word to say as well.
        pid = next(int(line) for line in screen.stdout if line.strip().isdigit())
        screen.kill()
        wait_until(lambda: is_gone(pid), "the observer has left", within_s=20)


def test_orders_from_before_a_hang_do_not_drive_the_robot_after_it(
    watcher: Watcher, teller: Peer
) -> None:
    teller.listen("/drive", type_name=FLOAT)
    watched(watcher)
    watcher.wait_for("/drive", lambda row: row.subscribers, "a listener")
    watcher.observer.publish("/drive", FLOAT, {"data": 1.0}).result(20)
    pid = pid_of(watcher)
    os.kill(pid, signal.SIGSTOP)
    late = watcher.observer.publish("/drive", FLOAT, {"data": 2.0})
    too_late_s = time.monotonic() + LATE_S
    wait_until(lambda: time.monotonic() > too_late_s, "it is too late", within_s=20)
    os.kill(pid, signal.SIGCONT)
    with pytest.raises(ObserverError):
        late.result(40)
    assert "2.0" not in str(teller.heard.get("/drive"))


def test_a_release_from_before_a_hang_is_given_up_and_a_stop_is_not(
    watcher: Watcher, teller: Peer
) -> None:
    """It would be younger than a stop that somebody else has given meanwhile."""
    teller.listen("/held", type_name=BOOL)
    watched(watcher)
    watcher.wait_for("/held", lambda row: row.subscribers, "a listener")
    watcher.observer.prepare_publisher("/held", BOOL, latched=True).result(20)
    pid = pid_of(watcher)
    os.kill(pid, signal.SIGSTOP)
    stop = watcher.observer.publish("/held", BOOL, {"data": True}, latched=True)
    release = watcher.observer.publish("/held", BOOL, {"data": False}, latched=True)
    too_late_s = time.monotonic() + WITHDRAWN_LATE_S
    wait_until(lambda: time.monotonic() > too_late_s, "it is too late")
    os.kill(pid, signal.SIGCONT)
    with pytest.raises(ObserverError):
        release.result(40)
    stop.result(40)
    wait_until(lambda: "True" in str(teller.heard.get("/held")), "the stop")
    assert "False" not in str(teller.heard.get("/held"))


DEAF = """<?xml version="1.0"?>
<dds xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles"><profiles>
<participant profile_name="deaf" is_default_profile="true"><rtps><builtin><discovery_config>
<ignoreParticipantFlags>FILTER_DIFFERENT_PROCESS</ignoreParticipantFlags>
</discovery_config></builtin></rtps></participant></profiles></dds>
"""
"""Settings by which a node finds nobody, as after a load peak in which it has heard nothing."""


def test_one_that_lives_and_sees_less_than_there_is_is_replaced(
    ros_domain: int, teller: Peer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = tmp_path / "deaf.xml"
    settings.write_text(DEAF)
    started: list[ObserverProcess] = []

    def start() -> ObserverProcess:
        with monkeypatch.context() as patch:
            if not started:
                patch.setenv(FAST_DDS_VARIABLES[0], str(settings))
            started.append(ObserverProcess())
        return started[-1]

    watcher = Watcher(ros_domain, apart=start)
    watcher.observer.watch(["/beat"])
    try:
        wait_until(lambda: len(started) == 2, "a second one looks", within_s=40)
        assert watcher.node(teller.name) is None
        wait_until(lambda: watcher.of("/beat"), "it has taken over", within_s=40)
        assert watcher.node(teller.name)
        assert not started[0].is_alive
        let_updates_come(watcher, 20)
        assert len(started) == 2, "no third one is needed"
    finally:
        watcher.close()
