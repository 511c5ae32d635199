"""What is asked of nodes: calls, parameters, goals, and goals of others; or in words why not."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from typing import Any

import pytest
import rclpy
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.parameter import Parameter
from rclpy.service import Service

from graph.calls.goals import GoalError
from graph.data import CallResult, Goal, GoalStatus, ParameterRow, SeenGoal, SetResult
from graph.messages.making import FieldError
from graph.messages.types import UnknownTypeError, load_service
from graph.observer.requests import (
    CallService,
    CancelGoal,
    CancelSeenGoal,
    ForgetGoal,
    ObserverError,
    ReadParameters,
    SendGoal,
    SetParameters,
    StopCommanding,
)
from tests.ros.observing import Peer, Watcher, let_updates_come
from tests.ros.peer import Peer as InProcess
from tests.waiting import wait_until

ADD = "example_interfaces/srv/AddTwoInts"
DRIVE = "deck_interfaces/action/DriveToPoint"
CANCELED = 5
"""Of action_msgs/GoalStatus."""


# ---------------------------------------------------------------- calls


@pytest.fixture(scope="module")
def adder(talker: Peer) -> Peer:
    talker.serve("/add")
    return talker


def call(watcher: Watcher, service: str, request: dict[str, Any], **how: Any) -> CallResult:
    type_name = str(how.pop("type_name", ADD))
    return watcher.observer.ask(CallService(service, type_name, request, **how)).result(40)


@pytest.mark.usefixtures("adder")
def test_an_answer_comes_as_plain_values(watcher: Watcher) -> None:
    result = call(watcher, "/add", {"a": 2, "b": 40}, timeout_s=30)
    assert result.ok, result.error
    assert result.response == {"sum": 42}
    assert result.error == ""
    assert 0 < result.elapsed_s < 30


def test_a_server_that_does_not_answer_ends_in_a_time_out_and_freezes_nothing(
    talker: Peer, watcher: Watcher, module_domain: int
) -> None:
    talker.advertise("/beat", type_name="std_msgs/msg/Float32")
    talker.repeat("/beat", value={"data": 1.0}, hz=20)
    watcher.want(watched=["/beat"])
    wait_until(lambda: watcher.of("/beat"), "the beat")
    slow = Peer("slow", module_domain)
    slow.serve("/slow", after_s=2.0)
    wait_until(lambda: watcher.serves("/slow"), "the service")
    slow_one = watcher.observer.ask(CallService("/slow", ADD, {"a": 1, "b": 2}, timeout_s=0.8))
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


@pytest.mark.usefixtures("adder")
def test_what_cannot_be_called_is_refused_in_words(watcher: Watcher) -> None:
    wait_until(lambda: watcher.serves("/add"), "the service")
    for service, type_name, request, word in (
        ("/add", ADD, {"a": "two"}, "a: expected a whole number, got 'two'"),
        ("/add", "foo_msgs/srv/Bar", {}, "/add is a example_interfaces/srv/AddTwoInts, not a foo"),
        ("/else", "foo_msgs/srv/Bar", {}, "package foo_msgs is not installed"),
        ("/no name", ADD, {}, "/no name cannot be called"),
    ):
        result = call(watcher, service, request, type_name=type_name)
        assert not result.ok
        assert result.error.startswith(word)


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
        future = watcher.observer.ask(CallService("/vanishing", ADD, {"a": 1, "b": 2}, timeout_s=60.0))
        wait_until(lambda: takes_a_request(service), "the request")
        assert not future.done()
        silent.destroy_node()
        result = future.result(30)
        assert result.error == "/vanishing has left the graph and has not answered"


# ---------------------------------------------------------------- parameters


@pytest.fixture(scope="module")
def node(module_domain: int) -> Iterator[Any]:
    with InProcess(module_domain, "robot") as peer:
        declare(peer.node)
        yield peer.node


def declare(node: Any) -> None:
    speed = FloatingPointRange(from_value=0.0, to_value=2.0, step=0.5)
    gears = IntegerRange(from_value=1, to_value=6, step=0)
    node.declare_parameter(
        "speed",
        1.0,
        ParameterDescriptor(
            description="how fast", additional_constraints="slow indoors", floating_point_range=[speed]
        ),
    )
    node.declare_parameter("gear", 1, ParameterDescriptor(integer_range=[gears]))
    node.declare_parameter("frame", "base_link", ParameterDescriptor(read_only=True))
    node.declare_parameter("any", 1, ParameterDescriptor(dynamic_typing=True))
    node.declare_parameter("never_set", Parameter.Type.DOUBLE)
    node.declare_parameter("on", True)
    node.declare_parameter("arm.joints", ["a", "b"])
    node.declare_parameter("arm.limits", [1.0, 2.5])
    node.declare_parameter("arm.numbers", [1, 2])
    node.declare_parameter("arm.flags", [True, False])
    node.declare_parameter("arm.bytes", [b"\x00", b"\xff"])

    def refuse_nought(parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name == "on" and parameter.value is False:
                return SetParametersResult(successful=False, reason="somebody must drive")
        return SetParametersResult(successful=True)

    node.add_on_set_parameters_callback(refuse_nought)


def rows(watcher: Watcher, node: str = "/robot") -> dict[str, ParameterRow]:
    wait_until(lambda: watcher.serves(f"{node}/list_parameters"), f"the services of {node}")
    result = watcher.observer.ask(ReadParameters(node, timeout_s=30)).result(40)
    assert result.error == ""
    assert result.node == node
    assert result.elapsed_s > 0
    assert [row.name for row in result.parameters] == sorted(r.name for r in result.parameters)
    return {row.name: row for row in result.parameters}


def set_them(watcher: Watcher, node: str = "/robot", **values: Any) -> SetResult:
    wait_until(lambda: watcher.serves(f"{node}/set_parameters"), f"the services of {node}")
    return watcher.observer.ask(SetParameters(node, values, timeout_s=30)).result(40)


@pytest.mark.usefixtures("node")
def test_all_parameters_come_with_types_values_and_descriptors(watcher: Watcher) -> None:
    found = rows(watcher)
    assert found["speed"] == ParameterRow("speed", "double", 1.0, "how fast", "slow indoors", False, 0.0, 2.0, 0.5)
    assert found["gear"] == ParameterRow("gear", "integer", 1, least=1.0, greatest=6.0, step=None)
    assert found["frame"] == ParameterRow("frame", "string", "base_link", read_only=True)
    assert found["arm.joints"] == ParameterRow("arm.joints", "string_array", ["a", "b"])
    assert found["arm.limits"] == ParameterRow("arm.limits", "double_array", [1.0, 2.5])
    assert found["arm.numbers"] == ParameterRow("arm.numbers", "integer_array", [1, 2])
    assert found["arm.flags"] == ParameterRow("arm.flags", "bool_array", [True, False])
    assert found["arm.bytes"] == ParameterRow("arm.bytes", "byte_array", b"\x00\xff")


def test_values_are_set_by_the_types_that_the_node_has(watcher: Watcher, node: Any) -> None:
    arm: dict[str, Any] = {"arm.joints": "[x, y, z]", "arm.limits": [1, 2], "arm.bytes": [1, 2]}
    result = set_them(watcher, speed=2, gear="4", any="now a text", **arm)
    assert (result.error, result.refused) == ("", {})
    values = {name: node.get_parameter(name).value for name in ("speed", "gear", "any")}
    assert values == {"speed": 2.0, "gear": 4, "any": "now a text"}
    assert node.get_parameter("arm.joints").value == ["x", "y", "z"]
    assert list(node.get_parameter("arm.limits").value) == [1.0, 2.0]
    assert list(node.get_parameter("arm.bytes").value) == [b"\x01", b"\x02"]
    assert rows(watcher)["speed"].value == 2.0


def test_each_refusal_is_told_and_the_others_are_set(watcher: Watcher, node: Any) -> None:
    arm: dict[str, Any] = {"arm.flags": [False]}
    result = set_them(watcher, speed="fast", frame="map", on=False, nothing=1, gear=9, **arm)
    assert result.error == ""
    assert result.refused["speed"] == "expected a number, got 'fast'"
    assert result.refused["frame"].startswith("it is read-only")
    assert result.refused["on"] == "somebody must drive"
    assert result.refused["nothing"] == "the node has no such parameter"
    assert "gear" in result.refused
    assert set(result.refused) == {"speed", "frame", "on", "nothing", "gear"}
    assert node.get_parameter("arm.flags").value == [False]


@pytest.mark.usefixtures("node")
def test_a_stopped_node_ends_in_a_time_out_and_holds_up_nothing(watcher: Watcher, module_domain: int) -> None:
    asleep = Peer("asleep", module_domain, "--parameters")
    assert "use_sim_time" in rows(watcher, "/asleep")
    os.kill(asleep.process.pid, signal.SIGSTOP)
    try:
        read = watcher.observer.ask(ReadParameters("/asleep", timeout_s=3.0))
        write = watcher.observer.ask(SetParameters("/asleep", {"use_sim_time": True}, timeout_s=3.0))
        assert rows(watcher)["speed"].type_name == "double"
        assert not read.done()
        assert read.result(40).error == "/asleep does not answer within 3 s"
        assert write.result(40).error == "/asleep does not answer within 3 s"
    finally:
        os.kill(asleep.process.pid, signal.SIGCONT)
    assert "use_sim_time" in rows(watcher, "/asleep")
    asleep.close()


# ---------------------------------------------------------------- goals


@pytest.fixture
def server(talker: Peer, request: pytest.FixtureRequest) -> Peer:
    """The talker, with an action that only this test knows."""
    talker.action = f"/{request.node.originalname}"
    talker.serve_action(talker.action)
    return talker


def send(watcher: Watcher, action: str, x: float = 1.0) -> int:
    return watcher.observer.ask(SendGoal(action, DRIVE, {"x": x})).result(30)


def goal(watcher: Watcher, number: int) -> Goal | None:
    return next((each for each in watcher.update.goals if each.number == number), None)


def wait_for(watcher: Watcher, number: int, *statuses: GoalStatus) -> Goal:
    def has() -> Goal | None:
        found = goal(watcher, number)
        return found if found and found.status in statuses else None

    return wait_until(has, f"goal {number} is one of {statuses}, not {goal(watcher, number)}")


def at_work(watcher: Watcher, server: Peer, x: float = 1.0, action: str = "") -> int:
    action = action or server.action
    number = send(watcher, action, x)
    wait_until(lambda: [x, 0.0] in server.goals(action), "the goal at its server")
    wait_for(watcher, number, GoalStatus.EXECUTING)
    return number


def test_a_goal_is_accepted_executed_and_succeeds(watcher: Watcher, server: Peer) -> None:
    number = at_work(watcher, server, 2.0)
    server.feedback(server.action, goal=0, distance=1.5)
    server.feedback(server.action, goal=0, distance=0.5)

    def fed() -> Goal | None:
        found = goal(watcher, number)
        return found if found and found.feedback_count == 2 else None

    told = wait_until(fed, "two feedbacks")
    assert told.feedback == {"distance": 0.5}
    assert told.goal == {"x": 2.0, "y": 0.0, "tolerance": 0.0}
    assert (told.result, told.error, told.ended) == (None, "", False)
    server.finish(server.action, goal=0, how="succeed", reached=True, distance=0.1)
    told = wait_for(watcher, number, GoalStatus.SUCCEEDED)
    assert told.result == {"reached": True, "distance": 0.1, "message": ""}
    assert (told.error, told.ended, told.action, told.type_name) == ("", True, server.action, DRIVE)
    assert told.elapsed_s > 0
    watcher.observer.ask(ForgetGoal(number))
    wait_until(lambda: not watcher.update.goals, "the goal is forgotten")


def test_a_goal_is_cancelled(watcher: Watcher, server: Peer) -> None:
    number = at_work(watcher, server)
    watcher.observer.ask(CancelGoal(number))
    wait_for(watcher, number, GoalStatus.CANCELING)
    server.finish(server.action, goal=0, how="canceled", distance=2.0)
    told = wait_for(watcher, number, GoalStatus.CANCELED)
    assert (told.error, told.result) == ("", {"reached": False, "distance": 2.0, "message": ""})


def test_goals_that_run_are_cancelled_with_all_that_commands(watcher: Watcher, server: Peer) -> None:
    at_work(watcher, server)
    watcher.observer.ask(StopCommanding())
    wait_until(lambda: server.cancels(server.action) == 1, "its server is asked to cancel")


def test_goals_that_run_are_cancelled_when_the_observer_stops(server: Peer, module_domain: int) -> None:
    watcher = Watcher(module_domain)
    at_work(watcher, server)
    watcher.close()
    assert server.cancels(server.action) == 1
    with pytest.raises(ObserverError):
        watcher.observer.ask(SendGoal(server.action, DRIVE, {})).result(10)
    watcher.observer.ask(CancelGoal(1))
    watcher.observer.ask(ForgetGoal(1))


def test_what_cannot_be_sent_is_refused_in_words(watcher: Watcher, talker: Peer) -> None:
    talker.serve_action("/drive_to")
    wait_until(lambda: any(a.name == "/drive_to" for a in watcher.update.actions), "the action")
    other = "example_interfaces/action/Fibonacci"
    for action, type_name, values, kind, words in (
        ("/drive_to", DRIVE, {"x": "far"}, FieldError, "x: expected a number, got 'far'"),
        ("/drive_to", other, {}, GoalError, f"/drive_to is a {DRIVE}, not a {other}"),
        ("/free", "foo_msgs/action/Bar", {}, UnknownTypeError, "foo_msgs is not installed"),
        ("/free", "std_msgs/msg/Bool", {}, UnknownTypeError, "write it as package/action/Name"),
        ("/a name", DRIVE, {}, GoalError, "/a name cannot be sent a goal"),
    ):
        with pytest.raises(kind, match=words):
            watcher.observer.ask(SendGoal(action, type_name, values)).result(30)
    assert talker.goals("/drive_to") == []
    assert watcher.update.goals == ()


# ---------------------------------------------------------------- goals of others


@pytest.fixture(scope="module")
def stranger(module_domain: int) -> Iterator[Peer]:
    stranger = Peer("stranger", module_domain)
    yield stranger
    stranger.close()


def seen(watcher: Watcher, *statuses: GoalStatus) -> list[SeenGoal]:
    """Wait until the goals of others are seen to stand so."""
    return wait_until(
        lambda: (
            [goal.status for goal in watcher.update.seen_goals] == list(statuses) and list(watcher.update.seen_goals)
        ),
        lambda: f"{statuses}, not {watcher.update.seen_goals}",
    )


def stranger_at_work(server: Peer, stranger: Peer, x: float = 1.0) -> None:
    """A goal of the stranger's that the server executes."""
    stranger.send_drive(server.action, x=x)
    wait_until(lambda: [x, 0.0] in server.goals(server.action), "the goal at its server")


def test_a_goal_of_another_is_cancelled_that_one_alone_and_its_client_is_told(
    watcher: Watcher, server: Peer, stranger: Peer
) -> None:
    stranger_at_work(server, stranger, 1.0)
    stranger_at_work(server, stranger, 2.0)
    watcher.want(actions=[server.action])
    _first, second = seen(watcher, GoalStatus.EXECUTING, GoalStatus.EXECUTING)
    watcher.observer.ask(CancelSeenGoal(server.action, second.goal_id))
    seen(watcher, GoalStatus.EXECUTING, GoalStatus.CANCELING)
    server.finish(server.action, goal=1, how="canceled")
    wait_until(lambda: stranger.ends(server.action) == {"1": CANCELED}, "a word to its client")
    (first, second) = seen(watcher, GoalStatus.EXECUTING, GoalStatus.CANCELED)
    assert server.cancels(server.action) == 1
    assert first.error == second.error == ""
    server.finish(server.action, goal=0, how="succeed")
