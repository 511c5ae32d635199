"""From an LLM's JSON to motion: checks a whole response, then carries it out in order.

One bad command, and none is executed. /drive is published at once; head turns are requested one
after the other, and a new response drops those that have not begun. With `repeat_for_s`, which a
gate needs, the last /drive is repeated for that long, then a stop; a new response ends that. The
outcome of each response is published on /llm_result as JSON, one object per message:

    {"event": "accepted", "commands": 2, "thought": "..."}
    {"event": "refused", "problems": [{"field", "line", "column", "message", "code", "args"}]}
    {"event": "drive", "speed": 0.2, "steering": -0.3}
    {"event": "head", "pan": -45, "tilt": 10, "sum": 1}     or "error" with a sentence
"""

from __future__ import annotations

import json
from collections.abc import Sequence

from std_msgs.msg import String

from nodes.parts.head_client import HeadAnswer, HeadClient
from nodes.parts.node import DEPTH, LessonNode, Number
from nodes.parts.repeat import REPEAT_FOR_S, DriveRepeater
from nodes.parts.runner import run
from robot.commands.schema import (
    MAX_COMMANDS,
    CommandError,
    DriveCommand,
    HeadCommand,
    LlmResponse,
    Problem,
    parse_llm,
)
from robot.topics import LLM_RAW_JSON, LLM_RESULT
from robot.words import DriveSetpoint
from text.i18n import N_

_STARTED = N_("Waiting for JSON on {topic}")
_THOUGHT = N_('The model thinks: "{thought}" ({count} commands)')
_REFUSED = N_("Refused, nothing is done: {problem}")
_DRIVE = N_("Chassis: speed {speed:g} m/s, steering {steering:g} rad")
_HEAD = N_("Head: asked for pan {pan}°, tilt {tilt}°")
_HEAD_DONE = N_("Head: pan {pan}°, tilt {tilt}° done")
_HEAD_REFUSED = N_("Head: pan {pan}°, tilt {tilt}° refused")
_HEAD_TROUBLE = N_("Head: {trouble}")
_RESULTS = 2 * MAX_COMMANDS
"""Queue of results: a response causes more of them at once than an ordinary queue holds."""


class LlmParser(LessonNode):
    """Carries out responses that pass the schema."""

    NAME = "llm_parser"
    head_timeout = Number(5.0, "For each answer of the head", low=0.1, high=60.0, unit="s")
    repeat_for_s = REPEAT_FOR_S

    def __init__(self) -> None:
        super().__init__()
        self._drive = DriveRepeater(self)
        self._result = self.create_publisher(String, LLM_RESULT, _RESULTS)
        self._head = HeadClient(self, lambda: self.head_timeout)
        self.create_subscription(String, LLM_RAW_JSON, self._receive, DEPTH)
        self.say.info(_STARTED, topic=LLM_RAW_JSON)

    def before_end(self) -> None:
        """Leave no command behind that would still move the robot."""
        self._drive.end()

    def _receive(self, message: String) -> None:
        try:
            response = parse_llm(message.data)
        except CommandError as error:
            self._drive.hush()
            self._refuse(error.problems)
            return
        self._execute(response)

    def _refuse(self, problems: Sequence[Problem]) -> None:
        reports = []
        for problem in problems:
            place = f"{problem.line}:{problem.column} {problem.field}".rstrip()
            words = problem.in_language(self.say.language)
            self.say.error(_REFUSED, problem=f"{place}: {words}")
            reports.append(
                {
                    "field": problem.field,
                    "line": problem.line,
                    "column": problem.column,
                    "message": words,
                    "code": problem.code,
                    "args": dict(problem.args),
                }
            )
        self._tell(event="refused", problems=reports)

    def _execute(self, response: LlmResponse) -> None:
        self.say.info(_THOUGHT, thought=response.thought, count=len(response.commands))
        self._tell(event="accepted", commands=len(response.commands), thought=response.thought)
        self._head.forget()
        self._drive.hush()
        for command in response.commands:
            if isinstance(command, DriveCommand):
                self._drive_as(command)
            else:
                self._turn_as(command)

    def _drive_as(self, command: DriveCommand) -> None:
        speed, steering = command.speed, command.steering
        self._drive.say(DriveSetpoint(speed, steering))
        self.say.info(_DRIVE, speed=speed, steering=steering)
        self._tell(event="drive", speed=speed, steering=steering)

    def _turn_as(self, command: HeadCommand) -> None:
        self.say.info(_HEAD, pan=command.pan, tilt=command.tilt)
        self._head.turn(command.pan, command.tilt, self._head_answered)

    def _head_answered(self, answer: HeadAnswer) -> None:
        pose = {"pan": answer.pan, "tilt": answer.tilt}
        if answer.trouble or answer.sum is None:
            self.say.warn(_HEAD_TROUBLE, trouble=answer.trouble)
            self._tell(event="head", **pose, error=answer.trouble)
            return
        if answer.sum:
            self.say.info(_HEAD_DONE, **pose)
        else:
            self.say.warn(_HEAD_REFUSED, **pose)
        self._tell(event="head", **pose, sum=answer.sum)

    def _tell(self, **report: object) -> None:
        self._result.publish(String(data=json.dumps(report, ensure_ascii=False)))


if __name__ == "__main__":
    raise SystemExit(run(LlmParser))
