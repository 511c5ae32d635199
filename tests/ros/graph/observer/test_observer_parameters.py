"""Parameters of real nodes: read with their descriptors, set by their types, or why not."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from typing import Any

import pytest
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.parameter import Parameter

from graph.data import ParameterRow, SetResult
from tests.ros.observing import Peer as Process
from tests.ros.observing import Watcher
from tests.ros.peer import Peer
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

MANY = 1500


@pytest.fixture(scope="module")
def node(module_domain: int) -> Iterator[Any]:
    with Peer(module_domain, "robot") as peer:
        declare(peer.node)
        yield peer.node


@pytest.fixture(scope="module")
def watcher(module_domain: int, node: Any) -> Iterator[Watcher]:
    watcher = Watcher(module_domain)
    wait_until(lambda: watcher.serves(f"/{node.get_name()}/list_parameters"), "the node")
    yield watcher
    watcher.close()


def declare(node: Any) -> None:
    speed = FloatingPointRange(from_value=0.0, to_value=2.0, step=0.5)
    gears = IntegerRange(from_value=1, to_value=6, step=0)
    node.declare_parameter(
        "speed",
        1.0,
        ParameterDescriptor(
            description="how fast",
            additional_constraints="slow indoors",
            floating_point_range=[speed],
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
    result = watcher.observer.parameters(node, timeout_s=30).result(40)
    assert result.error == ""
    assert result.node == node
    assert result.elapsed_s > 0
    assert [row.name for row in result.parameters] == sorted(r.name for r in result.parameters)
    return {row.name: row for row in result.parameters}


def set_them(watcher: Watcher, node: str = "/robot", **values: Any) -> SetResult:
    return watcher.observer.set_parameters(node, values, timeout_s=30).result(40)


def test_a_change_by_another_client_is_told(watcher: Watcher, node: Any) -> None:
    """What a screen that shows them follows in order to read them anew."""
    watcher.observer.follow(["/parameter_events"])
    try:

        def told() -> bool:
            node.set_parameters([Parameter("gear", value=1)])
            return any(
                event["node"] == "/robot"
                and [one["name"] for one in event["changed_parameters"]] == ["gear"]
                for event in watcher.of("/parameter_events")
            )

        wait_until(told, "the event")
    finally:
        watcher.observer.follow(())


def test_all_parameters_come_with_types_values_and_descriptors(watcher: Watcher) -> None:
    found = rows(watcher)
    assert found["speed"] == ParameterRow(
        "speed", "double", 1.0, "how fast", "slow indoors", False, 0.0, 2.0, 0.5
    )
    assert found["gear"] == ParameterRow("gear", "integer", 1, least=1.0, greatest=6.0, step=None)
    assert found["frame"] == ParameterRow("frame", "string", "base_link", read_only=True)
    assert found["arm.joints"] == ParameterRow("arm.joints", "string_array", ["a", "b"])
    assert found["arm.limits"] == ParameterRow("arm.limits", "double_array", [1.0, 2.5])
    assert found["arm.numbers"] == ParameterRow("arm.numbers", "integer_array", [1, 2])
    assert found["arm.flags"] == ParameterRow("arm.flags", "bool_array", [True, False])
    assert found["arm.bytes"] == ParameterRow("arm.bytes", "byte_array", b"\x00\xff")


def test_one_without_a_value_hides_no_other(watcher: Watcher) -> None:
    found = rows(watcher)
    assert found["never_set"] == ParameterRow("never_set", "double", None)
    assert found["on"].value is True


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


def test_setting_nothing_is_no_fault(watcher: Watcher) -> None:
    assert set_them(watcher).refused == {}


def test_a_node_may_have_any_number_of_parameters(watcher: Watcher, module_domain: int) -> None:
    with Peer(module_domain, "hoard") as peer:
        for number in range(MANY):
            peer.node.declare_parameter(f"group_{number % 7}.p{number}", number)
        wait_until(lambda: watcher.serves("/hoard/list_parameters"), "its services")
        found = rows(watcher, "/hoard")
        mine = {name: row.value for name, row in found.items() if name.startswith("group_")}
        assert mine == {f"group_{n % 7}.p{n}": n for n in range(MANY)}
        values = dict.fromkeys(mine, -1)
        assert set_them(watcher, "/hoard", **values).refused == {}
        assert peer.node.get_parameter("group_0.p0").value == -1
        assert peer.node.get_parameter(f"group_{(MANY - 1) % 7}.p{MANY - 1}").value == -1


def test_a_node_without_parameter_services_gets_its_own_words(
    watcher: Watcher, module_domain: int
) -> None:
    mute = Process("mute", module_domain)
    wait_until(lambda: watcher.node("/mute"), "the node")
    result = watcher.observer.parameters("/mute").result(40)
    assert result.error.startswith("/mute has no parameter services")
    refused = watcher.observer.set_parameters("/mute", {"a": 1}).result(40)
    assert refused.error == result.error
    mute.close()


def test_a_node_that_is_not_there_is_named(watcher: Watcher) -> None:
    result = watcher.observer.parameters("/nobody").result(40)
    assert result.error == "there is no node /nobody in the graph"


def test_a_stopped_node_ends_in_a_time_out_and_holds_up_nothing(
    watcher: Watcher, module_domain: int
) -> None:
    asleep = Process("asleep", module_domain, "--parameters")
    wait_until(lambda: watcher.serves("/asleep/list_parameters"), "its services")
    assert "use_sim_time" in rows(watcher, "/asleep")
    os.kill(asleep.process.pid, signal.SIGSTOP)
    try:
        read = watcher.observer.parameters("/asleep", timeout_s=3.0)
        write = watcher.observer.set_parameters("/asleep", {"use_sim_time": True}, timeout_s=3.0)
        assert rows(watcher)["speed"].type_name == "double"
        assert not read.done()
        assert read.result(40).error == "/asleep does not answer within 3 s"
        assert write.result(40).error == "/asleep does not answer within 3 s"
    finally:
        os.kill(asleep.process.pid, signal.SIGCONT)
    assert "use_sim_time" in rows(watcher, "/asleep")
    asleep.close()


def test_a_node_that_leaves_in_mid_talk_is_told_at_once(
    watcher: Watcher, module_domain: int
) -> None:
    leaving = Process("leaving", module_domain, "--parameters")
    wait_until(lambda: watcher.serves("/leaving/list_parameters"), "its services")
    assert "use_sim_time" in rows(watcher, "/leaving")
    os.kill(leaving.process.pid, signal.SIGSTOP)
    read = watcher.observer.parameters("/leaving", timeout_s=60)
    # Orders are carried out in turn: when this one is done, the question is under way.
    watcher.observer.prepare_publisher("/later", "std_msgs/msg/Bool").result(20)
    os.kill(leaving.process.pid, signal.SIGCONT)
    leaving.close()
    # It may have answered before it went; if not, nobody waits for a minute.
    result = read.result(40)
    assert not result.error or "has left the graph" in result.error


def test_what_is_asked_of_an_observer_that_stops_is_answered(module_domain: int) -> None:
    watcher = Watcher(module_domain)
    wait_until(lambda: watcher.serves("/robot/list_parameters"), "its services")
    watcher.close()
    assert "stopped" in watcher.observer.parameters("/robot").result(10).error
    assert "stopped" in watcher.observer.set_parameters("/robot", {"speed": 1}).result(10).error
