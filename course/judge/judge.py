"""Judging the steps of a lesson against a running profile, once or again and again."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import AsyncIterator, Callable, Iterable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from course.judge.at_work import UnaskedFailures, ends, learners_nodes, not_at_work, running, start_anew
from course.judge.evidence import Evidence
from course.judge.functions import LessonFaultError
from course.judge.kinds import expected, judged, topics_of
from course.judge.looking import dead_nodes
from course.lessons.lesson import LessonFolder
from course.results import CheckResult, State, StepResult
from graph.data import GraphUpdate, Interest
from graph.messages.making import FieldError
from graph.messages.types import UnknownTypeError
from graph.observer.observer import Observer
from launcher.client.client import SupervisorClient
from launcher.profile.steps.checks import LOOK_AGAIN_S, CheckDocument
from launcher.profile.steps.draw import draw
from launcher.profile.steps.expressions import filled
from launcher.profile.steps.model import StepDocument
from launcher.status import NodeState
from text.sentences import InLanguages, reason_of, say

PERIOD_S = 0.1
SETTLED_WITHIN_S = 15.0
NAMED_WITHIN_S = 1.5
"""After this, a node need not have the name of the profile, or not run in the process started."""
FOUND_WITHIN_S = 10.0
"""A node is not waited for any longer: a program need not have one."""
AGAIN_S = LOOK_AGAIN_S
"""How long a failed step rests before it is judged again, if nothing happens."""
IDLE_S = 5.0
"""The same where a node was not at work: it may be at any time."""

_SETTLED = (NodeState.READY, NodeState.RUNNING, NodeState.FAILED, NodeState.EXITED)


class Judge:
    """Judges a lesson; made and closed by `judging`."""

    def __init__(self, lesson: LessonFolder, evidence: Evidence, seed: int) -> None:
        self.lesson = lesson
        self.seed = seed
        self.evidence = evidence
        self.steps = {step.id: step for step in lesson.steps}
        self.over = asyncio.create_task(evidence.listen())
        """Done once the session has ended."""

    async def close(self) -> None:
        self.over.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await self.over

    async def settle(self) -> None:
        """Wait until every node is ready, or will not be, and the judge has found those there."""
        evidence = self.evidence
        await evidence.holds(lambda: all(one.state in _SETTLED for one in evidence.nodes.values()), SETTLED_WITHIN_S)
        named_by_s = time.monotonic() + NAMED_WITHIN_S

        def found() -> bool:
            alive = [node.name for node in evidence.nodes.values() if node.state.alive]
            ways = all(evidence.node(f"/{name}") for name in alive), evidence.has_found_everybody()
            return any(ways) if time.monotonic() >= named_by_s else all(ways)

        await evidence.holds(found, FOUND_WITHIN_S)

    async def once(self, on_step: Callable[[StepResult], object], *, until: str = "") -> None:
        """Judge every step once, in order; those after the step `until` are left out.

        `on_step` hears of each, and once more of one that a later failure of its node changes.
        """
        self.follow()
        await self.settle()
        results: list[StepResult] = []
        told: dict[str, StepResult] = {}
        failures = UnaskedFailures(self.evidence)

        def tell() -> None:
            for each in results:
                if told.get(each.id) != each:
                    told[each.id] = each
                    on_step(each)

        await failures.look()
        for step in self.steps.values():
            result = self.waits(step, results) or self._failed_unasked(step, failures)
            if result is None:
                await self._start_crashed()
                result = await self.step(step)
                await failures.look_after(step, result)
            results = self._revised([*results, result], failures)
            tell()
            if step.id == until:
                break
        if not until:
            await failures.look_on()
            results = self._revised(results, failures)
            tell()

    async def _start_crashed(self) -> None:
        """Start the learner's nodes that have crashed, so that each step has one that runs.

        Whether one would be started again by itself, and when, depends on how fast all of it is.
        """
        nodes = self.evidence.nodes.values()
        names = [node.name for node in nodes if node.file and node.crashed]
        if names:
            await start_anew(names, self.evidence)
            await self.settle()

    def _revised(self, results: Iterable[StepResult], failures: UnaskedFailures) -> list[StepResult]:
        """Return results as they are by what is known of the nodes now."""
        revised: list[StepResult] = []
        for result in results:
            step = self.steps[result.id]
            now = self.waits(step, revised) or self._failed_unasked(step, failures)
            revised.append(now or result)
        return revised

    def _failed_unasked(self, step: StepDocument, failures: UnaskedFailures) -> StepResult | None:
        """Return the result of a step whose node fails whatever is asked of it; None otherwise."""
        idle = failures.of(step)
        if idle is None:
            return None
        checks = [self._filled(check) for check in step.checks]
        return _concluded(step, [CheckResult(State.NOT_YET, expected(check)) for check in checks], 0, idle)

    def waits(self, step: StepDocument, results: Iterable[StepResult]) -> StepResult | None:
        """Return the result of a step that needs one that has not passed; None if it can begin."""
        passed = {result.id for result in results if result.state is State.PASSED}
        missing = [need for need in step.needs if need not in passed]
        if not missing:
            return None
        reason = say("waits for: {steps}", steps=", ".join(missing))
        return StepResult(step.id, State.WAITS, step.points, (), reason)

    async def watch(self, id_: str) -> AsyncIterator[StepResult]:
        """Judge a step again and again until it has passed; yield what changes.

        It begins anew when a node is started, by others than the judge.
        """
        step = self.steps[id_]
        self.follow([step])
        shown: StepResult | None = None
        try:
            await self.settle()
            while not self.evidence.ended:
                restarts = self.evidence.restarts
                async for result in self._round(step, shown, restarts):
                    if result != shown:
                        shown = result
                        yield shown
                if shown is not None and shown.state is State.PASSED:
                    return
                await self._rest(shown, restarts)
        finally:
            self.follow(())

    async def _round(self, step: StepDocument, before: StepResult | None, restarts: int) -> AsyncIterator[StepResult]:
        """Judge a step once; yield what is known of it after each check, and at the end."""
        news: asyncio.Queue[StepResult | None] = asyncio.Queue()
        judging = asyncio.ensure_future(self.step(step, news.put_nowait, before))
        judging.add_done_callback(lambda _: news.put_nowait(None))
        disturbed = asyncio.ensure_future(self._disturbed(restarts, judging))
        try:
            while (result := await news.get()) is not None:
                yield result
            if not judging.cancelled():
                yield judging.result()
        finally:
            judging.cancel()
            disturbed.cancel()

    async def _disturbed(self, restarts: int, judging: asyncio.Future[StepResult]) -> None:
        while self.evidence.restarts == restarts:
            await self.evidence.wait(AGAIN_S)
        judging.cancel()

    async def _rest(self, shown: StepResult | None, restarts: int) -> None:
        """Wait until a node is started, or until it is time to look again."""
        longest_s = AGAIN_S
        if shown is not None:
            checks, failed = self.steps[shown.id].checks, sum(one.state is State.PASSED for one in shown.checks)
            if len(shown.checks) > len(checks):
                longest_s = IDLE_S
            elif failed < len(checks):
                longest_s = checks[failed].rest_s
        await self.evidence.holds(lambda: self.evidence.restarts != restarts, longest_s)

    async def step(
        self,
        step: StepDocument,
        on_check: Callable[[StepResult], object] = lambda _: None,
        before: StepResult | None = None,
    ) -> StepResult:
        """Judge a step: its checks in order, up to the first that fails.

        `before`: what was known of it, shown for the checks whose turn has not come.
        """
        checks = [self._filled(check) for check in step.checks]
        found = [CheckResult(State.NOT_YET, expected(check)) for check in checks]
        more: tuple[CheckResult, ...] = ()
        if before is not None and len(before.checks) >= len(found):
            more = before.checks[len(found) :]
            found = [
                replace(one, state=old.state, seen=old.seen, look=old.look, hint=old.hint)
                for one, old in zip(found, before.checks, strict=False)
            ]
        meanwhile = before.state if before is not None else State.NOT_YET
        on_check(StepResult(step.id, meanwhile, step.points, (*found, *more)))
        ask = partial(not_at_work, learners_nodes(step, self.evidence), self.evidence, time.time())
        ran, everybody = running(self.evidence), frozenset(self.evidence.nodes)
        idle: CheckResult | None = None
        done = 0
        for check in checks:
            if ends(check):
                # Afterwards it is another process, which has done nothing yet.
                idle = await ask(everybody)
            if idle is not None:
                break
            found[done] = await self._check(check)
            if found[done].state is not State.PASSED:
                break
            done += 1
            on_check(StepResult(step.id, meanwhile, step.points, (*found, *more)))
        all_hold = done == len(found)
        asked = ends(checks[min(done, len(found) - 1)])
        if not asked and (all_hold or found[done].state is not State.UNJUDGED):
            idle = await ask(everybody if all_hold else ran)
        return _concluded(step, found, done, idle)

    async def _check(self, check: CheckDocument) -> CheckResult:
        what = expected(check)
        if self.evidence.update.error:
            return CheckResult(State.UNJUDGED, what, self.evidence.update.error)
        try:
            observation = await judged(check, self.evidence)
        except Exception as error:  # noqa: BLE001 - whatever nodes say, the judge goes on
            return CheckResult(State.UNJUDGED, what, _why(error))
        if observation.met:
            return CheckResult(State.PASSED, what)
        if self.evidence.ended:
            return CheckResult(State.UNJUDGED, what, say("the session has ended"))
        if any(node.ails for node in self.evidence.nodes.values()):
            # Whatever a check advises is meant for a program that runs.
            look = dead_nodes(self.evidence)
            return CheckResult(State.FAILED, what, observation.seen, look)
        hint = InLanguages(check.look) if check.look else ""
        return CheckResult(State.FAILED, what, observation.seen, observation.look, hint)

    def _filled(self, check: CheckDocument) -> CheckDocument:
        """Return the check with the values of this run in it."""
        data = filled(check.model_dump(by_alias=True, exclude_unset=True), self.evidence.values)
        return type(check).model_validate(data)

    def follow(self, steps: Iterable[StepDocument] | None = None) -> None:
        """Subscribe to what these steps need, or all steps, and to nothing else."""
        chosen = self.steps.values() if steps is None else steps
        followed = {topic for step in chosen for check in step.checks for topic in topics_of(check)}
        self.evidence.observer.want(Interest(followed=frozenset(followed), period_s=PERIOD_S))


def _concluded(step: StepDocument, found: list[CheckResult], done: int, idle: CheckResult | None) -> StepResult:
    """Return the result of a step of which so many checks hold, and the next one may not.

    `idle`: what keeps its node from its work, which counts more than what was missed meanwhile.
    """
    state = found[done].state if done < len(found) else State.PASSED
    judged_too = done + (idle is None)
    found[judged_too:] = [CheckResult(State.NOT_YET, one.what) for one in found[judged_too:]]
    if idle is not None:
        return StepResult(step.id, State.FAILED, step.points, (*found, idle))
    return StepResult(step.id, state, step.points, tuple(found))


def _why(error: Exception) -> str:
    if isinstance(error, (LessonFaultError, FieldError, UnknownTypeError)):
        return reason_of(error)
    return say("the judge failed: {kind}: {text}", kind=type(error).__name__, text=str(error))


@contextlib.asynccontextmanager
async def judging(
    lesson: LessonFolder,
    client: SupervisorClient,
    seed: int,
    functions: Mapping[str, Callable[[Any], object]] | None = None,
) -> AsyncIterator[Judge]:
    """Open a judge for a running profile; `client` is a connection of its own, and stays open.

    `functions`: those of the lesson's checks, if they are not to be read when their turn comes.
    """
    observer = Observer(client.session.domain, client.session.discovery, graph_s=PERIOD_S)
    values = draw(lesson.profile.values, seed)
    evidence = Evidence(observer, client, lesson.path, values, functions or {})
    loop = asyncio.get_running_loop()

    def take(update: GraphUpdate) -> None:
        with contextlib.suppress(RuntimeError):  # The loop is closed at the very end.
            loop.call_soon_threadsafe(evidence.take, update)

    observer.start(take)
    judge = Judge(lesson, evidence, seed)
    judge.follow(())
    try:
        yield judge
    finally:
        await judge.close()
        await asyncio.to_thread(observer.stop)
