"""What a list of commands would do to the robot, and whether the rules of its profile permit it.

Commands are carried out by the node that hears /llm_raw_json: it repeats the last drive for its
`repeat_for_s`, then stops. So a drive goes `|speed| * repeat_for_s` metres at most, and a list
holds one drive at most: of several only the last would count.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING

from agents.refusal import refused
from robot.commands.schema import CommandError, DriveCommand, HeadCommand, parse_llm
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from launcher.consent import AgentRules
    from robot.commands.schema import LlmResponse
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
