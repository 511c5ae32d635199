"""A node's life, on a clock that the test moves and with processes that obey it."""

from __future__ import annotations

import signal
from dataclasses import replace

import pytest

from cli.health import well
from launcher.processes.exit import Exit
from launcher.profile.node import Node, Ready
from launcher.status import IDLE, STUCK, NodeFault, NodeState, Severity
from launcher.supervisor.readiness import NotBroughtUpError
from launcher.supervisor.words import Seen
from tests.unit.launcher.supervisor.fake_session import PLAN, FakeSession, crash, planned, started
from tests.unit.manual_clock import settle
from text.i18n import localized

ACTIVE = Ready(node="sonar", lifecycle="active", goes=True)
TOPIC = Ready(topic="/sonar", within=7)


async def test_a_node_without_a_condition_runs_at_once(session: FakeSession) -> None:
    node = await started(session)
    status = node.status()
    assert (status.state, status.pid, status.restarts) == (NodeState.RUNNING, 100, 0)
    assert node.serves


async def test_a_node_is_ready_when_its_condition_holds(session: FakeSession) -> None:
    node = await started(session, planned(ready=Ready(topic="/sonar")))
    assert (node.state, node.serves) == (NodeState.STARTING, False)
    assert "/sonar" in node.detail
    session.is_ready.set()
    await settle()
    assert (node.state, node.serves) == (NodeState.READY, True)


async def test_a_node_that_is_not_ready_in_time_runs_on_and_says_so(session: FakeSession) -> None:
    node = await started(session, planned(ready=Ready(node="sonar", within=7)))
    await session.clock.advance(7)
    assert (node.state, node.serves) == (NodeState.RUNNING, False)
    assert node.detail == "not ready within 7 s: node sonar is not in the graph"
    session.is_ready.set()
    await settle()
    assert (node.state, node.detail, node.serves) == (NodeState.READY, "", True)


async def test_what_there_is_in_place_of_what_is_awaited_is_told_at_once(session: FakeSession) -> None:
    awaited = Ready(topic="/sonar", type="std_msgs/msg/Float32", rate=5, within=7)
    node = await started(session, planned(ready=awaited))
    session.tell(Seen(("std_msgs/msg/String",)))
    wrong = "/sonar is published as std_msgs/msg/String, expected std_msgs/msg/Float32"
    assert (node.state, node.detail) == (NodeState.STARTING, wrong)
    await session.clock.advance(7)
    assert (node.state, node.detail) == (NodeState.RUNNING, f"not ready within 7 s: {wrong}")
    session.tell(Seen(("std_msgs/msg/Float32",), 1.25))
    assert node.detail == "not ready within 7 s: /sonar arrives at 1.2 Hz, expected 5 Hz"
    assert not node.serves


async def test_a_node_is_brought_up_before_its_other_condition(session: FakeSession) -> None:
    node = await started(session, planned(lifecycle="active", ready=TOPIC))
    assert (node.state, node.detail) == (NodeState.STARTING, "waiting for sonar to be active")
    session.tell(Seen(("configuring",)))
    assert node.detail == "sonar is configuring, expected active"
    await session.clock.advance(7)
    assert node.state is NodeState.RUNNING
    assert node.detail == "not ready within 7 s: sonar is configuring, expected active"
    session.is_ready.set()
    await settle()
    assert session.awaited == [ACTIVE, TOPIC]
    assert (node.state, node.serves) == (NodeState.READY, True)


async def test_a_node_that_fails_to_come_up_is_ended_and_has_failed(session: FakeSession) -> None:
    session.never = NotBroughtUpError("configure", "unconfigured")
    session.is_ready.set()
    node = await started(session, planned(lifecycle="active", restart="never"))
    await settle()
    assert session.process.heard == [(100, signal.SIGINT)]
    why = "configure failed, it is unconfigured now: no such port"
    assert (node.state, node.detail, node.serves) == (NodeState.FAILED, why, False)
    assert why in session.lines
    assert session.gravest is Severity.ERROR


async def test_a_node_waits_for_those_it_needs(session: FakeSession) -> None:
    session.absent = "waiting for camera"
    node = await started(session)
    assert (node.state, node.detail) == (NodeState.WAITING, "waiting for camera")
    session.absent = ""
    node.needs_changed()
    await settle()
    assert node.state is NodeState.RUNNING


async def test_a_node_that_waits_can_be_started_by_hand(session: FakeSession) -> None:
    session.absent = "waiting for camera"
    node = await started(session)
    node.start()
    await settle()
    assert node.state is NodeState.RUNNING


async def test_a_crash_is_told_and_the_node_started_again_after_a_while(session: FakeSession) -> None:
    node = await started(session)
    await crash(session)
    assert node.state is NodeState.BACKOFF
    assert node.detail == "exit code 1: no such port; again in 1 s"
    assert node.status().exit_code == 1
    await session.clock.advance(0.9)
    assert len(session.started) == 1
    await session.clock.advance(0.2)
    assert (node.state, node.status().restarts) == (NodeState.RUNNING, 1)
    assert node.status().exit_code is None


@pytest.mark.parametrize("file", ["", "/own/hello.py"])
async def test_why_it_has_crashed_is_told_until_it_has_been_well_for_a_while(session: FakeSession, file: str) -> None:
    fault = NodeFault("crash", file, 3, exception="ValueError: x") if file else None
    session.fault = fault
    node = await started(session, planned(run=file or None, exec=None if file else ("sonar",)))
    await crash(session)
    await session.clock.advance(1.1)
    assert node.state is NodeState.RUNNING
    assert node.status().detail == (fault.words if fault else "exit code 1: no such port")
    if fault:
        assert node.status().fault == replace(fault, kind="warning"), "nothing is wrong now"
    await session.clock.advance(9.0)
    assert node.status().fault or node.status().detail
    await session.clock.advance(2.0)
    assert (node.status().fault, node.status().detail) == (None, "")


async def test_a_node_that_is_started_by_hand_has_no_crash_to_tell_of(session: FakeSession) -> None:
    node = await started(session)
    await crash(session)
    await session.clock.advance(1.1)
    node.restart()
    await settle()
    assert (node.state, node.status().detail) == (NodeState.RUNNING, "")


async def test_a_crash_before_it_is_ready_waits_as_long(session: FakeSession) -> None:
    node = await started(session, planned(ready=TOPIC))
    await crash(session)
    assert (node.state, len(session.started)) == (NodeState.BACKOFF, 1)
    await session.clock.advance(0.9)
    assert len(session.started) == 1
    await session.clock.advance(0.2)
    assert (node.state, len(session.started)) == (NodeState.STARTING, 2)


async def test_a_file_that_does_not_compile_is_not_tried_again_until_it_is_saved(session: FakeSession) -> None:
    node = await started(session, planned(run="/own/hello.py", exec=None))
    session.fault = fault = NodeFault("syntax", "/own/hello.py", 3, exception="SyntaxError: x")
    await crash(session)
    assert (node.state, node.detail, node.fault) == (NodeState.FAILED, fault.words, fault)
    node.saved(None)
    await settle()
    assert (node.state, len(session.started)) == (NodeState.RUNNING, 2)


@pytest.mark.parametrize(
    ("kind", "state", "gravest"),
    [(IDLE, NodeState.FAILED, Severity.ERROR), ("warning", NodeState.EXITED, Severity.WARN)],
)
async def test_what_an_early_end_is_called_agrees_with_its_state(
    session: FakeSession, kind: str, state: NodeState, gravest: Severity
) -> None:
    """A main that nobody calls is an error, said once, and no healthy end."""
    node = await started(session, planned(run="/own/hello.py", exec=None))
    session.early = fault = NodeFault(kind, "/own/hello.py", 3, exception="it came to its end")
    session.process.end(100, Exit(0))
    await settle()
    assert (node.state, node.detail, session.gravest) == (state, fault.words, gravest)
    assert session.lines.count(fault.words) == 1
    assert well(node.status()) is (kind == "warning")


async def test_a_stuck_callback_ails_the_node_until_it_returns(session: FakeSession) -> None:
    node = await started(session, planned(run="/own/hello.py", exec=None))
    node.ail(fault := NodeFault(STUCK, "/own/hello.py", 3, exception="tick has been stuck"))
    assert (node.status().ails, node.status().why) == (True, fault.words)
    assert session.gravest is Severity.ERROR
    node.go_on()
    assert not node.status().ails
    assert well(node.status())


async def test_a_node_that_a_signal_has_suspended_is_not_healthy_until_it_goes_on(session: FakeSession) -> None:
    node = await started(session, planned(run="/own/hello.py", exec=None))
    node.warn(warning := NodeFault("warning", "/own/hello.py", 3, exception="a warning"))
    node.halted(100)
    assert (node.status().ails, well(node.status())) == (True, False)
    assert node.status().why.startswith("suspended by a signal (SIGSTOP, pid 100). ")
    assert "kill -CONT 100" in node.status().why
    assert session.gravest is Severity.ERROR
    told = list(session.lines)
    node.halted(100)
    assert session.lines == told, "it is told once"
    node.halted(0)
    assert (node.status().fault, well(node.status())) == (warning, True)
    assert session.lines[-1] == "it runs again, after SIGCONT"


async def test_an_interrupted_node_is_not_called_killed(session: FakeSession) -> None:
    node = await started(session, planned(restart="never"))
    session.process.end(100, Exit(None, "SIGINT"))
    await settle()
    assert localized(node.detail, "ru").startswith("прерван (SIGINT)")


def test_an_exception_that_is_a_sentence_gets_no_second_full_stop() -> None:
    fault = NodeFault("crash", "/a.py", 3, exception="Error: no workspace.", meaning="Type it.")
    assert fault.words == "a.py:3: Error: no workspace. Type it."


async def test_a_crash_loop_ends_with_a_word_why(session: FakeSession) -> None:
    node = await started(session)
    for delay in (1, 2, 4, 8):
        await crash(session)
        await session.clock.advance(delay)
    await crash(session)
    assert node.state is NodeState.FAILED
    assert node.detail == "given up after 5 exits in 15 s: exit code 1: no such port"
    await session.clock.advance(300)
    assert len(session.started) == 5


async def test_a_node_given_up_can_be_started_by_hand(session: FakeSession) -> None:
    node = await started(session, planned(restart="never"))
    await crash(session)
    given_up = node.state
    assert given_up is NodeState.FAILED
    node.start()
    await settle()
    assert node.state is NodeState.RUNNING


async def test_a_process_that_cannot_be_started_is_tried_again(session: FakeSession) -> None:
    session.refuses = "too many processes"
    node = await started(session)
    assert node.detail == "cannot be started: too many processes; again in 1 s"
    session.refuses = ""
    await session.clock.advance(1)
    assert node.state is NodeState.RUNNING


OPTIONAL = planned(optional=True)
MODULE = planned(run="nodes.sonar", exec=None)
PUBLISHES, SERVES = planned(ready=Ready(topic="/x")), planned(ready=Ready(service="/x"))
IS_THERE = planned(ready=Ready(node="/x"))
ABSENT = "deck: command not found: sonar"
LESSON_GOES_ON = "not installed; the lesson continues without it"


@pytest.mark.parametrize("was_ready", [True, False])
@pytest.mark.parametrize(
    ("plan", "code", "last", "state", "detail"),
    [
        (PLAN, 0, "", "EXITED", "ended"),
        (PLAN, 127, "", "FAILED", "exit code 127"),
        (PLAN, 127, ABSENT, "FAILED", "sonar is not installed"),
        (OPTIONAL, 127, ABSENT, "EXITED", "sonar is not installed; the lesson continues without it"),
        (replace(OPTIONAL, restart="never"), 127, "x", "EXITED", "exit code 127: x"),
        (MODULE, 2, "no such port", "FAILED", "exit code 2: no such port"),
        (replace(MODULE, restart="always"), 2, "", "FAILED", "exit code 2"),
        (PUBLISHES, 0, "", "FAILED", "ended by itself, but should still publish /x"),
        (SERVES, 0, "", "FAILED", "ended by itself, but should still serve /x"),
        (IS_THERE, 0, "", "EXITED", "ended"),
    ],
)
async def test_an_end_is_told_as_what_it_is_and_not_tried_again(
    session: FakeSession, plan: Node, code: int, last: str, state: str, detail: str, was_ready: bool
) -> None:
    if was_ready:
        session.is_ready.set()
    node = await started(session, plan)
    session.said_last = last
    session.process.end(100, Exit(code))
    await settle()
    assert (node.state, node.detail) == (NodeState[state], detail)
    alarm = {"FAILED": Severity.ERROR, "EXITED": Severity.WARN if code else Severity.INFO}[state]
    assert session.gravest is alarm
    assert session.lines.count(detail) == 1
