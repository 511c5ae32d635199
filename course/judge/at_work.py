"""Whether the learner's own nodes are at work: they run, and answer what every node can be asked.

What keeps a node from its work comes before whatever a check has missed meanwhile: which check that
is depends on when it happened, and the reason does not.

Some nodes fail without having been asked for anything, some seconds after their start. At which step that happens
depends on how fast all of it is, and so would the grade. Therefore such a node fails every step that needs it, also
those that were judged before. Whether a node fails by itself, or by what a step has asked of it, is tried: it is
started anew and left alone.
"""

from __future__ import annotations

import asyncio
import re
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from course.judge.evidence import MET, Evidence, Observation
from course.results import CheckResult, State, StepResult
from graph.observer.requests import CallService
from launcher.faults.crash import held_by
from launcher.processes.table import read_process
from launcher.profile.steps.checks import CheckDocument, NodeCheck
from launcher.profile.steps.model import StepDocument
from launcher.status import STUCK, NodeFault, NodeState
from text.sentences import Words, say

FOUND_WITHIN_S = 10.0
"""How long the services that every node has may take to be discovered."""
ANSWERS_WITHIN_S = 20.0
"""How long a node may take to answer: longer than until Deck reports that it is stuck."""
ASKED_AGAIN_S = 4.0
SETTLED_WITHIN_S = 10.0
"""How long a node may take to start, or the supervisor to tell that its process has ended."""
AGAIN_S = 0.2
SERVICE, TYPE = "get_parameters", "rcl_interfaces/srv/GetParameters"
_ON_THE_WAY = (NodeState.WAITING, NodeState.STARTING, NodeState.STOPPING)
_ADDRESS = re.compile(r" at 0x[0-9a-f]+")
"""Where an object is: another place in each run."""
BEGUN_WITHIN_S = 20.0
WATCHED_S = 8.0
"""How old a process of each node must have become at least, without failing."""
LONGER, AND_S, ALONE_AT_MOST_S = 1.25, 2.0, 15.0
"""How much longer than it had lived when it failed a node is left alone, and at most how long."""


def learners_nodes(step: StepDocument, evidence: Evidence) -> list[str]:
    """Return the names of the nodes that must be at work for a step: those of its file, or all."""
    own = [node for node in evidence.nodes.values() if node.file]
    named = [node.name for node in own if Path(node.file).name == step.file]
    return named or [node.name for node in own]


async def not_at_work(
    names: Sequence[str], evidence: Evidence, since_s: float, ran: frozenset[str]
) -> CheckResult | None:
    """Return what keeps a node of these from its work; None if all are at it.

    `since_s`: a crash since then counts, even if the node has been started again.
    `ran`: nodes of which the end counts as well, even if it was no crash.
    """
    await evidence.holds(lambda: _settled(names, evidence), SETTLED_WITHIN_S)
    silent = await asyncio.gather(*(_silent_node(name, evidence) for name in names))
    for name, asked_in_vain in zip(names, silent, strict=True):
        seen, look = trouble(name, evidence, since_s, ended_too=name in ran)
        fault = evidence.nodes[name].fault
        if not seen and asked_in_vain and fault is not None and held_by(fault):
            seen, look = _stuck(fault)
        elif not seen and asked_in_vain:
            seconds = f"{ANSWERS_WITHIN_S:g}"
            seen = say("{node} does not answer within {seconds} s", node=asked_in_vain, seconds=seconds)
            look = say("Does main come to rclpy.spin, and does every callback return?")
        if seen:
            # Several nodes may run it, and which of them fails first is chance.
            what = Path(evidence.nodes[name].file).name
            return CheckResult(State.FAILED, say("{program} is at work", program=what), seen, look)
    return None


def trouble(name: str, evidence: Evidence, since_s: float, *, ended_too: bool) -> tuple[str, str]:
    """Return how a node has ended, or in what it is stuck; nothing of one that runs."""
    node = evidence.trouble(name, since_s)
    if node is None:
        now = evidence.nodes[name]
        ended = ended_too and now.state is NodeState.EXITED and _is_of_ros(now.file)
        return (say("it has ended"), say("rclpy.spin keeps a node running.")) if ended else ("", "")
    fault = node.fault
    if fault is not None and node.ails:
        exception = fault.exception
        lasting = exception if isinstance(exception, Words) else _ADDRESS.sub("", exception)
        return _stuck(fault) if held_by(fault) else (replace(fault, exception=lasting).words, "")
    if node.signal is not None:
        return say("it was killed by {signal}", signal=node.signal), ""
    if node.exit_code is not None:
        return say("it has ended with exit code {code}", code=node.exit_code), ""
    return node.detail or node.state.value, ""


def _stuck(fault: NodeFault) -> tuple[str, str]:
    file = fault.file.rpartition("/")[2]
    return say("{name} in {file} does not return", name=held_by(fault), file=file), fault.meaning


def _settled(names: Sequence[str], evidence: Evidence) -> bool:
    """Whether none of these nodes is on its way, has ended untold, or is between two crashes."""
    nodes = [evidence.nodes[name] for name in names]
    processes = (read_process(node.pid) for node in nodes if node.pid is not None)
    ended = any(process is None or process.zombie for process in processes)
    return not ended and not any(node.state in _ON_THE_WAY or evidence.may_crash_again(node.name) for node in nodes)


async def _silent_node(name: str, evidence: Evidence) -> str:
    """Return the node of a process that does not answer; empty if all do, or cannot be asked."""
    pid = evidence.nodes[name].pid
    if pid is not None and _is_of_ros(evidence.nodes[name].file):
        # One that is crashing leaves the graph before its process ends.
        await evidence.holds(
            lambda: bool(_nodes_of(name, evidence)) or evidence.nodes[name].pid != pid, FOUND_WITHIN_S
        )
    for node in _nodes_of(name, evidence):
        if not await _answers(name, node, evidence):
            return node
    return ""


def _nodes_of(name: str, evidence: Evidence) -> list[str]:
    """Return the nodes of the graph that a process has made."""
    pid = evidence.nodes[name].pid
    if pid is None:
        return []
    number = evidence.number(pid)
    # Those that are confined all have the same.
    others = {f"/{each.name}" for each in evidence.nodes.values() if each.pid and evidence.number(each.pid) == number}
    others.discard(f"/{name}")
    return [row.name for row in evidence.update.nodes if number in row.processes and row.name not in others]


async def _answers(name: str, node: str, evidence: Evidence) -> bool:
    service, pid = f"{node}/{SERVICE}", evidence.nodes[name].pid

    def gone() -> bool:
        now = evidence.nodes[name]
        return now.pid != pid or (now.fault is not None and now.fault.kind == STUCK)

    def can_be_asked() -> Observation | None:
        there = any(row.name == service for row in evidence.update.services)
        return MET if there else Observation(met=False, final=gone())

    if not (await evidence.until(can_be_asked, FOUND_WITHIN_S)).met:
        return True
    deadline_s = time.monotonic() + ANSWERS_WITHIN_S
    while (left_s := deadline_s - time.monotonic()) > 0 and not gone():
        once_s = min(left_s, ASKED_AGAIN_S)
        answer = asyncio.ensure_future(evidence.ask(CallService(service, TYPE, {"names": []}, once_s)))
        try:
            await evidence.holds(lambda it=answer: it.done() or gone(), once_s + 1)  # type: ignore[misc]
            if answer.done() and answer.result().ok:
                return True
        finally:
            answer.cancel()
        # It may have been asked while it was ending, or before it served; and an answer is lost
        # if the node has not found by then who asks.
        await evidence.wait(AGAIN_S)
    # Of one that has ended there is more to say than that it does not answer.
    return evidence.nodes[name].pid != pid


def running(evidence: Evidence) -> frozenset[str]:
    return frozenset(node.name for node in evidence.nodes.values() if node.state.alive)


def _is_of_ros(file: str) -> bool:
    """Whether a program is of ROS: another one may end when it has done its work."""
    try:
        return "rclpy" in Path(file).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return False


class UnaskedFailures:
    """Those of one run of a lesson."""

    def __init__(self, evidence: Evidence) -> None:
        self._evidence = evidence
        self._seen_until_s = 0.0
        self._found: dict[str, CheckResult] = {}

    def of(self, step: StepDocument) -> CheckResult | None:
        """Return what a node of a step does by itself; None if nothing is known of that kind."""
        names = learners_nodes(step, self._evidence)
        return next((self._found[name] for name in names if name in self._found), None)

    async def look(self) -> None:
        """Try the nodes that have failed since the last look."""
        await self._try(self._failed())

    async def look_after(self, step: StepDocument, result: StepResult) -> None:
        """Try those that have failed during a step, or do nothing, though they may still run."""
        failed = self._failed()
        if len(result.checks) > len(step.checks):
            failed += [one for one in learners_nodes(step, self._evidence) if one not in failed]
        elif any(map(ends, step.checks)):
            return  # They were told to end.
        await self._try(failed)

    async def look_on(self) -> None:
        """Watch until each node has had the time to fail, and try those that do."""
        evidence = self._evidence

        def is_young(name: str) -> bool:
            return evidence.nodes[name].state.alive and evidence.lived_s(name) < WATCHED_S

        await evidence.holds(lambda: not any(map(is_young, self._own())), WATCHED_S)
        await self.look()

    def _failed(self) -> list[str]:
        since_s, self._seen_until_s = self._seen_until_s, time.time()
        return [name for name in self._own() if trouble(name, self._evidence, since_s, ended_too=True)[0]]

    def _own(self) -> list[str]:
        """Return the learner's nodes of which nothing is known yet."""
        nodes = self._evidence.nodes.values()
        return [node.name for node in nodes if node.file and node.name not in self._found]

    async def _try(self, names: Sequence[str]) -> None:
        """Start nodes anew and leave them alone; note those that fail again."""
        if not names:
            return
        evidence = self._evidence
        lived_s = max(map(evidence.lived_s, names))
        await start_anew(names, evidence)
        since_s = {name: evidence.began_s(name) for name in names}
        for name in names:
            evidence.forget_earlier_crash(name)

        def fail() -> bool:
            return all(trouble(name, evidence, since_s[name], ended_too=True)[0] for name in names)

        await evidence.holds(fail, min(LONGER * lived_s + AND_S, ALONE_AT_MOST_S))
        for name in names:
            idle = await not_at_work([name], evidence, since_s[name], frozenset([name]))
            if idle is not None:
                self._found[name] = idle
        self._seen_until_s = time.time()


def ends(check: CheckDocument) -> bool:
    return isinstance(check, NodeCheck) and check.ends is not None


async def start_anew(names: Sequence[str], evidence: Evidence) -> None:
    """Start nodes anew; return once the process of each has begun."""
    before_s = {name: evidence.began_s(name) for name in names}
    evidence.touched.update(names)
    await evidence.client.restart(*names)
    await evidence.holds(lambda: all(evidence.began_s(name) > before_s[name] for name in names), BEGUN_WITHIN_S)
