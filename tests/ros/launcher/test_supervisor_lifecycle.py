"""Nodes with a lifecycle under a supervisor: waited for, brought up, or failed; real rclpy."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import pytest
from lifecycle_msgs.srv import ChangeState

from launcher.status import NodeState, Severity
from tests.ros.peer import ROOT, Peer
from tests.ros.supervised import until_state
from tests.waiting import until

if TYPE_CHECKING:
    from launcher.client.client import SupervisorClient
    from tests.ros.supervised import Launch

pytestmark = pytest.mark.nightly


def managed(name: str, **keys: Any) -> dict[str, Any]:
    """A node of `tests.ros.managed_nodes`, named after what its on_configure does."""
    program = [sys.executable, "-m", "tests.ros.managed_nodes", name]
    return {"exec": program, "cwd": str(ROOT), **keys}


async def lines(client: SupervisorClient, name: str, severity: Severity) -> list[str]:
    return [line.text for line in await client.history(name, 50) if line.severity is severity]


async def test_a_node_is_brought_up_and_those_that_need_it_wait(start: Launch) -> None:
    client = await start(
        {
            "good": managed("good", lifecycle="active", ready={"within": 40}),
            "after": managed(
                "refusing",
                needs=["good"],
                lifecycle="active",
                ready={"node": "refusing", "within": 40},
            ),
        }
    )
    assert client.nodes["after"].state is NodeState.WAITING
    await until_state(client, "good", NodeState.READY)
    failed = await until_state(client, "after", NodeState.FAILED)
    assert failed.detail.startswith("configure failed, it is unconfigured now")
    assert failed.pid is None
    told = await lines(client, "after", Severity.ERROR)
    assert any("configure failed, it is unconfigured now" in line for line in told)
    assert client.nodes["good"].state is NodeState.READY


async def test_a_node_is_waited_for_that_somebody_else_activates(
    start: Launch, ros_domain: int
) -> None:
    client = await start({"good": managed("good", ready={"lifecycle": "active", "within": 40})})
    await until(
        lambda: client.nodes["good"].detail == "good is unconfigured, expected active", "its state"
    )
    with Peer(ros_domain, "manager") as manager:
        request = ChangeState.Request()
        for transition, state in (("configure", "inactive"), ("activate", "active")):
            assert client.nodes["good"].state is NodeState.STARTING
            request.transition.label = transition
            assert manager.ask("/good/change_state", ChangeState, request).success
            if state == "inactive":
                await until(lambda: "inactive" in client.nodes["good"].detail, state)
    await until_state(client, "good", NodeState.READY)


async def test_a_node_that_hangs_or_has_no_lifecycle_is_late_and_says_why(start: Launch) -> None:
    client = await start(
        {
            "hanging": managed("hanging", lifecycle="active", ready={"within": 3}),
            "plain": {"run": "nodes.hello", "lifecycle": "active", "ready": {"within": 2}},
        }
    )
    plain = await until_state(client, "plain", NodeState.RUNNING)
    assert plain.detail == (
        "not ready within 2 s: plain tells no state: it is not there, or has no lifecycle"
    )
    await client.stop("plain")
    assert client.nodes["plain"].state is NodeState.EXITED
    late = "not ready within 3 s: hanging is unconfigured, expected active"
    await until(lambda: client.nodes["hanging"].detail == late, "why it is late")
    assert client.nodes["hanging"].state is NodeState.RUNNING


async def test_an_exception_is_a_failure_that_is_tried_again(start: Launch) -> None:
    client = await start({"raising": managed("raising", lifecycle="active", restart="on-failure")})
    again = await until_state(client, "raising", NodeState.BACKOFF)
    assert again.detail.startswith("configure failed, it is unconfigured now")
    assert "again in" in again.detail
