"""A node that is stopped by SIGSTOP: it answers nothing, and it holds up nothing."""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from graph.data import GraphUpdate
from tests.ros.observing import Peer, Watcher, let_updates_come
from tests.waiting import wait_until

FLOAT = "std_msgs/msg/Float32"
ADD = "example_interfaces/srv/AddTwoInts"
LONGEST_GAP_S = 2.0
"""Between two updates that are due every tenth of a second, on a machine that is busy."""


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
