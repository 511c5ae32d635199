"""A node's life, on a clock that the test moves and with processes that obey it."""

from __future__ import annotations

import asyncio
import signal
from dataclasses import replace

import pytest

from cli.health import well
from launcher.processes.exit import Exit
from launcher.processes.usage import Usage
from launcher.status import IDLE, STUCK, THREAD, NodeFault, NodeState, Severity
from launcher.supervisor.lifecycle import NotBroughtUpError
from launcher.supervisor.readiness import ReadyCondition, Seen
from launcher.supervisor.readying import LATE_S
from tests.unit.launcher.supervisor.fake_session import PLAN, FakeSession, crash, started
from tests.unit.manual_clock import settle

ACTIVE = ReadyCondition("lifecycle", "sonar", "active", goes=True)
TOPIC = ReadyCondition("topic", "/sonar")


async def test_a_node_without_a_condition_runs_at_once(session: FakeSession) -> None:
    node = await started(session)
    status = node.status()
    assert (status.state, status.pid, status.restarts) == (NodeState.RUNNING, 100, 0)
    assert node.serves


async def test_what_the_process_before_cost_is_not_told_of_the_next(session: FakeSession) -> None:
    node = await started(session)
    node.usage = Usage(cpu_percent=99.0, memory_bytes=10**9)
    assert node.status().cpu_percent == 99.0
    node.restart()
    await settle()
    status = node.status()
    assert (status.pid, status.cpu_percent, status.memory_bytes) == (110, None, None)


async def test_a_node_is_ready_when_its_condition_holds(session: FakeSession) -> None:
    node = await started(session, replace(PLAN, ready=ReadyCondition("topic", "/sonar")))
    assert (node.state, node.serves) == (NodeState.STARTING, False)
    assert "/sonar" in node.detail
    session.is_ready.set()
    await settle()
    assert (node.state, node.serves) == (NodeState.READY, True)


async def test_a_node_that_is_not_ready_in_time_runs_on_and_says_so(session: FakeSession) -> None:
    node = await started(session, replace(PLAN, ready=ReadyCondition("node", "sonar"), within_s=7))
    await session.clock.advance(7)
    assert (node.state, node.serves) == (NodeState.RUNNING, False)
    assert node.detail == "not ready within 7 s: node sonar is not in the graph"
    session.is_ready.set()
    await settle()
    assert (node.state, node.detail, node.serves) == (NodeState.READY, "", True)


async def test_what_there_is_in_place_of_what_is_awaited_is_told_at_once(
    session: FakeSession,
) -> None:
    awaited = ReadyCondition("topic", "/sonar", "std_msgs/msg/Float32", 5)
    node = await started(session, replace(PLAN, ready=awaited, within_s=7))
    session.tell(Seen(("std_msgs/msg/String",)))
    wrong = "/sonar is published as std_msgs/msg/String, expected std_msgs/msg/Float32"
    assert (node.state, node.detail) == (NodeState.STARTING, wrong)
    await session.clock.advance(7)
    assert (node.state, node.detail) == (NodeState.RUNNING, f"not ready within 7 s: {wrong}")
    session.tell(Seen(("std_msgs/msg/Float32",), 1.25))
    assert node.detail == "not ready within 7 s: /sonar arrives at 1.2 Hz, expected 5 Hz"
    assert not node.serves


async def test_readiness_is_not_watched_for_ever(session: FakeSession) -> None:
    node = await started(session, replace(PLAN, ready=ReadyCondition("node", "sonar")))
    await session.clock.advance(10 + LATE_S)
    session.is_ready.set()
    await settle()
    assert node.state is NodeState.RUNNING


async def test_where_readiness_cannot_be_seen_nobody_waits_for_it(session: FakeSession) -> None:
    session.watchable = False
    node = await started(session, replace(PLAN, ready=ReadyCondition("node", "sonar")))
    assert (node.state, node.serves) == (NodeState.RUNNING, True)


async def test_a_node_is_brought_up_before_its_other_condition(session: FakeSession) -> None:
    node = await started(session, replace(PLAN, lifecycle=ACTIVE, ready=TOPIC, within_s=7))
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
    node = await started(session, replace(PLAN, lifecycle=ACTIVE, restart="never"))
    await settle()
    assert session.process.heard == [(100, signal.SIGINT)]
    why = "configure failed, it is unconfigured now: no such port"
    assert (node.state, node.detail, node.serves) == (NodeState.FAILED, why, False)
    assert why in session.lines
    assert session.gravest is Severity.ERROR


async def test_a_node_that_fails_to_come_up_is_tried_again(session: FakeSession) -> None:
    session.never = NotBroughtUpError("", "finalized")
    session.said_last = ""
    session.is_ready.set()
    node = await started(session, replace(PLAN, lifecycle=ACTIVE))
    await settle()
    assert node.state is NodeState.BACKOFF
    assert node.detail == "it is finalized, from where it gets nowhere; again in 1 s"
    session.never = None
    await session.clock.advance(1)
    assert (node.state, node.status().restarts) == (NodeState.READY, 1)


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


async def test_a_node_that_waits_can_be_stopped(session: FakeSession) -> None:
    session.absent = "waiting for camera"
    node = await started(session)
    await node.stop()
    session.absent = ""
    node.needs_changed()
    await settle()
    assert (node.state, session.started) == (NodeState.EXITED, [])


async def test_a_crash_is_told_and_the_node_started_again_after_a_while(
    session: FakeSession,
) -> None:
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


async def test_a_crash_before_it_is_ready_waits_as_long(session: FakeSession) -> None:
    node = await started(session, replace(PLAN, ready=TOPIC))
    await crash(session)
    assert (node.state, len(session.started)) == (NodeState.BACKOFF, 1)
    await session.clock.advance(0.9)
    assert len(session.started) == 1
    await session.clock.advance(0.2)
    assert (node.state, len(session.started)) == (NodeState.STARTING, 2)


async def test_a_file_that_does_not_compile_is_not_tried_again_until_it_is_saved(
    session: FakeSession,
) -> None:
    node = await started(session, replace(PLAN, file="/own/hello.py"))
    session.fault = fault = NodeFault("syntax", "/own/hello.py", 3, exception="SyntaxError: x")
    await crash(session)
    assert (node.state, node.detail, node.fault) == (NodeState.FAILED, fault.words, fault)
    node.saved(None)
    await settle()
    assert (node.state, len(session.started)) == (NodeState.RUNNING, 2)


async def test_what_is_wrong_with_a_file_stays_while_it_is_tried_until_it_runs(
    session: FakeSession,
) -> None:
    session.absent = "waiting for camera"
    node = await started(session, replace(PLAN, file="/own/hello.py", ready=TOPIC))
    fault = NodeFault("syntax", "/own/hello.py", 3, exception="SyntaxError: x")
    node.saved(fault)
    session.absent = ""
    node.needs_changed()
    await settle()
    assert (node.state, node.fault) == (NodeState.STARTING, fault)
    session.is_ready.set()
    await settle()
    assert (node.state, node.fault) == (NodeState.READY, None)


@pytest.mark.parametrize(
    ("kind", "state", "gravest"),
    [(IDLE, NodeState.FAILED, Severity.ERROR), ("warning", NodeState.EXITED, Severity.WARN)],
)
async def test_what_an_early_end_is_called_agrees_with_its_state(
    session: FakeSession, kind: str, state: NodeState, gravest: Severity
) -> None:
    """A main that nobody calls is an error, said once, and no healthy end."""
    node = await started(session, replace(PLAN, file="/own/hello.py"))
    session.early = fault = NodeFault(kind, "/own/hello.py", 3, exception="it came to its end")
    session.process.end(100, Exit(0))
    await settle()
    assert (node.state, node.detail, session.gravest) == (state, fault.words, gravest)
    assert session.lines.count(fault.words) == 1
    assert well(node.status()) is (kind == "warning")


async def test_a_stuck_callback_ails_the_node_until_it_returns(session: FakeSession) -> None:
    node = await started(session, replace(PLAN, file="/own/hello.py"))
    node.ail(fault := NodeFault(STUCK, "/own/hello.py", 3, exception="tick has been stuck"))
    assert (node.status().ails, node.status().why) == (True, fault.words)
    assert session.gravest is Severity.ERROR
    node.go_on()
    assert not node.status().ails
    assert well(node.status())


async def test_a_node_that_a_signal_has_suspended_is_not_healthy_until_it_goes_on(
    session: FakeSession,
) -> None:
    node = await started(session, replace(PLAN, file="/own/hello.py"))
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


async def test_that_it_was_suspended_is_not_told_of_the_next_process(session: FakeSession) -> None:
    node = await started(session)
    node.halted(100)
    node.restart()
    await settle()
    assert (node.status().pid, well(node.status())) == (110, True)


async def test_a_thread_that_ends_while_the_node_is_stopped_is_no_fault(
    session: FakeSession,
) -> None:
    node = await started(session, replace(PLAN, file="/own/hello.py"))
    stopping = asyncio.create_task(node.stop())
    await asyncio.sleep(0)
    node.ail(NodeFault(THREAD, "/own/hello.py", 3, exception="ExternalShutdownException"))
    assert node.fault is None
    await stopping


async def test_what_a_killed_node_said_last_is_no_reason(session: FakeSession) -> None:
    node = await started(session, replace(PLAN, restart="never"))
    session.process.end(100, Exit(None, "SIGKILL"))
    await settle()
    assert (node.state, node.detail) == (NodeState.FAILED, "killed by SIGKILL")


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
    node = await started(session, replace(PLAN, restart="never"))
    await crash(session)
    given_up = node.state
    assert given_up is NodeState.FAILED
    node.start()
    await settle()
    assert node.state is NodeState.RUNNING


async def test_a_clean_end_is_an_end(session: FakeSession) -> None:
    node = await started(session)
    session.process.end(100, Exit(0))
    await settle()
    assert (node.state, node.detail) == (NodeState.EXITED, "ended")


@pytest.mark.parametrize("was_ready", [True, False])
@pytest.mark.parametrize(
    ("kind", "state", "words"),
    [
        ("topic", NodeState.FAILED, "ended by itself, but should still publish /x"),
        ("service", NodeState.FAILED, "ended by itself, but should still serve /x"),
        ("node", NodeState.EXITED, "ended"),
    ],
)
async def test_who_is_to_publish_or_serve_does_not_end_well_by_itself(
    session: FakeSession, kind: str, state: NodeState, words: str, was_ready: bool
) -> None:
    if was_ready:
        session.is_ready.set()
    node = await started(session, replace(PLAN, ready=ReadyCondition(kind, "/x")))
    assert node.serves is was_ready
    session.process.end(100, Exit(0))
    await settle()
    assert (node.state, node.detail) == (state, words)


async def test_a_node_that_always_returns_returns_after_a_clean_end(session: FakeSession) -> None:
    node = await started(session, replace(PLAN, restart="always"))
    session.process.end(100, Exit(0))
    await session.clock.advance(1)
    assert (node.state, len(session.started)) == (NodeState.RUNNING, 2)


async def test_a_process_that_cannot_be_started_is_tried_again(session: FakeSession) -> None:
    session.refuses = "too many processes"
    node = await started(session)
    assert node.detail == "cannot be started: too many processes; again in 1 s"
    session.refuses = ""
    await session.clock.advance(1)
    assert node.state is NodeState.RUNNING


async def test_a_command_that_does_not_exist_is_not_tried_again(session: FakeSession) -> None:
    node = await started(session)
    session.process.end(100, Exit(127))
    await settle()
    assert node.state is NodeState.FAILED


@pytest.mark.parametrize("restart", ["on-failure", "always"])
async def test_a_module_that_refuses_its_parameters_is_not_tried_again(
    session: FakeSession, restart: str
) -> None:
    node = await started(session, replace(PLAN, module=("nodes.sonar",), restart=restart))
    session.process.end(100, Exit(2))
    await settle()
    assert (node.state, node.detail) == (NodeState.FAILED, "exit code 2: no such port")


async def test_a_module_that_ends_so_later_is_started_again(session: FakeSession) -> None:
    node = await started(session, replace(PLAN, module=("nodes.sonar",)))
    await session.clock.advance(60)
    session.process.end(100, Exit(2))
    await settle()
    assert node.state is NodeState.BACKOFF


async def test_an_optional_node_does_not_fail(session: FakeSession) -> None:
    node = await started(session, replace(PLAN, optional=True, restart="never"))
    session.process.end(100, Exit(127))
    await settle()
    assert (node.state, node.detail) == (NodeState.EXITED, "exit code 127: no such port")


@pytest.mark.parametrize(
    ("optional", "state", "detail", "gravest"),
    [
        (
            True,
            NodeState.EXITED,
            "sonar is not installed; the lesson continues without it",
            Severity.WARN,
        ),
        (False, NodeState.FAILED, "sonar is not installed", Severity.ERROR),
    ],
)
async def test_a_program_that_is_not_installed_is_told_and_no_alarm_if_optional(
    session: FakeSession, optional: bool, state: NodeState, detail: str, gravest: Severity
) -> None:
    node = await started(session, replace(PLAN, optional=optional))
    session.said_last = "deck: command not found: sonar"
    session.process.end(100, Exit(127))
    await settle()
    assert (node.state, node.detail) == (state, detail)
    assert session.gravest is gravest
    assert session.lines.count(detail) == 1


def test_words_can_be_translated() -> None:
    from text.packing import pack_text, unpack_text
    from text.sentences import Words, say

    words = say("{why}; again in {seconds:g} s", why=say("exit code {code}", code=1), seconds=2.0)
    packed = pack_text(words)
    again = unpack_text(packed)
    assert again == words == "exit code 1; again in 2 s"
    assert isinstance(words, Words)
    assert isinstance(again, Words)
    assert again.template == words.template
    why = again.values["why"]
    assert isinstance(why, Words)
    assert why.template == "exit code {code}"
