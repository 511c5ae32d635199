"""The kinds of checks that ask something of a node: a service, an action, a parameter, its end."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import time

from course.judge.evidence import MET, Evidence, Observation, missed
from course.judge.fields import FieldMissingError, differs, field_at, shown
from course.judge.looking import but, dead_nodes
from graph.data import Goal, GoalStatus, ParameterRow, Value
from graph.observer.requests import CallService, CancelGoal, ForgetGoal, ReadParameters, SendGoal, SetParameters
from launcher.profile.steps.checks import ActionCheck, NodeCheck, ParameterCheck, ServiceCheck
from launcher.status import NodeState, NodeStatus
from text.sentences import reason_of, say

NOTICED_S = 6.0
"""How long a service or an action may take to be discovered."""
STAYS_S = 1.0
"""How long a node must at least have been in the graph."""
BACK_WITHIN_S = 10.0
BEGUN_AFTER_S = 1.0
"""A process of this age has made its node; the graph may still name the one before it."""
TERMINATED_WITHIN_S = 5.0
KILLED_AFTER_S = 12.0
"""The supervisor's own waits between its signals, and a little more."""


async def service(check: ServiceCheck, evidence: Evidence) -> Observation:
    name = "/" + check.service.lstrip("/")

    def served() -> Observation:
        row = next((row for row in evidence.update.services if row.name == name), None)
        if row is not None:
            return _of_type(name, row.type_names, check.type)
        others = (row.name for row in evidence.update.services if "parameter" not in row.name)
        seen = but(say("there is no service {service}", service=name), name, others)
        return missed(seen, dead_nodes(evidence) or say("Is create_service called in __init__?"))

    there = await evidence.until(served, NOTICED_S)
    if not there.met:
        return there
    result = await evidence.ask(CallService(check.service, check.type, check.request, check.within))
    if not result.ok or result.response is None:
        look = say("Does the callback return the response, and does it not wait for too long?")
        return missed(result.error, dead_nodes(evidence) or look)
    if not differs(check.response, result.response, check.tolerance):
        return MET
    asked, response = shown(check.request), shown(result.response)
    words = say("{service} was asked {request} and answered {response}", service=check.service, request=asked,
                response=response)  # fmt: skip
    return missed(words)


def _of_type(name: str, found: tuple[str, ...], wanted: str) -> Observation:
    if found == (wanted,):
        return MET
    words = say("{service} has the type {found}, not {wanted}", service=name, found=", ".join(found), wanted=wanted)
    return missed(words)


async def action(check: ActionCheck, evidence: Evidence) -> Observation:
    name = "/" + check.action.lstrip("/")

    def offered() -> Observation:
        row = next((row for row in evidence.update.actions if row.name == name), None)
        if row is not None and row.servers:
            return _of_type(name, row.type_names, check.type)
        look = dead_nodes(evidence) or say("Is the ActionServer made in __init__?")
        return missed(say("there is no action {action}", action=name), look)

    there = await evidence.until(offered, NOTICED_S)
    if not there.met:
        return there
    try:
        number = await evidence.ask(SendGoal(name, check.type, check.goal))
    except Exception as error:  # noqa: BLE001 - a goal that cannot be sent
        return missed(reason_of(error))
    try:
        return await _pursued(check, number, evidence)
    finally:
        evidence.observer.ask(ForgetGoal(number))


async def _pursued(check: ActionCheck, number: int, evidence: Evidence) -> Observation:
    to_cancel = check.cancel
    deadline_s = time.monotonic() + check.within
    goal: Goal | None = None
    while time.monotonic() < deadline_s and not evidence.ended:
        await evidence.wait(0.1)
        goal = next((each for each in evidence.update.goals if each.number == number), goal)
        if goal is not None and goal.ended:
            return _ended(check, goal)
        if goal is not None and goal.feedback_count and to_cancel:
            evidence.observer.ask(CancelGoal(number))
            to_cancel = False
    where = goal.status.value if goal is not None else GoalStatus.SENDING.value
    seen = say("after {seconds} s the goal is still: {status}", seconds=f"{check.within:g}", status=where)
    return missed(seen, dead_nodes(evidence))


def _ended(check: ActionCheck, goal: Goal) -> Observation:
    wanted = GoalStatus.SUCCEEDED if check.accepted else GoalStatus.REJECTED
    if check.cancel:
        wanted = GoalStatus.CANCELED
    if goal.status is not wanted:
        found, why = goal.status.value, goal.error or "-"
        words = say("the goal ended as {found}, not as {wanted}: {why}", found=found, wanted=wanted.value, why=why)
        return missed(words)
    if check.feedback:
        if goal.feedback is None:
            return missed(say("no feedback came"))
        try:
            field_at(goal.feedback, check.feedback)
        except FieldMissingError as error:
            return missed(reason_of(error))
    if check.result and differs(check.result, goal.result or {}, check.tolerance):
        return missed(say("the result is {result}", result=shown(goal.result or {})))
    return MET


async def parameter(check: ParameterCheck, evidence: Evidence) -> Observation:
    """A node declares a parameter, and takes or refuses values."""
    node, name = "/" + check.of.lstrip("/"), check.parameter
    row = await _declared(name, node, check.within, evidence)
    if isinstance(row, Observation):
        return row
    if check.type is not None and row.type_name != check.type:
        found = row.type_name
        seen = say("the parameter {name} is a {found}, not a {wanted}", name=name, found=found, wanted=check.type)
        return missed(seen, say("The type is that of the default value: 0.5 is a double, 1 an integer."))
    if check.value is not None and differs(check.value, row.value, None):
        return _is_now(name, row.value)
    taken = MET if check.set is None else await _takes(check.set, row, node, evidence)
    return taken if check.refuses is None or not taken.met else await _refuses(check.refuses, row, node, evidence)


def _is_now(name: str, value: Value | None) -> Observation:
    return missed(say("the parameter {name} is {value}", name=name, value=shown(value)))


async def _declared(name: str, node: str, within_s: float, evidence: Evidence) -> ParameterRow | Observation:
    if not await evidence.holds(lambda: evidence.node(node) is not None, within_s):
        return missed(say("there is no node {node}", node=node), dead_nodes(evidence))
    # A node's services are announced apart from its name, on a busy machine seconds later.
    served = f"{node}/list_parameters"
    await evidence.holds(lambda: any(row.name == served for row in evidence.update.services), NOTICED_S)
    result = await evidence.ask(ReadParameters(node, within_s))
    row = next((row for row in result.parameters if row.name == name), None)
    if row is not None:
        return row
    if result.error:
        return missed(result.error)
    seen = say("{node} declares no parameter {name}", node=node, name=name)
    names = (row.name for row in result.parameters)
    return missed(but(seen, name, names), say("Is declare_parameter called in __init__?"))


async def _takes(value: Value, row: ParameterRow, node: str, evidence: Evidence) -> Observation:
    result = await evidence.ask(SetParameters(node, {row.name: value}))
    if why := result.error or result.refused.get(row.name, ""):
        text = shown(value)
        return missed(say("the parameter {name} does not take {value}: {why}", name=row.name, value=text, why=why))
    read = await evidence.ask(ReadParameters(node))
    now = next((each for each in read.parameters if each.name == row.name), row)
    await _put_back(row, node, evidence)
    return _is_now(row.name, now.value) if differs(value, now.value, None) else MET


async def _refuses(value: Value, row: ParameterRow, node: str, evidence: Evidence) -> Observation:
    result = await evidence.ask(SetParameters(node, {row.name: value}))
    if result.error:
        return missed(result.error)
    if row.name in result.refused:
        return MET
    await _put_back(row, node, evidence)
    return missed(
        say("the parameter {name} takes {value}", name=row.name, value=shown(value)),
        say("A callback of add_on_set_parameters_callback can refuse a value."),
    )


async def _put_back(row: ParameterRow, node: str, evidence: Evidence) -> None:
    if row.value is not None:
        await evidence.ask(SetParameters(node, {row.name: row.value}))


async def node(check: NodeCheck, evidence: Evidence) -> Observation:
    """Wait for a node, and see that it is there a while later: one without a spin ends at once."""
    name = check.node.lstrip("/")
    if check.ends is not None:
        return await _ends(name, check, evidence)

    def is_there() -> Observation:
        """It is in the graph, and its process runs: the graph forgets a dead one only later."""
        process = evidence.nodes.get(name)
        if evidence.node(f"/{name}") is not None and (process is None or process.state.alive):
            return MET
        seen = say("there is no node {node}", node=f"/{name}")
        look = dead_nodes(evidence) or say("Is the node made in main, and does rclpy.spin get it?")
        return missed(but(seen, f"/{name}", (row.name for row in evidence.update.nodes)), look)

    def pid() -> int | None:
        return evidence.nodes[name].pid if name in evidence.nodes else None

    deadline_s = time.monotonic() + check.within
    while True:
        observation = await evidence.until(is_there, max(deadline_s - time.monotonic(), 0))
        if not observation.met:
            return observation
        before = pid()
        await evidence.let_pass(STAYS_S)
        if is_there().met and pid() == before:
            return MET


async def _ends(name: str, check: NodeCheck, evidence: Evidence) -> Observation:
    """A node ends by itself when it is asked to, with a code; afterwards it runs again.

    How long that takes says more of the machine than of the node: what hears no signal is killed.
    """
    node = evidence.nodes.get(name)
    if node is None or not node.state.alive:
        return missed(dead_nodes(evidence) or say("{node} does not run", node=name))

    def is_back() -> bool:
        return evidence.nodes[name].state in (NodeState.READY, NodeState.RUNNING, NodeState.FAILED)

    def is_at_work() -> bool:
        """It has begun to spin: one that has just been saved still imports, and cannot end."""
        begun = time.time() - evidence.began_s(name) > BEGUN_AFTER_S
        return begun and is_back() and evidence.node(f"/{name}") is not None

    await evidence.holds(is_at_work, BACK_WITHIN_S)
    affected = [name, *_dependants(name, evidence)]
    evidence.touched.update(affected)
    try:
        await (_terminated if check.signal == "SIGTERM" else _stopped)(node, evidence)
        observation = _how_it_ended(name, check.ends, evidence.nodes[name])
    finally:
        # Also if the learner turns to another step meanwhile.
        await evidence.client.start(*affected)
    await evidence.holds(is_back, BACK_WITHIN_S)
    return observation


def _how_it_ended(name: str, code: int | None, now: NodeStatus) -> Observation:
    if now.signal is not None:
        return missed(
            say("{node} did not end by itself: {signal} killed it", node=name, signal=now.signal),
            say("Ctrl-C is an exception, KeyboardInterrupt: catch it around rclpy.spin."),
        )
    if now.exit_code == code:
        return MET
    return missed(
        say("{node} ends with exit code {code}", node=name, code=now.exit_code),
        say(
            "Catch KeyboardInterrupt and ExternalShutdownException around rclpy.spin, and call "
            "rclpy.try_shutdown() instead of rclpy.shutdown()."
        ),
    )


def _dependants(name: str, evidence: Evidence) -> list[str]:
    """Return the running nodes that need a node, and end before it."""
    found = {name}
    while more := {each.name for each in evidence.nodes.values() if each.name not in found and found & {*each.needs}}:
        found |= more
    return [each for each in evidence.nodes if each in found - {name} and evidence.nodes[each].state.alive]


async def _stopped(node: NodeStatus, evidence: Evidence) -> None:
    """Have the supervisor end a node: by SIGINT at first."""
    stopping = asyncio.ensure_future(evidence.client.stop(node.name))
    try:
        await asyncio.wait_for(asyncio.shield(stopping), KILLED_AFTER_S)
    except asyncio.TimeoutError:
        await evidence.client.stop(node.name, now=True)
        await stopping


async def _terminated(node: NodeStatus, evidence: Evidence) -> None:
    """End a node by SIGTERM, as a robot that is switched off does; a confined one is not the leader of its group."""
    if node.pid is not None:
        with contextlib.suppress(OSError):
            os.killpg(node.pid, signal.SIGTERM)
    if not await evidence.holds(lambda: evidence.nodes[node.name].pid != node.pid, TERMINATED_WITHIN_S):
        await _stopped(node, evidence)
