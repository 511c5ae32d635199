"""The brain of lesson 9: hears a voice, checks the distance, and makes the robot act.

The reasoning that an LLM would do is a few rules in `robot.commands.brain`: with an obstacle within
`stop_distance`, or without a fresh and valid distance, the robot is told to stop; otherwise the
head turns, the robot drives forward, and the loudspeaker announces it. A drive command ("стоп",
"left") is obeyed directly, unless it leads into the unknown.
"""

from __future__ import annotations

import math
import sys
import time

from sensor_msgs.msg import Image
from std_msgs.msg import ByteMultiArray, Float32, String

from nodes.parts.head_client import HeadAnswer, HeadClient
from nodes.parts.node import LessonNode
from nodes.parts.parameters import Number
from nodes.parts.qos import DEPTH
from nodes.parts.runner import run
from nodes.parts.sensor import SensorListener
from nodes.parts.sound import from_message, to_message
from robot.commands.brain import Decision, decide, spoken
from robot.safety.distance import Reading, range_state
from robot.sound import text_in
from robot.topics import AI_COMMAND, CAMERA, MICROPHONE, SONAR_FRONT, SPEAKER
from robot.words import WORDS, parse_word
from text.i18n import N_

LOOK_PAN_DEG, LOOK_TILT_DEG = 45, 0
FORWARD, STOP_WORD = WORDS["ru"][0], WORDS["ru"][4]
"""The course's own nodes know only Russian words."""

_STARTED = N_("The brain is awake and waits for a voice")
_HEARD = N_('Heard: "{words}"')
_NO_WORDS = N_("Hearing sound and no words: nothing recognises speech yet")
_SAY_EVERY_S = 10.0
_THINKING = N_("Thinking with the voice, {picture} and {distance}")
_PICTURE = N_("a picture")
_NO_PICTURE = N_("no picture")
_DISTANCE = N_("{metres:.2f} m ahead")
_NOTHING_NEAR = N_("nothing in range ahead")
_TOO_CLOSE = N_("something too close to measure ahead")
_NOT_VALID = N_("no valid distance straight ahead")
_NO_DISTANCE = N_("no distance")
_THOUGHTS = {
    Decision.LOOK_AND_GO: N_("The path is clear: I look round and drive on"),
    Decision.OBSTACLE: N_("An obstacle is near: I stop"),
    Decision.BLIND: N_("I do not know what is ahead: I stop"),
    Decision.OBEY: N_("As you say"),
}
_REPLIES = {
    Decision.LOOK_AND_GO: N_("I look round and drive on."),
    Decision.OBSTACLE: N_("There is something in front of me, I stand still."),
    Decision.BLIND: N_("I cannot see what is ahead, I stand still."),
    Decision.OBEY: N_("As you say."),
}
_DECIDED = N_("Decision: {thought}")
_HEAD_ASKED = N_("Asking the head for pan {pan}°, tilt {tilt}°")
_HEAD_DONE = N_("The head has turned")
_HEAD_REFUSED = N_("The head refused")
_HEAD_TROUBLE = N_("The head does not turn: {trouble}")


class AiBrain(LessonNode):
    """Turns each voice message into words, a decision and an answer."""

    NAME = "ai_brain"
    SETTINGS = (
        Number("stop_distance", 1.0, "Nearer than this it stops", low=0.05, high=100.0, unit="m"),
        Number("stale_after_s", 2.5, "An older distance is ignored", low=0.1, high=60.0, unit="s"),
        Number(
            "head_timeout",
            5.0,
            "How long to wait for the head's answer",
            low=0.1,
            high=60.0,
            unit="s",
        ),
    )

    def __init__(self) -> None:
        super().__init__()
        self._picture: bytes | None = None
        """Serialized: it is not decoded until there is a vision model."""
        self._front_m: float | None = None
        self._front_s = 0.0
        self._command = self.create_publisher(String, AI_COMMAND, DEPTH)
        self._speaker = self.create_publisher(ByteMultiArray, SPEAKER, DEPTH)
        self._head = HeadClient(self, lambda: self.number("head_timeout"))
        SensorListener(self, Image, CAMERA, self._see, depth=1, raw=True)
        SensorListener(self, Float32, SONAR_FRONT, self._measure)
        self.create_subscription(ByteMultiArray, MICROPHONE, self._hear, DEPTH)
        self.say.info(_STARTED)

    def _see(self, picture: bytes) -> None:
        self._picture = picture

    def _measure(self, message: Float32) -> None:
        self._front_m, self._front_s = message.data, time.monotonic()

    def _hear(self, message: ByteMultiArray) -> None:
        sound = from_message(message)
        if text_in(sound) is None:
            # A real microphone hears something all the time: that is not a request to drive.
            self.say.info(_NO_WORDS, every_s=_SAY_EVERY_S)
            return
        words = spoken(sound)
        self.say.info(_HEARD, words=words)
        self._tell_what_is_known()
        order = parse_word(words)
        reading = Reading(self._front_m, time.monotonic() - self._front_s)
        front = range_state(reading, self.number("stop_distance"), self.number("stale_after_s"))
        self._act(decide(order, front), words)

    def _tell_what_is_known(self) -> None:
        distance = self.say.text(_ahead(self._front_m), metres=self._front_m)
        picture = self.say.text(_NO_PICTURE if self._picture is None else _PICTURE)
        self.say.info(_THINKING, picture=picture, distance=distance)

    def _act(self, decision: Decision, words: str) -> None:
        self.say.info(_DECIDED, thought=self.say.text(_THOUGHTS[decision]))
        if decision == Decision.OBEY:
            self._drive(_canonical(words))
        elif decision == Decision.LOOK_AND_GO:
            self.say.info(_HEAD_ASKED, pan=LOOK_PAN_DEG, tilt=LOOK_TILT_DEG)
            self._head.turn(LOOK_PAN_DEG, LOOK_TILT_DEG, self._head_answered)
            self._drive(FORWARD)
        else:
            self._drive(STOP_WORD)
        reply = self.say.text(_REPLIES[decision])
        self._speaker.publish(to_message(reply.encode()))

    def _drive(self, word: str) -> None:
        self._command.publish(String(data=word))

    def _head_answered(self, answer: HeadAnswer) -> None:
        if answer.trouble:
            self.say.warn(_HEAD_TROUBLE, trouble=answer.trouble)
        elif answer.sum:
            self.say.info(_HEAD_DONE)
        else:
            self.say.warn(_HEAD_REFUSED)


def _ahead(metres: float | None) -> str:
    if metres is None:
        return _NO_DISTANCE
    if math.isnan(metres):
        return _NOT_VALID
    if math.isinf(metres):
        return _NOTHING_NEAR if metres > 0 else _TOO_CLOSE
    return _DISTANCE


def _canonical(word: str) -> str:
    """Return the Russian word for the same motion."""
    asked = parse_word(word)
    return next((known for known in WORDS["ru"] if parse_word(known) == asked), STOP_WORD)


def main(args: list[str] | None = None) -> int:
    """Run the node until it is asked to end."""
    return run(AiBrain, args)


if __name__ == "__main__":
    sys.exit(main())
