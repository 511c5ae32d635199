"""What a list of commands would do to the robot, whether the rules of its profile permit it, and what is proposed.

Commands are carried out by the node that hears /llm_raw_json: it repeats the last drive for its
`repeat_for_s`, then stops. So a drive goes `|speed| * repeat_for_s` metres at most, and a list
holds one drive at most: of several only the last would count.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from agents.refusal import refused
from robot.commands.schema import CommandError, DriveCommand, HeadCommand, parse_llm
from safety.gate_report import STOPPED
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from launcher.consent import AgentRules
    from robot.commands.schema import LlmResponse
    from safety.gate_report import Gate
    from text.sentences import Words

MAX_HEADS = 8
"""Most head turns of one proposal."""
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Motion:
    """What is asked for."""

    drive: DriveCommand | None = None
    heads: tuple[HeadCommand, ...] = ()

    @property
    def speed_m_s(self) -> float:
        """Negative backwards; 0 without a drive."""
        return self.drive.speed if self.drive is not None else 0.0

    @property
    def moves_wheels(self) -> bool:
        """Whether the robot would leave its place."""
        return self.speed_m_s != 0.0

    def distance_m(self, repeat_for_s: float) -> float:
        """Return the longest way it could go."""
        return abs(self.speed_m_s) * repeat_for_s

    def response(self, thought: str) -> str:
        """Return it as the JSON of a language model."""
        drives = [] if self.drive is None else [self.drive]
        commands = [command.model_dump() for command in (*drives, *self.heads)]
        return json.dumps({"thought": thought, "commands": commands}, ensure_ascii=False)


def read_motion(commands: Sequence[object]) -> Motion:
    """Check commands from anywhere.

    Raises:
        RefusedError: if they do not fit `robot.commands.schema`, or are more than is overseen.
    """
    try:
        text = json.dumps({"thought": "", "commands": list(commands)})
        found = parse_llm(text)
    except CommandError as error:
        problems = "; ".join(f"{one.field}: {one.in_language('en')}".lstrip(": ") for one in error.problems[:5])
        raise refused("the commands are not valid: {problems}", problems=problems) from None
    except (TypeError, ValueError, RecursionError):
        raise refused("the commands are not valid: {problems}", problems="JSON") from None
    return _motion(found)


def _motion(response: LlmResponse) -> Motion:
    drives = [one for one in response.commands if isinstance(one, DriveCommand)]
    heads = tuple(one for one in response.commands if isinstance(one, HeadCommand))
    if not response.commands:
        raise refused("there is no command")
    if len(drives) > 1:
        raise refused(
            "one drive at a time: of several only the last is carried out; propose the next one "
            "when this one has ended"
        )
    if len(heads) > MAX_HEADS:
        raise refused("at most {n} turns of the head at a time", n=MAX_HEADS)
    return Motion(drives[0] if drives else None, heads)


def check_rules(motion: Motion, rules: AgentRules, repeat_for_s: float) -> None:
    """Raise a RefusedError if the rules of the profile do not permit it, whoever allows it."""
    if abs(motion.speed_m_s) > rules.max_speed_m_s + _ROUNDING:
        raise refused(
            "{speed:g} m/s is too fast: agents may drive at {limit:g} m/s at most",
            speed=motion.speed_m_s,
            limit=rules.max_speed_m_s,
        )
    metres = motion.distance_m(repeat_for_s)
    if metres > rules.max_distance_m + _ROUNDING:
        raise refused(
            "{metres:g} m is too far: agents may drive {limit:g} m at a time; a drive lasts "
            "{seconds:g} s, so drive more slowly",
            metres=metres,
            limit=rules.max_distance_m,
            seconds=repeat_for_s,
        )


def motion_words(motion: Motion, repeat_for_s: float) -> list[Words]:
    """Say what it does: the drive first, then the head."""
    said = []
    if motion.drive is not None and not motion.moves_wheels:
        said.append(say("stops"))
    elif motion.drive is not None:
        said.append(
            say(
                "drives at {speed:g} m/s, steering {steering:g} rad, for {seconds:g} s: {metres:.2f} m at most",
                speed=motion.drive.speed,
                steering=motion.drive.steering,
                seconds=repeat_for_s,
                metres=motion.distance_m(repeat_for_s),
            )
        )
    if motion.heads:
        poses = ", ".join(f"{head.pan}°/{head.tilt}°" for head in motion.heads)
        said.append(say("turns the head (pan/tilt): {poses}", poses=poses))
    return said


# ---------------------------------------------------------------- the gate


@dataclass(frozen=True)
class Preview:
    """What the gate would do."""

    words: Words
    lets: bool
    """Whether it would let the robot begin."""
    reach_m: float
    """How far the robot would come, as far as the sensors see."""


def preview_of(gate: Gate, speed_m_s: float, distance_m: float) -> Preview:
    """Return what the gate would do with a drive of this speed and longest way."""
    place = "rear" if speed_m_s < 0 else "front"
    metres = gate.metres.get(place)
    if gate.verdict == STOPPED:
        return _held(say("the gate would hold it: emergency stop"))
    if gate.verdict == "starting":
        return _held(say("the gate would hold it: it is starting"))
    blocked = "blocked_backward" if speed_m_s < 0 else "blocked_forward"
    if gate.verdict in ("blocked", blocked):
        return _held(_why_held(gate, place, metres))
    if metres is None:
        unseen = say("the gate would let it: no sensor sees that way")
        return Preview(unseen, lets=True, reach_m=distance_m)
    if math.isinf(metres):
        return Preview(say("the gate would let it: nothing in range"), True, distance_m)
    return _towards(gate, metres, distance_m)


def _towards(gate: Gate, metres: float, distance_m: float) -> Preview:
    free_m = max(0.0, metres - (gate.critical_m or 0.0))
    slow_m = gate.slow_m or 0.0
    if distance_m > free_m:
        words = say(
            "the gate would stop it after {reach:.2f} m: obstacle at {metres:.2f} m", reach=free_m, metres=metres
        )
    elif metres - distance_m < slow_m:
        words = say("the gate would slow it down: obstacle at {metres:.2f} m", metres=metres)
    else:
        words = say("the gate would let it: free for {metres:.2f} m", metres=metres)
    return Preview(words, lets=True, reach_m=min(distance_m, free_m))


def _held(words: Words) -> Preview:
    return Preview(words, lets=False, reach_m=0.0)


def _why_held(gate: Gate, place: str, metres: float | None) -> Words:
    if metres is None or gate.states.get(place) in ("silent", "invalid"):
        return say("the gate would hold it: its sensor gives no distance that way")
    return say("the gate would hold it: obstacle at {metres:.2f} m", metres=metres)


# ---------------------------------------------------------------- proposals

EXECUTED_WITHIN_S = 60.0
"""An older proposal is about a situation that is no more."""
MAX_OPEN = 16
"""Most proposals of all agents that wait; older ones make way."""


@dataclass(frozen=True)
class Proposal:
    """What an agent has proposed."""

    id: str
    agent: str
    """The key of the agent, the only one that may have it carried out."""
    run_id: str
    """The session it was made for."""
    motion: Motion
    reason: str
    made_s: float
    """On the clock of the book."""


class ProposalBook:
    """The proposals that have not been carried out."""

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        self._now = now
        self._open: dict[str, Proposal] = {}
        self._last = 0

    def add(self, agent: str, run_id: str, motion: Motion, reason: str) -> Proposal:
        """Add a proposal; its id was never used before."""
        self._last += 1
        made = Proposal(f"p{self._last}", agent, run_id, motion, reason, self._now())
        self._open[made.id] = made
        while len(self._open) > MAX_OPEN:
            del self._open[next(iter(self._open))]
        return made

    def take(self, name: str, agent: str, run_id: str) -> Proposal:
        """Take a proposal out to carry it out.

        Raises:
            RefusedError: if it is not there any more, or belongs to another agent or session.
        """
        found = self._open.get(name)
        if found is None or found.agent != agent:
            raise refused(
                "there is no proposal {name!r}: each is carried out once, and an emergency stop "
                "ends them all; make a new one",
                name=name,
            )
        del self._open[name]
        if self._now() - found.made_s > EXECUTED_WITHIN_S:
            raise refused("the proposal is older than {seconds:g} s; make a new one", seconds=EXECUTED_WITHIN_S)
        if found.run_id != run_id:
            raise refused("the proposal was made for another session; make a new one")
        return found

    def clear(self) -> None:
        """Forget them all: an emergency stop."""
        self._open.clear()
