"""Learners' nodes that fail without having been asked for anything: some seconds after their start.

At which step that happens depends on how fast all of it is, and so would the grade. Therefore such
a node fails every step that needs it, also those that were judged before. Whether a node fails by
itself, or by what a step has asked of it, is tried: it is started anew and left alone.
"""

from __future__ import annotations

import time
from collections.abc import Sequence

from course.judge.at_work import learners_nodes, not_at_work, trouble
from course.judge.evidence import Evidence
from course.results import CheckResult, StepResult
from launcher.profile.steps.checks import CheckDocument, NodeCheck
from launcher.profile.steps.model import StepDocument

BEGUN_WITHIN_S = 20.0
WATCHED_S = 8.0
"""How old a process of each node must have become at least, without failing."""
LONGER, AND_S, ALONE_AT_MOST_S = 1.25, 2.0, 15.0
"""How much longer than it had lived when it failed a node is left alone, and at most how long."""


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
