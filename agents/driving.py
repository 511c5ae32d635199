"""Proposing motion, asking for consent, and carrying it out: at most once, within the limits."""

from __future__ import annotations

import asyncio
import contextlib
import json
import math
import time
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from agents.looking import FRESH_S, gate_fields
from agents.motion import EXECUTED_WITHIN_S, Preview, ProposalBook, check_rules, motion_words, preview_of, read_motion
from agents.refusal import RefusedError, refused
from agents.road import road_of
from agents.tools import Call, Caller, Commands, Facts, Pan, ProposalId, Reason, Tilt, tool
from graph.observer.requests import PreparePublisher, Publish
from launcher.consent import ALLOWED_FOR_S, Approval, ConsentVerdict
from launcher.errors import LauncherError
from launcher.status import Severity
from robot.topics import LLM_RAW_JSON, LLM_RESULT, ODOMETRY
from text.nested import read_json
from text.plain import plain
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from agents.motion import Motion, Proposal
    from agents.road import Road
    from agents.session import RobotSession
    from graph.data import Sample
    from text.sentences import Words

STRING = "std_msgs/msg/String"
SENT_WITHIN_S = 3.0
HEARD_WITHIN_S = 3.0
HEAD_WITHIN_S = 8.0
WATCHED_FOR_S = 20.0
"""A longer drive goes on after the answer."""
SETTLES_S = 0.5
ROUNDING = 1e-9
HEAD_FIELDS = ("pan", "tilt", "sum", "error")
REFUSALS = {
    ConsentVerdict.REFUSED: say("the person at the screen has refused"),
    ConsentVerdict.NO_SCREEN: say(
        "nobody can be asked: no screen of Deck is attached to this session; open one with `deck attach`"
    ),
    ConsentVerdict.SCREEN_GONE: say("the screen was closed before anybody answered"),
    ConsentVerdict.LATE: say("nobody at the screen has answered in time"),
    ConsentVerdict.ENDED: say("an emergency stop, or the end of the session, has ended the question"),
}


@dataclass(frozen=True)
class CheckedMotion:
    """A motion that the rules permit, and what it would come to now."""

    motion: Motion
    road: Road
    preview: Preview | None

    @property
    def distance_m(self) -> float:
        """The longest way it could go."""
        return self.motion.distance_m(self.road.repeat_for_s)

    def lines(self, reason: str) -> list[Words]:
        """Say what would happen, to the person who is asked."""
        said = motion_words(self.motion, self.road.repeat_for_s)
        if self.preview is not None:
            said.append(self.preview.words)
        if reason:
            said.append(say("it says: {reason}", reason=reason))
        return said


class AgentDriving:
    """Everything that moves the robot on behalf of agents."""

    def __init__(self, approval: Approval) -> None:
        self.approval = approval
        self._book = ProposalBook()
        self._unasked: deque[tuple[float, float]] = deque()
        """When, by the monotonic clock, agents drove without a question, and how far, in m."""
        self._under_way = asyncio.Lock()

    def stopped(self) -> None:
        """Forget all proposals: an emergency stop is in force, or the session has ended."""
        self._book.clear()

    async def propose(self, call: Call, motion: Motion, reason: str) -> Facts:
        """Say what a motion would do; nothing moves and nobody is asked."""
        checked = await self._checked(call.session, motion)
        proposal = self._book.add(call.caller.key, call.session.info.run_id, motion, reason)
        preview = checked.preview
        return {
            "proposal": proposal.id,
            "expires_in_s": EXECUTED_WITHIN_S,
            "would": [str(line) for line in checked.lines("")],
            "distance_m": round(checked.distance_m, 3),
            "reach_m": None if preview is None else round(preview.reach_m, 3),
            "gate_lets": None if preview is None else preview.lets,
            "gate": gate_fields(checked.road.gate),
            "approval": self.approval.value,
        }

    async def execute(self, call: Call, name: str) -> Facts:
        """Carry out a proposal, if it is allowed."""
        # First: as long as it is in force, it ends what has been proposed since, too.
        _unless_stopped(call.session)
        proposal = self._book.take(name, call.caller.key, call.session.info.run_id)
        return await self._execute(call.session, call.caller, proposal)

    async def execute_at_once(self, call: Call, motion: Motion, reason: str) -> Facts:
        """Carry out a motion that was not proposed before, which takes the same consent."""
        name = self._book.add(call.caller.key, call.session.info.run_id, motion, reason).id
        proposal = self._book.take(name, call.caller.key, call.session.info.run_id)
        return await self._execute(call.session, call.caller, proposal)

    async def _checked(self, session: RobotSession, motion: Motion) -> CheckedMotion:
        road = await road_of(session, wheels=motion.moves_wheels)
        check_rules(motion, session.info.agents, road.repeat_for_s)
        metres = motion.distance_m(road.repeat_for_s)
        preview = None
        if road.gate is not None:
            preview = preview_of(road.gate, motion.speed_m_s, metres)
        return CheckedMotion(motion, road, preview)

    async def _free_to_go(self, session: RobotSession, motion: Motion) -> CheckedMotion:
        """Return what is checked now; refuse what the emergency stop or the gate would hold.

        A command that the gate holds would set the robot going when the way becomes free.
        """
        checked = await self._checked(session, motion)
        _unless_stopped(session)
        if checked.preview is not None and not checked.preview.lets:
            raise RefusedError(checked.preview.words)
        return checked

    async def _execute(self, session: RobotSession, caller: Caller, proposal: Proposal) -> dict[str, object]:
        if self.approval is Approval.NEVER:
            raise refused("agents do not move this robot: `deck mcp` runs with --approve never")
        if self._under_way.locked():
            raise refused("another proposal is being carried out; wait for its end")
        async with self._under_way:
            checked = await self._allowed(session, caller, proposal)
            words = " · ".join(str(line) for line in checked.lines("")[:1])
            told = say("agent “{agent}” does {id}: {words}", agent=caller.name, id=proposal.id, words=words)
            # Written before anything moves: if that fails, nothing does.
            arguments = {"proposal": proposal.id, "commands": read_json(_thought(proposal, ""))}
            session.audit.write(caller.name, "execute", arguments, "begins", 0.0)
            await session.link.tell(Severity.INFO, told)
            return await self._carry_out(session, proposal, checked)

    async def _allowed(self, session: RobotSession, caller: Caller, proposal: Proposal) -> CheckedMotion:
        """Return what is allowed, checked again after the answer."""
        checked = await self._free_to_go(session, proposal.motion)
        # Matched with the parser by the time of the answer, after which nothing is to wait.
        prepared = session.observer.ask(PreparePublisher(LLM_RAW_JSON, STRING))
        prepared.add_done_callback(lambda future: future.cancelled() or future.exception())
        rules = session.info.agents
        fits = checked.distance_m <= rules.max_total_m - self.unasked_m() + ROUNDING
        unasked = self.approval is Approval.ALWAYS
        if unasked and not fits:
            raise refused(
                "agents may drive {limit:g} m within five minutes without a question, and have done so",
                limit=rules.max_total_m,
            )
        if not unasked:
            verdict = await _ask(session, caller, checked.lines(proposal.reason), anew=not fits)
            if not verdict.allows:
                raise RefusedError(REFUSALS[verdict])
            unasked = verdict is ConsentVerdict.ALLOWED_BEFORE
        # A person takes their time: meanwhile the robot, or the gate, may have changed.
        again = await self._free_to_go(session, proposal.motion)
        if again.road.way != checked.road.way:
            raise refused("the robot has changed since the person was asked; make a new proposal")
        if unasked:
            self.drove_unasked(again.distance_m)
        return again

    def unasked_m(self) -> float:
        """Return how far they went without a question in as long as an allowance lasts."""
        while self._unasked and time.monotonic() - self._unasked[0][0] > ALLOWED_FOR_S:
            self._unasked.popleft()
        return sum(metres for _when_s, metres in self._unasked)

    def drove_unasked(self, metres: float) -> None:
        """Note a drive without a question."""
        self._unasked.append((time.monotonic(), metres))

    async def _carry_out(
        self, session: RobotSession, proposal: Proposal, checked: CheckedMotion
    ) -> dict[str, object]:
        thought = f"{proposal.id}: {proposal.reason}".strip(": ")
        answers = _Answers(thought)
        before = _place(session)
        sent = False
        try:
            with session.view.hearing(LLM_RESULT, answers.hear):
                _unless_stopped(session)
                sending = session.observer.ask(Publish(LLM_RAW_JSON, STRING, {"data": _thought(proposal, thought)}))
                sent = True
                await asyncio.wait_for(asyncio.wrap_future(sending), SENT_WITHIN_S)
                await session.view.until(lambda: answers.heard, HEARD_WITHIN_S)
                if not answers.heard:
                    raise refused("{node} has not answered", node=checked.road.parser)
                if answers.refused:
                    raise refused("{node} has refused it: {why}", node=checked.road.parser, why=answers.refused)
                heads = len(proposal.motion.heads)
                await session.view.until(lambda: len(answers.heads) >= heads, HEAD_WITHIN_S)
                await self._drives(session, checked)
        except (asyncio.CancelledError, asyncio.TimeoutError, RefusedError):
            if sent:
                _end_drive(session)
            raise
        return {
            "outcome": "carried out",
            "head": answers.heads,
            "stopped_by_emergency_stop": session.emergency.engaged,
            "moved_m": _moved(before, _place(session)),
        }

    async def _drives(self, session: RobotSession, checked: CheckedMotion) -> None:
        """Wait for the end of the drive, as long as an agent waits for an answer."""
        if checked.motion.moves_wheels:
            wait_s = min(checked.road.repeat_for_s + SETTLES_S, WATCHED_FOR_S)
            await session.view.until(lambda: session.emergency.engaged, wait_s)


def _unless_stopped(session: RobotSession) -> None:
    if session.emergency.engaged:
        raise refused("the emergency stop is in force; only a person releases it")


class _Answers:
    """What /llm_result says of one response, which its thought identifies."""

    def __init__(self, thought: str) -> None:
        self._thought = thought
        self.accepted = False
        self.refused = ""
        self.heads: list[dict[str, object]] = []

    @property
    def heard(self) -> bool:
        return self.accepted or bool(self.refused)

    def hear(self, sample: Sample) -> None:
        try:
            report = read_json(str(sample.value.get("data", "")))
        except ValueError:
            return
        if not isinstance(report, dict):
            return
        event = report.get("event")
        if event == "accepted" and report.get("thought") == self._thought:
            self.accepted = True
        elif event == "refused" and not self.accepted:
            problems = report.get("problems")
            self.refused = str(problems)[:300] or "?"
        elif event == "head" and self.accepted and len(self.heads) < 16:
            self.heads.append({name: _short(report.get(name)) for name in HEAD_FIELDS})


async def _ask(session: RobotSession, caller: Caller, lines: Sequence[Words], *, anew: bool) -> ConsentVerdict:
    try:
        return await session.link.ask_consent(caller.key, lines, anew=anew)
    except asyncio.CancelledError:
        # The agent waits no longer: nor does the question.
        with contextlib.suppress(LauncherError):
            await asyncio.shield(session.link.withdraw(caller.key))
        raise
    except LauncherError as error:
        raise refused("nobody could be asked: {why}", why=str(error)) from error


def _short(value: object) -> object:
    """Return a number as it is, anything else as a short text: it may come from anybody."""
    return value if value is None or isinstance(value, (int, float)) else plain(str(value), 200)


def _thought(proposal: Proposal, thought: str) -> str:
    return proposal.motion.response(thought)


def _end_drive(session: RobotSession) -> None:
    """Have the robot stand: whoever has moved it does not look any more."""
    stop = {"thought": "", "commands": [{"action": "drive", "speed": 0.0, "steering": 0.0}]}
    session.last_words = session.observer.ask(Publish(LLM_RAW_JSON, STRING, {"data": json.dumps(stop)}))


def _place(session: RobotSession) -> tuple[float, float] | None:
    sample = session.view.newest(ODOMETRY, FRESH_S)
    if sample is None:
        return None
    try:
        pose: Any = sample.value["pose"]
        place = pose["pose"]["position"]
        return float(place["x"]), float(place["y"])
    except (KeyError, TypeError, ValueError):
        return None


def _moved(before: tuple[float, float] | None, after: tuple[float, float] | None) -> float | None:
    if before is None or after is None:
        return None
    return round(math.dist(before, after), 3)


@tool()
async def propose(call: Call, commands: Commands, reason: Reason = "") -> Facts:
    """Propose motion: nothing moves yet.

    Answers with an id for `execute`, what the safety gate would do now, and how far the robot would go. A drive ends
    by itself after the time that is answered.
    """
    driving: AgentDriving = call.driving
    return await driving.propose(call, read_motion(commands), reason)


@tool(acts=True, tells=True)
async def execute(call: Call, proposal: ProposalId) -> Facts:
    """Carry out a proposal, once, within 60 s.

    The person at the robot's screen is asked, which takes up to 30 s; a refusal is final for this proposal: do not
    repeat it unasked.
    """
    driving: AgentDriving = call.driving
    return await driving.execute(call, proposal)


@tool(acts=True, tells=True)
async def head(call: Call, pan: Pan, tilt: Tilt, reason: Reason = "") -> Facts:
    """Turn the robot's head. The person at its screen is asked, as for `execute`."""
    motion = read_motion([{"action": "turn_head", "pan": pan, "tilt": tilt}])
    driving: AgentDriving = call.driving
    return await driving.execute_at_once(call, motion, reason)
