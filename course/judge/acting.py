"""The kinds of checks that ask something of a node: a service, an action, a parameter, its end."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import time
from typing import TYPE_CHECKING

from course.judge.evidence import MET, Observation, missed
from course.judge.fields import FieldMissingError, differs, field_at, shown
from course.judge.missing import dead_nodes
from graph.data import GoalStatus
from graph.observer.requests import CallService, CancelGoal, ForgetGoal, ReadParameters, SendGoal, SetParameters
from launcher.status import NodeState
from text.sentences import reason_of, say
from text.suggestions import nearest

if TYPE_CHECKING:
    from course.judge.evidence import Evidence
    from graph.data import Goal, ParameterRow
    from launcher.profile.steps.checks import ActionCheck, NodeCheck, ParameterCheck, ServiceCheck
    from launcher.status import NodeStatus

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
    """A service answers as it should."""
    there = await evidence.until(lambda: _served(check.service, check.type, evidence), NOTICED_S)
    if not there.met:
        return there
    result = await asyncio.wrap_future(
        evidence.observer.ask(CallService(check.service, check.type, check.request, check.within))
    )
    if not result.ok or result.response is None:
        return missed(
            result.error,
            dead_nodes(evidence) or say("Does the callback return the response, and does it not wait for too long?"),
        )
    if not differs(check.response, result.response, check.tolerance):
        return MET
    return missed(
        say(
            "{service} was asked {request} and answered {response}",
            service=check.service,
            request=shown(check.request),
            response=shown(result.response),
        )
    )


def _served(name: str, type_name: str, evidence: Evidence) -> Observation:
    wanted = "/" + name.lstrip("/")
    row = next((row for row in evidence.update.services if row.name == wanted), None)
    if row is not None:
        return _of_type(wanted, row.type_names, type_name)
    meant = nearest(wanted, [row.name for row in evidence.update.services if "parameter" not in row.name])
    seen = say("there is no service {service}", service=wanted)
    if meant:
        seen = say("there is no service {service}, but {meant}", service=wanted, meant=meant)
    return missed(seen, dead_nodes(evidence) or say("Is create_service called in __init__?"))


def _of_type(name: str, found: tuple[str, ...], wanted: str) -> Observation:
    if found == (wanted,):
        return MET
    words = say("{service} has the type {found}, not {wanted}", service=name, found=", ".join(found), wanted=wanted)
    return missed(words)


async def action(check: ActionCheck, evidence: Evidence) -> Observation:
    """An action carries a goal out, refuses it, or lets go of it."""
    name = "/" + check.action.lstrip("/")
    there = await evidence.until(lambda: _offered(name, check.type, evidence), NOTICED_S)
    if not there.met:
        return there
    try:
        number = await asyncio.wrap_future(evidence.observer.ask(SendGoal(name, check.type, check.goal)))
    except Exception as error:  # noqa: BLE001 - a goal that cannot be sent
        return missed(reason_of(error))
    try:
        return await _pursued(check, number, evidence)
    finally:
        evidence.observer.ask(ForgetGoal(number))


def _offered(name: str, type_name: str, evidence: Evidence) -> Observation:
    row = next((row for row in evidence.update.actions if row.name == name), None)
    if row is not None and row.servers:
        return _of_type(name, row.type_names, type_name)
    return missed(
        say("there is no action {action}", action=name),
        dead_nodes(evidence) or say("Is the ActionServer made in __init__?"),
    )


async def _pursued(check: ActionCheck, number: int, evidence: Evidence) -> Observation:
    asked_to_cancel = False
    deadline_s = time.monotonic() + check.within
    goal: Goal | None = None
    while time.monotonic() < deadline_s and not evidence.ended:
        await evidence.wait(0.1)
        goal = next((each for each in evidence.update.goals if each.number == number), goal)
        if goal is None:
            continue
        if goal.ended:
            return _ended(check, goal)
        if check.cancel and goal.feedback_count and not asked_to_cancel:
            evidence.observer.ask(CancelGoal(number))
            asked_to_cancel = True
    where = goal.status.value if goal is not None else GoalStatus.SENDING.value
    seen = say("after {seconds} s the goal is still: {status}", seconds=f"{check.within:g}", status=where)
    return missed(seen, dead_nodes(evidence))


def _ended(check: ActionCheck, goal: Goal) -> Observation:
    wanted = GoalStatus.SUCCEEDED if check.accepted else GoalStatus.REJECTED
    if check.cancel:
        wanted = GoalStatus.CANCELED
    if goal.status is not wanted:
        return missed(
            say(
                "the goal ended as {found}, not as {wanted}: {why}",
                found=goal.status.value,
                wanted=wanted.value,
                why=goal.error or "-",
            )
        )
    if check.feedback:
        if goal.feedback is None:
            return missed(say("no feedback came"))
        try:
            field_at(goal.feedback, check.feedback)
        except FieldMissingError as error:
            return missed(error.words)
    if check.result and differs(check.result, goal.result or {}, check.tolerance):
        return missed(say("the result is {result}", result=shown(goal.result or {})))
    return MET


async def parameter(check: ParameterCheck, evidence: Evidence) -> Observation:
    """A node declares a parameter, and takes or refuses values."""
    node = "/" + check.of.lstrip("/")
    row = await _declared(check.parameter, node, check.within, evidence)
    if isinstance(row, Observation):
        return row
    if check.type is not None and row.type_name != check.type:
        return missed(
            say(
                "the parameter {name} is a {found}, not a {wanted}",
                name=check.parameter,
                found=row.type_name,
                wanted=check.type,
            ),
            say("The type is that of the default value: 0.5 is a double, 1 an integer."),
        )
    if check.value is not None and differs(check.value, row.value, None):
        return missed(_parameter_is(check, row.value))
    observation = MET
    if check.set is not None:
        observation = await _takes(check, node, row, evidence)
    if observation.met and check.refuses is not None:
        observation = await _refuses(check, node, row, evidence)
    return observation


def _parameter_is(check: ParameterCheck, value: object) -> str:
    return say("the parameter {name} is {value}", name=check.parameter, value=shown(value))


async def _declared(name: str, node: str, within_s: float, evidence: Evidence) -> ParameterRow | Observation:
    there = await evidence.until(lambda: MET if evidence.node(node) is not None else missed(""), within_s)
    # A node's services are announced apart from its name, on a busy machine seconds later.
    served = f"{node}/list_parameters"
    await evidence.until(
        lambda: MET if any(row.name == served for row in evidence.update.services) else None,
        NOTICED_S if there.met else 0.0,
    )
    if not there.met:
        return missed(say("there is no node {node}", node=node), dead_nodes(evidence))
    result = await asyncio.wrap_future(evidence.observer.ask(ReadParameters(node, within_s)))
    row = next((row for row in result.parameters if row.name == name), None)
    if row is not None:
        return row
    if result.error:
        return missed(result.error)
    meant = nearest(name, [row.name for row in result.parameters])
    seen = say("{node} declares no parameter {name}", node=node, name=name)
    if meant:
        seen = say("{node} declares no parameter {name}, but {meant}", node=node, name=name, meant=meant)
    return missed(seen, say("Is declare_parameter called in __init__?"))


async def _takes(check: ParameterCheck, node: str, row: ParameterRow, evidence: Evidence) -> Observation:
    result = await asyncio.wrap_future(evidence.observer.ask(SetParameters(node, {check.parameter: check.set})))
    why = result.error or result.refused.get(check.parameter, "")
    if why:
        value = shown(check.set)
        return missed(
            say("the parameter {name} does not take {value}: {why}", name=check.parameter, value=value, why=why)
        )
    read = await asyncio.wrap_future(evidence.observer.ask(ReadParameters(node)))
    now = next((each for each in read.parameters if each.name == check.parameter), row)
    await _put_back(check, node, row, evidence)
    return missed(_parameter_is(check, now.value)) if differs(check.set, now.value, None) else MET


async def _refuses(check: ParameterCheck, node: str, row: ParameterRow, evidence: Evidence) -> Observation:
    result = await asyncio.wrap_future(evidence.observer.ask(SetParameters(node, {check.parameter: check.refuses})))
    if result.error:
        return missed(result.error)
    if check.parameter in result.refused:
        return MET
    await _put_back(check, node, row, evidence)
    return missed(
        say("the parameter {name} takes {value}", name=check.parameter, value=shown(check.refuses)),
        say("A callback of add_on_set_parameters_callback can refuse a value."),
    )


async def _put_back(check: ParameterCheck, node: str, row: ParameterRow, evidence: Evidence) -> None:
    if row.value is not None:
        await asyncio.wrap_future(evidence.observer.ask(SetParameters(node, {check.parameter: row.value})))


async def node(check: NodeCheck, evidence: Evidence) -> Observation:
    """Wait for a node, and see that it is there a while later: one without a spin ends at once."""
    if check.ends is not None:
        return await _ends(check.node.lstrip("/"), check, evidence)
    deadline_s = time.monotonic() + check.within
    while True:
        left_s = deadline_s - time.monotonic()
        observation = await evidence.until(lambda: _is_there(check, evidence), max(left_s, 0))
        if not observation.met:
            return observation
        pid = _pid(check, evidence)
        await evidence.let_pass(STAYS_S)
        if _is_there(check, evidence).met and _pid(check, evidence) == pid:
            return MET


def _pid(check: NodeCheck, evidence: Evidence) -> int | None:
    process = evidence.nodes.get(check.node.lstrip("/"))
    return process.pid if process is not None else None


def _is_there(check: NodeCheck, evidence: Evidence) -> Observation:
    """A node is in the graph, and its process runs: the graph forgets a dead one only later."""
    wanted = "/" + check.node.lstrip("/")
    process = evidence.nodes.get(wanted.lstrip("/"))
    if evidence.node(wanted) is not None and (process is None or process.state.alive):
        return MET
    meant = nearest(wanted, [row.name for row in evidence.update.nodes])
    seen = say("there is no node {node}", node=wanted)
    if meant:
        seen = say("there is no node {node}, but {meant}", node=wanted, meant=meant)
    return missed(seen, dead_nodes(evidence) or say("Is the node made in main, and does rclpy.spin get it?"))


async def _ends(name: str, check: NodeCheck, evidence: Evidence) -> Observation:
    """A node ends by itself when it is asked to, with a code; afterwards it runs again.

    How long that takes says more of the machine than of the node: what hears no signal is killed.
    """
    node = evidence.nodes.get(name)
    if node is None or not node.state.alive:
        return missed(dead_nodes(evidence) or say("{node} does not run", node=name))
    await evidence.until(lambda: MET if _is_at_work(name, evidence) else None, BACK_WITHIN_S)
    affected = [name, *_dependants(name, evidence)]
    evidence.touched.update(affected)
    try:
        if check.signal == "SIGTERM":
            await _terminated(node, evidence)
        else:
            await _stopped(name, evidence)
        after = evidence.nodes[name]
        observation = _how_it_ended(name, check.ends, after)
    finally:
        # Also if the learner turns to another step meanwhile.
        await evidence.client.start(*affected)
    await evidence.until(lambda: MET if _is_back(name, evidence) else None, BACK_WITHIN_S)
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


async def _stopped(name: str, evidence: Evidence) -> None:
    """Have the supervisor end a node: by SIGINT at first."""
    stopping = asyncio.ensure_future(evidence.client.stop(name))
    try:
        await asyncio.wait_for(asyncio.shield(stopping), KILLED_AFTER_S)
    except asyncio.TimeoutError:
        await evidence.client.stop(name, now=True)
        await stopping


async def _terminated(node: NodeStatus, evidence: Evidence) -> None:
    """End a node by SIGTERM, as a robot that is switched off does; a confined one is not the leader of its group."""
    if node.pid is not None:
        with contextlib.suppress(OSError):
            os.killpg(node.pid, signal.SIGTERM)

    def has_ended() -> Observation | None:
        return MET if evidence.nodes[node.name].pid != node.pid else None

    if not (await evidence.until(has_ended, TERMINATED_WITHIN_S)).met:
        await _stopped(node.name, evidence)


def _is_at_work(name: str, evidence: Evidence) -> bool:
    """Whether it has begun to spin: one that has just been saved still imports, and cannot end."""
    begun = time.time() - evidence.began_s(name) > BEGUN_AFTER_S
    return begun and _is_back(name, evidence) and evidence.node(f"/{name}") is not None


def _is_back(name: str, evidence: Evidence) -> bool:
    return evidence.nodes[name].state in (NodeState.READY, NodeState.RUNNING, NodeState.FAILED)
