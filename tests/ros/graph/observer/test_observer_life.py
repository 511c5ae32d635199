"""The observer's coming and going: nothing delayed, nothing printed, nothing left behind."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pytest

from graph.data import GraphUpdate
from graph.observer.interest import Interest
from graph.observer.loop import ObserverLoop
from graph.observer.node import ObserverNode
from graph.observer.observer import Observer
from graph.observer.requests import ObserverError
from graph.observer.settings import ObserverSettings
from tests.middleware_words import own_words
from tests.ros.observing import Peer, Watcher
from tests.waiting import DEADLINE_S, wait_until

ROOT = Path(__file__).parents[4]


def run(program: str, domain: int, **env: str) -> subprocess.CompletedProcess[str]:
    """Run a small program in a process of its own."""
    return subprocess.run(
        [sys.executable, "-c", program],
        cwd=ROOT,
        env={**os.environ, "ROS_DOMAIN_ID": str(domain), **env},
        capture_output=True,
        text=True,
        timeout=DEADLINE_S,
        check=False,
    )


def test_importing_the_room_imports_neither_rclpy_nor_numpy(ros_domain: int) -> None:
    program = (
        "import json, sys;"
        "import graph, graph.data, graph.pictures.images, graph.observer.observer;"
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


def test_its_node_leaves_the_graph_when_it_stops(ros_domain: int) -> None:
    peer, watcher = Peer("talker", ros_domain), Watcher(ros_domain)
    name = f"/_deck_observer_{os.getpid()}"
    wait_until(lambda: name in peer.names(), "it is in the graph")
    began_s = time.monotonic()
    watcher.observer.stop()
    assert time.monotonic() - began_s < 5
    wait_until(lambda: name not in peer.names(), "it has left the graph", within_s=10)
    peer.close()


def test_the_environment_of_the_screen_is_left_as_it_was(
    ros_domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
    monkeypatch.delenv("ROS_STATIC_PEERS", raising=False)
    before = dict(os.environ)
    peer, watcher = Peer("talker", ros_domain), Watcher(ros_domain)
    wait_until(lambda: watcher.node("/talker"), "the graph")
    watcher.close()
    peer.close()
    assert dict(os.environ) == before


@pytest.mark.parametrize(
    ("domain", "discovery", "word"),
    [
        (233, "localhost", "domain 233 is not between 0 and 232"),
        (-3, "localhost", "domain -3 is not between 0 and 232"),
        (5, "everywhere", "discovery 'everywhere' is neither of localhost, subnet"),
    ],
)
def test_a_domain_that_is_refused_is_told_and_so_is_every_order(
    domain: int, discovery: str, word: str
) -> None:
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


def test_a_machine_without_ros_is_told_in_words(ros_domain: int, tmp_path: Path) -> None:
    (tmp_path / "rclpy.py").write_text("raise ImportError('no rclpy')")
    program = (
        f"import sys, threading; sys.path.insert(0, {str(tmp_path)!r})\n"
        "from graph.observer.observer import Observer\n"
        f"told = threading.Event(); observer = Observer({ros_domain})\n"
        "observer.start(lambda update: (print(update.error), told.set()))\n"
        "assert told.wait(30); observer.stop()"
    )
    done = run(program, ros_domain)
    assert done.stdout.startswith("ROS cannot be used: ")
    assert "rclpy" in done.stdout
    assert (done.stderr, done.returncode) == ("", 0)


def test_a_screen_that_fails_to_take_an_update_gets_the_next(ros_domain: int) -> None:
    taken = []

    def take(update: GraphUpdate) -> None:
        taken.append(update)
        raise RuntimeError("the screen is being closed")

    observer = Observer(ros_domain)
    peer = Peer("talker", ros_domain)
    observer.start(take)
    observer.measure(all_topics=True)
    wait_until(lambda: len(taken) > 3, "more updates")
    observer.stop()
    peer.close()


class Listener:
    """Whom a loop works for in this process; it has it stop once it has seen the graph."""

    def __init__(self, domain: int) -> None:
        self.updates: list[GraphUpdate] = []
        self.loop = ObserverLoop(ObserverSettings(domain), self)

    def tell(self, update: GraphUpdate) -> None:
        self.updates.append(update)
        if update.nodes:
            self.loop.stop()

    def wait(self, within_s: float) -> None:
        time.sleep(within_s)

    def look(self) -> bool:
        return False


def test_one_look_that_fails_is_told_and_the_next_has_another_chance(
    ros_domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    look, failures = ObserverNode.look, [RuntimeError("the node went"), RuntimeError("and another")]

    def failing(node: ObserverNode, interest: Interest) -> GraphUpdate | None:
        if failures:
            raise failures.pop()
        return look(node, interest)

    monkeypatch.setattr(ObserverNode, "look", failing)
    peer, listener = Peer("talker", ros_domain), Listener(ros_domain)
    listener.loop.run()
    assert [u.error for u in listener.updates[:2]] == [
        "the ROS graph: and another",
        "the ROS graph: the node went",
    ]
    assert listener.updates[-1].error == ""
    peer.close()


def test_peers_named_by_their_address_are_found(ros_domain: int) -> None:
    peer = Peer("talker", ros_domain)
    updates: list[GraphUpdate] = []
    observer = Observer(ros_domain, ("127.0.0.1",))
    observer.start(updates.append)
    wait_until(lambda: any(u.nodes for u in updates), "the graph")
    observer.stop()
    peer.close()


def test_one_that_is_stopped_before_it_was_started_refuses_what_it_was_asked_for() -> None:
    observer = Observer(1)
    future = observer.publish("/x", "std_msgs/msg/String", {"data": "x"})
    observer.stop()
    with pytest.raises(ObserverError, match="never started"):
        future.result(1)


def test_whoever_wants_something_else_again_and_again_does_not_put_off_the_next_look(
    ros_domain: int,
) -> None:
    peer, watcher = Peer("teller", ros_domain), Watcher(ros_domain)
    peer.advertise("/beat", type_name="std_msgs/msg/Float32")
    # As each key in the field of an expression does.
    for number in range(100):
        topic = f"/wanted_{number}"
        watcher.observer.watch([topic])
        wait_until(partial(watcher.row, topic), f"{topic}")
    watcher.observer.watch(["/beat"])
    peer.repeat("/beat", value={"data": 1.0}, hz=20)
    wait_until(lambda: len(watcher.of("/beat")) > 2, "messages", within_s=10)
    watcher.close()
    peer.close()
