"""Whether a run went well is told from the nodes' statuses."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cli.health import over, settled, well
from launcher.status import HALTED, IDLE, STUCK, THREAD, NodeFault, NodeState, NodeStatus
from launcher.supervisor.readiness import ReadyCondition, Seen
from launcher.supervisor.words import instead, what


def node(name: str, state: NodeState, **more: object) -> NodeStatus:
    """Return a status."""
    return replace(NodeStatus(name, "x", state), **more)  # type: ignore[arg-type]


READY, RUNNING, FAILED = NodeState.READY, NodeState.RUNNING, NodeState.FAILED
STARTING, WAITING, EXITED = NodeState.STARTING, NodeState.WAITING, NodeState.EXITED
TOPIC = ReadyCondition("topic", "/scan", "std_msgs/msg/Float32", 5.0)
LATE = "not ready within 10 s: nobody publishes /scan"


@pytest.mark.parametrize("kind", ["syntax", "import", "crash", STUCK, THREAD, IDLE])
@pytest.mark.parametrize("state", [READY, RUNNING, EXITED, STARTING])
def test_a_node_that_ails_is_not_healthy_whatever_its_state(kind: str, state: NodeState) -> None:
    ailing = node("a", state, fault=NodeFault(kind, "/own/a.py", 3, exception="x"))
    assert not well(ailing)
    assert not well(ailing, on_the_way=True)
    assert well(ailing, optional=("a",))
    assert ailing.why == "a.py:3: x"


def test_what_is_wrong_with_a_program_as_a_whole_has_no_place() -> None:
    fault = NodeFault(HALTED, exception="suspended", meaning="`kill -CONT 7`")
    assert node("a", READY, fault=fault).why == "suspended. `kill -CONT 7`"


def statuses(*nodes: NodeStatus) -> dict[str, NodeStatus]:
    """Return the nodes by name."""
    return {each.name: each for each in nodes}


@pytest.mark.parametrize(
    ("nodes", "is_settled", "is_over"),
    [
        ([node("a", READY), node("b", RUNNING)], True, False),
        ([node("a", READY), node("b", STARTING)], False, False),
        ([node("a", READY), node("b", WAITING, needs=("a",))], False, False),
        ([node("a", STARTING), node("b", WAITING, needs=("a",))], False, False),
        ([node("a", FAILED), node("b", WAITING, needs=("a",))], True, True),
        ([node("a", RUNNING, detail=LATE), node("b", WAITING, needs=("a",))], True, False),
        ([node("a", WAITING)], False, False),
        ([node("a", EXITED), node("b", FAILED)], True, True),
        ([node("a", EXITED), node("b", NodeState.BACKOFF)], True, False),
        ([node("a", EXITED), node("b", NodeState.STOPPING)], True, False),
    ],
)
def test_when_all_is_up_and_when_all_is_over(
    nodes: list[NodeStatus], is_settled: bool, is_over: bool
) -> None:
    assert settled(statuses(*nodes)) is is_settled
    assert over(statuses(*nodes)) is is_over


@pytest.mark.parametrize(
    ("status", "is_well"),
    [
        (node("a", READY), True),
        (node("a", RUNNING), True),
        (node("a", RUNNING, detail="whether it is ready cannot be determined"), True),
        (node("a", RUNNING, detail=LATE), False),
        (node("a", READY, restarts=1), False),
        (node("a", EXITED, exit_code=0), True),
        (node("a", EXITED, exit_code=3), False),
        (node("a", EXITED, signal="SIGKILL"), False),
        (node("a", FAILED), False),
        (node("a", NodeState.BACKOFF), False),
        (node("a", STARTING), False),
        (node("a", WAITING), False),
    ],
)
def test_which_nodes_are_well(status: NodeStatus, is_well: bool) -> None:
    assert well(status) is is_well
    assert well(status, {"a"})


def test_a_node_on_its_way_up_is_none_the_worse_if_nobody_waited() -> None:
    assert well(node("a", STARTING), on_the_way=True)
    assert well(node("a", WAITING), on_the_way=True)
    assert not well(node("a", STARTING, restarts=2), on_the_way=True)
    assert not well(node("a", FAILED), on_the_way=True)


def test_a_node_that_publishes_another_type_is_not_on_its_way_up() -> None:
    waits = str(what(TOPIC))
    slow = str(instead(TOPIC, Seen((TOPIC.type,), 0.5)))
    other = str(instead(TOPIC, Seen(("std_msgs/msg/String",))))
    assert well(node("a", STARTING, detail=waits), on_the_way=True)
    assert well(node("a", STARTING, detail=slow), on_the_way=True)
    assert not well(node("a", STARTING, detail=other), on_the_way=True)
