"""The emergency stop while Deck has its hands full: it goes out at once, whatever hangs."""

from __future__ import annotations

import asyncio
import os
import signal
import time
from collections.abc import Iterator
from concurrent.futures import Future
from types import SimpleNamespace
from typing import Any, cast

import pytest
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Bool

from graph.observer.requests import CallService, ReadParameters, SendGoal, SetParameters, StartPublishing
from safety.topics import EMERGENCY_STOP
from tests.ros.observing import Peer as Process
from tests.ros.observing import Watcher
from tests.ros.peer import Peer
from tests.waiting import wait_until
from tui.emergency.control import EmergencyControl

ADD = "example_interfaces/srv/AddTwoInts"
DRIVE = "deck_interfaces/action/DriveToPoint"
FLOAT = "std_msgs/msg/Float32"
AT_ONCE_S = 0.5
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class App:
    """As much of the app as the emergency stop needs."""

    def __init__(self, watcher: Watcher) -> None:
        self.feed = SimpleNamespace(graph=watcher.observer, update=watcher.update, link=None)
        self.workers: list[asyncio.Task[Any]] = []

    def run_worker(self, work: Any, group: str) -> None:
        assert group == "emergency"
        self.workers.append(asyncio.ensure_future(work))

    def notify(self, words: str, **_looks: Any) -> None:
        """Nobody reads it here."""


@pytest.fixture
def hung(ros_domain: int) -> Iterator[Process]:
    """A node that serves all kinds of things and is stopped as soon as it has been found."""
    process = Process("hung", ros_domain, "--parameters")
    process.serve("/slow")
    process.serve_action("/hung_drive")
    yield process
    os.kill(process.process.pid, signal.SIGCONT)
    process.close()


@pytest.fixture
def watcher(ros_domain: int) -> Iterator[Watcher]:
    watcher = Watcher(ros_domain)
    yield watcher
    watcher.close()


def begin_everything(watcher: Watcher, hung: Process) -> list[Any]:
    """Begin calls, questions and goals that hang, a goal that runs and publications that race."""
    observer = watcher.observer
    running = Process("running", int(os.environ["ROS_DOMAIN_ID"]))
    running.serve_action("/drive_to")
    wait_until(lambda: len(watcher.update.actions) == 2, "both actions")
    wait_until(lambda: watcher.serves("/slow"), "the service")
    os.kill(hung.process.pid, signal.SIGSTOP)
    waiting: list[Future[Any]] = [
        observer.ask(CallService("/slow", ADD, {"a": n, "b": 1}, timeout_s=60.0)) for n in range(30)
    ]
    waiting.append(observer.ask(ReadParameters("/hung", timeout_s=60.0)))
    waiting.append(observer.ask(SetParameters("/hung", {"use_sim_time": True}, timeout_s=60.0)))
    for n in range(3):
        observer.ask(StartPublishing(f"/race_{n}", FLOAT, {"data": 1.0}, 100.0)).result(30)
        observer.ask(SendGoal("/hung_drive", DRIVE, {"x": float(n)})).result(30)
        observer.ask(SendGoal("/drive_to", DRIVE, {"x": float(n)})).result(30)
    wait_until(lambda: len(running.goals("/drive_to")) == 3, "goals that run")
    return [running, *waiting]


async def test_it_is_heard_at_once_while_everything_else_hangs(
    watcher: Watcher, hung: Process, ros_domain: int
) -> None:
    app = App(watcher)
    stop = EmergencyControl(cast("Any", app), cast("Any", app.feed), lambda: None)
    with Peer(ros_domain) as robot:
        heard: list[tuple[bool, float]] = []

        def take(message: Bool) -> None:
            heard.append((message.data, time.monotonic()))

        robot.node.create_subscription(Bool, EMERGENCY_STOP, take, LATCHED)
        watcher.wait_for(EMERGENCY_STOP, lambda row: row.subscribers == 1, "the robot listens")
        stop.prepare()
        running, *waiting = begin_everything(watcher, hung)
        app.feed.update = watcher.update
        for count in range(1, 6):
            pressed_s = time.monotonic()
            stop.engage()
            await asyncio.gather(*app.workers)
            await asyncio.to_thread(wait_until, lambda n=count: len(heard) >= n, "the stop")
            assert heard[-1][0] is True
            assert heard[-1][1] - pressed_s < AT_ONCE_S
        wait_until(lambda: not watcher.update.publications, "what raced has ended")
        assert stop.state.fallback == ""
        assert not any(future.done() for future in waiting)
        running.close()
