"""Checks of a node's process: what it logs, and how it ends."""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import signal
import time
from typing import TYPE_CHECKING

from course.judge.evidence import MET, Observation
from course.judge.missing import dead_nodes
from launcher.status import NodeState
from text.sentences import say

if TYPE_CHECKING:
    from course.judge.evidence import Evidence
    from launcher.profile.steps.checks import EndsCheck, LogCheck
    from launcher.status import NodeStatus

BACK_WITHIN_S = 10.0
BEGUN_AFTER_S = 1.0
"""A process of this age has made its node; the graph may still name the one before it."""
TERMINATED_WITHIN_S = 5.0
KILLED_AFTER_S = 12.0
"""The supervisor's own waits between its signals, and a little more."""


def log(check: LogCheck, evidence: Evidence, since_s: float) -> Observation:
    """A node logs a line."""
    lines = evidence.lines(check.log, since_s)
    fitting = [line for line in lines if re.search(check.matches, line.text)]
    right = [line for line in fitting if check.level in (None, line.severity.value)]
    if len(right) >= check.lines:
        return MET
    if fitting and not right:
        return Observation(
            met=False,
            seen=say(
                "{node} logs it as {found}, not as {wanted}: {text}",
                node=check.log,
                found=fitting[0].severity.value,
                wanted=check.level,
                text=fitting[0].text,
            ),
        )
    if right:
        seen = say("{node} logs it fewer than {n} times", node=check.log, n=check.lines)
    elif lines:
        # The first: it is the same in each run.
        seen = say("{node} logs instead: {text}", node=check.log, text=lines[0].text)
    else:
        seen = say("{node} logs nothing", node=check.log)
    return Observation(met=False, seen=seen, look=dead_nodes(evidence))


async def ends(check: EndsCheck, evidence: Evidence) -> Observation:
    """A node ends by itself when it is asked to, with a code; afterwards it runs again.

    How long that takes says more of the machine than of the node: what hears no signal is killed.
    """
    node = evidence.nodes.get(check.ends)
    if node is None or not node.state.alive:
        return Observation(met=False, seen=dead_nodes(evidence) or say("{node} does not run", node=check.ends))
    await evidence.until(lambda: MET if _is_at_work(check.ends, evidence) else None, BACK_WITHIN_S)
    affected = [check.ends, *_dependants(check.ends, evidence)]
    evidence.touched.update(affected)
    try:
        if check.signal == "SIGTERM":
            await _terminated(node, evidence)
        else:
            await _stopped(check.ends, evidence)
        after = evidence.nodes[check.ends]
        observation = _how(check, after.exit_code, after.signal)
    finally:
        # Also if the learner turns to another step meanwhile.
        await evidence.client.start(*affected)
    await evidence.until(lambda: MET if _is_back(check.ends, evidence) else None, BACK_WITHIN_S)
    return observation


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


def _how(check: EndsCheck, code: int | None, ended_by: str | None) -> Observation:
    if ended_by is not None:
        return Observation(
            met=False,
            seen=say("{node} did not end by itself: {signal} killed it", node=check.ends, signal=ended_by),
            look=say("Ctrl-C is an exception, KeyboardInterrupt: catch it around rclpy.spin."),
        )
    if code != check.code:
        return Observation(
            met=False,
            seen=say("{node} ends with exit code {code}", node=check.ends, code=code),
            look=say(
                "Catch KeyboardInterrupt and ExternalShutdownException around rclpy.spin, and call "
                "rclpy.try_shutdown() instead of rclpy.shutdown()."
            ),
        )
    return MET


def _is_at_work(name: str, evidence: Evidence) -> bool:
    """Whether it has begun to spin: one that has just been saved still imports, and cannot end."""
    begun = time.time() - evidence.began_s(name) > BEGUN_AFTER_S
    return begun and _is_back(name, evidence) and evidence.node(f"/{name}") is not None


def _is_back(name: str, evidence: Evidence) -> bool:
    return evidence.nodes[name].state in (NodeState.READY, NodeState.RUNNING, NodeState.FAILED)
