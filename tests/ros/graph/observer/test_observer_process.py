"""The observer's process: it delays and leaves nothing, and where it hangs another takes over."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from graph.data import GoalStatus, GraphUpdate
from graph.observer.observer import Observer
from graph.observer.process.language import LATE_S, WITHDRAWN_LATE_S
from graph.observer.process.started import ObserverProcess
from graph.observer.requests import ObserverError
from graph.publishing.dead_man_switch import HeldCommand
from tests.middleware_words import own_words
from tests.ros.observing import ROOT, Peer, Watcher, let_updates_come
from tests.waiting import wait_until

BOOL, FLOAT = "std_msgs/msg/Bool", "std_msgs/msg/Float32"
ADD, DRIVE = "example_interfaces/srv/AddTwoInts", "deck_interfaces/action/DriveToPoint"
NO_WAITING_S = 2.0
"""Forty calls that wait for nothing take less, on a machine that is busy; one that waited for the
process that hangs would take at least as long as that is given."""
LONGEST_GAP_S = 2.0
"""Between two updates that are due every tenth of a second, on a machine that is busy."""


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


def test_one_that_is_stopped_holds_up_nobody_and_is_replaced(watcher: Watcher, teller: Peer) -> None:
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
    screen = subprocess.Popen([sys.executable, "-c", program], cwd=ROOT, stdout=subprocess.PIPE, text=True)
    with screen:
        assert screen.stdout is not None
        # Fast DDS may have a word to say as well.
        pid = next(int(line) for line in screen.stdout if line.strip().isdigit())
        screen.kill()
        wait_until(lambda: is_gone(pid), "the observer has left", within_s=20)


def test_orders_from_before_a_hang_do_not_drive_the_robot_after_it(watcher: Watcher, teller: Peer) -> None:
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


def test_a_release_from_before_a_hang_is_given_up_and_a_stop_is_not(watcher: Watcher, teller: Peer) -> None:
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


# ---------------------------------------------------------------- begin and end


def run(program: str, domain: int, **env: str) -> subprocess.CompletedProcess[str]:
    """Run a small program in a process of its own."""
    return subprocess.run(
        [sys.executable, "-c", program],
        cwd=ROOT,
        env={**os.environ, "ROS_DOMAIN_ID": str(domain), **env},
        capture_output=True,
        text=True,
        check=False,
    )


def test_importing_the_room_imports_neither_rclpy_nor_numpy(ros_domain: int) -> None:
    program = (
        "import json, sys;"
        "import graph, graph.data, graph.pictures.pixels, graph.observer.observer;"
        "print(json.dumps([m for m in ('rclpy', 'numpy', 'rosidl_parser') if m in sys.modules]))"
    )
    assert json.loads(run(program, ros_domain).stdout) == []


WORKING = """
import sys, threading, time
from graph.observer.interest import Interest
from graph.observer.observer import Observer
seen = threading.Event()
observer = Observer({domain})
observer.start(lambda update: seen.set() if update.topics else None)
observer.measure(True)
observer.watch(["/rosout"])
observer.publish("/x", "std_msgs/msg/String", {{"data": "x"}}, latched=True)
call = observer.call("/y", "example_interfaces/srv/AddTwoInts", {{}}, timeout_s=60)
assert seen.wait(30)
{end}
"""


@pytest.mark.parametrize(
    "end",
    [
        "observer.stop(); print(call.result(1).error)",
        "print('the observer has been stopped')",
        "print('the observer has been stopped'); sys.exit(0)",
    ],
    ids=["stopped", "forgotten", "exit"],
)
def test_it_writes_nothing_and_ends_cleanly(ros_domain: int, end: str, tmp_path: Path) -> None:
    peer = Peer("talker", ros_domain)
    peer.advertise("/a", type_name="std_msgs/msg/String")
    logs = tmp_path / "logs-of-ros"
    done = run(WORKING.format(domain=ros_domain, end=end), ros_domain, ROS_LOG_DIR=str(logs))
    peer.close()
    assert done.stderr == ""
    assert own_words(done.stdout).strip() == "the observer has been stopped"
    assert done.returncode == 0
    assert not logs.exists()


@pytest.mark.parametrize(
    ("domain", "discovery", "word"),
    [
        (233, "localhost", "domain 233 is not between 0 and 232"),
        (-3, "localhost", "domain -3 is not between 0 and 232"),
        (5, "everywhere", "discovery 'everywhere' is neither of localhost, subnet"),
    ],
)
def test_a_domain_that_is_refused_is_told_and_so_is_every_order(domain: int, discovery: str, word: str) -> None:
    updates: list[GraphUpdate] = []
    observer = Observer(domain, discovery)
    before = observer.publish("/x", "std_msgs/msg/String", {"data": "x"})
    observer.start(updates.append)
    with pytest.raises(ObserverError, match="ROS cannot be used"):
        before.result(30)
    wait_until(lambda: updates, "an update")
    assert word in updates[0].error
    with pytest.raises(ObserverError, match="ROS cannot be used"):
        observer.publish("/x", "std_msgs/msg/String", {"data": "x"}).result(1)
    result = observer.call("/y", "example_interfaces/srv/AddTwoInts", {}).result(1)
    assert "ROS cannot be used" in result.error
    observer.stop()


# ---------------------------------------------------------------- a node that hangs


class TimedWatcher(Watcher):
    """It knows the longest time between two updates since it was last set to nothing."""

    longest_s = 0.0
    _newest_s = 0.0

    def _take(self, update: GraphUpdate) -> None:
        now_s = time.monotonic()
        if self._newest_s:
            self.longest_s = max(self.longest_s, now_s - self._newest_s)
        self._newest_s = now_s
        super()._take(update)


@pytest.fixture
def stuck(ros_domain: int) -> Iterator[Peer]:
    peer = Peer("stuck", ros_domain)
    peer.advertise("/stuck", type_name=FLOAT)
    peer.serve("/add")
    peer.repeat("/stuck", value={"data": 1.0}, hz=20)
    yield peer
    peer.process.send_signal(signal.SIGCONT)
    peer.close()


@pytest.fixture
def lively(ros_domain: int) -> Iterator[Peer]:
    peer = Peer("lively", ros_domain)
    peer.advertise("/lively", type_name=FLOAT)
    peer.repeat("/lively", value={"data": 2.0}, hz=20)
    peer.serve("/other_add")
    yield peer
    peer.close()


@contextmanager
def stopped(peer: Peer) -> Iterator[None]:
    peer.process.send_signal(signal.SIGSTOP)
    try:
        yield
    finally:
        peer.process.send_signal(signal.SIGCONT)


def test_one_stopped_node_freezes_nothing(ros_domain: int, stuck: Peer, lively: Peer) -> None:
    watcher = TimedWatcher(ros_domain)
    watcher.observer.watch(["/lively", "/stuck"])
    watcher.observer.measure(all_topics=True)
    try:
        for topic in ("/lively", "/stuck"):
            watcher.wait_for(topic, lambda row: row.hz and abs(row.hz - 20) < 2, "its rate")
        wait_until(lambda: len(watcher.update.services) > 1, "the services")
        with stopped(stuck):
            check_that_all_goes_on(watcher)
        watcher.wait_for("/stuck", lambda row: row.trouble is None, "it is back")
        assert lively.process.poll() is None
    finally:
        watcher.close()


def check_that_all_goes_on(watcher: TimedWatcher) -> None:
    watcher.longest_s = 0.0
    unanswered = watcher.observer.call("/add", ADD, {"a": 1, "b": 2}, timeout_s=3)
    parameters = watcher.observer.parameters("/stuck", timeout_s=3)
    publishing = watcher.observer.publish("/lively", FLOAT, {"data": 3.0})
    answered = watcher.observer.call("/other_add", ADD, {"a": 1, "b": 2}, timeout_s=20).result(30)
    assert answered.response == {"sum": 3}
    seen = len(watcher.samples["/lively"])
    watcher.wait_for("/stuck", lambda row: row.trouble is not None, "it has gone quiet")
    let_updates_come(watcher, 10)
    result = unanswered.result(30)
    assert (result.ok, "no answer within 3 s" in result.error) == (False, True)
    assert result.elapsed_s < 6
    assert parameters.result(30).error
    publishing.result(30)
    assert watcher.node("/stuck") is not None
    rate = pytest.approx(20, rel=0.1)
    watcher.wait_for("/lively", lambda row: row.hz == rate, "has its rate")
    assert len(watcher.samples["/lively"]) > seen + 10
    assert watcher.longest_s < LONGEST_GAP_S
