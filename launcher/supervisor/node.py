"""The life of one node: waiting, starting, ready or running, stopping, restarting or not.

It all happens in one task, so that nothing can start the node twice.
"""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from launcher.processes.exit import UNSEEN, Exit
from launcher.processes.members import Usage
from launcher.processes.stop import PATIENT, QUICK, StagedStop
from launcher.processes.table import Process
from launcher.profile.node import Node
from launcher.spawn_server.spawner import SpawnError
from launcher.status import IDLE, STUCK, NodeFault, NodeState, NodeStatus, Severity
from launcher.supervisor.process import NodeProcess
from launcher.supervisor.readiness import NodeSession, bring_up
from launcher.supervisor.restart_policy import Again, GivenUp, RestartPolicy
from launcher.supervisor.words import NOT_EXECUTABLE, NOT_FOUND, end_words, left_undone, stopped_words, suspended, who
from text.sentences import say

USAGE = 2
"""Exit code of a program that rejects its arguments; Deck's nodes use it for parameters."""
UNREADY = Exit(1)
"""The end of a process that could not be brought up."""
USAGE_WITHIN_S = 10.0
"""A program that rejects its arguments, or does not compile, ends within this time."""
END_LOOK_EVERY_S = 0.1
END_LOOKS = 30
"""How often an end is looked up anew of which nobody has told though no process is left."""
WELL_AFTER_S = 10.0
"""A node that has been started again after a crash must run for so long until that is forgotten."""
ASKED_TWICE_S = 0.3
"""Two stop requests closer together than this count as one."""


@dataclass
class _Crash:
    """Why the process before this one has ended, which is shown until this one has proved well."""

    words: str
    fault: NodeFault | None
    """That of the learner's own file."""
    well_s: float | None = None
    """Since when the node is well again."""


@dataclass
class _Now:
    """State that exists only while a process runs."""

    process: NodeProcess
    started: float
    stop: StagedStop | None = None
    failure: str = ""
    """Why it will never be ready, although it runs."""


class SupervisedNode:
    """One node of the session."""

    def __init__(self, plan: Node, session: NodeSession) -> None:
        self.plan = plan
        self.state = NodeState.WAITING
        self.detail = ""
        self.serves = False
        """Whether the nodes that need it may start."""
        self.usage: Usage = None, None
        self.fault: NodeFault | None = None
        """What is wrong with the learner's own file."""
        self._clash: NodeFault | None = None
        self._suspended: NodeFault | None = None
        """What a signal has done to its process, while that lasts."""
        self._crash: _Crash | None = None
        self._session = session
        self._policy = RestartPolicy(plan.restart)
        self._restarts = 0
        self._last: Exit | None = None
        self._now: _Now | None = None
        self._task: asyncio.Task[None] | None = None
        self._nudge = asyncio.Event()
        self._down = False
        self._again = False
        self._forced = False
        self._hurried = False
        self._asked_at = 0.0
        self._stuck = asyncio.Event()
        self.outlived: Sequence[Process] = ()
        """The processes that have not ended by SIGKILL, while that is so."""

    @property
    def at_work(self) -> bool:
        """Whether it is active: it runs, waits, or is to be started again."""
        return self._task is not None and not self._task.done()

    def status(self) -> NodeStatus:
        now, last = self._now, self._last
        cpu_percent, memory_bytes = self.usage if now else (None, None)
        crash = self._recent_crash()
        fault = self.fault if self._suspended is None else self._suspended
        return NodeStatus(
            name=self.plan.name,
            command=self.plan.command,
            state=self.state,
            detail=self.detail or (crash.words if crash is not None else ""),
            pid=now.process.pid if now else None,
            uptime_s=self._session.clock.now() - now.started if now else None,
            restarts=self._restarts,
            exit_code=last.code if last and not now else None,
            signal=last.signal if last and not now else None,
            cpu_percent=cpu_percent,
            memory_bytes=memory_bytes,
            needs=self.plan.needs,
            file=self.plan.file,
            fault=fault or (crash.fault if crash is not None else None),
        )

    def _recent_crash(self) -> _Crash | None:
        """Return what is still to be shown of the process before this one."""
        crash, now_s = self._crash, self._session.clock.now()
        if crash is None or (crash.well_s is not None and now_s - crash.well_s > WELL_AFTER_S):
            return None
        return crash

    def start(self) -> None:
        """Start it; a node that is waiting for others or for its next attempt starts at once."""
        if not self.at_work:
            self._down = self._again = self._forced = self._hurried = False
            self._policy.reset()
            self._task = asyncio.create_task(self._live())
            self._task.add_done_callback(self._tell_fault)
        elif self._down:
            self._again = True
        elif self.state in (NodeState.WAITING, NodeState.BACKOFF):
            self._forced = True
            self._nudge.set()

    async def stop(self, *, now: bool = False) -> None:
        """Stop it; return when none of its processes is left, or not even SIGKILL ends them.

        `now`, or a second call, skips the waits between the signals.
        """
        self._again = False
        if self.at_work and self._task is not None:
            asked_before = self._down and self._session.clock.now() - self._asked_at > ASKED_TWICE_S
            self._go_down(now=now or asked_before)
            stuck = asyncio.create_task(self._stuck.wait())
            await asyncio.wait([self._task, stuck], return_when=asyncio.FIRST_COMPLETED)
            stuck.cancel()
        elif self.state in (NodeState.WAITING, NodeState.BACKOFF):
            self.become(NodeState.EXITED, say("stopped"))

    def restart(self) -> None:
        """Restart it; a node that is already waiting for a restart is not started twice."""
        if self.at_work:
            self._again = True
            self._go_down(now=False)
        else:
            self.start()

    def exchange(self, plan: Node, fault: NodeFault | None) -> None:
        """Restart it with another program, as `saved` does."""
        self.plan = plan
        self._renew(fault, say("exchanged for {program}", program=plan.command))

    def warn(self, fault: NodeFault | None) -> None:
        """Note something that is wrong while it runs."""
        if fault is not None and self._now is not None:
            self.fault = fault
            self._changed()

    def ail(self, fault: NodeFault) -> None:
        """Note that it runs, and does not do its work: a callback is stuck, a thread has ended."""
        if self._now is not None and not self._down:
            self.fault = fault
            self.say(Severity.ERROR, fault.words)
            self._changed()

    def go_on(self) -> None:
        """Note that the callback that seemed stuck has returned."""
        if self._now is not None and not self._down and self.fault is not None and self.fault.kind == STUCK:
            self.fault = replace(self.fault, kind="warning")
            self.say(Severity.INFO, say("it goes on after all"))
            self._changed()

    def halted(self, pid: int) -> None:
        """Note which of its processes a signal has suspended; 0: none."""
        if self._now is None or self._down or bool(pid) is (self._suspended is not None):
            return
        self._suspended = fault = suspended(pid) if pid else None
        if fault is None:
            self.say(Severity.INFO, say("it runs again, after SIGCONT"))
        else:
            self.say(Severity.ERROR, fault.words)
        self._changed()

    def clashes(self, fault: NodeFault | None) -> None:
        """Note a topic that has another type elsewhere, or that this is no longer so."""
        if fault == self._clash or self._now is None:
            return
        if self.fault is None or self.fault == self._clash:
            self.fault = fault
            if fault is not None:
                self.say(Severity.WARN, fault.words)
            self._changed()
        self._clash = fault

    def saved(self, fault: NodeFault | None) -> None:
        """Restart it, since its file was saved; with a fault in the file, leave it as it is.

        A node that was stopped by hand stays stopped.
        """
        self._renew(fault, say("saved: starting it again"))

    def _renew(self, fault: NodeFault | None, why: str) -> None:
        self.fault = fault
        if fault is not None:
            self.say(Severity.ERROR, fault.words)
        elif not self._down or self._again:
            self.say(Severity.INFO, why)
            self.restart()
        self._changed()

    def say(self, severity: Severity, words: str) -> None:
        """Add a line about it to its log."""
        self._session.log.say(self.plan.name, severity, words)

    def _changed(self) -> None:
        self._session.changed(self.plan.name, self.state)

    def needs_changed(self) -> None:
        """Check again whether everything it needs is there."""
        if self.state is NodeState.WAITING:
            self._nudge.set()

    def _tell_fault(self, task: asyncio.Task[None]) -> None:
        """Report an exception in Deck itself, so that the node does not seem to be healthy."""
        if not task.cancelled() and task.exception() is not None:
            self.become(NodeState.FAILED, say("an error in Deck itself: {error!r}", error=task.exception()))
            asyncio.get_running_loop().call_exception_handler(
                {"message": f"life of {self.plan.name}", "exception": task.exception()}
            )

    def _go_down(self, *, now: bool) -> None:
        if not self._down:
            self._asked_at = self._session.clock.now()
        self._down = True
        self._hurried = self._hurried or now
        self.serves = False
        if now and self._now is not None and self._now.stop is not None:
            self._now.stop.hurry()
        self._nudge.set()

    def become(self, state: NodeState, detail: str = "", *, serves: bool = False) -> None:
        """Give it another state; `serves`: the nodes that need it may start."""
        self.state, self.detail, self.serves = state, detail, serves and not self._down
        well = state in (NodeState.READY, NodeState.RUNNING)
        if self._crash is not None and not well:
            self._crash.well_s = None
        elif self._crash is not None and self._crash.well_s is None:
            self._crash.well_s = self._session.clock.now()
        if state in (NodeState.READY, NodeState.RUNNING) and self._does_not_compile:
            self.fault = None
        self._changed()

    async def _live(self) -> None:
        while True:
            await self._wait_for_needs()
            if not self._down:
                again = await self._one_process()
                if not again and not self._down:
                    return
            if self._down:
                if not self._again:
                    self.become(NodeState.EXITED, stopped_words(self._last))
                    return
                self._again = self._down = self._hurried = False
                self._policy.reset()

    async def _wait_for_needs(self) -> None:
        while not self._down and not self._forced:
            missing = self._session.missing(self.plan)
            if not missing:
                break
            if (self.state, self.detail) != (NodeState.WAITING, missing):
                self.become(NodeState.WAITING, missing)
            await self._nudge.wait()
            self._nudge.clear()
        self._forced = False

    async def _one_process(self) -> bool:
        """Start a process and follow it until it ends; return whether to start another."""
        self.become(NodeState.STARTING)
        try:
            process = await self._launched()
        except SpawnError as problem:
            end = Exit(None)
            lasted = 0.0
            why: str = say("cannot be started: {reason}", reason=problem.args[0])
            self.say(Severity.ERROR, why)
        else:
            if process is None:
                return False
            end, lasted, failure = await self._see_through(process)
            why = self._end_words(end, asked=self._down)
            if failure:
                # Deck has ended it, which is none of the node's own success.
                end, why = UNREADY, failure
            elif self.fault is not None and not self._down:
                why = self.fault.words
                warns = self.fault.kind == "warning"
                gravity = Severity.WARN if warns else Severity.ERROR
                self.say(gravity, why)
        if self._down:
            return False
        return await self._after(end, lasted, why)

    async def _launched(self) -> NodeProcess | None:
        """Start a process; None if the node is to stop before there is one."""
        launching = asyncio.ensure_future(self._session.launch(self.plan))
        await self._until_down_or(launching)
        if not launching.done():
            launching.cancel()
            await asyncio.wait([launching])
        return None if launching.cancelled() else launching.result()

    async def _until_down_or(self, *futures: asyncio.Future[Any]) -> None:
        """Wait until the node is to stop, or one of these is done."""
        for future in futures:
            future.add_done_callback(lambda _done: self._nudge.set())
        while not self._down and not any(future.done() for future in futures):
            self._nudge.clear()
            await self._nudge.wait()

    async def _see_through(self, process: NodeProcess) -> tuple[Exit, float, str]:
        """Follow a process; return its end, its age in seconds, and why it was ended by Deck."""
        clock = self._session.clock
        self._now = now = _Now(process, clock.now())
        self._last = self._clash = self._suspended = None
        self.usage = None, None
        if not self._does_not_compile:
            self.fault = None
        self.say(Severity.INFO, say("started, pid {pid}", pid=process.pid))
        ready = asyncio.create_task(bring_up(self, self._session))
        await self._until_down_or(process.ended, ready)
        now.failure = ready.result() if ready.done() else ""
        if not now.failure:
            await self._until_down_or(process.ended)
        ready.cancel()
        lasted = clock.now() - now.started
        if now.failure:
            self.say(Severity.ERROR, now.failure)
        if self._down or now.failure:
            self.become(NodeState.STOPPING, now.failure)
        await self._end_all_of_it(now)
        end = await self._end_of(process)
        await process.close()
        self._now, self._last, self._suspended, self._crash = None, end, None, None
        asked = self._down or bool(now.failure)
        self.say(self._gravity(end, asked=asked), self._end_words(end, asked=asked))
        if self.plan.file:
            self._judge_end(end)
        return end, lasted, now.failure

    def _judge_end(self, end: Exit) -> None:
        """Note what is wrong with the learner's own file if it ended other than as it should."""
        if end.clean:
            if not self._down:
                self.fault = self._session.ended_early(self.plan) or self.fault
            return
        crash = self._session.crash(self.plan)
        if crash is not None and self._down:
            self.fault = replace(crash, kind="warning")
            self.say(Severity.WARN, crash.words)
        elif crash is not None:
            self.fault = crash

    async def _end_all_of_it(self, now: _Now) -> None:
        """Stop what is left: everything if the node is to stop, else what its process left."""
        now.stop = StagedStop(
            now.process.left, self._session.clock, self._held_up, QUICK if self._hurried else PATIENT, self._outlived
        )
        if now.process.ended.done() and not self._down:
            left = now.process.left()
            if not left:
                return
            self.become(NodeState.STOPPING, say("it ended and left {who} running", who=who(left)))
        stop = now.stop
        now.process.ended.add_done_callback(lambda _ended: stop.look())
        await stop.run()
        self._stuck.clear()
        self.outlived = ()

    async def _end_of(self, process: NodeProcess) -> Exit:
        """Return how the process ended, of whose node nothing is left."""
        look = asyncio.Event()
        process.ended.add_done_callback(lambda _ended: look.set())
        for _look in range(END_LOOKS):
            if process.ended.done():
                return process.ended.result()
            process.look_for_end()
            await self._session.clock.wait(look, END_LOOK_EVERY_S)
        return UNSEEN

    def _outlived(self, left: Sequence[Process]) -> None:
        self.outlived = left
        words = say("still running after SIGKILL: {who}", who=who(left))
        self.become(NodeState.STOPPING, words)
        self.say(Severity.ERROR, words)
        self._stuck.set()

    def _held_up(self, left: Sequence[Process], number: signal.Signals) -> None:
        words = say("{signal} sent, waiting for {who}", signal=number.name, who=who(left))
        self.become(NodeState.STOPPING, words)
        if number.name != "SIGINT":
            self.say(Severity.WARN, words)

    async def _after(self, end: Exit, lasted: float, why: str) -> bool:
        """Apply the restart policy; return whether to start it again."""
        clock = self._session.clock
        verdict = (
            GivenUp(1)
            if self._is_hopeless(end, lasted)
            else self._policy.after(clean=end.clean, lasted_s=lasted, now=clock.now())
        )
        if isinstance(verdict, Again):
            words = say("{why}; again in {seconds:g} s", why=why, seconds=verdict.delay_s)
            self.become(NodeState.BACKOFF, words)
            fault = self.fault and replace(self.fault, kind="warning")
            self._crash = _Crash(why, fault)
            again_s = clock.now() + verdict.delay_s
            # It may be nudged by what has just ended as well.
            while not (self._forced or self._down) and (left_s := again_s - clock.now()) > 0:
                self._nudge.clear()
                await clock.wait(self._nudge, left_s)
            self._forced = False
            if not self._down:
                self._restarts += 1
            return not self._down
        undone = next(filter(None, map(left_undone, self.plan.conditions[::-1])), "")
        idle = self.fault is not None and self.fault.kind == IDLE
        if self.plan.optional or (verdict is None and not undone and not idle):
            self.become(NodeState.EXITED, why)
            return False
        if verdict is None:
            why = why if self.fault is not None else undone
            if not idle:
                self.say(Severity.ERROR, why)
        elif verdict.crashes > 1:
            why = say(
                "given up after {count} exits in {seconds:.0f} s: {why}",
                count=verdict.crashes,
                seconds=verdict.within_s,
                why=why,
            )
            self.say(Severity.ERROR, why)
        self.become(NodeState.FAILED, why)
        return False

    @property
    def _does_not_compile(self) -> bool:
        """Whether its file was found not to be Python; it may have been fixed since."""
        return self.fault is not None and self.fault.kind == "syntax"

    def _is_hopeless(self, end: Exit, lasted: float) -> bool:
        """Whether another attempt would end in the same way."""
        if self._does_not_compile and lasted < USAGE_WITHIN_S:
            return True
        if self.plan.is_forked:
            return end.code == USAGE and lasted < USAGE_WITHIN_S
        return end.code in (NOT_EXECUTABLE, NOT_FOUND)

    def _gravity(self, end: Exit, *, asked: bool) -> Severity:
        if end.clean or asked:
            return Severity.INFO
        return Severity.WARN if self.plan.optional else Severity.ERROR

    def _end_words(self, end: Exit, *, asked: bool) -> str:
        return end_words(end, self.plan, self._session.log.last_words(self.plan.name), asked=asked)
