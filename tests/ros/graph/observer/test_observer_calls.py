"""Service calls: an answer, or in words why there is none; nothing else waits meanwhile."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from typing import Any

import pytest
import rclpy
from rclpy.service import Service

from graph.data import CallResult
from graph.messages.types import load_service
from tests.ros.observing import Peer, Watcher, let_updates_come
from tests.ros.peer import Peer as InProcess
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

ADD = "example_interfaces/srv/AddTwoInts"


@pytest.fixture(scope="module")
def server(module_domain: int) -> Iterator[Peer]:
    peer = Peer("server", module_domain)
    peer.serve("/add")
    yield peer
    peer.close()


@pytest.fixture(scope="module")
def watcher(module_domain: int) -> Iterator[Watcher]:
    watcher = Watcher(module_domain)
    yield watcher
    watcher.close()


def call(watcher: Watcher, service: str, request: dict[str, Any], **how: Any) -> CallResult:
    type_name = str(how.pop("type_name", ADD))
    return watcher.observer.call(service, type_name, request, **how).result(40)


@pytest.mark.usefixtures("server")
def test_an_answer_comes_as_plain_values(watcher: Watcher) -> None:
    result = call(watcher, "/add", {"a": 2, "b": 40}, timeout_s=30)
    assert result.ok, result.error
    assert result.response == {"sum": 42}
    assert result.error == ""
    assert 0 < result.elapsed_s < 30


def test_many_calls_of_a_busy_service_get_each_their_own_answer(
    server: Peer, watcher: Watcher
) -> None:
    assert call(watcher, "/add", {"a": 1, "b": 2}, timeout_s=30).ok
    server.process.send_signal(signal.SIGSTOP)
    futures = [
        watcher.observer.call("/add", ADD, {"a": number, "b": 1000}, timeout_s=30)
        for number in range(20)
    ]
    # Orders are carried out in turn: when this one is over, the calls are on their way.
    assert not call(watcher, "/nobody", {}, timeout_s=0.1).ok
    server.process.send_signal(signal.SIGCONT)
    sums = [future.result(40).response for future in futures]
    assert sums == [{"sum": 1000 + number} for number in range(20)]


def test_a_service_that_nobody_serves_is_named(watcher: Watcher) -> None:
    result = call(watcher, "/nobody", {"a": 1, "b": 2}, timeout_s=0.3)
    assert (result.ok, result.response) == (False, None)
    assert result.error == "/nobody: no server appeared within 0.3 s"
    assert result.elapsed_s >= 0.3


def test_a_server_that_does_not_answer_ends_in_a_time_out_and_freezes_nothing(
    server: Peer, watcher: Watcher, module_domain: int
) -> None:
    server.advertise("/beat", type_name="std_msgs/msg/Float32")
    server.repeat("/beat", value={"data": 1.0}, hz=20)
    watcher.observer.watch(["/beat"])
    wait_until(lambda: watcher.of("/beat"), "the beat")
    slow = Peer("slow", module_domain)
    slow.serve("/slow", after_s=2.0)
    wait_until(lambda: watcher.serves("/slow"), "the service")
    slow_one = watcher.observer.call("/slow", ADD, {"a": 1, "b": 2}, timeout_s=0.8)
    let_updates_come(watcher, 5)
    assert not slow_one.done()
    result = slow_one.result(30)
    assert (result.ok, result.error) == (False, "/slow: no answer within 0.8 s")
    # The answer that comes too late is told as what it is, not taken for one to the next call.
    assert result.late is not None
    late = result.late.result(30)
    assert (late.ok, late.response) == (True, {"sum": 3})
    assert late.elapsed_s > result.elapsed_s
    following = call(watcher, "/slow", {"a": 10, "b": 20}, timeout_s=30)
    assert following.response == {"sum": 30}
    slow.close()


def test_a_service_that_leaves_after_the_time_out_is_told_to_whoever_still_listens(
    watcher: Watcher, module_domain: int
) -> None:
    with InProcess(module_domain, "leaver") as host:
        # Nobody spins this node, so the request stays unanswered.
        silent = rclpy.create_node("silent", context=host.node.context)
        service = silent.create_service(load_service(ADD), "/leaving", lambda _, answer: answer)
        wait_until(lambda: watcher.serves("/leaving"), "it")
        future = watcher.observer.call("/leaving", ADD, {"a": 1, "b": 2}, timeout_s=2.0)
        wait_until(lambda: takes_a_request(service), "the request")
        result = future.result(30)
        assert (result.error, result.late is not None) == ("/leaving: no answer within 2 s", True)
        silent.destroy_node()
        assert result.late is not None
        assert result.late.result(30).error == "/leaving has left the graph and has not answered"


@pytest.mark.usefixtures("server")
@pytest.mark.parametrize(
    ("service", "type_name", "request_", "word"),
    [
        ("/add", ADD, {"a": "two"}, "a: expected a whole number, got 'two'"),
        ("/add", ADD, {"c": 2}, "c: no such field; there is a, b"),
        ("/add", ADD, {"a": 2**63}, "a: expected -9223372036854775808 to 9223372036854775807"),
        ("/add", "foo_msgs/srv/Bar", {}, "/add is a example_interfaces/srv/AddTwoInts, not a foo"),
        ("/else", "foo_msgs/srv/Bar", {}, "package foo_msgs is not installed"),
        ("/no name", ADD, {}, "/no name cannot be called"),
    ],
)
def test_what_cannot_be_called_is_refused_in_words(
    watcher: Watcher,
    service: str,
    type_name: str,
    request_: dict[str, object],
    word: str,
) -> None:
    wait_until(lambda: watcher.serves("/add"), "the service")
    result = call(watcher, service, request_, type_name=type_name)
    assert not result.ok
    assert result.error.startswith(word)


def test_a_server_that_dies_during_the_call_ends_in_a_time_out(
    watcher: Watcher, module_domain: int
) -> None:
    dying = Peer("dying", module_domain)
    dying.serve("/dying", after_s=60.0)
    wait_until(lambda: watcher.serves("/dying"), "the service")
    future = watcher.observer.call("/dying", ADD, {"a": 1, "b": 2}, timeout_s=2.0)
    # Orders are carried out in turn: when this one is done, the call is under way.
    watcher.observer.prepare_publisher("/later", "std_msgs/msg/Bool").result(20)
    dying.kill()
    assert "no answer" in future.result(30).error
    dying.close()


def takes_a_request(service: Service) -> bool:
    with service.handle:
        kind: Any = service.srv_type
        request, _ = service.handle.service_take_request(kind.Request)
    return request is not None


def test_a_service_that_vanishes_in_mid_call_is_told_long_before_the_time_out(
    watcher: Watcher, module_domain: int
) -> None:
    with InProcess(module_domain, "host") as host:
        # Nobody spins this node, so the request stays unanswered.
        silent = rclpy.create_node("silent", context=host.node.context)
        service = silent.create_service(load_service(ADD), "/vanishing", lambda _, answer: answer)
        wait_until(lambda: watcher.serves("/vanishing"), "it")
        future = watcher.observer.call("/vanishing", ADD, {"a": 1, "b": 2}, timeout_s=60.0)
        wait_until(lambda: takes_a_request(service), "the request")
        assert not future.done()
        silent.destroy_node()
        result = future.result(30)
        assert result.error == "/vanishing has left the graph and has not answered"
