"""Checks that ask something of a node: a service, an action, a parameter."""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING

from course.judge.evidence import MET, Observation
from course.judge.fields import FieldMissingError, differs, field_at, shown
from course.judge.missing import dead_nodes
from graph.data import GoalStatus
from graph.observer.requests import CallService, CancelGoal, ForgetGoal, ReadParameters, SendGoal, SetParameters
from text.sentences import reason_of, say
from text.suggestions import nearest

if TYPE_CHECKING:
    from course.judge.evidence import Evidence
    from graph.data import Goal, ParameterRow
    from launcher.profile.steps.checks import ActionCheck, ParameterCheck, ServiceCheck

NOTICED_S = 6.0
"""How long a service or an action may take to be discovered."""


async def service(check: ServiceCheck, evidence: Evidence) -> Observation:
    """A service answers as it should."""
    there = await evidence.until(lambda: _served(check.service, check.type, evidence), NOTICED_S)
    if not there.met:
        return there
    call = evidence.observer.ask(CallService(check.service, check.type, check.request, check.within))
    result = await asyncio.wrap_future(call)
    if not result.ok or result.response is None:
        return Observation(
            met=False,
            seen=result.error,
            look=dead_nodes(evidence)
            or say("Does the callback return the response, and does it not wait for too long?"),
        )
    if differs(check.response, result.response, check.tolerance):
        return Observation(
            met=False,
            seen=say(
                "{service} was asked {request} and answered {response}",
                service=check.service,
                request=shown(check.request),
                response=shown(result.response),
            ),
        )
    return MET


def _served(name: str, type_name: str, evidence: Evidence) -> Observation:
    wanted = "/" + name.lstrip("/")
    row = next((row for row in evidence.update.services if row.name == wanted), None)
    if row is None:
        offered = [row.name for row in evidence.update.services if "parameter" not in row.name]
        meant = nearest(wanted, offered)
        seen = say("there is no service {service}", service=wanted)
        if meant:
            seen = say("there is no service {service}, but {meant}", service=wanted, meant=meant)
        look = dead_nodes(evidence) or say("Is create_service called in __init__?")
        return Observation(met=False, seen=seen, look=look)
    if row.type_names != (type_name,):
        return Observation(
            met=False,
            seen=say(
                "{service} has the type {found}, not {wanted}",
                service=wanted,
                found=", ".join(row.type_names),
                wanted=type_name,
            ),
        )
    return MET


async def action(check: ActionCheck, evidence: Evidence) -> Observation:
    """An action carries a goal out, refuses it, or lets go of it."""
    name = "/" + check.action.lstrip("/")
    there = await evidence.until(lambda: _offered(name, check.type, evidence), NOTICED_S)
    if not there.met:
        return there
    try:
        number = await asyncio.wrap_future(evidence.observer.ask(SendGoal(name, check.type, check.goal)))
    except Exception as error:  # noqa: BLE001 - a goal that cannot be sent
        return Observation(met=False, seen=reason_of(error))
    try:
        return await _pursued(check, number, evidence)
    finally:
        evidence.observer.ask(ForgetGoal(number))


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
    return Observation(
        met=False,
        seen=say("after {seconds} s the goal is still: {status}", seconds=f"{check.within:g}", status=where),
        look=dead_nodes(evidence),
    )


def _ended(check: ActionCheck, goal: Goal) -> Observation:
    wanted = GoalStatus.SUCCEEDED if check.accepted else GoalStatus.REJECTED
    if check.cancel:
        wanted = GoalStatus.CANCELED
    if goal.status is not wanted:
        return Observation(
            met=False,
            seen=say(
                "the goal ended as {found}, not as {wanted}: {why}",
                found=goal.status.value,
                wanted=wanted.value,
                why=goal.error or "-",
            ),
        )
    if check.feedback:
        if goal.feedback is None:
            return Observation(met=False, seen=say("no feedback came"))
        try:
            field_at(goal.feedback, check.feedback)
        except FieldMissingError as error:
            return Observation(met=False, seen=error.words)
    if check.result and differs(check.result, goal.result or {}, check.tolerance):
        return Observation(met=False, seen=say("the result is {result}", result=shown(goal.result or {})))
    return MET


def _offered(name: str, type_name: str, evidence: Evidence) -> Observation:
    row = next((row for row in evidence.update.actions if row.name == name), None)
    if row is None or not row.servers:
        return Observation(
            met=False,
            seen=say("there is no action {action}", action=name),
            look=dead_nodes(evidence) or say("Is the ActionServer made in __init__?"),
        )
    if row.type_names != (type_name,):
        return Observation(
            met=False,
            seen=say(
                "{service} has the type {found}, not {wanted}",
                service=name,
                found=", ".join(row.type_names),
                wanted=type_name,
            ),
        )
    return MET


async def parameter(check: ParameterCheck, evidence: Evidence) -> Observation:
    """A node declares a parameter, and takes or refuses values."""
    node = "/" + check.of.lstrip("/")
    row = await _declared(check.parameter, node, check.within, evidence)
    if isinstance(row, Observation):
        return row
    if check.type is not None and row.type_name != check.type:
        return Observation(
            met=False,
            seen=say(
                "the parameter {name} is a {found}, not a {wanted}",
                name=check.parameter,
                found=row.type_name,
                wanted=check.type,
            ),
            look=say("The type is that of the default value: 0.5 is a double, 1 an integer."),
        )
    if check.value is not None and differs(check.value, row.value, None):
        return Observation(
            met=False, seen=say("the parameter {name} is {value}", name=check.parameter, value=shown(row.value))
        )
    if check.set is not None:
        observation = await _takes(check, node, row, evidence)
        if not observation.met:
            return observation
    return await _refuses(check, node, row, evidence) if check.refuses is not None else MET


async def _declared(name: str, node: str, within_s: float, evidence: Evidence) -> ParameterRow | Observation:
    there = await evidence.until(lambda: MET if evidence.node(node) is not None else Observation(met=False), within_s)
    # A node's services are announced apart from its name, on a busy machine seconds later.
    served = f"{node}/list_parameters"
    await evidence.until(
        lambda: MET if any(row.name == served for row in evidence.update.services) else None,
        NOTICED_S if there.met else 0.0,
    )
    if not there.met:
        seen = say("there is no node {node}", node=node)
        return Observation(met=False, seen=seen, look=dead_nodes(evidence))
    result = await asyncio.wrap_future(evidence.observer.ask(ReadParameters(node, within_s)))
    row = next((row for row in result.parameters if row.name == name), None)
    if row is not None:
        return row
    if result.error:
        return Observation(met=False, seen=result.error)
    meant = nearest(name, [row.name for row in result.parameters])
    seen = say("{node} declares no parameter {name}", node=node, name=name)
    if meant:
        seen = say("{node} declares no parameter {name}, but {meant}", node=node, name=name, meant=meant)
    return Observation(met=False, seen=seen, look=say("Is declare_parameter called in __init__?"))


async def _takes(check: ParameterCheck, node: str, row: ParameterRow, evidence: Evidence) -> Observation:
    result = await asyncio.wrap_future(evidence.observer.ask(SetParameters(node, {check.parameter: check.set})))
    why = result.error or result.refused.get(check.parameter, "")
    if why:
        return Observation(
            met=False,
            seen=say(
                "the parameter {name} does not take {value}: {why}",
                name=check.parameter,
                value=shown(check.set),
                why=why,
            ),
        )
    read = await asyncio.wrap_future(evidence.observer.ask(ReadParameters(node)))
    now = next((each for each in read.parameters if each.name == check.parameter), row)
    await _put_back(check, node, row, evidence)
    if differs(check.set, now.value, None):
        return Observation(
            met=False, seen=say("the parameter {name} is {value}", name=check.parameter, value=shown(now.value))
        )
    return MET


async def _refuses(check: ParameterCheck, node: str, row: ParameterRow, evidence: Evidence) -> Observation:
    result = await asyncio.wrap_future(evidence.observer.ask(SetParameters(node, {check.parameter: check.refuses})))
    if result.error:
        return Observation(met=False, seen=result.error)
    if check.parameter in result.refused:
        return MET
    await _put_back(check, node, row, evidence)
    return Observation(
        met=False,
        seen=say("the parameter {name} takes {value}", name=check.parameter, value=shown(check.refuses)),
        look=say("A callback of add_on_set_parameters_callback can refuse a value."),
    )


async def _put_back(check: ParameterCheck, node: str, row: ParameterRow, evidence: Evidence) -> None:
    if row.value is not None:
        values = {check.parameter: row.value}
        await asyncio.wrap_future(evidence.observer.ask(SetParameters(node, values)))
